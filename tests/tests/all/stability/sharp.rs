//! Verdicts of laws that change on a scale far below that of the orbit, against an integration that shares nothing with the library.
//!
//!     HERTZIAN_SHARP=1 cargo test -p hertzian-tests --release --test all stability::sharp -- --nocapture
//!
//! judges every law at nine scales from 1 to 1e-4 of the orbit and at six frequencies instead of a few.

use std::f64::consts::TAU;

use hertzian::{Complex, ContactEquation, Error, FrequencyResponse, Point, System, Verdict};
use hertzian_tests::dormand_prince::step;

use crate::stability::truth::distance;

hertzian::oscillator! {
    TanhOfGap(x) {
        param width > 0;
        ddot(x) + 0.02*dot(x) + x + 0.5*tanh(x/width) = cos(omega*t);
    }
}

hertzian::oscillator! {
    TanhOfRate(x) {
        param width > 0;
        ddot(x) + 0.3*tanh(dot(x)/width) + x = cos(omega*t);
    }
}

hertzian::oscillator! {
    Galloping(x) {
        param width > 0;
        ddot(x) + 0.06*dot(x) + x + 0.5*x^3 - 0.1*tanh(dot(x)/width) = cos(omega*t);
    }
}

hertzian::oscillator! {
    ExponentialBump(x) {
        param width > 0;
        ddot(x) + 0.05*dot(x) + x + 0.3*exp(-((x - 0.2)/width)^2) = cos(omega*t);
    }
}

hertzian::oscillator! {
    RationalBump(x) {
        param width > 0;
        ddot(x) + 0.05*dot(x) + x + 0.3/(1 + ((x - 0.2)/width)^2) = cos(omega*t);
    }
}

hertzian::oscillator! {
    SteepBump(x) {
        param width > 0;
        ddot(x) + 0.0005*dot(x) + x + 3/(1 + ((x - 0.37)/width)^8) = cos(omega*t);
    }
}

hertzian::oscillator! {
    Logistic(x) {
        param width > 0;
        ddot(x) + 0.05*dot(x) + x + 0.1/(1 + exp(-dot(x)/width)) = cos(omega*t);
    }
}

hertzian::oscillator! {
    QuadraticDrag(x) {
        param width > 0;
        ddot(x) + 0.05*dot(x) + width*|dot(x)|*dot(x) + x + 0.2*x^3 = cos(omega*t);
    }
}

hertzian::oscillator! {
    HuntCrossley(x) {
        param width > 0;
        law contact(gap) { gap > 0 => max(0, gap^1.5*(1 + dot(gap)/width)), else => 0 }
        ddot(x) + 0.05*dot(x) + 0.2*x + contact(x) = cos(omega*t) + 0.5;
    }
}

hertzian::oscillator! {
    Adhesive(x) {
        param width > 0;
        law contact(gap) { gap > 0 => gap^1.5 + 0.2*gap*tanh(dot(gap)/width), else => 0 }
        ddot(x) + 0.05*dot(x) + 0.2*x + contact(x) = cos(omega*t) + 0.5;
    }
}

hertzian::oscillator! {
    Rounded(x) {
        param width > 0;
        ddot(x) + 0.05*dot(x) + 0.3*x + 0.5*(x^2 + width^2)^0.5 = cos(omega*t) + 0.3;
    }
}

/// A law by hand, to be added to `x'' = cos omega t - ..`: the force, its derivatives by position and rate, and an operand in which
/// it changes on the scale of one, with its derivatives.
type ByHand = fn(f64, f64, f64) -> [f64; 6];

