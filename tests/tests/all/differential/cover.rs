//! Ranges of random models with several stable orbits: whatever motions settle to lies on a branch that one request returns.
//!
//!     HERTZIAN_COVER=200 cargo test --release -p hertzian-tests --test all one_request -- --nocapture
//!
//! draws until so many models have a range with two stable orbits at one value; without it one model alone is looked at, [`MODEL`] or
//! `HERTZIAN_MODEL=17`.
//! Motions begin at random states, and values are random too; what they settle to is confirmed by an integrator that shares no code
//! with the library. Models whose motions take many evaluations of the forces for each period are passed over.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use hertzian::attractors::basin::Fate;
use hertzian::bifurcation::{Bifurcations, Diagram, Settling};
use hertzian::generic::Declaration;
use hertzian::time;
use hertzian::time::stroboscope::Stroboscope;
use hertzian::{FrequencyResponse, HarmonicBalance, Point, Shooting, Stop};
use hertzian_tests::random::Random;

use crate::differential::draw;
use crate::differential::environment;
use crate::differential::model::{COORDINATES, Model, State};
use crate::differential::truth::Question;

/// The model by default: one of the quicker ones.
const MODEL: u64 = 16;
/// Values, and initial states at each.
const VALUES: usize = 5;
const STARTS: usize = 64;
/// The longest period of an orbit that is looked for.
const LONGEST: usize = 4;
/// Evaluations of the forces in a period, at most, and the periods over which they are counted.
const EVALUATIONS: usize = 600;
const COUNTED: usize = 20;
/// Periods in which a motion has to settle.
const PATIENCE: usize = 600;
/// A motion that returns so near for so many periods has settled; near an orbit that is known less will do.
const SETTLED: f64 = 1e-7;
const NEAR: f64 = 1e-4;
const STILL: usize = 12;
/// States of an orbit at the beginnings of its periods are farther apart.
const APART: f64 = 1e-5;
/// States of one orbit differ by less, relative to the sizes.
const SAME: f64 = 1e-3;
/// Orbits of all branches of a request.
const POINTS: usize = 6000;

/// An orbit that motions settle to.
struct Settled {
    value: f64,
    /// At the beginnings of its periods.
    states: Vec<Vec<f64>>,
    motions: usize,
}

/// Motions of a model at one value.
struct Motions {
    map: Stroboscope,
    units: Vec<f64>,
    value: f64,
    found: Vec<Settled>,
}

impl Motions {
    fn of(model: &Model, system: &Declaration, value: f64) -> Option<Self> {
        let flow = time::of(system, value, 1e-8).ok()?;
        let mut units = vec![model.size; 2 * model.coordinates];
        for unit in &mut units[model.coordinates..] {
            *unit *= value;
        }
        Some(Self {
            map: Stroboscope::new(flow),
            units,
            value,
            found: Vec::new(),
        })
    }

    fn apart(&self, a: &[f64], b: &[f64]) -> f64 {
        let entries = a.iter().zip(b).zip(&self.units);
        entries.fold(0.0, |most: f64, ((x, y), unit)| {
            most.max((x - y).abs() / unit)
        })
    }

    fn known(&self, state: &[f64], within: f64) -> Option<usize> {
        self.found.iter().position(|settled| {
            let mut states = settled.states.iter();
            states.any(|other| self.apart(other, state) < within)
        })
    }

    /// Follows a motion until it has settled, if it does.
    fn follow(&mut self, mut state: Vec<f64>) {
        let mut past: Vec<Vec<f64>> = Vec::new();
        let mut still = [0; LONGEST + 1];
        let mut near = 0;
        for _ in 0..PATIENCE {
            let mut next = state.clone();
            if self.map.map(&mut next).is_err() {
                return;
            }
            past.insert(0, std::mem::replace(&mut state, next));
            past.truncate(LONGEST);
            let known = self.known(&state, NEAR);
            near = if known.is_some() { near + 1 } else { 0 };
            if let Some(known) = known.filter(|_| near > STILL) {
                self.found[known].motions += 1;
                return;
            }
            for period in 1..=past.len() {
                let returns = self.apart(&state, &past[period - 1]) < SETTLED;
                still[period] = if returns { still[period] + 1 } else { 0 };
            }
            // What turns slowly while it decays comes nearer to itself after three periods than after one.
            let shortest = |period: &usize| {
                let mut before = past[..period - 1].iter();
                before.all(|other| self.apart(&state, other) > APART)
            };
            let returned = (1..=past.len()).find(|&period| still[period] > STILL);
            if let Some(period) = returned.filter(shortest) {
                if let Some(known) = self.known(&state, SAME) {
                    self.found[known].motions += 1;
                } else {
                    let states = std::iter::once(state).chain(past).take(period);
                    let (value, motions) = (self.value, 1);
                    let states = states.collect();
                    self.found.push(Settled {
                        value,
                        states,
                        motions,
                    });
                }
                return;
            }
        }
    }
}

