//! Free oscillation and phase resonance of reduced structures: against closed forms, against motions of all coordinates by an integrator of its
//! own, and against the structure by all of its modes.

use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::system::{Place, Signal, System};
use hertzian::{Branch, FrequencyResponse, Shooting, Stop};
use hertzian_structure::{Damping, Direction, Reduced, Reduction, SparseMatrix, SparseStructure};
use nalgebra::{Complex, DMatrix, DVector};

use crate::common::{beam, dense, stopped};

/// All modes of a structure.
fn whole(structure: &SparseStructure) -> Reduced {
    let reduction = Reduction::to(10.0).modes(structure.coordinates());
    reduction.steps(0).run(structure).unwrap()
}

/// Free oscillation in a mode, up to a position of it.
fn free(reduced: &Reduced, structure: &SparseStructure, mode: usize, to: f64) -> Branch {
    let model = reduced.structure(structure).unwrap();
    let request = FreeOscillation::of(&model).conservative().mode(mode).to(to);
    let curve = request.run().unwrap();
    assert_eq!(curve.stopped, Stop::ReachedEnd);
    curve
}

/// Below the clearance frequencies are those of `scipy.linalg.eigh`, here of nalgebra, whatever the amplitude and however damped; energies are
/// halves of squares.
#[test]
fn small_oscillations_have_the_frequencies_of_modes() {
    let structure = beam(6).damping(Damping::ratio(0.05));
    let structure = stopped(structure, 0.3, 50.0, 1.0, [10, 10]);
    let (m, k) = (dense(structure.mass()), dense(structure.stiffness()));
    let root = m.cholesky().unwrap().l();
    let half = root.solve_lower_triangular(&k).unwrap();
    let scaled = root.solve_lower_triangular(&half.transpose()).unwrap();
    let mut exact: Vec<f64> = scaled.symmetric_eigenvalues().iter().copied().collect();
    exact.sort_by(f64::total_cmp);
    let reduced = whole(&structure);
    let model = reduced.structure(&structure).unwrap();
    let request = FreeOscillation::of(&model).conservative();
    for mode in 1..=3 {
        let omega = exact[mode - 1].sqrt();
        let request = request.clone().mode(mode).to(0.2);
        let curve = request.run().unwrap();
        assert_eq!(curve.stopped, Stop::ReachedEnd);
        let energies = request.energies(&curve).unwrap();
        for (point, energy) in curve.points.iter().zip(energies) {
            assert!((point.omega() / omega - 1.0).abs() < 1e-9, "{mode}");
            let amplitude = point.orbit.state()[mode - 1];
            let expected = 0.5 * (omega * amplitude).powi(2);
            assert!((energy / expected - 1.0).abs() < 1e-9, "{energy}");
        }
        // Nothing is pushed by what is left out.
        let errors = reduced.frequency_errors(&structure, &curve).unwrap();
        assert!(errors.iter().all(|error| *error == 0.0));
    }
}

/// A mass on a spring before a stop: with `w^2` and `w^2 + k` on either side of the clearance `d`, half a period from `-a` takes
/// `acos(-d/a)/w` and `atan(v/(w_2 c))/w_2`, `v = w sqrt(a^2 - d^2)`, `c = d w^2/w_2^2`.
#[test]
fn one_mass_before_a_stop_has_the_closed_form() {
    let one = |x: f64| SparseMatrix::from_triplets(1, 1, [(0, 0, x)]).unwrap();
    let (omega, k, d) = (2.0_f64, 30.0, 0.5);
    let structure = SparseStructure::new(one(1.0), one(omega * omega));
    let structure = structure.damping(Damping::ratio(0.1));
    let structure = stopped(structure, 0.3, k, d, [0, 0]);
    let reduced = Reduction::to(4.0).run(&structure).unwrap();
    let model = reduced.structure(&structure).unwrap();
    // A mode has either sign.
    let side = model_side(&reduced, &structure);
    let request = FreeOscillation::of(&model).conservative().mode(1);
    let request = request.from(-0.1 * side).to(-3.0 * side);
    let curve = request.run().unwrap();
    let energies = request.energies(&curve).unwrap();
    let mut met = 0;
    for (point, energy) in curve.points.iter().zip(energies) {
        let a = point.orbit.state()[0].abs();
        assert!((energy / (0.5 * (omega * a).powi(2)) - 1.0).abs() < 1e-12);
        let exact = if a <= d {
            omega
        } else {
            met += 1;
            let second = omega.hypot(k.sqrt());
            let speed = omega * (a * a - d * d).sqrt();
            let centre = d * (omega / second).powi(2);
            let half = (-d / a).acos() / omega + (speed / (second * centre)).atan() / second;
            std::f64::consts::PI / half
        };
        assert!((point.omega() / exact - 1.0).abs() < 1e-9, "{a}");
    }
    assert!(met > 5);
}

