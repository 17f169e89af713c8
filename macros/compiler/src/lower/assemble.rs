//! Terms to coefficients with places: equations (1) and (2) of the contract.

use std::collections::HashMap;

use hertzian_contract::system::{self, ContactFacts, Part, Place, Signal};

use crate::dag::{Dag, Id, Rational, Variable};

use super::term::{Motion, Term};
use super::wave::Wave;

/// Finer fractions of `omega` than this are surely not meant.
const LARGEST_DIVISOR: i128 = 1000;
const LARGEST_HARMONIC: i128 = 10_000;

/// A term `e phi(g; arguments)` of one equation, with its wave.
#[derive(Debug, Clone)]
pub struct Action {
    /// Index of the law.
    pub law: usize,
    /// Gap, affine in the coordinates.
    pub gap: Vec<Term>,
    /// Every argument of the law.
    pub arguments: Vec<Id>,
    /// Equation.
    pub row: usize,
    /// Factor of the force.
    pub factor: Id,
    /// Wave of the force.
    pub wave: Wave,
}

/// Coefficients and contacts, as far as assembled.
#[derive(Debug, Default)]
pub struct Assembly {
    /// Coefficients with their places, one for each place.
    pub coefficients: Vec<(Place, Id)>,
    /// Contacts.
    pub contacts: Vec<ContactFacts>,
    /// The base frequency is `omega / divisor`.
    pub divisor: u32,
    positions: HashMap<Place, usize>,
    known: HashMap<ContactKey, usize>,
}

/// Law, arguments and gap of a contact.
type ContactKey = (usize, Vec<Id>, Vec<(Motion, Wave, Id)>);

/// What tells contacts apart.
fn key(law: usize, arguments: &[Id], gap: &[Term]) -> ContactKey {
    let gap = gap.iter();
    let mut gap: Vec<(Motion, Wave, Id)> = gap
        .map(|term| (term.motion, term.wave, term.coefficient))
        .collect();
    gap.sort_by_key(|&(_, _, coefficient)| coefficient);
    (law, arguments.to_vec(), gap)
}

/// The smallest divisor for which every wave is a whole harmonic of the base frequency.
///
/// # Errors
/// In words, if divisor or harmonics are out of all proportion.
pub fn divisor<'a>(waves: impl Iterator<Item = &'a Wave> + Clone) -> Result<u32, &'static str> {
    let mut divisor: i128 = 1;
    for wave in waves.clone() {
        let Some((_, denominator)) = wave.multiple.fraction() else {
            return Err("a frequency is out of all proportion to omega");
        };
        let (mut a, mut b) = (divisor, denominator);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        divisor = (divisor / a).saturating_mul(denominator);
        if divisor > LARGEST_DIVISOR {
            return Err(
                "the frequencies have no common base above omega/1000: use simpler fractions",
            );
        }
    }
    if waves
        .into_iter()
        .any(|wave| harmonic(wave.multiple, divisor).is_none())
    {
        return Err("a frequency is more than 10000 times the base frequency");
    }
    u32::try_from(divisor).map_err(|_| "the frequencies have no common base")
}

fn harmonic(multiple: Rational, divisor: i128) -> Option<u32> {
    let scaled = multiple.checked_mul(Rational::integer(divisor))?;
    let harmonic = scaled
        .whole()
        .filter(|harmonic| *harmonic <= LARGEST_HARMONIC)?;
    u32::try_from(harmonic).ok()
}

impl Assembly {
    /// Nothing yet, with a given divisor.
    pub fn new(divisor: u32) -> Self {
        Self {
            divisor,
            ..Self::default()
        }
    }

    fn wave(&self, wave: Wave) -> system::Wave {
        let harmonic = harmonic(wave.multiple, i128::from(self.divisor)).unwrap_or_default();
        let part = if wave.sine { Part::Sine } else { Part::Cosine };
        system::Wave { harmonic, part }
    }

