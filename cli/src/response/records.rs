//! What is written to JSON and CSV: plain numbers with stable names.

use std::collections::BTreeMap;

use hertzian::observe::{amplitudes, phases};
use hertzian::shooting::BifurcationCurve;
use hertzian::system::SystemFacts;
use hertzian::{Branch, Event, Point, Statistics, System};
use serde::Serialize;

use super::backbone::Backbone;
use super::options::Options;

/// Everything about a branch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Record {
    /// Name of the oscillator.
    pub model: String,
    /// Its equations.
    pub equation: String,
    /// Its parameters where the branch begins.
    pub parameters: BTreeMap<String, f64>,
    /// Name of what varies.
    pub varied: String,
    /// The points in branch order.
    pub points: Vec<PointRecord>,
    /// Special orbits.
    pub events: Vec<EventRecord>,
    /// Places where the branch turned, but not through a fold.
    pub turns: Vec<TurnRecord>,
    /// Every solution at the values that were asked for.
    pub at: Vec<PointRecord>,
    /// Curves of bifurcations in two parameters.
    pub tracks: Vec<TrackRecord>,
    /// Free oscillation and phase resonance.
    pub backbone: Backbone,
    /// Why the branch ended.
    pub stopped: String,
    /// What it cost.
    pub statistics: StatisticsRecord,
    /// Time of the computation alone.
    pub elapsed_seconds: f64,
}

/// One orbit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointRecord {
    /// Number of the branch: zero is the one that was asked for.
    pub branch: usize,
    /// Period of the orbit, in periods of the excitation.
    pub period: usize,
    /// What varies along the branch.
    pub value: f64,
    /// Frequency of the excitation.
    pub omega: f64,
    /// Amplitude of the excitation.
    pub drive: f64,
    /// Largest less smallest displacement.
    pub peak_to_peak: f64,
    /// Largest displacement.
    pub max: f64,
    /// Smallest displacement.
    pub min: f64,
    /// Mean displacement.
    pub mean: Option<f64>,
    /// Root of the mean square of the displacement, mean included.
    pub rms: Option<f64>,
    /// `stable`, `unstable` or `undecided`.
    pub stability: String,
    /// Floquet multipliers, real and imaginary part.
    pub multipliers: Vec<[f64; 2]>,
    /// Number of harmonics of the orbit.
    pub harmonics: usize,
    /// Estimated relative error of peak-to-peak.
    pub error: Option<f64>,
    /// Amplitudes of the harmonics, the mean first.
    pub amplitudes: Vec<f64>,
    /// Phase lags of the harmonics, the mean's zero first.
    pub phases: Vec<f64>,
    /// Fraction of the period on pieces of the law that are not zero; this and the next two of the first contact, if the oscillator has one.
    pub contact_fraction: Option<f64>,
    /// Contacts per period.
    pub contacts: Option<usize>,
    /// Largest contact force.
    pub peak_force: Option<f64>,
    /// Smallest and largest force of each contact, with their signs.
    pub contact_forces: Vec<[f64; 2]>,
    /// Part of the period on each piece of the law of each contact, from the lowest gaps to the highest.
    pub contact_pieces: Vec<Vec<f64>>,
    /// Mean power that is dissipated.
    pub dissipated_power: Option<f64>,
}

/// A special orbit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventRecord {
    /// Number of the branch.
    pub branch: usize,
    /// Period of the orbit, in periods of the excitation.
    pub period: usize,
    /// What happens there.
    pub kind: String,
    /// What varies along the branch.
    pub value: f64,
    /// Frequency of the excitation.
    pub omega: f64,
    /// Amplitude of the excitation.
    pub drive: f64,
    /// Largest less smallest displacement.
    pub peak_to_peak: f64,
    /// Estimated error of what the branch varies.
    pub error: f64,
}

/// A place where the branch turned, but not through a fold.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TurnRecord {
    /// What varies along the branch.
    pub value: f64,
    /// What would have happened where the test function vanishes.
    pub kind: String,
    /// Frequency of the excitation.
    pub omega: f64,
    /// Amplitude of the excitation.
    pub drive: f64,
    /// Number of points of the branch before it.
    pub after: usize,
}

/// A curve of bifurcations in two parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrackRecord {
    /// What bifurcates.
    pub kind: String,
    /// Period of the orbits, in periods of the excitation.
    pub period: usize,
    /// Names of the two parameters.
    pub names: [String; 2],
    /// Their values along the curve.
    pub points: Vec<[f64; 2]>,
    /// Its special points.
    pub special: Vec<SpecialRecord>,
}

/// A special point of a curve of bifurcations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpecialRecord {
    /// What is special.
    pub kind: String,
    /// Values of the two parameters.
    pub values: [f64; 2],
    /// Estimated error of them.
    pub error: f64,
}

impl TrackRecord {
    /// Of a curve.
    pub fn of(track: &BifurcationCurve) -> Self {
        Self {
            kind: track.kind.to_string(),
            period: track.period,
            names: track.names.clone(),
            points: track.points.iter().map(|point| point.values).collect(),
            special: track
                .special
                .iter()
                .map(|special| SpecialRecord {
                    kind: special.kind.to_string(),
                    values: special.values,
                    error: special.error,
                })
                .collect(),
        }
    }
}

