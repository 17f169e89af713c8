//! Walks that unknowns or steps lead astray.

use hertzian::structure::{Contact, DMatrix, Structure};
use hertzian::{ContactEquation, EventKind, FrequencyResponse, Stop};

hertzian::law! {
    /// Elastic stop
    pub Elastic(gap, k) { gap > 0 => k*gap, else => 0 }
}

/// Four masses in a row of which three meet stops, each at one side.
fn three_stops() -> Structure {
    let masses = 4;
    let stiffness = DMatrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 if i == 0 => 1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let damping = 0.062 * &stiffness;
    let structure = Structure::of(&DMatrix::identity(masses, masses), &damping, &stiffness);
    let mut structure = structure.cosine(masses - 1, 1, 0.21);
    let stops = [(1.0, 2.4, 0.85), (1.0, 4.8, 0.74), (-1.0, 5.0, 0.56)];
    for (place, (side, stiffness, distance)) in stops.into_iter().enumerate() {
        let mut direction = vec![0.0; masses];
        direction[place] = side;
        structure = structure.contact(
            Contact::new(Elastic)
                .arguments([stiffness])
                .direction(direction)
                .offset(distance),
        );
    }
    structure.build().unwrap()
}

/// Where branches cross a multiplier is one. At 0.4274233 the extreme of a gap that does not touch moves fast, from one place where the gap is almost
/// straight to another, and nothing happens.
#[test]
fn branches_cross_where_a_multiplier_is_one() {
    let stops = three_stops();
    let request = FrequencyResponse::of(&stops).by(ContactEquation::new());
    let branch = request.from(0.25).to(1.1).run().unwrap();
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    let beside = |value: f64| (value - 0.427_423_3).abs() < 1e-6;
    assert!(!branch.turns.iter().any(|turn| beside(turn.value)));
    assert!(!branch.events.iter().any(|event| beside(event.point.value)));
    for event in branch.events(EventKind::BranchPoint) {
        let multipliers = event.point.stability.multipliers.iter();
        let nearest = multipliers.map(|m| (m - 1.0).norm());
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-3, "{event}: {nearest}");
    }
}
