//! Two masses, of which one meets an elastic stop: example 03 of `NLvib` (Krack and Gross 2019).
//!
//! Every piece is affine, so the motions of shooting have closed forms, and its events are exact to rounding.

use hertzian::EventKind::{Fold, NeimarkSacker, PeriodDoubling};
use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting, Stop};
use hertzian_tests::TwoMasses;

use super::{all_found, all_found_or_touched, from_either_end, of_shooting};

const MODEL: TwoMasses = TwoMasses {
    stop: 100.0,
    drive: 0.1,
};
const RANGE: [f64; 2] = [0.57, 0.77];

/// Event-driven shooting with the exact flow, in extended precision.
const EVENTS: [(EventKind, f64); 6] = [
    (NeimarkSacker, 0.581_900_650_364_619_4),
    (NeimarkSacker, 0.618_606_874_267_020_4),
    (PeriodDoubling, 0.738_783_025_373_251_7),
    (PeriodDoubling, 0.755_586_159_356_174_7),
    (Fold, 0.755_627_352_609_068_3),
    (Fold, 0.653_440_134_548_891_6),
];
/// Where the motion without contact touches the stop.
const TOUCHES: [f64; 2] = [0.581_899_639_039_3, 0.653_440_140_416_3];

#[test]
fn every_event_is_found_from_either_end() {
    let request = FrequencyResponse::of(&MODEL);
    for branch in from_either_end(&request.clone().by(ContactEquation::new()), RANGE) {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        all_found_or_touched(&of_shooting(&branch), &EVENTS, 1e-15);
    }
    for branch in from_either_end(&request.by(Shooting::new()), RANGE) {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let found = of_shooting(&branch);
        all_found(&found, &EVENTS, 1e-15);
        let touches = TOUCHES.map(|value| (EventKind::Grazing { turns: false }, value));
        all_found(&found, &touches, 1e-12);
        assert_eq!(found.len(), EVENTS.len() + TOUCHES.len(), "{found:#?}");
    }
}
