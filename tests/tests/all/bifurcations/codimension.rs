//! Curves of grazing in two parameters, and points of codimension two on curves of doublings.

use hertzian::shooting::SpecialKind;
use hertzian::{Event, EventKind, FrequencyResponse, Shooting, Side};
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
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(1.2)
        .to(0.95);
    let branch = shooting.clone().run().unwrap();
    let grazing = branch
        .events(EventKind::Grazing { turns: false })
        .next()
        .unwrap();
    let track = shooting.track(grazing, "drive", [0.07, 0.4]).unwrap();
    assert!(track.points.len() > 10, "{:?}", track.ends);
    for (&[omega, drive], point) in track.values.iter().zip(&track.points) {
        let square = (1.0 - omega * omega).powi(2) + (2.0 * zeta * omega).powi(2);
        let error = (drive - load * square.sqrt()).abs();
        assert!(error < 1e-10, "{omega} {drive} {error:.1e}");
        // The least position is that of the contact, and the mean is the load.
        let size = point.peak_to_peak();
        assert!((size - 2.0 * load).abs() < 1e-8, "{omega} {size}");
        assert_eq!((point.omega(), point.value), (omega, omega));
    }
}

hertzian::oscillator! {
    /// Beside a driven oscillator, one whose stiffness varies. The tongue of the linear part does not know of `bend`, and the branch
    /// that begins at its edge bends with the sign of it.
    pub Bending(x, y) {
        param k;
        param bend;
        ddot(x) + 0.1*dot(x) + x = 0.1*cos(omega*t);
        ddot(y) + 0.02*dot(y) + (k + 0.05*cos(omega*t))*y + bend*y^3 + y^5 = 0;
    }
}

#[test]
fn a_doubling_is_degenerate_where_its_cubic_term_vanishes() {
    let model = Bending { k: 0.2, bend: -0.7 };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("k")
        .omega(1.0)
        .from(0.2)
        .to(0.3);
    let branch = shooting.run().unwrap();
    let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let track = shooting.track(doubling, "bend", [-1.0, 1.0]).unwrap();
    let [special] = &track.special[..] else {
        panic!("{:?}", track.special);
    };
    assert_eq!(special.kind, SpecialKind::Degenerate);
    let error = (special.values[0] - doubling.point.value)
        .abs()
        .max(special.values[1].abs());
    assert!(
        error < 1e-10 && error <= special.error,
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
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("k")
        .omega(1.0)
        .from(0.2)
        .to(0.3);
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
        let values = [low.point.value, edge.point.value];
        for (found, expected) in special.values.into_iter().zip(values) {
            let error = (found - expected).abs();
            assert!(error < 1e-6, "{special:?} {error:.1e}");
        }
    }
}

/// The doublings of period two at a frequency, near a drive.
fn doubling_of_period_2(omega: f64, drive: f64) -> Option<(OneSidedLinear, Event)> {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(omega);
    let first = shooting.clone().from(1.0).to(2.2).run().ok()?;
    let doubling = first.events(EventKind::PeriodDoubling).next()?;
    let branch = shooting
        .from(1.0)
        .to(2.4)
        .switch(doubling, Side::One)
        .ok()?;
    let doublings = branch.events(EventKind::PeriodDoubling).cloned();
    let near = |event: &Event| (event.point.value - drive).abs();
    let event = doublings.min_by(|a, b| near(a).total_cmp(&near(b)))?;
    Some((model, event))
}

/// Which way the branch of period four begins: towards larger drives or smaller ones, from orbits close by.
fn begins_upwards(omega: f64, drive: f64) -> bool {
    let (model, event) = doubling_of_period_2(omega, drive).unwrap();
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(omega);
    let value = event.point.value;
    let request = shooting
        .from(value - 0.01)
        .to(value + 0.01)
        .largest_step(1e-4);
    let branch = request.max_points(3).switch(&event, Side::One).unwrap();
    branch.points[0].value > value
}

/// On the curve of doublings of period two beside figure 8, with `A4`: a point where period four begins upwards on one side, as far as
/// orbits at a hundredth of the size say, and downwards on the other, and the end at a grazing orbit.
#[test]
fn a_doubling_of_period_two_is_degenerate() {
    let (model, event) = doubling_of_period_2(1.0, 1.531).unwrap();
    let shooting = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let request = shooting.from(1.0).to(2.4);
    let track = request.track(&event, "omega", [0.8, 1.2]).unwrap();
    let degenerate = track
        .special
        .iter()
        .filter(|s| s.kind == SpecialKind::Degenerate);
    let [special] = degenerate.collect::<Vec<_>>()[..] else {
        panic!("{:?}", track.special);
    };
    assert!(special.error < 1e-5, "{special:?}");
    let [drive, omega] = special.values;
    for (part, expected) in [(-1e-2, true), (1e-2, false)] {
        assert_eq!(begins_upwards(omega + part, drive), expected, "{special:?}");
    }
    assert!(track.special.iter().any(|s| s.kind == SpecialKind::Grazing));
}
