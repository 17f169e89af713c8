//! Verdicts at defaults of 500 orbits against their multipliers when they are refined by shooting.
//!
//!     HERTZIAN_ORBITS=500 cargo test -p hertzian-tests --test all stability -- --nocapture
//!
//! judges as many instead of [`FEW`], and prints what they came to. A branch depends on its number only.

use std::collections::BTreeMap;

use hertzian::stability::Method;
use hertzian::{Branch, Verdict};
use hertzian_tests::random::Random;

use crate::stability::draw::{Bifurcation, Case, ORBITS, choose};
use crate::stability::truth::{distance, growth, refined, refined_at, refined_beside};

/// Orbits by default.
const FEW: usize = 50;
/// Tries to find a branch for a case.
const TRIES: usize = 60;
/// Where the largest multiplier is farther than this from the unit circle, perturbed motions are simulated.
const CLEAR: f64 = 0.02;
/// The true error may be this multiple of the estimate, for all but one in twenty.
const FACTOR: f64 = 3.0;

/// What all orbits came to.
#[derive(Default)]
struct Summary {
    judged: usize,
    undecided: usize,
    /// Orbits beside a fold whose truncation moves it past their frequency: the true orbit is at another one.
    without: usize,
    simulated: usize,
    /// Orbits without an estimate.
    unknown: usize,
    /// True error over the estimate.
    ratios: Vec<f64>,
    /// The largest of those beyond [`FACTOR`], at the frequency of the corrected orbit and with the change from one frequency to the
    /// other as part of the estimate.
    left: f64,
    /// How many orbits before and behind a bifurcation were stable and unstable, by kind and period.
    beside: BTreeMap<(Bifurcation, usize), [usize; 2]>,
    faults: Vec<String>,
}

impl Summary {
    fn judge(
        &mut self,
        case: &Case,
        branch: &Branch,
        (index, kind): (usize, Option<Bifurcation>),
        random: &mut Random,
    ) {
        let point = &branch.points[index];
        self.judged += 1;
        let stability = &point.stability;
        let decided = stability.verdict != Verdict::Undecided;
        let system = case.system.as_ref();
        let place = format!("{} at omega {:.9}: {stability:?}", case.name, point.value);
        self.undecided += usize::from(!decided);
        let Some(cycle) = refined(system, point) else {
            self.without += 1;
            println!("no orbit at this frequency: {place}");
            let mut folds = branch.folds();
            let fold = folds.find(|fold| (fold.after..=fold.after + 1).contains(&(index + 1)));
            let beside = fold.and_then(|fold| refined_beside(system, point, fold));
            if decided && beside.is_none_or(|cycle| cycle.stability.verdict != stability.verdict) {
                self.faults
                    .push(format!("decided, but there is no such orbit: {place}"));
            }
            return;
        };
        let exact = &cycle.stability.multipliers;
        let largest = exact[0].norm();
        let place = format!("{place}, exactly {exact:?}");
        if let Some(kind) = kind {
            let sides = self.beside.entry((kind, case.period)).or_default();
            sides[usize::from(largest > 1.0)] += 1;
        }
        let error = distance(&stability.multipliers, exact);
        let ratio = error / (stability.error + cycle.stability.error);
        if stability.error.is_finite() {
            self.ratios.push(ratio);
        } else {
            self.unknown += 1;
        }
        if ratio > FACTOR {
            // The corrected orbit is a little farther along the axis, which counts beside a fold.
            let answer = branch.multipliers(point, Method::Default).unwrap();
            let left = refined_at(system, point, answer.value).map_or(ratio, |there| {
                let (given, there) = (answer.stability, there.stability);
                let moved = distance(&there.multipliers, exact);
                let error = distance(&given.multipliers, &there.multipliers);
                error / (given.error + there.error + moved)
            });
            println!("ratio {ratio:.2}, where the corrected orbit is {left:.2}: {place}");
            self.left = self.left.max(left);
        }
        let wrong = match stability.verdict {
            Verdict::Stable => largest > 1.0,
            Verdict::Unstable => largest < 1.0,
            Verdict::Undecided => {
                println!("undecided: {place}");
                (largest - 1.0).abs() > stability.error
            }
        };
        if wrong {
            self.faults.push(format!("wrong: {place}"));
        }
        if (largest - 1.0).abs() > CLEAR {
            self.simulated += 1;
            match growth(system, &cycle, random) {
                Ok(growth) if (growth > 1.0) == (largest > 1.0) => {}
                other => self.faults.push(format!(
                    "a perturbed motion goes elsewhere: {other:?}, {place}"
                )),
            }
        }
    }

    /// Part of the orbits with an error of at most this multiple of the estimate.
    fn within(&self, factor: f64) -> f64 {
        let within = self.ratios.iter().filter(|ratio| **ratio <= factor).count();
        within as f64 / self.ratios.len() as f64
    }

    fn print(&mut self) {
        let Self {
            judged,
            undecided,
            without,
            unknown,
            simulated,
            ..
        } = self;
        println!(
            "{judged} orbits, {undecided} undecided, {unknown} without an estimate, {without} without a true orbit, \
             {simulated} simulated"
        );
        for factor in [0.1, 0.3, 1.0, FACTOR, 10.0] {
            println!(
                "{:5.1} % within {factor} of the estimate",
                100.0 * self.within(factor)
            );
        }
        for ((kind, period), [stable, unstable]) in &self.beside {
            println!("beside {kind:?} of period {period}: {stable} stable, {unstable} unstable");
        }
        for fault in &self.faults {
            println!("{fault}");
        }
    }
}

fn number(name: &str) -> Option<usize> {
    let text = std::env::var(name).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

#[test]
fn verdicts_of_random_orbits_are_true() {
    let orbits = number("HERTZIAN_ORBITS").unwrap_or(FEW);
    let mut summary = Summary::default();
    for index in 0..orbits.div_ceil(ORBITS) {
        let random = &mut Random::of(index as u64);
        for _ in 0..TRIES {
            let case = Case::draw(random);
            if let Some(branch) = case.branch() {
                for chosen in choose(&branch, random) {
                    summary.judge(&case, &branch, chosen, random);
                }
                break;
            }
        }
    }
    summary.print();
    assert!(summary.faults.is_empty(), "{}", summary.faults[0]);
    assert!(summary.judged >= orbits);
    assert!(summary.within(FACTOR) >= 0.95);
    assert!(summary.left < FACTOR, "{}", summary.left);
    assert!(summary.undecided * 50 < summary.judged);
    // Of few orbits not every period has bifurcations.
    let periods: &[usize] = if orbits < 500 { &[] } else { &[1, 2, 3] };
    for kind in [Bifurcation::Fold, Bifurcation::PeriodDoubling] {
        let of_kind = |of: &(Bifurcation, usize)| of.0 == kind;
        assert!(summary.beside.keys().any(of_kind), "{kind:?}");
        for &period in periods {
            let sides = summary.beside[&(kind, period)];
            assert!(sides.iter().all(|&count| count > 0), "{kind:?} {period}");
        }
    }
}
