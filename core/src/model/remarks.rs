//! What is unusual about a system and may be meant: nothing is refused for it, but a slip of the pen looks the same.

use nalgebra::DMatrix;

use crate::model::layout::{Layout, constant};
use crate::model::values;
use crate::system::System;

/// Entries that differ by less, relative to the largest, are equal.
const EQUAL: f64 = 1e-12;

/// What is unusual about a system at the present values of its parameters and an excitation frequency, each in a sentence.
///
/// That nothing in the equations depends on time: every periodic orbit of the excitation's frequency that is found is likely at rest. That
/// the mass or the stiffness matrix, which is symmetric for forces with an energy, is not, with the two entries that differ most.
///
/// ```
/// hertzian::oscillator! {
///     Slip(x, y) {
///         ddot(x) + 0.1*dot(x) + 2*x - y = cos(omega*t);
///         ddot(y) + 0.1*dot(y) + 2*y + x = 0;
///     }
/// }
///
/// let remarks = hertzian::remarks::of(&Slip {}, 1.0);
/// assert_eq!(
///     remarks[0],
///     "the stiffness matrix is not symmetric: -1e0 of y in the equation of x, 1e0 of x in that of y"
/// );
/// ```
pub fn of(system: &dyn System, omega: f64) -> Vec<String> {
    let layout = Layout::of(system);
    let facts = system.facts();
    let parameters = values(system);
    let mut coefficients = vec![0.0; layout.coefficients];
    system.coefficients(&parameters, omega, &mut coefficients);
    let mut remarks = Vec::new();
    if !is_excited(&layout, &coefficients) {
        remarks.push("nothing in the equations depends on time: there is no excitation".to_owned());
    }
    for (matrix, entries) in [("mass", &layout.mass), ("stiffness", &layout.stiffness)] {
        let matrix_of = constant(entries, &coefficients, layout.coordinates);
        remarks.extend(unsymmetric(&matrix_of).map(|(row, column)| {
            let [a, b] = [row, column].map(|at| &facts.coordinates[at]);
            let [ab, ba] = [matrix_of[(row, column)], matrix_of[(column, row)]];
            format!(
                "the {matrix} matrix is not symmetric: {ab:e} of {b} in the equation of {a}, {ba:e} of {a} in that of {b}"
            )
        }));
    }
    remarks
}

/// Whether a load, a stiffness, a direction or an offset has a harmonic that is not zero.
fn is_excited(layout: &Layout, coefficients: &[f64]) -> bool {
    let entries = layout.load.iter().chain(&layout.stiffness);
    let mut waves = entries.map(|entry| (entry.wave, entry.coefficient));
    let contacts = layout.contacts.iter();
    let mut of_contacts = contacts
        .flat_map(|contact| {
            contact
                .force
                .iter()
                .chain(&contact.gap)
                .chain(&contact.offset)
        })
        .map(|term| (term.wave, term.coefficient));
    let varies = |(wave, coefficient): (crate::system::Wave, usize)| {
        wave.harmonic > 0 && coefficients[coefficient] != 0.0
    };
    waves.any(varies) || of_contacts.any(varies)
}

/// The pair of entries that differ most, if they do.
fn unsymmetric(matrix: &DMatrix<f64>) -> Option<(usize, usize)> {
    let n = matrix.nrows();
    let pairs = (0..n).flat_map(|row| (row + 1..n).map(move |column| (row, column)));
    let apart =
        |&(row, column): &(usize, usize)| (matrix[(row, column)] - matrix[(column, row)]).abs();
    let worst = pairs.max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    (apart(&worst) > EQUAL * matrix.amax()).then_some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    hertzian::oscillator! {
        Turning(x, y) {
            param drive;
            param coupling;
            2*ddot(x) + 0.1*dot(x) + 3*dot(y) + x + coupling*y = drive*cos(omega*t);
            2*ddot(y) + 0.1*dot(y) - 3*dot(x) + y + x = 0;
        }
    }

    #[test]
    fn what_is_usual_has_no_remark() {
        let usual = Turning {
            drive: 0.1,
            coupling: 1.0,
        };
        assert!(of(&usual, 1.0).is_empty());
    }

    #[test]
    fn without_drive_there_is_no_excitation() {
        let free = Turning {
            drive: 0.0,
            coupling: 1.0,
        };
        assert_eq!(
            of(&free, 1.0),
            ["nothing in the equations depends on time: there is no excitation"]
        );
    }

    #[test]
    fn the_pair_that_differs_most_is_named() {
        let slip = Turning {
            drive: 0.1,
            coupling: -1.0,
        };
        let expected = "the stiffness matrix is not symmetric: -1e0 of y in the equation of x, 1e0 of x in that of y";
        assert_eq!(of(&slip, 1.0), [expected]);
    }
}
