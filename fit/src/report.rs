//! What a fit says: a summary, a table of residuals, everything as JSON.

use std::fmt::{self, Write};

use crate::result::{Estimate, Fitted};

/// Correlations that are said.
const STRONG: f64 = 0.9;
/// A scatter of residuals that is said, in hundredths of the largest value.
const POOR: f64 = 5.0;
/// Leverages that are said.
const DECISIVE: f64 = 0.9;
/// Outliers, rejected trials and other lines that are said of each kind.
const LINES: usize = 5;

/// A number to two digits of its error, and the error.
fn to_error(value: f64, error: f64) -> (String, String) {
    // Decimals: below zero in front of the point.
    let digits = if error > 0.0 {
        (1.0 - error.log10().floor()).min(15.0)
    } else {
        15.0
    };
    let plain = (1e-5..1e7).contains(&value.abs()) || value == 0.0;
    if plain {
        let digits = digits.max(0.0) as usize;
        return (format!("{value:.digits$}"), short(error));
    }
    let significant = (value.abs().log10().floor() + digits).clamp(1.0, 15.0) as usize;
    (format!("{value:.significant$e}"), short(error))
}

/// Two digits.
fn short(error: f64) -> String {
    if (1e-4..1e4).contains(&error) {
        let digits = (1.0 - error.log10().floor()).max(0.0) as usize;
        format!("{error:.digits$}")
    } else {
        format!("{error:.1e}")
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            unit,
            value,
            error,
            interval,
            at_limit,
            undetermined,
        } = self;
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" {unit}")
        };
        match (error, interval) {
            (Some(error), Some([low, high])) => {
                let (value, deviation) = to_error(*value, *error);
                let [low, high] = [low, high].map(|end| to_error(*end, *error).0);
                write!(
                    f,
                    "{name:<10} {value}{unit} (standard error {deviation}), 95 % from {low} to {high}"
                )
            }
            _ if *at_limit => write!(
                f,
                "{name:<10} {value}{unit}, at the end of its range: the data want it beyond, or do not need it"
            ),
            _ if *undetermined => write!(
                f,
                "{name:<10} {value:.3e}{unit}, which the data do not determine"
            ),
            _ => write!(f, "{name:<10} {value}{unit}, without a standard error"),
        }
    }
}

impl fmt::Display for Fitted {
    /// Estimates with their errors, how well they fit, and what is to be known of both.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for estimate in &self.estimates {
            writeln!(f, "{estimate}")?;
        }
        self.goodness(f)?;
        for what in &self.untold {
            writeln!(f, "not told   {what}")?;
        }
        for (i, j) in self.strong() {
            let [a, b] = [&self.estimates[i].name, &self.estimates[j].name];
            writeln!(f, "correlated {a} and {b}: {:.3}", self.correlation[i][j])?;
        }
        self.outliers(f)?;
        self.decisive(f)?;
        for (reason, count) in self.rejected.iter().take(LINES) {
            writeln!(f, "rejected   {count} of {} trials: {reason}", self.trials)?;
        }
        if !self.converged {
            writeln!(
                f,
                "unfinished the search was stopped: these are the best values until then"
            )?;
        }
        Ok(())
    }
}

