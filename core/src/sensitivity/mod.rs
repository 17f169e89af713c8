//! Derivatives of what is read off orbits, and of where events are, by the frequency and by every parameter of the declaration.
//!
//! An orbit by whatever method is taken as a state that returns to itself, and everything is differentiated along its motion in time:
//! exponents, levels, the motion of switches, one-sided limits at them. `cycle` has the equations, `slopes` signals at one instant,
//! `scan` where an orbit switches and has extremes, `moments` what is read off, `place` how events move.

mod cycle;
mod error;
mod moments;
mod place;
mod scan;
mod slopes;

use std::sync::Arc;

pub use error::SensitivityError;

use crate::branches::branch::{Branch, Model, Source};
use crate::branches::point::{Event, Point};
use crate::cancel::Cancel;
use crate::error::Error;
use crate::event::EventKind;
use crate::model::request::RequestError;
use crate::orbit::observe::{Measure, Wanted};
use crate::system::{System, Variable};
use cycle::Cycle;
use moments::{Along, Needs, Places, Reader, Slope};
use slopes::{Asked, Slopes};

/// Tolerance of the flow and nodes of a rule, and those that errors are told by.
const FINE: (f64, usize) = (1e-12, 24);
const COARSE: (f64, usize) = (1e-10, 16);
/// Those where no errors are asked for.
const QUICK: (f64, usize) = (1e-9, 12);
/// Harmonics that are read off where nothing is asked for by name.
const HARMONICS: usize = 5;
/// Roundings of a derivative, times the condition of the equations.
const ROUNDINGS: f64 = 8.0;

/// A derivative with its error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Derivative {
    /// Its value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Estimated error: how much another tolerance of the flow and other nodes change it, and roundings times the condition of the orbit's
    /// equations. Infinite where it was not asked for.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub error: f64,
}

/// What is read off an orbit, with its derivatives.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Measured {
    /// What it is, as [`Wanted`] is written: `x:p2p`; `power` is the mean power of the load.
    pub name: String,
    /// Its unit; empty where there is none.
    pub unit: String,
    /// Its value.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub value: f64,
    /// Its derivative by each of [`Sensitivities::variables`], all others fixed.
    pub by: Vec<Derivative>,
}

/// Derivatives at an orbit or at an event.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Sensitivities {
    /// What the derivatives are by: `omega`, then the parameters in the order of the declaration.
    pub variables: Vec<String>,
    /// Their values.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub values: Vec<f64>,
    /// What the branch varies.
    pub varied: String,
    /// The kind of an event; `None` of any other orbit.
    pub kind: Option<EventKind>,
    /// Derivatives of the place of an event, a value of what is varied, by each of the variables: none by that itself. Empty of any other orbit.
    pub place: Vec<Option<Derivative>>,
    /// What is read off the orbit, at a fixed value of what is varied. Empty at a fold: there these derivatives are unbounded, as the inverse of the
    /// distance along the branch.
    pub measured: Vec<Measured>,
    /// How far the orbit's equations are from singular ones, as a part of their size: zero at a fold. Derivatives at a fixed value of what is
    /// varied grow as its inverse.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub condition: f64,
}

impl Sensitivities {
    /// The derivative of what is read off by a variable, by their names; `None` where there is none of that name.
    pub fn of(&self, name: &str, variable: &str) -> Option<Derivative> {
        let index = self.variables.iter().position(|own| own == variable)?;
        let measured = self
            .measured
            .iter()
            .find(|measured| measured.name == name)?;
        measured.by.get(index).copied()
    }

    /// The derivative of the place of an event by a variable, by its name.
    pub fn of_place(&self, variable: &str) -> Option<Derivative> {
        let index = self.variables.iter().position(|own| own == variable)?;
        self.place.get(index).copied().flatten()
    }
}

impl Branch {
    /// Derivatives of what is read off an orbit of this branch, by the frequency and by every parameter of the declaration, exponents
    /// included, each with its error: of extremes, peak-to-peak, mean, rms, crest factor and five harmonics of every coordinate and output, of
    /// the forces of contacts, the part of the period on each piece of their laws, and the power of the load. The orbit is found again from switch to
    /// switch, so that they are those of the true orbit, whatever method followed the branch.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) {
    ///         param zeta in 0.0..;
    ///         ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear { zeta: 0.1 }).from(0.5).to(1.5).run()?;
    /// let at = branch.sensitivities(&branch.at(1.0)?[0])?;
    /// // At resonance peak-to-peak is 1 / zeta.
    /// let by_zeta = at.of("x:p2p", "zeta").unwrap();
    /// assert!((by_zeta.value + 100.0).abs() < 1e-8);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If the branch was read from a file and has no [model](Self::attach), the orbit is at a fold or is not found again.
    pub fn sensitivities(&self, point: &Point) -> Result<Sensitivities, Error> {
        let problem = Sensitive::of(self, point)?;
        problem.of_point(&problem.all())
    }

