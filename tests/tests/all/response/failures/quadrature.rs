//! One Gauss-Jacobi rule on a law that mixes powers.

use std::f64::consts::{PI, TAU};

use hertzian::{FrequencyResponse, Orbit};
use nalgebra::{DMatrix, SymmetricEigen};

use super::models::first;

hertzian::oscillator! {
    /// A linear spring and a contact of two spheres that lift off together.
    Mixed(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => gap + gap^1.5, else => 0 }
        ddot(x) + 2*zeta*dot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// Nodes on `[-1, 1]` and weights for `(1 - x^2)^power f(x)`, by the recurrence of Gegenbauer's polynomials: Golub and Welsch (1969).
fn gauss_jacobi(power: f64, count: usize) -> Vec<(f64, f64)> {
    let lambda = power + 0.5;
    let matrix = DMatrix::from_fn(count, count, |i, j| {
        let k = i.max(j) as f64;
        if i.abs_diff(j) != 1 {
            return 0.0;
        }
        let square = k * (k + 2.0 * lambda - 1.0) / (4.0 * (k + lambda) * (k + lambda - 1.0));
        square.sqrt()
    });
    // The integral of the weight, by the substitution x = cos t.
    let steps = 20_000;
    let sines = (0..steps).map(|i| (PI * (f64::from(i) + 0.5) / f64::from(steps)).sin());
    let total = sines.map(|sine| sine.powf(2.0 * power + 1.0)).sum::<f64>() * PI / f64::from(steps);
    let eigen = SymmetricEigen::new(matrix);
    let weight = |i| total * eigen.eigenvectors[(0, i)].powi(2);
    (0..count)
        .map(|i| (eigen.eigenvalues[i], weight(i)))
        .collect()
}

/// The one arc on which the gap is positive, by bisection.
fn arc(orbit: &Orbit) -> [f64; 2] {
    let period = TAU / orbit.base;
    let inside = |t: f64| orbit.state_at(0, t).unwrap().0 > 0.0;
    let steps = 4000;
    let time = |i: i32| period * f64::from(i) / f64::from(steps);
    let crossings: Vec<_> = (0..steps)
        .filter(|&i| inside(time(i)) != inside(time(i + 1)))
        .map(|i| {
            let (mut a, mut b) = (time(i), time(i + 1));
            let before = inside(a);
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                if inside(middle) == before {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            (b, !before)
        })
        .collect();
    let [(first, enters), (second, _)] = crossings[..] else {
        panic!("{crossings:?}");
    };
    if enters {
        [first, second]
    } else {
        [second, first + period]
    }
}

/// The mean force is the load. With a rule for the power 3/2 alone, what the linear part is integrated to falls slowly with the nodes.
#[test]
fn one_rule_for_two_powers() {
    let model = Mixed {
        zeta: 0.05,
        load: 1.0,
        drive: 1.5,
    };
    let branch = first(
        &FrequencyResponse::of(&model)
            .from(0.9)
            .to(0.91)
            .harmonics(10),
    );
    let orbit = &branch.points[0].orbit;
    let [start, end] = arc(orbit);
    let half = 0.5 * (end - start);
    let mean = |power: f64, count: usize, law: &dyn Fn(f64) -> f64| {
        let nodes = gauss_jacobi(power, count).into_iter();
        let values = nodes.map(|(node, weight)| {
            let (gap, _) = orbit.state_at(0, start + half * (1.0 + node)).unwrap();
            weight * law(gap.max(0.0)) / (1.0 - node * node).powf(power)
        });
        half * values.sum::<f64>() * orbit.base / TAU
    };
    println!("nodes, rule for 3/2, rule for 1, a rule for each");
    for count in [16, 32, 64] {
        let both = |gap: f64| gap + gap.powf(1.5);
        let error = |mean: f64| (mean / model.load - 1.0).abs();
        let [by_larger, by_smaller] = [1.5, 1.0].map(|power| error(mean(power, count, &both)));
        let each = error(mean(1.0, count, &|gap| gap) + mean(1.5, count, &|gap| gap.powf(1.5)));
        println!("{count}, {by_larger:.1e}, {by_smaller:.1e}, {each:.1e}");
        assert!(by_larger > 1e-7 && by_smaller > 1e-9);
        // The orbit was found with the one set of nodes for everything: its mean force is the load.
        assert!(each < 1e-13, "{each:e}");
    }
}
