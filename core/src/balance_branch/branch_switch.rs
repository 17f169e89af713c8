//! From an event of a branch of the balance onto the branch that begins there.
//!
//! At the event the block of harmonics that the orbits do not have is singular ([`critical_block`](crate::balance::critical_block)). Its null vector is the
//! direction of the new branch, which leaves the old one at a right angle: for a step `e` the parameter changes by `e^2` only.
//! So the first orbit is solved for with its component in that direction held. Where two branches of orbits with the same harmonics
//! cross, the null vector is across the tangent of the known one, which has no component there but by its curvature; the other one
//! has, at whatever angle it crosses.
//!
//! Source: Govaerts (2000), Numerical Methods for Bifurcations of Dynamical Equilibria, chapter 8 (branch switching); Detroux,
//! Renson, Masset and Kerschen (2015), The harmonic balance method for bifurcation analysis, section 4.

use crate::balance::Parity;
use crate::balance::critical_block::Part;
use crate::balance::resolution::resize;
use crate::balance_branch::context::BranchContext;
use crate::branches::branch_start::BranchSwitch;
use crate::branches::error::OrbitError;
use crate::branches::point::Event;
use crate::continuation::follow::CurvePoint;
use crate::continuation::newton::Newton;
use crate::continuation::problem::{Norm, Scale};
use crate::error::Error;
use crate::event::EventKind;
use crate::numeric::fourier::series;

/// Components of the first orbit in the direction of the new branch, in units of the orbit's size: the first that leads to an
/// orbit of the new branch is taken.
const FIRST_STEPS: [f64; 4] = [0.02, 0.05, 0.01, 0.1];

/// Which part of the Jacobian is singular at an event, and the parity of the harmonics that its orbits have; `None` if no branch begins
/// there. The harmonics of the old branch are multiples of a stride.
fn critical(event: &Event, stride: usize) -> Option<(Part, Parity)> {
    Some(match event.kind {
        EventKind::PeriodDoubling => (Part::doubled(stride), Parity::All),
        EventKind::BranchPoint | EventKind::SymmetryBreaking if !event.tangent.is_empty() => {
            (Part::Own, Parity::All)
        }
        EventKind::SymmetryBreaking => (Part::Even, Parity::Odd),
        _ => return None,
    })
}

/// The first orbit of the branch that begins at an event, with its direction, in the resolution of the new branch's context. The
/// harmonics of the old branch are multiples of a stride.
///
/// # Errors
/// [`OrbitError::NoBranch`] if no branch begins there, or its first orbit was not found.
pub(crate) fn switch_branch(
    context: &BranchContext,
    event: &Event,
    stride: usize,
    side: f64,
) -> Result<CurvePoint, Error> {
    let nothing = OrbitError::NoBranch {
        kind: event.kind,
        value: event.point.value,
    };
    let orbit = &event.point.orbit;
    let mut u = orbit.series.clone();
    u.push(event.point.value);
    let Some((part, parity)) = critical(event, stride) else {
        return Err(nothing.into());
    };
    let mut old = context.with_harmonics(orbit.harmonics(), orbit.harmonics());
    (old.parity, old.stride, old.period) = (parity, stride, orbit.period);
    let (on_block, direction) = context.block(part, old).null_vector(&u, &event.tangent);
    let harmonics = context.resolution.harmonics;
    let of_branch = |u: &[f64]| resize(u, orbit.coordinates, series::length(harmonics));
    let (start, mut direction) = (of_branch(&on_block), of_branch(&direction));
    let mut balance = context.balance(context.with_harmonics(harmonics, harmonics));
    let mut newton = Newton::new(&balance);
    let range = (context.to - context.from).abs();
    if part == Part::Own {
        let scale = newton.norm().scale_at(&start, range, &mut [0.0; 2]);
        let tangent = of_branch(&event.tangent);
        take_out(newton.norm(), scale, &tangent, &mut direction);
    }
    for part in FIRST_STEPS {
        let scale = newton.norm().scale_at(&start, range, &mut [0.0; 2]);
        let length = newton.norm().length(scale, &direction);
        let unit: Vec<f64> = direction.iter().map(|x| x / length).collect();
        let mut row = vec![0.0; unit.len()];
        newton.norm().linear_form(scale, &unit, &mut row);
        let switch = BranchSwitch {
            from: &start,
            along: &unit,
            held: &row,
            scale,
        };
        let options = context.newton;
        let first = switch.first_point(&mut balance, &mut newton, side * part, options);
        if let Some(first) = first {
            return Ok(first);
        }
    }
    Err(nothing.into())
}

/// Takes the component along a tangent out of a direction.
fn take_out(norm: &Norm, scale: Scale, tangent: &[f64], direction: &mut [f64]) {
    let along = norm.product(scale, direction, tangent);
    let part = along / norm.product(scale, tangent, tangent);
    for (x, t) in direction.iter_mut().zip(tangent) {
        *x -= part * t;
    }
}
