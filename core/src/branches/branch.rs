//! A branch of orbits as data.

use std::any::Any;
use std::collections::{HashMap, HashSet};
use std::fmt::Debug;
use std::sync::Arc;
use std::time::Duration;

#[cfg(feature = "serde")]
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::leap::Leap;
use super::point::{Event, Point};
use super::record::Kept;
use crate::cancel::Cancel;
use crate::continuation::follow::Stop;
use crate::continuation::statistics::Statistics;
use crate::error::Error;
use crate::event::{EventKind, Turn};
use crate::system::{OutputFacts, ParameterFacts, System, SystemFacts};
use crate::time::Work;

/// A branch of orbits in the order in which it was followed, by whatever method.
///
/// It owns a copy of the system, so that it can be returned, kept, and sent to another thread:
///
/// ```
/// use hertzian::{Branch, Error, FrequencyResponse};
///
/// fn resonance(drive: f64) -> Result<Branch, Error> {
///     hertzian::oscillator! {
///         Duffing(x) {
///             param drive;
///             ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t);
///         }
///     }
///
///     let model = Duffing { drive };
///     FrequencyResponse::of(&model).from(0.5).to(2.0).harmonics(7).samples(64).run()
/// }
///
/// let branch = resonance(0.2)?;
/// // Further orbits are computed when they are asked for.
/// let at = std::thread::spawn(move || branch.at(1.3)).join().unwrap()?;
/// assert_eq!(at.len(), 3);
/// # Ok::<(), hertzian::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Branch {
    /// The system that it belongs to.
    pub model: Model,
    /// Name of what it varies.
    pub varied: String,
    /// The orbits.
    pub points: Vec<Point>,
    /// Special orbits, in the order of the branch. Several behind the same point keep the order in which they were found if the branch may turn there.
    pub events: Vec<Event>,
    /// Turns that are not folds, and other events that could not be located.
    pub turns: Vec<Turn>,
    /// Places where it was not followed: its orbits before and behind are of two parts.
    #[cfg_attr(feature = "serde", serde(default))]
    pub leaps: Vec<Leap>,
    /// Why it ended at its beginning, where it was followed both ways from an orbit.
    pub begin: Option<Stop>,
    /// Why it ended.
    pub stopped: Stop,
    /// What the continuation cost.
    pub statistics: Statistics,
    /// What motions in time cost, by shooting.
    pub work: Work,
    /// Time of the computation.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub elapsed: Duration,
    /// What it takes to go on with it.
    #[cfg_attr(feature = "serde", serde(default, rename = "request"))]
    pub(crate) further: Further,
}

/// What a branch says of its system.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Model {
    /// Name of the declared type.
    pub name: String,
    /// The equations of motion, as written, and the constants and laws that are in them.
    pub equation: String,
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// Their units, empty for plain numbers; none at all where the model has no units. Time is in seconds where it has.
    #[cfg_attr(feature = "serde", serde(default))]
    pub units: Vec<String>,
    /// The parameters, in the order of [`Point::parameters`].
    pub parameters: Vec<Named>,
    /// The outputs, in the order of their declaration.
    #[cfg_attr(feature = "serde", serde(default))]
    pub outputs: Vec<Named>,
    /// Names of the contacts: of their laws, with a number from one on where a law acts in several. Numbers that would give the name of an
    /// output, a coordinate or another law are left out.
    #[cfg_attr(feature = "serde", serde(default))]
    pub contacts: Vec<String>,
    /// Units of their forces, empty for plain numbers and where a law is measured in several; none at all where the model has no units.
    #[cfg_attr(feature = "serde", serde(default))]
    pub force_units: Vec<String>,
    /// Number of pieces of the law of each contact.
    pub pieces: Vec<usize>,
}

/// A parameter or an output of a model.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub documentation: String,
    /// Its unit; empty where there is none.
    #[cfg_attr(feature = "serde", serde(default))]
    pub unit: String,
}

/// What a name stands for, by position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    Output(usize),
    Coordinate(usize),
    Contact(usize),
}

impl Model {
    /// Of a system.
    pub fn of(system: &dyn System) -> Self {
        let facts: &SystemFacts = system.facts();
        let pieces = facts.contacts.iter();
        let measured = pieces.clone().filter(|_| !facts.units.is_empty());
        Self {
            name: facts.name.to_string(),
            equation: facts.equation.to_string(),
            coordinates: facts.coordinates.iter().map(ToString::to_string).collect(),
            units: facts.units.iter().map(ToString::to_string).collect(),
            parameters: facts.parameters.iter().map(Named::parameter).collect(),
            outputs: facts.outputs.iter().map(Named::output).collect(),
            contacts: contacts_of(system),
            force_units: measured.map(|contact| contact.unit.to_string()).collect(),
            pieces: pieces
                .map(|contact| system.law(contact.law).facts().pieces.len())
                .collect(),
        }
    }

