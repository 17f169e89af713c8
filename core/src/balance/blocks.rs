//! Blocks of the Jacobian: multiplication by a periodic function as Toeplitz plus Hankel.

use std::collections::BTreeMap;

use super::harmonics::Harmonics;
use crate::continuation::jacobian::Jacobian;
use crate::model::layout::Layout;
use crate::numeric::fourier::series;
use crate::numeric::linear::Matrix;
use crate::system::Wave;

/// The part of the Jacobian that couples one equation to one coordinate.
#[derive(Debug)]
pub(super) struct Block {
    row: usize,
    column: usize,
    /// Series that multiplies the coordinate: `S`.
    stiffness: Vec<f64>,
    /// Series that multiplies its phase derivative: `Omega T`.
    damping: Vec<f64>,
    /// Both are nothing but a mean: no contact, no wave.
    constant: bool,
}

/// The blocks that a system can fill, cleared, with series of `reach` harmonics, row by row.
pub(super) fn of_layout(layout: &Layout, reach: usize) -> Vec<Block> {
    let mut constants = BTreeMap::new();
    let mut fills = |row: usize, column: usize, constant: bool| {
        *constants.entry((row, column)).or_insert(true) &= constant;
    };
    for entry in layout.stiffness.iter().chain(&layout.damping) {
        fills(entry.row, entry.column, entry.wave == Wave::CONSTANT);
    }
    for contact in &layout.contacts {
        for e in &contact.force {
            for d in &contact.gap {
                fills(e.index, d.index, false);
            }
        }
    }
    let zeros = || vec![0.0; series::length(reach)];
    let block = |((row, column), constant)| Block {
        row,
        column,
        stiffness: zeros(),
        damping: zeros(),
        constant,
    };
    constants.into_iter().map(block).collect()
}

/// The block of an equation and a coordinate, among blocks row by row.
pub(super) fn find(blocks: &mut [Block], row: usize, column: usize) -> Option<&mut Block> {
    let place = |block: &Block| (block.row, block.column);
    let found = blocks.binary_search_by_key(&(row, column), place).ok()?;
    Some(&mut blocks[found])
}

impl Block {
    pub(super) fn clear(&mut self) {
        self.stiffness.fill(0.0);
        self.damping.fill(0.0);
    }

    /// The series that couple harmonics.
    pub(super) fn series_mut(&mut self) -> [&mut [f64]; 2] {
        [&mut self.stiffness, &mut self.damping]
    }

    /// The equation, and how strongly harmonics are coupled in it: the largest coefficient of the stiffness but the mean, or
    /// what the mean would make of it if contact came and went. Zero without a contact or a wave.
    pub(super) fn coupling(&self) -> (usize, f64) {
        if self.constant {
            return (self.row, 0.0);
        }
        let waves = self.stiffness[1..]
            .chunks_exact(2)
            .map(|pair| pair[0].hypot(pair[1]));
        let mean = std::f64::consts::FRAC_2_PI * self.stiffness[0].abs();
        (self.row, waves.fold(mean, f64::max))
    }

    /// Adds an entry of `K` or, times the base frequency, of `C`.
    pub(super) fn add_stiffness(&mut self, wave: Wave, value: f64) {
        series::add_wave(
            &mut self.stiffness,
            wave.harmonic as usize,
            wave.part,
            value,
        );
    }

    pub(super) fn add_damping(&mut self, value: f64) {
        self.damping[0] += value;
    }

    /// Adds `e factor phi_g d` to `S`.
    pub(super) fn add_by_gap(
        &mut self,
        by_gap: &[f64],
        e: Wave,
        d: Wave,
        factor: f64,
        workspace: &mut [f64],
    ) {
        add_twice(by_gap, e, d, factor, &mut self.stiffness, workspace);
    }

    /// Adds `Omega factor phi_r e D d` to `S` and `Omega factor phi_r e d` to `Omega T`.
    pub(super) fn add_by_rate(
        &mut self,
        by_rate: &[f64],
        e: Wave,
        d: Wave,
        factor: f64,
        workspace: &mut [f64],
    ) {
        add_twice(by_rate, e, d, factor, &mut self.damping, workspace);
        if d.harmonic > 0 {
            let (slope, sign) = d.derivative();
            let factor = factor * sign * f64::from(d.harmonic);
            add_twice(by_rate, e, slope, factor, &mut self.stiffness, workspace);
        }
    }

    /// Adds the block to the Jacobian, by (2) of [`balance`](super).
    pub(super) fn add_to(&self, harmonics: &Harmonics, jacobian: &mut Jacobian) {
        self.add_to_core(&harmonics.core, jacobian.core_mut());
        for (group, &k) in harmonics.tail.iter().enumerate() {
            self.add_to_group(k, jacobian.group_mut(group));
            if !self.constant {
                let (cosine, sine) = jacobian.two_coupling_rows_mut(group, 2 * self.row);
                let length = places(&harmonics.core);
                let part = self.column * length..(self.column + 1) * length;
                self.add_rows(
                    k,
                    &harmonics.core,
                    &mut cosine[part.clone()],
                    &mut sine[part],
                );
            }
        }
    }

