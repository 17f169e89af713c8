//! An orbit in the plane of two signals.

use hertzian_chart::{Chart, Note, Series};

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::report::unit::in_unit;
use crate::report::view::Frequency;

impl Branch {
    /// An orbit in the plane of two signals, coordinates, outputs or forces of contacts by their names: the path of a shaft in its bearing, a
    /// phase portrait where the second is the rate of the first. Where the period of the declaration begins is marked.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     /// A shaft on two springs.
    ///     Shaft(x: mm, y: mm) {
    ///         param m: t = 1e-3 > 0;
    ///         param c: N*s/mm = 0.01;
    ///         param soft: N/mm = 40;
    ///         param stiff: N/mm = 60;
    ///         param drive: N = 1;
    ///         m*ddot(x) + c*dot(x) + soft*x = drive*cos(omega*t);
    ///         m*ddot(y) + c*dot(y) + stiff*y = drive*sin(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Shaft::default()).from(150.0).to(300.0).run()?;
    /// let orbit = &branch.at(220.0)?[0];
    /// let svg = branch.path(["x", "y"], orbit)?.to_svg();
    /// assert!(svg.contains("x [mm]") && svg.contains("y [mm]"));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`waveform`](Self::waveform).
    pub fn path(&self, names: [&str; 2], point: &Point) -> Result<Chart, Error> {
        let [x, y] = [
            self.waveform(names[0], point)?,
            self.waveform(names[1], point)?,
        ];
        let points = together(&x, &y);
        let [across, up] = names.map(|name| in_unit(name, self.model.unit_of(name)));
        let here = self.place_of(point, Frequency::Omega);
        let title = format!("{} over {} at {here}", names[1], names[0]);
        let begin = points.first().map(|&point| Note {
            label: "beginning of the period".to_owned(),
            point,
        });
        let chart = Chart::new(title).x(across).y(up).trace(Series {
            label: String::new(),
            points,
        });
        Ok(begin.into_iter().fold(chart, Chart::note))
    }
}

/// Two signals over the times of both. Where one jumps there are two places, before and after.
fn together(x: &[[f64; 2]], y: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut times: Vec<f64> = x.iter().chain(y).map(|[t, _]| *t).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut places = Vec::with_capacity(times.len());
    for t in times {
        let [[x, later], [y, after]] = [sides(x, t), sides(y, t)];
        places.push([x, y]);
        if [later, after] != [x, y] {
            places.push([later, after]);
        }
    }
    places
}

/// The values of a signal just before a time and just after it; between its times on the chord.
fn sides(of: &[[f64; 2]], t: f64) -> [f64; 2] {
    let first = of.partition_point(|[time, _]| *time < t);
    let end = of.partition_point(|[time, _]| *time <= t);
    match (&of[..first], &of[first..end], &of[end..]) {
        (_, [[_, before], .., [_, after]], _) => [*before, *after],
        ([.., [from, a]], [], [[to, b], ..]) => [a + (t - from) / (to - from) * (b - a); 2],
        (_, [[_, value]], _) | ([.., [_, value]], [], []) | ([], [], [[_, value], ..]) => {
            [*value; 2]
        }
        ([], [], []) => [f64::NAN; 2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_of_different_times_meet_at_those_of_both() {
        let coarse = [[0.0, 1.0], [1.0, 3.0], [2.0, 2.0]];
        let fine = [[0.0, 5.0], [0.5, 6.0], [1.0, 7.0], [1.0, 8.0], [2.0, 9.0]];
        let expected = [[1.0, 5.0], [2.0, 6.0], [3.0, 7.0], [3.0, 8.0], [2.0, 9.0]];
        assert_eq!(together(&coarse, &fine), expected);
        let turned = expected.map(|[x, y]| [y, x]);
        assert_eq!(together(&fine, &coarse), turned);
    }

    #[test]
    fn signals_that_jump_together_stay_together() {
        let jumps = [[0.0, 0.0], [1.0, 1.0], [1.0, 4.0], [2.0, 5.0]];
        assert_eq!(
            together(&jumps, &jumps),
            [[0.0, 0.0], [1.0, 1.0], [4.0, 4.0], [5.0, 5.0]]
        );
        assert!(together(&jumps, &[]).iter().all(|[_, y]| y.is_nan()));
    }
}