    /// Whether the other one has the same equations by the same names, whatever is said of its parameters.
    pub(crate) fn agrees(&self, other: &Self) -> bool {
        let names = |model: &Self| -> Vec<String> {
            let names = model.parameters.iter().map(|parameter| &parameter.name);
            names.chain(&model.coordinates).cloned().collect()
        };
        self.name == other.name
            && self.equation == other.equation
            && names(self) == names(other)
            && self.pieces == other.pieces
            && self.units == other.units
            && self.outputs == other.outputs
    }
}

impl Named {
    fn parameter(facts: &ParameterFacts) -> Self {
        Self {
            name: facts.name.to_string(),
            documentation: facts.documentation.to_string(),
            unit: facts.unit.to_string(),
        }
    }

    fn output(facts: &OutputFacts) -> Self {
        Self {
            name: facts.name.to_string(),
            documentation: facts.documentation.to_string(),
            unit: facts.unit.to_string(),
        }
    }
}

/// A name for each contact: that of its law, numbered where the law acts in several. A number is left out where an output, a coordinate or a
/// law has that name.
fn contacts_of(system: &dyn System) -> Vec<String> {
    let facts = system.facts();
    let contacts = &facts.contacts;
    let law_name = |law: usize| system.law(law).facts().name.as_ref();
    let outputs = facts.outputs.iter().map(|output| output.name.as_ref());
    let signals: HashSet<&str> = outputs
        .chain(facts.coordinates.iter().map(AsRef::as_ref))
        .collect();
    let laws: HashSet<&str> = contacts.iter().map(|of| law_name(of.law)).collect();
    let mut acts: HashMap<usize, usize> = HashMap::new();
    for contact in contacts.iter() {
        *acts.entry(contact.law).or_default() += 1;
    }
    let mut names: Vec<String> = Vec::with_capacity(contacts.len());
    let mut own: HashSet<String> = HashSet::new();
    let mut numbers: HashMap<usize, usize> = HashMap::new();
    for contact in contacts.iter() {
        let name = law_name(contact.law);
        if acts[&contact.law] == 1 && !signals.contains(name) && own.insert(name.to_owned()) {
            names.push(name.to_owned());
            continue;
        }
        let number = numbers.entry(contact.law).or_default();
        names.push(loop {
            *number += 1;
            let numbered = format!("{name}_{number}");
            let other = numbered.as_str();
            let is_free = !signals.contains(other) && !laws.contains(other);
            if is_free && own.insert(numbered.clone()) {
                break numbered;
            }
        });
    }
    names
}

/// What it takes to compute further orbits of a branch: the system, and what was asked for by the method that followed it. Of a branch
/// read from a file it has what was written of that, until it is given a system. Not a part of what is compared.
#[derive(Debug, Clone, Default)]
pub(crate) struct Further {
    pub(crate) system: Option<Arc<dyn System>>,
    pub(crate) request: Option<Arc<dyn Asked>>,
    /// Whether the branch is a backbone: its orbits are read by what it was asked for, and no others are computed.
    pub(crate) is_backbone: bool,
    #[cfg(feature = "serde")]
    pub(crate) written: serde_json::Value,
}

impl Further {
    /// Of a system, and what its branch was asked for by.
    pub(crate) fn of(system: Arc<dyn System>, request: Arc<dyn Asked>) -> Self {
        Self {
            system: Some(system),
            request: Some(request),
            is_backbone: false,
            #[cfg(feature = "serde")]
            written: serde_json::Value::Null,
        }
    }

    /// The same of a backbone.
    pub(crate) fn of_backbone(self) -> Self {
        Self {
            is_backbone: true,
            ..self
        }
    }
}

/// What a branch was asked for by.
pub(crate) trait Asked: Any + Debug + Send + Sync {
    /// As JSON.
    #[cfg(feature = "serde")]
    fn written(&self) -> serde_json::Result<serde_json::Value>;
}

/// What says in a file that a branch is a backbone.
#[cfg(feature = "serde")]
const BACKBONE: &str = "backbone";

#[cfg(feature = "serde")]
impl Serialize for Further {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Some(request) = &self.request else {
            return self.written.serialize(to);
        };
        let mut written = request.written().map_err(serde::ser::Error::custom)?;
        if let Some(written) = written.as_object_mut().filter(|_| self.is_backbone) {
            written.insert(BACKBONE.to_owned(), true.into());
        }
        written.serialize(to)
    }
}

