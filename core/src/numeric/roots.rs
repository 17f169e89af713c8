//! One root of a function in a bracket.
//!
//! Without derivatives, [`Bracket`]: inverse quadratic interpolation through the last three places where these lie on a function that
//! is monotone with it, and bisection elsewhere. Its order is 1.84 at a simple root; at any other it takes about three times as many
//! steps as bisection, at most.
//!
//! With derivatives, [`Guarded`]: the steps of any iteration, as Newton's or Halley's, as long as they stay in the bracket and shrink by
//! half, and bisection elsewhere.
//!
//! Sources: Chandrupatla (1997), A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without using
//! derivatives, Advances in Engineering Software 28, 145. Press et al. (2007), Numerical Recipes, section 9.4.

/// Steps, at most: more than any function needs, discontinuous ones included.
pub(crate) const STEPS: usize = 200;

/// A function at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) x: f64,
    pub(crate) value: f64,
}

/// Two places with a change of sign between them, and where to look next.
///
/// A value that is not a number counts as being on the side of the last place. Without a change of sign one of the ends is closed in to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    /// The last place.
    near: Place,
    /// The last place of the other sign.
    far: Place,
    /// Where to look next, as a part of the way from `near` to `far`.
    part: f64,
    /// Accuracy of the root. The spacing of numbers is added.
    tolerance: f64,
}

impl Bracket {
    /// Begins with linear interpolation.
    pub(crate) fn new(a: Place, b: Place, tolerance: f64) -> Self {
        let part = b.value / (b.value - a.value);
        let inside = part > 0.0 && part < 1.0;
        let mut bracket = Self {
            near: b,
            far: a,
            part: 0.5,
            tolerance,
        };
        if inside {
            bracket.aim(part);
        }
        bracket
    }

    /// Where to look next, as a part of the way from the last place to that of the other sign.
    pub(crate) fn part(&self) -> f64 {
        self.part
    }

    /// The place at a part of that way.
    pub(crate) fn at(&self, part: f64) -> f64 {
        self.near.x + part * (self.far.x - self.near.x)
    }

    /// Takes the value at a place. Returns whether the last one is now on the other side of the root.
    pub(crate) fn take(&mut self, place: Place) -> bool {
        let mut third = std::mem::replace(&mut self.near, place);
        let crosses = are_across(place.value, third.value);
        if crosses {
            std::mem::swap(&mut self.far, &mut third);
        }
        self.aim(interpolated(self.near, self.far, third).unwrap_or(0.5));
        crosses
    }

    /// Where to look next, not closer to an end than the accuracy.
    fn aim(&mut self, part: f64) {
        let least = self.least();
        self.part = if least < 0.5 {
            part.clamp(least, 1.0 - least)
        } else {
            0.5
        };
    }

    /// The accuracy as a part of the width.
    fn least(&self) -> f64 {
        let size = self.near.x.abs().max(self.far.x.abs());
        self.tolerance.max(f64::EPSILON * size) / (self.far.x - self.near.x).abs()
    }

    /// Whether the root is known as well as asked for.
    pub(crate) fn is_closed(&self) -> bool {
        self.near.value == 0.0 || self.least() >= 0.5
    }

    /// Whether the last place is nearer to zero than that of the other sign.
    pub(crate) fn near_is_best(&self) -> bool {
        self.near.value.abs() < self.far.value.abs()
    }

    /// The end where the function is on one side of zero, or zero.
    pub(crate) fn end(&self, positive: bool) -> f64 {
        let on_side = self.near.value == 0.0 || (self.near.value > 0.0) == positive;
        if on_side { self.near.x } else { self.far.x }
    }
}

/// Whether zero is between two values, or is one of them.
fn are_across(a: f64, b: f64) -> bool {
    (a <= 0.0 && b >= 0.0) || (a >= 0.0 && b <= 0.0)
}

/// Where to look next, as a part of the way from `a` to `b`, given a third place; none if the three may lie on a function that is not
/// monotone with its inverse quadratic interpolation (Chandrupatla's criterion).
fn interpolated(a: Place, b: Place, c: Place) -> Option<f64> {
    let place = (a.x - b.x) / (c.x - b.x);
    let level = (a.value - b.value) / (c.value - b.value);
    if !(level * level < place && (1.0 - level) * (1.0 - level) < 1.0 - place) {
        return None;
    }
    let part = a.value / (b.value - a.value) * c.value / (b.value - c.value)
        + (c.x - a.x) / (b.x - a.x) * a.value / (c.value - a.value) * b.value / (c.value - b.value);
    part.is_finite().then_some(part)
}

