//! What is given besides the model: orbits, events, ranges and options.

use hertzian::{EventKind, FrequencyResponse, ModelError, RequestError, Side};

use crate::response::{Continuous, Linear, OneSided};

hertzian::oscillator! {
    /// Driven at one harmonic of the excitation.
    pub High(x) {
        ddot(x) + 0.1*dot(x) + x = cos(25*omega*t);
    }
}

hertzian::oscillator! {
    /// As `High`, not as high.
    pub Seventh(x) {
        ddot(x) + 0.1*dot(x) + x = cos(7*omega*t);
    }
}

hertzian::oscillator! {
    /// Damping of a narrow range.
    pub Narrow(x) {
        param zeta in 0.0..=0.0005;
        ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Masses in proportion.
    pub Proportional(x, y) {
        param a;
        param b;
        param c;
        a*ddot(x) + b*ddot(y) + 0.1*dot(x) + x = cos(omega*t);
        b*ddot(x) + c*ddot(y) + 0.1*dot(y) + y = 0;
    }
}

/// Amplitude of `x'' + c x' + x = cos(w t)`.
fn amplitude(c: f64, w: f64) -> f64 {
    1.0 / (1.0 - w * w).hypot(c * w)
}

/// Harmonics that were not given follow the excitation.
#[test]
fn harmonics_are_enough_for_the_excitation() {
    let high = FrequencyResponse::of(&High {}).orbit(0.05).unwrap();
    let exact = 2.0 * amplitude(0.1, 25.0 * 0.05);
    assert!((high.peak_to_peak() / exact - 1.0).abs() < 1e-9);
    let request = FrequencyResponse::of(&Seventh {}).tolerance(1e-2);
    let seventh = request.orbit(0.2).unwrap();
    let exact = 2.0 * amplitude(0.1, 7.0 * 0.2);
    assert!((seventh.peak_to_peak() / exact - 1.0).abs() < 1e-9);
}

/// At both ends of a range that is narrower than a usual step.
#[test]
fn an_orbit_at_the_end_of_a_narrow_range_is_found() {
    let request = FrequencyResponse::of(&Narrow { zeta: 0.0 });
    let request = request.vary("zeta").omega(1.5);
    for zeta in [0.0, 0.0005] {
        let orbit = request.orbit(zeta).unwrap();
        let exact = 2.0 * amplitude(2.0 * zeta, 1.5);
        assert!((orbit.peak_to_peak() / exact - 1.0).abs() < 1e-9);
    }
}

/// An orbit of the system under a small load, given to the system without it: its mean is none of the unknowns, and is zero.
#[test]
fn an_orbit_given_to_a_symmetric_system_is_made_symmetric() {
    let model = |load| Continuous {
        zeta: 0.1,
        alpha: 3.0,
        load,
        drive: 1.0,
    };
    let loaded = model(1e-6);
    let start = FrequencyResponse::of(&loaded).orbit(0.5).unwrap();
    let mean = start.orbit.series(0).unwrap()[0];
    assert!(mean != 0.0);
    let symmetric = model(0.0);
    let request = FrequencyResponse::of(&symmetric).near_orbit(&start.orbit);
    let branch = request.from(0.5).to(0.55).run().unwrap();
    for point in &branch.points {
        assert_eq!(point.orbit.series(0).unwrap()[0], 0.0);
        assert!((point.motion().maximum + point.motion().minimum).abs() < 1e-12);
    }
}

/// In doubles the determinant of this is 1.4e-17, and its inverse finite.
#[test]
fn masses_in_proportion_are_refused() {
    let model = |c| Proportional { a: 0.1, b: 0.3, c };
    let singular = model(0.9);
    let fault = FrequencyResponse::of(&singular).orbit(0.5).unwrap_err();
    assert!(
        matches!(fault.downcast_ref(), Some(ModelError::SingularMass { determinant }) if determinant.abs() < 1e-16),
        "{fault}"
    );
    assert!(FrequencyResponse::of(&model(0.91)).orbit(0.5).is_ok());
}

/// The doubling of Wang et al. (2021), figure 8, at a drive of 1.28, asked for elsewhere.
#[test]
fn an_event_belongs_to_the_request() {
    let model = OneSided {
        zeta: 0.032,
        alpha: 1.0,
        load: 1.0,
        drive: 1.0,
    };
    let request = FrequencyResponse::of(&model).vary("drive").omega(1.0);
    let request = request.harmonics(10).stability(false);
    let here = request.clone().from(1.0).to(1.4).doublings(true);
    let branch = here.run().unwrap();
    let event = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let beside = request.clone().from(2.0).to(3.0);
    let fault = beside.switch(event, Side::One).unwrap_err();
    assert!(
        matches!(fault.downcast_ref(), Some(RequestError::Option { name: "event", value, .. }) if (value - 1.2826).abs() < 1e-3),
        "{fault}"
    );
    let at_another = request.clone().omega(1.1).from(1.0).to(1.4);
    let fault = at_another.switch(event, Side::One).unwrap_err();
    assert!(
        matches!(
            fault.downcast_ref(),
            Some(RequestError::Option {
                name: "event",
                value: 1.0,
                ..
            })
        ),
        "{fault}"
    );
    let over_omega = FrequencyResponse::of(&model).from(1.2).to(1.4);
    let fault = over_omega.switch(event, Side::One).unwrap_err();
    assert!(
        matches!(
            fault.downcast_ref(),
            Some(RequestError::Option { name: "event", .. })
        ),
        "{fault}"
    );
}

/// A gap of a linear spring touches where its amplitude is the load: closed form.
#[test]
fn doublings_take_no_bifurcation_away() {
    let model = OneSided {
        zeta: 0.032,
        alpha: 1.0,
        load: 1.0,
        drive: 0.1,
    };
    let request = FrequencyResponse::of(&model).from(0.8).to(0.96);
    let request = request.bifurcations(true);
    for request in [
        request.clone(),
        request.clone().doublings(true),
        request.doublings(false),
    ] {
        let branch = request.run().unwrap();
        // Whether it turns is not asked.
        let touch = branch.events(EventKind::Grazing { turns: true }).next();
        let omega = touch.unwrap().point.value;
        assert!((0.1 * amplitude(0.064, omega) - 1.0).abs() < 1e-9);
    }
}

/// Nothing of the linear oscillator's three harmonics is too large for a Hill matrix, but that of 1200 is.
#[test]
fn hill_matrices_have_a_largest_order() {
    let model = Linear {
        zeta: 0.1,
        drive: 1.0,
    };
    let method = hertzian::stability::Method::Hill;
    for (harmonics, found) in [(3, true), (1200, false)] {
        let request = FrequencyResponse::of(&model).harmonics(harmonics);
        let branch = request.stability(false).from(0.5).to(0.6).max_points(2);
        let branch = branch.run().unwrap();
        let answer = branch.multipliers(&branch.points[0], method).unwrap();
        assert_eq!(answer.stability.multipliers.is_empty(), !found);
    }
}
