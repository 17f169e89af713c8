//! A chart of what moves an event most: a bar for each parameter, the longest on top.
//!
//! To first order an uncertainty `u` of a parameter `p` moves the place `lambda` by `u dlambda/dp`, to either side.
//!
//! Source: Eschenbach (1992), Spiderplots versus tornado diagrams for sensitivity analysis, Interfaces 22.

use hertzian_chart::{Bar, Chart, Series};

use crate::branches::branch::Branch;
use crate::branches::point::Event;
use crate::error::Error;
use crate::model::request::RequestError;
use crate::numeric::decimal::Decimal;
use crate::report::labels::Labels;
use crate::report::picture::plain;
use crate::report::prefix::with_unit;
use crate::report::unit::with;
use crate::report::view::View;
use crate::sensitivity::{Sensitivities, Uncertain};

/// What is taken where nothing is said of uncertainties: of every parameter a hundredth.
const USUAL: f64 = 0.01;
/// Digits of what is written beside bars.
const DIGITS: i32 = 3;

impl Branch {
    /// A chart of how an event of this branch moves with parameters, by its [derivatives](Self::event_sensitivities): a bar for each of the
    /// uncertainties, or for one per cent of every parameter where there are none. The dark part is where a larger parameter moves it.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param zeta in 0.0..;
    ///         param drive;
    ///         ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { zeta: 0.05, drive: 0.2 };
    /// let branch = FrequencyResponse::of(&model).from(0.5).to(2.0).run()?;
    /// let fold = branch.folds().next().unwrap();
    /// let moves = branch.event_sensitivities(fold)?;
    /// let chart = branch.tornado(fold, &moves, &["zeta=10%".parse()?, "drive=0.01".parse()?])?;
    /// assert!(chart.to_svg().contains("zeta = 0.05 ± 10 %"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no parameter of a name, or the branch is a [backbone](crate::backbone), which has no such derivatives.
    pub fn tornado(
        &self,
        event: &Event,
        moves: &Sensitivities,
        uncertain: &[Uncertain],
    ) -> Result<Chart, Error> {
        self.is_no_backbone()?;
        let usual;
        let uncertain = if uncertain.is_empty() {
            usual = self.usual()?;
            &usual
        } else {
            uncertain
        };
        let place = event.point.value;
        let mut moved: Vec<(f64, Bar)> = Vec::new();
        let mut held: Vec<&str> = Vec::new();
        for own in uncertain {
            let index = place_of(moves, own.name())?;
            let Some(by) = moves.place.get(index).copied().flatten() else {
                held.push(own.name());
                continue;
            };
            let value = moves.values[index];
            let shift = by.value * own.of(value);
            let parameter = self.written(own, value);
            moved.push((shift.abs(), self.bar(parameter, place, shift)));
        }
        moved.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        let count = moved.len();
        let bars: Vec<Bar> = moved.into_iter().map(|(_, bar)| bar).collect();
        let labels = Labels::of(&View::new().seen(self, self.leading()));
        let unit = self.model.unit_of_varied(&self.varied);
        let at = with(&Decimal::to_error(place, event.error).to_string(), unit);
        let chart = Chart::new(format!(
            "{}: {} at {} = {at}",
            self.model.name, event.kind, self.varied
        ))
        .x(&labels.varied)
        .bars(bars, ["parameter larger", "parameter smaller"])
        .reference(Series::new("", [[place, 0.0], [place, 1.0]]))
        .remark("first order: the place and its derivative times the uncertainty");
        let chart = if count == 0 {
            chart.remark("nothing else is uncertain")
        } else {
            chart
        };
        let chart = held.iter().fold(chart, |chart, name| {
            chart.remark(self.why_held(moves, name))
        });
        Ok(if self.model.is_plain() {
            plain(chart, &[])
        } else {
            chart
        })
    }

    /// Why a parameter does not move a place.
    fn why_held(&self, moves: &Sensitivities, name: &str) -> String {
        if name == self.varied {
            return format!("{name} is what is varied: the place is one of its values");
        }
        let what = format!("place by {name}");
        let mut missing = moves.missing.iter();
        let why = missing.find(|missing| missing.what == what);
        let why = why.map_or("the place has no derivative by it", |missing| &missing.why);
        format!("{name}: {why}")
    }

    /// One per cent of every other parameter.
    fn usual(&self) -> Result<Vec<Uncertain>, Error> {
        let parameters = self.model.parameters.iter();
        let others = parameters.filter(|parameter| parameter.name != self.varied);
        others
            .map(|parameter| Uncertain::relative(&parameter.name, USUAL))
            .collect()
    }

    /// A parameter with its value and its uncertainty.
    fn written(&self, own: &Uncertain, value: f64) -> String {
        let mut parameters = self.model.parameters.iter();
        let parameter = parameters.find(|parameter| parameter.name == own.name());
        let unit = parameter.map_or("", |parameter| parameter.unit.as_str());
        let (name, size) = (own.name(), in_words(own));
        if own.is_relative() || unit.is_empty() {
            format!("{name} = {} ± {size}", with_unit(value, unit))
        } else {
            format!("{name} = ({} ± {size}) {unit}", Decimal::plain(value))
        }
    }

    fn bar(&self, label: String, place: f64, shift: f64) -> Bar {
        let unit = self.model.unit_of_varied(&self.varied);
        let text = |shift: f64| {
            let sign = if shift < 0.0 { '−' } else { '+' };
            with(&format!("{sign}{}", significant(shift.abs())), unit)
        };
        Bar {
            label,
            middle: place,
            ends: [place + shift, place - shift],
            texts: [text(shift), text(-shift)],
        }
    }
}

/// A number with a few digits.
fn significant(value: f64) -> Decimal {
    if value == 0.0 || !value.is_finite() {
        return Decimal::plain(value);
    }
    let first = value.log10().floor() as i32;
    Decimal::to_error(value, 10_f64.powi(first + 1 - DIGITS))
}

/// How large an uncertainty is: `5 %`.
fn in_words(own: &Uncertain) -> String {
    own.written_size().replace('%', " %")
}

/// Where a variable stands.
///
/// # Errors
/// If there is none of that name.
fn place_of(moves: &Sensitivities, name: &str) -> Result<usize, Error> {
    let place = moves.variables.iter().position(|own| own == name);
    place.ok_or_else(|| {
        RequestError::UnknownParameter {
            name: name.to_owned(),
            known: moves.variables.clone(),
        }
        .into()
    })
}
