//! Two events of a kind within one step, beside the touch of a level from which multipliers go as a root: the branch is one whichever way it is
//! followed, by whatever method.

use hertzian::structure::{Contact, DMatrix, Structure};
use hertzian::{Branch, ContactEquation, EventKind, FrequencyResponse, Shooting, System};

use crate::bifurcations::limbs::agrees;

hertzian::law! {
    /// Elastic stop
    pub Elastic(gap, k) { gap > 0 => k*gap, else => 0 }
}

hertzian::oscillator! {
    /// Gears whose stiffness changes with the mesh, with an error of their teeth
    Gears(x) {
        law mesh(gap) { gap > 1.2 => gap - 1.2, -1.2 <= gap <= 1.2 => 0, gap < -1.2 => gap + 1.2 }
        ddot(x) + 0.056*dot(x) + (1 + 0.37*cos(omega*t))*mesh(x) = 0.11 + 0.27*omega^2*cos(omega*t);
    }
}

/// Masses in a row, the first of which is held, with stops of a mass: its number, the side, stiffness and distance.
pub fn chain(masses: usize, ratio: f64, drive: f64, stops: &[(usize, f64, f64, f64)]) -> Structure {
    let stiffness = DMatrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 if i == 0 => 1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let damping = ratio * &stiffness;
    let structure = Structure::of(&DMatrix::identity(masses, masses), &damping, &stiffness);
    let mut structure = structure.cosine(masses - 1, 1, drive);
    for &(mass, side, stiffness, distance) in stops {
        let mut direction = vec![0.0; masses];
        direction[mass] = side;
        let contact = Contact::new(Elastic).arguments([stiffness]);
        structure = structure.contact(contact.direction(direction).offset(distance));
    }
    structure.build().unwrap()
}

