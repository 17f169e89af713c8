//! Two masses, of which one meets an elastic stop: example 03 of `NLvib` (Krack and Gross 2019).
//!
//! Every piece is affine, so the motions of shooting have closed forms, and its events are exact to rounding.

use hertzian::{ContactEquation, FrequencyResponse, Shooting};
use hertzian_tests::TwoMasses;
use hertzian_tests::reference::Case;

use super::from_either_end;

const MODEL: TwoMasses = TwoMasses {
    stop: 100.0,
    drive: 0.1,
};
const RANGE: [f64; 2] = [0.57, 0.77];

#[test]
fn every_event_is_found_from_either_end() {
    let case = Case::of("A");
    let request = FrequencyResponse::of(&MODEL);
    for branch in from_either_end(&request.clone().by(ContactEquation::new()), RANGE) {
        case.assert_events(&branch, 1e-15, 0);
    }
    for branch in from_either_end(&request.by(Shooting::new()), RANGE) {
        case.assert_events(&branch, 1e-15, 0);
        // None is one with a touch.
        let known = case.events.len() + case.touches.len();
        assert_eq!(branch.events.len(), known);
    }
}
