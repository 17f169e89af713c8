//! Who runs.

use hertzian::generic::InterpretedLaw;
use hertzian::law::{Derivatives, Law, On};
use hertzian::power::Instructions;

use super::laws::{Call, Subject};
use super::samples::Samples;
use super::{by_hand, scalar};

/// A name, and what is computed.
pub struct Contender {
    pub name: &'static str,
    pub evaluate: Box<dyn Fn(&mut Samples)>,
}

/// Generated and interpreted law, and whom else the compared call of the law is put to.
pub fn contenders(subject: &'static Subject, call: Call) -> Vec<Contender> {
    let mut contenders = Vec::new();
    let mut add = |name, evaluate| {
        contenders.push(Contender { name, evaluate });
    };
    let arguments = subject.arguments;
    let generated = move |s: &mut Samples| evaluate(subject.law, call, arguments, s);
    add("generated", Box::new(generated));
    let law = InterpretedLaw::of(subject.law).expect("a generated law");
    add(
        "interpreted",
        Box::new(move |s| evaluate(&law, call, arguments, s)),
    );
    let (true, Some(sides)) = (call == subject.compared, subject.sides) else {
        return contenders;
    };
    if let [zeta, alpha] = *arguments {
        add(
            "powf",
            Box::new(move |s| scalar::powf(sides, [zeta, alpha], s)),
        );
        add(
            "num-dual",
            Box::new(move |s| scalar::duals(sides, [zeta, alpha], s)),
        );
    } else {
        let zeta = arguments[0];
        let instructions = Instructions::in_use();
        add(
            "by hand",
            Box::new(move |s| by_hand::run(sides, instructions, zeta, s)),
        );
        add(
            "num-dual",
            Box::new(move |s| scalar::duals_three_halves(sides, zeta, s)),
        );
        #[cfg(target_arch = "x86_64")]
        if instructions == Instructions::Avx512 {
            add(
                "Newton",
                Box::new(move |s| super::newton::run(sides, zeta, s)),
            );
        }
    }
    contenders
}

fn evaluate(law: &dyn Law, call: Call, arguments: &[f64], samples: &mut Samples) {
    let Samples {
        gap,
        rate,
        force,
        by_gap,
        by_rate,
        by_argument,
    } = samples;
    let on = On::AllPieces;
    if let Call::Force = call {
        law.force(on, arguments, gap, rate, force);
        return;
    }
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    match call {
        Call::ByArgument(index) => {
            law.derivatives_and_by(index, on, arguments, gap, rate, out, by_argument);
        }
        _ => law.derivatives(on, arguments, gap, rate, out),
    }
}
