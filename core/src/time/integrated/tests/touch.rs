//! Motions that touch a level, or pass it by next to nothing.

use super::*;

hertzian::oscillator! {
    /// A free oscillation about a load, with a stop.
    Stopped(x) {
        param load;
        param clearance;
        param alpha > 0;
        law stop(gap) { gap > 0 => 10*gap^alpha, else => 0 }
        ddot(x) + x + stop(x - clearance) = load;
    }
}

/// `x = load + A cos(t - 1)` with its largest value this far beyond the stop. By that little the stop changes nothing: its force
/// is below `10 d^alpha` for a time of about `d^(1/2)`.
#[test]
fn a_touch_changes_nothing() {
    let depths = (8..18).flat_map(|k| [1.0, 3.7, -1.0].map(|part| part * 10_f64.powi(-k)));
    for depth in depths.chain([0.0]) {
        for (clearance, load, alpha) in [
            (1.0, 0.0, 1.5),
            (0.0, -1.0, 1.5),
            (1.0, 0.3, 2.5),
            (0.0, -1.0, 1.0),
            (0.7, 0.0, 1.0),
        ] {
            let amplitude = clearance + depth - load;
            let model = Stopped {
                load,
                clearance,
                alpha,
            };
            for tolerance in [1e-7, 1e-10, 1e-13] {
                let values = [load, clearance, alpha];
                let mut flow = Integrated::new(&model, &values, 1.0, tolerance).unwrap();
                let at = |t: f64| {
                    [
                        load + amplitude * (t - 1.0).cos(),
                        -amplitude * (t - 1.0).sin(),
                    ]
                };
                let mut state = at(0.0);
                let mut tangent = Tangent::of_state(1, None);
                flow.advance(0.0, 2.0, &mut state, Some(&mut tangent), None)
                    .unwrap_or_else(|error| {
                        panic!("{depth:e} {clearance} {alpha} {tolerance:e}: {error}")
                    });
                let allowed = 10.0 * tolerance + 100.0 * depth.abs().powf(alpha + 0.5);
                for (x, y) in state.iter().zip(at(2.0)) {
                    assert!((x - y).abs() < allowed, "{depth:e} {tolerance:e}: {x} {y}");
                }
                // The stiffness of the stop for that time.
                let allowed = 10.0 * tolerance + 100.0 * depth.abs().powf(alpha - 0.5);
                let (s, c) = 2_f64.sin_cos();
                for (x, y) in tangent.columns.iter().zip([c, -s, s, c]) {
                    assert!((x - y).abs() < allowed, "{depth:e} {tolerance:e}: {x} {y}");
                }
            }
        }
    }
}
