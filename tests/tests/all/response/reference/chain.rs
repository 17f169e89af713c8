//! A chain of sixteen masses, of which the first meets an elastic stop.
//!
//! Every piece is affine, so the motions of shooting have closed forms. Five events lie within 2e-8 of the two touches of the motion without
//! contact; there the touch stands for what happens beside it.

use hertzian::EventKind::{Fold, NeimarkSacker, PeriodDoubling};
use hertzian::structure::{Contact, DMatrix, Structure, parameter};
use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting, Stop};

use super::{all_found, from_either_end, of_shooting};

hertzian::law! {
    /// Elastic stop
    pub Elastic(gap, k) { gap > 0 => k*gap, else => 0 }
}

const MASSES: usize = 16;
const RANGE: [f64; 2] = [0.275, 0.298];

/// Event-driven shooting with the exact flow, and the times of events as unknowns with exponentials of 75 digits.
const EVENTS: [(EventKind, f64); 5] = [
    (PeriodDoubling, 0.286_049_604_250_05),
    (PeriodDoubling, 0.290_383_700_953_46),
    (NeimarkSacker, 0.291_566_278_197_79),
    (Fold, 0.294_706_123_875_18),
    (NeimarkSacker, 0.293_248_179_016_59),
];
/// Where the motion without contact touches the stop.
const TOUCHES: [f64; 2] = [0.278_801_939_441_4, 0.290_444_359_679_4];

fn chain() -> Structure {
    let stiffness = DMatrix::from_fn(MASSES, MASSES, |i, j| match i.abs_diff(j) {
        0 if i == 0 => 1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let damping = 0.03 * &stiffness;
    let mut first = vec![0.0; MASSES];
    first[0] = 1.0;
    Structure::of(&DMatrix::identity(MASSES, MASSES), &damping, &stiffness)
        .cosine(MASSES - 1, 1, parameter("drive", 0.1))
        .contact(
            Contact::new(Elastic)
                .arguments([parameter("k", 100.0)])
                .direction(first)
                .offset(parameter("distance", 1.0)),
        )
        .build()
        .unwrap()
}

#[test]
fn every_event_is_found_from_either_end() {
    let chain = chain();
    let request = FrequencyResponse::of(&chain);
    let by_shooting = from_either_end(&request.clone().by(Shooting::new()), RANGE);
    let by_contact_equation = from_either_end(&request.by(ContactEquation::new()), RANGE);
    for branch in by_shooting.into_iter().chain(by_contact_equation) {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let found = of_shooting(&branch);
        all_found(&found, &EVENTS, 1e-13);
        for touch in TOUCHES {
            let near = found
                .iter()
                .find(|event| (event.value - touch).abs() < 2e-8);
            assert!(near.is_some(), "{touch} is missing among {found:#?}");
        }
    }
}
