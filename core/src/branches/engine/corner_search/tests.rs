//! The way to a corner along an arc, which bends with the root of the height `h` as a branch does beyond a level, and on which some heights have no orbit:
//!
//! ```text
//! y = sin a,    lambda = 1 - cos a,    a = b (h / H)^(1/2)                                                     (1)
//! ```
//!
//! Heights are so small that the tangent goes along `(cos a, sin a)`.

use super::{Approach, Beside, Corner, CornerSearch, Reached};
use crate::branches::extreme::Extreme;
use crate::branches::problem::{
    BranchProblem, Change, Read, TestValue, Watched, Zero, ZeroOutcome,
};
use crate::branches::record::Record;
use crate::continuation::follow::{CurvePoint, Step};
use crate::continuation::jacobian::Jacobian;
use crate::continuation::locate::Located;
use crate::continuation::newton::{Newton, NewtonOptions};
use crate::continuation::problem::{Problem, Scale};

/// `H`, where the search comes from.
const HEIGHT: f64 = 2e-3;

/// (1), with `h` and `y` as unknowns.
struct Arc {
    /// `b`
    bend: f64,
    /// Between these heights there is no orbit.
    hole: [f64; 2],
    record: Record,
}

impl Arc {
    /// `a`
    fn angle(&self, height: f64) -> f64 {
        self.bend * (height.max(0.0) / HEIGHT).sqrt()
    }

    /// The solution at a height, with the tangent towards the level.
    fn at(&self, height: f64) -> CurvePoint {
        let (sine, cosine) = self.angle(height).sin_cos();
        CurvePoint {
            u: vec![height, sine, 1.0 - cosine],
            tangent: vec![0.0, -cosine, -sine],
            scale: Scale::UNIT,
        }
    }

    /// An extreme beyond its level.
    fn extreme(height: f64) -> Extreme {
        Extreme {
            maximum: true,
            above: height,
            ..Extreme::of(0, 0, 1.0, true)
        }
    }
}

impl Problem for Arc {
    fn unknowns(&self) -> usize {
        2
    }

    fn evaluate(&mut self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut Jacobian>) {
        let [height, y, parameter] = [u[0], u[1], u[2]];
        let (sine, cosine) = self.angle(height).sin_cos();
        residual[0] = y - sine;
        residual[1] = parameter - (1.0 - cosine);
        if height > self.hole[0] && height < self.hole[1] {
            residual.fill(f64::NAN);
        }
        let Some(jacobian) = jacobian else { return };
        let slope = self.angle(height) / (2.0 * height);
        jacobian.core_mut().row_mut(0)[0] = -cosine * slope;
        jacobian.core_mut().row_mut(0)[1] = 1.0;
        jacobian.core_mut().row_mut(1)[0] = -sine * slope;
        jacobian.set_column(&[0.0, 1.0]);
    }

    fn weights(&self, weights: &mut [f64]) {
        weights.fill(1.0);
    }

    fn is_mean(&self, _: usize) -> bool {
        false
    }
}

impl BranchProblem for Arc {
    fn equations(&mut self) -> &mut dyn Problem {
        self
    }

    fn watched(&self) -> &[Watched] {
        &[]
    }

    fn test(&mut self, _: usize, _: &CurvePoint) -> TestValue {
        TestValue::UNKNOWN
    }

    fn aim(&self) -> f64 {
        1e-12
    }

    fn vanishes(&mut self, _: Change, _: &Located) -> bool {
        false
    }

    fn record(&self) -> &Record {
        &self.record
    }

    fn record_mut(&mut self) -> &mut Record {
        &mut self.record
    }

    fn read(&mut self, _: &mut Newton, _: &CurvePoint) -> Read {
        Read::Kept
    }

    fn keep(&mut self, _: &mut Newton, _: Step<'_>, _: &Zero) -> ZeroOutcome {
        ZeroOutcome::Nothing
    }

