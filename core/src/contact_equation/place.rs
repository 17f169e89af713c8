//! A phase with its derivatives by unknowns: of two switches by (2) of [`skeleton`](super::skeleton).

/// `H` below which differences over the way are rounding.
pub(super) const CLOSEST: f64 = 1e-13;

/// By which unknown the way between two switches that may meet is told. Where both do, it is `H`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Opening {
    /// By `H`, in which an orbit is smooth as long as the force grows from zero.
    Square,
    /// By its root, in which it is where the force jumps.
    Root,
}

impl Opening {
    /// Half of the way, and its derivative by the unknown; zero where there is none.
    pub(super) fn half(self, unknown: f64) -> [f64; 2] {
        if unknown <= 0.0 {
            return [0.0; 2];
        }
        match self {
            Self::Square => {
                let half = unknown.max(CLOSEST).sqrt();
                [half, 0.5 / half]
            }
            Self::Root => [unknown.max(CLOSEST.sqrt()), 1.0],
        }
    }

    /// `H`
    pub(super) fn square(self, unknown: f64) -> f64 {
        match self {
            Self::Root if unknown > 0.0 => unknown * unknown,
            _ => unknown,
        }
    }

    /// The unknown with an `H`.
    pub(super) fn unknown(self, square: f64) -> f64 {
        match self {
            Self::Root if square > 0.0 => square.sqrt(),
            _ => square,
        }
    }
}

/// A phase with its derivatives by unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) phase: f64,
    by: [(usize, f64); 4],
    count: usize,
}

impl Place {
    pub(super) fn fixed(phase: f64) -> Self {
        Self {
            phase,
            by: [(0, 0.0); 4],
            count: 0,
        }
    }

    pub(super) fn add(&mut self, unknown: usize, slope: f64) {
        self.by[self.count] = (unknown, slope);
        self.count += 1;
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.phase *= factor;
        for (_, slope) in &mut self.by {
            *slope *= factor;
        }
    }

    pub(super) fn slopes(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        self.by.into_iter().take(self.count)
    }
}
