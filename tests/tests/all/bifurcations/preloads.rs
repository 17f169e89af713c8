//! Oscillators before stops whose force begins with a jump, and their events at known places.

use hertzian::{Branch, EventKind};

hertzian::oscillator! {
    /// Between two stops whose forces begin with a jump.
    pub Preloads(x) {
        param drive;
        param p;
        law stop(gap) { gap >= 0 => p + 4*gap, else => 0 }
        ddot(x) + 0.1*dot(x) + x + stop(x - 1) - stop(-x - 1.2) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Two masses, one of them before a stop with a preload.
    pub Masses(x, y) {
        param drive;
        param preload;
        law stop(gap) { gap >= 0 => preload + 8*gap, else => 0 }
        ddot(x) + 0.04*dot(x) + x + 0.3*(x - y) + stop(x - 1) = drive*cos(omega*t);
        0.5*ddot(y) + 0.04*dot(y) + 0.6*y + 0.3*(y - x) = 0;
    }
}

/// Events of a kind are at these places of a window alone, to this error.
pub fn assert_places(
    branch: &Branch,
    kind: EventKind,
    window: [f64; 2],
    expected: &[f64],
    most: f64,
) {
    let values = branch.events(kind).map(|event| event.point.value);
    let mut values: Vec<f64> = values
        .filter(|value| (window[0]..window[1]).contains(value))
        .collect();
    values.sort_by(f64::total_cmp);
    assert_eq!(values.len(), expected.len(), "{values:?}");
    for (value, expected) in values.iter().zip(expected) {
        let error = (value - expected).abs();
        assert!(error < most, "{value}: {error:.1e}");
    }
}
