//! Signals of a motion at one instant: sums of coordinates, rates, accelerations and forces of laws, from the state there and the pieces
//! that the gaps are on.
//!
//! An acceleration is what the equations of motion give, `q'' = M^-1 ( f - C q' - K q - sum_c e_c phi_c )`.

mod alike;

use nalgebra::DMatrix;

use super::gap::{Gap, Waves};
use crate::law::{On, Variation};
use crate::laws::single;
use crate::model::layout::Layout;
use crate::system::{Place, Signal, System, Wave};

/// Which signals are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Asked {
    /// All outputs of the system.
    Outputs,
    /// One of them.
    Output(usize),
    /// A coordinate.
    Coordinate(usize),
    /// All coordinates.
    Coordinates,
    /// The law of a contact.
    Contact(usize),
    /// The laws of all contacts.
    Contacts,
}

/// A multiple of something that moves.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Term {
    of: Signal,
    wave: Wave,
    coefficient: f64,
}

impl Term {
    fn once(of: Signal) -> Self {
        Self {
            of,
            wave: Wave::CONSTANT,
            coefficient: 1.0,
        }
    }
}

/// What is known of a contact at these values.
#[derive(Debug)]
struct Contact {
    law: usize,
    gap: Gap,
    arguments: Vec<f64>,
    levels: Vec<f64>,
}

/// Some of the signals, and the contacts whose forces they are made of.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chosen {
    signals: Vec<usize>,
    contacts: Vec<usize>,
    accelerates: bool,
}

impl Chosen {
    /// Which signals these are.
    pub(crate) fn signals(&self) -> &[usize] {
        &self.signals
    }
}

/// Signals of a system at values of its parameters and of `omega`.
#[derive(Debug)]
pub(crate) struct Signals<'s> {
    system: &'s dyn System,
    layout: Layout,
    coefficients: Vec<f64>,
    contacts: Vec<Contact>,
    /// `M^-1`, where an acceleration is asked for.
    inverse_mass: Option<DMatrix<f64>>,
    sums: Vec<Vec<Term>>,
    /// Room for the forces of the contacts, and for what accelerates the coordinates.
    forces: Vec<f64>,
    loads: Vec<f64>,
}

impl<'s> Signals<'s> {
    pub(crate) fn new(
        system: &'s dyn System,
        parameters: &[f64],
        omega: f64,
        asked: Asked,
    ) -> Self {
        let layout = Layout::of(system);
        let mut coefficients = vec![0.0; layout.coefficients];
        system.coefficients(parameters, omega, &mut coefficients);
        let base = omega / f64::from(system.facts().divisor);
        let signals = terms(system, &coefficients, asked);
        let uses = |signal: fn(&Signal) -> bool| signals.iter().flatten().any(|t| signal(&t.of));
        let accelerates = uses(|of| matches!(of, Signal::Acceleration(_)));
        let contacts = layout.contacts.iter().map(|contact| {
            let law = system.law(contact.law);
            let mut arguments = vec![0.0; contact.argument_count];
            contact.arguments(&coefficients, &mut arguments);
            let mut levels = vec![0.0; law.facts().levels.len()];
            law.levels(&arguments, &mut levels);
            Contact {
                law: contact.law,
                gap: Gap::new(contact, &coefficients, base),
                arguments,
                levels,
            }
        });
        let contacts: Vec<Contact> = contacts.collect();
        let inverse_mass = accelerates.then(|| layout.mass(&coefficients).try_inverse());
        Self {
            system,
            forces: vec![0.0; contacts.len()],
            loads: vec![0.0; layout.coordinates],
            contacts,
            inverse_mass: inverse_mass.flatten(),
            sums: signals,
            layout,
            coefficients,
        }
    }

    /// Some of them alone, in this order.
    pub(crate) fn only(mut self, signals: &[usize]) -> Self {
        let sums = signals.iter().map(|signal| self.sums[*signal].clone());
        self.sums = sums.collect();
        self
    }

    /// Number of signals.
    pub(crate) fn count(&self) -> usize {
        self.sums.len()
    }

