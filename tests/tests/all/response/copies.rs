//! Contacts that take each other's place after a part of the period: orbits come back after that part.

use std::f64::consts::PI;

use hertzian::{EventKind, FrequencyResponse, HarmonicBalance, Point, Shooting};

hertzian::oscillator! {
    /// Two springs on opposite sides of a shaft, both always pressed: `k (x cos + 9) cos` twice is `k (1 + cos 2 omega t) x`.
    pub Pressed(x) {
        law spring(gap) { gap > 0 => 0.4*gap, else => 0 }
        ddot(x) + 0.05*dot(x) + x + for j in 0..2 {
            let angle = omega*t + pi*j;
            cos(angle)*spring(x*cos(angle) + 9)
        } = 1;
    }
}

hertzian::oscillator! {
    /// Stops at equal angles, which the shaft meets now and then.
    pub Stops(x) {
        param skew = 0;
        law stop(gap) { gap > 0 => gap^1.5, else => 0 }
        ddot(x) + 0.1*dot(x) + x + for j in 0..3 {
            let angle = omega*t + 2*pi*j/3;
            cos(angle)*stop(x*cos(angle) - 0.3)
        } + skew*stop(x*cos(omega*t) - 0.3) = 1;
    }
}

/// Half the trace of the monodromy matrix of `x'' + 0.05 x' + (1.4 + 0.4 cos 2 omega t) x = 0` over half a period, and its
/// determinant: Runge and Kutta's method of order four, 4000 steps.
fn passage(omega: f64) -> (f64, f64) {
    let f = |t: f64, [x, v]: [f64; 2]| [v, -0.05 * v - (1.4 + 0.4 * (2.0 * omega * t).cos()) * x];
    let steps = 4000;
    let h = PI / omega / f64::from(steps);
    let column = |mut y: [f64; 2]| {
        for step in 0..steps {
            let t = h * f64::from(step);
            let along = |k: [f64; 2], by: f64| [y[0] + by * k[0], y[1] + by * k[1]];
            let a = f(t, y);
            let b = f(t + 0.5 * h, along(a, 0.5 * h));
            let c = f(t + 0.5 * h, along(b, 0.5 * h));
            let d = f(t + h, along(c, h));
            for i in 0..2 {
                y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        y
    };
    let (a, b) = (column([1.0, 0.0]), column([0.0, 1.0]));
    (0.5 * (a[0] + b[1]), a[0] * b[1] - a[1] * b[0])
}

/// Where a multiplier of half a period is minus one, between two frequencies: `1 + trace + determinant` is zero.
fn doubling(mut from: f64, mut to: f64) -> f64 {
    let test = |omega: f64| {
        let (half, determinant) = passage(omega);
        1.0 + 2.0 * half + determinant
    };
    let below = test(from) < 0.0;
    for _ in 0..50 {
        let middle = 0.5 * (from + to);
        if (test(middle) < 0.0) == below {
            from = middle;
        } else {
            to = middle;
        }
    }
    0.5 * (from + to)
}

/// The largest coefficient of harmonics that are no multiples of one.
fn others(point: &Point, stride: usize) -> f64 {
    let series = point.orbit.series(0).unwrap().iter().enumerate();
    let others = series.filter(|(index, _)| !index.div_ceil(2).is_multiple_of(stride));
    others.fold(0.0, |largest: f64, (_, x)| largest.max(x.abs()))
}

#[test]
fn two_copies_have_even_harmonics_and_double_where_the_mathieu_equation_does() {
    let model = Pressed {};
    let request = FrequencyResponse::of(&model).from(1.4).to(1.0);
    let by_balance = request.clone().bifurcations(true).run().unwrap();
    let mut all = by_balance.points.iter();
    assert!(all.all(|point| others(point, 2) == 0.0));
    let by_shooting = request.by(Shooting::new()).run().unwrap();
    let known = [doubling(1.4, 1.18), doubling(1.18, 1.0)];
    for branch in [by_balance, by_shooting] {
        let kinds = [EventKind::PeriodDoubling, EventKind::BranchPoint];
        let doubles = branch.events.iter();
        let found: Vec<_> = doubles
            .filter(|event| kinds.contains(&event.kind))
            .collect();
        assert_eq!(found.len(), 2, "{:?} {:?}", branch.events, branch.turns);
        for (found, known) in found.iter().zip(known) {
            assert_eq!(found.kind, EventKind::PeriodDoubling);
            assert_eq!((found.point.orbit.period, found.point.orbit.parts), (1, 2));
            let error = (found.point.value - known).abs();
            assert!(error < 1e-9, "{found} {known}");
        }
    }
}

#[test]
fn orbits_of_three_copies_are_those_with_all_harmonics() {
    let model = Stops { skew: 0.0 };
    let request = FrequencyResponse::of(&model)
        .from(0.9)
        .to(0.5)
        .tolerance(1e-8)
        .by(HarmonicBalance::new());
    let three = request.run().unwrap();
    let all = request.clone().symmetric(false).run().unwrap();
    assert!(three.points.iter().all(|point| others(point, 3) == 0.0));
    for omega in [0.83, 0.71, 0.55] {
        let (a, b) = (three.at(omega).unwrap(), all.at(omega).unwrap());
        assert_eq!((a.len(), b.len()), (1, 1));
        assert!(others(&b[0], 3) < 1e-9);
        let [a, b] = [&a[0], &b[0]].map(|point| (point.peak_to_peak(), point.stability.verdict));
        assert!((a.0 - b.0).abs() < 1e-7 * a.0, "{a:?} {b:?}");
        assert_eq!(a.1, b.1);
    }
}

#[test]
fn another_contact_takes_the_copies_apart() {
    let model = Stops { skew: 0.2 };
    let request = FrequencyResponse::of(&model).from(0.9).to(0.8);
    let request = request.by(HarmonicBalance::new());
    let branch = request.run().unwrap();
    assert!(branch.points.iter().all(|point| others(point, 3) > 1e-4));
}
