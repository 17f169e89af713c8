//! Exponent 3/2 in intrinsics of AVX-512: every second vector of square roots is computed by Newton's method from the
//! processor's estimate, so that the square-root unit and the multipliers work at the same time.
//!
//! From an estimate `y` of `1/sqrt a` to 14 bits, with `s = a y`, `q = y/2`,
//!
//! ```text
//! e = 1/2 - s q,   s <- s + s e,   q <- q + q e        (28 bits)
//! s <- s + q (a - s^2)                                 (below one unit in the last place)
//! ```
//!
//! Source: Markstein (2004), Software division and square root using Goldschmidt's algorithms. Unlike the square-root unit,
//! it needs `a` to be zero or well inside the range: at infinity it gives a NaN. A person who knows the gaps may accept
//! that; the generated code must not.

use std::arch::x86_64::{
    __m512d, _CMP_GT_OQ, _mm512_abs_pd, _mm512_cmp_pd_mask, _mm512_fmadd_pd, _mm512_fnmadd_pd,
    _mm512_loadu_pd, _mm512_maskz_mov_pd, _mm512_maskz_rsqrt14_pd, _mm512_mul_pd, _mm512_set1_pd,
    _mm512_setzero_pd, _mm512_sqrt_pd, _mm512_storeu_pd,
};

use hertzian::power::Instructions;

use super::dual::Sides;
use super::samples::Samples;

/// Runs the loop.
///
/// # Panics
/// If the processor lacks the instructions, or the samples are no multiple of sixteen.
pub fn run(sides: Sides, zeta: f64, samples: &mut Samples) {
    assert!(Instructions::Avx512.is_available());
    assert_eq!(samples.gap.len() % 16, 0);
    // SAFETY: the processor has the instructions, and all arrays of `Samples` have one length.
    unsafe {
        match sides {
            Sides::Both => both::<false>(zeta, samples),
            Sides::One => both::<true>(zeta, samples),
        }
    }
}

/// # Safety
/// The arrays have one length, a multiple of sixteen.
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
unsafe fn both<const ONE_SIDED: bool>(zeta: f64, samples: &mut Samples) {
    let damping = _mm512_set1_pd(2.0 * zeta);
    for first in (0..samples.gap.len()).step_by(16) {
        // SAFETY: `first + 16` samples are there.
        unsafe {
            group::<ONE_SIDED, false>(damping, samples, first);
            group::<ONE_SIDED, true>(damping, samples, first + 8);
        }
    }
}

/// # Safety
/// There are `at + 8` samples.
#[inline]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
unsafe fn group<const ONE_SIDED: bool, const NEWTON: bool>(
    damping: __m512d,
    samples: &mut Samples,
    at: usize,
) {
    // SAFETY: promised.
    let (gap, rate) = unsafe {
        (
            _mm512_loadu_pd(samples.gap.as_ptr().add(at)),
            _mm512_loadu_pd(samples.rate.as_ptr().add(at)),
        )
    };
    let (base, base_size, damping) = if ONE_SIDED {
        let above = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(gap, _mm512_setzero_pd());
        let penetration = _mm512_maskz_mov_pd(above, gap);
        (
            penetration,
            penetration,
            _mm512_maskz_mov_pd(above, damping),
        )
    } else {
        (gap, _mm512_abs_pd(gap), damping)
    };
    let root = if NEWTON {
        newton(base_size)
    } else {
        _mm512_sqrt_pd(base_size)
    };
    let force = _mm512_fmadd_pd(base, root, _mm512_mul_pd(damping, rate));
    let by_gap = _mm512_mul_pd(_mm512_set1_pd(1.5), root);
    // SAFETY: promised.
    unsafe {
        _mm512_storeu_pd(samples.force.as_mut_ptr().add(at), force);
        _mm512_storeu_pd(samples.by_gap.as_mut_ptr().add(at), by_gap);
        _mm512_storeu_pd(samples.by_rate.as_mut_ptr().add(at), damping);
    }
}

/// Square roots of numbers that are zero or far from the ends of the range.
#[inline]
#[target_feature(enable = "avx512f,fma")]
fn newton(a: __m512d) -> __m512d {
    let half = _mm512_set1_pd(0.5);
    let positive = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(a, _mm512_setzero_pd());
    let estimate = _mm512_maskz_rsqrt14_pd(positive, a);
    let (s, q) = (_mm512_mul_pd(a, estimate), _mm512_mul_pd(half, estimate));
    let e = _mm512_fnmadd_pd(s, q, half);
    let (s, q) = (_mm512_fmadd_pd(s, e, s), _mm512_fmadd_pd(q, e, q));
    _mm512_fmadd_pd(_mm512_fnmadd_pd(s, s, a), q, s)
}
