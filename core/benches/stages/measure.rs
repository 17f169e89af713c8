//! Times of one evaluation, whole and in parts.

use std::fmt;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use hertzian::generic::InterpretedLaw;
use hertzian::law::Law;
use hertzian::stages::Stages;
use hertzian::stages::{Crossing, CrossingFinder, NearMiss};
use hertzian::system::System;
use hertzian::{Branch, FrequencyResponse, Point};

use super::With;
use super::dual_law::DualLaw;
use super::observe::{Call, Observed};

/// Turns of each kind of law.
pub const TURNS: usize = 301;
/// How often a law's calls are repeated in a turn: some are shorter than the resolution of the clock.
const REPEATS: usize = 20;

pub const WHOLE: &str = "residual, generated | interpreted | dual numbers | Jacobian, generated | interpreted | dual numbers";
pub const PARTS: &str = "core | nodes | crossings | placing nodes | law | projection | assembly | Jacobian | factorisation | \
law / Jacobian | law / both";

/// A branch through resonance, under the load of which contact is lost there.
fn branch(system: &dyn System, harmonics: usize) -> Branch {
    let request = FrequencyResponse::of(system)
        .from(0.8)
        .to(1.4)
        .harmonics(harmonics);
    request.stability(false).run().expect("a branch")
}

/// Its largest orbit.
fn largest(branch: &Branch) -> &Point {
    let size = |point: &&Point| point.peak_to_peak();
    branch
        .points
        .iter()
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .expect("points")
}

fn stages(branch: &Branch) -> Stages<'_> {
    Stages::at(branch, largest(branch)).expect("a branch of the balance")
}

/// Residual and Jacobian with the three kinds of laws.
pub struct Whole {
    residual: [f64; 3],
    jacobian: [f64; 3],
}

impl Whole {
    pub fn of(system: &dyn System, harmonics: usize) -> Self {
        let interpreted = InterpretedLaw::of(system.law(0)).expect("a generated law");
        let dual = DualLaw::of(system.law(0));
        let laws: [Option<Arc<dyn Law>>; 3] =
            [None, Some(Arc::new(interpreted)), Some(Arc::new(dual))];
        let branches = laws.map(|law| {
            let system = system.shared();
            branch(&With { system, law }, harmonics)
        });
        let mut stages = branches.each_ref().map(stages);
        agree(&mut stages);
        let mut residual: [Vec<f64>; 3] = Default::default();
        let mut jacobian: [Vec<f64>; 3] = Default::default();
        for _ in 0..TURNS {
            for (kind, stages) in stages.iter_mut().enumerate() {
                residual[kind].push(seconds(|| _ = black_box(stages.residual())));
                jacobian[kind].push(seconds(|| stages.jacobian()));
            }
        }
        Self {
            residual: residual.map(median),
            jacobian: jacobian.map(median),
        }
    }
}

/// All laws have found the same orbit, and are therefore at the same work.
fn agree(stages: &mut [Stages<'_>; 3]) {
    let cores = stages.each_ref().map(Stages::core);
    assert_eq!(cores, [cores[0]; 3]);
    for stages in stages {
        let largest = stages
            .residual()
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(largest < 1e-8, "the residual is {largest}");
    }
}

/// Where the time of the generated law's Jacobian goes.
pub struct Parts {
    core: usize,
    nodes: usize,
    crossings: f64,
    placing: f64,
    law: f64,
    projection: f64,
    assembly: f64,
    jacobian: f64,
    factorisation: f64,
}

impl Parts {
    pub fn of(system: &dyn System, harmonics: usize) -> Self {
        let law = system.law(0);
        let observed = Arc::new(Observed::new(system));

        let with = With {
            system: system.shared(),
            law: Some(Arc::clone(&observed) as Arc<dyn Law>),
        };
        let of_observed = branch(&with, harmonics);
        let point = largest(&of_observed);
        let mut stages = Stages::at(&of_observed, point).expect("a branch of the balance");
        let of_plain = branch(system, harmonics);
        let mut plain = self::stages(&of_plain);
        let mut search = Search::new(point.orbit.series(0).unwrap());

        observed.take();
        stages.contacts();
        let mut calls = observed.take();
        let samples = |index: usize| calls.get(index).map_or(0, Call::samples);
        let nodes: usize = (0..calls.len()).map(samples).sum();
        let first = samples(0);

        let mut times: [Vec<f64>; 6] = Default::default();
        let [before, contacts, crossings, by_law, jacobian, factorisation] = &mut times;
        for _ in 0..TURNS {
            let start = Instant::now();
            stages.contacts();
            let call = &observed.take()[0];
            before.push((call.start - start).as_secs_f64());
            contacts.push(seconds(|| plain.contacts()));
            crossings.push(seconds(|| search.find()));
            let mut all = || calls.iter_mut().for_each(|call| call.repeat(law));
            by_law.push(seconds(|| (0..REPEATS).for_each(|_| all())) / REPEATS as f64);
            jacobian.push(seconds(|| plain.jacobian()));
            factorisation.push(seconds(|| assert!(plain.factorise())));
        }
        let [before, contacts, crossings, law, jacobian, factorisation] = times.map(median);
        // Batches after the first are placed as that one is.
        let placing = (before - crossings) * nodes as f64 / first as f64;
        Self {
            core: plain.core(),
            nodes,
            crossings,
            placing,
            law,
            projection: contacts - crossings - placing - law,
            assembly: jacobian - contacts,
            jacobian,
            factorisation,
        }
    }
}

/// The search for crossings of a gap with zero, as the balance makes it.
struct Search<'a> {
    finder: CrossingFinder,
    gap: &'a [f64],
    crossings: Vec<Crossing>,
    misses: Vec<NearMiss>,
}

impl<'a> Search<'a> {
    fn new(gap: &'a [f64]) -> Self {
        Self {
            finder: CrossingFinder::new(gap.len() / 2),
            gap,
            crossings: Vec::new(),
            misses: Vec::new(),
        }
    }

    fn find(&mut self) {
        self.finder.sample(black_box(self.gap));
        self.crossings.clear();
        self.finder.crossings(0.0, &mut self.crossings);
        let size: f64 = self.gap[1..].iter().map(|x| x.abs()).sum();
        self.misses.clear();
        self.finder.near_misses(0.0, 0.05 * size, &mut self.misses);
        black_box((&self.crossings, &self.misses));
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

impl fmt::Display for Whole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let times = self.residual.iter().chain(&self.jacobian);
        let times: Vec<String> = times.map(|time| format!("{:.1}", 1e6 * time)).collect();
        f.write_str(&times.join(" | "))
    }
}

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} | {}", self.core, self.nodes)?;
        let parts = [
            self.crossings,
            self.placing,
            self.law,
            self.projection,
            self.assembly,
        ];
        for time in parts.iter().chain(&[self.jacobian, self.factorisation]) {
            write!(f, " | {:.2}", 1e6 * time)?;
        }
        for whole in [self.jacobian, self.jacobian + self.factorisation] {
            write!(f, " | {:.1} %", 100.0 * self.law / whole)?;
        }
        Ok(())
    }
}