    /// The same of what is asked for alone: `"x:rms".parse()?`.
    ///
    /// # Errors
    /// As [`sensitivities`](Self::sensitivities), and if nothing has such a name or it has no derivative, as a number of impacts.
    pub fn sensitivities_of(
        &self,
        point: &Point,
        wanted: &[Wanted],
    ) -> Result<Sensitivities, Error> {
        let problem = Sensitive::of(self, point)?;
        let rows = wanted.iter().map(|wanted| problem.row(wanted));
        let rows = rows.collect::<Result<Vec<Row>, Error>>()?;
        problem.of_point(&rows)
    }

    /// As [`sensitivities_of`](Self::sensitivities_of), by some variables alone (`"omega"`, or parameters) and in a fraction of the time: to eight
    /// digits as a rule, but without errors, which are infinite. For who needs many of them, as a fit does.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) {
    ///         param zeta in 0.0..;
    ///         param drive;
    ///         ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear { zeta: 0.1, drive: 1.0 }).from(0.5).to(1.5).run()?;
    /// let at = branch.quick_sensitivities_of(&branch.at(1.0)?[0], &["x:p2p".parse()?], &["zeta"])?;
    /// assert_eq!(at.variables, ["zeta"]);
    /// assert!((at.of("x:p2p", "zeta").unwrap().value + 100.0).abs() < 1e-5);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`sensitivities_of`](Self::sensitivities_of), and if there is no such parameter.
    pub fn quick_sensitivities_of(
        &self,
        point: &Point,
        wanted: &[Wanted],
        by: &[&str],
    ) -> Result<Sensitivities, Error> {
        let mut problem = Sensitive::of(self, point)?;
        let variables = by.iter().map(|name| problem.variable(name));
        problem.variables = variables.collect::<Result<_, Error>>()?;
        let rows = wanted.iter().map(|wanted| problem.row(wanted));
        let rows = rows.collect::<Result<Vec<Row>, Error>>()?;
        problem.quick(&rows)
    }

    /// Derivatives of where an event of this branch is: of a fold, or of an orbit that grazes a level. Other events take second derivatives of the
    /// motion and have none here. At a fold nothing else is read off: at a fixed value of what is varied those derivatives are unbounded.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    ///
    /// hertzian::oscillator! {
    ///     Duffing(x) {
    ///         param zeta in 0.0..;
    ///         param alpha > 0;
    ///         ddot(x) + 2*zeta*dot(x) + x + sgn(x)*|x|^alpha = 0.2*cos(omega*t);
    ///     }
    /// }
    ///
    /// let model = Duffing { zeta: 0.05, alpha: 3.0 };
    /// let branch = FrequencyResponse::of(&model).from(0.5).to(2.0).run()?;
    /// let fold = branch.folds().next().unwrap();
    /// let moves = branch.event_sensitivities(fold)?;
    /// // More damping, and the upper branch ends at a lower frequency.
    /// assert!(moves.of_place("zeta").unwrap().value < 0.0);
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    ///
    /// # Errors
    /// If the kind of event has none, the branch was read from a file and has no [model](Self::attach), or the event is not found again.
    pub fn event_sensitivities(&self, event: &Event) -> Result<Sensitivities, Error> {
        Sensitive::of(self, &event.point)?.of_event(event)
    }
}

/// What is read of which signal.
#[derive(Debug, Clone)]
struct Row {
    name: String,
    unit: String,
    asked: Asked,
    measure: Measure,
}

/// An orbit of a system whose derivatives are asked for.
struct Sensitive<'p> {
    system: Arc<dyn System>,
    model: Model,
    point: &'p Point,
    varied: Variable,
    name: String,
    variables: Vec<Variable>,
    cancel: Cancel,
}

/// Derivatives by one flow and one rule.
struct Once {
    states: Vec<f64>,
    slopes: Vec<Slope>,
    condition: f64,
}

