//! Directions: linear combinations of coordinates.

/// A linear combination of coordinates: what a gap, a force or an output is along.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Direction {
    pub(crate) entries: Vec<(usize, f64)>,
}

impl Direction {
    /// One coordinate, counted from zero.
    pub fn at(coordinate: usize) -> Self {
        Self::weighted([(coordinate, 1.0)])
    }

    /// The mean of several coordinates. A force along it is shared between them in equal parts.
    pub fn mean(coordinates: &[usize]) -> Self {
        let share = 1.0 / coordinates.len().max(1) as f64;
        Self::weighted(coordinates.iter().map(|&coordinate| (coordinate, share)))
    }

    /// Coordinates with their factors. Several factors of one coordinate add up.
    pub fn weighted(entries: impl IntoIterator<Item = (usize, f64)>) -> Self {
        Self {
            entries: entries.into_iter().collect(),
        }
    }

    /// Of all coordinates their factors.
    pub(crate) fn full(&self, coordinates: usize) -> Vec<f64> {
        let mut full = vec![0.0; coordinates];
        for &(coordinate, factor) in &self.entries {
            full[coordinate] += factor;
        }
        full
    }
}
