//! The search for a [corner](super::corner): the touch, and the branch on both sides of it.

use super::grazing_search::{Approach, Reached, again};
use crate::branches::extreme::Extreme;
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::numeric::linear::dot;

/// The first orbit beyond, by its height, and how near to the touch it is, in units of the walk.
const FIRST: f64 = 1e-8;
const NEAREST: f64 = 0.01;
/// The branch bends by no more than this from the touch to where the walk goes on: the cosine.
const BENDS: f64 = 0.9;
/// Coming from the side where the level is crossed, the other one is gone to from no higher.
const ACROSS: f64 = 1e-6;
/// Each of the points on the way to a corner is so much nearer to the level than the one before.
const WAY: f64 = 0.1;
/// Or by less, where the branch bends by more than a right angle between two of them: up to this.
const CLOSEST: f64 = 0.7;
/// Where the walk goes on, by its height: the first of them that is not farther away than this, in units of the walk.
const HEIGHTS: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
const FAR: f64 = 0.03;
/// An orbit whose height is so much smaller is at least so much nearer: else the height is not what leads there.
const NEARER: f64 = 0.7;
/// Steps towards an orbit with the matrix of another one, each at the height wanted, to this part of it, and orbits on the way there.
const GUESSES: usize = 4;
const LIFTS: usize = 5;
const LIFTED: f64 = 0.1;
const ORBITS: usize = 6;
/// A height is met if it is right to this factor.
const MET: f64 = 3.0;

/// A solution whose extreme has a height.
struct Beside {
    point: CurvePoint,
    extreme: Extreme,
}

/// A touch with the branch on both sides of it. All tangents point forwards.
pub(super) struct Corner {
    pub(super) touch: Reached,
    /// Where the branch comes from ends here, without touching or with hardly more than that.
    pub(super) end: CurvePoint,
    /// Where it goes on begins here.
    pub(super) begin: CurvePoint,
    /// Points on the way to its end, where the branch bends.
    pub(super) way: Vec<CurvePoint>,
    /// One if extremes rise forwards, or minus one.
    forwards: f64,
}

impl Corner {
    /// Whether the branch turns back in what it varies.
    pub(super) fn turns(&self) -> bool {
        self.end.parameter_slope() * self.begin.parameter_slope() < 0.0
    }
}

/// The search for a corner that an extreme approaches.
pub(super) struct CornerSearch<'s> {
    pub(super) problem: &'s mut dyn BranchProblem,
    pub(super) newton: &'s mut Newton,
    pub(super) options: NewtonOptions,
    pub(super) range: [f64; 2],
    pub(super) approach: Approach<'s>,
}