impl<'p> Sensitive<'p> {
    fn of(branch: &Branch, point: &'p Point) -> Result<Self, Error> {
        let system = branch.system().ok_or(RequestError::Detached)?.shared();
        let parameters = 0..system.facts().parameters.len();
        let facts = &system.facts().parameters;
        let varied = facts.iter().position(|facts| facts.name == branch.varied);
        Ok(Self {
            variables: std::iter::once(Variable::Omega)
                .chain(parameters.map(Variable::Parameter))
                .collect(),
            model: Model::of(system.as_ref()),
            varied: varied.map_or(Variable::Omega, Variable::Parameter),
            name: branch.varied.clone(),
            point,
            system,
            cancel: Cancel::new(),
        })
    }

    fn row(&self, wanted: &Wanted) -> Result<Row, Error> {
        row(&self.model, wanted)
    }

    /// What has a name: the frequency, or a parameter.
    fn variable(&self, name: &str) -> Result<Variable, Error> {
        let mut parameters = self.model.parameters.iter();
        let index = parameters.position(|parameter| parameter.name == name);
        let known = self.model.parameters.iter();
        let unknown = || RequestError::UnknownParameter {
            name: name.to_owned(),
            known: known.map(|parameter| parameter.name.clone()).collect(),
        };
        match index {
            None if name == "omega" => Ok(Variable::Omega),
            None => Err(unknown().into()),
            Some(index) => Ok(Variable::Parameter(index)),
        }
    }

    /// By one flow, without errors.
    fn quick(&self, rows: &[Row]) -> Result<Sensitivities, Error> {
        let mut cycle = self.cycle(QUICK.0)?;
        let states = cycle.states(&self.point.orbit)?;
        let once = self.once(&mut cycle, states, rows, QUICK.1)?;
        let measured = rows.iter().zip(once.slopes).map(|(row, slope)| Measured {
            name: row.name.clone(),
            unit: row.unit.clone(),
            value: slope.value,
            by: (slope.by.into_iter())
                .map(|value| Derivative {
                    value,
                    error: f64::INFINITY,
                })
                .collect(),
        });
        let measured = measured.filter(|measured| !measured.value.is_nan());
        Ok(self.told(None, Vec::new(), measured.collect(), once.condition))
    }

    /// Everything that is read off.
    fn all(&self) -> Vec<Row> {
        let mut measures = vec![
            Measure::PeakToPeak,
            Measure::Maximum,
            Measure::Minimum,
            Measure::Mean,
            Measure::Rms,
            Measure::CrestFactor,
        ];
        let harmonics = (1..=HARMONICS).flat_map(|h| [Measure::Amplitude(h), Measure::Phase(h)]);
        measures.extend(harmonics);
        let outputs = self.model.outputs.iter().map(|output| &output.name);
        let moving: Vec<&String> = outputs.chain(&self.model.coordinates).collect();
        let of_motions = moving.into_iter().flat_map(|name| {
            let measures = measures.iter();
            measures.map(|&measure| (name.clone(), measure))
        });
        let contacts = self.model.contacts.iter().zip(&self.model.pieces);
        let of_contacts = contacts.flat_map(|(name, &pieces)| {
            let extremes = [Measure::Maximum, Measure::Minimum, Measure::Mean];
            let pieces = (1..=pieces).map(Measure::OnPiece);
            let measures = extremes.into_iter().chain(pieces);
            measures.map(|measure| (name.clone(), measure))
        });
        let wanted = of_motions.chain(of_contacts);
        let rows = wanted.filter_map(|(name, measure)| {
            let wanted = Wanted { name, measure };
            self.row(&wanted).ok()
        });
        let power = Row {
            name: "power".to_owned(),
            unit: String::new(),
            asked: Asked::Power,
            measure: Measure::Mean,
        };
        rows.chain([power]).collect()
    }

    fn cycle(&self, tolerance: f64) -> Result<Cycle, Error> {
        let point = self.point;
        let (values, orbit) = (&point.parameters, &point.orbit);
        Cycle::new(
            &self.system,
            values,
            orbit,
            self.varied,
            tolerance,
            &self.cancel,
        )
    }

