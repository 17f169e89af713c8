//! From the file of a structure to the structure.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::ops::Range;
use std::sync::Arc;

use hertzian::generic::law_from_text;
use hertzian::law::{Bound, Law};
use hertzian::structure::{Turn, Value, parameter};
use hertzian::system::ParameterFacts;
use toml::Spanned;

use super::Files;
use super::error::{FileError, FileFault};
use super::text::{
    ContactText, DampingText, DirectionText, KindText, LoadText, ParameterText, TakenText, Text,
    TurningText, ValueText,
};
use crate::description::contact::SparseContact;
use crate::description::damping::{Damping, Gyroscopic, Ratios};
use crate::description::direction::Direction;
use crate::description::load::{Load, LoadKind};
use crate::description::output::OutputKind;
use crate::description::structure::SparseStructure;
use crate::market::MOST_COORDINATES;

/// The structure that a text describes.
pub(super) fn parsed(text: &str, files: &Files) -> Result<SparseStructure, FileError> {
    let read: Text = toml::from_str(text).map_err(|error| FileError::Toml {
        path: files.path.clone(),
        line: line(text, error.span().unwrap_or(0..0)),
        message: error.message().replace('\n', "; "),
    })?;
    let reading = Reading {
        text,
        files,
        parameters: HashMap::new(),
        coordinates: 0,
        taken: Vec::new(),
        length: read.units.length.clone(),
        force: read.units.force.clone(),
    };
    reading.structure(read)
}

fn line(text: &str, span: Range<usize>) -> usize {
    let before = text.as_bytes().iter().take(span.start);
    1 + before.filter(|&&byte| byte == b'\n').count()
}

/// What is known while a text is gone through.
struct Reading<'t> {
    text: &'t str,
    files: &'t Files,
    /// Values and units.
    parameters: HashMap<String, (f64, String)>,
    coordinates: usize,
    /// Names of contacts, outputs and parameters.
    taken: Vec<String>,
    length: String,
    force: String,
}

