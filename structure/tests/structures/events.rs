//! Events of structures with a stop, against values of the whole structure from integrations of their own.
//!
//! The values are from event-driven shooting with the exact flow of all modes, confirmed by the times of the switches as unknowns in 75
//! digits and by an integrator of order eight.

use hertzian::{Branch, ContactEquation, EventKind, FrequencyResponse, OrbitMethod, Shooting};
use hertzian_structure::{Damping, Reduction, SparseMatrix, SparseStructure};

use crate::common::{beam, stopped};

/// The branch, and what the reduction changes of its tip at most.
fn branch<M: OrbitMethod>(
    structure: &SparseStructure,
    reduction: &Reduction,
    by: M,
    from: f64,
    to: f64,
) -> (Branch, f64) {
    let reduced = reduction.run(structure).unwrap();
    let model = reduced.structure(structure).unwrap();
    let request = FrequencyResponse::of(&model).by(by);
    let request = request.accuracy_of("stopped").from(from).to(to);
    let branch = request.run().unwrap();
    let errors = branch.events.iter().map(|event| {
        let errors = reduced.errors_at(structure, &branch, &event.point).unwrap();
        errors[0].error
    });
    let worst = errors.fold(0.0, f64::max);
    (branch, worst)
}

fn are_found(branch: &Branch, known: &[(EventKind, f64)], relative: f64) {
    for (kind, exact) in known {
        let near = branch
            .events(*kind)
            .map(|event| (event.point.value / exact - 1.0).abs());
        let off = near.fold(f64::INFINITY, f64::min);
        assert!(off <= relative, "{kind} at {exact}: {off:e}");
    }
}

#[test]
fn two_masses_with_a_stop() {
    let of = |entries: &[(usize, usize, f64)]| {
        SparseMatrix::from_triplets(2, 2, entries.iter().copied()).unwrap()
    };
    let mass = of(&[(0, 0, 1.0), (1, 1, 1.0)]);
    let stiffness = of(&[(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 2.0)]);
    let structure = SparseStructure::new(mass, stiffness).damping(Damping::Rayleigh {
        mass: 0.0,
        stiffness: 0.03,
    });
    let structure = stopped(structure, 0.1, 100.0, 1.0, [1, 0]);
    let (branch, error) = branch(
        &structure,
        &Reduction::to(0.8),
        ContactEquation::new(),
        0.5,
        0.8,
    );
    let known = [
        (EventKind::NeimarkSacker, 0.581_900_650_364_62),
        (EventKind::NeimarkSacker, 0.618_606_874_267_02),
        (EventKind::PeriodDoubling, 0.738_783_025_373_24),
        (EventKind::PeriodDoubling, 0.755_586_159_356_17),
        (EventKind::Fold, 0.755_627_352_609_07),
        (EventKind::Fold, 0.653_440_134_548_89),
    ];
    are_found(&branch, &known, 1e-9);
    let located = branch.events.iter();
    let located = located.filter(|event| !matches!(event.kind, EventKind::Grazing { .. }));
    assert_eq!(located.count(), known.len());
    // Nothing is left out.
    assert!(error < 1e-9, "{error:e}");
}

/// Few vectors instead of 200 modes.
#[test]
fn a_beam_with_a_stop() {
    let structure = beam(100).damping(Damping::ratio(0.01));
    let structure = stopped(structure, 0.03, 50.0, 0.1, [198, 198]);
    let (branch, error) = branch(&structure, &Reduction::to(4.6), Shooting::new(), 3.2, 4.6);
    let folds = [
        (EventKind::Fold, 4.397_268_492_460),
        (EventKind::Fold, 3.723_657_666_350),
        (EventKind::Fold, 3.721_170_768_660),
        (EventKind::Fold, 3.678_388_995_307),
    ];
    are_found(&branch, &folds, 2e-6);
    // These depend on the damping of modes that static vectors stand for.
    let tori = [
        (EventKind::NeimarkSacker, 3.888_797_342_809),
        (EventKind::NeimarkSacker, 3.721_333_430_009),
    ];
    are_found(&branch, &tori, 1e-4);
    // What is stated holds, and says something.
    assert!((2e-6..1e-3).contains(&error), "{error:e}");
}
