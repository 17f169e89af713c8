//! The largest value of a signal between samples, and whether its rate has a zero between two of them.
//!
//! Between two samples that are `h` apart in time, with values `x`, `y` and rates `v`, `w`, the rate of the cubic through all of these is, with `r = y - x` at
//! the part `s` of the way,
//!
//! ```text
//! h p'(s) = a s^2 + b s + h v,    a = 3 h (v + w) - 6 r,    b = 6 r - 4 h v - 2 h w                            (1)
//! ```
//!
//! It tells of what turns by less than an eighth of a period between them. The rest, modes that are faster, has values, rates and bends of at most `A`, `B`
//! and `C`, the bounds of [`content`](super::content), and is in both samples, too. So what is not faster has another rate than the motion by at most `B`, and what
//! the cubic says is wrong by that of the samples,
//!
//! ```text
//! |x' - p'| <= 2 B + 3 A / h,    |x'' - p''| <= C + 6 B / h + 12 A / h^2,    |x - p| <= 2 A + h B / 2           (2)
//! ```
//!
//! and by what it is wrong by of slow signals, at most `h^4 / 384 max |x''''|` of a value. Where the cubic's rate stays farther from zero than (2), there
//! is no extreme, and where the rate changes its sign and the cubic's bend does not come as near to zero, there is one. Elsewhere the way is halved, until nothing is
//! too fast. So a mode that does not ring costs nothing, and one that does is followed where the rate of all others is as small as its own.
//!
//! The largest value is looked for in the ways in which it may be by (2), from that with the highest bound on; all others are left (Land and Doig).
//! Of a block of ways it is known what its samples and rates are at most, so that most blocks are left at once. Where an interval has
//! [layers](super::layers), samples and bounds are those of each of them.
//!
//! Source: de Boor (2001), A Practical Guide to Splines, chapter IV (cubic Hermite interpolation and its error); Land and Doig (1960), An automatic method of
//! solving discrete programming problems, Econometrica 28 (bounds).

use super::content::Fast;
use super::pieces::{Part, Piece, TOGETHER, Way};
use super::signal::{Look, Signal};
use crate::numeric::roots::Place;

/// Accuracy of the phase of an extreme, in parts of the distance of two samples.
const LOCATED: f64 = 1e-9;
/// Steps to an extreme, more than any takes; and after how many what it is in must be half as wide.
const STEPS: usize = 120;
const AGAIN: usize = 4;
/// A cubic may be wrong by this part of the range of a coordinate where forces are known at nodes.
const FORETOLD: f64 = 0.02;
/// Parts of what is largest that are rounding.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The cubic between two samples, `h` apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cubic {
    pub(super) h: f64,
    v: f64,
    w: f64,
    /// Those of (1), divided by `h`.
    a: f64,
    b: f64,
    x: f64,
    y: f64,
}

impl Cubic {
    pub(super) fn of(before: &Look, next: &Look, base: f64) -> Self {
        let h = (next.x - before.x) / base;
        let (v, w) = (before.rate, next.rate);
        let r = (next.value - before.value) / h;
        Self {
            h,
            v,
            w,
            a: 3.0 * (v + w) - 6.0 * r,
            b: 6.0 * r - 4.0 * v - 2.0 * w,
            x: before.value,
            y: next.value,
        }
    }

    /// Where its bend is zero.
    pub(super) fn inflection(&self) -> f64 {
        -self.b / (2.0 * self.a)
    }

    /// Its rate there.
    pub(super) fn rate_there(&self) -> f64 {
        self.v + 0.5 * self.b * self.inflection()
    }

    /// How near its rate comes to zero from the side that it is on at both ends; negative where it is beyond.
    fn nearest_rate(&self) -> f64 {
        let sign = if self.v > 0.0 || self.w > 0.0 {
            1.0
        } else {
            -1.0
        };
        let ends = (sign * self.v).min(sign * self.w);
        let s = self.inflection();
        if s > 0.0 && s < 1.0 {
            ends.min(sign * self.rate_there())
        } else {
            ends
        }
    }

    /// How near its bend comes to zero; zero where it changes its sign.
    fn nearest_bend(&self) -> f64 {
        let (first, last) = (self.b / self.h, (2.0 * self.a + self.b) / self.h);
        if (first > 0.0) == (last > 0.0) {
            first.abs().min(last.abs())
        } else {
            0.0
        }
    }

    /// The part of the way where its rate is zero; in the middle where there is no such.
    fn turn(&self) -> f64 {
        let root = (self.b * self.b - 4.0 * self.a * self.v).max(0.0).sqrt();
        let q = -0.5 * (self.b + root.copysign(self.b));
        let found = [self.v / q, q / self.a];
        let found = found.into_iter().find(|s| (0.0..=1.0).contains(s));
        found.unwrap_or(0.5)
    }

