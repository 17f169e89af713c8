//! One contact in the linearised equation: a column and a row, with slopes at the nodes of a panel.

use super::nodes::Nodes;
use crate::law::{Derivatives, On, Variation};
use crate::laws::generic::scales::{Scales, Sight};
use crate::model::layout::{ContactLayout, Term};
use crate::orbit::stability::orbit::Orbit;
use crate::orbit::stability::path::Contact;
use crate::system::{Part, Wave};

/// The column `M^-1 e` and the row `d` of a contact, with its slopes at the nodes.
#[derive(Debug, Default)]
pub(super) struct Pair {
    /// Neither direction varies.
    pub(super) fixed: bool,
    pub(super) push: Vec<f64>,
    pub(super) pull: Vec<f64>,
    /// `dd/dtau`
    pub(super) turn: Vec<f64>,
    pub(super) by_gap: Vec<f64>,
    pub(super) by_rate: Vec<f64>,
    /// The slopes are not all zero on this panel.
    pub(super) present: bool,
    /// Where the law may be sharp, once it has been asked.
    scales: Option<Scales>,
    asked: bool,
}

/// Largest change from node to node, in the units of [`Scales`]: steps of order six then err by parts of `1e-4`, and show it.
const PART: f64 = 0.5;

impl Pair {
    /// The directions at a phase.
    pub(super) fn turn_to(
        &mut self,
        layout: &ContactLayout,
        orbit: &Orbit<'_>,
        period: usize,
        inverse_mass: &[f64],
        tau: f64,
    ) {
        let n = orbit.layout.coordinates;
        for vector in [&mut self.push, &mut self.pull, &mut self.turn] {
            vector.clear();
            vector.resize(n, 0.0);
        }
        let value = |term: &Term| orbit.coefficients[term.coefficient];
        for term in &layout.force {
            let value = value(term) * wave_at(term.wave, period, tau);
            for (i, push) in self.push.iter_mut().enumerate() {
                *push += inverse_mass[i * n + term.index] * value;
            }
        }
        for term in &layout.gap {
            self.pull[term.index] += value(term) * wave_at(term.wave, period, tau);
            self.turn[term.index] += value(term) * slope_at(term.wave, period, tau);
        }
    }

    /// The slopes of a piece on which they are constant, at any gap of it. Returns whether that took an evaluation.
    pub(super) fn evaluate_once(
        &mut self,
        orbit: &Orbit<'_>,
        contact: &Contact,
        layout: &ContactLayout,
    ) -> bool {
        let law = orbit.system.law(layout.law);
        let facts = &law.facts().pieces[contact.piece];
        for slopes in [&mut self.by_gap, &mut self.by_rate] {
            slopes.clear();
            slopes.push(0.0);
        }
        self.present = [facts.by_gap, facts.by_rate] != [Variation::Zero; 2];
        if !self.present {
            return false;
        }
        let below = contact
            .piece
            .checked_sub(1)
            .map(|index| contact.levels[index]);
        let above = contact.levels.get(contact.piece).copied();
        let gap = match (below, above) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (Some(a), None) => a + a.abs().max(1.0),
            (None, Some(b)) => b - b.abs().max(1.0),
            (None, None) => 0.0,
        };
        let mut force = [0.0];
        let out = Derivatives {
            force: &mut force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let on = On::Piece(contact.piece);
        law.derivatives(on, &contact.arguments, &[gap], &[0.0], out);
        true
    }

    /// The slopes at the nodes, and what these see of a law that may be sharp.
    pub(super) fn evaluate(
        &mut self,
        orbit: &Orbit<'_>,
        contact: &Contact,
        layout: &ContactLayout,
        nodes: &mut Nodes,
    ) -> Option<Sight> {
        self.present = true;
        self.by_gap.resize(nodes.gap.len(), 0.0);
        self.by_rate.resize(nodes.gap.len(), 0.0);
        let out = Derivatives {
            force: &mut nodes.force,
            by_gap: &mut self.by_gap,
            by_rate: &mut self.by_rate,
        };
        let law = orbit.system.law(layout.law);
        let on = On::Piece(contact.piece);
        law.derivatives(on, &contact.arguments, &nodes.gap, &nodes.rate, out);
        if !self.asked {
            (self.scales, self.asked) = (Scales::of(law), true);
        }
        let scales = self.scales.as_mut()?;
        scales.set(&contact.arguments, &contact.levels);
        if !scales.any(contact.piece) {
            return None;
        }
        let count = nodes.taus.len();
        let (gap, rate) = (&nodes.gap[..count], &nodes.rate[..count]);
        Some(scales.look(contact.piece, gap, rate, PART))
    }
}

/// Value of a wave at a phase of the orbit.
pub(super) fn wave_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 1.0;
    }
    let angle = f64::from(wave.harmonic) * period as f64 * tau;
    match wave.part {
        Part::Cosine => angle.cos(),
        Part::Sine => angle.sin(),
    }
}

/// Its phase derivative.
fn slope_at(wave: Wave, period: usize, tau: f64) -> f64 {
    if wave.harmonic == 0 {
        return 0.0;
    }
    let (slope, sign) = wave.derivative();
    sign * f64::from(wave.harmonic) * period as f64 * wave_at(slope, period, tau)
}
