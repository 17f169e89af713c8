//! A model that was drawn: its text for the library, and its accelerations for the integrator.

use std::fmt::Write as _;

use hertzian::Error;
use hertzian::generic::Declaration;

use crate::differential::expression::{Expression, Names, Place, Wave, sum};

/// Most coordinates.
pub const COORDINATES: usize = 3;
/// Most contacts.
pub const CONTACTS: usize = 8;
/// Positions, then velocities; what a model has not is zero.
pub type State = [f64; 2 * COORDINATES];
/// The piece that each contact is on.
pub type Pieces = [usize; CONTACTS];

/// A parameter of a declaration.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    /// Whether it is declared to be positive.
    pub positive: bool,
}

/// A force of a gap and its rate.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Law {
    /// In increasing order.
    pub levels: Vec<Expression>,
    /// One more than levels, from below.
    pub pieces: Vec<Expression>,
    /// Where it changes fast, if it does.
    pub sharp: Option<Sharp>,
    /// Where a slope jumps, or has no bound, on a piece.
    pub bend: Option<(Variable, Expression)>,
}

/// A force that changes near zero of one of its variables, on a length of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Sharp {
    pub of: Variable,
    pub width: Expression,
}

/// What a force depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    Gap,
    Rate,
}

/// A term of a gap: a coordinate times a number, and a wave where the direction turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    pub coordinate: usize,
    pub factor: f64,
    pub wave: Option<Wave>,
}

/// Where a law acts: `sum of terms - distance - moving*wave`.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    pub law: usize,
    pub terms: Vec<Term>,
    pub distance: Option<Expression>,
    pub moving: Option<(Expression, Wave)>,
    /// What the force is multiplied by in every equation.
    pub factor: Option<Expression>,
}

/// Equations of motion with numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Model {
    pub name: String,
    pub coordinates: usize,
    pub parameters: Vec<Parameter>,
    pub laws: Vec<Law>,
    pub contacts: Vec<Contact>,
    /// Coefficient of the acceleration in each equation.
    pub masses: Vec<Expression>,
    /// Terms on the left but for the acceleration and contacts, by equation.
    pub left: Vec<Vec<Expression>>,
    /// Terms on the right.
    pub right: Vec<Vec<Expression>>,
    /// Smallest scale of a law, relative to that of the motion.
    pub sharpest: f64,
    /// Length that motions are about as large as.
    pub size: f64,
    /// Frequencies of the branch.
    pub range: [f64; 2],
    /// Divisor of omega that all waves have in common.
    pub divisor: u32,
}

/// A gap with its rate.
#[derive(Debug, Clone, Copy)]
pub struct Gap {
    pub value: f64,
    pub rate: f64,
}

const NAMES: [&str; COORDINATES] = ["x", "y", "z"];

impl Model {
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// The model as the library has it.
    pub fn declared(&self) -> Result<Declaration, Error> {
        let mut declaration = Declaration::parse(&self.text())?;
        for Parameter { name, value, .. } in &self.parameters {
            declaration.set(name, *value)?;
        }
        Ok(declaration)
    }

    /// The declaration, as the library reads it.
    pub fn text(&self) -> String {
        let mut names = self.names();
        names.forces = (0..self.contacts.len())
            .map(|contact| self.call(contact, &names))
            .collect();
        let coordinates = &names.coordinates;
        let mut text = format!("{}({}) {{\n", self.name, coordinates.join(", "));
        for Parameter {
            name,
            value,
            positive,
        } in &self.parameters
        {
            let range = if *positive { " > 0" } else { "" };
            let value = if written(*value) {
                format!(" = {value:?}")
            } else {
                String::new()
            };
            let _ = writeln!(text, "    param {name}{value}{range};");
        }
        for (index, law) in self.laws.iter().enumerate() {
            let _ = writeln!(text, "    law law{index}(gap) {{ {} }}", law.text(&names));
        }
        for equation in 0..self.coordinates {
            let mass = format!(
                "{}*ddot({})",
                self.masses[equation].text(&names),
                coordinates[equation]
            );
            let mut left = self.left[equation].clone();
            for (index, contact) in self.contacts.iter().enumerate() {
                let terms = contact.terms.iter();
                let here = terms.filter(|term| term.coordinate == equation);
                left.extend(here.map(|term| contact.acting(index, term)));
            }
            let left = sum(&left, &names);
            let right = match &self.right[equation][..] {
                [] => "0".to_owned(),
                terms => sum(terms, &names),
            };
            let between = if left.starts_with('-') { "" } else { "+ " };
            let _ = writeln!(text, "    {mass} {between}{left} = {right};");
        }
        text + "}\n"
    }