    fn at(&self, s: f64) -> f64 {
        let t = 1.0 - s;
        let slopes = self.h * (s * t * t * self.v - s * s * t * self.w);
        (1.0 + 2.0 * s) * t * t * self.x + s * s * (3.0 - 2.0 * s) * self.y + slopes
    }

    /// Whether (2) says that the motion has no extreme between the samples.
    pub(super) fn goes_on(&self, fast: Fast) -> bool {
        let wrong = 2.0 * fast.rate + 3.0 * fast.value / self.h;
        (self.v > 0.0) == (self.w > 0.0) && self.nearest_rate() > wrong
    }

    /// Whether it says that it has no more than one.
    pub(super) fn turns_once(&self, fast: Fast) -> bool {
        let wrong = fast.bend + (6.0 * fast.rate + 12.0 * fast.value / self.h) / self.h;
        self.nearest_bend() > wrong
    }
}

/// The extreme between two samples whose rates have different signs: cubics through the last two places, or through the ends of what it is in.
pub(super) fn extreme(signal: &mut Signal<'_, '_>, ends: [Look; 2], base: f64) -> Look {
    let [mut low, mut high] = ends;
    let near = LOCATED * (high.x - low.x).abs();
    let rising = low.rate > 0.0;
    let mut last: Option<Look> = None;
    let mut here = if low.rate.abs() < high.rate.abs() {
        low
    } else {
        high
    };
    let mut known = f64::INFINITY;
    for place in 0..STEPS {
        if here.rate == 0.0 {
            return here;
        }
        let inside = |x: f64| x > low.x && x < high.x;
        let beside = last.and_then(|last| beyond(&last, &here, base));
        let wide = high.x - low.x;
        let middle = low.x + 0.5 * wide;
        let mut next = match beside.filter(|x| inside(*x)) {
            Some(x) => x,
            None => low.x + Cubic::of(&low, &high, base).turn() * wide,
        };
        let near_by = (next - here.x).abs() <= near;
        // Cubics that do not close in give way to halving.
        let slow = place % AGAIN == AGAIN - 1 && wide > 0.5 * std::mem::replace(&mut known, wide);
        if !near_by && (slow || !inside(next)) {
            next = middle;
        }
        let step = next - here.x;
        if step.abs() <= near || !inside(next) {
            // So near the rate is a straight line.
            here.value += 0.5 * here.rate * step / base;
            here.x = next.clamp(low.x, high.x);
            return here;
        }
        let found = signal.at(next);
        if (found.rate > 0.0) == rising {
            low = found;
        } else {
            high = found;
        }
        last = Some(here);
        here = found;
    }
    here
}

/// Where the cubic through two places has an extreme near the second.
fn beyond(last: &Look, here: &Look, base: f64) -> Option<f64> {
    let cubic = Cubic::of(last, here, base);
    // Its rate from the second on, backwards.
    let (a, slope) = (cubic.a, -(2.0 * cubic.a + cubic.b));
    let root = (slope * slope - 4.0 * a * cubic.w).max(0.0).sqrt();
    let q = -0.5 * (slope + root.copysign(slope));
    let back = cubic.w / q;
    let x = here.x - back * (here.x - last.x);
    x.is_finite().then_some(x)
}

/// What a value may be above the cubic, without what rings too fast.
#[derive(Debug, Clone, Copy)]
struct Slack {
    of: f64,
    /// What rings too fast.
    fast: Fast,
}

/// The largest value of a signal that is given part by part, with a sign.
pub(super) struct Largest<'s, 'm, 'e> {
    pub(super) parts: &'s mut [Part<'m, 'e>],
    pub(super) base: f64,
    pub(super) sign: f64,
    /// Largest less smallest sample.
    pub(super) range: f64,
    pub(super) best: Place,
}