    fn add(&mut self, dag: &mut Dag, place: Place, value: Id) {
        let position = *self
            .positions
            .entry(place)
            .or_insert(self.coefficients.len());
        match self.coefficients.get_mut(position) {
            Some((_, sum)) => *sum = dag.sum(&[*sum, value]),
            None => self.coefficients.push((place, value)),
        }
    }

    /// Adds a term that is linear in the motion or free of it, as it stands on the left.
    pub fn linear(&mut self, dag: &mut Dag, row: usize, term: &Term) {
        let wave = self.wave(term.wave);
        let (place, value) = match term.motion {
            Motion::Linear(Variable::Acceleration(column)) => {
                (Place::Mass { row, column }, term.coefficient)
            }
            Motion::Linear(Variable::Velocity(column)) => {
                (Place::Damping { row, column }, term.coefficient)
            }
            Motion::Linear(Variable::Coordinate(column)) => {
                (Place::Stiffness { row, column, wave }, term.coefficient)
            }
            _ => (Place::Load { row, wave }, dag.negate(term.coefficient)),
        };
        self.add(dag, place, value);
    }

    /// Adds the force of a law. Equal laws at equal gaps are one contact, which acts in several equations.
    pub fn force(&mut self, dag: &mut Dag, action: &Action) {
        let key = key(action.law, &action.arguments, &action.gap);
        let contact = match self.known.get(&key) {
            Some(&contact) => contact,
            None => self.contact(dag, action, key),
        };
        let wave = self.wave(action.wave);
        self.add(
            dag,
            Place::ForceDirection {
                contact,
                row: action.row,
                wave,
            },
            action.factor,
        );
    }

    fn contact(&mut self, dag: &mut Dag, action: &Action, key: ContactKey) -> usize {
        let contact = self.contacts.len();
        self.contacts.push(ContactFacts::new(action.law));
        self.known.insert(key, contact);
        for term in &action.gap {
            let wave = self.wave(term.wave);
            let (place, value) = match term.motion {
                Motion::Linear(Variable::Coordinate(column)) => (
                    Place::GapDirection {
                        contact,
                        column,
                        wave,
                    },
                    term.coefficient,
                ),
                _ => (
                    Place::Offset { contact, wave },
                    dag.negate(term.coefficient),
                ),
            };
            self.add(dag, place, value);
        }
        for (index, &value) in action.arguments.iter().enumerate() {
            self.add(dag, Place::Argument { contact, index }, value);
        }
        contact
    }

    /// The contact of a law with these arguments at a gap, if it acts in an equation.
    pub fn contact_of(&self, law: usize, arguments: &[Id], gap: &[Term]) -> Option<usize> {
        self.known.get(&key(law, arguments, gap)).copied()
    }

    /// Adds a term of an output. False where its wave is no whole harmonic of the base frequency.
    pub fn output(&mut self, dag: &mut Dag, output: usize, of: Signal, term: &Term) -> bool {
        let whole = harmonic(term.wave.multiple, i128::from(self.divisor)).is_some();
        if whole {
            let wave = self.wave(term.wave);
            self.add(dag, Place::Output { output, of, wave }, term.coefficient);
        }
        whole
    }

    /// The entries of the mass matrix.
    pub fn masses(&self) -> Vec<(usize, usize, Id)> {
        let mass = |&(place, value): &(Place, Id)| match place {
            Place::Mass { row, column } => Some((row, column, value)),
            _ => None,
        };
        self.coefficients.iter().filter_map(mass).collect()
    }

    /// Drops coefficients that have cancelled; those of arguments and gaps stay, as the runtime counts on them.
    pub fn drop_zeros(&mut self, dag: &Dag) {
        self.coefficients.retain(|&(place, value)| {
            matches!(place, Place::Argument { .. }) || dag.as_number(value) != Some(Rational::ZERO)
        });
    }
}
