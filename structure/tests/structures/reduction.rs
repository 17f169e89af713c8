//! Modes, static vectors and the error that is stated of them.

use std::f64::consts::PI;

use hertzian::structure::{Value, parameter};
use hertzian_structure::{
    Damping, Direction, Gyroscopic, Load, LoadKind, Ratios, Reduced, ReducedError, Reduction,
    ReductionError, SparseMatrix, SparseStructure, StructureError,
};
use nalgebra::DMatrix;
use serde_json::json;

use crate::common::{bar, beam, dense};

fn driven(structure: SparseStructure, at: usize) -> SparseStructure {
    structure
        .load(Load::force(Direction::at(at), parameter("drive", 1.0)))
        .output("tip", Direction::at(at))
}

/// Frequencies of a bar in linear elements are known: `w^2 = 6/h^2 (1 - cos k h) / (2 + cos k h)`.
fn of_bar(elements: usize, k: f64) -> f64 {
    let h = 1.0 / elements as f64;
    let cosine = (k * h).cos();
    (6.0 * (1.0 - cosine) / (2.0 + cosine)).sqrt() / h
}

#[test]
fn modes_of_a_bar_are_those_of_its_formula() {
    let elements = 500;
    let reduced = Reduction::to(2.0)
        .run(&driven(bar(elements, false), elements - 1))
        .unwrap();
    // Below sixteen times two: (r - 1/2) pi < 32.
    assert_eq!(reduced.modes(), 10);
    for (r, frequency) in reduced.frequencies()[..10].iter().enumerate() {
        let exact = of_bar(elements, (r as f64 + 0.5) * PI);
        assert!(
            (frequency / exact - 1.0).abs() < 1e-9,
            "{r}: {frequency} {exact}"
        );
    }
}

#[test]
fn a_free_bar_has_a_rigid_mode() {
    let elements = 300;
    let reduced = Reduction::to(4.0)
        .run(&driven(bar(elements, true), elements))
        .unwrap();
    let frequencies = reduced.frequencies();
    assert_eq!(frequencies[0], 0.0);
    for r in 1..reduced.modes() {
        let exact = of_bar(elements, r as f64 * PI);
        assert!((frequencies[r] / exact - 1.0).abs() < 1e-9);
    }
    // tan: the compliance at the end is -cot(s)/s.
    let s: f64 = 2.5;
    let exact = -1.0 / (s * s.tan());
    assert!((reduced.compliance(1, 0, s) / exact - 1.0).abs() < 1e-4);
}

#[test]
fn equal_frequencies_are_all_found() {
    // Two bars beside each other, and a third one that is half as stiff.
    let elements = 60;
    let one = bar(elements, false);
    let thrice = |scale: f64, stiffness: bool| {
        let reference = bar(elements, false);
        let matrix = if stiffness {
            reference.stiffness()
        } else {
            reference.mass()
        };
        let entries: Vec<_> = matrix.triplets().collect();
        let n = elements;
        let all = (0..3).flat_map(|k| {
            let factor = if k == 2 { scale } else { 1.0 };
            let shift = move |(i, j, x): &(usize, usize, f64)| (i + k * n, j + k * n, factor * x);
            entries.iter().map(shift).collect::<Vec<_>>()
        });
        SparseMatrix::from_triplets(3 * n, 3 * n, all).unwrap()
    };
    let structure = SparseStructure::new(thrice(1.0, false), thrice(0.5, true));
    let structure = driven(structure, elements - 1);
    let reduced = Reduction::to(0.75).run(&structure).unwrap();
    let known = dense_frequencies(&one);
    let below = known.iter().filter(|w| **w < 12.0).count();
    let slow = known.iter().filter(|w| **w * 0.5_f64.sqrt() < 12.0).count();
    assert_eq!(reduced.modes(), 2 * below + slow);
}

