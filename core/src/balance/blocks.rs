//! Blocks of the Jacobian: multiplication by a periodic function as Toeplitz plus Hankel.

use crate::fourier::series;
use crate::layout::Layout;
use crate::linear::Matrix;
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

/// The blocks that a system can fill, cleared.
pub(super) fn of_layout(layout: &Layout, harmonics: usize) -> Vec<Block> {
    let mut blocks = Vec::new();
    for entry in layout.stiffness.iter().chain(&layout.damping) {
        find_or_add(
            &mut blocks,
            entry.row,
            entry.column,
            entry.wave == Wave::CONSTANT,
            harmonics,
        );
    }
    for contact in &layout.contacts {
        for e in &contact.force {
            for d in &contact.gap {
                find_or_add(&mut blocks, e.index, d.index, false, harmonics);
            }
        }
    }
    blocks
}

fn find_or_add(
    blocks: &mut Vec<Block>,
    row: usize,
    column: usize,
    constant: bool,
    harmonics: usize,
) {
    if let Some(block) = find(blocks, row, column) {
        block.constant &= constant;
        return;
    }
    let length = series::length(2 * harmonics);
    let zeros = || vec![0.0; length];
    blocks.push(Block {
        row,
        column,
        stiffness: zeros(),
        damping: zeros(),
        constant,
    });
}

/// The block of an equation and a coordinate.
pub(super) fn find(blocks: &mut [Block], row: usize, column: usize) -> Option<&mut Block> {
    blocks
        .iter_mut()
        .find(|block| (block.row, block.column) == (row, column))
}

impl Block {
    pub(super) fn clear(&mut self) {
        self.stiffness.fill(0.0);
        self.damping.fill(0.0);
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
        room: &mut [f64],
    ) {
        add_twice(by_gap, e, d, factor, &mut self.stiffness, room);
    }

    /// Adds `Omega factor phi_r e D d` to `S` and `Omega factor phi_r e d` to `Omega T`.
    pub(super) fn add_by_rate(
        &mut self,
        by_rate: &[f64],
        e: Wave,
        d: Wave,
        factor: f64,
        room: &mut [f64],
    ) {
        add_twice(by_rate, e, d, factor, &mut self.damping, room);
        if d.harmonic > 0 {
            let (slope, sign) = d.derivative();
            let factor = factor * sign * f64::from(d.harmonic);
            add_twice(by_rate, e, slope, factor, &mut self.stiffness, room);
        }
    }

    /// Adds the block to the Jacobian, by (2) of [`balance`](super).
    pub(super) fn add_to(&self, harmonics: usize, jacobian: &mut Matrix) {
        let length = series::length(harmonics);
        let (top, left) = (self.row * length, self.column * length);
        jacobian.row_mut(top)[left] += self.stiffness[0];
        if self.constant {
            self.add_diagonal(harmonics, top, left, jacobian);
            return;
        }
        self.add_mean_row(harmonics, &mut jacobian.row_mut(top)[left..][..length]);
        for l in 1..=harmonics {
            let (cosine, sine) = jacobian.two_rows_mut(top + 2 * l - 1, top + 2 * l);
            let cosine = &mut cosine[left..][..length];
            let sine = &mut sine[left..][..length];
            cosine[0] += self.stiffness[2 * l - 1];
            sine[0] += self.stiffness[2 * l];
            for m in 1..=harmonics {
                self.add_pair(
                    l,
                    m,
                    &mut cosine[2 * m - 1..=2 * m],
                    &mut sine[2 * m - 1..=2 * m],
                );
            }
        }
    }

    fn add_mean_row(&self, harmonics: usize, row: &mut [f64]) {
        for m in 1..=harmonics {
            let (c, s) = (0.5 * self.stiffness[2 * m - 1], 0.5 * self.stiffness[2 * m]);
            let (tc, ts) = (0.5 * self.damping[2 * m - 1], 0.5 * self.damping[2 * m]);
            row[2 * m - 1] += c - m as f64 * ts;
            row[2 * m] += s + m as f64 * tc;
        }
    }

    /// The two by two entries of harmonics `l` (row) and `m` (column), neither zero.
    #[inline]
    fn add_pair(&self, l: usize, m: usize, cosine: &mut [f64], sine: &mut [f64]) {
        let s = projections(&self.stiffness, l, m);
        let t = projections(&self.damping, l, m);
        // The phase derivative of the column cos m is -m sin m, and of sin m it is m cos m.
        let m = m as f64;
        cosine[0] += s.cos_cos - m * t.cos_sin;
        cosine[1] += s.cos_sin + m * t.cos_cos;
        sine[0] += s.sin_cos - m * t.sin_sin;
        sine[1] += s.sin_sin + m * t.sin_cos;
    }

    fn add_diagonal(&self, harmonics: usize, top: usize, left: usize, jacobian: &mut Matrix) {
        let (s, t) = (self.stiffness[0], self.damping[0]);
        for m in 1..=harmonics {
            let (cosine, sine) = jacobian.two_rows_mut(top + 2 * m - 1, top + 2 * m);
            let i = left + 2 * m - 1;
            cosine[i] += s;
            cosine[i + 1] += m as f64 * t;
            sine[i] -= m as f64 * t;
            sine[i + 1] += s;
        }
    }
}

/// `2 <S cos l cos m>` and its companions.
struct Projections {
    cos_cos: f64,
    cos_sin: f64,
    sin_cos: f64,
    sin_sin: f64,
}

#[inline]
fn projections(series: &[f64], l: usize, m: usize) -> Projections {
    let (sum_c, sum_s) = (0.5 * series[2 * (l + m) - 1], 0.5 * series[2 * (l + m)]);
    let (difference_c, difference_s) = match l.cmp(&m) {
        std::cmp::Ordering::Equal => (series[0], 0.0),
        std::cmp::Ordering::Greater => (0.5 * series[2 * (l - m) - 1], 0.5 * series[2 * (l - m)]),
        std::cmp::Ordering::Less => (0.5 * series[2 * (m - l) - 1], -0.5 * series[2 * (m - l)]),
    };
    Projections {
        cos_cos: difference_c + sum_c,
        cos_sin: sum_s - difference_s,
        sin_cos: sum_s + difference_s,
        sin_sin: difference_c - sum_c,
    }
}

/// Adds `factor e(tau) d(tau) series(tau)`.
fn add_twice(from: &[f64], e: Wave, d: Wave, factor: f64, to: &mut [f64], room: &mut [f64]) {
    if factor == 0.0 {
        return;
    }
    if d.harmonic == 0 {
        series::add_product(from, e, factor, to);
    } else {
        room.fill(0.0);
        series::add_product(from, d, factor, room);
        series::add_product(room, e, 1.0, to);
    }
}
