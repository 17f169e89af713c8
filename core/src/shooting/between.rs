//! What lies between two orbits of a branch that their signs do not show.
//!
//! A test function that has one sign at both ends of a step may have passed zero twice: where the parabola through the last three
//! orbits comes near zero inside the step, its extremum is looked at, and so on from there. And where a branch turns and the
//! bordered determinant changes its sign, that is one place, where it meets another branch, or two, a fold and a crossing: orbits
//! on both sides of the turn tell.
//!
//! Source of the parabola: Brent (1973), Algorithms for Minimization without Derivatives, chapter 5.

use super::equations::Equations;
use super::run::Run;
use super::tested::{Change, Test, Tests};
use crate::continuation::follow::CurvePoint;
use crate::continuation::locate::{inside, locate};
use crate::continuation::newton::Newton;

/// A function that comes nearer to zero than this part of what it is at both ends is looked at.
const NEAR: f64 = 0.5;
/// So many orbits, and until they come this near to each other, as a part of the step.
const LOOKS: usize = 6;
const CLOSE: f64 = 1e-3;
/// Half of the widths about a turn that are looked at, as parts of the step.
const BESIDE: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// A zero is in the middle of a width if the values at both ends differ by less than this part.
const MIDDLE: f64 = 0.2;

/// An orbit of the branch with its test functions.
#[derive(Clone)]
pub(super) struct Seen {
    pub(super) point: CurvePoint,
    pub(super) tests: Tests,
}

/// The end of the step before: how far back, and its test functions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Earlier {
    pub(super) distance: f64,
    pub(super) tests: Tests,
}

impl Run<'_> {
    /// A step divided so that no test function changes its sign twice in a part, as far as can be seen.
    pub(super) fn parts(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        [a, b]: [Seen; 2],
    ) -> Vec<Seen> {
        let half = equations.span.half;
        let mut parts = vec![a, b];
        if let Some(earlier) = self.earlier {
            for test in [Test::Bordered, Test::Plus, Test::Pairs] {
                let ends = [&parts[0], &parts[parts.len() - 1]];
                if let Some(found) = self.dip(equations, newton, (ends, earlier), test) {
                    let along = |seen: &Seen| distance(newton, &parts[0].point, &seen.point);
                    let place = along(&found);
                    let behind = parts.iter().position(|part| along(part) > place);
                    parts.insert(behind.unwrap_or(parts.len() - 1), found);
                }
            }
        }
        let mut index = 0;
        while index + 1 < parts.len() {
            let (a, b) = (&parts[index], &parts[index + 1]);
            let both = Tests::changes(a.tests, b.tests, half, 0.0).contains(&Change::TURNED);
            let apart = if both {
                self.beside_turn(equations, newton, [a, b])
            } else {
                None
            };
            if let Some(beside) = apart {
                parts.splice(index + 1..=index, beside);
                index += 2;
            }
            index += 1;
        }
        parts
    }

    /// An orbit inside a step where a test function has the other sign than at both ends.
    fn dip(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        ([a, b], earlier): ([&Seen; 2], Earlier),
        test: Test,
    ) -> Option<Seen> {
        let (first, last) = (a.tests.value(test), b.tests.value(test));
        let least = first.abs().min(last.abs());
        let vanishing = self.setting.vanishing(equations.frame.ratio);
        if first * last <= 0.0 || least <= vanishing {
            return None;
        }
        let length = distance(newton, &a.point, &b.point);
        let sign = first.signum();
        let mut known = [
            (-earlier.distance, sign * earlier.tests.value(test)),
            (0.0, sign * first),
            (length, sign * last),
        ];
        let mut lowest: Option<(f64, f64)> = None;
        for _ in 0..LOOKS {
            let (place, foretold) = vertex(known)?;
            let (from, to) = match lowest {
                None => (0.0, length),
                Some(_) => (known[0].0, known[2].0),
            };
            let close = CLOSE * length;
            if place <= from + close || place >= to - close || foretold > NEAR * least {
                return None;
            }
            if lowest.is_some_and(|(at, _)| (at - place).abs() < close) {
                return None;
            }
            let point = inside(
                equations,
                newton,
                (&a.point, &b.point),
                place / length,
                self.options,
            )?;
            let seen = self::seen(equations, point)?;
            let value = sign * seen.tests.value(test);
            if value < 0.0 {
                return Some(seen);
            }
            // The lowest, with its neighbours.
            let mut all = match lowest {
                None => vec![known[1], (place, value), known[2]],
                Some(_) => [&known[..], &[(place, value)]].concat(),
            };
            all.sort_by(|x, y| x.0.total_cmp(&y.0));
            let at = (1..all.len() - 1).min_by(|i, j| all[*i].1.total_cmp(&all[*j].1))?;
            known = [all[at - 1], all[at], all[at + 1]];
            lowest = Some(known[1]);
        }
        None
    }

    /// Orbits before and behind the turn in a step, if nothing else vanishes there.
    fn beside_turn(
        &mut self,
        equations: &mut Equations,
        newton: &mut Newton,
        [a, b]: [&Seen; 2],
    ) -> Option<[Seen; 2]> {
        let between = (&a.point, &b.point);
        let (slope, options) = (CurvePoint::parameter_slope, self.options);
        let wanted = self.setting.vanishing(equations.frame.ratio);
        let turn = locate(equations, newton, between, options, wanted, slope)?;
        let length = distance(newton, &a.point, &b.point);
        let place = distance(newton, &a.point, &turn.point) / length;
        let mut beside = |part: f64| {
            let point = inside(equations, newton, between, part, options)?;
            seen(equations, point)
        };
        for width in BESIDE {
            let width = width.min(0.5 * place).min(0.5 * (1.0 - place));
            let found = [beside(place - width)?, beside(place + width)?];
            let [before, behind] = found.each_ref().map(|seen| seen.tests);
            let turned = before.value(Test::Slope) * behind.value(Test::Slope) < 0.0;
            let [b, c] = [before, behind].map(|tests| tests.value(Test::Bordered));
            if !turned {
                return None;
            }
            if b * c > 0.0 {
                return Some(found);
            }
            // Where a branch ends on another one, it vanishes in the middle.
            if (b + c).abs() < MIDDLE * (b - c).abs() {
                return None;
            }
        }
        None
    }
}

fn seen(equations: &mut Equations, point: CurvePoint) -> Option<Seen> {
    let map = equations.map(&point.u, &mut |_| {}).ok()?;
    let tests = Tests::of(Some(&map), point.parameter_slope());
    Some(Seen { point, tests })
}

/// How far a point is behind another one, along the tangent there.
pub(super) fn distance(newton: &Newton, a: &CurvePoint, b: &CurvePoint) -> f64 {
    let difference: Vec<f64> = b.u.iter().zip(&a.u).map(|(x, y)| x - y).collect();
    newton.norm().product(a.scale, &a.tangent, &difference)
}

/// Place and value of the lowest point of the parabola through three points; `None` if it has none.
fn vertex([(x, p), (y, q), (z, r)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (left, right) = ((q - p) / (y - x), (r - q) / (z - y));
    let bend = (right - left) / (z - x);
    // q + s (u - y) + bend (u - y)^2
    let s = left + bend * (y - x);
    let lowest = y - 0.5 * s / bend;
    let value = q - 0.25 * s * s / bend;
    (bend > 0.0 && lowest.is_finite()).then_some((lowest, value))
}