#[cfg(feature = "serde")]
impl<'de> Deserialize<'de> for Further {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let written = serde_json::Value::deserialize(from)?;
        Ok(Self {
            is_backbone: written[BACKBONE] == true,
            written,
            ..Self::default()
        })
    }
}

impl PartialEq for Further {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Branch {
    /// The system that it belongs to; `None` of a branch that was read from a file.
    pub fn system(&self) -> Option<&dyn System> {
        self.further.system.as_deref()
    }

    pub(crate) fn kept(&self) -> Kept<'_> {
        Kept {
            points: &self.points,
            events: &self.events,
            turns: &self.turns,
        }
    }

    /// Period of its orbits in periods of the declaration; zero without orbits.
    pub fn period(&self) -> usize {
        self.points.first().map_or(0, |point| point.orbit.period)
    }

    /// Its orbits in the order in which they were followed, in parts between [places](Self::leaps) where it was not.
    ///
    /// ```
    /// use hertzian::backbone::FreeOscillation;
    ///
    /// hertzian::oscillator! {
    ///     Hertz(x) { ddot(x) + sgn(x)*|x|^1.5 = 0; }
    /// }
    ///
    /// let curve = FreeOscillation::of(&Hertz {}).from(0.5).to(2.0).run()?;
    /// // Nothing is left out.
    /// assert!(curve.leaps.is_empty());
    /// assert_eq!(curve.parts().map(<[_]>::len).sum::<usize>(), curve.points.len());
    /// # Ok::<(), hertzian::Error>(())
    /// ```
    pub fn parts(&self) -> impl Iterator<Item = &[Point]> {
        let ends = self.leaps.iter().map(|leap| leap.after);
        let ends = ends.chain([self.points.len()]);
        ends.scan(0, |from, to| {
            let to = to.clamp(*from, self.points.len());
            let part = self.points.get(*from..to).unwrap_or_default();
            *from = to;
            Some(part)
        })
    }

    /// The events of one kind. Whether the branch turns back is not asked: `Grazing` of either kind gives all.
    pub fn events(&self, kind: EventKind) -> impl DoubleEndedIterator<Item = &Event> {
        self.events
            .iter()
            .filter(move |event| event.kind.is_like(kind))
    }

    /// The folds.
    pub fn folds(&self) -> impl DoubleEndedIterator<Item = &Event> {
        self.events(EventKind::Fold)
    }

    /// A branch with its part to the other side, if there is one: without it where that was cancelled.
    ///
    /// # Errors
    /// If the other part could not be followed.
    pub(crate) fn with_back(
        forth: Self,
        back: Option<Result<Self, Error>>,
        cancel: &Cancel,
    ) -> Result<Self, Error> {
        match back {
            None => Ok(forth),
            Some(Ok(back)) => Ok(Self::joined(back, forth)),
            Some(Err(_)) if cancel.is_cancelled() => Ok(Self {
                begin: Some(Stop::Interrupted),
                ..forth
            }),
            Some(Err(error)) => Err(error),
        }
    }

    /// Two parts of one branch from the same orbit on as one branch, the first backwards.
    pub(crate) fn joined(back: Self, forth: Self) -> Self {
        let count = back.points.len();
        let mut branch = forth;
        let mut points = back.points;
        points.reverse();
        // The first orbit of both is the same.
        points.extend(branch.points.drain(..).skip(1));
        let turned = |after: usize| count - after.min(count);
        let mut events: Vec<Event> = back.events;
        events.reverse();
        for event in &mut events {
            event.after = turned(event.after);
        }
        let mut turns: Vec<Turn> = back.turns;
        turns.reverse();
        for turn in &mut turns {
            turn.after = turned(turn.after);
        }
        let shift = count.saturating_sub(1);
        let mut leaps: Vec<Leap> = back.leaps;
        leaps.reverse();
        for leap in &mut leaps {
            leap.after = turned(leap.after);
        }
        leaps.extend(branch.leaps.drain(..).map(|leap| Leap {
            after: leap.after + shift,
            ..leap
        }));
        events.extend(branch.events.drain(..).map(|event| Event {
            after: event.after + shift,
            ..event
        }));
        turns.extend(branch.turns.drain(..).map(|turn| Turn {
            after: turn.after + shift,
            ..turn
        }));
        branch.statistics += back.statistics;
        branch.elapsed += back.elapsed;
        branch.work += back.work;
        Self {
            points,
            events,
            turns,
            leaps,
            begin: Some(back.stopped),
            ..branch
        }
    }
}
