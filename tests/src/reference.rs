//! Models of the literature against events and orbits of the differential equations that were computed by other programs.
//!
//! `reference.json` has them, each case with its equations. They are from event-driven shooting with an exact flow or DOP853 in extended
//! precision, confirmed each by a second method as said beside it (harmonic balance with Hill's determinant, Chebyshev collocation,
//! exponentials of 75 digits); none of these knows this library.

use std::collections::BTreeMap;

use hertzian::{Branch, Complex, Event, EventKind, Point, Stop, Verdict};
use serde::Deserialize;

use crate::nearest;

/// Touches are known to so many digits.
const OF_TOUCHES: f64 = 1e-12;

/// What is as near to a touch may be one event with it.
pub const ONE_WITH_TOUCH: f64 = 2e-8;

/// What is known of a model.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its bifurcations: kind and frequency.
    pub events: Vec<(EventKind, f64)>,
    /// Where the motion without contact touches.
    pub touches: Vec<f64>,
    /// Its orbits at a few frequencies.
    pub orbits: Vec<KnownOrbit>,
}

/// An orbit that is known.
#[derive(Debug, Clone, Deserialize)]
pub struct KnownOrbit {
    /// Frequency of the excitation.
    pub omega: f64,
    /// Of signals by their names.
    pub peak_to_peak: BTreeMap<String, f64>,
    /// Largest values.
    pub max: BTreeMap<String, f64>,
    /// Smallest values.
    pub min: BTreeMap<String, f64>,
    /// Of each contact; of the gear pairs the largest gaps.
    pub max_contact_force: Vec<f64>,
    /// The largest multipliers, at most four.
    pub multipliers: Vec<[f64; 2]>,
    /// Whether all are inside of the unit circle.
    pub stable: bool,
}

/// How far an orbit may be from a known one.
#[derive(Debug, Clone, Copy)]
pub struct Accuracy {
    /// Of extremes and forces, as a part of the peak-to-peak of the signal.
    pub of_peaks: f64,
    /// Of multipliers.
    pub of_multipliers: f64,
}

#[derive(Deserialize)]
struct Written {
    cases: Vec<WrittenCase>,
}

#[derive(Deserialize)]
struct WrittenCase {
    name: String,
    events: Vec<WrittenEvent>,
    touches: Vec<String>,
    orbits: Vec<KnownOrbit>,
}

#[derive(Deserialize)]
struct WrittenEvent {
    kind: String,
    omega: String,
}

impl Case {
    /// Of a name in `reference.json`: `A` two masses, `B1` beam, `C` chain, `D1` and `D3` gears, `E1` bearing.
    ///
    /// # Panics
    /// If there is none.
    pub fn of(name: &str) -> Self {
        let all: Written = serde_json::from_str(include_str!("reference.json")).unwrap();
        let case = all.cases.into_iter().find(|case| case.name == name);
        let case = case.unwrap_or_else(|| panic!("no case {name}"));
        let kind = |kind: &str| match kind {
            "fold" => EventKind::Fold,
            "PD" => EventKind::PeriodDoubling,
            "NS" => EventKind::NeimarkSacker,
            other => panic!("an event of kind {other}"),
        };
        let events = case.events.iter();
        let events = events.map(|event| (kind(&event.kind), event.omega.parse().unwrap()));
        Self {
            events: events.collect(),
            touches: case.touches.iter().map(|x| x.parse().unwrap()).collect(),
            orbits: case.orbits,
        }
    }

    /// What lies between two frequencies.
    #[must_use]
    pub fn within(mut self, [low, high]: [f64; 2]) -> Self {
        let inside = |omega: f64| low <= omega && omega <= high;
        self.events.retain(|(_, omega)| inside(*omega));
        self.touches.retain(|omega| inside(*omega));
        self.orbits.retain(|orbit| inside(orbit.omega));
        self
    }

