//! The largest value of a smooth function between two places: parabolas through the three highest places, and golden sections where these do not close
//! in. Near a maximum the value is known to rounding where its place is known to half of the digits.
//!
//! Source: Brent (1973), Algorithms for Minimization without Derivatives, chapter 5.

use super::roots::Place;

/// Accuracy of the place, in parts of the way between both ends.
const LOCATED: f64 = 1e-8;
/// Two steps in turn that are as short as these parts of the way lead to the place, the second by a parabola that has told what is gained: it leaves less than the product of
/// both.
const LAST: [f64; 2] = [1e-3, 1e-6];
/// Parts of a value that are rounding.
const ROUNDED: f64 = 4.0 * f64::EPSILON;
/// Steps, more than golden sections alone would take.
const STEPS: usize = 60;
/// `(3 - sqrt 5) / 2`
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// The largest value between two places, from one between them if that is known.
pub(crate) fn largest(
    mut at: impl FnMut(f64) -> f64,
    ends: [Place; 2],
    inside: Option<Place>,
) -> f64 {
    let mut bracket = ends.map(|end| end.x);
    let width = bracket[1] - bracket[0];
    let mut best = inside.unwrap_or_else(|| {
        let x = bracket[0] + GOLDEN * width;
        Place { x, value: at(x) }
    });
    let mut others = ends;
    if others[1].value > others[0].value {
        others.reverse();
    }
    // The last steps, the later one first.
    let mut steps = [width; 2];
    for _ in 0..STEPS {
        let middle = 0.5 * (bracket[0] + bracket[1]);
        let left = (best.x - middle).abs() + 0.5 * (bracket[1] - bracket[0]);
        if left <= 2.0 * LOCATED * width {
            break;
        }
        let parabola = vertex(best, others).filter(|vertex| {
            let (by, x) = (vertex.by, best.x + vertex.by);
            by.abs() < 0.5 * steps[1].abs() && x > bracket[0] && x < bracket[1]
        });
        let by = if let Some(vertex) = parabola {
            vertex.by
        } else {
            let end = bracket[usize::from(best.x < middle)];
            steps[0] = end - best.x;
            GOLDEN * steps[0]
        };
        let least = LOCATED * width;
        let by = if by.abs() < least {
            least.copysign(if by == 0.0 { middle - best.x } else { by })
        } else {
            by
        };
        let x = best.x + by;
        if x <= bracket[0] || x >= bracket[1] {
            break;
        }
        let next = Place { x, value: at(x) };
        let told = parabola.is_some_and(|vertex| {
            let off = (next.value - best.value - vertex.gain).abs();
            off <= vertex.gain + ROUNDED * best.value.abs()
        });
        take(next, &mut best, &mut others, &mut bracket);
        steps = [by, steps[0]];
        let short = LAST.map(|part| part * width);
        if told && steps[0].abs() <= short[1] && steps[1].abs() <= short[0] {
            break;
        }
    }
    best.value.max(ends[0].value).max(ends[1].value)
}

/// The vertex of a parabola: how far it is from a place, and how much higher.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    by: f64,
    gain: f64,
}

/// That of the parabola through three places, from the first; none where it is no maximum.
fn vertex(best: Place, [second, third]: [Place; 2]) -> Option<Vertex> {
    let (a, b) = (second.x - best.x, third.x - best.x);
    let (f, g) = (best.value - second.value, best.value - third.value);
    // Slope and, with the other sign, half of the second derivative, both times this.
    let size = a * b * (a - b);
    let rise = b * b * f - a * a * g;
    let bend = b * f - a * g;
    let by = 0.5 * rise / bend;
    let is_maximum = bend * size > 0.0;
    let gain = 0.5 * rise / size * by;
    (by.is_finite() && is_maximum).then_some(Vertex { by, gain })
}

/// Takes a value into the three highest places and the ends of what the largest is in.
fn take(next: Place, best: &mut Place, others: &mut [Place; 2], bracket: &mut [f64; 2]) {
    if next.value >= best.value {
        bracket[usize::from(next.x < best.x)] = best.x;
        *others = [*best, others[0]];
        *best = next;
        return;
    }
    bracket[usize::from(next.x > best.x)] = next.x;
    if next.value >= others[0].value {
        *others = [next, others[0]];
    } else if next.value >= others[1].value {
        others[1] = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest value, and at how many places it was looked for.
    fn found(of: impl Fn(f64) -> f64, [low, high]: [f64; 2], inside: Option<f64>) -> (f64, usize) {
        let mut count = 0;
        let place = |x: f64| Place { x, value: of(x) };
        let counted = |x: f64| {
            count += 1;
            of(x)
        };
        let largest = largest(counted, [place(low), place(high)], inside.map(place));
        (largest, count)
    }

    #[test]
    fn largest_values_are_known_to_rounding() {
        let waves = |x: f64| (3.0 * x).sin() + 0.2 * (7.0 * x + 0.3).cos();
        // Of the sum, by its derivative: Newton's method from 0.6.
        let mut x = 0.6_f64;
        for _ in 0..20 {
            let slope = 3.0 * (3.0 * x).cos() - 1.4 * (7.0 * x + 0.3).sin();
            let bend = -9.0 * (3.0 * x).sin() - 9.8 * (7.0 * x + 0.3).cos();
            x -= slope / bend;
        }
        let exact = waves(x);
        for (ends, inside) in [
            ([x - 0.1, x + 0.2], None),
            ([x - 0.15, x + 0.1], Some(x + 0.03)),
        ] {
            let (largest, count) = found(waves, ends, inside);
            assert!((largest - exact).abs() < 1e-15, "{largest} {exact}");
            assert!(count <= 8, "{count}");
        }
    }

    /// A cusp, a flat top, a power and a straight line: parabolas do not close in on these.
    #[test]
    fn what_is_no_parabola_is_followed_by_golden_sections() {
        let (largest, _) = found(|x| -(x - 0.3_f64).abs(), [0.0, 1.0], None);
        assert!(largest > -1e-7, "{largest}");
        let (largest, _) = found(|x| -(x - 0.3_f64).powi(4), [0.0, 1.0], Some(0.5));
        assert!(largest > -1e-20, "{largest}");
        let (largest, _) = found(|x| -(x - 0.3_f64).abs().powf(1.5), [0.0, 1.0], None);
        assert!(largest > -1e-9, "{largest}");
        assert_eq!(found(|x| x, [0.0, 1.0], None).0, 1.0);
        assert_eq!(found(|_| 2.0, [0.0, 1.0], Some(0.2)).0, 2.0);
    }

    /// Where three places lie on a parabola that has its vertex at the middle one by chance, the largest value is elsewhere.
    #[test]
    fn a_vertex_by_chance_is_left_again() {
        let of = |x: f64| -x * x + 0.4 * (x - x * x * x);
        let exact = {
            // -2 x + 0.4 - 1.2 x^2 = 0
            let x = (-2.0 + (4.0_f64 + 4.0 * 1.2 * 0.4).sqrt()) / 2.4;
            of(x)
        };
        let (largest, _) = found(of, [-1.0, 1.0], Some(0.0));
        assert!((largest - exact).abs() < 1e-15, "{largest} {exact}");
    }
}
