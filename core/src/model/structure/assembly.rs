//! Coefficients and parameters of a structure, gathered and checked one by one.

use std::collections::HashMap;

use super::{Coefficient, Contact, StructureError, Turn, Value};
use crate::law::ArgumentFacts;
use crate::model::validate;
use crate::system::{Bound, ParameterFacts, Part, Place, Wave};

/// Coefficients and parameters as they are gathered.
#[derive(Default)]
pub(super) struct Assembly {
    pub(super) places: Vec<Place>,
    pub(super) coefficients: Vec<Coefficient>,
    pub(super) parameters: Vec<ParameterFacts>,
    pub(super) values: Vec<f64>,
    known: HashMap<String, usize>,
}

impl Assembly {
    /// Adds a coefficient, unless it is zero.
    pub(super) fn add(&mut self, place: Place, value: &Value) -> Result<(), StructureError> {
        let not_finite = |value: f64| StructureError::NotFinite {
            place: format!("{place:?}"),
            value,
        };
        if !value.factor.is_finite() {
            return Err(not_finite(value.factor));
        }
        let parameter = match &value.parameter {
            None if value.factor == 0.0 => return Ok(()),
            None => None,
            Some((_, present)) if !present.is_finite() => return Err(not_finite(*present)),
            Some((name, present)) => Some(self.parameter(name, *present)?),
        };
        let power = value.power;
        self.places.push(place);
        self.coefficients.push(Coefficient {
            factor: value.factor,
            parameter,
            power,
        });
        Ok(())
    }

    /// The position of a parameter, which is new or has the same value as before.
    fn parameter(&mut self, name: &str, value: f64) -> Result<usize, StructureError> {
        if name.is_empty() || name == "omega" {
            return Err(StructureError::Name {
                parameter: name.to_owned(),
            });
        }
        if let Some(&index) = self.known.get(name) {
            let first = self.values[index];
            if first == value {
                return Ok(index);
            }
            return Err(StructureError::TwoValues {
                parameter: name.to_owned(),
                first,
                second: value,
            });
        }
        let index = self.values.len();
        self.known.insert(name.to_owned(), index);
        self.values.push(value);
        self.parameters.push(ParameterFacts::new(name.to_owned()));
        Ok(index)
    }

    /// What is known of a parameter besides.
    pub(super) fn know(&mut self, facts: &ParameterFacts) {
        let Some(&index) = self.known.get(facts.name.as_ref()) else {
            return;
        };
        let own = &mut self.parameters[index];
        own.documentation.clone_from(&facts.documentation);
        own.unit.clone_from(&facts.unit);
        own.minimum = narrower(own.minimum, facts.minimum, |a, b| a > b);
        own.maximum = narrower(own.maximum, facts.maximum, |a, b| a < b);
    }

    /// Adds the coefficients of a contact.
    pub(super) fn contact(
        &mut self,
        index: usize,
        contact: &Contact,
        coordinates: usize,
        divisor: u32,
    ) -> Result<(), StructureError> {
        let law = contact.law.facts();
        if law.arguments.len() != contact.arguments.len() {
            return Err(StructureError::Arguments {
                law: law.name.to_string(),
                expected: law.arguments.len(),
                given: contact.arguments.len(),
            });
        }
        let force = contact.force.as_ref().unwrap_or(&contact.gap);
        let across = contact.turning.iter().map(|(across, _)| across);
        for direction in [&contact.gap, force].into_iter().chain(across) {
            if direction.len() != coordinates {
                return Err(StructureError::DirectionSize {
                    contact: index,
                    entries: direction.len(),
                    coordinates,
                });
            }
        }
        let wave = Wave::CONSTANT;
        if let Some((across, turn)) = &contact.turning {
            if contact.force.is_some() {
                return Err(StructureError::TurningForce { contact: index });
            }
            for (wave, direction) in turning(&contact.gap, across, *turn, divisor) {
                self.directions(index, wave, [&direction, &direction])?;
            }
        } else {
            self.directions(index, wave, [force, &contact.gap])?;
        }
        let offset = Place::Offset {
            contact: index,
            wave,
        };
        self.add(offset, &contact.offset)?;
        for (argument, value) in contact.arguments.iter().enumerate() {
            let place = Place::Argument {
                contact: index,
                index: argument,
            };
            self.add(place, value)?;
            self.argument(&law.name, &law.arguments[argument], value)?;
        }
        Ok(())
    }

