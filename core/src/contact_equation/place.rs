//! A phase with its derivatives by unknowns.

/// `H` below which differences over the way are rounding.
const CLOSEST: f64 = 1e-13;

/// `sqrt(H)`; zero where there is no way between the two.
pub(super) fn half_way(square: f64) -> f64 {
    if square > 0.0 {
        square.max(CLOSEST).sqrt()
    } else {
        0.0
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