impl Largest<'_, '_, '_> {
    /// Looks for it in all ways between samples.
    pub(super) fn search(&mut self) -> Place {
        let mut bounds: Vec<(f64, Way)> = Vec::new();
        for part in 0..self.parts.len() {
            for piece in 0..self.parts[part].pieces.len() {
                self.add_ways(part, piece, &mut bounds);
            }
        }
        bounds.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        for (bound, way) in bounds {
            if self.may_exceed(bound) {
                let wide = way.ends[1].x - way.ends[0].x;
                self.look(way, wide);
            }
        }
        self.best
    }

    /// Ways of a piece in which it may be, with the bounds there. Most are far from it: of a cubic no more is asked than how far it may be above its ends.
    fn add_ways(&self, part: usize, piece: usize, bounds: &mut Vec<(f64, Way)>) {
        let Piece { samples, most, .. } = &self.parts[part].pieces[piece];
        let ways = samples.phases.windows(2).map(|ends| ends[1] - ends[0]);
        let wide = ways.fold(0.0, f64::max);
        let slack = self.slack(part, piece, wide);
        let none = slack.fast.is_none();
        let wrong = 2.0 * slack.fast.value + 0.5 * wide / self.base * slack.fast.rate;
        let least = self.sign * self.best.value - slack.of - wrong;
        let (steep, sign) = (wide / self.base, self.sign);
        let ways = samples.phases.len() - 1;
        let far = most.iter().enumerate();
        let far = far.filter(|(_, most)| most.highest(sign) + most.rate * steep > least);
        let ways = far.flat_map(|(block, _)| {
            let first = block * TOGETHER;
            first..(first + TOGETHER).min(ways)
        });
        for index in ways {
            let [values, rates] = [&samples.values, &samples.rates].map(|of| &of[index..index + 2]);
            let top = sign * rates[0] > 0.0 && sign * rates[1] <= 0.0;
            if !top && none {
                continue;
            }
            let rise = if top {
                rates[0].abs().max(rates[1].abs()) * steep
            } else {
                0.0
            };
            if (sign * values[0]).max(sign * values[1]) + rise <= least {
                continue;
            }
            let ends = [samples.look(index), samples.look(index + 1)];
            let way = Way { part, piece, ends };
            let bound = self.bound(&way, ends[1].x - ends[0].x);
            if self.may_exceed(bound) {
                bounds.push((bound, way));
            }
        }
    }

    /// What a value may be above the cubic in all ways of a piece that are no wider.
    fn slack(&self, part: usize, piece: usize, wide: f64) -> Slack {
        let of = &self.parts[part];
        let (ripples, h) = (of.ripples(piece), wide / self.base);
        let fast = of.fast(piece, h);
        let forced = if of.signal.is_forced() {
            FORETOLD * self.range
        } else {
            0.0
        };
        // What is not fast for a narrower way is in the fourth derivative there.
        let slow = ripples.fourth(0.0) * h.powi(4) / 384.0;
        let slow = slow.min(ripples.fourth(h) * h.powi(4) / 384.0 + fast.value);
        Slack {
            of: slow + forced,
            fast,
        }
    }

    fn may_exceed(&self, bound: f64) -> bool {
        bound - self.sign * self.best.value > ROUNDED * self.best.value.abs()
    }

    fn see(&mut self, look: &Look) {
        if self.sign * (look.value - self.best.value) > 0.0 {
            self.best = Place {
                x: look.x,
                value: look.value,
            };
        }
    }

    /// Samples between which (1) says of a largest value.
    fn has_top(&self, [before, next]: &[Look; 2]) -> bool {
        self.sign * before.rate > 0.0 && self.sign * next.rate <= 0.0
    }

    /// What it is at most in a way, part of one that was so wide; less than anything where it is none.
    fn bound(&self, way: &Way, wide: f64) -> f64 {
        let [before, next] = way.ends;
        let cubic = Cubic::of(&before, &next, self.base);
        let part = &self.parts[way.part];
        let fast = part.fast_in(way, cubic.h);
        let top = self.has_top(&way.ends);
        if !top && fast.is_none() {
            return f64::NEG_INFINITY;
        }
        let ends = (self.sign * before.value).max(self.sign * next.value);
        let highest = if top {
            ends.max(self.sign * cubic.at(cubic.turn()))
        } else {
            ends
        };
        let slow = part.ripples(way.piece).fourth(cubic.h) * cubic.h.powi(4) / 384.0;
        let forced = if part.signal.is_forced() {
            let part = (next.x - before.x) / wide;
            FORETOLD * self.range * part.powi(4)
        } else {
            0.0
        };
        highest + slow + forced + 2.0 * fast.value + 0.5 * cubic.h * fast.rate
    }

    fn look(&mut self, way: Way, wide: f64) {
        let cubic = Cubic::of(&way.ends[0], &way.ends[1], self.base);
        let fast = self.parts[way.part].fast_in(&way, cubic.h);
        if fast.is_none() || cubic.turns_once(fast) {
            if !self.has_top(&way.ends) {
                return;
            }
            let found = extreme(&mut self.parts[way.part].signal, way.ends, self.base);
            self.see(&found);
            return;
        }
        let signal = &mut self.parts[way.part].signal;
        let middle = signal.at_shared(0.5 * (way.ends[0].x + way.ends[1].x));
        self.see(&middle);
        let halves = [[way.ends[0], middle], [middle, way.ends[1]]];
        let halves = halves.map(|ends| Way { ends, ..way });
        let mut bounds = halves.map(|half| (self.bound(&half, wide), half));
        if bounds[1].0 > bounds[0].0 {
            bounds.reverse();
        }
        for (bound, half) in bounds {
            if self.may_exceed(bound) {
                self.look(half, wide);
            }
        }
    }
}
