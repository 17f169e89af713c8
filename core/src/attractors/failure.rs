//! How a checkpoint keeps the error that ended a motion: as three numbers.

use crate::system::Variable;
use crate::time::FlowError;

/// Which error it is, and what it carries.
pub(super) fn numbers(error: FlowError) -> [f64; 3] {
    match error {
        FlowError::StepTooShort { phase, step } => [1.0, phase, step],
        FlowError::NotFinite { phase } => [2.0, phase, 0.0],
        FlowError::TooManySwitches { phase, switches } => [3.0, phase, switches as f64],
        FlowError::Rests { phase } => [4.0, phase, 0.0],
        FlowError::Grazes { phase } => [5.0, phase, 0.0],
        FlowError::Cancelled { phase } => [14.0, phase, 0.0],
        FlowError::SingularMass { determinant } => [6.0, determinant, 0.0],
        FlowError::Value { variable, value } => match variable {
            Variable::Omega => [7.0, value, 0.0],
            Variable::Parameter(index) => [8.0, value, index as f64],
        },
        FlowError::Levels { contact } => [9.0, contact as f64, 0.0],
        FlowError::Entries { entries, expected } => [10.0, entries as f64, expected as f64],
        FlowError::Section { phase } => [11.0, phase, 0.0],
        FlowError::NoPeriods => [12.0, 0.0, 0.0],
        FlowError::TooManySteps { phase, steps } => [13.0, phase, steps as f64],
    }
}

/// From [`numbers`].
pub(super) fn of_numbers([kind, a, b]: [f64; 3]) -> Option<FlowError> {
    Some(match kind as usize {
        1 => FlowError::StepTooShort { phase: a, step: b },
        2 => FlowError::NotFinite { phase: a },
        3 => FlowError::TooManySwitches {
            phase: a,
            switches: b as usize,
        },
        4 => FlowError::Rests { phase: a },
        5 => FlowError::Grazes { phase: a },
        6 => FlowError::SingularMass { determinant: a },
        7 => FlowError::Value {
            variable: Variable::Omega,
            value: a,
        },
        8 => FlowError::Value {
            variable: Variable::Parameter(b as usize),
            value: a,
        },
        9 => FlowError::Levels {
            contact: a as usize,
        },
        10 => FlowError::Entries {
            entries: a as usize,
            expected: b as usize,
        },
        11 => FlowError::Section { phase: a },
        12 => FlowError::NoPeriods,
        13 => FlowError::TooManySteps {
            phase: a,
            steps: b as usize,
        },
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors come back from the numbers that a checkpoint keeps.
    #[test]
    fn errors_are_kept_as_numbers() {
        for error in [
            FlowError::StepTooShort {
                phase: 1.5,
                step: 1e-17,
            },
            FlowError::NotFinite { phase: 2.5 },
            FlowError::TooManySwitches {
                phase: 0.1,
                switches: 2001,
            },
            FlowError::Rests { phase: 0.2 },
            FlowError::Grazes { phase: 0.3 },
            FlowError::SingularMass { determinant: 0.0 },
            FlowError::Value {
                variable: Variable::Omega,
                value: -1.0,
            },
            FlowError::Value {
                variable: Variable::Parameter(3),
                value: -2.0,
            },
            FlowError::Levels { contact: 2 },
            FlowError::Entries {
                entries: 3,
                expected: 2,
            },
            FlowError::Section { phase: 0.4 },
            FlowError::NoPeriods,
            FlowError::TooManySteps {
                phase: 0.5,
                steps: 100_001,
            },
        ] {
            assert_eq!(of_numbers(numbers(error)), Some(error));
        }
        assert_eq!(of_numbers([0.0; 3]), None);
    }
}
