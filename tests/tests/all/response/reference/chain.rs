//! A chain of sixteen masses, of which the first meets an elastic stop.
//!
//! Every piece is affine, so the motions of shooting have closed forms. Five events lie within 2e-8 of the two touches of the motion without
//! contact; there the touch stands for what happens beside it.

use hertzian::structure::{Contact, DMatrix, Structure, parameter};
use hertzian::{ContactEquation, FrequencyResponse, Shooting};
use hertzian_tests::reference::Case;

use super::from_either_end;

hertzian::law! {
    /// Elastic stop
    pub Elastic(gap, k) { gap > 0 => k*gap, else => 0 }
}

const MASSES: usize = 16;
const RANGE: [f64; 2] = [0.275, 0.298];

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
    let case = Case::of("C");
    let chain = chain();
    let request = FrequencyResponse::of(&chain);
    let by_shooting = from_either_end(&request.clone().by(Shooting::new()), RANGE);
    let by_contact_equation = from_either_end(&request.by(ContactEquation::new()), RANGE);
    for branch in by_shooting.into_iter().chain(by_contact_equation) {
        case.assert_events(&branch, 1e-13, 0);
    }
}
