//! A function through points: cubic between neighbours, with slopes of the parabola through three.
//!
//! Source: Fritsch and Butland (1984), SIAM Journal on Scientific and Statistical Computing 5, 300, (2.1) for the three-point slope; no slope
//! is limited, since what is drawn through may turn between points.

/// A function of an increasing argument.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spline {
    at: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

/// The slope at the middle of three points, or at an end of two.
fn slope(at: &[f64], values: &[f64], index: usize) -> f64 {
    let chord = |i: usize| (values[i + 1] - values[i]) / (at[i + 1] - at[i]);
    match (index, index + 1 == at.len()) {
        (0, true) => 0.0,
        (0, false) => chord(0),
        (_, true) => chord(index - 1),
        _ => {
            let [before, after] = [at[index] - at[index - 1], at[index + 1] - at[index]];
            (after * chord(index - 1) + before * chord(index)) / (before + after)
        }
    }
}

impl Spline {
    /// Through values at increasing arguments.
    pub(crate) fn through(at: Vec<f64>, values: Vec<f64>) -> Self {
        let slopes = (0..at.len())
            .map(|index| slope(&at, &values, index))
            .collect();
        Self { at, values, slopes }
    }

    /// With no slope at a point.
    pub(crate) fn flatten(&mut self, index: usize) {
        self.slopes[index] = 0.0;
    }

    /// Value and slope; a straight line beyond the ends.
    pub(crate) fn of(&self, at: f64) -> [f64; 2] {
        let last = self.at.len() - 1;
        let beyond = |i: usize| {
            [
                self.values[i] + self.slopes[i] * (at - self.at[i]),
                self.slopes[i],
            ]
        };
        if at <= self.at[0] {
            return beyond(0);
        }
        if at >= self.at[last] {
            return beyond(last);
        }
        let i = self.at.partition_point(|&a| a <= at) - 1;
        let h = self.at[i + 1] - self.at[i];
        let t = (at - self.at[i]) / h;
        let [a, b] = [self.values[i], self.values[i + 1]];
        let [da, db] = [h * self.slopes[i], h * self.slopes[i + 1]];
        let (square, cube) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
        let value = a + t * (da + t * (square + t * cube));
        [value, (da + t * (2.0 * square + 3.0 * t * cube)) / h]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_between_uneven_points() {
        let at = vec![0.0, 0.5, 0.7, 1.5, 2.0];
        let values = at.iter().map(|x| 1.0 + x - 3.0 * x * x).collect();
        let spline = Spline::through(at, values);
        for x in [0.6, 1.0, 1.3] {
            let [value, slope] = spline.of(x);
            assert!((value - (1.0 + x - 3.0 * x * x)).abs() < 1e-14);
            assert!((slope - (1.0 - 6.0 * x)).abs() < 1e-13);
        }
    }
}