    fn extremes(&mut self, u: &[f64], extremes: &mut Vec<Extreme>) -> bool {
        extremes.push(Self::extreme(u[0]));
        true
    }

    fn extreme_form(&mut self, _: &[f64], _: &Extreme, _: f64, form: &mut [f64]) -> bool {
        form.copy_from_slice(&[1.0, 0.0, 0.0]);
        true
    }

    fn lifted(&mut self, _: &[f64], _: &Extreme, height: f64) -> Option<Vec<f64>> {
        Some(self.at(height).u)
    }

    fn count(&mut self, _: &Newton) {}
}

/// Orbits on the way to the touch.
fn way(bend: f64, hole: [f64; 2]) -> Option<Vec<Beside>> {
    let mut arc = Arc {
        bend,
        hole,
        record: Record::default(),
    };
    let [from, touch] = [arc.at(HEIGHT), arc.at(0.0)];
    let located = Located {
        point: touch.clone(),
        test: 0.0,
        vanishes: true,
        jump: 0.0,
    };
    let corner = Corner {
        touch: Reached {
            located,
            extreme: Arc::extreme(0.0),
            error: 0.0,
            rate: 1.0,
        },
        end: touch.clone(),
        begin: touch,
        crossed: Arc::extreme(0.0),
        way: Vec::new(),
        forwards: -1.0,
    };
    let mut newton = Newton::new(&arc);
    let mut search = CornerSearch {
        problem: &mut arc,
        newton: &mut newton,
        options: NewtonOptions {
            tolerance: 1e-11,
            iterations: 12,
            damped: false,
        },
        range: [-1.0, 3.0],
        approach: Approach {
            from: &from,
            extreme: Arc::extreme(HEIGHT),
            farthest: 10.0,
        },
    };
    search.way(&corner, HEIGHT)
}

/// The orbits are those of (1) at these parts of the height, and the arc bends by less than a right angle from each to the next.
fn assert_way(found: &[Beside], bend: f64, parts: &[f64]) {
    let heights: Vec<f64> = found.iter().map(|beside| beside.extreme.above).collect();
    assert_eq!(found.len(), parts.len(), "{heights:?}");
    let mut before = bend;
    for (beside, part) in found.iter().zip(parts) {
        let height = part * HEIGHT;
        assert!(
            (beside.extreme.above / height - 1.0).abs() < 1e-9,
            "{heights:?}"
        );
        let angle = bend * part.sqrt();
        assert!((beside.point.u[1] - angle.sin()).abs() < 1e-10);
        let along = beside.point.tangent[1] * angle.cos() + beside.point.tangent[2] * angle.sin();
        assert!(along < -0.99, "{along}");
        assert!(before - angle < std::f64::consts::FRAC_PI_2);
        before = angle;
    }
}

const NOWHERE: [f64; 2] = [1.0, 1.0];

#[test]
fn orbits_are_a_tenth_as_high_each() {
    let bend = 0.5;
    let found = way(bend, NOWHERE).unwrap();
    assert_way(&found, bend, &[1e-1, 1e-2, 1e-3, 1e-4]);
}

/// To a tenth of the height the arc bends by 2.6 times `1 - 0.1^(1/2)`, more than a right angle.
#[test]
fn where_the_branch_bends_there_is_another_orbit_between_two() {
    let bend = 2.6;
    let part = 0.1_f64.sqrt();
    let parts = [1.0, 1e-1, 1e-2, 1e-3].map(|tenth| tenth * part);
    assert_way(&way(bend, NOWHERE).unwrap(), bend, &parts);
}

#[test]
fn heights_without_an_orbit_are_passed() {
    let bend = 0.5;
    let found = way(bend, [5e-6, 5e-5]).unwrap();
    assert_way(&found, bend, &[1e-1, 1e-3, 1e-4]);
}

/// Over the heights without an orbit it bends by more than a right angle: the search for one between them comes to an end.
#[test]
fn where_no_orbit_leads_on_there_is_no_way() {
    assert!(way(2.6, [3e-6, 1.9e-3]).is_none());
}
