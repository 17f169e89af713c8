//! Branches of several parameters, or of several models, in one chart.

use hertzian_chart::{Chart, Curve, Note, Scale, Series};

use crate::branches::branch::Branch;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::report::drawn::Drawn;
use crate::report::error::ViewError;
use crate::report::labels::{Held, Labels, held};
use crate::report::picture;
use crate::report::unit::with;
use crate::report::view::View;

/// How far curves of a waterfall are apart, in parts of the largest of them.
const APART: f64 = 0.4;

impl View {
    /// Branches in one chart, of one model or of several: what is the same of all stands in the title, what is not is the name of a curve.
    ///
    /// # Errors
    /// As of [`Branch::chart_of`]; and if branches vary something else, or measure in another unit, or none has an orbit.
    pub fn together<'b>(
        &self,
        branches: impl IntoIterator<Item = &'b Branch>,
    ) -> Result<Chart, Error> {
        let drawn = self.all(branches)?;
        let (labels, names) = told_apart(&drawn, None);
        Ok(picture::chart_of(self, &labels, &drawn, &names))
    }

    /// One curve for each value of a parameter, each above the last one, with the value at its end.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    /// use hertzian::chart::View;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param drive;
    ///         ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let branches = [0.1, 0.2, 0.3].map(|drive| {
    ///     FrequencyResponse::of(&Duffing { drive }).from(0.5).to(2.0).harmonics(5).run()
    /// });
    /// let branches = branches.into_iter().collect::<Result<Vec<_>, _>>()?;
    /// let svg = View::new().waterfall("drive", &branches)?.to_svg();
    /// assert!(svg.contains("drive = 0.2"));
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`together`](Self::together); and if there is no such parameter, the branches vary it, or several harmonics are asked for.
    pub fn waterfall<'b>(
        &self,
        parameter: &str,
        branches: impl IntoIterator<Item = &'b Branch>,
    ) -> Result<Chart, Error> {
        let harmonics = self.harmonics;
        if harmonics > 0 {
            return Err(ViewError::Waterfall { harmonics }.into());
        }
        let mut drawn = self.all(branches)?;
        let values: Vec<f64> = drawn
            .iter()
            .map(|drawn| value_of(drawn, parameter))
            .collect::<Result<_, _>>()?;
        let (labels, names) = told_apart(&drawn, Some(parameter));
        let mut curves: Vec<(f64, &String)> = Vec::new();
        for (value, name) in values.into_iter().zip(&names) {
            if !curves.iter().any(|(_, known)| *known == name) {
                curves.push((value, name));
            }
        }
        curves.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let step = Step::of(self.scale, &drawn);
        let rank = |name: &String| curves.iter().position(|(_, own)| *own == name);
        drawn = drawn
            .into_iter()
            .zip(&names)
            .map(|(drawn, name)| drawn.raised(|y| step.raised(y, rank(name).unwrap_or(0))))
            .collect();
        let unit = drawn[0].seen.unit();
        let labels = Labels {
            size: format!("{}, {}", labels.size, step.in_words(&unit)),
            ..labels
        };
        let mut chart = picture::empty_chart(&labels).scales(Scale::Linear, self.scale);
        for (rank, (_, name)) in curves.iter().enumerate() {
            let own = drawn.iter().zip(&names).filter(|(_, own)| own == name);
            let own: Vec<&Drawn<'_>> = own.map(|(drawn, _)| drawn).collect();
            chart = step.curve(chart, &own, rank, name);
        }
        Ok(self.marked(chart, &drawn))
    }

    /// All that have orbits, as the first of them is seen.
    fn all<'b>(
        &self,
        branches: impl IntoIterator<Item = &'b Branch>,
    ) -> Result<Vec<Drawn<'b>>, Error> {
        let all: Vec<&Branch> = branches.into_iter().collect();
        let mut drawn: Vec<Drawn<'b>> = Vec::new();
        for (index, branch) in all.iter().enumerate() {
            if branch.points.is_empty() {
                continue;
            }
            let view = match drawn.first() {
                Some(first) => self.clone().of(first.seen.wanted.clone()),
                None => self.clone(),
            };
            let seen = view.on(branch)?;
            if let Some(first) = drawn.first() {
                let axes = |seen: &crate::report::view::Seen<'_>| {
                    let branch = seen.branch;
                    let varied = &branch.varied;
                    let unit = branch.model.unit_of_varied(varied);
                    [
                        (varied.clone(), unit.to_owned()),
                        (seen.wanted.to_string(), seen.unit()),
                    ]
                    .map(|(name, unit)| in_words(&name, &unit))
                };
                for (expected, found) in axes(&first.seen).into_iter().zip(axes(&seen)) {
                    if expected != found {
                        let branch = index + 1;
                        return Err(ViewError::OtherAxis {
                            branch,
                            expected,
                            found,
                        }
                        .into());
                    }
                }
            }
            drawn.push(Drawn::of(seen));
        }
        if drawn.is_empty() {
            let branches = all.len();
            return Err(ViewError::Empty { branches }.into());
        }
        self.check(&mut drawn)?;
        Ok(drawn)
    }
}

/// What is at an axis.
fn in_words(name: &str, unit: &str) -> String {
    match unit {
        "" => format!("{name} without a unit"),
        _ => format!("{name} in {unit}"),
    }
}

