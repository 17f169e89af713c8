//! Exponent 3/2 written by hand: a loop over structure of arrays that a compiler vectorises, compiled for each instruction
//! set. What AVX-512 allows beyond that is in `newton`.

use hertzian::power::Instructions;

use super::dual::Sides;
use super::samples::Samples;

/// `FUSED`: products and sums in one operation, where the processor has it.
#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled anew for each set")]
fn continuous<const FUSED: bool>(
    zeta: f64,
    [gap, rate]: [&[f64]; 2],
    force: &mut [f64],
    by_gap: &mut [f64],
    by_rate: &mut [f64],
) {
    let count = gap.len();
    let (rate, force) = (&rate[..count], &mut force[..count]);
    let (by_gap, by_rate) = (&mut by_gap[..count], &mut by_rate[..count]);
    let damping = 2.0 * zeta;
    for i in 0..count {
        let root = gap[i].abs().sqrt();
        force[i] = multiply_add::<FUSED>(gap[i], root, damping * rate[i]);
        by_gap[i] = 1.5 * root;
        by_rate[i] = damping;
    }
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "compiled anew for each set")]
fn one_sided<const FUSED: bool>(
    zeta: f64,
    [gap, rate]: [&[f64]; 2],
    force: &mut [f64],
    by_gap: &mut [f64],
    by_rate: &mut [f64],
) {
    let count = gap.len();
    let (rate, force) = (&rate[..count], &mut force[..count]);
    let (by_gap, by_rate) = (&mut by_gap[..count], &mut by_rate[..count]);
    for i in 0..count {
        let penetration = if gap[i] > 0.0 { gap[i] } else { 0.0 };
        let damping = if gap[i] > 0.0 { 2.0 * zeta } else { 0.0 };
        let root = penetration.sqrt();
        force[i] = multiply_add::<FUSED>(penetration, root, damping * rate[i]);
        by_gap[i] = 1.5 * root;
        by_rate[i] = damping;
    }
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "one operation")]
fn multiply_add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Compiles a loop for one instruction set.
macro_rules! clone {
    ($name:ident, $of:ident, $fused:literal $(, $features:literal)?) => {
        $(
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = $features)]
        )?
        fn $name(
            zeta: f64,
            inputs: [&[f64]; 2],
            force: &mut [f64],
            by_gap: &mut [f64],
            by_rate: &mut [f64],
        ) {
            $of::<$fused>(zeta, inputs, force, by_gap, by_rate);
        }
    };
}

clone!(continuous_baseline, continuous, false);
clone!(continuous_avx2, continuous, true, "avx2,fma");
clone!(
    continuous_avx512,
    continuous,
    true,
    "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw"
);
clone!(one_sided_baseline, one_sided, false);
clone!(one_sided_avx2, one_sided, true, "avx2,fma");
clone!(
    one_sided_avx512,
    one_sided,
    true,
    "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw"
);

/// Runs the loop that was compiled for an instruction set.
pub fn run(sides: Sides, instructions: Instructions, zeta: f64, samples: &mut Samples) {
    let Samples {
        gap,
        rate,
        force,
        by_gap,
        by_rate,
        ..
    } = samples;
    let inputs = [*gap, *rate];
    let one = sides == Sides::One;
    assert!(instructions.is_available());
    match instructions {
        Instructions::Baseline if one => one_sided_baseline(zeta, inputs, force, by_gap, by_rate),
        Instructions::Baseline => continuous_baseline(zeta, inputs, force, by_gap, by_rate),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has the instructions.
        Instructions::Avx2 => unsafe {
            let clone = if one { one_sided_avx2 } else { continuous_avx2 };
            clone(zeta, inputs, force, by_gap, by_rate);
        },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the processor has the instructions.
        Instructions::Avx512 => unsafe {
            let clone = if one {
                one_sided_avx512
            } else {
                continuous_avx512
            };
            clone(zeta, inputs, force, by_gap, by_rate);
        },
        _ => unreachable!("no clone for them"),
    }
}