/// What motions from random states settle to at random values of the range of a model.
fn settled(index: u64, model: &Model, system: &Declaration) -> Vec<Vec<Settled>> {
    let mut random = Random::of(!index ^ 0xC0FE);
    let [from, to] = model.range;
    let mut all = Vec::new();
    for part in 0..VALUES {
        let part = (part as f64 + random.between(0.02, 0.98)) / VALUES as f64;
        let Some(mut motions) = Motions::of(model, system, from + part * (to - from)) else {
            continue;
        };
        for _ in 0..STARTS {
            let units = motions.units.iter();
            let start = units.map(|unit| random.between(-2.0, 2.0) * unit).collect();
            motions.follow(start);
        }
        all.push(motions.found);
    }
    all
}

/// Whether the other integrator comes back to the state after the period.
fn is_true(model: &Model, orbit: &Settled) -> bool {
    let question = Question::of(model, orbit.value, orbit.states.len(), model.size);
    let mut state = State::default();
    let (positions, velocities) = orbit.states[0].split_at(model.coordinates);
    state[..positions.len()].copy_from_slice(positions);
    state[COORDINATES..][..velocities.len()].copy_from_slice(velocities);
    question.after(&state, 1.0).is_ok_and(|after| {
        let size = |i: usize| {
            let unit = if i < COORDINATES { 1.0 } else { orbit.value };
            unit * model.size
        };
        (0..after.len()).all(|i| (after[i] - state[i]).abs() < 1e-4 * size(i))
    })
}

/// Whether a branch passes an orbit.
fn holds(system: &Declaration, diagram: &Diagram, orbit: &Settled, units: &[f64]) -> bool {
    let period = orbit.states.len();
    let is_it = |point: &Point| {
        let state = point.orbit.state();
        orbit.states.iter().any(|other| {
            let mut entries = state.iter().zip(other).zip(units);
            entries.all(|((x, y), unit)| (x - y).abs() < SAME * unit)
        })
    };
    // A series resolves velocities less well than states do.
    let resolved = |point: &Point| {
        let request = FrequencyResponse::of(system).by(Shooting::new());
        let request = request.period(period).near_orbit(&point.orbit);
        request.orbit(orbit.value).is_ok_and(|point| is_it(&point))
    };
    let branches = diagram.branches.iter();
    let mut branches = branches.filter(|branch| branch.period() == period);
    branches.any(|branch| {
        if let Ok(at) = branch.branch.at(orbit.value) {
            return at.iter().any(|point| is_it(point) || resolved(point));
        }
        // An orbit between two neighbours of another one that was not found.
        let off = |point: &Point| point.value - orbit.value;
        let pairs = branch.branch.points.windows(2);
        let mut passing = pairs.filter(|pair| off(&pair[0]) * off(&pair[1]) <= 0.0);
        passing.any(|pair| pair.iter().any(resolved))
    })
}

/// What a model comes to: whether its range has two stable orbits at a value, how many orbits there are, and the missing ones.
#[derive(Default)]
struct Covered {
    several: bool,
    orbits: usize,
    unconfirmed: usize,
    missing: String,
    seconds: f64,
    statement: String,
}

fn covered(index: u64) -> Covered {
    let model = draw::model(index, [1.0; 2]);
    let mut covered = Covered::default();
    let Ok(system) = model.declared() else {
        return covered;
    };
    if model.is_free() || !is_quick(&system, &model) || !turns(&system, &model) {
        return covered;
    }
    let settled = settled(index, &model, &system);
    covered.several = settled.iter().any(|at| at.len() > 1);
    if !covered.several {
        return covered;
    }
    let [from, to] = model.range;
    let started = Instant::now();
    let request = Bifurcations::of(&system)
        .from(from)
        .to(to)
        .depth(3)
        .max_period(LONGEST)
        .tolerance(1e-4);
    let settling = Settling::new().values(20).starts(12).patience(PATIENCE);
    let request = request.max_points(POINTS).cover(settling);
    let diagram = if index.is_multiple_of(2) {
        request.by(HarmonicBalance::new()).run()
    } else {
        request.run()
    };
    covered.seconds = started.elapsed().as_secs_f64();
    let diagram = diagram.unwrap_or_default();
    covered.statement = statement(&diagram);
    for orbit in settled.iter().flatten() {
        if !is_true(&model, orbit) {
            covered.unconfirmed += 1;
            continue;
        }
        covered.orbits += 1;
        let mut units = vec![model.size; 2 * model.coordinates];
        for unit in &mut units[model.coordinates..] {
            *unit *= orbit.value;
        }
        if !holds(&system, &diagram, orbit, &units) {
            let _ = writeln!(
                covered.missing,
                "HERTZIAN_MODEL={index}: period {} at {:?}, {:?}, of {} motions, is on no branch",
                orbit.states.len(),
                orbit.value,
                orbit.states[0],
                orbit.motions,
            );
        }
    }
    covered
}

