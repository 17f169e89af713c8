//! Displacements, rates and accelerations along directions, and what the reduction changes of each.

use std::sync::Arc;

use hertzian::structure::parameter;
use hertzian::{FrequencyResponse, Shooting};
use hertzian_structure::{
    Damping, Direction, Load, OutputKind, Reduction, SparseContact, SparseMatrix, SparseStructure,
};
use nalgebra::{Complex, DMatrix, DVector};

use crate::common::{beam, dense};

const KINDS: [(&str, OutputKind); 3] = [
    ("place", OutputKind::Displacement),
    ("speed", OutputKind::Rate),
    ("shaking", OutputKind::Acceleration),
];

/// With a unit force at a coordinate, read along a direction.
fn read(structure: SparseStructure, pushed: usize, along: &Direction) -> SparseStructure {
    let load = Load::force(Direction::at(pushed), parameter("drive", 1.0));
    let all = KINDS.into_iter();
    all.fold(structure.load(load), |structure, (name, kind)| {
        structure.output_of(name, kind, along.clone())
    })
}

/// Peak-to-peaks of the outputs, each with what is stated of its error by the reduction.
fn peaks(structure: &SparseStructure, reduction: &Reduction, omega: f64) -> Vec<[f64; 2]> {
    let reduced = reduction.run(structure).unwrap();
    let model = reduced.structure(structure).unwrap();
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let branch = request.from(omega).to(1.001 * omega).run().unwrap();
    let point = &branch.points[0];
    let errors = reduced.errors_at(structure, &branch, point).unwrap();
    let one = |(error, (name, _)): (&hertzian_structure::OutputError, _)| {
        assert_eq!(error.name, name);
        let motion = branch.reading(name, point).unwrap().motion;
        [motion.peak_to_peak(), error.error]
    };
    errors.iter().zip(KINDS).map(one).collect()
}

/// The amplitude of a mass on a spring is `F/sqrt((k - m w^2)^2 + (c w)^2)`.
#[test]
fn one_mass_has_the_amplitudes_of_its_formula() {
    let one = |x: f64| SparseMatrix::from_triplets(1, 1, [(0, 0, x)]).unwrap();
    let (mass, stiffness, ratio, omega) = (2.0, 8.0, 0.1, 1.5);
    let structure = SparseStructure::new(one(mass), one(stiffness)).damping(Damping::ratio(ratio));
    let structure = read(structure, 0, &Direction::at(0));
    let (re, im): (f64, f64) = (stiffness - mass * omega * omega, 8.0 * ratio * omega);
    let mut exact = 1.0 / re.hypot(im);
    for [peak, error] in peaks(&structure, &Reduction::to(2.0), omega) {
        assert!((peak / (2.0 * exact) - 1.0).abs() < 1e-9, "{peak} {exact}");
        assert!(error < 1e-12);
        exact *= omega;
    }
}

/// Two masses: complex amplitudes solve `(K - w^2 M + i w C) q = f`, of all coordinates at once.
#[test]
fn two_masses_along_a_direction_have_those_of_their_matrices() {
    let two = |x: [f64; 4]| {
        let places = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().zip(x);
        SparseMatrix::from_triplets(2, 2, places.map(|((i, j), x)| (i, j, x))).unwrap()
    };
    let structure = SparseStructure::new(two([2.0, 0.3, 0.3, 1.0]), two([5.0, -2.0, -2.0, 3.0]));
    let structure = structure.damping(Damping::Rayleigh {
        mass: 0.1,
        stiffness: 0.02,
    });
    let along = Direction::weighted([(0, 1.0), (1, -0.5)]);
    let structure = read(structure, 1, &along);
    for omega in [0.5, 1.3, 2.4] {
        let mut exact = whole(&structure, [0.1, 0.02], 1, &[(0, 1.0), (1, -0.5)], omega);
        for [peak, _] in peaks(&structure, &Reduction::to(2.4), omega) {
            assert!((peak / (2.0 * exact) - 1.0).abs() < 1e-9, "{peak} {exact}");
            exact *= omega;
        }
    }
}

/// The amplitude along a direction of the whole structure, by its matrices.
fn whole(
    structure: &SparseStructure,
    [by_mass, by_stiffness]: [f64; 2],
    pushed: usize,
    along: &[(usize, f64)],
    omega: f64,
) -> f64 {
    let (m, k) = (dense(structure.mass()), dense(structure.stiffness()));
    let c = by_mass * &m + by_stiffness * &k;
    let dynamic = DMatrix::from_fn(m.nrows(), m.nrows(), |i, j| {
        Complex::new(k[(i, j)] - omega * omega * m[(i, j)], omega * c[(i, j)])
    });
    let mut force = DVector::zeros(m.nrows());
    force[pushed] = Complex::new(1.0, 0.0);
    let q = dynamic.lu().solve(&force).unwrap();
    let sum: Complex<f64> = along.iter().map(|&(at, factor)| q[at] * factor).sum();
    sum.norm()
}

