//! Which sheet of a curve each value of a data set belongs to.
//!
//! Of all ways that a sweep can take from sheet to sheet the one is chosen whose distances have the smallest sum of squares, by dynamic
//! programming over the values in their order. Along a branch that begins at the lowest frequency a rising sweep goes forward, from sheet to sheet
//! over folds, and a falling one goes back. So where it went over is told by the data, early or not, and distances change continuously with parameters.
//!
//! Source: Viterbi (1967), IEEE Transactions on Information Theory 13, 260.

use crate::data::Sweep;

/// The sheet of each value, by its number; empty without sheets.
///
/// `ranks[k]` is the place of sheet `k` along the branch from the lowest frequency on, and `squares[i][k]` the square of the distance of value `i`
/// from it.
pub(crate) fn assigned(sweep: Sweep, ranks: &[isize], squares: &[Vec<f64>]) -> Vec<usize> {
    let ahead = match sweep {
        Sweep::Rising => 1,
        Sweep::Falling => -1,
        Sweep::Settled | Sweep::Controlled => {
            return squares.iter().map(|row| least(row)).collect();
        }
    };
    let may_follow = |from: usize, to: usize| ahead * (ranks[to] - ranks[from]) >= 0;
    let count = ranks.len();
    let mut sums: Vec<f64> = vec![0.0; count];
    let mut before: Vec<Vec<usize>> = Vec::with_capacity(squares.len());
    for (index, row) in squares.iter().enumerate() {
        let came = |to: usize| {
            let from = (0..count)
                .filter(|&from| index == 0 && from == to || index > 0 && may_follow(from, to));
            from.min_by(|&a, &b| sums[a].total_cmp(&sums[b]))
                .unwrap_or(to)
        };
        let came: Vec<usize> = (0..count).map(came).collect();
        sums = (0..count).map(|to| sums[came[to]] + row[to]).collect();
        before.push(came);
    }
    let mut sheet = least(&sums);
    let mut path: Vec<usize> = before
        .iter()
        .rev()
        .map(|came| {
            let here = sheet;
            sheet = came[here];
            here
        })
        .collect();
    path.reverse();
    path
}

/// The place of the smallest.
fn least(row: &[f64]) -> usize {
    let smallest = row.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    smallest.map_or(0, |(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a hard spring: the upper sheet ends in a fold, and the lower one begins in one.
    #[test]
    fn a_sweep_goes_over_once_and_in_its_direction() {
        let ranks = [0, 2];
        // The third value is nearer to the lower sheet, and the sixth to the upper one: noise.
        let squares = [
            [0.0, 9.0],
            [0.0, 9.0],
            [1.0, 0.9],
            [0.0, 9.0],
            [9.0, 0.0],
            [0.9, 1.0],
            [9.0, 0.0],
        ];
        let squares: Vec<Vec<f64>> = squares.iter().map(|row| row.to_vec()).collect();
        assert_eq!(
            assigned(Sweep::Rising, &ranks, &squares),
            [0, 0, 0, 0, 1, 1, 1]
        );
        // Each for itself.
        assert_eq!(
            assigned(Sweep::Settled, &ranks, &squares),
            [0, 0, 1, 0, 1, 0, 1]
        );
        let falling: Vec<Vec<f64>> = squares.into_iter().rev().collect();
        assert_eq!(
            assigned(Sweep::Falling, &ranks, &falling),
            [1, 1, 1, 0, 0, 0, 0]
        );
        // Nothing rises from the lower sheet to the upper one: the nearest of both is left.
        assert_eq!(assigned(Sweep::Rising, &ranks, &falling), [0; 7]);
    }
}
