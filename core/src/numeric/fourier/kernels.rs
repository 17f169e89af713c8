//! The inner loops of exact switching: series at many phases, sums over many phases, products of series.
//!
//! Plain loops over lanes of eight, compiled once for each instruction set and chosen at run time. The order of every sum
//! is written out, and nothing is fused, so the results are the same on all of them.
//!
//! Harmonics at a phase follow from those before by rotation,
//!
//! ```text
//! cos k t = cos (k-1) t cos t - sin (k-1) t sin t,    sin k t = sin (k-1) t cos t + cos (k-1) t sin t        (1)
//! ```
//!
//! whose error grows as `k` rounding errors.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use std::array::from_fn;

use multiversion::multiversion;

/// Phases are handled in groups of this many; slices of phases have a multiple of it as their length.
pub(crate) const LANES: usize = 8;

/// `count` rounded up to whole groups of lanes.
pub(crate) const fn padded(count: usize) -> usize {
    count.div_ceil(LANES) * LANES
}

/// Groups whose values are computed at once.
const TOGETHER: usize = 2;

/// Harmonics that are summed in one pass over phases.
const BLOCK: usize = 4;

type Group = [f64; LANES];

fn group(of: &[f64], index: usize) -> Group {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&of[index * LANES..][..LANES]);
    lanes
}

/// Writes the values of two series of one length at phases given by their cosines and sines.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(crate) fn evaluate(
    series: [&[f64]; 2],
    cosines: &[f64],
    sines: &[f64],
    first: &mut [f64],
    second: &mut [f64],
) {
    // Of one group each harmonic waits for the one before; several groups keep the machine busy meanwhile.
    let groups = cosines.len() / LANES;
    let whole = groups / TOGETHER * TOGETHER;
    for index in (0..whole).step_by(TOGETHER) {
        evaluate_groups::<TOGETHER>(series, [cosines, sines], [first, second], index);
    }
    for index in whole..groups {
        evaluate_groups::<1>(series, [cosines, sines], [first, second], index);
    }
}

/// The same for `G` groups, the first of which is `index`.
#[inline(always)]
fn evaluate_groups<const G: usize>(
    [a, b]: [&[f64]; 2],
    [cosines, sines]: [&[f64]; 2],
    [first, second]: [&mut [f64]; 2],
    index: usize,
) {
    let cosine: [Group; G] = from_fn(|g| group(cosines, index + g));
    let sine: [Group; G] = from_fn(|g| group(sines, index + g));
    let (mut c, mut s) = ([[1.0; LANES]; G], [[0.0; LANES]; G]);
    let (mut x, mut y) = ([[a[0]; LANES]; G], [[b[0]; LANES]; G]);
    for (p, q) in a[1..].chunks_exact(2).zip(b[1..].chunks_exact(2)) {
        for g in 0..G {
            for lane in 0..LANES {
                let next = c[g][lane] * cosine[g][lane] - s[g][lane] * sine[g][lane];
                s[g][lane] = s[g][lane] * cosine[g][lane] + c[g][lane] * sine[g][lane];
                c[g][lane] = next;
                x[g][lane] += p[0] * c[g][lane] + p[1] * s[g][lane];
                y[g][lane] += q[0] * c[g][lane] + q[1] * s[g][lane];
            }
        }
    }
    for g in 0..G {
        first[(index + g) * LANES..][..LANES].copy_from_slice(&x[g]);
        second[(index + g) * LANES..][..LANES].copy_from_slice(&y[g]);
    }
}

/// Adds `sum_j value_j (1, 2 cos t_j, 2 sin t_j, 2 cos 2 t_j, ...)` to a series. `c` and `s` are workspace for as many phases.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(crate) fn project(
    values: &[f64],
    cosines: &[f64],
    sines: &[f64],
    c: &mut [f64],
    s: &mut [f64],
    series: &mut [f64],
) {
    let mut sum = [0.0; LANES];
    for index in 0..values.len() / LANES {
        let value = group(values, index);
        for lane in 0..LANES {
            sum[lane] += value[lane];
        }
    }
    series[0] += total(&sum);
    // The values take the place of the factor in (1), so that no product is left for the sum.
    for (to, value) in c.iter_mut().zip(values) {
        *to = 2.0 * value;
    }
    s[..values.len()].fill(0.0);
    // Of each group of phases several harmonics at once: loading and storing them takes as long as one.
    let (blocks, rest) = series[1..].as_chunks_mut::<{ 2 * BLOCK }>();
    for block in blocks {
        project_block::<BLOCK>([cosines, sines], [c, s], block);
    }
    for pair in rest.chunks_exact_mut(2) {
        project_block::<1>([cosines, sines], [c, s], pair);
    }
}

/// Adds the next `H` harmonics, and turns `c` and `s` on by as many.
#[inline(always)]
fn project_block<const H: usize>(
    [cosines, sines]: [&[f64]; 2],
    [c, s]: [&mut [f64]; 2],
    series: &mut [f64],
) {
    let mut x = [[0.0; LANES]; H];
    let mut y = [[0.0; LANES]; H];
    for index in 0..cosines.len() / LANES {
        let (cosine, sine) = (group(cosines, index), group(sines, index));
        let (mut old_c, mut old_s) = (group(c, index), group(s, index));
        for (x, y) in x.iter_mut().zip(&mut y) {
            let (mut new_c, mut new_s) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                new_c[lane] = old_c[lane] * cosine[lane] - old_s[lane] * sine[lane];
                new_s[lane] = old_s[lane] * cosine[lane] + old_c[lane] * sine[lane];
                x[lane] += new_c[lane];
                y[lane] += new_s[lane];
            }
            (old_c, old_s) = (new_c, new_s);
        }
        c[index * LANES..][..LANES].copy_from_slice(&old_c);
        s[index * LANES..][..LANES].copy_from_slice(&old_s);
    }
    for ((pair, x), y) in series.chunks_exact_mut(2).zip(&x).zip(&y) {
        pair[0] += total(x);
        pair[1] += total(y);
    }
}

