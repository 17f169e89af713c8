//! A gear pair with backlash and a stiffness of the mesh that varies in time: Kahraman and Singh (1991).
//!
//! The pieces are affine, but the stiffness varies, so motions are integrated. Shooting is the method for digits.

use hertzian::EventKind::{Fold, PeriodDoubling};
use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting};

use super::{all_found, from_either_end, of_shooting};

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

/// DOP853 in extended precision, confirmed by Chebyshev collocation.
const LARGE: Known = Known {
    error: 0.2,
    range: [0.4, 2.0],
    events: &[
        (PeriodDoubling, 1.758_934_488_127_7),
        (PeriodDoubling, 0.900_809_600_539_09),
        (Fold, 0.513_202_851_418_59),
        (Fold, 0.658_634_499_082_91),
    ],
};
const SMALL: Known = Known {
    error: 0.05,
    range: [0.7, 1.2],
    events: &[(Fold, 0.835_590_098_182_22), (Fold, 0.894_134_568_813_05)],
};
/// What the last digits leave open.
const DIGITS: f64 = 3e-13;

/// What is known of one gear pair: its events.
struct Known {
    error: f64,
    range: [f64; 2],
    events: &'static [(EventKind, f64)],
}

#[test]
fn every_event_is_found_from_either_end() {
    for known in [LARGE, SMALL] {
        let model = Gears { error: known.error };
        let request = FrequencyResponse::of(&model);
        let by_shooting = from_either_end(&request.clone().by(Shooting::new()), known.range);
        let by_contact_equation = from_either_end(&request.by(ContactEquation::new()), known.range);
        for branch in by_shooting.into_iter().chain(by_contact_equation) {
            all_found(&of_shooting(&branch), known.events, DIGITS);
        }
    }
}