    fn add_to_core(&self, harmonics: &[usize], core: &mut Matrix) {
        let length = places(harmonics);
        let (top, left) = (self.row * length, self.column * length);
        if self.constant {
            let mut place = 0;
            for &l in harmonics {
                self.add_diagonal(l, core, top + place, left + place);
                place += if l == 0 { 1 } else { 2 };
            }
            return;
        }
        let mut place = top;
        for &l in harmonics {
            if l == 0 {
                let row = &mut core.row_mut(place)[left..][..length];
                self.add_mean_row(harmonics, row);
                place += 1;
                continue;
            }
            let (cosine, sine) = core.two_rows_mut(place, place + 1);
            let cosine = &mut cosine[left..][..length];
            let sine = &mut sine[left..][..length];
            self.add_rows(l, harmonics, cosine, sine);
            place += 2;
        }
    }

    /// The two rows of a harmonic that is not zero, over harmonics of the core.
    fn add_rows(&self, l: usize, harmonics: &[usize], cosine: &mut [f64], sine: &mut [f64]) {
        let mut column = 0;
        for &m in harmonics {
            if m == 0 {
                cosine[0] += self.stiffness[2 * l - 1];
                sine[0] += self.stiffness[2 * l];
                column += 1;
                continue;
            }
            self.add_pair(
                l,
                m,
                &mut cosine[column..column + 2],
                &mut sine[column..column + 2],
            );
            column += 2;
        }
    }

    fn add_mean_row(&self, harmonics: &[usize], row: &mut [f64]) {
        let mut column = 0;
        for &m in harmonics {
            if m == 0 {
                row[0] += self.stiffness[0];
                column += 1;
                continue;
            }
            let (c, s) = (0.5 * self.stiffness[2 * m - 1], 0.5 * self.stiffness[2 * m]);
            let (tc, ts) = (0.5 * self.damping[2 * m - 1], 0.5 * self.damping[2 * m]);
            row[column] += c - m as f64 * ts;
            row[column + 1] += s + m as f64 * tc;
            column += 2;
        }
    }

    /// The two by two entries of harmonics `l` (row) and `m` (column), neither zero.
    #[inline]
    fn add_pair(&self, l: usize, m: usize, cosine: &mut [f64], sine: &mut [f64]) {
        let (sum, difference) = (2 * (l + m), 2 * l.abs_diff(m));
        let sign = if m > l { -0.5 } else { 0.5 };
        let s = projections(&self.stiffness, sum, difference, sign);
        let t = projections(&self.damping, sum, difference, sign);
        // The phase derivative of the column cos m is -m sin m, and of sin m it is m cos m.
        let m = m as f64;
        cosine[0] += s.cos_cos - m * t.cos_sin;
        cosine[1] += s.cos_sin + m * t.cos_cos;
        sine[0] += s.sin_cos - m * t.sin_sin;
        sine[1] += s.sin_sin + m * t.sin_cos;
    }

    /// What a mean stiffness and damping do to one harmonic.
    fn add_diagonal(&self, m: usize, matrix: &mut Matrix, row: usize, column: usize) {
        let (s, t) = (self.stiffness[0], self.damping[0]);
        matrix.row_mut(row)[column] += s;
        if m > 0 {
            matrix.row_mut(row)[column + 1] += m as f64 * t;
            matrix.row_mut(row + 1)[column] -= m as f64 * t;
            matrix.row_mut(row + 1)[column + 1] += s;
        }
    }

    /// Among the tail a harmonic is coupled to itself alone, through the means.
    fn add_to_group(&self, k: usize, group: &mut Matrix) {
        let (row, column) = (2 * self.row, 2 * self.column);
        self.add_diagonal(k, group, row, column);
    }
}

/// Number of unknowns that harmonics of one coordinate make.
pub(super) fn places(harmonics: &[usize]) -> usize {
    harmonics.iter().map(|&k| if k == 0 { 1 } else { 2 }).sum()
}

/// `2 <S cos l cos m>` and its companions.
struct Projections {
    cos_cos: f64,
    cos_sin: f64,
    sin_cos: f64,
    sin_sin: f64,
}

/// By the places of the sine of `l + m` and of `|l - m|`, and half the sign of `l - m`.
#[inline]
fn projections(series: &[f64], sum: usize, difference: usize, sign: f64) -> Projections {
    let (sum_c, sum_s) = (0.5 * series[sum - 1], 0.5 * series[sum]);
    let (difference_c, difference_s) = if difference == 0 {
        (series[0], 0.0)
    } else {
        (0.5 * series[difference - 1], sign * series[difference])
    };
    Projections {
        cos_cos: difference_c + sum_c,
        cos_sin: sum_s - difference_s,
        sin_cos: sum_s + difference_s,
        sin_sin: difference_c - sum_c,
    }
}

/// Adds `factor e(tau) d(tau) series(tau)`.
fn add_twice(from: &[f64], e: Wave, d: Wave, factor: f64, to: &mut [f64], workspace: &mut [f64]) {
    if factor == 0.0 {
        return;
    }
    if d.harmonic == 0 {
        series::add_product(from, e, factor, to);
    } else {
        workspace.fill(0.0);
        series::add_product(from, d, factor, workspace);
        series::add_product(workspace, e, 1.0, to);
    }
}