/// The value of a parameter that is the same all along a branch.
fn value_of(drawn: &Drawn<'_>, name: &str) -> Result<f64, Error> {
    let branch = drawn.seen.branch;
    let held = held(branch);
    if branch.varied == name {
        let name = name.to_owned();
        let must = "must be another one than the parameter of the waterfall";
        return Err(RequestError::Varied { name, must }.into());
    }
    let found = held.iter().find(|held| held.name == name);
    found.map(|held| held.value).ok_or_else(|| {
        RequestError::UnknownParameter {
            name: name.to_owned(),
            known: held.iter().map(|held| held.name.clone()).collect(),
        }
        .into()
    })
}

/// Title and axes with what is the same of all branches, and the rest as a name of each: with the parameter that is named in any case.
fn told_apart(drawn: &[Drawn<'_>], named: Option<&str>) -> (Labels, Vec<String>) {
    let all: Vec<Vec<Held>> = drawn.iter().map(|drawn| held(drawn.seen.branch)).collect();
    let is_common = |held: &Held| {
        let alike = |others: &Vec<Held>| others.iter().any(|other| other.text() == held.text());
        named != Some(&*held.name) && all.iter().all(alike)
    };
    let first = &drawn[0].seen;
    let model = |drawn: &Drawn<'_>| drawn.seen.branch.model.name.clone();
    let mut models: Vec<String> = Vec::new();
    for drawn in drawn {
        if !models.contains(&model(drawn)) {
            models.push(model(drawn));
        }
    }
    let period = first.branch.period();
    let periods_differ = drawn
        .iter()
        .any(|drawn| drawn.seen.branch.period() != period);
    let names = drawn.iter().zip(&all).map(|(drawn, held)| {
        let name = Some(model(drawn)).filter(|_| models.len() > 1);
        let own = held.iter().filter(|held| !is_common(held)).map(Held::text);
        let period = drawn.seen.branch.period();
        let period = periods_differ.then(|| format!("period {period}"));
        let parts: Vec<String> = name.into_iter().chain(own).chain(period).collect();
        parts.join(", ")
    });
    let names = names.collect();
    let common = all[0].iter().filter(|held| is_common(held)).map(Held::text);
    let labels = Labels::titled(first, models.join(" and "), common);
    let labels = if periods_differ {
        labels
    } else {
        labels.with_period(period)
    };
    (labels, names)
}

/// How far each curve of a waterfall is above the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Step {
    scale: Scale,
    /// To be added, or on a logarithmic axis to be multiplied by.
    size: f64,
}

impl Step {
    fn of(scale: Scale, drawn: &[Drawn<'_>]) -> Self {
        let level = |y: f64| match scale {
            Scale::Linear => y,
            _ => y.log10(),
        };
        let levels = drawn.iter().flat_map(|drawn| drawn.points(0));
        let levels = levels.map(|[_, y]| level(*y)).filter(|u| u.is_finite());
        let [low, high] = levels.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| {
            [low.min(u), high.max(u)]
        });
        // Curves of sizes begin at zero.
        let low = if scale == Scale::Linear && low > 0.0 {
            0.0
        } else {
            low
        };
        let extent = if high > low {
            APART * (high - low)
        } else {
            1.0
        };
        let size = match scale {
            Scale::Linear => round_up(extent),
            Scale::Decibel => 10_f64.powf(round_up(20.0 * extent) / 20.0),
            _ => round_up(10_f64.powf(extent)),
        };
        Self { scale, size }
    }

    fn raised(self, y: f64, rank: usize) -> f64 {
        match self.scale {
            Scale::Linear => y + self.size * rank as f64,
            _ => y * self.size.powi(rank as i32),
        }
    }

    fn in_words(self, unit: &str) -> String {
        let amount = match self.scale {
            Scale::Linear => with(&self.size.to_string(), unit),
            Scale::Decibel => format!("{} dB", (20.0 * self.size.log10()).round()),
            _ => return format!("each curve ×{} over the last", self.size),
        };
        format!("each curve {amount} above the last")
    }

    /// Adds a curve with its name at the end, over its own zero.
    fn curve(self, chart: Chart, drawn: &[&Drawn<'_>], rank: usize, name: &str) -> Chart {
        let runs = drawn.iter().flat_map(|drawn| drawn.runs(0, self.scale));
        let places = || {
            drawn
                .iter()
                .flat_map(|drawn| drawn.points(0).iter().copied())
        };
        let last = places()
            .filter(|place| place.iter().all(|u| u.is_finite()))
            .max_by(|[a, _], [b, _]| a.total_cmp(b));
        let mut chart = chart.curve(Curve {
            label: String::new(),
            runs: runs.collect(),
        });
        if let Some(point) = last {
            let label = name.to_owned();
            chart = chart.text(Note { label, point });
        }
        if self.scale != Scale::Linear {
            return chart;
        }
        let [low, high] = places()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [x, _]| {
                [low.min(x), high.max(x)]
            });
        let zero = self.raised(0.0, rank);
        chart.reference(Series {
            label: String::new(),
            points: vec![[low, zero], [high, zero]],
        })
    }
}

/// The next of one, two and five times a power of ten.
fn round_up(size: f64) -> f64 {
    let power = size.log10().floor();
    let unit = 10_f64.powf(power.abs());
    let unit = |digit: f64| {
        if power < 0.0 {
            digit / unit
        } else {
            digit * unit
        }
    };
    let digits = [1.0, 2.0, 5.0].map(unit);
    let found = digits
        .into_iter()
        .find(|round| *round >= size * (1.0 - 1e-12));
    found.unwrap_or(unit(10.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (size, expected) in [
            (0.07, 0.1),
            (0.2, 0.2),
            (0.21, 0.5),
            (3.0, 5.0),
            (7.0, 10.0),
            (1e-7, 1e-7),
        ] {
            assert_eq!(round_up(size), expected, "{size}");
        }
    }
}
