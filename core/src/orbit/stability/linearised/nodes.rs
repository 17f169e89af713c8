//! The nodes of one panel, and the motion of a contact there.

use super::Panel;
use crate::numeric::fourier::grading::Grading;
use crate::numeric::fourier::kernels::{evaluate, padded};
use crate::numeric::fourier::phases::sines_and_cosines;
use crate::numeric::fourier::taylor::Taylor;
use crate::orbit::stability::magnus;
use crate::orbit::stability::path::{Contact, Cut, Event};

/// The nodes of one panel: three for each step.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    rules: Vec<Rule>,
    pub(super) cosines: Vec<f64>,
    pub(super) sines: Vec<f64>,
    pub(super) taus: Vec<f64>,
    /// Phases from the start of the panel, or from its end and negative.
    pub(super) offsets: Vec<f64>,
    /// Width of a step times the slope of the grading.
    pub(super) weights: Vec<f64>,
    pub(super) gap: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) force: Vec<f64>,
}

/// Graded nodes on `[0, 1]`, kept for the next panel that wants them.
#[derive(Debug)]
struct Rule {
    grading: Grading,
    steps: usize,
    /// Distance from the start, or from the end and negative.
    distances: Vec<f64>,
    /// Slope of the map over the number of steps.
    slopes: Vec<f64>,
}

impl Nodes {
    /// Puts three nodes into every step of a panel.
    pub(super) fn place(&mut self, panel: &Panel) {
        let rule = self.rule(panel);
        let rule = &self.rules[rule];
        let count = rule.distances.len();
        let filled = padded(count);
        for workspace in [
            &mut self.cosines,
            &mut self.sines,
            &mut self.gap,
            &mut self.rate,
            &mut self.force,
        ] {
            workspace.resize(filled, 0.0);
        }
        let width = panel.end - panel.start;
        self.taus.clear();
        self.offsets.clear();
        self.weights.clear();
        self.offsets
            .extend(rule.distances.iter().map(|distance| width * distance));
        self.weights
            .extend(rule.slopes.iter().map(|slope| width * slope));
        self.taus.extend(self.offsets.iter().map(|&offset| {
            let from_end = offset.is_sign_negative();
            offset + if from_end { panel.end } else { panel.start }
        }));
        // Nodes that only fill the last group stand where the last one stands.
        self.taus.resize(filled, self.taus[count - 1]);
        sines_and_cosines(&self.taus, &mut self.sines, &mut self.cosines);
        self.taus.truncate(count);
    }

    fn rule(&mut self, panel: &Panel) -> usize {
        let Panel { grading, steps, .. } = *panel;
        let known = self
            .rules
            .iter()
            .position(|rule| rule.grading == grading && rule.steps == steps);
        known.unwrap_or_else(|| {
            let h = 1.0 / steps as f64;
            let mut rule = Rule {
                grading,
                steps,
                distances: Vec::with_capacity(3 * steps),
                slopes: Vec::with_capacity(3 * steps),
            };
            for step in 0..steps {
                for node in magnus::NODES {
                    let (distance, slope, from_start) = grading.distance((step as f64 + node) * h);
                    rule.distances
                        .push(if from_start { distance } else { -distance });
                    rule.slopes.push(slope * h);
                }
            }
            self.rules.push(rule);
            self.rules.len() - 1
        })
    }

    /// Gap and rate of a contact at the nodes. Close to an end where the gap is on a level and the slopes are singular, the gap
    /// is taken from its Taylor polynomial there: a small distance from the level keeps all its digits then.
    pub(super) fn motion(&mut self, contact: &Contact, panel: &Panel, ends: [Option<Cut>; 2]) {
        evaluate(
            [&contact.gap, &contact.rate],
            &self.cosines,
            &self.sines,
            &mut self.gap,
            &mut self.rate,
        );
        let near = Taylor::reach(&contact.gap);
        let powers = [panel.grading.start, panel.grading.end];
        let phases = [panel.start, panel.end];
        for end in 0..2 {
            let Some(cut) = ends[end].filter(|cut| cut.event != Event::Near && powers[end] > 1)
            else {
                continue;
            };
            let taylor = Taylor::at(&contact.gap, phases[end]);
            let level = contact.levels[cut.level];
            for (&distance, gap) in self.offsets.iter().zip(&mut self.gap) {
                let of_this_end = distance.is_sign_negative() == (end == 1);
                if of_this_end && distance.abs() < near {
                    *gap = taylor.value(level, distance);
                }
            }
        }
    }
}
