//! The search for a [corner](super::corner): the touch, and the branch on both sides of it.

use super::grazing_search::{Approach, Reached, again};
use crate::branches::extreme::Extreme;
use crate::branches::problem::BranchProblem;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::locate::inside_over;
use crate::continuation::newton::{Border, Newton, NewtonOptions};
use crate::numeric::linear::dot;

/// The first orbit beyond, by its height, and how near to the touch it is, in units of the walk.
pub(super) const FIRST: f64 = 1e-8;
const NEAREST: f64 = 0.01;
/// The branch bends by no more than this from the touch to where the walk goes on: the cosine.
const BENDS: f64 = 0.9;
/// Coming from the side where the level is crossed, the other one is gone to from no higher.
const ACROSS: f64 = 1e-6;
/// Or from where the line in the root of the height leads, brought down on the other side by so many times the height, where no iterate crosses the level
/// again, and by this at the most.
const DEEPER: [f64; 5] = [1.0, 10.0, 1e2, 1e3, 1e4];
const DEEPEST: f64 = 0.05;
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
#[derive(Clone)]
pub(super) struct Beside {
    pub(super) point: CurvePoint,
    pub(super) extreme: Extreme,
}

/// A touch with the branch on both sides of it. All tangents point forwards.
pub(super) struct Corner {
    pub(super) touch: Reached,
    /// Where the branch comes from ends here, without touching or with hardly more than that.
    pub(super) end: CurvePoint,
    /// Where it goes on begins here.
    pub(super) begin: CurvePoint,
    /// The extreme at that of them which is beyond the level.
    pub(super) crossed: Extreme,
    /// Orbits on the way to its end, where the branch bends.
    pub(super) way: Vec<Beside>,
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
        let Beside {
            point: mut crossed,
            extreme: beyond,
        } = first;
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
            crossed: beyond,
            way: Vec::new(),
            forwards,
        };
        if extreme.begins && corner.turns() {
            return None;
        }
        if !extreme.is_clear() {
            corner.way = self.way(&corner, extreme.above)?;
        }
        let last = corner.way.last().map_or(at, |last| &last.point);
        (self.bend(last, &corner.end) > 0.0).then_some(corner)
    }

    /// The orbit that touches, from the side where the level is not crossed.
    fn touch(&mut self, forwards: f64) -> Option<Reached> {
        let mut touch = if self.approach.extreme.is_clear() {
            self.approach
                .close_in(self.problem, self.newton, self.options)?
        } else {
            self.touch_from_beyond(forwards)?
        };
        direct(&mut touch.located.point, forwards);
        Some(touch)
    }

    /// The same from where the level is crossed: down to it, and to the side where it is clear.
    fn touch_from_beyond(&mut self, forwards: f64) -> Option<Reached> {
        let Approach {
            from: at,
            extreme,
            farthest,
        } = self.approach;
        let mut last = Beside {
            point: at.clone(),
            extreme,
        };
        while last.extreme.above.abs() > ACROSS {
            let lower = WAY * last.extreme.above;
            let next = self.lower(&last, lower);
            let next = next.or_else(|| self.beside(&last.point, last.extreme, lower));
            let Some(next) = next else {
                break;
            };
            last = next;
        }
        let height = last.extreme.above.abs();
        let close_in = |search: &mut Self, from: &CurvePoint, extreme: Extreme| {
            let approach = Approach {
                from,
                extreme,
                farthest,
            };
            approach.close_in(search.problem, search.newton, search.options)
        };
        let across = self.beside(&last.point, last.extreme, forwards * height);
        let found = across.and_then(|across| close_in(self, &across.point, across.extreme));
        found.or_else(|| {
            DEEPER.into_iter().find_map(|times| {
                let depth = (times * height).min(DEEPEST);
                let from = self.straight_to_touch(&last, forwards * depth)?;
                close_in(self, &from.point, from.extreme)
            })
        })
    }

    /// Where an orbit beyond the level leads along its tangent to a part of its root of the height, in which it is smooth, (2) of
    /// [`corner`](super::corner): as `h` goes at the rate `h'` of the arc length, by `2 (1 - part) h / h'`.
    fn along_root(&mut self, from: &Beside, part: f64) -> Option<Beside> {
        let Beside { point, extreme } = from;
        let mut form = vec![0.0; point.u.len()];
        let range = point.scale.parameter;
        if !self
            .problem
            .extreme_form(&point.u, extreme, range, &mut form)
        {
            return None;
        }
        let way = 2.0 * (1.0 - part) * extreme.above / dot(&form, &point.tangent);
        // Where it hardly rises along the branch it leads anywhere.
        let leads = way.abs() <= self.approach.farthest;
        if !leads {
            return None;
        }
        let mut u = point.u.clone();
        rise(&mut u, &point.tangent, -way);
        let extreme = again(self.problem, &u, extreme)?;
        let point = CurvePoint { u, ..point.clone() };
        Some(Beside { point, extreme })
    }

    /// The solution at a lower height beyond the level.
    fn lower(&mut self, from: &Beside, height: f64) -> Option<Beside> {
        let part = (height / from.extreme.above).sqrt();
        let guess = self.along_root(from, part)?;
        self.solution(&from.point, guess.point.u, guess.extreme, height)
    }

    /// Near the touch, where an orbit beyond the level leads in the root of the height, and from there to a height on the other side.
    fn straight_to_touch(&mut self, from: &Beside, height: f64) -> Option<Beside> {
        let Beside { mut point, extreme } = self.along_root(from, 0.0)?;
        let mut form = vec![0.0; point.u.len()];
        let range = point.scale.parameter;
        let known = self
            .problem
            .extreme_form(&point.u, &extreme, range, &mut form);
        rise(
            &mut point.u,
            &form,
            (height - extreme.above) / dot(&form, &form),
        );
        let extreme = again(self.problem, &point.u, &extreme)?;
        (known && extreme.is_clear()).then_some(Beside { point, extreme })
    }

    /// Points between where the search comes from, at a height, and the end of the branch at a corner: beyond the level it bends with the root
    /// of the height. None if it turns back on the way.
    fn way(&mut self, corner: &Corner, height: f64) -> Option<Vec<Beside>> {
        let mut way: Vec<Beside> = Vec::new();
        // Heights between which the next orbit is: of the last one, or the lowest above the other at which none was found, and of one to which the branch has
        // bent too far.
        let (mut high, mut low) = (height, None);
        let mut next = WAY * height;
        while next.abs() > FIRST / WAY {
            let beside = self.at_height(corner, next);
            let last = way.last().map_or(self.approach.from, |last| &last.point);
            match (beside, low) {
                (Some(beside), _) if self.bend(last, &beside.point) > 0.0 => {
                    way.push(beside);
                    (high, low, next) = (next, None, WAY * next);
                    continue;
                }
                (None, None) => {
                    next *= WAY;
                    continue;
                }
                (Some(_), _) => low = Some(next),
                (None, Some(_)) => high = next,
            }
            let part = low.map_or(1.0, |low| low / high);
            if part > CLOSEST {
                return None;
            }
            next = high * part.sqrt();
        }
        Some(way)
    }

    /// The cosine of the angle between tangents.
    pub(super) fn bend(&self, a: &CurvePoint, b: &CurvePoint) -> f64 {
        let norm = self.newton.norm();
        norm.product(a.scale, &a.tangent, &b.tangent) / norm.length(a.scale, &b.tangent)
    }

    /// An orbit of the branch some way behind a corner.
    pub(super) fn behind(&mut self, corner: &Corner) -> Option<Beside> {
        let from = &corner.touch.located.point;
        let apart = self.distance(from, &corner.begin);
        HEIGHTS.into_iter().find_map(|height| {
            let beside = self.at_height(corner, corner.forwards * height)?;
            let point = &beside.point;
            let distance = self.distance(from, point);
            let [a, b] = self.range;
            let within = (point.parameter() - a) * (point.parameter() - b) < 0.0;
            let near = distance <= FAR && apart <= NEARER * distance;
            (within && near && self.bend(&corner.begin, point) > BENDS).then_some(beside)
        })
    }

    /// The orbit beside a corner whose extreme has a height. Its tangent points forwards.
    pub(super) fn at_height(&mut self, corner: &Corner, height: f64) -> Option<Beside> {
        let touch = &corner.touch;
        let mut beside = self.beside(&touch.located.point, touch.extreme, height)?;
        direct(&mut beside.point, corner.forwards);
        Some(beside)
    }

    /// An orbit at a part of the way between two others. Its tangent points along that way.
    pub(super) fn between(&mut self, ends: [&Beside; 2], part: f64) -> Option<Beside> {
        let step = Step {
            before: &ends[0].point,
            next: &ends[1].point,
        };
        let equations = self.problem.equations();
        let point = inside_over(equations, self.newton, step, part, self.options)?;
        let extreme = again(self.problem, &point.u, &ends[0].extreme)?;
        Some(Beside { point, extreme })
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

#[cfg(test)]
mod tests;