/// Whether a motion from rest takes few evaluations of the forces.
fn is_quick(system: &Declaration, model: &Model) -> bool {
    let Ok(mut flow) = time::of(system, model.range[0], 1e-8) else {
        return false;
    };
    let mut state = vec![0.0; 2 * model.coordinates];
    let moves = (0..COUNTED).all(|_| {
        let moved = flow.advance(0.0, TAU, &mut state, None, None);
        moved.is_ok()
    });
    moves && flow.work().forces < COUNTED * EVALUATIONS
}

/// Whether a branch turns, which tells of several stable orbits.
fn turns(system: &Declaration, model: &Model) -> bool {
    let [from, to] = model.range;
    let request = FrequencyResponse::of(system).from(from).to(to);
    let request = request.stability(false).max_points(200).tolerance(1e-3);
    request
        .run()
        .is_ok_and(|branch| branch.folds().next().is_some() || branch.stopped != Stop::ReachedEnd)
}

/// Branches, and what was searched.
fn statement(diagram: &Diagram) -> String {
    let mut text = String::new();
    for (number, branch) in diagram.branches.iter().enumerate() {
        let points = &branch.branch.points;
        let ends = [points.first(), points.last()].map(|p| p.map_or(f64::NAN, |p| p.value));
        let _ = writeln!(
            text,
            "  {number}: {:.2} s, {:?}, period {}, {} points from {:?} to {:?}, {:?}, {}",
            branch.branch.elapsed.as_secs_f64(),
            branch.origin,
            branch.period(),
            points.len(),
            ends[0],
            ends[1],
            branch.branch.begin.map(|stop| stop.to_string()),
            branch.branch.stopped
        );
    }
    for searched in &diagram.searched {
        let _ = write!(text, "  at {:?}:", searched.value);
        for (number, orbit) in searched.orbits.iter().enumerate() {
            let motions = searched.count(Fate::Periodic(number));
            let _ = write!(
                text,
                " {motions} to period {} on {:?},",
                orbit.period, orbit.branch
            );
        }
        let others = [
            Fate::Chaotic,
            Fate::Long,
            Fate::Escaped,
            Fate::Failed,
            Fate::Unknown,
        ];
        let _ = writeln!(
            text,
            " others {:?}",
            others.map(|fate| searched.count(fate))
        );
    }
    for (value, reason) in &diagram.missed {
        let _ = writeln!(text, "  missed at {value:?}: {reason}");
    }
    for omitted in &diagram.omitted {
        let _ = writeln!(text, "  omitted {omitted}");
    }
    text
}

#[test]
fn one_request_covers_a_range() {
    let one = environment("HERTZIAN_MODEL");
    let Some(wanted) = environment("HERTZIAN_COVER").filter(|_| one.is_none()) else {
        let covered = covered(one.unwrap_or(MODEL));
        println!(
            "{}\n{}{}",
            covered.seconds, covered.statement, covered.missing
        );
        assert!(covered.missing.is_empty(), "{}", covered.missing);
        assert!(one.is_some() || covered.orbits > VALUES);
        return;
    };
    let next = AtomicU64::new(environment("HERTZIAN_FIRST").unwrap_or(0));
    let found = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, |count| count.get().min(8));
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while (found.lock().unwrap().len() as u64) < wanted {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let covered = covered(index);
                    if !covered.several {
                        continue;
                    }
                    if !covered.missing.is_empty() {
                        eprint!("{}{}", covered.missing, covered.statement);
                    }
                    if covered.seconds > 20.0 {
                        eprintln!("HERTZIAN_MODEL={index}: {:.1} s", covered.seconds);
                    }
                    let mut found = found.lock().unwrap();
                    found.push(covered);
                    if found.len().is_multiple_of(10) {
                        eprintln!("{} ranges of {index} models", found.len());
                    }
                }
            });
        }
    });
    let found = found.into_inner().unwrap();
    let sum = |of: fn(&Covered) -> usize| found.iter().map(of).sum::<usize>();
    let orbits = sum(|covered| covered.orbits);
    let missing: String = found.iter().map(|covered| &covered.missing[..]).collect();
    let missed = found.iter().filter(|covered| !covered.missing.is_empty());
    println!(
        "{} ranges of {} models, {orbits} orbits, {} not confirmed by the other integrator; {} ranges with one that is missing; {:.1} s of requests",
        found.len(),
        next.load(Ordering::Relaxed),
        sum(|covered| covered.unconfirmed),
        missed.count(),
        found.iter().map(|covered| covered.seconds).sum::<f64>(),
    );
    assert!(missing.is_empty(), "{missing}");
    assert!(orbits > found.len());
}