    fn of_point(&self, rows: &[Row]) -> Result<Sensitivities, Error> {
        let mut cycle = self.cycle(FINE.0)?;
        let states = cycle.states(&self.point.orbit)?;
        let fine = self.once(&mut cycle, states, rows, FINE.1)?;
        let mut cycle = self.cycle(COARSE.0)?;
        let coarse = self.once(&mut cycle, fine.states.clone(), rows, COARSE.1)?;
        let rounding = ROUNDINGS * f64::EPSILON / fine.condition;
        let both = fine.slopes.iter().zip(&coarse.slopes);
        let measured = rows.iter().zip(both).map(|(row, (fine, coarse))| {
            let largest = fine.by.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let by = fine.by.iter().zip(&coarse.by).map(|(&a, &b)| Derivative {
                value: a,
                error: (a - b).abs() + rounding * (a.abs() + f64::EPSILON * largest),
            });
            Measured {
                name: row.name.clone(),
                unit: row.unit.clone(),
                value: fine.value,
                by: by.collect(),
            }
        });
        // An amplitude that vanishes has no derivative, nor has its phase.
        let measured = measured.filter(|measured| !measured.value.is_nan());
        Ok(self.told(None, Vec::new(), measured.collect(), fine.condition))
    }

    fn told(
        &self,
        kind: Option<EventKind>,
        place: Vec<Option<Derivative>>,
        measured: Vec<Measured>,
        condition: f64,
    ) -> Sensitivities {
        let named = |variable: &Variable| match variable {
            Variable::Omega => "omega".to_owned(),
            Variable::Parameter(index) => self.model.parameters[*index].name.clone(),
        };
        let value = |variable: &Variable| match variable {
            Variable::Omega => self.point.orbit.omega,
            Variable::Parameter(index) => self.point.parameters[*index],
        };
        Sensitivities {
            variables: self.variables.iter().map(named).collect(),
            values: self.variables.iter().map(value).collect(),
            varied: self.name.clone(),
            kind,
            place,
            measured,
            condition,
        }
    }

    /// By one flow and one rule.
    fn once(
        &self,
        cycle: &mut Cycle,
        mut states: Vec<f64>,
        rows: &[Row],
        nodes: usize,
    ) -> Result<Once, Error> {
        cycle.set(self.varied, self.point.value)?;
        cycle.solve(&mut states)?;
        let mut asked: Vec<Asked> = Vec::new();
        for row in rows {
            if !asked.contains(&row.asked) {
                asked.push(row.asked);
            }
        }
        let mut slopes = Slopes::new(&self.system, &asked);
        slopes.set(&cycle.values, cycle.omega);
        let needs = needs(rows.iter().map(|row| row.measure), nodes);
        let places = Places::of(cycle, &slopes, &states, needs)?;
        let evaluated = cycle.evaluate(&states, &self.variables, &places.stops)?;
        let lu = evaluated.jacobian.clone().lu();
        let count = self.variables.len();
        let along = (0..count).map(|index| {
            let moved = lu.solve(&-&evaluated.by[index]);
            let mut weights = vec![0.0; count];
            weights[index] = 1.0;
            moved
                .map(|states| Along { states, weights })
                .ok_or(SensitivityError::Singular)
        });
        let along = along.collect::<Result<Vec<Along>, SensitivityError>>()?;
        let inverse = lu.try_inverse().ok_or(SensitivityError::Singular)?;
        let condition = 1.0 / (evaluated.jacobian.norm() * inverse.norm());
        let reader = Reader::new(&places, &slopes, &evaluated, &self.variables, &along, cycle);
        let moments = reader.moments();
        let measured = rows.iter().map(|row| {
            let none = || Slope {
                value: f64::NAN,
                by: vec![f64::NAN; count],
            };
            if let (Measure::OnPiece(piece), Asked::Contact(contact)) = (row.measure, row.asked) {
                let pieces = self.model.pieces[contact];
                return reader.on_pieces(contact, pieces)[piece - 1].clone();
            }
            let signal = asked.iter().position(|asked| *asked == row.asked);
            let measured = signal.and_then(|signal| moments[signal].measure(row.measure));
            measured.unwrap_or_else(none)
        });
        let slopes = measured.collect();
        Ok(Once {
            states,
            slopes,
            condition,
        })
    }

