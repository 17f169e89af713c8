//! Equations of many modes, whose states are eliminated mode by mode, against those where forces are eliminated first.

use nalgebra::DMatrix;

use super::super::equations::Equations;
use super::super::equations::setting::{Frame, Setting};
use super::super::orbit::gaps::Gaps;
use super::super::skeleton::placement::Resolution;
use super::super::switches::plan::Plan;
use crate::branches::recurrence::{Recurrence, SignedPermutation};
use crate::cancel::Cancel;
use crate::continuation::jacobian::Jacobian;
use crate::continuation::problem::Problem;
use crate::model::structure::{Contact, Structure, parameter};
use crate::system::{System, Variable};

crate::law! {
    /// A ball on a plane.
    Hertz(gap, k >= 0) { gap > 0 => k*gap^1.5, else => 0 }
}

/// A chain of unit masses and springs with a stop at the first, or one at each side of it. What holds the last one holds all of them.
fn chain(masses: usize, sides: &[f64], hold: f64, damping: f64) -> Structure {
    let stiffness = DMatrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 if i == 0 => 1.0,
        0 if i + 1 == masses => 1.0 + hold,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let mut structure = Structure::of(
        &DMatrix::identity(masses, masses),
        &(damping * &stiffness),
        &stiffness,
    )
    .cosine(masses - 1, 1, parameter("drive", 0.1));
    for side in sides {
        let mut direction = vec![0.0; masses];
        direction[0] = *side;
        let stop = Contact::new(Hertz)
            .arguments([parameter("k", 100.0)])
            .direction(direction)
            .offset(parameter("distance", 1.0));
        structure = structure.contact(stop);
    }
    structure.build().unwrap()
}

/// Equations beside no orbit of it: a wave that goes down along the chain, and meets its stops.
fn equations(
    structure: &Structure,
    vary: Variable,
    recurrence: &Recurrence,
) -> (Equations, Vec<f64>) {
    let omega = 0.7;
    let parameters = crate::model::values(structure);
    let value = match vary {
        Variable::Omega => omega,
        Variable::Parameter(index) => parameters[index],
    };
    let shared = structure.shared();
    let setting = Setting::new(&shared, vary, parameters, omega, &Cancel::new());
    let values = setting.values(value).unwrap();
    let coordinates = values.order() / 2;
    let at = |phase: f64, state: &mut [f64]| {
        for i in 0..coordinates {
            let (size, angle) = (1.3 / (1.0 + i as f64), phase - 0.2 * i as f64);
            state[i] = size * angle.cos();
            state[coordinates + i] = -omega * size * angle.sin();
        }
    };
    let gaps = Gaps {
        values: &values,
        at: &at,
        coordinates,
    };
    let frame = Frame {
        reference: vec![0.0; 2 * coordinates],
        size: 1.0,
        resolution: Resolution {
            nodes: 12,
            panels: 1,
        },
    };
    let plan = Plan::sampled(&gaps, recurrence);
    plan.equations(&setting, value, &gaps, &frame).unwrap()
}

/// Factors at unknowns, with a border.
fn factors(equations: &mut Equations, u: &[f64]) -> Jacobian {
    let n = u.len() - 1;
    let mut jacobian = Jacobian::new(equations.partition());
    jacobian.clear();
    equations.evaluate(u, &mut vec![0.0; n], Some(&mut jacobian));
    let border: Vec<f64> = (0..=n).map(|i| (0.7 * i as f64).cos()).collect();
    jacobian.set_border(&border);
    let units: Vec<f64> = (0..=n).map(|i| 1.5 + (i as f64).sin()).collect();
    jacobian.scale_columns(&units);
    jacobian
}

fn are_near(found: &[f64], known: &[f64]) {
    let size = known.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in found.iter().zip(known) {
        assert!((a - b).abs() < 1e-9 * size, "{a} {b} of {size}");
    }
}

/// Both ways have the same solutions, transposed ones and determinants, and the same step to a finer orbit.
fn both_ways_agree(structure: &Structure, vary: Variable, recurrence: &Recurrence) {
    let (mut paired, u) = equations(structure, vary, recurrence);
    let (mut chained, _) = equations(structure, vary, recurrence);
    assert!(paired.partition().pairs > 0, "nothing is compared");
    chained.keep_chain();
    let mut both = [factors(&mut paired, &u), factors(&mut chained, &u)];
    let [a, b] = both.each_mut().map(Jacobian::determinant);
    assert_eq!(a.0, b.0);
    assert!((a.1 - b.1).abs() < 1e-9 * b.1.abs().max(1.0), "{a:?} {b:?}");
    let right: Vec<f64> = (0..u.len()).map(|i| (i as f64 + 0.3).sin()).collect();
    let solved = both.each_mut().map(|jacobian| {
        let mut x = right.clone();
        jacobian.solve(&mut x);
        x
    });
    are_near(&solved[0], &solved[1]);
    let solved = both.each_mut().map(|jacobian| {
        let mut x = right.clone();
        jacobian.solve_transposed(&mut x);
        x
    });
    are_near(&solved[0], &solved[1]);
    let steps = [&mut paired, &mut chained].map(|of| of.across(&u, &right).unwrap());
    are_near(&steps[0], &steps[1]);
    let maps = [&mut paired, &mut chained].map(|of| of.map(&u).unwrap());
    assert_eq!(maps[0], maps[1]);
}

#[test]
fn both_ways_to_eliminate_agree() {
    let held = chain(30, &[1.0], 1.0, 0.03);
    let whole = Recurrence::whole(1);
    both_ways_agree(&held, Variable::Omega, &whole);
    let names = held.facts().parameters.iter();
    let distance = names.map(|p| &p.name).position(|name| name == "distance");
    both_ways_agree(&held, Variable::Parameter(distance.unwrap()), &whole);
    let half = Recurrence {
        period: 1,
        parts: 2,
        image: SignedPermutation::minus(30),
    };
    both_ways_agree(&chain(30, &[1.0, -1.0], 1.0, 0.03), Variable::Omega, &half);
}

/// The mode in which all masses move alike is one that stays.
#[test]
fn both_ways_agree_where_a_mode_is_free() {
    let free = chain(30, &[1.0], 0.0, 0.02);
    both_ways_agree(&free, Variable::Omega, &Recurrence::whole(1));
}
