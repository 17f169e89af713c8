//! The same oscillator in other units of time: what is located does not depend on them.

use hertzian::{EventKind, FrequencyResponse};

use crate::bifurcations::symmetry::HARDENING;

hertzian::oscillator! {
    /// Figure 2a of Wang et al. (2021), with `s` units of time in each of its own.
    Hardening(x) {
        param s > 0;
        ddot(x) + 0.02*s*dot(x) + s^2*sgn(x)*|x|^1.5 = 0.1*s^2*cos(omega*t);
    }
}

/// As a vibration of a kilohertz, and as one that takes minutes.
#[test]
fn branch_points_do_not_depend_on_the_unit_of_time() {
    for s in [1e-3, 1.0, 1e4] {
        let model = Hardening { s };
        let request = FrequencyResponse::of(&model).symmetric(false);
        let branch = request.bifurcations(true).from(0.41 * s).to(0.34 * s);
        let branch = branch.run().unwrap();
        let found: Vec<_> = branch.events(EventKind::BranchPoint).collect();
        assert_eq!(
            found.len(),
            2,
            "{s}: {:?} {:?}",
            branch.events,
            branch.turns
        );
        for (event, exact) in found.iter().zip(HARDENING) {
            let error = (event.point.value / s - exact).abs();
            assert!(
                error < 1e-6 && error <= event.error / s,
                "{s}: {event} {error:.1e}"
            );
        }
    }
}