/// Everything of a sweep: its name, the system at a width, and the same by hand.
type Kind = (&'static str, fn(f64) -> Box<dyn System>, ByHand);

fn sech2(u: f64) -> f64 {
    1.0 - u.tanh().powi(2)
}

const KINDS: [Kind; 11] = [
    (
        "steep bump",
        |width| Box::new(SteepBump { width }),
        |x, v, w| {
            let u = (x - 0.37) / w;
            let bump = 1.0 + u.powi(8);
            [
                0.0005 * v + x + 3.0 / bump,
                1.0 - 24.0 * u.powi(7) / (w * bump * bump),
                0.0005,
                u,
                1.0 / w,
                0.0,
            ]
        },
    ),
    (
        "logistic",
        |width| Box::new(Logistic { width }),
        |x, v, w| {
            // 1/(1 + exp(-u)) = (1 + tanh(u/2))/2, which has no overflow.
            let u = v / w;
            let force = 0.05 * v + x + 0.05 * (1.0 + (0.5 * u).tanh());
            [
                force,
                1.0,
                0.05 + 0.025 * sech2(0.5 * u) / w,
                u,
                0.0,
                1.0 / w,
            ]
        },
    ),
    (
        "tanh of gap",
        |width| Box::new(TanhOfGap { width }),
        |x, v, w| {
            let u = x / w;
            let slope = 0.5 * sech2(u) / w;
            [
                0.02 * v + x + 0.5 * u.tanh(),
                1.0 + slope,
                0.02,
                u,
                1.0 / w,
                0.0,
            ]
        },
    ),
    (
        "tanh of rate",
        |width| Box::new(TanhOfRate { width }),
        |x, v, w| {
            let u = v / w;
            [0.3 * u.tanh() + x, 1.0, 0.3 * sech2(u) / w, u, 0.0, 1.0 / w]
        },
    ),
    (
        "galloping",
        |width| Box::new(Galloping { width }),
        |x, v, w| {
            let u = v / w;
            let force = 0.06 * v + x + 0.5 * x.powi(3) - 0.1 * u.tanh();
            let by_rate = 0.06 - 0.1 * sech2(u) / w;
            [force, 1.0 + 1.5 * x * x, by_rate, u, 0.0, 1.0 / w]
        },
    ),
    (
        "exponential bump",
        |width| Box::new(ExponentialBump { width }),
        |x, v, w| {
            let u = (x - 0.2) / w;
            let bump = 0.3 * (-u * u).exp();
            let slope = -2.0 * u / w * bump;
            [0.05 * v + x + bump, 1.0 + slope, 0.05, u, 1.0 / w, 0.0]
        },
    ),
    (
        "rational bump",
        |width| Box::new(RationalBump { width }),
        |x, v, w| {
            let u = (x - 0.2) / w;
            let bump = 0.3 / (1.0 + u * u);
            let slope = -2.0 * u / w * bump / (1.0 + u * u);
            [0.05 * v + x + bump, 1.0 + slope, 0.05, u, 1.0 / w, 0.0]
        },
    ),
    (
        "quadratic drag",
        |width| Box::new(QuadraticDrag { width }),
        |x, v, w| {
            let force = 0.05 * v + w * v.abs() * v + x + 0.2 * x.powi(3);
            // The slope bends where the rate vanishes.
            let (by_gap, by_rate) = (1.0 + 0.6 * x * x, 0.05 + 2.0 * w * v.abs());
            [force, by_gap, by_rate, 1e3 * v, 0.0, 1e3]
        },
    ),
    (
        "Hunt-Crossley that does not pull",
        |width| Box::new(HuntCrossley { width }),
        |x, v, w| {
            let (linear, power) = (0.2 * x - 0.5 + 0.05 * v, x.max(0.0).powf(1.5));
            let factor = 1.0 + v / w;
            if x <= 0.0 || factor <= 0.0 {
                return [
                    linear,
                    0.2,
                    0.05,
                    1e4 * x * factor,
                    1e4 * factor,
                    1e4 * x / w,
                ];
            }
            let by_gap = 0.2 + 1.5 * x.sqrt() * factor;
            let by_rate = 0.05 + power / w;
            let near = [1e4 * x * factor, 1e4 * factor, 1e4 * x / w];
            [
                linear + power * factor,
                by_gap,
                by_rate,
                near[0],
                near[1],
                near[2],
            ]
        },
    ),
    (
        "contact with friction",
        |width| Box::new(Adhesive { width }),
        |x, v, w| {
            let linear = 0.2 * x - 0.5 + 0.05 * v;
            let u = v / w;
            if x <= 0.0 {
                return [linear, 0.2, 0.05, 1e4 * x, 1e4, 0.0];
            }
            let force = linear + x.powf(1.5) + 0.2 * x * u.tanh();
            let by_gap = 0.2 + 1.5 * x.sqrt() + 0.2 * u.tanh();
            let by_rate = 0.05 + 0.2 * x * sech2(u) / w;
            // The nearer of the two.
            if 1e4 * x < u.abs() {
                return [force, by_gap, by_rate, 1e4 * x, 1e4, 0.0];
            }
            [force, by_gap, by_rate, u, 0.0, 1.0 / w]
        },
    ),
    (
        "rounded edge",
        |width| Box::new(Rounded { width }),
        |x, v, w| {
            let root = x.hypot(w);
            let force = 0.05 * v + 0.3 * x + 0.5 * root - 0.3;
            [force, 0.3 + 0.5 * x / root, 0.05, x / w, 1.0 / w, 0.0]
        },
    ),
];

/// State, and its derivatives by the state at the beginning, column by column.
type Motion = [f64; 6];

fn slope(law: ByHand, width: f64, omega: f64, t: f64, y: &Motion) -> Motion {
    let [force, k, c, ..] = law(y[0], y[1], width);
    let [a, b] = [[y[2], y[3]], [y[4], y[5]]].map(|[x, v]| -k * x - c * v);
    [y[1], (omega * t).cos() - force, y[3], a, y[5], b]
}

const TOLERANCE: f64 = 1e-11;

/// A period: steps by their error, and so short that the operand changes by a part of what it is.
fn period(law: ByHand, width: f64, omega: f64, state: [f64; 2]) -> Motion {
    let mut y = [state[0], state[1], 1.0, 0.0, 0.0, 1.0];
    let (mut t, end) = (0.0, TAU / omega);
    let mut h = 1e-4;
    while t < end {
        let first = slope(law, width, omega, t, &y);
        let [.., u, by_x, by_v] = law(y[0], y[1], width);
        let passing = (by_x * first[0] + by_v * first[1]).abs();
        h = f64::min(h, 0.05)
            .min(0.3 * (1.0 + u.abs()) / passing)
            .min(end - t);
        let (last, apart) = step(t, (&y, first), h, |t, y| slope(law, width, omega, t, y));
        let error = (0..6).fold(0.0_f64, |most, i| {
            most.max(apart[i] / (1.0 + y[i].abs().max(last[i].abs())))
        });
        // Where a slope bends, no step is short enough for the error in relation to its width.
        if error <= TOLERANCE || h < 1e-9 {
            (t, y) = (if h >= end - t { end } else { t + h }, last);
        }
        h *= (0.9 * (TOLERANCE / error).powf(0.2)).clamp(0.2, 4.0);
    }
    y
}

/// The multipliers of the orbit near a state, closed by Newton's method; none if it does not close.
fn exact(law: ByHand, width: f64, omega: f64, mut state: [f64; 2]) -> Option<[Complex<f64>; 2]> {
    for _ in 0..12 {
        let y = period(law, width, omega, state);
        let [d, e] = [y[0] - state[0], y[1] - state[1]];
        let [a, c, b, f] = [1.0 - y[2], -y[3], -y[4], 1.0 - y[5]];
        let determinant = a * f - b * c;
        let change = [(f * d - b * e) / determinant, (a * e - c * d) / determinant];
        state = [state[0] + change[0], state[1] + change[1]];
        if change[0].abs() + change[1].abs() < 1e-10 {
            let (half, product) = (0.5 * (y[2] + y[5]), y[2] * y[5] - y[3] * y[4]);
            let root = Complex::new(half * half - product, 0.0).sqrt();
            return Some([half + root, half - root]);
        }
    }
    None
}

/// What a sweep came to.
#[derive(Default)]
struct Count {
    judged: usize,
    undecided: usize,
    without: usize,
    beyond: usize,
    faults: Vec<String>,
}

/// How an orbit is found at a frequency.
type Found = fn(&dyn System, f64) -> Result<Point, Error>;

impl Count {
    fn judge(&mut self, (name, system, law): Kind, width: f64, omega: f64, found: Found) {
        let place = format!("{name}, width {width:.1e}, omega {omega}");
        let system = system(width);
        let point = match found(system.as_ref(), omega) {
            Ok(point) => point,
            Err(error) => {
                self.without += 1;
                println!("{place}: {error}");
                return;
            }
        };
        let orbit = &point.orbit;
        let state = orbit.state();
        let Some(exact) = exact(law, width, omega, [state[0], state[1]]) else {
            self.without += 1;
            println!("{place}: no exact orbit");
            return;
        };
        self.judged += 1;
        let given = &point.stability;
        let largest = exact[0].norm().max(exact[1].norm());
        let wrong = match given.verdict {
            Verdict::Stable => largest > 1.0,
            Verdict::Unstable => largest < 1.0,
            Verdict::Undecided => {
                self.undecided += 1;
                false
            }
        };
        let error = if given.multipliers.len() == 2 {
            distance(&given.multipliers, &exact)
        } else {
            f64::NAN
        };
        // The exact ones err as well.
        let beyond = error > given.error + 1e-8;
        self.beyond += usize::from(beyond);
        println!(
            "{place}: {} by {}, {:.6} said, {largest:.6} exactly; error {error:.1e}, stated {:.1e}{}",
            given.verdict,
            orbit.harmonics(),
            given.multipliers.first().map_or(f64::NAN, |m| m.norm()),
            given.error,
            if wrong {
                " WRONG"
            } else if beyond {
                " BEYOND"
            } else {
                ""
            }
        );
        if wrong || error > 3.0 * given.error + 1e-8 {
            self.faults.push(place);
        }
    }
}

#[test]
fn sharp_laws_have_no_false_verdict() {
    let count = swept(|system, omega| FrequencyResponse::of(system).orbit(omega));
    assert!(count.undecided * 20 <= count.judged && count.beyond * 20 <= count.judged);
}

/// Where a law turns within a small part of the gaps, or of the rates, that an orbit passes.
#[test]
fn sharp_laws_have_no_false_verdict_by_the_contact_equation() {
    let count = swept(|system, omega| {
        let request = FrequencyResponse::of(system).by(ContactEquation::new());
        request.orbit(omega)
    });
    assert!(count.undecided * 20 <= count.judged && count.beyond * 20 <= count.judged);
}

/// Every law at some scales and frequencies, none of which may be judged wrongly.
fn swept(found: Found) -> Count {
    let many = std::env::var_os("HERTZIAN_SHARP").is_some();
    let (scales, omegas): (&[i32], &[f64]) = if many {
        (
            &[0, -1, -2, -3, -4, -5, -6, -7, -8],
            &[0.55, 0.8, 1.05, 1.3, 1.6, 2.1],
        )
    } else {
        (&[0, -3, -6, -8], &[1.3])
    };
    let mut count = Count::default();
    for kind in KINDS {
        for &omega in omegas {
            for &scale in scales {
                count.judge(kind, 10_f64.powf(0.5 * f64::from(scale)), omega, found);
            }
        }
    }
    println!(
        "{} judged, {} undecided, {} without an orbit, {} beyond their stated error, {} faults",
        count.judged,
        count.undecided,
        count.without,
        count.beyond,
        count.faults.len()
    );
    assert!(count.faults.is_empty(), "{:#?}", count.faults);
    assert!(count.judged >= 8 * count.without);
    count
}