impl Reading<'_> {
    fn at(&self, span: Range<usize>, fault: FileFault) -> FileError {
        FileError::At {
            path: self.files.path.clone(),
            line: line(self.text, span),
            fault,
        }
    }

    fn structure(mut self, read: Text) -> Result<SparseStructure, FileError> {
        let mass = self.files.matrix(&read.matrices.mass)?;
        let stiffness = self.files.matrix(&read.matrices.stiffness)?;
        self.coordinates = mass.rows();
        let mut structure = SparseStructure::new(mass, stiffness).force_unit(&self.force);
        if let Some(name) = &read.name {
            structure = structure.name(name);
        }
        for (name, value) in read.parameters {
            structure = structure.parameter(self.parameter(&name, &value)?);
        }
        structure = structure.damping(self.damping(read.matrices.damping, read.damping)?);
        for gyroscopic in read.gyroscopic {
            structure = structure.gyroscopic(Gyroscopic {
                matrix: self.files.matrix(&gyroscopic.matrix)?,
                speed: self.value(&gyroscopic.speed, "")?,
            });
        }
        for load in &read.load {
            structure = structure.load(self.load(load)?);
        }
        for contact in &read.contact {
            structure = structure.contact(self.contact(contact)?);
        }
        for output in &read.output {
            self.take(&output.name)?;
            let direction = self.direction(&output.direction)?;
            let (kind, per) = match output.kind {
                TakenText::Displacement => (OutputKind::Displacement, ""),
                TakenText::Rate => (OutputKind::Rate, "/s"),
                TakenText::Acceleration => (OutputKind::Acceleration, "/s^2"),
            };
            let unit = match &output.unit {
                Some(unit) => unit.clone(),
                None if self.length.is_empty() => String::new(),
                None => format!("{}{per}", self.length),
            };
            structure = structure
                .output_of(output.name.get_ref(), kind, direction)
                .unit(&unit)
                .about(&output.about);
        }
        structure.check().map_err(|source| FileError::Structure {
            path: self.files.path.clone(),
            source,
        })?;
        Ok(structure)
    }

    /// A name is given once.
    fn take(&mut self, name: &Spanned<String>) -> Result<(), FileError> {
        let (own, span) = (name.get_ref(), name.span());
        if own.is_empty() || own == "omega" || self.taken.contains(own) {
            let name = own.clone();
            return Err(self.at(span, FileFault::Taken { name }));
        }
        self.taken.push(own.clone());
        Ok(())
    }

    fn parameter(
        &mut self,
        name: &Spanned<String>,
        text: &ParameterText,
    ) -> Result<ParameterFacts, FileError> {
        self.take(name)?;
        let own = name.get_ref().clone();
        let facts = ParameterFacts::new(own.clone());
        let (value, facts) = match text {
            ParameterText::Plain(value) => (*value, facts),
            ParameterText::Known(known) => {
                let end = |end: Option<f64>| end.map_or(Bound::Unbounded, Bound::Included);
                let facts = facts
                    .unit(known.unit.clone())
                    .documentation(known.about.clone())
                    .range(end(known.min), end(known.max));
                (known.value, facts)
            }
        };
        if !value.is_finite() || !facts.admits(value) {
            return Err(self.at(name.span(), FileFault::NotFinite { value }));
        }
        self.parameters.insert(own, (value, facts.unit.to_string()));
        Ok(facts)
    }

    /// A number or a parameter, which has this unit if both are known.
    fn value(&self, text: &Spanned<ValueText>, expected: &str) -> Result<Value, FileError> {
        match text.get_ref() {
            ValueText::Number(value) if value.is_finite() => Ok(Value::from(*value)),
            ValueText::Number(value) => {
                Err(self.at(text.span(), FileFault::NotFinite { value: *value }))
            }
            ValueText::Name(name) => {
                let (name, sign) = match name.strip_prefix('-') {
                    Some(name) => (name.trim(), -1.0),
                    None => (name.trim(), 1.0),
                };
                if name == "omega" {
                    return Ok(Value::from(sign).times_omega(1));
                }
                let Some((value, unit)) = self.parameters.get(name) else {
                    let mut known: Vec<_> = self.parameters.keys().map(String::as_str).collect();
                    known.sort_unstable();
                    let fault = FileFault::NoParameter {
                        name: name.to_owned(),
                        known: known.join(", "),
                    };
                    return Err(self.at(text.span(), fault));
                };
                if !unit.is_empty() && !expected.is_empty() && unit != expected {
                    let fault = FileFault::Unit {
                        parameter: name.to_owned(),
                        unit: unit.clone(),
                        expected: expected.to_owned(),
                    };
                    return Err(self.at(text.span(), fault));
                }
                Ok(parameter(name, *value).times(sign))
            }
        }
    }

    fn damping(
        &self,
        matrix: Option<String>,
        text: Option<Spanned<DampingText>>,
    ) -> Result<Damping, FileError> {
        let one = FileFault::Keys {
            what: "damping is a matrix, or one of `ratio`, `ratios`, `table`, or `mass` and `stiffness`",
        };
        let Some(text) = text else {
            return match matrix {
                Some(path) => Ok(Damping::Matrix(self.files.matrix(&path)?)),
                None => Ok(Damping::None),
            };
        };
        let span = text.span();
        let DampingText {
            ratio,
            ratios,
            table,
            mass,
            stiffness,
        } = text.into_inner();
        let rayleigh = (mass.is_some() || stiffness.is_some()).then(|| Damping::Rayleigh {
            mass: mass.unwrap_or(0.0),
            stiffness: stiffness.unwrap_or(0.0),
        });
        let given = [
            ratio.map(Damping::ratio),
            ratios.map(|ratios| Damping::Modal(Ratios::PerMode(ratios))),
            table.map(|table| Damping::Modal(Ratios::Table(table))),
            rayleigh,
        ];
        let mut given = given.into_iter().flatten();
        match (given.next(), given.next(), matrix) {
            (Some(damping), None, None) => Ok(damping),
            _ => Err(self.at(span, one)),
        }
    }

    fn direction(&self, text: &Spanned<DirectionText>) -> Result<Direction, FileError> {
        let at = |fault| self.at(text.span(), fault);
        let of = text.get_ref();
        if self.coordinates > MOST_COORDINATES {
            let coordinates = self.coordinates;
            return Err(at(FileFault::Large { coordinates }));
        }
        let inside = |coordinate: usize| {
            if coordinate < self.coordinates {
                return Ok(());
            }
            Err(at(FileFault::NoCoordinate {
                coordinate,
                coordinates: self.coordinates,
            }))
        };
        match (&of.coordinates, &of.file, of.first) {
            (Some(coordinates), None, None) if of.every.is_none() => {
                coordinates.iter().try_for_each(|&at| inside(at))?;
                let Some(weights) = &of.weights else {
                    return Ok(Direction::mean(coordinates));
                };
                if weights.len() != coordinates.len() {
                    return Err(at(FileFault::Weights {
                        weights: weights.len(),
                        coordinates: coordinates.len(),
                    }));
                }
                let pairs = coordinates.iter().copied().zip(weights.iter().copied());
                Ok(Direction::weighted(pairs))
            }
            (None, Some(name), None) if of.every.is_none() && of.weights.is_none() => {
                let array = self.files.array(name)?;
                if array.shape.len() != 1 || array.values.len() != self.coordinates {
                    return Err(FileError::Shape {
                        path: self.files.folder.join(name),
                        shape: array.shape,
                        expected: "one dimension, and a number for each coordinate",
                    });
                }
                let entries = array.values.into_iter().enumerate();
                Ok(Direction::weighted(entries.filter(|(_, x)| *x != 0.0)))
            }
            (None, None, Some(first)) if of.weights.is_none() => {
                inside(first)?;
                let every = of.every.unwrap_or(1).max(1);
                let coordinates = (first..self.coordinates).step_by(every);
                Ok(Direction::weighted(coordinates.map(|at| (at, 1.0))))
            }
            _ => Err(at(FileFault::Keys {
                what: "a direction has `coordinates`, with or without `weights`, or the `file` of an array, or a `first` coordinate with others at `every` so many",
            })),
        }
    }

    fn load(&self, text: &LoadText) -> Result<Load, FileError> {
        let (kind, unit) = match text.kind {
            KindText::Force => (LoadKind::Force, self.force.as_str()),
            KindText::Unbalance => (LoadKind::Unbalance, ""),
            KindText::Base => (LoadKind::Base, self.length.as_str()),
            KindText::Acceleration => (LoadKind::Acceleration, ""),
        };
        let direction = self.direction(&text.direction)?;
        let amplitude = self.value(&text.amplitude, unit)?;
        let load = Load::new(kind, direction, amplitude);
        Ok(load.harmonic(text.harmonic).phase(text.phase))
    }

    fn contact(&mut self, text: &ContactText) -> Result<SparseContact, FileError> {
        self.take(&text.name)?;
        let law = self.law(text)?;
        let gap = self.direction(&text.direction)?;
        let arguments = self.arguments(law.as_ref(), text)?;
        let mut contact = SparseContact::new(text.name.get_ref(), law, gap).arguments(arguments);
        if let Some(direction) = &text.force_direction {
            contact = contact.force_direction(self.direction(direction)?);
        }
        if let Some(turning) = &text.turning {
            contact = self.turning(contact, turning)?;
        }
        if let Some(offset) = &text.offset {
            contact = contact.offset(self.value(offset, &self.length)?);
        }
        Ok(contact)
    }

    fn turning(
        &self,
        contact: SparseContact,
        text: &Spanned<TurningText>,
    ) -> Result<SparseContact, FileError> {
        let of = text.get_ref();
        let [numerator, denominator] = of.by;
        if contact.force.is_some() || denominator == 0 {
            let what = "a contact that is `turning` has no `force_direction`, and turns `by` a fraction, as [2, 5]";
            return Err(self.at(text.span(), FileFault::Keys { what }));
        }
        if !of.from.is_finite() {
            return Err(self.at(text.span(), FileFault::NotFinite { value: of.from }));
        }
        let turn = Turn::by(numerator, denominator).from(of.from);
        Ok(contact.turning(self.direction(&of.towards)?, turn))
    }

    fn law(&self, text: &ContactText) -> Result<Arc<dyn Law>, FileError> {
        let (written, path, begins) = match (&text.law, &text.law_file) {
            (Some(law), None) => {
                let place = law.span();
                let quoted = self.text.get(place.start..).unwrap_or_default();
                // A line end behind three quotes is not part of the text.
                let is_next = ["\"\"\"\n", "'''\n"].iter().any(|q| quoted.starts_with(q));
                let begins = line(self.text, place) + usize::from(is_next);
                (law.get_ref().clone(), self.files.path.clone(), begins)
            }
            (None, Some(name)) => {
                let path = self.files.folder.join(name.get_ref());
                let read = fs::read_to_string(&path);
                let read = read.map_err(|source| FileError::Read {
                    path: path.clone(),
                    source,
                })?;
                (read, path, 1)
            }
            _ => {
                let what = "a contact has a `law`, or the `law_file` of one";
                return Err(self.at(text.name.span(), FileFault::Keys { what }));
            }
        };
        law_from_text(&written).map_err(|error| {
            let first = error.faults.into_iter().next();
            let (after, fault) = first.map_or_else(
                || {
                    let what = "this is no law";
                    (0, FileFault::Keys { what })
                },
                |fault| {
                    let (column, message) = (fault.column, fault.message);
                    (
                        fault.line.saturating_sub(1),
                        FileFault::Law { column, message },
                    )
                },
            );
            let line = begins + after;
            FileError::At { path, line, fault }
        })
    }

    /// The values of a law's arguments, in its order.
    fn arguments(&self, law: &dyn Law, text: &ContactText) -> Result<Vec<Value>, FileError> {
        let facts = law.facts();
        let given: BTreeMap<&str, _> = text
            .arguments
            .iter()
            .map(|(name, value)| (name.get_ref().as_str(), (name, value)))
            .collect();
        let known: Vec<&str> = facts.arguments.iter().map(|a| a.name.as_ref()).collect();
        if let Some((name, (key, _))) = given.iter().find(|(name, _)| !known.contains(*name)) {
            let fault = FileFault::UnknownArgument {
                law: facts.name.to_string(),
                argument: (*name).to_owned(),
                known: known.join(", "),
            };
            return Err(self.at(key.span(), fault));
        }
        let value = |name: &&str| {
            if let Some((_, value)) = given.get(name) {
                return self.value(value, "");
            }
            let fault = FileFault::NoArgument {
                law: facts.name.to_string(),
                argument: (*name).to_owned(),
            };
            Err(self.at(text.name.span(), fault))
        };
        known.iter().map(value).collect()
    }
}