    fn of_event(&self, event: &Event) -> Result<Sensitivities, Error> {
        let others: Vec<Variable> = (self.variables.iter().copied())
            .filter(|variable| *variable != self.varied)
            .collect();
        let place = |cycle: &mut Cycle, states: &[f64]| match event.kind {
            EventKind::Fold => place::fold(cycle, states, self.point.value, &others),
            EventKind::Grazing { .. } => {
                let value = self.point.value;
                place::grazing(cycle, &self.system, states, value, &others)
            }
            kind => Err(SensitivityError::Kind { kind }),
        };
        let mut cycle = self.cycle(FINE.0)?;
        let states = cycle.states(&self.point.orbit)?;
        let fine = place(&mut cycle, &states)?;
        let coarse = place(&mut self.cycle(COARSE.0)?, &fine.states)?;
        let rounding = ROUNDINGS * f64::EPSILON;
        let mut both = fine.by.iter().zip(&coarse.by).map(|(&a, &b)| Derivative {
            value: a,
            error: (a - b).abs() + rounding * a.abs(),
        });
        let place = self.variables.iter().map(|variable| {
            let own = *variable == self.varied;
            if own { None } else { both.next() }
        });
        let place = place.collect();
        if event.kind == EventKind::Fold {
            return Ok(self.told(Some(event.kind), place, Vec::new(), 0.0));
        }
        let at = self.of_point(&self.all())?;
        Ok(self.told(Some(event.kind), place, at.measured, at.condition))
    }
}

/// What is asked for as a row.
///
/// # Errors
/// If nothing has that name, or it has no derivative.
fn row(model: &Model, wanted: &Wanted) -> Result<Row, Error> {
    if let Some(row) = row_of_rate(model, wanted) {
        return Ok(row);
    }
    let source = model.measurable(wanted)?;
    let without = matches!(wanted.measure, Measure::Impacts | Measure::Impulse);
    let of_motion = matches!(wanted.measure, Measure::OnPiece(_));
    if without || (of_motion && !matches!(source, Source::Contact(_))) {
        return Err(RequestError::NoContactMeasure {
            name: wanted.name.clone(),
            measure: wanted.measure.in_words(),
        }
        .into());
    }
    let unit = match source {
        Source::Output(index) => model.outputs[index].unit.clone(),
        Source::Coordinate(index) => model.units.get(index).cloned().unwrap_or_default(),
        Source::Contact(index) => model.force_units.get(index).cloned().unwrap_or_default(),
    };
    Ok(Row {
        name: wanted.to_string(),
        unit: wanted.measure.unit(&unit),
        asked: match source {
            Source::Output(index) => Asked::Output(index),
            Source::Coordinate(index) => Asked::Coordinate(index),
            Source::Contact(index) => Asked::Contact(index),
        },
        measure: wanted.measure,
    })
}

/// The rate `dot(x)` of a coordinate, or its acceleration `ddot(x)`.
fn row_of_rate(model: &Model, wanted: &Wanted) -> Option<Row> {
    let inside = |head: &str| wanted.name.strip_prefix(head)?.strip_suffix(')');
    let (name, asked): (&str, fn(usize) -> Asked) = match inside("ddot(") {
        Some(name) => (name, Asked::Acceleration),
        None => (inside("dot(")?, Asked::Rate),
    };
    let index = model.coordinates.iter().position(|own| own == name)?;
    let of_contact = matches!(
        wanted.measure,
        Measure::Impacts | Measure::Impulse | Measure::OnPiece(_)
    );
    let unit = model.units.get(index).filter(|unit| !unit.is_empty());
    let by = if asked(index) == Asked::Rate(index) {
        "s"
    } else {
        "s^2"
    };
    (!of_contact).then(|| Row {
        name: wanted.to_string(),
        unit: unit.map_or_else(String::new, |unit| {
            wanted.measure.unit(&format!("{unit}/{by}"))
        }),
        asked: asked(index),
        measure: wanted.measure,
    })
}

/// What must be computed for measures.
fn needs(measures: impl Iterator<Item = Measure>, nodes: usize) -> Needs {
    let mut needs = Needs {
        extremes: false,
        integrals: false,
        harmonics: 0,
        nodes,
    };
    for measure in measures {
        match measure {
            Measure::PeakToPeak | Measure::Maximum | Measure::Minimum => needs.extremes = true,
            Measure::CrestFactor => (needs.extremes, needs.integrals) = (true, true),
            Measure::Mean | Measure::Rms => needs.integrals = true,
            Measure::Amplitude(h) | Measure::Phase(h) => needs.harmonics = needs.harmonics.max(h),
            _ => {}
        }
    }
    needs
}
