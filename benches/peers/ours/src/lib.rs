//! Two generated laws behind the C interface that all contenders share.

use std::ffi::{c_int, c_long};
use std::slice::{from_raw_parts, from_raw_parts_mut};

use hertzian::law;
use hertzian::law::{Derivatives, Law, On};

law! {
    /// A spring of exponent 3/2 of either sign, with damping.
    ThreeHalves(gap, zeta) {
        gap > 0 => 2*zeta*dot(gap) + gap^1.5,
        else    => 2*zeta*dot(gap) - (-gap)^1.5,
    }
}

law! {
    /// The same, the exponent an argument.
    Power(gap, zeta, alpha > 0) {
        gap > 0 => 2*zeta*dot(gap) + gap^alpha,
        else    => 2*zeta*dot(gap) - (-gap)^alpha,
    }
}

/// Exponent 3/2: force, by gap, by rate.
///
/// # Safety
/// Inputs and outputs have room for `count` numbers, and outputs do not overlap with anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn three_halves(
    gap: *const f64,
    rate: *const f64,
    zeta: f64,
    _alpha: f64,
    force: *mut f64,
    by_gap: *mut f64,
    by_rate: *mut f64,
    _by_alpha: *mut f64,
    count: c_long,
) {
    let count = count as usize;
    // SAFETY: promised.
    let (gap, rate, out) = unsafe {
        let out = [force, by_gap, by_rate].map(|out| from_raw_parts_mut(out, count));
        (from_raw_parts(gap, count), from_raw_parts(rate, count), out)
    };
    let [force, by_gap, by_rate] = out;
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    ThreeHalves.derivatives(On::AllPieces, &[zeta], gap, rate, out);
}

/// The exponent an argument: force, by gap, by rate, by the exponent.
///
/// # Safety
/// As [`three_halves`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn power(
    gap: *const f64,
    rate: *const f64,
    zeta: f64,
    alpha: f64,
    force: *mut f64,
    by_gap: *mut f64,
    by_rate: *mut f64,
    by_alpha: *mut f64,
    count: c_long,
) {
    let count = count as usize;
    // SAFETY: promised.
    let (gap, rate, out) = unsafe {
        let out = [force, by_gap, by_rate, by_alpha].map(|out| from_raw_parts_mut(out, count));
        (from_raw_parts(gap, count), from_raw_parts(rate, count), out)
    };
    let [force, by_gap, by_rate, by_alpha] = out;
    let out = Derivatives {
        force,
        by_gap,
        by_rate,
    };
    Power.derivatives_and_by(1, On::AllPieces, &[zeta, alpha], gap, rate, out, by_alpha);
}