fn dense_frequencies(structure: &SparseStructure) -> Vec<f64> {
    let root = dense(structure.mass()).cholesky().unwrap().l();
    let k = root
        .solve_lower_triangular(&dense(structure.stiffness()))
        .unwrap();
    let k = root.solve_lower_triangular(&k.transpose()).unwrap();
    let mut all: Vec<f64> = k
        .symmetric_eigenvalues()
        .iter()
        .map(|x| x.max(0.0).sqrt())
        .collect();
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn frequencies_and_compliances_of_a_beam_are_those_of_dense_matrices() {
    let structure = driven(beam(40), 78);
    let known = dense_frequencies(&structure);
    // Roots of cos x cosh x = -1, squared.
    assert!((known[0] - 3.516_015_268_5).abs() < 1e-6);
    let reduced = Reduction::to(7.5).run(&structure).unwrap();
    let below = known.iter().filter(|w| **w < 120.0).count();
    assert_eq!(reduced.modes(), below);
    for (found, known) in reduced.frequencies()[..below].iter().zip(&known) {
        assert!((found / known - 1.0).abs() < 1e-7, "{found} {known}");
    }
    let (m, k) = (dense(structure.mass()), dense(structure.stiffness()));
    for s in [0.0, 10.0, 55.0, 140.0] {
        let mut b = DMatrix::zeros(80, 1);
        b[78] = 1.0;
        let full = (&k - s * s * &m).lu().solve(&b).unwrap()[78];
        let error = (reduced.compliance(1, 0, s) - full).abs();
        let stated = reduced.compliance_error(1, 0, s);
        assert!(
            error <= 3.0 * stated + 1e-10,
            "{s}: {error:e}, stated {stated:e}"
        );
    }
}

/// Each step makes two more terms of the series in the square of the frequency exact.
#[test]
fn steps_gain_two_orders_each() {
    let structure = driven(beam(30), 58);
    let mut slopes = Vec::new();
    for steps in 1..=2 {
        let reduced = Reduction::to(6.0)
            .modes(2)
            .steps(steps)
            .run(&structure)
            .unwrap();
        // Both are below the third frequency of 61.7, and above rounding.
        let [a, b] = [12.0, 24.0].map(|s| reduced.compliance_error(1, 0, s));
        slopes.push((b / a).log2());
    }
    // Errors of s^4 with one step and s^8 with two, beside the pole at 61.7.
    assert!((3.5..5.5).contains(&slopes[0]), "{slopes:?}");
    assert!((7.0..10.0).contains(&slopes[1]), "{slopes:?}");
}

#[test]
fn every_kind_of_damping_is_that_of_the_whole_structure() {
    let plain = || driven(bar(80, false), 79);
    let of = |damping: Damping| Reduction::to(5.0).run(&plain().damping(damping)).unwrap();
    let rayleigh = of(Damping::Rayleigh {
        mass: 0.3,
        stiffness: 0.02,
    });
    let (m, k) = (plain(), plain());
    let matrix = m.mass().triplets().map(|(i, j, x)| (i, j, 0.3 * x));
    let matrix = matrix.chain(k.stiffness().triplets().map(|(i, j, x)| (i, j, 0.02 * x)));
    let matrix = SparseMatrix::from_triplets(80, 80, matrix).unwrap();
    let by_matrix = of(Damping::Matrix(matrix));
    let vectors = rayleigh.vectors();
    for i in 0..vectors {
        for j in 0..vectors {
            let (a, b) = (rayleigh.damping(i, j), by_matrix.damping(i, j));
            assert!(
                (a - b).abs() < 1e-6 * rayleigh.damping(i.max(j), i.max(j)),
                "{i} {j} {a} {b}"
            );
        }
    }
    let table = of(Damping::Modal(Ratios::Table(vec![
        [0.0, 0.01],
        [10.0, 0.03],
    ])));
    for (i, w) in table.frequencies().iter().enumerate() {
        let ratio = 0.01 + 0.002 * w.min(10.0);
        assert!((table.damping(i, i) - 2.0 * ratio * w).abs() < 1e-12 * w);
    }
    let listed = of(Damping::Modal(Ratios::PerMode(vec![0.01, 0.05])));
    let w = listed.frequencies();
    assert!((listed.damping(0, 0) - 0.02 * w[0]).abs() < 1e-12);
    assert!((listed.damping(3, 3) - 0.1 * w[3]).abs() < 1e-9);
}

#[test]
fn what_cannot_be_reduced_is_said() {
    let sound = || driven(bar(20, false), 19);
    let said = |structure: &SparseStructure| Reduction::to(3.0).run(structure).unwrap_err();
    let pushed = SparseStructure::new(
        sound().mass().clone(),
        SparseMatrix::from_triplets(
            20,
            20,
            (0..20).map(|i| (i, i, if i == 3 { -1.0 } else { 1.0 })),
        )
        .unwrap(),
    );
    assert_eq!(said(&pushed), ReductionError::Unstable { count: 1 });
    // Two coordinates that are coupled by more than their own: eigenvalues 3 and -1, on a positive diagonal.
    let coupled = || {
        let ones = (0..20).map(|i| (i, i, 1.0));
        let entries = ones.chain([(4, 5, 2.0), (5, 4, 2.0)]);
        SparseMatrix::from_triplets(20, 20, entries).unwrap()
    };
    let of = |mass: SparseMatrix, stiffness: SparseMatrix| {
        said(&driven(SparseStructure::new(mass, stiffness), 19))
    };
    assert_eq!(
        of(sound().mass().clone(), coupled()),
        ReductionError::Unstable { count: 1 }
    );
    assert_eq!(
        of(coupled(), sound().stiffness().clone()),
        ReductionError::Mass
    );
    assert_eq!(
        said(&sound().damping(Damping::Matrix(coupled()))),
        ReductionError::Damping { count: 1 }
    );
    // A damper between two coordinates has rows of zeros and an eigenvalue of zero, which may stand beside a far stronger one, and have few digits.
    for (strong, damper, own) in [(0.0, 1.0, 1.0), (1e3, 1e-8, 1e-8), (1.0, 1.0, 0.999_999_9)] {
        let between = [(4, 4, own), (4, 5, -damper), (5, 4, -damper), (5, 5, own)];
        let entries = between.into_iter().chain([(2, 2, strong)]);
        let damper = SparseMatrix::from_triplets(20, 20, entries).unwrap();
        let damped = sound().damping(Damping::Matrix(damper));
        assert!(Reduction::to(3.0).run(&damped).is_ok(), "{strong} {own}");
    }
    let unsymmetric = SparseMatrix::from_triplets(20, 20, (0..20).map(|i| (i, 0, 1.0))).unwrap();
    let unsymmetric = SparseStructure::new(sound().mass().clone(), unsymmetric);
    assert!(matches!(
        said(&unsymmetric),
        ReductionError::Structure(StructureError::Symmetry { .. })
    ));
    let none = SparseMatrix::from_triplets(20, 20, []).unwrap();
    let massless = SparseStructure::new(none, sound().stiffness().clone());
    assert!(Reduction::to(3.0).run(&driven(massless, 3)).is_err());
    let empty = SparseMatrix::from_triplets(0, 0, []).unwrap();
    let empty = SparseStructure::new(empty.clone(), empty);
    assert_eq!(
        said(&empty),
        ReductionError::Structure(StructureError::Empty)
    );
    assert!(matches!(
        Reduction::to(-1.0).run(&sound()),
        Err(ReductionError::Option { name: "omega", .. })
    ));
    assert!(matches!(
        Reduction::to(1.0).modes(0).run(&sound()),
        Err(ReductionError::Option { name: "modes", .. })
    ));
    let outside = sound().output("beyond", Direction::at(20));
    assert!(said(&outside).to_string().contains("coordinate 20"));
}

#[test]
fn a_reduced_structure_is_kept_in_a_file() {
    let structure = driven(bar(50, false), 49);
    let reduced = Reduction::to(3.0).run(&structure).unwrap();
    let path = std::env::temp_dir().join(format!("hertzian-reduced-{}.json", std::process::id()));
    reduced.write(&path).unwrap();
    let read = Reduced::read(&path).unwrap();
    assert_eq!(read, reduced);
    assert!(read.is_of(&structure).is_ok());
    assert!(read.is_of(&driven(bar(50, false), 48)).is_err());
    std::fs::write(&path, "{}").unwrap();
    assert!(Reduced::read(&path).is_err());
    std::fs::remove_file(&path).unwrap();
}

/// What was kept stands for a reduction of lower frequencies, and for none with other options.
#[test]
fn what_was_kept_is_that_of_the_options_it_was_made_with() {
    let structure = driven(bar(50, false), 49);
    let asked = || Reduction::to(3.0).modes(4).steps(2);
    let kept = asked().run(&structure).unwrap();
    assert!(asked().accepts(&kept).is_ok());
    assert!(Reduction::to(1.0).modes(4).steps(2).accepts(&kept).is_ok());
    let said = |other: Reduction| other.accepts(&kept).unwrap_err().to_string();
    assert_eq!(
        said(Reduction::to(4.0).modes(4).steps(2)),
        "it was made for frequencies up to 3, and 4 are asked for: remove it"
    );
    assert_eq!(
        said(asked().modes(5)),
        "it was made with 4 modes, and 5 modes are asked for: remove it"
    );
    assert!(said(Reduction::to(3.0).steps(2)).contains("all modes that its frequency asks for"));
    assert!(said(asked().steps(0)).contains("with 2 steps of static vectors, and 0 steps"));
    assert!(said(Reduction::to(3.0).modes(4)).contains("as many steps"));
    assert!(said(asked().tolerance(1e-3)).contains("a compliance to 1e-6"));
}

/// A bar with a damper between its coordinates and the ground, which turns.
fn turning(kind: LoadKind) -> SparseStructure {
    let n = 6;
    let spins = [(0, 1, 0.3), (1, 0, -0.3)];
    let spins = SparseMatrix::from_triplets(n, n, spins).unwrap();
    let dampers = SparseMatrix::from_triplets(n, n, [(2, 2, 0.1)]).unwrap();
    bar(n, false)
        .damping(Damping::Matrix(dampers))
        .gyroscopic(Gyroscopic {
            matrix: spins,
            speed: parameter("speed", 1.0),
        })
        .load(Load::new(kind, Direction::at(n - 1), parameter("a", 0.1)))
}

/// By three of its six vectors, so that something is left out.
fn by_few() -> Reduced {
    let asked = Reduction::to(3.0).modes(2).steps(1);
    asked.run(&turning(LoadKind::Force)).unwrap()
}

/// What is read of a file that holds other values at some places, or nothing there.
fn changed(
    name: &str,
    changes: impl IntoIterator<Item = (&'static str, Option<serde_json::Value>)>,
) -> Result<Reduced, ReducedError> {
    let name = format!("hertzian-changed-{name}-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    by_few().write(&path).unwrap();
    let mut all: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    for (pointer, value) in changes {
        let place = all.pointer_mut(pointer).expect(pointer);
        if let Some(value) = value {
            *place = value;
        } else {
            let fields = all.as_object_mut().expect("fields");
            fields.remove(pointer.trim_start_matches('/'));
        }
    }
    std::fs::write(&path, all.to_string()).unwrap();
    let read = Reduced::read(&path);
    std::fs::remove_file(&path).unwrap();
    read
}

/// What was changed in a file so that its numbers do not fit each other is refused.
#[test]
fn a_changed_file_of_a_reduced_structure_is_refused() {
    let reduced = by_few();
    assert_eq!(reduced.vectors(), 3);
    let block = vec![0.0; 9];
    for (pointer, value) in [
        ("/damping/1", json!(7.0)),
        ("/gyroscopic/0/0", json!(1.0)),
        ("/gyroscopic/0/1", json!(9.0)),
        ("/gyroscopic", json!([])),
        ("/coupling/3", json!([1.0])),
        ("/coupling", json!([])),
        ("/coupling", json!([block, block])),
        ("/coupling", json!([block, block, block, block, block])),
        ("/rows/0", json!([1.0])),
        ("/modes", json!(0)),
        ("/modes", json!(100)),
        ("/to", json!(0.0)),
        ("/asked/modes", json!(0)),
        ("/asked/tolerance", json!(-1.0)),
        ("/checked", json!([])),
        ("/checked/0/largest", json!(-1.0)),
        ("/checked/1/frequency", json!(1e9)),
        ("/checked/0/errors", json!([0.0, 0.0])),
    ] {
        let error = changed("sizes", [(pointer, Some(value))]).expect_err(pointer);
        assert!(matches!(error, ReducedError::Sizes), "{pointer}: {error}");
    }
}

/// Files of older versions have fewer fields, and it is the version that is said.
#[test]
fn files_of_older_versions_are_told_by_their_version() {
    let first = changed("first", [("/version", Some(json!(1)))]);
    let first = first.expect_err("a version");
    assert!(matches!(first, ReducedError::Version { found: 1, .. }));
    let third = [("/version", Some(json!(3))), ("/coupling", None)];
    let third = changed("third", third).expect_err("a version");
    assert!(matches!(third, ReducedError::Version { found: 3, .. }));
}

#[test]
fn a_reduction_of_another_structure_is_refused() {
    let structure = turning(LoadKind::Force);
    let reduced = by_few();
    assert!(reduced.is_of(&structure).is_ok());
    // A base moves the masses: its vectors are others.
    assert!(reduced.is_of(&turning(LoadKind::Base)).is_err());
    for (pointer, value) in [
        ("/coordinates", json!(7)),
        // As of one without a damping matrix that is given by its entries.
        ("/coupling", json!([vec![0.0; 9]])),
    ] {
        let other = changed("other", [(pointer, Some(value))]).unwrap();
        assert!(matches!(other.is_of(&structure), Err(ReducedError::Other)));
    }
    // Nor is anything said by it of orbits of another structure.
    let one = bar(6, false).load(Load::force(Direction::at(0), 0.1));
    let whole = Reduction::to(3.0).run(&one).unwrap();
    let model = whole.structure(&one).unwrap();
    let branch = hertzian::FrequencyResponse::of(&model).from(0.5).to(0.6);
    let branch = branch.run().unwrap();
    let refused = reduced.errors_at(&one, &branch, &branch.points[0]);
    assert!(matches!(refused, Err(ReducedError::Other)));
}

/// One mass on a spring: loads of all kinds have the amplitudes of their formulas.
#[test]
fn loads_of_every_kind_have_their_amplitudes() {
    use hertzian::{FrequencyResponse, Shooting};
    let one = |x: f64| SparseMatrix::from_triplets(1, 1, [(0, 0, x)]).unwrap();
    let (mass, stiffness, zeta, omega) = (2.0, 8.0, 0.1, 1.5);
    for (kind, force) in [
        (LoadKind::Force, 0.3),
        (LoadKind::Unbalance, 0.3 * omega * omega),
        (LoadKind::Base, 0.3 * mass * omega * omega),
        (LoadKind::Acceleration, 0.3 * mass),
    ] {
        let structure = SparseStructure::new(one(mass), one(stiffness))
            .damping(Damping::ratio(zeta))
            .load(Load::new(kind, Direction::at(0), parameter("a", 0.3)).phase(0.4))
            .output("x", Direction::at(0));
        let model = Reduction::to(2.0)
            .run(&structure)
            .unwrap()
            .structure(&structure)
            .unwrap();
        let request = FrequencyResponse::of(&model).by(Shooting::new());
        let orbit = request.orbit(omega).unwrap();
        let measured = request
            .measured(&"x:h1".parse().unwrap(), &orbit)
            .unwrap()
            .unwrap();
        let r: f64 = omega / 2.0;
        let exact = force / stiffness / ((1.0 - r * r).powi(2) + (2.0 * zeta * r).powi(2)).sqrt();
        assert!(
            (measured / exact - 1.0).abs() < 1e-9,
            "{kind:?} {measured} {exact}"
        );
    }
}

/// A disc on a flexible shaft, which turns at a speed: its whirl frequencies are the roots of `w^2 -+ g s w - k = 0`.
#[test]
fn gyroscopic_matrices_split_frequencies() {
    use hertzian::structure::DMatrix;
    use hertzian::system::System;
    let of =
        |entries: Vec<(usize, usize, f64)>| SparseMatrix::from_triplets(2, 2, entries).unwrap();
    let one = || of(vec![(0, 0, 1.0), (1, 1, 1.0)]);
    let structure = SparseStructure::new(one(), one())
        .gyroscopic(Gyroscopic {
            matrix: of(vec![(0, 1, 0.5), (1, 0, -0.5)]),
            speed: Value::from(1.0).times_omega(1),
        })
        .load(Load::force(Direction::at(0), 0.1));
    let reduced = Reduction::to(2.0).run(&structure).unwrap();
    let model = reduced.structure(&structure).unwrap();
    // At the speed s the state matrix has the eigenvalues +-i w with w^2 -+ 0.5 s w - 1 = 0.
    let speed = 0.8;
    let mut coefficients = vec![0.0; model.facts().places.len()];
    model.coefficients(&[], speed, &mut coefficients);
    let mut matrix = DMatrix::zeros(4, 4);
    for i in 0..2 {
        matrix[(i, 2 + i)] = 1.0;
        matrix[(2 + i, i)] = -1.0;
    }
    for (place, value) in model.facts().places.iter().zip(&coefficients) {
        if let hertzian::system::Place::Damping { row, column } = place {
            matrix[(2 + row, 2 + column)] -= value;
        }
    }
    let mut found: Vec<f64> = matrix
        .complex_eigenvalues()
        .iter()
        .map(|z| z.im)
        .filter(|w| *w > 0.0)
        .collect();
    found.sort_by(f64::total_cmp);
    let g = 0.5 * speed;
    let root = (g * g / 4.0 + 1.0_f64).sqrt();
    for (found, exact) in found.iter().zip([root - g / 2.0, root + g / 2.0]) {
        assert!((found - exact).abs() < 1e-12);
    }
}