    fn names(&self) -> Names {
        Names {
            parameters: self.parameters.iter().map(|p| p.name.clone()).collect(),
            coordinates: NAMES[..self.coordinates]
                .iter()
                .map(ToString::to_string)
                .collect(),
            forces: Vec::new(),
        }
    }

    fn call(&self, contact: usize, names: &Names) -> String {
        let contact = &self.contacts[contact];
        let mut gap = String::new();
        for (index, term) in contact.terms.iter().enumerate() {
            let sign = match (index, term.factor < 0.0) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            gap += sign;
            if term.factor.abs() != 1.0 {
                let _ = write!(gap, "{:?}*", term.factor.abs());
            }
            gap += NAMES[term.coordinate];
            if let Some(wave) = term.wave {
                let _ = write!(gap, "*{wave}");
            }
        }
        if let Some(distance) = &contact.distance {
            let _ = write!(gap, " - {}", distance.text(names));
        }
        if let Some((amplitude, wave)) = &contact.moving {
            let _ = write!(gap, " - {}*{wave}", amplitude.text(names));
        }
        format!("law{}({gap})", contact.law)
    }

    /// The gap of a contact.
    pub fn gap(&self, contact: usize, values: &[f64], omega: f64, time: f64, state: &State) -> Gap {
        let contact = &self.contacts[contact];
        let phase = omega * time;
        let place = Place {
            omega,
            phase,
            ..Place::of(values)
        };
        let mut gap = Gap {
            value: 0.0,
            rate: 0.0,
        };
        for term in &contact.terms {
            let (wave, slope) = term.wave.map_or((1.0, 0.0), |wave| {
                (wave.value(phase), omega * wave.slope(phase))
            });
            let (x, v) = (state[term.coordinate], state[COORDINATES + term.coordinate]);
            gap.value += term.factor * wave * x;
            gap.rate += term.factor * (wave * v + slope * x);
        }
        if let Some(distance) = &contact.distance {
            gap.value -= distance.value(&place);
        }
        if let Some((amplitude, wave)) = &contact.moving {
            let amplitude = amplitude.value(&place);
            gap.value -= amplitude * wave.value(phase);
            gap.rate -= amplitude * omega * wave.slope(phase);
        }
        gap
    }

    /// Levels of the law of a contact.
    pub fn levels(&self, contact: usize, values: &[f64], levels: &mut Vec<f64>) {
        let place = Place::of(values);
        levels.clear();
        let law = &self.laws[self.contacts[contact].law];
        levels.extend(law.levels.iter().map(|level| level.value(&place)));
    }

    /// What the law of a contact changes fast with, and its width.
    pub fn sharp(&self, contact: usize, values: &[f64]) -> Option<(Variable, f64)> {
        let sharp = self.laws[self.contacts[contact].law].sharp.as_ref()?;
        Some((sharp.of, sharp.width.value(&Place::of(values))))
    }

    /// Where a slope of the law of a contact jumps on a piece.
    pub fn bend(&self, contact: usize, values: &[f64]) -> Option<(Variable, f64)> {
        let (of, bend) = self.laws[self.contacts[contact].law].bend.as_ref()?;
        Some((*of, bend.value(&Place::of(values))))
    }

