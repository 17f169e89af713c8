//! Walks that unknowns or steps lead astray.

use hertzian::structure::{Contact, DMatrix, Structure};
use hertzian::{ContactEquation, EventKind, FrequencyResponse, Shooting, Stop};

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

hertzian::oscillator! {
    /// Two masses of which one is pressed against a contact that is damped as it is deformed.
    Pressed(x, y) {
        law contact(gap) { gap > 0 => (1.3e10*gap^1.5)*(1 + 990*dot(gap)), else => 0 }
        61.7*ddot(x) + 521*dot(x) + 1.37e6*x + 3.47e5*(x - y) + 96.7*(dot(x) - dot(y)) = 2.42*cos(omega*t) + 0.664;
        38.2*ddot(y) + 500*dot(y) + 1.26e6*y + 3.47e5*(y - x) + 96.7*(dot(y) - dot(x)) + contact(y + 3.88e-7) = 0;
    }
}

/// Where a gap has come to open, another extreme of it is nearer to its level, and more nodes are asked for: the switches around that one are not
/// there at the orbit before. The touch between both is found from either end, and is that of shooting.
#[test]
fn touches_are_seen_where_more_nodes_are_asked_for() {
    let touches = |branch: hertzian::Branch| {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        assert!(branch.turns.is_empty(), "{:?}", branch.turns);
        let events = branch.events.iter();
        let mut found: Vec<_> = events
            .map(|event| (event.point.value, event.error))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    };
    let request = FrequencyResponse::of(&Pressed {});
    let [low, high] = [88.0, 153.5];
    let known = touches(
        request
            .clone()
            .from(low)
            .to(high)
            .by(Shooting::new())
            .run()
            .unwrap(),
    );
    assert_eq!(known.len(), 9);
    for [from, to] in [[low, high], [high, low]] {
        let contact = request.clone().from(from).to(to).by(ContactEquation::new());
        let found = touches(contact.run().unwrap());
        assert_eq!(found.len(), known.len(), "{found:?}");
        for (found, known) in found.iter().zip(&known) {
            let apart = (found.0 - known.0).abs();
            assert!(
                apart <= found.1 + known.1 && found.1 < 1e-7,
                "{found:?} {known:?}"
            );
        }
    }
}
