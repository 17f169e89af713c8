//! What a chart shows of branches: which signal, measured how, on which scale, and over which frequency.

use hertzian_chart::Scale;

use crate::branches::branch::Branch;
use crate::branches::point::Point;
use crate::error::Error;
use crate::event::EventKind;
use crate::model::request::RequestError;
use crate::numeric::fourier::series;
use crate::orbit::observe::{Measure, Wanted};
use crate::report::error::ViewError;
use crate::report::unit::{in_unit, with};

/// What is at the axis of the excitation frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Frequency {
    /// The angle per time, `omega`.
    #[default]
    Omega,
    /// Periods per time, `omega/(2 pi)`.
    Hertz,
    /// Periods per sixty units of time.
    Rpm,
}

impl Frequency {
    /// The number at the axis.
    pub fn of(self, omega: f64) -> f64 {
        match self {
            Self::Omega => omega,
            Self::Hertz => omega / std::f64::consts::TAU,
            Self::Rpm => 60.0 * omega / std::f64::consts::TAU,
        }
    }

    /// What the axis is called, in a model with units and without.
    pub(crate) fn label(self, units: bool) -> String {
        self.named("excitation frequency", units)
    }

    /// The same of the lines of a spectrum.
    pub(crate) fn label_of_lines(self, units: bool) -> String {
        self.named("frequency", units)
    }

    fn named(self, name: &str, units: bool) -> String {
        let name = match (self, units) {
            (Self::Omega, _) => format!("{name} ω"),
            (_, true) => name.to_owned(),
            (Self::Hertz, false) => format!("{name} ω/2π"),
            (Self::Rpm, false) => format!("{name} 60 ω/2π"),
        };
        in_unit(&name, self.unit(units))
    }

    /// The unit at the axis, in a model with units and without.
    pub(crate) fn unit(self, units: bool) -> &'static str {
        match self {
            _ if !units => "",
            Self::Omega => "rad/s",
            Self::Hertz => "Hz",
            Self::Rpm => "rpm",
        }
    }

    /// A sign for the number at the axis.
    pub(crate) fn symbol(self) -> &'static str {
        match self {
            Self::Omega => "ω",
            Self::Hertz => "ω/2π",
            Self::Rpm => "60 ω/2π",
        }
    }
}

/// What a chart shows: one number of each orbit over what is varied. By default [what leads](Branch::leading), over `omega`.
///
/// ```
/// use hertzian::FrequencyResponse;
/// use hertzian::chart::{Frequency, View};
///
/// hertzian::oscillator! {
///     Mount(x: mm) {
///         param m: t = 1e-3 > 0;
///         param c: N*s/mm = 0.02;
///         param k: N/mm = 40;
///         param drive: N = 2;
///         m*ddot(x) + c*dot(x) + k*x = drive*cos(omega*t);
///         /// what an accelerometer shows
///         output shaking: m/s^2 = ddot(x);
///     }
/// }
///
/// let branch = FrequencyResponse::of(&Mount::default()).from(100.0).to(300.0).run()?;
/// let view = View::new().of("shaking:rms".parse()?).frequency(Frequency::Hertz);
/// let svg = branch.chart_of(&view)?.to_svg();
/// assert!(svg.contains("rms of shaking (what an accelerometer shows) [m/s^2]"));
/// assert!(svg.contains("excitation frequency [Hz]"));
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct View {
    pub(crate) wanted: Option<Wanted>,
    pub(crate) frequency: Frequency,
    pub(crate) scale: Scale,
    pub(crate) events: Option<Vec<EventKind>>,
    pub(crate) harmonics: usize,
}

impl View {
    /// What leads, over `omega`.
    pub fn new() -> Self {
        Self::default()
    }

    hertzian_contract::setters! { self:
        /// The signal and what is measured of it: `"tip:rms".parse()?`.
        of(wanted: Wanted) { self.wanted = Some(wanted) }

        /// What is at the axis of the excitation frequency.
        frequency(frequency: Frequency) { self.frequency = frequency }

        /// The scale of what is measured. A logarithm takes what is positive: what is negative anywhere is refused, orbits at zero are left
        /// out, and the chart says how many. Decibels are twenty times the logarithm to the base ten of the value over one unit, which
        /// stands at the axis.
        scale(scale: Scale) { self.scale = scale }

        /// The amplitudes of the first harmonics of the signal, so many, upon each other: at the excitation frequency, twice of it, and so
        /// on, whatever the period of an orbit. Zero for what is measured otherwise.
        harmonics(count: usize) { self.harmonics = count }
    }

    /// Events of these kinds alone are marked; the chart says how many others there are. Of grazing, both that at which the branch turns
    /// and that at which it does not.
    #[must_use]
    pub fn events(mut self, kinds: impl IntoIterator<Item = EventKind>) -> Self {
        self.events = Some(kinds.into_iter().collect());
        self
    }

