//! Random oscillators and the orbits taken of each.
//!
//! The load is one: units of length and time make it so. The exponent is 0.6, 1, 1.5, 2 or 3, or as often anything between 0.6 and
//! 3; the damping ratio from 1e-3 to 0.2 and the drive from 0.05 to 3, every order of magnitude as probable; contact on one side
//! or on both; the period one, two or three. Of a branch that starts between a half and twice the natural frequency
//! five orbits are taken: the neighbours of up to two bifurcations, and others anywhere.

use hertzian::{Branch, FrequencyResponse, Point, System, Verdict};
use hertzian_tests::random::Random;

hertzian::oscillator! {
    /// A contact that opens, with damping that ends with it.
    OneSided(x) {
        param zeta >= 0;
        param alpha > 0;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    /// The same with a linear spring: its motions have closed forms.
    OneSidedLinear(x) {
        param zeta >= 0;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + 1;
    }
}

hertzian::oscillator! {
    /// A spring on both sides.
    Continuous(x) {
        param zeta >= 0;
        param alpha > 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + sgn(x)*|x|^alpha = drive*cos(omega*t) + 1;
    }
}

/// Orbits of one branch.
pub const ORBITS: usize = 5;
/// Points of one branch at most.
const POINTS: usize = 150;

/// An oscillator, and where its branch runs.
pub struct Case {
    pub system: Box<dyn System>,
    pub name: String,
    pub period: usize,
    range: [f64; 2],
}

impl Case {
    pub fn draw(random: &mut Random) -> Self {
        let alpha = match random.below(10) {
            0 => 0.6,
            1 => 1.0,
            2 => 1.5,
            3 => 2.0,
            4 => 3.0,
            _ => random.between(0.6, 3.0),
        };
        let zeta = random.magnitude(1e-3, 0.2);
        let drive = random.magnitude(0.05, 3.0);
        let one_sided = random.below(2) == 0;
        let period = 1 + random.below(3);
        let natural = alpha.sqrt();
        let from = natural * random.magnitude(0.5, 2.0);
        let to = if random.below(2) == 0 {
            0.5 * from
        } else {
            2.0 * from
        };
        let system: Box<dyn System> = match (one_sided, alpha) {
            (false, _) => Box::new(Continuous { zeta, alpha, drive }),
            (true, 1.0) => Box::new(OneSidedLinear { zeta, drive }),
            (true, _) => Box::new(OneSided { zeta, alpha, drive }),
        };
        let sides = if one_sided { "one-sided" } else { "continuous" };
        let name =
            format!("{sides} alpha {alpha:.4}, zeta {zeta:.5}, drive {drive:.4}, period {period}");
        Self {
            system,
            name,
            period,
            range: [from, to],
        }
    }

    /// Its branch at defaults; none if there is no orbit of that period to be found.
    pub fn branch(&self) -> Option<Branch> {
        let [from, to] = self.range;
        let request = FrequencyResponse::of(self.system.as_ref())
            .from(from)
            .to(to)
            .period(self.period)
            .max_points(POINTS);
        request.run().ok().filter(|branch| branch.points.len() > 9)
    }
}

/// What lies between two neighbours of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bifurcation {
    Fold,
    PeriodDoubling,
}

/// Indices of the point before and of the point behind every bifurcation that the branch passes.
pub fn bifurcations(branch: &Branch) -> Vec<(usize, Bifurcation)> {
    let points = &branch.points;
    let mut found: Vec<_> = branch
        .folds()
        .filter(|fold| fold.after > 0 && fold.after < points.len())
        .map(|fold| (fold.after - 1, Bifurcation::Fold))
        .collect();
    let outside = |point: &Point| {
        let largest = point.stability.multipliers.first()?;
        let decided = point.stability.verdict != Verdict::Undecided;
        decided.then_some(largest.re < -1.0)
    };
    for (index, pair) in points.windows(2).enumerate() {
        if let (Some(before), Some(behind)) = (outside(&pair[0]), outside(&pair[1]))
            && before != behind
        {
            found.push((index, Bifurcation::PeriodDoubling));
        }
    }
    found
}

/// The orbits taken of a branch, by index: up to two bifurcations with both neighbours, and others anywhere.
pub fn choose(branch: &Branch, random: &mut Random) -> Vec<(usize, Option<Bifurcation>)> {
    let mut passed = bifurcations(branch);
    let mut chosen: Vec<(usize, Option<Bifurcation>)> = Vec::new();
    while chosen.len() + 2 <= ORBITS && !passed.is_empty() {
        let (index, kind) = passed.swap_remove(random.below(passed.len()));
        if chosen.iter().all(|&(taken, _)| taken.abs_diff(index) > 1) {
            chosen.extend([(index, Some(kind)), (index + 1, Some(kind))]);
        }
    }
    while chosen.len() < ORBITS {
        let index = random.below(branch.points.len());
        if chosen.iter().all(|&(taken, _)| taken != index) {
            chosen.push((index, None));
        }
    }
    chosen
}