/// Modes alone leave so much out that the true error is seen: what is stated holds for each kind, and says something.
#[test]
fn the_error_of_every_kind_is_stated() {
    let damping = [0.0, 0.001];
    let structure = beam(30).damping(Damping::Rayleigh {
        mass: damping[0],
        stiffness: damping[1],
    });
    let structure = read(structure, 58, &Direction::at(58));
    let reduction = Reduction::to(6.0).modes(2).steps(0);
    for omega in [2.0, 4.5, 6.0] {
        let mut exact = whole(&structure, damping, 58, &[(58, 1.0)], omega);
        for [peak, stated] in peaks(&structure, &reduction, omega) {
            let error = (peak / (2.0 * exact) - 1.0).abs();
            assert!(
                error <= 1.01 * stated && stated < 20.0 * error + 1e-9,
                "{omega}: {error:e}, stated {stated:e}"
            );
            exact *= omega;
        }
    }
}

hertzian::law! {
    /// An elastic stop.
    Stop(gap, k >= 0) { gap > 0 => k*gap, else => 0 }
}

/// Two masses of which the second meets a stop, with as many vectors as coordinates: extremes of every kind are those that the method of Kutta (1901)
/// settles to on the equations as they are, `M q'' + C q' + K q + e2 k max(q2 - d, 0) = e1 F cos(w t)`.
#[test]
fn with_a_contact_every_kind_is_that_of_the_motion() {
    let two = |x: [f64; 4]| {
        let places = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().zip(x);
        SparseMatrix::from_triplets(2, 2, places.map(|((i, j), x)| (i, j, x))).unwrap()
    };
    let structure = SparseStructure::new(two([2.0, 0.0, 0.0, 1.0]), two([5.0, -2.0, -2.0, 3.0]));
    let structure = structure.damping(Damping::Rayleigh {
        mass: 0.2,
        stiffness: 0.0,
    });
    let stop = SparseContact::new("stop", Arc::new(Stop), Direction::at(1));
    let stop = stop.arguments([4.0]).offset(0.3);
    let structure = structure.contact(stop);
    let along = Direction::weighted([(0, 1.0), (1, -0.5)]);
    let structure = read(structure, 0, &along);
    let (omega, steps, periods) = (1.3, 4000, 60);

    let slope = |t: f64, [q, p, v, w]: [f64; 4]| {
        let force = 4.0 * (p - 0.3).max(0.0);
        let first = 0.5 * ((omega * t).cos() - 0.4 * v - 5.0 * q + 2.0 * p);
        [v, w, first, 2.0 * q - 3.0 * p - 0.2 * w - force]
    };
    let length = std::f64::consts::TAU / omega / f64::from(steps);
    let mut state = [0.0; 4];
    let mut extremes = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut highest = 0.0_f64;
    for step in 0..steps * periods {
        let t = length * f64::from(step);
        let moved = |by: f64, slope: [f64; 4]| {
            let mut moved = state;
            moved.iter_mut().zip(slope).for_each(|(x, v)| *x += by * v);
            moved
        };
        let a = slope(t, state);
        let b = slope(t + 0.5 * length, moved(0.5 * length, a));
        let c = slope(t + 0.5 * length, moved(0.5 * length, b));
        let d = slope(t + length, moved(length, c));
        if step >= steps * (periods - 1) {
            highest = highest.max(state[1]);
            let kinds = [
                state[0] - 0.5 * state[1],
                a[0] - 0.5 * a[1],
                a[2] - 0.5 * a[3],
            ];
            for ([low, high], value) in extremes.iter_mut().zip(kinds) {
                (*low, *high) = (low.min(value), high.max(value));
            }
        }
        let mean = [0, 1, 2, 3].map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0);
        state = moved(length, mean);
    }
    // The stop is met, else this would be the test of two masses above.
    assert!(highest > 0.4, "{highest}");
    let found = peaks(&structure, &Reduction::to(2.4), omega);
    for ([peak, error], [low, high]) in found.into_iter().zip(extremes) {
        assert!(error < 1e-9, "{error}");
        assert!(
            (peak / (high - low) - 1.0).abs() < 1e-5,
            "{peak}, {low} to {high}"
        );
    }
}