/// Places of a kind of event between two values, in their order.
fn places(branch: &Branch, kind: EventKind, [from, to]: [f64; 2]) -> Vec<(f64, f64)> {
    let events = branch.events(kind).filter(|event| {
        let value = event.point.value;
        value > from && value < to
    });
    let mut found: Vec<_> = events
        .map(|event| (event.point.value, event.error))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Both methods in both directions find these places.
fn finds(system: &dyn System, [from, to]: [f64; 2], kind: EventKind, wanted: [f64; 2]) {
    let between = [wanted[0] - 1e-5, wanted[1] + 1e-5];
    for ends in [[from, to], [to, from]] {
        let request = FrequencyResponse::of(system).from(ends[0]).to(ends[1]);
        let by_contact_equation = request.clone().by(ContactEquation::new()).run().unwrap();
        let by_shooting = request.by(Shooting::new()).run().unwrap();
        let [one, other] =
            [&by_contact_equation, &by_shooting].map(|branch| places(branch, kind, between));
        assert_eq!(
            (one.len(), other.len()),
            (2, 2),
            "{ends:?}: {one:?} {other:?}"
        );
        for ((one, other), wanted) in one.iter().zip(&other).zip(wanted) {
            let off = (one.0 - other.0).abs();
            assert!(off <= 3.0 * (one.1 + other.1) + 1e-14, "{ends:?}: {off:e}");
            assert!((one.0 - wanted).abs() < 1e-7, "{ends:?}: {}", one.0);
        }
    }
}

/// Backwards a step passes both doublings and the touch at 0.6353; what doubles twice falls steeply to the touch and rises slowly from there.
#[test]
fn doublings_of_a_gear() {
    let places = [0.636_391_4, 0.640_926_5];
    finds(&Gears {}, [0.4, 2.3], EventKind::PeriodDoubling, places);
}

/// The multiplier rises from 0.2 at the touch at 0.31967 to more than one and is 0.44 at the end of the step.
#[test]
fn broken_symmetry_between_two_stops() {
    let stops = [(2, 1.0, 8.6, 0.69), (2, -1.0, 8.6, 0.69)];
    let structure = chain(3, 0.089, 0.43, &stops);
    let places = [0.320_833_1, 0.321_179_3];
    finds(&structure, [0.3, 0.36], EventKind::SymmetryBreaking, places);
}

/// A pair of multipliers leaves the unit circle and comes back, while a gap that is nearly straight there touches its level.
#[test]
fn motions_of_two_frequencies_between_two_stops() {
    let stops = [(2, 1.0, 26.0, 0.86), (2, -1.0, 26.0, 0.86)];
    let structure = chain(3, 0.022, 0.31, &stops);
    let places = [0.427_31, 0.433_07];
    let kind = EventKind::NeimarkSacker;
    let request = FrequencyResponse::of(&structure);
    let mut found = Vec::new();
    for ends in [[0.3, 1.3], [1.3, 0.3]] {
        let request = request.clone().from(ends[0]).to(ends[1]);
        let branch = request.by(Shooting::new()).run().unwrap();
        for place in places {
            let near = self::places(&branch, kind, [place - 2e-5, place + 2e-5]);
            assert_eq!(near.len(), 1, "{ends:?} {place}: {near:?}");
            found.extend(near);
        }
    }
    for (forwards, backwards) in found[..2].iter().zip(&found[2..]) {
        let off = (forwards.0 - backwards.0).abs();
        assert!(off <= 3.0 * (forwards.1 + backwards.1) + 1e-14, "{off:e}");
    }
}

/// Forwards a step of the contact equation passes the touch at 0.42773, from which switches go as a root: an orbit beside it is found from those
/// farther behind alone.
#[test]
fn doublings_of_four_masses() {
    let stops = [
        (0, 1.0, 2.4, 0.85),
        (1, 1.0, 4.8, 0.74),
        (2, -1.0, 5.0, 0.56),
    ];
    let places = [0.427_795_747, 0.427_835_355];
    let system = chain(4, 0.062, 0.21, &stops);
    finds(&system, [0.25, 1.1], EventKind::PeriodDoubling, places);
}

/// Forwards a step of shooting passes the touch at 0.41762 and both tori. The branch bends by more than a right angle in it.
#[test]
fn tori_of_four_masses() {
    let stops = [
        (0, 1.0, 27.0, 0.65),
        (1, 1.0, 6.1, 0.98),
        (2, 1.0, 9.0, 0.58),
    ];
    let places = [0.417_752_813, 0.420_654_598];
    let system = chain(4, 0.029, 0.058, &stops);
    finds(&system, [0.25, 1.1], EventKind::NeimarkSacker, places);
}

/// Between a fold at 0.336728985 and a touch at 0.33672986 a pair leaves the unit circle. Values next to the fold differ by less than that is away, when
/// orbits do not.
#[test]
fn a_torus_beside_a_fold() {
    let system = chain(
        2,
        0.035,
        0.44,
        &[(0, 1.0, 75.0, 0.47), (0, -1.0, 75.0, 0.47)],
    );
    let request = FrequencyResponse::of(&system).from(0.3).to(1.3);
    let by_contact_equation = request.clone().by(ContactEquation::new()).run().unwrap();
    let by_shooting = request.by(Shooting::new()).run().unwrap();
    for branch in [by_contact_equation, by_shooting] {
        let found = places(&branch, EventKind::NeimarkSacker, [0.3367, 0.3368]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            (found[0].0 - 0.336_729_050_726_9).abs() < 1e-12,
            "{found:?}"
        );
    }
}

hertzian::oscillator! {
    /// Before a ball with the damping of Hunt and Crossley (1975) that does not pull.
    Pressed(x) {
        param drive;
        law stop(gap) { gap > 0 => max(0, 20*gap^1.5*(1 + 0.8*dot(gap))), else => 0 }
        ddot(x) + 0.04*dot(x) + x + stop(x - 0.6) = drive*cos(omega*t);
    }
}

/// Six doublings, of which shooting downwards has three in one step, with a touch at 0.48833: one before it and two behind.
#[test]
fn three_doublings_within_one_step_are_found() {
    let system = Pressed { drive: 0.6801 };
    agrees(&system, [0.4, 2.2]);
    let request = FrequencyResponse::of(&system).from(2.2).to(0.4);
    let branch = request.by(Shooting::new()).run().unwrap();
    assert_eq!(branch.events(EventKind::PeriodDoubling).count(), 6);
}

hertzian::oscillator! {
    /// A spring of two stiffnesses.
    Bilinear(x) {
        law spring(gap) { gap > 0 => 9*gap, else => gap }
        ddot(x) + 0.08*dot(x) + spring(x) = 0.5005*cos(omega*t) + 0.4;
    }
}

/// Downwards two doublings, at 0.58853 and 0.58630, are in the step behind the one with the touch at 0.58918, and the contact equation goes over to other unknowns
/// between them.
#[test]
fn two_doublings_behind_a_touch_and_other_unknowns_are_found() {
    let system = Bilinear {};
    agrees(&system, [0.58, 0.68]);
    let request = FrequencyResponse::of(&system).from(0.68).to(0.58);
    let branch = request.by(ContactEquation::new()).run().unwrap();
    assert_eq!(branch.events(EventKind::PeriodDoubling).count(), 4);
}
