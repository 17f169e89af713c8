//! Two masses, a chain and a beam, each with a stop, from their entries: every event and orbit that other programs found, and no event
//! besides.

use hertzian::{Branch, ContactEquation, FrequencyResponse, OrbitMethod, Shooting};
use hertzian_structure::{Damping, Direction, Reduction, SparseMatrix, SparseStructure};
use hertzian_tests::reference::{Accuracy, Case};

use crate::common::{beam, stopped};

/// The branch of a structure of which all modes are kept, from the first frequency to the second.
fn branch<M: OrbitMethod>(structure: &SparseStructure, by: M, [from, to]: [f64; 2]) -> Branch {
    let all = structure.coordinates();
    let reduction = Reduction::to(from.max(to)).modes(all).steps(0);
    let reduced = reduction.run(structure).unwrap();
    assert_eq!(reduced.vectors(), all);
    let model = reduced.structure(structure).unwrap();
    let request = FrequencyResponse::of(&model).by(by);
    let request = request.accuracy_of("stopped").from(from).to(to);
    request.run().unwrap()
}

/// From either end of a range, by both methods.
fn branches(structure: &SparseStructure, [low, high]: [f64; 2]) -> impl Iterator<Item = Branch> {
    [[low, high], [high, low]].into_iter().flat_map(|range| {
        [
            branch(structure, Shooting::new(), range),
            branch(structure, ContactEquation::new(), range),
        ]
    })
}

/// Masses in a row, the last held to the ground and driven, the first before a stop.
fn chain(masses: usize) -> SparseStructure {
    let springs = (0..masses).flat_map(|i| {
        let own = if i == 0 { 1.0 } else { 2.0 };
        let beside = (i > 0).then(|| [(i, i - 1, -1.0), (i - 1, i, -1.0)]);
        beside.into_iter().flatten().chain([(i, i, own)])
    });
    let stiffness = SparseMatrix::from_triplets(masses, masses, springs).unwrap();
    let ones = (0..masses).map(|i| (i, i, 1.0));
    let mass = SparseMatrix::from_triplets(masses, masses, ones).unwrap();
    let damped = SparseStructure::new(mass, stiffness).damping(Damping::Rayleigh {
        mass: 0.0,
        stiffness: 0.03,
    });
    stopped(damped, 0.1, 100.0, 1.0, [masses - 1, 0])
}

const ACCURACY: Accuracy = Accuracy {
    of_peaks: 1e-9,
    of_multipliers: 1e-9,
};

#[test]
fn two_masses() {
    let case = Case::of("A");
    let structure = chain(2)
        .output("x1", Direction::at(0))
        .output("x2", Direction::at(1));
    for branch in branches(&structure, [0.57, 0.77]) {
        case.assert_events(&branch, 1e-9, 0);
        case.assert_orbits(&branch, &["stop"], ACCURACY);
    }
}

/// By shooting from one end alone, which takes five times as long.
#[test]
fn sixteen_masses() {
    let case = Case::of("C");
    let structure = chain(16)
        .output("x0", Direction::at(0))
        .output("x15", Direction::at(15));
    let (low, high) = (0.275, 0.298);
    let by_contact_equation = [[low, high], [high, low]];
    let by_contact_equation =
        by_contact_equation.map(|range| branch(&structure, ContactEquation::new(), range));
    let by_shooting = branch(&structure, Shooting::new(), [low, high]);
    for branch in by_contact_equation.into_iter().chain([by_shooting]) {
        case.assert_events(&branch, 1e-9, 0);
        case.assert_orbits(&branch, &["stop"], ACCURACY);
    }
}

/// The whole range of the first resonance, and the part of it that is followed by default.
const RANGE: [f64; 2] = [3.3, 4.5];
const PART: [f64; 2] = [3.3, 3.73];

fn ten_elements() -> SparseStructure {
    let structure = beam(10).damping(Damping::ratio(0.01));
    stopped(structure, 0.03, 50.0, 0.1, [18, 18])
        .output("tip", Direction::at(18))
        .output("mid", Direction::at(8))
}

/// Between two grazings the stop is met twice in a period: they are not among the events that are known, the four switches of the orbits between
/// are.
const GRAZINGS: usize = 2;

/// What is known of the branch as far as it leaves the part: it comes back into it later.
fn on_the_part() -> Case {
    let mut case = Case::of("B1").within(PART);
    case.events.truncate(3);
    case.touches.truncate(1);
    case
}

#[test]
fn a_beam_of_ten_elements() {
    let by = Shooting::new();
    let branch = branch(&ten_elements(), by, PART);
    let case = on_the_part();
    case.assert_events(&branch, 3e-9 * PART[1], GRAZINGS);
    case.assert_orbits(&branch, &["stop"], ACCURACY);
}

/// `HERTZIAN_BEAM=1` follows the whole range, from either end by both methods: minutes each.
#[test]
fn the_whole_resonance_of_a_beam() {
    if std::env::var_os("HERTZIAN_BEAM").is_none() {
        return;
    }
    let case = Case::of("B1").within(RANGE);
    for branch in branches(&ten_elements(), RANGE) {
        case.assert_events(&branch, 3e-9 * RANGE[0], GRAZINGS);
        case.assert_orbits(&branch, &["stop"], ACCURACY);
    }
}
