//! What the reduction changes of Floquet multipliers, against closed forms and the structure with all of its modes.

use std::f64::consts::TAU;

use hertzian::generic::law_from_text;
use hertzian::{Branch, Complex, FrequencyResponse, Shooting, Verdict};
use hertzian_structure::{
    Damping, Direction, Load, Reduced, ReducedError, ReducedStability, Reduction, SparseContact,
    SparseMatrix, SparseStructure,
};

const STOP: &str = "Stop(gap, k) { gap > 0 => k*gap, else => 0 }";

/// Masses of one with this stiffness, damped by a multiple of the mass, driven and read at one coordinate, with a contact at another one.
fn masses(
    stiffness: &[&[f64]],
    damping: f64,
    (driven, force): (usize, f64),
    contact: SparseContact,
) -> SparseStructure {
    let n = stiffness.len();
    let rows = stiffness.iter().enumerate();
    let entries = rows.flat_map(|(i, row)| (0..n).map(move |j| (i, j, row[j])));
    let stiffness = SparseMatrix::from_triplets(n, n, entries).unwrap();
    let mass = SparseMatrix::from_triplets(n, n, (0..n).map(|i| (i, i, 1.0))).unwrap();
    SparseStructure::new(mass, stiffness)
        .damping(Damping::Rayleigh {
            mass: damping,
            stiffness: 0.0,
        })
        .load(Load::force(Direction::at(driven), force))
        .contact(contact)
        .output("there", Direction::at(driven))
}

/// A reduction with orbits at a frequency and next to it.
struct Followed {
    reduced: Reduced,
    branch: Branch,
}

impl Followed {
    fn of(structure: &SparseStructure, modes: usize, steps: usize, omega: f64) -> Self {
        let reduction = Reduction::to(omega).modes(modes).steps(steps);
        let reduced = reduction.run(structure).unwrap();
        let model = reduced.structure(structure).unwrap();
        let request = FrequencyResponse::of(&model).by(Shooting::new());
        let branch = request.from(omega).to(1.001 * omega).run().unwrap();
        Self { reduced, branch }
    }

    fn multipliers(&self) -> &[Complex<f64>] {
        &self.branch.points[0].stability.multipliers
    }

    fn stability(&self, of: &SparseStructure) -> ReducedStability {
        let point = &self.branch.points[0];
        self.reduced.stability_at(of, &self.branch, point).unwrap()
    }
}

fn contact(text: &str, at: usize, stiffness: f64, offset: f64) -> SparseContact {
    let law = law_from_text(text).unwrap();
    SparseContact::new("contact", law, Direction::at(at))
        .arguments([stiffness])
        .offset(offset)
}

/// Two masses on three springs of one, and a stop at the first one that is never left, so that it is a spring `k`. The frequencies of the whole structure are the roots of
/// `2 + k/2 -+ sqrt(1 + k^2/4)`; by the first mode alone, which has half of the mass at each place, there is the one of `1 + k/2`.
#[test]
fn a_spring_moves_the_multiplier_of_one_mode_by_as_much_as_is_stated() {
    let (k, c, omega) = (0.1_f64, 0.04_f64, 0.7_f64);
    let structure = masses(
        &[&[2.0, -1.0], &[-1.0, 2.0]],
        c,
        (1, 0.3),
        contact(STOP, 0, k, -9.0),
    );
    let few = Followed::of(&structure, 1, 0, omega);
    let multiplier = |square: f64| {
        let exponent = Complex::new(-0.5 * c, (square - 0.25 * c * c).sqrt());
        (exponent * (TAU / omega)).exp()
    };
    let reduced = multiplier(1.0 + 0.5 * k);
    let whole = multiplier(2.0 + 0.5 * k - (1.0 + 0.25 * k * k).sqrt());
    let found = few.multipliers()[0];
    let found = Complex::new(found.re, found.im.abs());
    let up = Complex::new(reduced.re, reduced.im.abs());
    assert!((found - up).norm() < 1e-8, "{found} {up}");
    let stability = few.stability(&structure);
    let off = (whole - reduced).norm();
    // The second order that is added is a thirtieth.
    for stated in &stability.errors {
        assert!((off..1.1 * off).contains(stated), "{off} {stated}");
    }
    assert_eq!(stability.verdict, Verdict::Stable);
}

/// A chain of three masses, the last two of which a stiff spring holds together, with a stop at the second one, driven at one of them.
fn chain(stiff: f64, driven: usize) -> SparseStructure {
    masses(
        &[
            &[2.0, -1.0, 0.0],
            &[-1.0, 1.0 + stiff, -stiff],
            &[0.0, -stiff, stiff],
        ],
        0.1,
        (driven, 0.5),
        contact(STOP, 1, 0.5, 0.2),
    )
}

/// By two of three modes: what is left out gives way by one over the stiffness of the spring.
#[test]
fn multipliers_beside_a_stop_are_within_the_stated_error_of_all_modes() {
    let mut before: Option<f64> = None;
    for stiff in [20.0, 40.0, 80.0] {
        let structure = chain(stiff, 0);
        let omega = 0.8;
        let (few, all) = (
            Followed::of(&structure, 2, 0, omega),
            Followed::of(&structure, 3, 0, omega),
        );
        let force = few.branch.reading("contact", &few.branch.points[0]);
        assert!(force.unwrap().motion.peak_to_peak() > 0.01);
        let stability = few.stability(&structure);
        for (mu, stated) in few.multipliers().iter().zip(&stability.errors) {
            let others = all.multipliers().iter();
            let off = others.map(|other| (other - mu).norm());
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(
                off < *stated && *stated < 10.0 * off,
                "{stiff}: {mu} {off} {stated}"
            );
        }
        assert_eq!(stability.verdict, all.branch.points[0].stability.verdict);
        let largest = stability.errors.iter().copied().fold(0.0, f64::max);
        if let Some(before) = before {
            let fell = before / largest;
            assert!((1.6..2.5).contains(&fell), "{stiff}: {fell}");
        }
        before = Some(largest);
        // With all modes nothing is left out.
        for stated in all.stability(&structure).errors {
            assert!(stated < 1e-7, "{stated}");
        }
    }
}

/// One mode and the static vector of the stop: the frequency of the latter is none of the structure. Driven elsewhere there are three vectors,
/// and they are the modes.
#[test]
fn modes_of_static_vectors_have_no_bound() {
    for (driven, bounded) in [(1, 2), (0, 6)] {
        let structure = chain(20.0, driven);
        let few = Followed::of(&structure, 1, 1, 0.8);
        let errors = few.stability(&structure).errors;
        let finite = errors.iter().filter(|error| error.is_finite());
        assert_eq!(finite.count(), bounded, "{errors:?}");
    }
}

#[test]
fn a_reduction_of_another_structure_says_nothing() {
    let structure = chain(20.0, 0);
    let few = Followed::of(&structure, 2, 0, 0.8);
    let point = &few.branch.points[0];
    let refused = few
        .reduced
        .stability_at(&chain(30.0, 0), &few.branch, point);
    assert!(matches!(refused, Err(ReducedError::Other)));
}
