//! Laws of contacts: as the library has them, and written out by hand.

use std::sync::Arc;

use hertzian::law;

hertzian::law! {
    /// An elastic stop.
    Stop(gap, k >= 0) { gap > 0 => k*gap, else => 0 }
}

hertzian::law! {
    /// A body with a point contact (Hertz), or of another shape.
    Power(gap, k >= 0, alpha > 0) { gap > 0 => k*gap^alpha, else => 0 }
}

hertzian::law! {
    /// Free between two stops.
    Play(gap, k >= 0, half > 0) { gap > half => k*(gap - half), -half <= gap <= half => 0, gap < -half => k*(gap + half) }
}

hertzian::law! {
    /// A stop with a damper behind it: the force jumps where it is met.
    Damped(gap, k >= 0, c >= 0) { gap > 0 => k*gap + c*dot(gap), else => 0 }
}

hertzian::law! {
    /// A body that loses energy, Hunt and Crossley (1975), J. Appl. Mech. 42, 440.
    Lossy(gap, k >= 0, c >= 0) { gap > 0 => k*gap^1.5*(1 + c*dot(gap)), else => 0 }
}

/// A law with its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    Stop { k: f64 },
    Power { k: f64, alpha: f64 },
    Play { k: f64, half: f64 },
    Damped { k: f64, c: f64 },
    Lossy { k: f64, c: f64 },
}

/// A force with its derivatives by the gap and by its rate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Force {
    pub value: f64,
    pub by_gap: f64,
    pub by_rate: f64,
}

/// Nearer to a level the slope of a power below one is taken for that here.
const STEEPEST: f64 = 1e-15;

impl Law {
    /// As the library has it.
    pub fn of_library(&self) -> (Arc<dyn law::Law>, Vec<f64>) {
        match *self {
            Self::Stop { k } => (Arc::new(Stop), vec![k]),
            Self::Power { k, alpha } => (Arc::new(Power), vec![k, alpha]),
            Self::Play { k, half } => (Arc::new(Play), vec![k, half]),
            Self::Damped { k, c } => (Arc::new(Damped), vec![k, c]),
            Self::Lossy { k, c } => (Arc::new(Lossy), vec![k, c]),
        }
    }

    /// Gaps at which another piece begins, in ascending order.
    pub fn levels(&self) -> Vec<f64> {
        match *self {
            Self::Play { half, .. } => vec![-half, half],
            _ => vec![0.0],
        }
    }

    /// Whether all pieces are affine.
    pub fn is_affine(&self) -> bool {
        !matches!(self, Self::Power { .. } | Self::Lossy { .. })
    }

    /// On a piece, counted from the lowest gaps.
    pub fn force(&self, piece: usize, gap: f64, rate: f64) -> Force {
        let of = |value, by_gap, by_rate| Force {
            value,
            by_gap,
            by_rate,
        };
        let power = |alpha: f64| {
            let gap = gap.max(0.0);
            [gap.powf(alpha), alpha * gap.max(STEEPEST).powf(alpha - 1.0)]
        };
        match (*self, piece) {
            (Self::Play { k, half }, 0) => of(k * (gap + half), k, 0.0),
            (Self::Play { k, half }, 2) => of(k * (gap - half), k, 0.0),
            (Self::Play { .. }, _) | (_, 0) => Force::default(),
            (Self::Stop { k }, _) => of(k * gap, k, 0.0),
            (Self::Damped { k, c }, _) => of(k * gap + c * rate, k, c),
            (Self::Power { k, alpha }, _) => {
                let [value, slope] = power(alpha);
                of(k * value, k * slope, 0.0)
            }
            (Self::Lossy { k, c }, _) => {
                let [value, slope] = power(1.5);
                let loss = 1.0 + c * rate;
                of(k * value * loss, k * slope * loss, k * c * value)
            }
        }
    }
}