    /// The same of a branch: what leads on it where nothing else was asked for.
    ///
    /// # Errors
    /// If nothing has the name, or what is measured is not one of it.
    pub(crate) fn on<'b>(&self, branch: &'b Branch) -> Result<Seen<'b>, Error> {
        let wanted = self.wanted.clone().unwrap_or_else(|| branch.leading());
        branch.model.check(&wanted)?;
        if self.harmonics > 0 {
            self.has_harmonics(branch, &wanted)?;
            return Ok(self.seen(branch, wanted));
        }
        // What is wrong with one orbit is wrong with all.
        if let Some(point) = branch.points.first() {
            let measured = branch.measured(&wanted, point)?;
            if measured.is_none() {
                has_harmonic(branch, &wanted)?;
            }
        }
        Ok(self.seen(branch, wanted))
    }

    /// The same of another branch of one diagram.
    pub(crate) fn seen<'b>(&self, branch: &'b Branch, wanted: Wanted) -> Seen<'b> {
        Seen {
            branch,
            wanted,
            frequency: self.frequency,
            scale: self.scale,
            harmonics: self.harmonics,
        }
    }

    /// Whether an orbit of the branch has all harmonics that are asked for, and their amplitudes are what is.
    fn has_harmonics(&self, branch: &Branch, wanted: &Wanted) -> Result<(), Error> {
        let Wanted { name, measure } = wanted;
        let count = self.harmonics;
        if *measure != Measure::PeakToPeak {
            let (name, measure) = (name.clone(), measure.in_words());
            return Err(ViewError::NoAmplitude {
                name,
                count,
                measure,
            }
            .into());
        }
        let each = |point: &Point| (point.orbit.omega / point.orbit.base).round();
        let multiple = branch.points.iter().map(each).fold(f64::INFINITY, f64::min);
        let harmonic = if multiple.is_finite() {
            count * multiple as usize
        } else {
            0
        };
        if let Some(point) = branch.points.first() {
            branch.reading(name, point)?;
        }
        let wanted = Wanted {
            name: name.clone(),
            measure: Measure::Amplitude(harmonic),
        };
        has_harmonic(branch, &wanted)
    }
}

/// Whether an orbit of the branch has the harmonic that is asked for.
///
/// # Errors
/// If none has.
fn has_harmonic(branch: &Branch, wanted: &Wanted) -> Result<(), Error> {
    let mut highest = 0;
    for point in &branch.points {
        let harmonics = match point.orbit.harmonics() {
            // Each of them is known by its states then, and has as many as the others.
            0 if highest == 0 => series::harmonics(&branch.reading(&wanted.name, point)?.series),
            harmonics => harmonics,
        };
        highest = highest.max(harmonics);
    }
    match wanted.measure {
        Measure::Amplitude(harmonic) | Measure::Phase(harmonic) if harmonic > highest => {
            Err(RequestError::NoHarmonic {
                name: wanted.name.clone(),
                harmonic,
                highest,
            }
            .into())
        }
        _ => Ok(()),
    }
}

/// A branch as a chart shows it.
#[derive(Debug, Clone)]
pub(crate) struct Seen<'b> {
    pub(crate) branch: &'b Branch,
    pub(crate) wanted: Wanted,
    pub(crate) frequency: Frequency,
    pub(crate) scale: Scale,
    /// How many harmonics are shown instead of one measure.
    pub(crate) harmonics: usize,
}

impl Seen<'_> {
    /// What is varied, as the axis has it.
    pub(crate) fn varied(&self, value: f64) -> f64 {
        if self.branch.varied == "omega" {
            self.frequency.of(value)
        } else {
            value
        }
    }

    /// The vertical axis.
    pub(crate) fn label(&self) -> String {
        let model = &self.branch.model;
        let (name, measure) = (&self.wanted.name, self.wanted.measure);
        if name.is_empty() {
            return String::new();
        }
        let mut outputs = model.outputs.iter();
        let output = outputs.find(|output| output.name == *name);
        let documentation = output.map_or("", |output| &output.documentation);
        let text = match self.harmonics {
            0 => format!("{} of {name}", measure.in_words()),
            _ => format!("amplitudes of {name} at multiples of ω"),
        };
        let line = documentation.lines().next().unwrap_or_default().trim();
        let text = if line.is_empty() {
            text
        } else {
            format!("{text} ({line})")
        };
        in_unit(&text, &self.unit())
    }

    /// The unit of the vertical axis; of decibels what they are over.
    pub(crate) fn unit(&self) -> String {
        let unit = self.branch.model.unit_of(&self.wanted.name);
        let unit = self.wanted.measure.unit(unit);
        match self.scale {
            Scale::Decibel => format!("dB over {}", with("1", &unit)),
            _ => unit,
        }
    }
}