    /// Whether no force knows of a shift of all coordinates together.
    pub fn is_free(&self) -> bool {
        let values = self.values();
        let omega = self.range[0];
        let derivative = |shift: f64| {
            let mut state = State::default();
            for i in 0..self.coordinates {
                state[i] = self.size * (0.3 - 0.4 * i as f64 + shift);
                state[COORDINATES + i] = self.size * omega * (0.7 - 0.5 * i as f64);
            }
            let time = 0.4 / omega;
            let mut pieces = [0; CONTACTS];
            let mut levels = Vec::new();
            for (contact, piece) in pieces[..self.contacts.len()].iter_mut().enumerate() {
                self.levels(contact, &values, &mut levels);
                let gap = self.gap(contact, &values, omega, time, &state).value;
                *piece = levels.iter().filter(|level| gap > **level).count();
            }
            self.derivative(&values, omega, time, (&state, &pieces))
        };
        let (here, there) = (derivative(0.0), derivative(0.9));
        let mut pairs = here.iter().zip(&there);
        pairs.all(|(a, b)| (a - b).abs() <= 1e-9 * a.abs().max(b.abs()))
    }

    /// Derivative of a state by time, with every contact on its piece.
    pub fn derivative(
        &self,
        values: &[f64],
        omega: f64,
        time: f64,
        (state, pieces): (&State, &Pieces),
    ) -> State {
        let (positions, velocities) = state.split_at(COORDINATES);
        let mut forces = [0.0; CONTACTS];
        let mut place = Place {
            parameters: values,
            omega,
            phase: omega * time,
            positions,
            velocities,
            gap: 0.0,
            rate: 0.0,
            forces: &[],
        };
        for (index, contact) in self.contacts.iter().enumerate() {
            let gap = self.gap(index, values, omega, time, state);
            (place.gap, place.rate) = (gap.value, gap.rate);
            forces[index] = self.laws[contact.law].pieces[pieces[index]].value(&place);
            if let Some(factor) = &contact.factor {
                forces[index] *= factor.value(&place);
            }
        }
        let mut derivative = State::default();
        derivative[..COORDINATES].copy_from_slice(velocities);
        for equation in 0..self.coordinates {
            let sum = |terms: &[Expression]| -> f64 { terms.iter().map(|t| t.value(&place)).sum() };
            derivative[COORDINATES + equation] =
                sum(&self.right[equation]) - sum(&self.left[equation]);
        }
        for (contact, force) in self.contacts.iter().zip(forces) {
            for term in &contact.terms {
                let wave = term.wave.map_or(1.0, |wave| wave.value(place.phase));
                derivative[COORDINATES + term.coordinate] -= term.factor * wave * force;
            }
        }
        for (equation, mass) in self.masses.iter().enumerate() {
            derivative[COORDINATES + equation] /= mass.value(&place);
        }
        derivative
    }
}

/// Whether a number may stand in a declaration with all of its digits: others are set.
pub fn written(number: f64) -> bool {
    number == 0.0 || (1e-18..1e18).contains(&number.abs())
}

impl Contact {
    /// The force as it stands in the equation of one of its coordinates.
    fn acting(&self, index: usize, term: &Term) -> Expression {
        let mut factors = Vec::new();
        if term.factor.abs() != 1.0 {
            factors.push(Expression::Number(term.factor.abs()));
        }
        factors.extend(term.wave.map(Expression::Wave));
        factors.extend(self.factor.clone());
        factors.push(Expression::Force(index));
        let force = match factors.pop() {
            Some(force) if factors.is_empty() => force,
            last => Expression::Product(factors.into_iter().chain(last).collect()),
        };
        if term.factor < 0.0 {
            force.negative()
        } else {
            force
        }
    }
}

impl Law {
    fn text(&self, names: &Names) -> String {
        let levels: Vec<String> = self.levels.iter().map(|l| l.text(names)).collect();
        let pieces: Vec<String> = self.pieces.iter().map(|p| p.text(names)).collect();
        match (&levels[..], &pieces[..]) {
            ([], [whole]) => whole.clone(),
            ([level], [below, above]) => format!("gap > {level} => {above}, else => {below}"),
            ([low, high], [below, between, above]) => format!(
                "gap > {high} => {above}, {low} <= gap <= {high} => {between}, gap < {low} => {below}"
            ),
            _ => unreachable!("a law has at most two levels, and one piece more"),
        }
    }
}