impl Fitted {
    fn goodness(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values: usize = self.sets.iter().map(|set| set.values.len()).sum();
        let sets = self.sets.len();
        let of = format!(
            "{values} values in {sets} data set{}",
            if sets == 1 { "" } else { "s" }
        );
        match (self.is_absolute, self.probability) {
            (true, Some(probability)) => writeln!(
                f,
                "residuals  {of}: chi-square {:.4} for {} degrees of freedom, probability {probability:.2}",
                self.chi_square, self.degrees
            )?,
            (true, None) => writeln!(
                f,
                "residuals  {of}: scatter {:.3} of the stated deviations",
                self.scatter
            )?,
            (false, _) if self.scatter.is_nan() => {
                writeln!(
                    f,
                    "residuals  {of}, as many as parameters: nothing is left of them"
                )?;
            }
            (false, _) => writeln!(
                f,
                "residuals  {of}: scatter {:.2e} of the largest value of a set; no deviations were stated, so the errors follow from it",
                0.01 * self.scatter
            )?,
        }
        for set in self
            .sets
            .iter()
            .filter(|set| self.is_absolute && !set.stated)
        {
            let deviation = set.values.first().map_or(f64::NAN, |value| value.deviation);
            let (name, unit) = (&set.name, &set.unit);
            writeln!(
                f,
                "weighed    {name} by a standard deviation of {deviation:.1e} {unit}: none was stated, and so its values scatter"
            )?;
        }
        if self
            .probability
            .is_some_and(|probability| probability < 0.01)
        {
            writeln!(
                f,
                "poor       the model does not describe the data to their deviations: errors of the estimates are too small"
            )?;
        }
        if !self.is_absolute && self.scatter > POOR {
            writeln!(
                f,
                "poor       the curve does not pass the data: the model does not describe them, or the search ended elsewhere; give other values to start from, or ranges"
            )?;
        }
        Ok(())
    }

    fn outliers(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = self.sets.iter().flat_map(|set| {
            let outliers = set.values.iter().filter(|value| value.is_outlier);
            outliers.map(move |value| (set, value))
        });
        let count = all.clone().count();
        for (set, value) in all.take(LINES) {
            let varied = &set.varied[0];
            writeln!(
                f,
                "outlier    {}, row {} at {varied} = {:.6}: {:+.1} standard deviations from a fit without it, which moves estimates by {:.1} standard errors",
                set.name,
                value.row + 1,
                value.place,
                value.studentised,
                value.influence
            )?;
        }
        if count > LINES {
            writeln!(f, "outliers   {} more", count - LINES)?;
        }
        Ok(())
    }

    /// Values that determine their own fit: next to a fold they know it better than derivatives say.
    fn decisive(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = self.sets.iter().flat_map(|set| {
            let decisive = set.values.iter().filter(|value| value.leverage > DECISIVE);
            decisive.map(move |value| (set, value))
        });
        for (set, value) in all.take(LINES) {
            writeln!(
                f,
                "decisive   {}, row {} at {} = {:.6} determines its own fit (leverage {:.2}): where it is next to a fold, intervals are too narrow; give the place of the jump",
                set.name,
                value.row + 1,
                set.varied[0],
                value.place,
                value.leverage
            )?;
        }
        Ok(())
    }

    /// Pairs of estimates that are correlated strongly.
    fn strong(&self) -> Vec<(usize, usize)> {
        let count = self.estimates.len();
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (j, i)));
        pairs
            .filter(|&(i, j)| self.correlation[i][j].abs() >= STRONG)
            .collect()
    }

    /// Everything as JSON: fields by their names. What is not a number is `null`.
    pub fn to_json(&self) -> String {
        // Strings, numbers and lists of them: nothing that could not be written.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// A row for each measured value: what was measured, what the model says, residual and influence.
    pub fn to_csv(&self) -> String {
        let mut text = "set,row,place,value,deviation,foot_place,foot_value,residual,leverage,studentised,influence,outlier\n".to_owned();
        for set in &self.sets {
            let name = format!("\"{}\"", set.name.replace('"', "\"\""));
            for value in &set.values {
                // Writing to a string does not fail.
                let _ = writeln!(
                    text,
                    "{name},{},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{}",
                    value.row + 1,
                    value.place,
                    value.value,
                    value.deviation,
                    value.foot[0],
                    value.foot[1],
                    value.residual,
                    value.leverage,
                    value.studentised,
                    value.influence,
                    value.is_outlier
                );
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_two_digits_of_their_error() {
        let of = |value, error| to_error(value, error).0;
        assert_eq!(of(1.500_123_4, 0.0012), "1.5001");
        assert_eq!(of(0.032_001, 0.000_47), "0.03200");
        assert_eq!(of(1234.6, 25.0), "1235");
        assert_eq!(of(2.345e10, 1.2e7), "2.3450e10");
        assert_eq!(short(0.001_24), "0.0012");
        assert_eq!(short(25.2), "25");
    }
}
