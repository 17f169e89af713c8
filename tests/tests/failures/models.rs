//! The oscillators of the gallery, and how their orbits are found and compared.

use std::ops::ControlFlow;

use hertzian::stability::{Answer, Method};
use hertzian::{Branch, Complex, Error, FrequencyResponse};

hertzian::oscillator! {
    /// Contact on one side with a linear spring.
    pub Linear(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Contact on one side of any power.
    pub Power(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// A spring of any power on both sides.
    pub Continuous(x) {
        param zeta in 0.0..;
        param alpha > 0;
        param load;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

/// The linear one at the damping and load of the paper.
pub const fn linear(drive: f64) -> Linear {
    Linear {
        zeta: 0.032,
        load: 1.0,
        drive,
    }
}

/// A branch of one point: the first orbit of a request, if one is found.
pub fn start<'a>(request: &FrequencyResponse<'a>) -> Result<Branch<'a>, Error> {
    request.run_with(|_| ControlFlow::Break(()))
}

/// The same of a request that has one.
pub fn first<'a>(request: &FrequencyResponse<'a>) -> Branch<'a> {
    start(request).unwrap()
}

/// What a method says of the first orbit of a branch.
pub fn answer(branch: &Branch<'_>, method: Method) -> Answer {
    branch.multipliers(&branch.points[0], method)
}

/// Largest distance between two sets of multipliers, each matched with its nearest.
pub fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut free = b.to_vec();
    let mut largest = 0.0_f64;
    for x in a {
        let nearest = (0..free.len())
            .min_by(|&i, &j| (free[i] - x).norm().total_cmp(&(free[j] - x).norm()))
            .unwrap();
        largest = largest.max((free.swap_remove(nearest) - x).norm());
    }
    largest
}

/// A number in a row of a table, if there is one.
pub fn shown(number: Option<f64>) -> String {
    number.map_or_else(|| "no orbit found".to_owned(), |x| format!("{x:.1e}"))
}
