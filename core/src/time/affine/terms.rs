//! What the equations of motion are made of, at given coefficients: all that is linear in them, and the pieces of the laws.

use crate::law::{Derivatives, Law, On};
use crate::laws::single::Single;
use crate::model::layout::{Entry, Layout, Term, add_constant};
use crate::system::{Part, Wave};

/// What the entries of `z` are.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Number of coordinates.
    pub(super) coordinates: usize,
    /// The harmonics of load and offsets, in increasing order.
    pub(super) harmonics: Vec<u32>,
}

impl Basis {
    pub(super) fn of(layout: &Layout) -> Self {
        let loads = layout.load.iter().map(|entry| entry.wave.harmonic);
        let offsets = layout
            .contacts
            .iter()
            .flat_map(|contact| contact.offset.iter().map(|term| term.wave.harmonic));
        let mut harmonics: Vec<_> = loads.chain(offsets).filter(|&h| h > 0).collect();
        harmonics.sort_unstable();
        harmonics.dedup();
        Self {
            coordinates: layout.coordinates,
            harmonics,
        }
    }

    /// Entries of `z`.
    pub(super) fn order(&self) -> usize {
        2 * self.coordinates + self.waves()
    }

    /// The constant and the waves.
    pub(super) fn waves(&self) -> usize {
        1 + 2 * self.harmonics.len()
    }

    /// Position of a wave among the waves; the sine of harmonic zero has none.
    fn position(&self, wave: Wave) -> Option<usize> {
        let sine = usize::from(wave.part == Part::Sine);
        if wave.harmonic == 0 {
            return (sine == 0).then_some(0);
        }
        let index = self.harmonics.binary_search(&wave.harmonic).ok()?;
        Some(1 + 2 * index + sine)
    }

    /// Writes the constant and the waves at a phase.
    pub(super) fn write_waves(&self, phase: f64, waves: &mut [f64]) {
        waves[0] = 1.0;
        for (pair, &harmonic) in waves[1..].chunks_exact_mut(2).zip(&self.harmonics) {
            let (sine, cosine) = (f64::from(harmonic) * phase).sin_cos();
            (pair[0], pair[1]) = (cosine, sine);
        }
    }
}

/// Everything of equations (1) to (3) of [`system`](crate::system) that is linear in the coefficients: from them, or from their
/// derivatives by a variable.
#[derive(Debug, Clone)]
pub(super) struct Terms {
    pub(super) mass: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    pub(super) load: Vec<f64>,
    pub(super) contacts: Vec<ContactTerms>,
    /// `nu`
    pub(super) base: f64,
}

/// The terms of one contact.
#[derive(Debug, Clone)]
pub(super) struct ContactTerms {
    /// `e`
    pub(super) force: Vec<f64>,
    /// `d`
    pub(super) gap: Vec<f64>,
    /// `delta`, by waves.
    pub(super) offset: Vec<f64>,
    pub(super) arguments: Vec<f64>,
}

impl Terms {
    pub(super) fn new(layout: &Layout, basis: &Basis) -> Self {
        let n = layout.coordinates;
        let contacts = layout.contacts.iter().map(|contact| ContactTerms {
            force: vec![0.0; n],
            gap: vec![0.0; n],
            offset: vec![0.0; basis.waves()],
            arguments: vec![0.0; contact.argument_count],
        });
        Self {
            mass: vec![0.0; n * n],
            damping: vec![0.0; n * n],
            stiffness: vec![0.0; n * n],
            load: vec![0.0; n * basis.waves()],
            contacts: contacts.collect(),
            base: 0.0,
        }
    }

    /// Sets all terms from coefficients.
    pub(super) fn fill(&mut self, layout: &Layout, basis: &Basis, coefficients: &[f64]) {
        let n = layout.coordinates;
        let matrix = |entries: &[Entry], out: &mut [f64]| {
            out.fill(0.0);
            add_constant(entries, coefficients, n, out);
        };
        matrix(&layout.mass, &mut self.mass);
        matrix(&layout.damping, &mut self.damping);
        matrix(&layout.stiffness, &mut self.stiffness);
        self.load.fill(0.0);
        for entry in &layout.load {
            if let Some(wave) = basis.position(entry.wave) {
                self.load[entry.row * basis.waves() + wave] += coefficients[entry.coefficient];
            }
        }
        for (contact, terms) in layout.contacts.iter().zip(&mut self.contacts) {
            let constant = |of: &[Term], out: &mut [f64]| {
                out.fill(0.0);
                for term in of {
                    out[term.index] += coefficients[term.coefficient];
                }
            };
            constant(&contact.force, &mut terms.force);
            constant(&contact.gap, &mut terms.gap);
            terms.offset.fill(0.0);
            for term in &contact.offset {
                if let Some(wave) = basis.position(term.wave) {
                    terms.offset[wave] += coefficients[term.coefficient];
                }
            }
            contact.arguments(coefficients, &mut terms.arguments);
        }
    }
}

impl Terms {
    /// Those of the motion backwards, `q(-t)`: rates and the sines of the phase change their signs.
    pub(super) fn reverse(&mut self, basis: &Basis) {
        let negate = |x: &mut f64| *x = -*x;
        self.damping.iter_mut().for_each(negate);
        let offsets = self.contacts.iter_mut().map(|terms| &mut terms.offset);
        for waves in offsets.chain([&mut self.load]) {
            for waves in waves.chunks_exact_mut(basis.waves()) {
                waves[1..].iter_mut().skip(1).step_by(2).for_each(negate);
            }
        }
    }
}

/// An affine piece: `phi = force + by_gap (g - at) + by_rate g'`, or its derivative by a variable at fixed `at`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Line {
    pub(super) at: f64,
    pub(super) force: f64,
    pub(super) by_gap: f64,
    pub(super) by_rate: f64,
}

impl Line {
    /// A piece of a law.
    pub(super) fn of(law: &dyn Law, arguments: &[f64], levels: &[f64], piece: usize) -> Self {
        let at = end_of(levels, piece);
        let Single {
            force,
            by_gap,
            by_rate,
        } = Single::of(law, On::Piece(piece), arguments, [at, 0.0]);
        Self {
            at,
            force,
            by_gap,
            by_rate,
        }
    }

    /// Adds the derivative of a piece by one argument, times the derivative of that argument.
    pub(super) fn add_derivative(
        &mut self,
        law: &dyn Law,
        arguments: &[f64],
        levels: &[f64],
        piece: usize,
        argument: usize,
        factor: f64,
    ) {
        let at = end_of(levels, piece);
        // Another gap of the same piece.
        let other = match levels.get(piece) {
            Some(&upper) if upper > at => upper,
            Some(_) => at - 1.0,
            None => at + 1.0,
        };
        let mut by = [0.0; 3];
        let [mut force, mut by_gap, mut by_rate] = [[0.0; 3]; 3];
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut by_gap,
            by_rate: &mut by_rate,
        };
        let (gap, rate) = ([at, other, at], [0.0, 0.0, 1.0]);
        let on = On::Piece(piece);
        law.derivatives_and_by(argument, on, arguments, &gap, &rate, out, &mut by);
        self.at = at;
        self.force += factor * by[0];
        self.by_gap += factor * (by[1] - by[0]) / (other - at);
        self.by_rate += factor * (by[2] - by[0]);
    }
}

/// A gap at the end of a piece.
fn end_of(levels: &[f64], piece: usize) -> f64 {
    let level = levels.get(piece.saturating_sub(1));
    level.copied().unwrap_or(0.0)
}
