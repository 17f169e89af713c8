//! A cantilever of ten finite elements with an elastic stop at its tip.
//!
//! Its fastest oscillation is 1700 times as fast as its first one, and the motion follows the first few. Stiffnesses are exact in double precision; the
//! products with the inverse of the mass matrix are not, by `1e-16` of the squared fastest frequency, which moves the first resonance by some
//! `1e-10`.

use hertzian::structure::{Contact, DMatrix, Structure, assemble, parameter};
use hertzian::{ContactEquation, FrequencyResponse, Shooting};
use hertzian_tests::reference::Case;
use nalgebra::{Cholesky, SymmetricEigen};

use super::from_either_end;

hertzian::law! {
    /// Elastic stop
    pub Elastic(gap, k) { gap > 0 => k*gap, else => 0 }
}

const ELEMENTS: usize = 10;
const FREE: usize = 2 * ELEMENTS;
/// The whole range, and the part of it that is followed by default: the whole one takes half a minute of a processor each way.
const RANGE: [f64; 2] = [3.3, 4.5];
const PART: [f64; 2] = [3.3, 3.73];

/// Between two grazings the stop is met twice in a period: they are not among the events that are known, the four switches of the orbits between
/// are.
const GRAZINGS: usize = 2;

/// Mass and stiffness, clamped at the last node: deflection and slope of every node, from the tip on.
fn matrices() -> [DMatrix<f64>; 2] {
    let inertia = [
        156.0, 22.0, 54.0, -13.0, 22.0, 4.0, 13.0, -3.0, 54.0, 13.0, 156.0, -22.0, -13.0, -3.0,
        -22.0, 4.0,
    ];
    let bending = [
        12.0, 6.0, -12.0, 6.0, 6.0, 4.0, -6.0, 2.0, -12.0, -6.0, 12.0, -6.0, 6.0, 2.0, -6.0, 4.0,
    ];
    let per_length = ELEMENTS as f64;
    let slopes = |row: usize, column: usize| (row % 2 + column % 2) as i32;
    let whole = |entries: [f64; 16], factor: f64| {
        let entry =
            |row, column| factor * entries[4 * row + column] / per_length.powi(slopes(row, column));
        let element = DMatrix::from_fn(4, 4, entry);
        assemble(FREE, (0..ELEMENTS).map(|number| (2 * number, &element)))
    };
    let mass = whole(inertia, 1.0 / (420.0 * per_length));
    [mass, whole(bending, per_length.powi(3))]
}

/// The beam with a damping ratio of 0.01 in each of its modes.
fn beam() -> Structure {
    let [mass, stiffness] = matrices();
    let root = Cholesky::new(mass.clone()).unwrap().l();
    let inverse = root.clone().try_inverse().unwrap();
    let SymmetricEigen {
        eigenvalues,
        eigenvectors,
    } = SymmetricEigen::new(&inverse * &stiffness * inverse.transpose());
    let diagonal = DMatrix::from_diagonal(&eigenvalues.map(|square| 0.02 * square.sqrt()));
    let shapes = root * eigenvectors;
    let damping = &shapes * diagonal * shapes.transpose();
    let mut tip = vec![0.0; FREE];
    tip[0] = 1.0;
    Structure::of(&mass, &damping, &stiffness)
        .cosine(0, 1, parameter("drive", 0.03))
        .contact(
            Contact::new(Elastic)
                .arguments([parameter("k", 50.0)])
                .direction(tip)
                .offset(parameter("distance", 0.1)),
        )
        .build()
        .unwrap()
}

/// What is known of the branch as far as it leaves the part: it comes back into it later.
fn on_the_part() -> Case {
    let mut case = Case::of("B1").within(PART);
    case.events.truncate(3);
    case.touches.truncate(1);
    case
}

#[test]
fn two_folds_and_a_torus_of_the_second_impact_are_found() {
    let [from, to] = PART;
    let case = on_the_part();
    let beam = beam();
    let request = FrequencyResponse::of(&beam).from(from).to(to);
    let by_shooting = request.clone().by(Shooting::new()).run();
    let by_contact_equation = request.by(ContactEquation::new()).run();
    for branch in [by_shooting, by_contact_equation] {
        case.assert_events(&branch.unwrap(), 1e-9, GRAZINGS);
    }
}

/// `HERTZIAN_BEAM=1` follows the whole range, from either end.
#[test]
fn every_event_is_found_from_either_end() {
    if std::env::var_os("HERTZIAN_BEAM").is_none() {
        return;
    }
    let case = Case::of("B1").within(RANGE);
    let beam = beam();
    let request = FrequencyResponse::of(&beam);
    let by_shooting = from_either_end(&request.clone().by(Shooting::new()), RANGE);
    let by_contact_equation = from_either_end(&request.by(ContactEquation::new()), RANGE);
    for branch in by_shooting.into_iter().chain(by_contact_equation) {
        case.assert_events(&branch, 1e-9, GRAZINGS);
    }
}