/// The sign by which the first mode moves the stop.
fn model_side(reduced: &Reduced, structure: &SparseStructure) -> f64 {
    let model = reduced.structure(structure).unwrap();
    let near = FreeOscillation::of(&model)
        .conservative()
        .mode(1)
        .from(0.01);
    let curve = near.to(0.02).run().unwrap();
    let reading = curve.reading("stopped", &curve.points[0]).unwrap();
    reading.series[1].signum()
}

/// The equations of two masses of which the first meets a stop, by the method of Kutta (1901), from rest over so long a time.
fn moved([q, p]: [f64; 2], time: f64) -> ([f64; 4], f64) {
    let slope = |[q, p, v, w]: [f64; 4]| {
        let force = 10.0 * (q - 1.0).max(0.0);
        [v, w, p - q - force, q - 2.0 * p]
    };
    let steps = 200_000;
    let h = time / f64::from(steps);
    let (mut state, mut highest) = ([q, p, 0.0, 0.0], q);
    for _ in 0..steps {
        let moved = |by: f64, slope: [f64; 4]| {
            let mut moved = state;
            moved.iter_mut().zip(slope).for_each(|(x, v)| *x += by * v);
            moved
        };
        let a = slope(state);
        let b = slope(moved(0.5 * h, a));
        let c = slope(moved(0.5 * h, b));
        let d = slope(moved(h, c));
        let mean = [0, 1, 2, 3].map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0);
        state = moved(h, mean);
        highest = highest.max(state[0]);
    }
    (state, highest)
}

/// Two masses of which the first meets a stop: a motion without damping is symmetric in time, and one that begins at rest is at rest again after half of
/// its period.
#[test]
fn motions_of_two_masses_return() {
    let two = |x: [f64; 4]| {
        let places = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().zip(x);
        SparseMatrix::from_triplets(2, 2, places.map(|((i, j), x)| (i, j, x))).unwrap()
    };
    let structure = SparseStructure::new(two([1.0, 0.0, 0.0, 1.0]), two([1.0, -1.0, -1.0, 2.0]));
    let structure = structure.damping(Damping::Rayleigh {
        mass: 0.0,
        stiffness: 0.03,
    });
    let structure = stopped(structure, 0.1, 10.0, 1.0, [1, 0]).output("second", Direction::at(1));
    let reduced = whole(&structure);
    for mode in [1, 2] {
        let curve = free(&reduced, &structure, mode, 2.0);
        let last = curve.points.last().unwrap();
        let modes = last.orbit.state();
        let begin = [0, 1].map(|output| {
            let row = output_row(&reduced, &structure, output);
            row.iter().zip(&modes).map(|(a, q)| a * q).sum::<f64>()
        });
        let half = std::f64::consts::PI / last.omega();
        let (end, highest) = moved(begin, half);
        assert!(highest > 1.01, "the stop is met: {highest}");
        let missed = end[2].hypot(end[3]) / (last.omega() * last.peak_to_peak());
        assert!(missed < 1e-9, "{mode}: {end:?} {missed:.1e}");
        // What is stated of it bounds nothing less than what is missed by the reduced equations.
        assert!(last.error.is_some_and(|error| error < 1e-9));
    }
}

/// What an output is of each vector of the reduction.
fn output_row(reduced: &Reduced, structure: &SparseStructure, output: usize) -> Vec<f64> {
    let model = reduced.structure(structure).unwrap();
    let facts = model.facts();
    let mut parameters = vec![0.0; facts.parameters.len()];
    model.values(&mut parameters);
    let mut coefficients = vec![0.0; facts.places.len()];
    model.coefficients(&parameters, 1.0, &mut coefficients);
    let mut row = vec![0.0; facts.coordinates.len()];
    for (place, coefficient) in facts.places.iter().zip(coefficients) {
        match *place {
            Place::Output {
                output: of,
                of: Signal::Coordinate(index),
                ..
            } if of == output => row[index] = coefficient,
            _ => {}
        }
    }
    row
}

/// The action of an oscillation by all of its vectors.
fn action(curve: &Branch, index: usize) -> f64 {
    let completed = curve.complete(&curve.points[index]).unwrap();
    let orbit = &completed.orbit;
    let mut action = 0.0;
    for coordinate in 0..orbit.coordinates() {
        for (pair, k) in orbit.series(coordinate).unwrap()[1..].chunks(2).zip(1..) {
            action += 0.5 * f64::from(k).powi(2) * orbit.base * (pair[0].powi(2) + pair[1].powi(2));
        }
    }
    action
}