    /// Adds the directions of the force and of the gap of a contact, times a wave.
    fn directions(
        &mut self,
        contact: usize,
        wave: Wave,
        [force, gap]: [&[f64]; 2],
    ) -> Result<(), StructureError> {
        for (row, (&force, &gap)) in force.iter().zip(gap).enumerate() {
            let along = Place::ForceDirection { contact, row, wave };
            self.add(along, &force.into())?;
            let column = row;
            let across = Place::GapDirection {
                contact,
                column,
                wave,
            };
            self.add(across, &gap.into())?;
        }
        Ok(())
    }

    /// An argument lies in its range. What that asks of a parameter becomes the range of the parameter, which a run
    /// checks before it varies one.
    fn argument(
        &mut self,
        law: &str,
        facts: &ArgumentFacts,
        value: &Value,
    ) -> Result<(), StructureError> {
        let Value {
            factor,
            parameter,
            power,
        } = value;
        // What the frequency makes of it is not known here.
        if *power > 0 {
            return Ok(());
        }
        let present = parameter.as_ref().map_or(1.0, |(_, present)| *present);
        if !facts.admits(factor * present) {
            return Err(StructureError::Range {
                law: law.to_owned(),
                argument: facts.name.to_string(),
                value: factor * present,
                range: validate::described(facts.minimum, facts.maximum),
            });
        }
        let known = parameter
            .as_ref()
            .and_then(|(name, _)| self.known.get(name));
        if let (Some(&index), true) = (known, *factor != 0.0) {
            let own = &mut self.parameters[index];
            let [low, high] = [facts.minimum, facts.maximum].map(|end| divided(end, *factor));
            let [low, high] = if *factor > 0.0 {
                [low, high]
            } else {
                [high, low]
            };
            own.minimum = narrower(own.minimum, low, |a, b| a > b);
            own.maximum = narrower(own.maximum, high, |a, b| a < b);
        }
        Ok(())
    }
}

/// The waves of a direction that turns, `cos(a + r w t) u + sin(a + r w t) v`, where the base frequency is that of the excitation divided by so
/// much.
fn turning(u: &[f64], v: &[f64], turn: Turn, divisor: u32) -> Vec<(Wave, Vec<f64>)> {
    let (sine, cosine) = turn.angle().sin_cos();
    let pairs = || u.iter().zip(v);
    let along = pairs().map(|(u, v)| cosine * u + sine * v).collect();
    let [numerator, denominator] = turn.fraction();
    // The divisor is a multiple of the denominator in lowest terms.
    let harmonic = u64::from(numerator) * u64::from(divisor) / u64::from(denominator.max(1));
    let harmonic = u32::try_from(harmonic).unwrap_or(u32::MAX);
    let wave = |part| Wave { harmonic, part };
    if harmonic == 0 {
        return vec![(Wave::CONSTANT, along)];
    }
    let across = pairs().map(|(u, v)| cosine * v - sine * u).collect();
    vec![(wave(Part::Cosine), along), (wave(Part::Sine), across)]
}

/// The end of a range whose values are divided by a number.
fn divided(end: Bound, by: f64) -> Bound {
    match end {
        Bound::Unbounded => Bound::Unbounded,
        Bound::Included(value) => Bound::Included(value / by),
        Bound::Excluded(value) => Bound::Excluded(value / by),
    }
}

/// Of two ends of one side of a range the one that admits less.
fn narrower(a: Bound, b: Bound, is_inside: impl Fn(f64, f64) -> bool) -> Bound {
    let [
        Bound::Included(of_a) | Bound::Excluded(of_a),
        Bound::Included(of_b) | Bound::Excluded(of_b),
    ] = [a, b]
    else {
        return if a == Bound::Unbounded { b } else { a };
    };
    if is_inside(of_b, of_a) || (of_a == of_b && matches!(b, Bound::Excluded(_))) {
        b
    } else {
        a
    }
}
