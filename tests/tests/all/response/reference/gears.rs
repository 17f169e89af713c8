//! A gear pair with backlash and a stiffness of the mesh that varies in time: Kahraman and Singh (1991).
//!
//! The pieces are affine, but the stiffness varies, so motions are integrated. Shooting is the method for digits.

use hertzian::{ContactEquation, FrequencyResponse, Shooting};
use hertzian_tests::reference::{Accuracy, Case};

use super::from_either_end;

hertzian::oscillator! {
    /// Relative displacement of the teeth; backlash from -1 to 1.
    Gears(x) {
        /// amplitude of the transmission error
        param error;
        law mesh(gap) {
            gap > 1          => gap - 1,
            -1 <= gap <= 1   => 0,
            gap < -1         => gap + 1,
        }
        ddot(x) + 0.1*dot(x) + (1 + 0.2*cos(omega*t))*mesh(x) = 0.1 + error*omega^2*cos(omega*t);
    }
}

/// What the last digits leave open.
const DIGITS: f64 = 3e-13;
const ACCURACY: Accuracy = Accuracy {
    of_peaks: 1e-9,
    of_multipliers: 1e-9,
};

/// At one end of a range the teeth never part, at the other one they do: between lies one grazing, which is not among what is known.
fn are_as_known(name: &str, error: f64, range: [f64; 2]) {
    let case = Case::of(name);
    let model = Gears { error };
    let request = FrequencyResponse::of(&model);
    let by_shooting = from_either_end(&request.clone().by(Shooting::new()), range);
    let by_contact_equation = from_either_end(&request.by(ContactEquation::new()), range);
    for branch in by_shooting.into_iter().chain(by_contact_equation) {
        case.assert_events(&branch, DIGITS, 1);
        case.assert_orbits(&branch, &[], ACCURACY);
    }
}

#[test]
fn a_large_error_of_transmission() {
    are_as_known("D1", 0.2, [0.4, 2.0]);
}

#[test]
fn a_small_error_of_transmission() {
    are_as_known("D3", 0.05, [0.7, 1.2]);
}
