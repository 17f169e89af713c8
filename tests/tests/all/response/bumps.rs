//! A force that is a bump of any width: nodes that do not see it state no error, and are not what a branch goes on with.

use hertzian::{ContactEquation, FrequencyResponse, Shooting};

hertzian::oscillator! {
    /// An oscillator with a bump of its restoring force at rest
    Bump(x) {
        /// width of the bump
        param width > 0;
        law bump(gap) { 20*exp(-(gap/width)^2) }
        ddot(x) + 0.2*dot(x) + x + bump(x) = 2*cos(omega*t);
    }
}

/// By the contact equation an orbit is within its stated error, or there is none; a branch goes on by another method.
#[test]
fn a_bump_that_no_node_sees_is_not_left_out() {
    for width in [0.3, 0.1, 0.03, 0.01, 3e-3, 7e-4, 1e-4] {
        let model = Bump { width };
        let request = FrequencyResponse::of(&model)
            .from(1.9)
            .to(2.1)
            .tolerance(1e-6);
        let exact = request.clone().by(Shooting::new()).orbit(2.0).unwrap();
        let stated = exact.error.unwrap();
        let found = request.clone().by(ContactEquation::new()).orbit(2.0);
        assert!(found.is_ok() || width < 0.02, "{width}");
        if let Ok(point) = found {
            let error = (point.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
            let stated = point.error.unwrap() + stated;
            assert!(error <= 3.0 * stated, "{width}: {error:e} {stated:e}");
        }
        let branch = request.run().unwrap();
        let point = &branch.at(2.0).unwrap()[0];
        let error = (point.peak_to_peak() / exact.peak_to_peak() - 1.0).abs();
        let stated = point.error.unwrap() + stated;
        assert!(error <= 3.0 * stated, "{width}: {error:e} {stated:e}");
    }
}
