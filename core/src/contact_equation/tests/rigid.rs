//! What a rigid motion that is damped little leaves of the digits of an event.

use crate::{ContactEquation, EventKind, FrequencyResponse, Shooting};

crate::oscillator! {
    /// Two masses on a spring, which only a cubic force between both and their supports holds; the exponents of their rigid motion are zero and -0.007.
    Adrift(x, y) {
        param reach = 0.732077824500591 > 0;
        param along = 0.6666666666666666;
        law pull(gap) { 0.16829954146822318*(exp(gap/reach) - 1) }
        1*ddot(x) + 0.016914775890829684*dot(x) + 1.4995648180681984*(x - y) + 0.038878283382643666*(dot(x) - dot(y))
            + 0.4509859214285026*y^2*x - along*pull(along*y - along*x + 0.19443164582877825) = 0.15343472360197008;
        2.4427103216603374*ddot(y) + 0.007763493795981225*dot(y) + 1.4995648180681984*(y - x) + 0.038878283382643666*(dot(y) - dot(x))
            + 0.4509859214285026*x^2*y + along*pull(along*y - along*x + 0.19443164582877825) = 0.18503208244646657*cos(omega*t);
    }
}

/// By extrapolation of the midpoint rule (Hairer, Nørsett and Wanner (1993), section II.9) of the motion and its variations with 64 bits of digits, and the secant
/// method on `det(M + 1)`; 40 and 60 steps a period give the same digits.
const DOUBLINGS: [f64; 2] = [0.858_693_238_098_518_9, 1.035_219_027_075_741];

/// The contact equation found them at 2e-12 from here, and said 2e-14.
#[test]
fn doublings_of_masses_adrift_have_all_digits() {
    let model = Adrift::default();
    let request = FrequencyResponse::of(&model).from(0.75).to(1.36);
    for branch in [
        request.clone().by(ContactEquation::new()).run().unwrap(),
        request.by(Shooting::new()).run().unwrap(),
    ] {
        let doublings = branch.events.iter();
        let doublings = doublings.filter(|event| event.kind == EventKind::PeriodDoubling);
        let found: Vec<f64> = doublings.map(|event| event.point.value).collect();
        assert_eq!(found.len(), DOUBLINGS.len(), "{found:?}");
        for (found, exact) in found.iter().zip(DOUBLINGS) {
            assert!((found - exact).abs() < 1e-13, "{found} {exact}");
        }
    }
}