fn total(lanes: &Group) -> f64 {
    ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3]))
        + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]))
}

/// Workspace for the product of two series of limited length.
#[derive(Debug, Clone, Default)]
pub(crate) struct Product {
    x: [Vec<f64>; 2],
    y: [Vec<f64>; 2],
}

impl Product {
    /// Adds `a(tau) b(tau)` to `sum`, dropping harmonics above those of `sum`.
    ///
    /// With `a = sum X_j e^(i j tau)` and `b = sum Y_m e^(i m tau)`, both real, harmonic `l` of the product is
    /// `sum_m conj(Y_m) X_(l + m)`.
    pub(crate) fn add(&mut self, a: &[f64], b: &[f64], sum: &mut [f64]) {
        let (reach, width) = (sum.len() / 2, b.len() / 2);
        spread(a, reach + width, &mut self.x);
        spread(b, width, &mut self.y);
        convolve(&self.x, &self.y, 2 * width + 1, sum);
    }
}

/// Writes the coefficients of `e^(i j tau)` for `j` from `-reach` to `reach`, real and imaginary parts, and zeros after them
/// for the last group of lanes to read.
fn spread(series: &[f64], reach: usize, to: &mut [Vec<f64>; 2]) {
    let [re, im] = to;
    for part in [&mut *re, &mut *im] {
        part.clear();
        part.resize(2 * reach + 1 + LANES, 0.0);
    }
    re[reach] = series[0];
    for (index, pair) in series[1..].chunks_exact(2).take(reach).enumerate() {
        let j = index + 1;
        re[reach + j] = 0.5 * pair[0];
        re[reach - j] = 0.5 * pair[0];
        im[reach + j] = -0.5 * pair[1];
        im[reach - j] = 0.5 * pair[1];
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn convolve(x: &[Vec<f64>; 2], y: &[Vec<f64>; 2], order: usize, sum: &mut [f64]) {
    let [yr, yi] = y;
    // X starts at -(reach + width), Y at -width: at harmonic l they are `reach + l` apart.
    let reach = sum.len() / 2;
    for first in (0..=reach).step_by(LANES) {
        let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
        let (xr, xi) = (&x[0][reach + first..], &x[1][reach + first..]);
        for m in 0..order {
            let (a, b) = (yr[m], yi[m]);
            let (r, i) = (&xr[m..m + LANES], &xi[m..m + LANES]);
            for lane in 0..LANES {
                re[lane] += a * r[lane] + b * i[lane];
                im[lane] += a * i[lane] - b * r[lane];
            }
        }
        for l in first..=reach.min(first + LANES - 1) {
            if l == 0 {
                sum[0] += re[0];
            } else {
                sum[2 * l - 1] += 2.0 * re[l - first];
                sum[2 * l] -= 2.0 * im[l - first];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::fourier::series;
    use proptest::prelude::*;

    fn any_series() -> impl Strategy<Value = Vec<f64>> {
        (0_usize..20).prop_flat_map(|k| prop::collection::vec(-1.0..1.0, series::length(k)))
    }

    proptest! {
        #[test]
        fn evaluates_and_projects_as_the_sums_do(
            a in any_series(), taus in prop::collection::vec(0.0..6.3_f64, 3 * LANES), groups in 1_usize..4,
        ) {
            let taus = &taus[..groups * LANES];
            let (sines, cosines): (Vec<f64>, Vec<f64>) = taus.iter().map(|t| t.sin_cos()).unzip();
            let mut b = a.clone();
            series::differentiate(&a, &mut b);
            let (mut x, mut y) = (vec![0.0; taus.len()], vec![0.0; taus.len()]);
            evaluate([&a, &b], &cosines, &sines, &mut x, &mut y);
            let (mut c, mut s) = (vec![0.0; taus.len()], vec![0.0; taus.len()]);
            let mut sums = vec![0.0; a.len()];
            project(&x, &cosines, &sines, &mut c, &mut s, &mut sums);
            let mut expected = vec![0.0; a.len()];
            for (j, tau) in taus.iter().enumerate() {
                let (value, slope, _) = series::value_and_derivatives(&a, *tau);
                prop_assert!((x[j] - value).abs() < 1e-13);
                prop_assert!((y[j] - slope).abs() < 1e-11);
                for (index, sum) in expected.iter_mut().enumerate() {
                    let mut unit = vec![0.0; a.len()];
                    unit[index] = if index == 0 { 1.0 } else { 2.0 };
                    *sum += value * series::value(&unit, *tau);
                }
            }
            for (x, y) in sums.iter().zip(&expected) {
                prop_assert!((x - y).abs() < 1e-11);
            }
        }

        #[test]
        fn product_is_the_product(a in any_series(), b in any_series(), k in 0_usize..45, tau in 0.0..6.0_f64) {
            let mut product = Product::default();
            let all = a.len() / 2 + b.len() / 2;
            let mut sum = vec![0.0; series::length(all)];
            product.add(&a, &b, &mut sum);
            let expected = series::value(&a, tau) * series::value(&b, tau);
            prop_assert!((series::value(&sum, tau) - expected).abs() < 1e-12);
            // Fewer or more harmonics leave the others as they are.
            let mut part = vec![0.0; series::length(k)];
            product.add(&a, &b, &mut part);
            for (index, x) in part.iter().enumerate() {
                let y = sum.get(index).copied().unwrap_or(0.0);
                prop_assert!((x - y).abs() < 1e-13);
            }
        }
    }
}
