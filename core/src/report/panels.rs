//! Everything of one orbit on one page.

use hertzian_chart::{Chart, Note, Page, Scale, Series};

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::numeric::decimal::Decimal;
use crate::orbit::observe::{Measure, SpectrumLine, Wanted};
use crate::report::drawn::Drawn;
use crate::report::unit::{in_unit, with};
use crate::report::view::{Frequency, Seen, View};

/// Lines of a spectrum that are smaller than this part of the largest are not drawn, on a linear axis and on another.
const SMALLEST: [f64; 2] = [1e-4, 1e-10];
/// Contacts whose forces are drawn, at most.
const CONTACTS: usize = 8;
/// Digits of values in titles, and of the mean.
const DIGITS: usize = 6;

impl Branch {
    /// A page about one orbit: the response with the orbit marked, the spectrum of the signal that the view shows, its motion over the
    /// period, and the forces of the contacts over the period. The spectrum is on the scale of the view. Of an orbit by shooting, motion and
    /// forces are those of the 20 harmonics in each period of the excitation that [`complete`](Self::complete) has.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    /// use hertzian::chart::View;
    ///
    /// hertzian::oscillator! {
    ///     Stopped(x) {
    ///         law stop(gap) { gap > 0 => 10*gap, else => 0 }
    ///         ddot(x) + 0.1*dot(x) + x + stop(x - 1) = 0.3*cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Stopped {}).from(0.5).to(1.5).run()?;
    /// let view = View::new();
    /// // Where somebody clicked on the chart.
    /// if let Some(orbit) = branch.nearest([1.2, 2.5], &view)? {
    ///     let page = branch.panels(orbit, &view)?.to_svg();
    ///     assert!(page.contains("force of stop"));
    /// }
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As of [`chart_of`](Self::chart_of) and [`reading`](Self::reading).
    pub fn panels(&self, point: &Point, view: &View) -> Result<Page, Error> {
        let seen = view.on(self)?;
        let here = self.place_of(point, seen.frequency);
        let place = [seen.varied(point.value), seen.sizes(point)[0]];
        let response = self.chart_of(view)?.note(Note {
            label: format!("{here}, {}", point.stability.verdict),
            point: place,
        });
        let mut motion = self.motion(&seen, point, &here)?;
        let forces = match self.system() {
            _ if self.model.contacts.is_empty() => None,
            Some(_) => Some(self.forces(point, &here)?),
            None => {
                motion = motion.remark(
                    "no forces: the branch was read from a file, and takes its model for them",
                );
                None
            }
        };
        let page = Page::new(2)
            .chart(response)
            .chart(self.spectrum(&seen, point, &here)?)
            .chart(motion);
        Ok(forces.into_iter().fold(page, Page::chart))
    }

    /// Where an orbit is along its branch, as titles say it: `ω = 0.5`.
    pub(crate) fn place_of(&self, point: &Point, frequency: Frequency) -> String {
        let (name, unit, value) = match self.varied.as_str() {
            "omega" => {
                let unit = frequency.unit(!self.model.units.is_empty());
                (frequency.symbol(), unit, frequency.of(point.value))
            }
            varied => (varied, self.model.unit_of_varied(varied), point.value),
        };
        format!("{name} = {}", with(&short(value), unit))
    }

