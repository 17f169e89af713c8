//! Touches of a level with forces on both sides of it: where the short stretch between two switches disappears, those before and after it
//! meet, and their nodes have moved as the root of its length.

use super::events_agree;
use crate::FrequencyResponse;

crate::oscillator! {
    /// A spring that hardens to both sides, with an exponent of which nothing is known.
    Hardening(x) {
        param alpha > 0;
        param damping;
        param drive;
        param load;
        law spring(gap) { gap > 0 => gap^alpha, else => -(-gap)^alpha }
        ddot(x) + damping*dot(x) + spring(x) = drive*cos(omega*t) + load;
    }
}

/// With panels beside the touch, from either end, for exponents near one and beyond two: every event is that of shooting, and nothing is left
/// that could not be located.
#[test]
fn both_stretches_beside_a_touch_are_carried_over_it() {
    let models = [
        [1.2, 0.02, 0.05, 1.0],
        [1.5, 0.064, 0.3, 1.0],
        [1.8, 0.02, 0.05, 1.0],
        [2.2, 0.02, 0.3, 1.0],
        [3.0, 0.02, 0.1, 0.3],
        [3.0, 0.02, 0.3, 1.0],
    ];
    for [alpha, damping, drive, load] in models {
        let model = Hardening {
            alpha,
            damping,
            drive,
            load,
        };
        for [from, to] in [[0.6, 1.6], [1.6, 0.6]] {
            events_agree(&FrequencyResponse::of(&model).from(from).to(to));
        }
    }
}