/// Closes in to the root between two places; an end that is a root itself is taken at once.
///
/// `None` if the signs do not differ, or a value is not a number.
pub(crate) fn closed(
    a: Place,
    b: Place,
    tolerance: f64,
    mut of: impl FnMut(f64) -> f64,
) -> Option<Bracket> {
    if !are_across(a.value, b.value) {
        return None;
    }
    let (from, to) = if a.value == 0.0 { (b, a) } else { (a, b) };
    let mut bracket = Bracket::new(from, to, tolerance);
    for _ in 0..STEPS {
        if bracket.is_closed() {
            break;
        }
        let x = bracket.at(bracket.part());
        let value = of(x);
        if value.is_nan() {
            return None;
        }
        bracket.take(Place { x, value });
    }
    Some(bracket)
}

/// The root between two places; `None` as [`closed`] has it.
pub(crate) fn root(a: Place, b: Place, tolerance: f64, of: impl FnMut(f64) -> f64) -> Option<f64> {
    let bracket = closed(a, b, tolerance, of)?;
    let best = if bracket.near_is_best() {
        bracket.near
    } else {
        bracket.far
    };
    Some(best.x)
}

/// Steps that stay in a bracket.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guarded {
    a: f64,
    b: f64,
    /// Length of the last step.
    last: f64,
}

impl Guarded {
    /// Between `a` and a larger `b`.
    pub(crate) fn new(a: f64, b: f64) -> Self {
        Self {
            a,
            b,
            last: f64::INFINITY,
        }
    }

    /// Takes on which side of the root a place is.
    pub(crate) fn cut(&mut self, x: f64, left: bool) {
        if left {
            self.a = x;
        } else {
            self.b = x;
        }
    }

    /// The next place from `x`, and whether it is the step and not the middle.
    pub(crate) fn next(&mut self, x: f64, step: f64) -> (f64, bool) {
        let next = x + step;
        // A step that is not a number fails all of these.
        let good = next >= self.a && next <= self.b && step.abs() <= 0.5 * self.last;
        let next = if good { next } else { 0.5 * (self.a + self.b) };
        self.last = (next - x).abs();
        (next, good)
    }

    /// Whether no more than a few numbers lie between the ends.
    pub(crate) fn is_closed(&self) -> bool {
        self.width() <= 2.0 * f64::EPSILON * self.b.abs()
    }