/// Counts of the work done.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StatisticsRecord {
    /// Evaluations of the residual alone.
    pub residuals: usize,
    /// Evaluations of the residual together with its Jacobian.
    pub jacobians: usize,
    /// Evaluations of the derivative of the residual in one direction.
    pub derivatives: usize,
    /// Factorisations of a dense matrix.
    pub factorisations: usize,
    /// Steps that gave a point.
    pub accepted_steps: usize,
    /// Steps that were tried again with a smaller length.
    pub rejected_steps: usize,
    /// Orbits whose multipliers were computed.
    pub monodromies: usize,
}

impl Record {
    /// Of a branch, and of solutions at values that were asked for.
    pub fn of(branch: &Branch, system: &dyn System, options: &Options, at: &[Point]) -> Self {
        let facts = system.facts();
        let point = |point: &Point| PointRecord::of(point, facts);
        // A turn has no orbit of its own; what the branch does not vary is the same at every point.
        let fixed = branch.points.first().map(point);
        let turn = |turn: &hertzian::Turn| {
            let (omega, drive) = fixed
                .as_ref()
                .map_or((f64::NAN, f64::NAN), |p| (p.omega, p.drive));
            let (omega, drive) = match options.varied() {
                "omega" => (turn.value, drive),
                "drive" => (omega, turn.value),
                _ => (omega, drive),
            };
            TurnRecord {
                value: turn.value,
                kind: turn.kind.to_string(),
                omega,
                drive,
                after: turn.after,
            }
        };
        let mut values = vec![0.0; facts.parameters.len()];
        system.values(&mut values);
        let first = branch.points.first();
        let values = first.map_or(values, |point| point.parameters.clone());
        let names = facts.parameters.iter().map(|p| p.name.to_string());
        Self {
            model: facts.name.to_string(),
            equation: facts.equation.to_string(),
            parameters: names.zip(values).collect(),
            varied: options.varied().to_owned(),
            points: branch.points.iter().map(point).collect(),
            events: branch
                .events
                .iter()
                .map(|event| EventRecord::of(0, event, facts))
                .collect(),
            turns: branch.turns.iter().map(turn).collect(),
            at: at.iter().map(point).collect(),
            tracks: Vec::new(),
            backbone: Backbone::default(),
            stopped: branch.stopped.to_string(),
            statistics: branch.statistics.into(),
            elapsed_seconds: branch.elapsed.as_secs_f64(),
        }
    }
}

impl PointRecord {
    /// Of a point.
    pub fn of(point: &Point, facts: &SystemFacts) -> Self {
        let motion = point.motion();
        let series = point.orbit.series(0).unwrap_or_default();
        let multipliers = point.stability.multipliers.iter();
        let contact = point.observed.contacts.first();
        Self {
            branch: 0,
            period: point.orbit.period,
            value: point.value,
            omega: point.omega(),
            drive: drive(point.parameters.as_slice(), facts),
            peak_to_peak: motion.peak_to_peak(),
            max: motion.maximum,
            min: motion.minimum,
            mean: motion.mean,
            rms: motion.rms,
            stability: point.stability.verdict.to_string(),
            multipliers: multipliers.map(|m| [m.re, m.im]).collect(),
            harmonics: point.orbit.harmonics(),
            error: point.error,
            amplitudes: amplitudes(series),
            phases: phases(series),
            contact_fraction: contact.map(|contact| contact.fraction),
            contacts: contact.map(|contact| contact.count),
            peak_force: contact.map(|contact| contact.peak_force),
            contact_forces: point
                .observed
                .contacts
                .iter()
                .map(|contact| [contact.minimum_force, contact.maximum_force])
                .collect(),
            contact_pieces: point.observed.on_pieces.clone(),
            dissipated_power: point.observed.dissipated_power,
        }
    }
}

impl EventRecord {
    /// Of an event of a branch with a number.
    pub fn of(branch: usize, event: &Event, facts: &SystemFacts) -> Self {
        Self {
            branch,
            period: event.point.orbit.period,
            kind: event.kind.to_string(),
            value: event.point.value,
            omega: event.point.omega(),
            drive: drive(&event.point.parameters, facts),
            peak_to_peak: event.point.peak_to_peak(),
            error: event.error,
        }
    }
}

impl From<Statistics> for StatisticsRecord {
    fn from(statistics: Statistics) -> Self {
        Self {
            residuals: statistics.residuals,
            jacobians: statistics.jacobians,
            derivatives: statistics.derivatives,
            factorisations: statistics.factorisations,
            accepted_steps: statistics.accepted_steps,
            rejected_steps: statistics.rejected_steps,
            monodromies: statistics.monodromies,
        }
    }
}

fn drive(parameters: &[f64], facts: &SystemFacts) -> f64 {
    let drive = facts.parameters.iter().position(|p| p.name == "drive");
    drive.map_or(f64::NAN, |index| parameters[index])
}