    /// The orbit whose place on the chart is nearest to a place on it, of which one has the axes: what somebody means who clicks there. `None`
    /// of a branch without orbits that have a place.
    ///
    /// # Errors
    /// As of [`chart_of`](Self::chart_of).
    pub fn nearest(&self, place: [f64; 2], view: &View) -> Result<Option<&Point>, Error> {
        let mut drawn = Drawn::of(view.on(self)?);
        view.check(std::slice::from_mut(&mut drawn))?;
        let level = |y: f64| match view.scale {
            Scale::Linear => y,
            _ => y.ln(),
        };
        let places = drawn.points(0).iter().map(|[x, y]| [*x, level(*y)]);
        let places: Vec<[f64; 2]> = places.collect();
        let known = || places.iter().filter(|p| p.iter().all(|u| u.is_finite()));
        let width = |k: usize| {
            let (low, high) = known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                (low.min(p[k]), high.max(p[k]))
            });
            if high > low { high - low } else { 1.0 }
        };
        let (widths, [x, y]) = ([width(0), width(1)], [place[0], level(place[1])]);
        let off = |p: &[f64; 2]| ((p[0] - x) / widths[0]).hypot((p[1] - y) / widths[1]);
        let all = self
            .points
            .iter()
            .zip(&places)
            .map(|(point, p)| (point, off(p)));
        let near = all.filter(|(_, off)| off.is_finite());
        Ok(near
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(point, _)| point))
    }

    /// The amplitudes of the harmonics of an orbit over their frequencies.
    fn spectrum(&self, seen: &Seen<'_>, point: &Point, here: &str) -> Result<Chart, Error> {
        let (name, scale) = (&seen.wanted.name, seen.scale);
        let spectrum = self.reading(name, point)?.spectrum();
        let (mean, lines) = spectrum
            .split_first()
            .map_or((0.0, &[][..]), |(mean, lines)| (mean.amplitude, lines));
        let largest = lines.iter().fold(0.0, |m: f64, line| m.max(line.amplitude));
        let part = SMALLEST[usize::from(scale != Scale::Linear)];
        let is_drawn = |line: &&SpectrumLine| line.amplitude > part * largest;
        let drawn: Vec<[f64; 2]> = lines
            .iter()
            .filter(is_drawn)
            .map(|line| [seen.frequency.of(line.omega), line.amplitude])
            .collect();
        let least = drawn.iter().fold(f64::INFINITY, |m: f64, [_, a]| m.min(*a));
        let foot = if scale == Scale::Linear {
            0.0
        } else {
            0.5 * least
        };
        // From zero to half a line beyond the last, along the foot.
        let base = seen.frequency.of(point.orbit.base);
        let last = drawn.last().map_or(base, |[x, _]| x + 0.5 * base);
        let stems = drawn
            .iter()
            .flat_map(|&[x, a]| [[x, foot], [x, a], [f64::NAN; 2]]);
        let stems = stems.chain([[0.0, foot], [last, foot]]).collect();
        let unit = self.model.unit_of(name);
        let amplitude = Seen {
            wanted: Wanted {
                name: name.clone(),
                measure: Measure::Amplitude(1),
            },
            ..seen.clone()
        };
        let (count, left) = (lines.len(), lines.len() - drawn.len());
        let mut chart = Chart::new(format!("spectrum of {name} at {here}"))
            .x(seen.frequency.label_of_lines(!self.model.units.is_empty()))
            .y(in_unit(&format!("amplitude of {name}"), &amplitude.unit()))
            .scales(Scale::Linear, scale)
            .trace(Series {
                label: String::new(),
                points: stems,
            })
            .markers(Series {
                label: String::new(),
                points: drawn,
            });
        let mean = with(&short(mean), unit);
        chart = chart.remark(format!("mean {mean}"));
        if left > 0 {
            chart = chart.remark(format!(
                "{left} of {count} harmonics are smaller than {part:.0e} of the largest, and not drawn"
            ));
        }
        Ok(chart)
    }

    /// The signal over the period.
    fn motion(&self, seen: &Seen<'_>, point: &Point, here: &str) -> Result<Chart, Error> {
        let name = &seen.wanted.name;
        Ok(Chart::new(format!("{name} over the period at {here}"))
            .x(self.time())
            .y(in_unit(name, self.model.unit_of(name)))
            .trace(Series {
                label: String::new(),
                points: self.waveform(name, point)?,
            }))
    }

    /// The forces of the contacts over the period.
    fn forces(&self, point: &Point, here: &str) -> Result<Chart, Error> {
        let names = &self.model.contacts;
        let units = &self.model.force_units;
        let alike = units.windows(2).all(|pair| pair[0] == pair[1]);
        let mut forces = Vec::new();
        for name in names {
            let points = self.waveform(name, point)?;
            let largest = points.iter().fold(0.0, |m: f64, [_, y]| m.max(y.abs()));
            let label = match names.len() {
                1 => String::new(),
                _ => in_unit(name, if alike { "" } else { self.model.unit_of(name) }),
            };
            forces.push((largest, Series { label, points }));
        }
        let (count, drawn) = (forces.len(), forces.len().min(CONTACTS));
        if count > drawn {
            forces.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        }
        let what = match &names[..] {
            [name] => format!("force of {name}"),
            _ => "force of contacts".to_owned(),
        };
        let unit = units.first().filter(|_| alike).map_or("", String::as_str);
        let chart = Chart::new(format!("{what} over the period at {here}"))
            .x(self.time())
            .y(in_unit(&what, unit));
        let forces = forces.into_iter().take(drawn).map(|(_, force)| force);
        let chart = forces.fold(chart, Chart::trace);
        Ok(if count > drawn {
            chart.remark(format!(
                "{drawn} of {count} contacts: those with the largest forces"
            ))
        } else {
            chart
        })
    }

    fn time(&self) -> &'static str {
        if self.model.units.is_empty() {
            "time"
        } else {
            "time [s]"
        }
    }
}

/// A number with so many digits as a title has room for, and no zeros behind them.
fn short(value: f64) -> String {
    let rounded = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
    Decimal::plain(rounded).to_string()
}