    /// Number of pieces of the law of each contact.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = usize> {
        self.contacts.iter().map(|contact| contact.levels.len() + 1)
    }

    /// Whether a contact has a force on a piece.
    pub(crate) fn touches(&self, contact: usize, piece: usize) -> bool {
        let law = self.system.law(self.contacts[contact].law);
        law.facts().pieces[piece].force != Variation::Zero
    }

    /// Writes the pieces that the gaps are on.
    pub(crate) fn place(&self, phase: f64, state: &[f64], pieces: &mut [usize]) {
        for (piece, contact) in pieces.iter_mut().zip(&self.contacts) {
            let (gap, _) = contact.gap.at(phase, state);
            *piece = contact.levels.iter().filter(|&&level| gap > level).count();
        }
    }

    /// Some of the signals.
    pub(crate) fn choose(&self, signals: impl IntoIterator<Item = usize>) -> Chosen {
        let signals: Vec<usize> = signals.into_iter().collect();
        let terms = || signals.iter().flat_map(|&signal| &self.sums[signal]);
        let accelerates = terms().any(|term| matches!(term.of, Signal::Acceleration(_)));
        let has_force = |contact: usize| terms().any(|term| term.of == Signal::Force(contact));
        let contacts = 0..self.contacts.len();
        let contacts = contacts.filter(|&contact| accelerates || has_force(contact));
        Chosen {
            contacts: contacts.collect(),
            signals,
            accelerates,
        }
    }

    /// Writes all signals, with every contact on a piece.
    pub(crate) fn write(&mut self, phase: f64, state: &[f64], pieces: &[usize], out: &mut [f64]) {
        let all = self.choose(0..self.count());
        self.write_some(&all, phase, state, pieces, out);
    }

    /// Writes some of the signals, each in its place, with every contact on a piece.
    pub(crate) fn write_some(
        &mut self,
        some: &Chosen,
        phase: f64,
        state: &[f64],
        pieces: &[usize],
        out: &mut [f64],
    ) {
        self.compute_forces(&some.contacts, phase, state, pieces);
        if some.accelerates {
            self.compute_loads(phase, state);
        }
        let mut waves = Waves::at(phase);
        for &signal in &some.signals {
            let values = self.sums[signal].iter().map(|term| {
                term.coefficient * waves.value(term.wave) * self.signal(term.of, state)
            });
            out[signal] = values.sum();
        }
    }

    fn signal(&self, of: Signal, state: &[f64]) -> f64 {
        match of {
            Signal::Coordinate(index) => state[index],
            Signal::Rate(index) => state[self.layout.coordinates + index],
            Signal::Acceleration(index) => {
                let Some(inverse) = &self.inverse_mass else {
                    return f64::NAN;
                };
                let row = inverse.row(index);
                row.iter().zip(&self.loads).map(|(m, f)| m * f).sum()
            }
            Signal::Force(contact) => self.forces[contact],
            _ => 1.0,
        }
    }

    fn compute_forces(&mut self, of: &[usize], phase: f64, state: &[f64], pieces: &[usize]) {
        for &index in of {
            let (contact, piece) = (&self.contacts[index], pieces[index]);
            let force = &mut self.forces[index];
            let law = self.system.law(contact.law);
            *force = 0.0;
            if law.facts().pieces[piece].force == Variation::Zero {
                continue;
            }
            let (gap, rate) = contact.gap.at(phase, state);
            // Where a stretch ends rounding must not take the gap off its piece.
            let lower = piece.checked_sub(1).map(|level| contact.levels[level]);
            let gap = lower.map_or(gap, |lower| gap.max(lower));
            let upper = contact.levels.get(piece);
            let gap = upper.map_or(gap, |&upper| gap.min(upper));
            *force = single::force(law, On::Piece(piece), &contact.arguments, [gap, rate]);
        }
    }

    /// `f - C q' - K q - sum_c e_c phi_c`.
    fn compute_loads(&mut self, phase: f64, state: &[f64]) {
        let (q, v) = state.split_at(self.layout.coordinates);
        let (loads, coefficients) = (&mut self.loads, &self.coefficients);
        let mut waves = Waves::at(phase);
        loads.fill(0.0);
        for entry in &self.layout.load {
            loads[entry.row] += coefficients[entry.coefficient] * waves.value(entry.wave);
        }
        for entry in &self.layout.damping {
            loads[entry.row] -= coefficients[entry.coefficient] * v[entry.column];
        }
        for entry in &self.layout.stiffness {
            let k = coefficients[entry.coefficient] * waves.value(entry.wave);
            loads[entry.row] -= k * q[entry.column];
        }
        for (contact, force) in self.layout.contacts.iter().zip(&self.forces) {
            for term in &contact.force {
                let e = coefficients[term.coefficient] * waves.value(term.wave);
                loads[term.index] -= e * force;
            }
        }
    }
}

/// What is asked for, as sums.
fn terms(system: &dyn System, coefficients: &[f64], asked: Asked) -> Vec<Vec<Term>> {
    let facts = system.facts();
    let output = |output: usize| -> Vec<Term> {
        let places = facts.places.iter().zip(coefficients);
        let terms = places.filter_map(|(place, &coefficient)| match *place {
            Place::Output {
                output: own,
                of,
                wave,
            } if own == output => Some(Term {
                of,
                wave,
                coefficient,
            }),
            _ => None,
        });
        terms.collect()
    };
    let coordinate = |index: usize| vec![Term::once(Signal::Coordinate(index))];
    let force = |contact: usize| vec![Term::once(Signal::Force(contact))];
    match asked {
        Asked::Outputs => (0..facts.outputs.len()).map(output).collect(),
        Asked::Output(index) => vec![output(index)],
        Asked::Coordinate(index) => vec![coordinate(index)],
        Asked::Coordinates => (0..facts.coordinates.len()).map(coordinate).collect(),
        Asked::Contact(contact) => vec![force(contact)],
        Asked::Contacts => (0..facts.contacts.len()).map(force).collect(),
    }
}