impl CornerSearch<'_> {
    /// The corner, if the branch leads to it and goes on behind it.
    pub(super) fn corner(&mut self) -> Option<Corner> {
        let Approach {
            from: at,
            extreme,
            farthest,
        } = self.approach;
        let forwards = -extreme.above.signum();
        let touch = self.touch(forwards)?;
        let other = if extreme.is_clear() {
            forwards
        } else {
            -forwards
        };
        let first = self.beside(&touch.located.point, touch.extreme, other * FIRST)?;
        let mut crossed = first.point;
        direct(&mut crossed, forwards);
        let apart = self.distance(&touch.located.point, &crossed);
        let clear = touch.located.point.clone();
        let (end, begin) = if extreme.is_clear() {
            (clear, crossed)
        } else {
            (crossed, clear)
        };
        if self.distance(at, &end) > farthest || apart > NEAREST {
            return None;
        }
        let mut corner = Corner {
            touch,
            end,
            begin,
            way: Vec::new(),
            forwards,
        };
        if extreme.begins && corner.turns() {
            return None;
        }
        if !extreme.is_clear() {
            corner.way = self.way(&corner, extreme.above)?;
        }
        let last = corner.way.last().unwrap_or(at);
        (self.bend(last, &corner.end) > 0.0).then_some(corner)
    }

    /// The orbit that touches, from the side where the level is not crossed.
    fn touch(&mut self, forwards: f64) -> Option<Reached> {
        let Approach {
            from: at,
            extreme,
            farthest,
        } = self.approach;
        let mut touch = if extreme.is_clear() {
            self.approach
                .close_in(self.problem, self.newton, self.options)?
        } else {
            // Down to the level, to the side where it is clear, and back.
            let mut last = Beside {
                point: at.clone(),
                extreme,
            };
            while last.extreme.above.abs() > ACROSS {
                let lower = WAY * last.extreme.above;
                last = self.beside(&last.point, last.extreme, lower)?;
            }
            let height = last.extreme.above.abs();
            let across = self.beside(&last.point, last.extreme, forwards * height)?;
            let approach = Approach {
                from: &across.point,
                extreme: across.extreme,
                farthest,
            };
            approach.close_in(self.problem, self.newton, self.options)?
        };
        direct(&mut touch.located.point, forwards);
        Some(touch)
    }

    /// Points between where the search comes from, at a height, and the end of the branch at a corner: beyond the level it bends with the root
    /// of the height. None if it turns back on the way.
    fn way(&mut self, corner: &Corner, height: f64) -> Option<Vec<CurvePoint>> {
        let touch = &corner.touch;
        let mut way: Vec<CurvePoint> = Vec::new();
        let (mut from, mut next) = (height, WAY * height);
        while next.abs() > FIRST / WAY {
            let Some(Beside { mut point, .. }) =
                self.beside(&touch.located.point, touch.extreme, next)
            else {
                next *= WAY;
                continue;
            };
            direct(&mut point, corner.forwards);
            let last = way.last().unwrap_or(self.approach.from);
            if self.bend(last, &point) > 0.0 {
                way.push(point);
                (from, next) = (next, WAY * next);
            } else if next / from < CLOSEST {
                next = from * (next / from).sqrt();
            } else {
                return None;
            }
        }
        Some(way)
    }

    /// The cosine of the angle between tangents.
    fn bend(&self, a: &CurvePoint, b: &CurvePoint) -> f64 {
        let norm = self.newton.norm();
        norm.product(a.scale, &a.tangent, &b.tangent) / norm.length(a.scale, &b.tangent)
    }

    /// A point of the branch some way behind a corner.
    pub(super) fn behind(&mut self, corner: &Corner) -> Option<CurvePoint> {
        let (touch, forwards) = (&corner.touch, corner.forwards);
        let from = &touch.located.point;
        let apart = self.distance(from, &corner.begin);
        HEIGHTS.into_iter().find_map(|height| {
            let beside = self.beside(from, touch.extreme, forwards * height)?;
            let mut point = beside.point;
            direct(&mut point, forwards);
            let distance = self.distance(from, &point);
            let [a, b] = self.range;
            let within = (point.parameter() - a) * (point.parameter() - b) < 0.0;
            let near = distance <= FAR && apart <= NEARER * distance;
            (within && near && self.bend(&corner.begin, &point) > BENDS).then_some(point)
        })
    }

    /// How far apart two points are.
    pub(super) fn distance(&self, a: &CurvePoint, b: &CurvePoint) -> f64 {
        let step = Step { before: a, next: b };
        self.newton.norm().length(a.scale, &step.difference())
    }

    /// The solution near a point whose extreme has a height.
    fn beside(&mut self, from: &CurvePoint, extreme: Extreme, height: f64) -> Option<Beside> {
        let Some(u) = self.problem.lifted(&from.u, &extreme, height) else {
            return self.beside_by_steps(from, extreme, height);
        };
        let lifted = Extreme {
            above: height,
            ..extreme
        };
        self.solution(from, u, lifted, height)
    }

    /// The same along the tangent, where no unknown tells the height.
    fn beside_by_steps(
        &mut self,
        from: &CurvePoint,
        mut extreme: Extreme,
        height: f64,
    ) -> Option<Beside> {
        let n = from.u.len() - 1;
        let mut u = from.u.clone();
        let mut form = vec![0.0; n + 1];
        let mut tangent = vec![0.0; n + 1];
        let mut residual = vec![0.0; n + 1];
        self.solve(&mut u, &extreme, 0.0, &mut form)?;
        self.newton
            .tangent(self.problem.equations(), &u, &mut tangent, true);
        for _ in 0..GUESSES {
            extreme = self.lift(&mut u, &tangent, extreme, height)?;
            let equations = self.problem.equations();
            self.newton
                .size_of_residual(equations, &u, &mut residual[..n]);
            residual[n] = 0.0;
            self.newton.solve(&mut residual);
            rise(&mut u, &residual, -1.0);
            extreme = again(self.problem, &u, &extreme)?;
        }
        extreme = self.lift(&mut u, &tangent, extreme, height)?;
        self.solution(from, u, extreme, height)
    }

    /// Solves the equations until an extreme has about a height.
    fn solution(
        &mut self,
        from: &CurvePoint,
        mut u: Vec<f64>,
        mut extreme: Extreme,
        height: f64,
    ) -> Option<Beside> {
        let scale = from.scale;
        let mut form = vec![0.0; u.len()];
        let mut tangent = vec![0.0; u.len()];
        for _ in 0..ORBITS {
            let rise = height - extreme.above;
            self.solve(&mut u, &extreme, rise, &mut form)?;
            extreme = again(self.problem, &u, &extreme)?;
            let part = extreme.above / height;
            if part > MET.recip() && part < MET {
                let equations = self.problem.equations();
                if !self.newton.tangent(equations, &u, &mut tangent, true) {
                    return None;
                }
                let length = self.newton.norm().length(scale, &tangent);
                for t in &mut tangent {
                    *t /= length;
                }
                let point = CurvePoint { u, tangent, scale };
                return Some(Beside { point, extreme });
            }
        }
        None
    }

    /// Moves unknowns along a tangent, on which the extreme rises as fast as the way is long, until it has a height. On the other side
    /// of the level the force is another one, and so is how fast it rises.
    fn lift(
        &mut self,
        u: &mut [f64],
        tangent: &[f64],
        mut extreme: Extreme,
        height: f64,
    ) -> Option<Extreme> {
        let mut form = vec![0.0; u.len()];
        let scale = self.approach.from.scale;
        let mut rate = 1.0;
        for _ in 0..LIFTS {
            rise(u, tangent, (height - extreme.above) / rate);
            extreme = again(self.problem, u, &extreme)?;
            if (extreme.above - height).abs() <= LIFTED * height.abs() {
                break;
            }
            let known = self
                .problem
                .extreme_form(u, &extreme, scale.parameter, &mut form);
            rate = Some(dot(&form, tangent)).filter(|rate| known && *rate > 0.0)?;
        }
        Some(extreme)
    }

    /// Solves the equations with the extreme higher by some height than it is.
    fn solve(&mut self, u: &mut [f64], extreme: &Extreme, by: f64, form: &mut [f64]) -> Option<()> {
        let scale = self.approach.from.scale;
        let known = self.problem.extreme_form(u, extreme, scale.parameter, form);
        let border = Border {
            row: form,
            value: dot(form, u) + by,
        };
        let equations = self.problem.equations();
        let solved = self
            .newton
            .correct(equations, u, border, scale, self.options);
        (known && solved.is_ok()).then_some(())
    }
}

/// Moves unknowns along a direction.
fn rise(u: &mut [f64], direction: &[f64], by: f64) {
    for (x, d) in u.iter_mut().zip(direction) {
        *x += by * d;
    }
}

/// Turns a tangent along which the extreme rises forwards.
fn direct(point: &mut CurvePoint, forwards: f64) {
    for t in &mut point.tangent {
        *t *= forwards;
    }
}
