//! Odd symmetry, and where a branch loses it.
//!
//! Let `S` take an orbit `q(tau)` to `-q(tau + pi)`. If `S` takes solutions of the system to solutions, there are solutions
//! with `q = S q`, which have odd harmonics only. It does if, besides odd loads and even waves of the stiffness, every contact
//! either has an odd law, even waves of its directions and odd ones of its offset (then `S` turns the gap's sign), or odd waves
//! of its directions and even ones of its offset (then `S` keeps the gap).
//!
//! At a symmetric solution the Jacobian falls apart into a block of the odd and one of the even harmonics. Where the determinant
//! of the even block changes its sign, a branch of solutions without the symmetry crosses: a symmetry-breaking branch point.
//!
//! Source: Swift and Wiesenfeld (1984), Suppression of period doubling in symmetric systems (the symmetry `S`); Golubitsky,
//! Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XIII (block structure).

use crate::branch::Orbit;
use crate::layout::{ContactLayout, Layout, Term};
use crate::subharmonics::Addition;
use crate::system::{System, Variable, Wave};

/// Values of the variable, as parts of its range, at which coefficients are looked at. A coefficient that vanishes at all of
/// them, with its derivative, is taken to vanish throughout.
const LOOKED_AT: [f64; 4] = [0.0, 0.36, 0.73, 1.0];

/// What an orbit has beyond the odd symmetry, beside that of another one.
pub(crate) fn broken(from: &Orbit, u: &[f64]) -> Addition {
    Addition::of(from, u, |harmonic| harmonic.is_multiple_of(2))
}

/// Least share of the mean square that the mean and the even harmonics of an orbit without the symmetry have: the rest is what
/// Newton's method leaves.
const BROKEN_SHARE: f64 = 1e-8;

/// Whether an orbit, of series of a length each, lacks the odd symmetry. What comes behind the last whole series does not count.
pub(crate) fn is_broken(u: &[f64], length: usize) -> bool {
    let (mut even, mut all) = (0.0, 0.0);
    for series in u.chunks_exact(length) {
        for (index, x) in series.iter().enumerate() {
            all += x * x;
            if index.div_ceil(2).is_multiple_of(2) {
                even += x * x;
            }
        }
    }
    even > BROKEN_SHARE * all
}

/// Whether solutions with odd harmonics only exist over a range of the variable.
pub(crate) fn is_odd(
    system: &dyn System,
    layout: &Layout,
    parameters: &[f64],
    omega: f64,
    variable: Variable,
    [from, to]: [f64; 2],
) -> bool {
    let mut matters = vec![false; layout.coefficients];
    let mut values = vec![0.0; layout.coefficients];
    for part in LOOKED_AT {
        let value = from + part * (to - from);
        let (mut parameters, mut omega) = (parameters.to_vec(), omega);
        match variable {
            Variable::Omega => omega = value,
            Variable::Parameter(index) => parameters[index] = value,
        }
        system.coefficients(&parameters, omega, &mut values);
        for (matters, value) in matters.iter_mut().zip(&values) {
            *matters |= *value != 0.0;
        }
        system.coefficients_by(variable, &parameters, omega, &mut values);
        for (matters, slope) in matters.iter_mut().zip(&values) {
            *matters |= *slope != 0.0;
        }
    }
    let counts = |coefficient: usize| matters[coefficient];
    let odd = |wave: Wave| wave.harmonic % 2 == 1;
    let load = layout.load.iter().filter(|entry| counts(entry.coefficient));
    let stiffness = layout
        .stiffness
        .iter()
        .filter(|entry| counts(entry.coefficient));
    let contact = |contact: &ContactLayout| {
        let all = |terms: &[Term], parity: bool| {
            let mut terms = terms.iter().filter(|term| counts(term.coefficient));
            terms.all(|term| odd(term.wave) == parity)
        };
        let turned = system.law(contact.law).facts().odd
            && all(&contact.gap, false)
            && all(&contact.force, false)
            && all(&contact.offset, true);
        let kept =
            all(&contact.gap, true) && all(&contact.force, true) && all(&contact.offset, false);
        turned || kept
    };
    load.into_iter().all(|entry| odd(entry.wave))
        && stiffness.into_iter().all(|entry| !odd(entry.wave))
        && layout.contacts.iter().all(contact)
}
