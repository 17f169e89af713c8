//! The one-sided power laws as a person would attach them without the compiler: facts by hand, derivatives by num-dual.

use hertzian::generic::LawData;
use hertzian::law::{Derivatives, Law, LawFacts, On, Parts};

use super::dual::{self, Exponent, Sides};

/// `phi = H(g) (2 zeta r + g^alpha)` with arguments `zeta` and, if it has two, `alpha`; otherwise `alpha` is 3/2.
pub struct DualLaw {
    facts: LawFacts,
    data: LawData,
}

impl DualLaw {
    /// With the facts of the law that it stands for.
    pub fn of(law: &dyn Law) -> Self {
        Self {
            facts: law.facts().clone(),
            data: law.data().expect("a generated law").clone(),
        }
    }
}

/// The piece of a sample.
fn is_above(on: On, gap: f64) -> bool {
    match on {
        On::AllPieces => gap > 0.0,
        On::Piece(piece) => piece == 1,
    }
}

/// Force and derivatives by gap, rate and exponent.
#[inline]
fn point<const N: usize>(on: On, arguments: &[f64], gap: f64, rate: f64) -> (f64, [f64; N]) {
    let (zeta, exponent) = match *arguments {
        [zeta, alpha] => (zeta, Exponent::Number(alpha)),
        _ => (arguments[0], Exponent::ThreeHalves),
    };
    if !is_above(on, gap) {
        return (0.0, [0.0; N]);
    }
    // A power of zero has no dual number.
    dual::force(Sides::One, zeta, exponent, gap.max(f64::MIN_POSITIVE), rate)
}

impl Law for DualLaw {
    fn facts(&self) -> &LawFacts {
        &self.facts
    }

    fn data(&self) -> Option<&LawData> {
        Some(&self.data)
    }

    fn levels(&self, _arguments: &[f64], levels: &mut [f64]) {
        levels.fill(0.0);
    }

    fn levels_by(&self, _arguments: &[f64], _argument: usize, by_argument: &mut [f64]) {
        by_argument.fill(0.0);
    }

    fn force(&self, on: On, arguments: &[f64], gap: &[f64], rate: &[f64], force: &mut [f64]) {
        let alpha = arguments.get(1).copied();
        for (i, force) in force.iter_mut().enumerate() {
            let size = gap[i].max(0.0);
            let power = alpha.map_or_else(|| size * size.sqrt(), |alpha| size.powf(alpha));
            let above = is_above(on, gap[i]);
            *force = if above {
                2.0 * arguments[0] * rate[i] + power
            } else {
                0.0
            };
        }
    }

    fn derivatives(
        &self,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
    ) {
        for i in 0..gap.len() {
            let (force, [by_gap, by_rate]) = point(on, arguments, gap[i], rate[i]);
            out.force[i] = force;
            out.by_gap[i] = by_gap;
            out.by_rate[i] = by_rate;
        }
    }

    fn derivatives_and_by(
        &self,
        argument: usize,
        on: On,
        arguments: &[f64],
        gap: &[f64],
        rate: &[f64],
        out: Derivatives<'_>,
        by_argument: &mut [f64],
    ) {
        for i in 0..gap.len() {
            let (force, [by_gap, by_rate, by_alpha]) = point(on, arguments, gap[i], rate[i]);
            out.force[i] = force;
            out.by_gap[i] = by_gap;
            out.by_rate[i] = by_rate;
            let by_zeta = if is_above(on, gap[i]) {
                2.0 * rate[i]
            } else {
                0.0
            };
            by_argument[i] = if argument == 0 { by_zeta } else { by_alpha };
        }
    }

    fn parts(&self) -> Option<Parts<'_>> {
        None
    }
}