/// Two modes of a beam instead of all: at equal action frequencies differ by what is stated, which says something.
#[test]
fn the_error_of_the_frequency_is_stated() {
    let structure = stopped(beam(4), 0.3, 3.0, 0.1, [6, 6]);
    let exact = free(&whole(&structure), &structure, 1, 0.072);
    let actions: Vec<f64> = (0..exact.points.len()).map(|i| action(&exact, i)).collect();
    let few = Reduction::to(4.0)
        .modes(2)
        .steps(0)
        .run(&structure)
        .unwrap();
    let curve = free(&few, &structure, 1, 0.068);
    let stated = few.frequency_errors(&structure, &curve).unwrap();
    assert_eq!(stated.len(), curve.points.len());
    let mut seen = 0;
    for (index, point) in curve.points.iter().enumerate() {
        let own = action(&curve, index);
        let after = actions.partition_point(|known| *known < own);
        if after < 2 || after + 1 >= actions.len() || stated[index] < 1e-6 {
            continue;
        }
        // The cubic through four neighbours.
        let places = after - 2..after + 2;
        let known = places.clone().map(|i| {
            let others = places.clone().filter(|j| *j != i);
            let weight = others.map(|j| (own - actions[j]) / (actions[i] - actions[j]));
            weight.product::<f64>() * exact.points[i].omega()
        });
        let error = (point.omega() / known.sum::<f64>() - 1.0).abs();
        seen += 1;
        let stated = stated[index];
        assert!(error < 1.5 * stated, "{error:e} {stated:e}");
        assert!(stated < 20.0 * error, "{error:e} {stated:e}");
    }
    assert!(seen > 3, "{seen}");
}

/// Without a contact the load and the displacement that it works on are a quarter of a period apart where the real part of
/// `b . (K - w^2 M + i w C)^-1 b` vanishes, whatever the amplitude.
#[test]
fn a_linear_structure_is_in_phase_resonance_where_its_matrices_say() {
    let damping = [0.2, 0.01];
    let structure = beam(5).damping(Damping::Rayleigh {
        mass: damping[0],
        stiffness: damping[1],
    });
    let structure = stopped(structure, 0.02, 50.0, 10.0, [4, 8]);
    let reduced = whole(&structure);
    let model = reduced.structure(&structure).unwrap();
    let response = FrequencyResponse::of(&model).by(Shooting::new());
    let response = response.from(2.5).to(4.5).run().unwrap();
    let request = PhaseResonance::of(&model).vary("drive").harmonics(3);
    let curve = request.to(0.001).on(&response).run().unwrap();
    assert_eq!(curve.stopped, Stop::ReachedEnd);
    let (m, k) = (dense(structure.mass()), dense(structure.stiffness()));
    let c = damping[0] * &m + damping[1] * &k;
    for point in &curve.points {
        let omega = point.omega();
        let dynamic = DMatrix::from_fn(m.nrows(), m.nrows(), |i, j| {
            Complex::new(k[(i, j)] - omega * omega * m[(i, j)], omega * c[(i, j)])
        });
        let mut force = DVector::zeros(m.nrows());
        force[4] = Complex::new(1.0, 0.0);
        let answer = dynamic.lu().solve(&force).unwrap()[4];
        assert!(answer.re.abs() < 1e-7 * answer.im.abs(), "{omega} {answer}");
    }
    let errors = reduced
        .errors_at(&structure, &curve, &curve.points[0])
        .unwrap();
    assert!(errors[0].error < 1e-9, "{errors:?}");
}

/// A rotor whose gyroscopic forces couple two planes does not come to rest: that is said.
#[test]
fn gyroscopic_forces_are_refused() {
    let two = |x: [f64; 4]| {
        let places = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter().zip(x);
        SparseMatrix::from_triplets(2, 2, places.map(|((i, j), x)| (i, j, x))).unwrap()
    };
    let structure = SparseStructure::new(two([1.0, 0.0, 0.0, 1.0]), two([1.0, 0.0, 0.0, 2.0]));
    let structure = structure.gyroscopic(hertzian_structure::Gyroscopic {
        matrix: two([0.0, 0.3, -0.3, 0.0]),
        speed: 1.0.into(),
    });
    let structure = stopped(structure, 0.1, 10.0, 1.0, [0, 1]);
    let model = whole(&structure).structure(&structure).unwrap();
    let request = FreeOscillation::of(&model).conservative().mode(1).to(2.0);
    let error = request.run().unwrap_err().to_string();
    assert!(
        error.starts_with("gyroscopic forces of up to 3.0e-1"),
        "{error}"
    );
}
