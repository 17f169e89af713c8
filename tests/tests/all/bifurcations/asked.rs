//! What is asked of shooting, and cannot be; and what is no bifurcation.

use hertzian::{Error, EventKind, FrequencyResponse, OrbitError, RequestError, Shooting, Side};
use hertzian_tests::TwoMasses;

use crate::bifurcations::cascade::MODEL;

hertzian::oscillator! {
    /// Nothing takes energy away.
    Undamped(x) {
        param drive;
        ddot(x) + x + x^3 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// A loaded contact that is not in closed form.
    Contact(x) {
        param drive;
        law contact(gap) { gap > 0 => 0.1*dot(gap) + gap^1.5, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

/// Areas are kept all along the branch: that is no torus.
#[test]
fn without_damping_there_is_no_neimark_sacker_bifurcation() {
    let model = Undamped { drive: 0.1 };
    let branch = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(0.3)
        .to(0.9)
        .run()
        .unwrap();
    assert!(branch.points.len() > 10);
    let tori = branch.events(EventKind::NeimarkSacker).count();
    let omitted = branch.turns.iter();
    assert_eq!(tori, 0);
    assert!(
        omitted
            .clone()
            .all(|turn| turn.kind != EventKind::NeimarkSacker)
    );
}

/// Twice the period of an orbit is not its period, however coarse the flow.
#[test]
fn a_shorter_period_is_recognised_at_any_tolerance() {
    let model = Contact { drive: 0.1 };
    for tolerance in [1e-3, 1e-4, 1e-8] {
        let request = FrequencyResponse::of(&model).by(Shooting::new().tolerance(tolerance));
        let orbit = request.orbit(1.5).unwrap();
        let twice = request.near_orbit(&orbit.orbit).period(2).orbit(1.5);
        let error = twice.expect_err("an orbit of period one");
        assert!(
            matches!(
                error.downcast_ref(),
                Some(OrbitError::NoSuchPeriod { period: 2, .. })
            ),
            "{tolerance}: {error:?}"
        );
    }
}

/// The doubling at a drive of 1.28, given where the frequency varies, and to other systems.
#[test]
fn an_event_belongs_to_what_is_varied() {
    let request = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let branch = request.from(1.0).to(1.4).run().unwrap();
    let event = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let over_omega = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .from(0.4)
        .to(2.0);
    let varied = |error: Error| matches!(error.downcast_ref(), Some(RequestError::Varied { .. }));
    assert!(varied(over_omega.switch(event, Side::One).unwrap_err()));
    assert!(varied(over_omega.complete(&event.point).unwrap_err()));
    assert!(varied(
        over_omega.track(event, "drive", [1.0, 2.0]).unwrap_err()
    ));
    let masses = TwoMasses {
        stop: 1.0,
        drive: 0.1,
    };
    let another = FrequencyResponse::of(&masses)
        .by(Shooting::new())
        .from(0.4)
        .to(2.0);
    let state = |error: Error| {
        matches!(
            error.downcast_ref(),
            Some(RequestError::State {
                entries: 2,
                expected: 4
            })
        )
    };
    assert!(state(another.switch(event, Side::One).unwrap_err()));
    assert!(state(another.complete(&event.point).unwrap_err()));
    let faster = FrequencyResponse::of(&MODEL)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.1);
    let faster = faster.from(1.0).to(1.4);
    let omega = |error: Error| {
        matches!(
            error.downcast_ref(),
            Some(RequestError::Option { name: "omega", .. })
        )
    };
    assert!(omega(faster.complete(&event.point).unwrap_err()));
    let heavier = hertzian_tests::OneSidedLinear { load: 1.1, ..MODEL };
    let heavier = FrequencyResponse::of(&heavier)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let load = |error: Error| matches!(error.downcast_ref(), Some(RequestError::Parameter { name, .. }) if name == "load");
    assert!(load(heavier.complete(&event.point).unwrap_err()));
    let contact = Contact { drive: 1.0 };
    let another = FrequencyResponse::of(&contact)
        .by(Shooting::new())
        .vary("drive")
        .omega(1.0);
    let another = another.from(1.0).to(1.4);
    let values = |error: Error| {
        matches!(
            error.downcast_ref(),
            Some(RequestError::Values { expected: 1, .. })
        )
    };
    assert!(values(another.switch(event, Side::One).unwrap_err()));
    assert!(values(another.complete(&event.point).unwrap_err()));
    assert!(values(
        another.track(event, "omega", [0.9, 1.1]).unwrap_err()
    ));
}

#[test]
fn a_branch_goes_through_values_of_its_range() {
    let model = Contact { drive: 0.1 };
    let request = FrequencyResponse::of(&model)
        .by(Shooting::new())
        .from(1.4)
        .to(1.6);
    for value in [1.3, f64::NAN] {
        let error = request.through(value).unwrap_err();
        assert!(
            matches!(
                error.downcast_ref(),
                Some(RequestError::Option {
                    name: "through",
                    ..
                })
            ),
            "{error}"
        );
    }
}
