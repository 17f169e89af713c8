//! One curve of a branch, for a chart of one's own.

use hertzian_chart::Curve;

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::orbit::observe::Wanted;

impl Branch {
    /// What is asked of a signal at every orbit, as `"tip:rms"`, over what the branch varies: solid where it is stable, and bent between
    /// orbits as [`runs`](Self::runs) are. It has the name of what was asked for, as `peak-to-peak of tip`.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    /// use hertzian::chart::Chart;
    ///
    /// hertzian::oscillator! {
    ///     Pair(x, y) {
    ///         ddot(x) + 0.1*dot(x) + 2*x - y + x^3 = 0.2*cos(omega*t);
    ///         ddot(y) + 0.1*dot(y) + 2*y - x = 0;
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Pair {}).from(0.8).to(2.0).tolerance(1e-3).run()?;
    /// let chart = Chart::new("Two masses").x("omega").y("size");
    /// let svg = chart.curve(branch.curve("x")?).curve(branch.curve("y")?).to_svg();
    /// assert!(svg.contains("peak-to-peak of y"));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`measured`](Self::measured), and if the text is not of that form.
    pub fn curve(&self, of: &str) -> Result<Curve, Error> {
        let wanted: Wanted = of.parse()?;
        // What is wrong with one orbit is wrong with all.
        if let Some(point) = self.points.first() {
            self.measured(&wanted, point)?;
        }
        let measured = |point: &Point| self.measured(&wanted, point).ok().flatten();
        Ok(Curve {
            label: format!("{} of {}", wanted.measure.in_words(), wanted.name),
            runs: self.runs_of(|point| [point.value, measured(point).unwrap_or(f64::NAN)]),
        })
    }
}