    pub(crate) fn width(&self) -> f64 {
        self.b - self.a
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{LN_2, PI};

    fn place(x: f64, of: impl Fn(f64) -> f64) -> Place {
        Place { x, value: of(x) }
    }

    /// The root in a bracket, and how many values it took.
    fn counted(of: impl Fn(f64) -> f64, a: f64, b: f64, tolerance: f64) -> (Option<f64>, usize) {
        let mut count = 0;
        let root = root(place(a, &of), place(b, &of), tolerance, |x| {
            count += 1;
            of(x)
        });
        (root, count)
    }

    /// A function with a bracket and the root in closed form.
    type Case = (fn(f64) -> f64, [f64; 2], f64);

    const SMOOTH: [Case; 5] = [
        (|x| x.exp() - 2.0, [0.0, 1.0], LN_2),
        (f64::sin, [3.0, 4.0], PI),
        (|x| x * x * x - 2.0, [2.0, 1.0], 1.259_921_049_894_873_2),
        (|x| 1.0 / x - 3.0, [0.1, 1.0], 1.0 / 3.0),
        (|x| (x - 1e3) * (1.0 + x), [999.0, 1001.5], 1e3),
    ];

    #[test]
    fn simple_roots_take_few_values() {
        for (of, [a, b], exact) in SMOOTH {
            let (root, count) = counted(of, a, b, 0.0);
            let root = root.unwrap();
            assert!((root - exact).abs() <= 4.0 * f64::EPSILON * exact, "{root}");
            // Bisection takes 52.
            assert!(count <= 12, "{exact}: {count}");
        }
    }

    /// Errors of the places looked at, e, e', e'': near a root the order is that of inverse quadratic interpolation through the last
    /// three, the root 1.839 of `p^3 = p^2 + p + 1` (Traub 1964, section 4.3), so `log e'' / log e` goes to its square.
    #[test]
    fn the_order_is_that_of_inverse_quadratic_interpolation() {
        let of = |x: f64| x.exp() - 2.0;
        let mut bracket = Bracket::new(place(0.69, of), place(0.70, of), 0.0);
        let mut errors = Vec::new();
        while !bracket.is_closed() && errors.len() < 3 {
            let x = bracket.at(bracket.part());
            errors.push((x - LN_2).abs());
            bracket.take(place(x, of));
        }
        // The first is linear: `e = |f''/(2 f')| a b`. What follows is quadratic through all three of them: by `a b e`.
        let [a, b] = [LN_2 - 0.69, 0.70 - LN_2];
        assert!((errors[0] / (0.5 * a * b) - 1.0).abs() < 0.01, "{errors:?}");
        // The inverse function is ln(2 + y): its third derivative over six is 1/24, and `y = 2 (x - ln 2)`.
        let expected = 8.0 / 24.0 * a * b * errors[0];
        assert!((errors[1] / expected - 1.0).abs() < 0.05, "{errors:?}");
    }

    #[test]
    fn roots_at_the_ends_are_taken_at_once() {
        let of = |x: f64| x * (x - 1.0);
        assert_eq!(counted(of, 0.0, 0.5, 0.0), (Some(0.0), 0));
        assert_eq!(counted(of, 0.5, 1.0, 0.0), (Some(1.0), 0));
        assert_eq!(counted(of, -0.0, 0.5, 0.0), (Some(0.0), 0));
    }

    #[test]
    fn without_a_change_of_sign_there_is_none() {
        assert_eq!(counted(|x| 1.0 + x * x, -1.0, 2.0, 0.0), (None, 0));
        // The product of such values is zero.
        assert_eq!(counted(|x| 1e-200 * (1.0 + x), 0.0, 1.0, 0.0), (None, 0));
        let tiny = counted(|x| 1e-300 * (x.exp() - 2.0), 0.0, 1.0, 0.0).0;
        assert!((tiny.unwrap() - LN_2).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_number_gives_none() {
        assert_eq!(counted(|_| f64::NAN, 0.0, 1.0, 0.0), (None, 0));
        let hole = |x: f64| if x.abs() < 0.9 { f64::NAN } else { x };
        assert_eq!(counted(hole, -1.0, 1.0, 0.0), (None, 1));
        let infinite = |x: f64| if x < 0.3 { -f64::INFINITY } else { x };
        let (root, count) = counted(infinite, 0.0, 1.0, 0.0);
        assert!((root.unwrap() - 0.3).abs() < 1e-15 && count < 60);
    }

    #[test]
    fn jumps_and_multiple_roots_take_no_longer_than_three_bisections() {
        let jump = |x: f64| if x < PI { -1.0 } else { 1e9 };
        let (root, count) = counted(jump, 0.0, 10.0, 0.0);
        assert!(
            (root.unwrap() - PI).abs() < 1e-15 && count <= 3 * 53,
            "{count}"
        );
        for power in [3, 5, 9, 21] {
            let (root, count) = counted(|x: f64| (x - 0.3).powi(power), -1.0, 1.0, 1e-12);
            assert!((root.unwrap() - 0.3).abs() < 1e-12, "{power}");
            assert!(count <= 3 * 41, "{power}: {count}");
        }
    }

    #[test]
    fn the_bracket_ends_where_the_sign_was_asked_for() {
        for (of, [a, b], exact) in SMOOTH {
            for within in [1e-3, 1e-8] {
                let bracket = closed(place(a, of), place(b, of), within, of).unwrap();
                let [low, high] = [false, true].map(|positive| bracket.end(positive));
                assert!(of(low) <= 0.0 && of(high) >= 0.0);
                assert!(
                    (low - exact).abs() <= 2.0 * within && (high - exact).abs() <= 2.0 * within
                );
            }
        }
    }

    /// Newton's error is `f''/(2 f')` times the square of the last, Halley's of third order.
    #[test]
    fn guarded_steps_keep_the_order_of_the_iteration() {
        let newton = |x: f64| -(x.exp() - 2.0) / x.exp();
        let halley = |x: f64| newton(x) / (1.0 + 0.5 * newton(x));
        let after = |step: &dyn Fn(f64) -> f64| {
            let (x, good) = Guarded::new(0.0, 1.0).next(0.7, step(0.7));
            assert!(good);
            (x - LN_2).abs()
        };
        let error = 0.7 - LN_2;
        assert!((after(&newton) / (0.5 * error.powi(2)) - 1.0).abs() < 0.01);
        assert!((after(&halley) / (error.powi(3) / 12.0) - 1.0).abs() < 0.02);
    }

    #[test]
    fn steps_that_leave_the_bracket_or_do_not_shrink_are_halvings() {
        let mut bracket = Guarded::new(0.0, 1.0);
        assert_eq!(bracket.next(0.25, 1.0), (0.5, false));
        bracket.cut(0.5, true);
        assert_eq!(bracket.next(0.5, f64::NAN), (0.75, false));
        bracket.cut(0.75, false);
        assert_eq!(bracket.next(0.75, -0.2), (0.625, false));
        assert_eq!(bracket.next(0.625, -0.0625), (0.5625, true));
        assert_eq!(bracket.width(), 0.25);
    }

    /// Newton's method runs away from the root of an arctangent, from `x > 1.39`.
    #[test]
    fn guarded_steps_converge_where_the_iteration_does_not() {
        let mut bracket = Guarded::new(-20.0, 31.0);
        let (mut x, mut count) = (31.0_f64, 0);
        while x.abs() > 1e-15 {
            bracket.cut(x, x < 0.0);
            (x, _) = bracket.next(x, -x.atan() * (1.0 + x * x));
            count += 1;
            assert!(count < 20);
        }
    }
}
