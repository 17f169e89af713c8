//! The oscillators of the program, declared as any user would declare one.
//!
//! An exponent that is written as a number is compiled into the force: `x^1.5` becomes `x sqrt(x)`, and `x^1` a straight
//! line whose derivative is a constant. An exponent that is a parameter costs a logarithm and an exponential, and can be
//! anything. All of them follow Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722, Eq. (1).

use hertzian::System;

use super::model_file::{self, ModelError, Varied};
use crate::model::ModelOptions;

hertzian::oscillator! {
    /// One-sided contact of any exponent.
    pub OneSidedPower(x) {
        /// exponent of the contact force
        param alpha > 0;
        /// damping ratio
        param zeta in 0.0..;
        /// normal load W
        param load;
        /// excitation amplitude A
        param drive;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^alpha,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// One-sided contact with a linear spring.
    pub OneSidedLinear(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load W
        param load;
        /// excitation amplitude A
        param drive;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// One-sided contact of two spheres: Hertz's exponent.
    pub OneSidedHertz(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load W
        param load;
        /// excitation amplitude A
        param drive;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap^1.5,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Power-law spring in both directions, of any exponent, in the notation of the paper.
    pub ContinuousPower(x) {
        /// exponent of the spring force
        param alpha > 0;
        /// damping ratio
        param zeta in 0.0..;
        /// constant load W
        param load;
        /// excitation amplitude A
        param drive;

        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Linear spring in both directions.
    pub ContinuousLinear(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// constant load W
        param load;
        /// excitation amplitude A
        param drive;

        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Spring of exponent 3/2 in both directions, in the notation of the paper.
    pub ContinuousHertz(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// constant load W
        param load;
        /// excitation amplitude A
        param drive;

        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^1.5 = drive*cos(omega*t) + load;
    }
}

/// The oscillator that the options ask for: the one in a file, or a declared one. What is varied needs no value but the first.
///
/// # Errors
/// If the file gives none.
pub fn model(options: &ModelOptions, varied: Varied<'_>) -> Result<Box<dyn System>, ModelError> {
    match &options.file {
        Some(path) => Ok(Box::new(model_file::read(path, &options.set, varied)?)),
        None if varied.name == "alpha" => Ok(of_any_exponent(options)),
        None => Ok(declared(options)),
    }
}

/// The declared oscillator: a specialised one if there is one for the exponent.
pub fn declared(options: &ModelOptions) -> Box<dyn System> {
    let &ModelOptions {
        alpha,
        zeta,
        load,
        drive,
        ..
    } = options;
    match (options.loses_contact(), alpha) {
        (true, 1.0) => Box::new(OneSidedLinear { zeta, load, drive }),
        (true, 1.5) => Box::new(OneSidedHertz { zeta, load, drive }),
        (false, 1.0) => Box::new(ContinuousLinear { zeta, load, drive }),
        (false, 1.5) => Box::new(ContinuousHertz { zeta, load, drive }),
        _ => of_any_exponent(options),
    }
}

/// The declared oscillator whose exponent is a parameter.
pub fn of_any_exponent(options: &ModelOptions) -> Box<dyn System> {
    let &ModelOptions {
        alpha,
        zeta,
        load,
        drive,
        ..
    } = options;
    if options.loses_contact() {
        Box::new(OneSidedPower {
            alpha,
            zeta,
            load,
            drive,
        })
    } else {
        Box::new(ContinuousPower {
            alpha,
            zeta,
            load,
            drive,
        })
    }
}
