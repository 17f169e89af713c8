//! Residual and Jacobian of the balance, stage by stage, with generated, interpreted and dual-number laws:
//! `cargo bench -p hertzian --bench stages`.
//!
//! One-sided contact with damping, exponents 3/2 and an argument (1.7), at an orbit that loses contact. Medians of turns in
//! which the kinds of laws take part one after the other. Times of the whole are measured on the laws as they are. What the
//! laws take of it is measured by repeating the very calls that an evaluation makes; where they begin and end in it,
//! by stamping them.

#[path = "../shared/dual.rs"]
mod dual;
mod dual_law;
mod measure;
mod observe;
#[path = "../shared/processor.rs"]
mod processor;

use std::sync::Arc;

use hertzian::law::Law;
use hertzian::oscillator;
use hertzian::system::{System, SystemFacts, Variable};

use measure::{Parts, TURNS, Whole};

oscillator! {
    /// Hertz contact with damping under a load.
    ThreeHalves(x) {
        param zeta in 0.0..;
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

oscillator! {
    /// The same, the exponent a parameter.
    Power(x) {
        param zeta in 0.0..;
        param alpha > 0;
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^alpha,
            else    => 0,
        }
        ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
    }
}

const HARMONICS: [usize; 4] = [10, 20, 50, 100];

/// A system with another law in the place of its only one.
#[derive(Clone)]
struct With {
    system: Arc<dyn System>,
    /// The other law; its own if there is none.
    law: Option<Arc<dyn Law>>,
}

impl System for With {
    fn facts(&self) -> &SystemFacts {
        self.system.facts()
    }

    fn values(&self, values: &mut [f64]) {
        self.system.values(values);
    }

    fn coefficients(&self, parameters: &[f64], omega: f64, coefficients: &mut [f64]) {
        self.system.coefficients(parameters, omega, coefficients);
    }

    fn coefficients_by(
        &self,
        variable: Variable,
        parameters: &[f64],
        omega: f64,
        derivatives: &mut [f64],
    ) {
        self.system
            .coefficients_by(variable, parameters, omega, derivatives);
    }

    fn law(&self, index: usize) -> &dyn Law {
        match &self.law {
            Some(law) => law.as_ref(),
            None => self.system.law(index),
        }
    }

    fn shared(&self) -> Arc<dyn System> {
        Arc::new(self.clone())
    }
}

fn main() {
    println!(
        "Microseconds, medians of {TURNS} turns. {}.\n",
        processor::description()
    );
    let models: [(&str, &dyn System); 2] = [
        ("3/2", &ThreeHalves { zeta: 0.032 }),
        (
            "an argument",
            &Power {
                zeta: 0.032,
                alpha: 1.7,
            },
        ),
    ];
    let (mut wholes, mut parts) = (Vec::new(), Vec::new());
    for (name, system) in models {
        for harmonics in HARMONICS {
            wholes.push(format!(
                "| {name} | {harmonics} | {} |",
                Whole::of(system, harmonics)
            ));
            parts.push(format!(
                "| {name} | {harmonics} | {} |",
                Parts::of(system, harmonics)
            ));
        }
    }
    for (head, rows) in [(measure::WHOLE, wholes), (measure::PARTS, parts)] {
        println!("| exponent | harmonics | {head} |");
        println!("|---|{}", "---:|".repeat(head.split('|').count() + 1));
        println!("{}\n", rows.join("\n"));
    }
}
