//! Curves of grazing in two parameters, and points of codimension two on curves of doublings.

use hertzian::flow::shooting::SpecialKind;
use hertzian::{EventKind, Shooting};
use hertzian_tests::OneSidedLinear;

/// Drive and frequency stay in contact as long as the linear motion does not reach zero: `A^2 = W^2 ((1 - omega^2)^2 +
/// (2 zeta omega)^2)`.
#[test]
fn a_linear_contact_is_lost_on_a_known_curve() {
    let (zeta, load) = (0.032, 1.0);
    let model = OneSidedLinear {
        zeta,
        load,
        drive: 0.2,
    };
    let shooting = Shooting::of(&model).from(1.2).to(0.95);
    let branch = shooting.clone().run().unwrap();
    let grazing = branch
        .events(EventKind::Grazing { turns: false })
        .next()
        .unwrap();
    let track = shooting.track(grazing, "drive", [0.07, 0.4]).unwrap();
    assert!(track.points.len() > 10, "{:?}", track.ends);
    for point in &track.points {
        let [omega, drive] = point.values;
        let square = (1.0 - omega * omega).powi(2) + (2.0 * zeta * omega).powi(2);
        let error = (drive - load * square.sqrt()).abs();
        assert!(error < 1e-10, "{omega} {drive} {error:.1e}");
    }
}

hertzian::oscillator! {
    /// Beside a driven oscillator, one whose stiffness varies. The tongue of the linear part does not know of `bend`, and the branch
    /// that begins at its edge bends with the sign of it.
    Bending(x, y) {
        param k;
        param bend;
        ddot(x) + 0.1*dot(x) + x = 0.1*cos(omega*t);
        ddot(y) + 0.02*dot(y) + (k + 0.05*cos(omega*t))*y + bend*y^3 + y^5 = 0;
    }
}

#[test]
fn a_doubling_is_degenerate_where_its_cubic_term_vanishes() {
    let model = Bending { k: 0.2, bend: -0.7 };
    let shooting = Shooting::of(&model).vary("k").omega(1.0).from(0.2).to(0.3);
    let branch = shooting.run().unwrap();
    let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let track = shooting.track(doubling, "bend", [-1.0, 1.0]).unwrap();
    let [special] = &track.special[..] else {
        panic!("{:?}", track.special);
    };
    assert_eq!(special.kind, SpecialKind::Degenerate);
    let error = (special.values[0] - doubling.cycle.value)
        .abs()
        .max(special.values[1].abs());
    assert!(
        error < 1e-5 && error <= special.error,
        "{special:?} {error:.1e}"
    );
}

hertzian::oscillator! {
    /// Two oscillators whose stiffness varies: two tongues.
    Tongues(x, y, z) {
        param k;
        param p;
        ddot(x) + 0.1*dot(x) + x = 0.1*cos(omega*t);
        ddot(y) + 0.02*dot(y) + (k + 0.05*cos(omega*t))*y + y^3 = 0;
        ddot(z) + 0.02*dot(z) + (p + 0.05*cos(omega*t))*z + z^3 = 0;
    }
}

/// Both are alike, so that both multipliers are minus one where both parameters are.
#[test]
fn two_multipliers_are_minus_one_at_once() {
    let model = Tongues { k: 0.2, p: 0.2 };
    let shooting = Shooting::of(&model).vary("k").omega(1.0).from(0.2).to(0.3);
    let branch = shooting.run().unwrap();
    let edges: Vec<_> = branch.events(EventKind::PeriodDoubling).collect();
    let [low, high] = edges[..] else {
        panic!("{:?}", branch.events);
    };
    let track = shooting.track(low, "p", [0.15, 0.3]).unwrap();
    let doubles = track
        .special
        .iter()
        .filter(|s| s.kind == SpecialKind::Double);
    let found: Vec<_> = doubles.collect();
    assert_eq!(found.len(), 2, "{:?}", track.special);
    for (special, edge) in found.into_iter().zip([low, high]) {
        let values = [low.cycle.value, edge.cycle.value];
        for (found, expected) in special.values.into_iter().zip(values) {
            let error = (found - expected).abs();
            assert!(error < 1e-6, "{special:?} {error:.1e}");
        }
    }
}
