//! Tests of hertzian across its crates, and what several of them need.

pub mod dormand_prince;
pub mod passage;
#[path = "../../core/src/testing/random.rs"]
pub mod random;
pub mod reference;
pub mod tableau;

use hertzian::Complex;

hertzian::oscillator! {
    /// Contact on one side, Wang et al. (2021), Eq. (1).
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// exponent of the force
        param alpha > 0;
        /// load
        param load;
        /// amplitude
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// The same with a linear spring: its motions have closed forms between switches.
    pub OneSidedLinear(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// load
        param load;
        /// amplitude
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// The same spring on both sides.
    pub Continuous(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// exponent of the force
        param alpha > 0;
        /// load
        param load;
        /// amplitude
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Two masses in a row, the second held to the ground, the first with an elastic stop at distance one.
    /// Stiffness and clearance as in example 03 of NLvib (Krack and Gross 2019); damping is 0.03 of the stiffness matrix.
    pub TwoMasses(x1, x2) {
        /// stiffness of the stop
        param stop > 0;
        /// amplitude
        param drive;
        law stop_spring(gap) { gap > 1 => stop*(gap - 1), else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop_spring(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

/// The one whose value is nearest to a wanted one.
pub fn nearest<T>(
    among: impl IntoIterator<Item = T>,
    wanted: f64,
    value: impl Fn(&T) -> f64,
) -> Option<T> {
    let apart = |x: &T| (value(x) - wanted).abs();
    among
        .into_iter()
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Largest distance between two sets of multipliers, each matched with its nearest.
///
/// # Panics
/// If they are not as many.
pub fn distance(a: &[Complex<f64>], b: &[Complex<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut free = b.to_vec();
    let mut largest = 0.0_f64;
    for x in a {
        let apart = |i: &usize| (free[*i] - x).norm();
        if let Some(index) = nearest(0..free.len(), 0.0, apart) {
            largest = largest.max((free.swap_remove(index) - x).norm());
        }
    }
    largest
}
