//! What the reduction changes of an orbit.
//!
//! The whole structure and the reduced one answer equal forces with amplitudes that differ by
//!
//! ```text
//! sum_c sum_k E_yc(k w) |f_ck| + sum_l E_yl(h_l w) |b_l|                                                      (1)
//! ```
//!
//! at most, with the errors `E` of the compliance and the harmonics `f_ck` of the forces that were computed; for a rate `E` is multiplied by
//! the frequency of its harmonic, for an acceleration by the square. Gaps differ as much, and change the forces, to which the reduced
//! structure answers with all of its compliance: that is added ([`crate::feedback`]). At a fold it is what lies beside the branch.
//! Both are of first order, and say too little where the stiffness of a contact is as large as one over the error of the compliance.

use hertzian::{Branch, Point};

use crate::at_orbit::AtOrbit;
use crate::description::SparseStructure;
use crate::feedback::Read;
use crate::reduced::{Reduced, ReducedError};

/// A multiplier so near to one is that of a fold.
const TURNS: f64 = 1e-4;

/// What the reduction changes of an output at an orbit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutputError {
    /// The output.
    pub name: String,
    /// Of its peak-to-peak, as a part of it, to first order (1).
    pub error: f64,
}

impl Reduced {
    /// What the reduction changes of each output of a structure at an orbit of a branch of it.
    ///
    /// # Errors
    /// If it is a reduction of [another structure](Self::is_of), or the orbit cannot be read.
    pub fn errors_at(
        &self,
        structure: &SparseStructure,
        branch: &Branch,
        point: &Point,
    ) -> Result<Vec<OutputError>, ReducedError> {
        let at = AtOrbit::of(self, structure, branch, point)?;
        let feedback = at.feedback(self, turns(point));
        let first = 2 * structure.contacts.len() + structure.loads.len();
        let read = structure.outputs.iter().enumerate();
        let read = read.map(|(index, output)| Read {
            row: first + index,
            derivatives: output.kind.derivatives(),
        });
        let read: Vec<_> = read.collect();
        let changes = feedback.changes(&read, &at.off());
        let outputs = structure.outputs.iter().zip(&read).zip(changes);
        let errors = outputs.map(|((output, read), change)| {
            let measured = &at.measured;
            let alone =
                measured.response_off(read.row, output.kind, at.base, &at.forces, &at.doubt);
            let motion = branch.reading(&output.name, point)?.motion;
            Ok(OutputError {
                name: output.name.clone(),
                error: part(alone + change, motion.peak_to_peak()),
            })
        });
        errors.collect()
    }
}

/// Whether a branch turns at an orbit.
fn turns(point: &Point) -> bool {
    let mut multipliers = point.stability.multipliers.iter();
    multipliers.any(|multiplier| (multiplier - 1.0).norm() < TURNS)
}

/// What an amplitude is of a peak-to-peak; what is not a number is unbounded.
fn part(amplitude: f64, size: f64) -> f64 {
    if amplitude == 0.0 {
        0.0
    } else if amplitude.is_nan() {
        f64::INFINITY
    } else {
        2.0 * amplitude / size
    }
}