    /// Every event is found, each within the error that is stated for it and `digits`. What is beside a touch may be one event with it.
    /// Returns those besides.
    ///
    /// # Panics
    /// If one is not found.
    pub fn besides<'b>(&self, branch: &'b Branch, digits: f64) -> Vec<&'b Event> {
        let mut left: Vec<_> = branch.events.iter().collect();
        let known = self.touches.iter();
        let known = known.map(|omega| (EventKind::Grazing { turns: false }, *omega));
        for (kind, omega) in self.events.iter().copied().chain(known) {
            let alike = (0..left.len()).filter(|&i| left[i].kind.is_like(kind));
            let apart = |i: &usize| (left[*i].point.value - omega).abs();
            let digits = digits.max(if touches(kind) { OF_TOUCHES } else { 0.0 });
            match nearest(alike, 0.0, apart) {
                Some(i) if apart(&i) <= left[i].error + digits => {
                    left.remove(i);
                }
                _ => assert!(
                    !touches(kind) && is_touched(branch, omega),
                    "{kind} at {omega} is missing among {:#?}",
                    said(branch)
                ),
            }
        }
        left
    }

    /// A branch that was followed to its end has [every event](Self::besides) and none besides but so many grazings, of which nothing is
    /// known.
    ///
    /// # Panics
    /// If that is not so.
    pub fn assert_events(&self, branch: &Branch, digits: f64, grazings: usize) {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let besides = self.besides(branch, digits);
        let more = besides.iter().filter(|event| touches(event.kind));
        assert_eq!(
            (besides.len(), more.count()),
            (grazings, grazings),
            "besides {:?} and {:?}: {:#?}",
            self.events,
            self.touches,
            said(branch)
        );
    }

    /// The orbits of a branch at the known frequencies are the known ones and no others: extremes of signals, largest forces of
    /// contacts by their names (of the gear pairs, gaps are compared by extremes alone), multipliers and verdicts.
    ///
    /// # Panics
    /// If they are not.
    pub fn assert_orbits(&self, branch: &Branch, forces: &[&str], accuracy: Accuracy) {
        let mut frequencies: Vec<f64> = self.orbits.iter().map(|orbit| orbit.omega).collect();
        frequencies.dedup();
        for omega in frequencies {
            let points = branch.at(omega).unwrap();
            let known: Vec<_> = self.orbits.iter().filter(|o| o.omega == omega).collect();
            assert_eq!(points.len(), known.len(), "orbits at {omega}");
            for known in known {
                known.assert_among(branch, &points, forces, accuracy);
            }
        }
    }
}

/// Events in words.
fn said(branch: &Branch) -> Vec<String> {
    let events = branch.events.iter();
    let said = events.map(|e| format!("{} at {} +- {:.0e}", e.kind, e.point.value, e.error));
    said.collect()
}

/// Whether a gap touches a level there.
pub fn touches(kind: EventKind) -> bool {
    matches!(kind, EventKind::Grazing { .. })
}

fn is_touched(branch: &Branch, omega: f64) -> bool {
    let mut events = branch.events.iter();
    events.any(|event| touches(event.kind) && (event.point.value - omega).abs() <= ONE_WITH_TOUCH)
}

impl KnownOrbit {
    /// The nearest of some orbits is this one.
    fn assert_among(&self, branch: &Branch, points: &[Point], forces: &[&str], accuracy: Accuracy) {
        let omega = self.omega;
        let (first, size) = self.peak_to_peak.iter().next().unwrap();
        let peak = |point: &&Point| branch.reading(first, point).unwrap().motion.peak_to_peak();
        let point = nearest(points, *size, peak).unwrap();
        let near = |what: &str, found: f64, known: f64, size: f64| {
            let off = (found - known).abs() / size;
            assert!(
                off <= accuracy.of_peaks,
                "{what} at {omega}: {found} instead of {known}, off by {off:.1e}"
            );
        };
        for (name, size) in &self.peak_to_peak {
            let motion = branch.reading(name, point).unwrap().motion;
            near(name, motion.peak_to_peak(), *size, *size);
            near(name, motion.maximum, self.max[name], *size);
            near(name, motion.minimum, self.min[name], *size);
        }
        for (name, known) in forces.iter().zip(&self.max_contact_force) {
            let force = branch.reading(name, point).unwrap().motion.maximum;
            near(name, force, *known, known.max(1e-3));
        }
        for [re, im] in &self.multipliers {
            let known = Complex::new(*re, *im);
            let off = |found: &&Complex<f64>| (*found - known).norm();
            let among = &point.stability.multipliers;
            let off = nearest(among, 0.0, off).map_or(f64::INFINITY, |found| off(&found));
            assert!(
                off <= accuracy.of_multipliers,
                "multiplier {known} at {omega} is off by {off:.1e}: {among:?}"
            );
        }
        let verdict = if self.stable {
            Verdict::Stable
        } else {
            Verdict::Unstable
        };
        assert_eq!(point.stability.verdict, verdict, "at {omega}");
    }
}
