//! The problems: curves of which folds and an orbit are known.

use hertzian::generic::Declaration;
use hertzian::system::System;

use crate::model::ModelOptions;
use crate::response::models::{declared, of_any_exponent};

/// A curve and what is known of it.
pub struct Problem {
    /// Name of its files.
    pub id: &'static str,
    /// What it is.
    pub title: &'static str,
    /// The oscillator, compiled.
    pub compiled: Box<dyn System>,
    /// The same, interpreted.
    pub interpreted: Box<dyn System>,
    /// The same with an exponent that is a parameter, so that shooting has no closed form, where it has one otherwise.
    pub integrated: Option<Box<dyn System>>,
    /// Frequencies at which the curve begins and ends.
    pub range: [f64; 2],
    /// All folds in the range, that of largest amplitude first; `None` where shooting with closed forms tells, whose own error is then
    /// not known from elsewhere.
    pub folds: Option<&'static [f64]>,
    /// Frequency at which the largest orbit is compared.
    pub at: f64,
}

hertzian::oscillator! {
    /// Two masses, the first with an elastic stop a hundred times as stiff as the springs. Stiffness and clearance as in example 03 of
    /// NLvib (Krack and Gross 2019), damping 0.03 of the stiffness.
    StiffStop(x1, x2) {
        param drive;
        law stop(gap) { gap > 1 => 100*(gap - 1), else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The same with an exponent.
    StiffPower(x1, x2) {
        param drive;
        param alpha in 0.1..;
        law stop(gap) { gap > 1 => 100*(gap - 1)^alpha, else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

const STIFF_STOP: &str = "StiffStop(x1, x2) { param drive = 0.1; law stop(gap) { gap > 1 => 100*(gap - 1), else => 0 } \
    ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop(x1) = 0; \
    ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t); }";

fn stiff_stop() -> Problem {
    let compiled = || Box::new(StiffStop { drive: 0.1 });
    Problem {
        id: "stiff-stop",
        title: "two masses, one with a stop 100 times as stiff as its spring",
        compiled: compiled(),
        interpreted: match Declaration::parse(STIFF_STOP) {
            Ok(model) => Box::new(model),
            Err(_) => compiled(),
        },
        integrated: Some(Box::new(StiffPower {
            drive: 0.1,
            alpha: 1.0,
        })),
        range: [0.5, 1.0],
        folds: None,
        at: 0.7,
    }
}

/// Names of the problems.
pub const IDS: [&str; 5] = [
    "one-sided-1",
    "one-sided-1.5",
    "one-sided-0.6",
    "continuous-1.5",
    "stiff-stop",
];

/// Folds are from an independent computation: exponent one from the closed-form flow, the others by event-located integration, in
/// 80-bit arithmetic, with errors below 1e-12.
pub fn all() -> Vec<Problem> {
    vec![
        problem(Spring {
            id: "one-sided-1",
            title: "one-sided contact, α = 1 (Wang et al. 2021, Fig. 5a)",
            alpha: 1.0,
            one_sided: true,
            range: [0.6, 1.4],
            folds: &[0.715_119_549_676_419, 0.960_163_671_878_57],
            at: 0.8,
        }),
        problem(Spring {
            id: "one-sided-1.5",
            title: "one-sided contact, α = 1.5 (Wang et al. 2021, Fig. 5b)",
            alpha: 1.5,
            one_sided: true,
            range: [0.6, 1.6],
            folds: &[0.685_842_253_572_486, 1.144_516_913_788_162],
            at: 0.8,
        }),
        problem(Spring {
            id: "one-sided-0.6",
            title: "one-sided contact, α = 0.6 (Wang et al. 2021, Fig. 5c)",
            alpha: 0.6,
            one_sided: true,
            range: [0.5, 1.2],
            folds: &[
                0.631_308_249_440_869,
                0.845_526_217_725_541,
                0.849_176_252_131_873,
                0.765_568_492_941_199,
            ],
            at: 0.7,
        }),
        problem(Spring {
            id: "continuous-1.5",
            title: "spring on both sides, α = 1.5 (Wang et al. 2021, Fig. 2a)",
            alpha: 1.5,
            one_sided: false,
            range: [0.5, 1.7],
            folds: &[1.332_696_002_393_464, 0.909_513_715_044_238],
            at: 1.2,
        }),
        stiff_stop(),
    ]
}

/// A mass on one spring.
#[derive(Clone, Copy)]
struct Spring {
    id: &'static str,
    title: &'static str,
    alpha: f64,
    one_sided: bool,
    range: [f64; 2],
    folds: &'static [f64],
    /// Where the size of the orbit is compared.
    at: f64,
}

/// One-sided contacts are loaded, and damped more.
fn problem(spring: Spring) -> Problem {
    let Spring {
        id,
        title,
        alpha,
        one_sided,
        range,
        folds,
        at,
    } = spring;
    let (zeta, load) = if one_sided { (0.032, 1.0) } else { (0.01, 0.0) };
    let options = ModelOptions {
        alpha,
        one_sided,
        continuous: !one_sided,
        file: None,
        set: Vec::new(),
        zeta,
        load,
        drive: 0.1,
        omega: None,
    };
    Problem {
        id,
        title,
        compiled: declared(&options),
        interpreted: interpreted(&options),
        integrated: (alpha == 1.0).then(|| of_any_exponent(&options)),
        range,
        folds: Some(folds),
        at,
    }
}

/// The same equation as the compiled one, with the same number as its exponent.
fn interpreted(options: &ModelOptions) -> Box<dyn System> {
    let ModelOptions {
        alpha,
        zeta,
        load,
        drive,
        ..
    } = options;
    let force = if options.one_sided {
        format!(
            "law contact(gap) {{ gap > 0 => 2*zeta*dot(gap) + gap^{alpha}, else => 0 }} ddot(x) + contact(x)"
        )
    } else {
        format!("ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^{alpha}")
    };
    let text = format!(
        "Spring(x) {{ param zeta = {zeta:?} in 0.0..; param load = {load:?}; param drive = {drive:?}; {force} = drive*cos(omega*t) + load; }}"
    );
    match Declaration::parse(&text) {
        Ok(model) => Box::new(model),
        // The compiled one, whose equation it is, has passed the same front end.
        Err(_) => declared(options),
    }
}
