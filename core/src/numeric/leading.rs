//! The largest eigenvalues of a matrix of many rows, and that no other one is as large.
//!
//! Most multipliers of a structure are those of modes that die out within a period, and say nothing of its stability. With an orthonormal basis `Q`
//! of a Krylov space of the map `A`,
//!
//! ```text
//! A Q = Q H + W B E^T,     E^T the last rows,                                                                  (1)
//! ```
//!
//! an eigenvalue `theta` of `H` with the eigenvectors `H y = theta y`, `z^T H = theta z^T` and `z^T y = 1` is taken for one of `A` but for
//!
//! ```text
//! |B E^T y| |z|     where |y| = 1                                                                              (2)
//! ```
//!
//! which would be so to first order with the left eigenvector of `A` in place of that of `H`, which is near it. The space grows until that is rounding for all that are larger than a part of the largest. With `P` the projection to what is
//! orthogonal to their eigenvectors `Q y` the others are those of `P A P`, and none is larger than the root of order `p` of
//!
//! ```text
//! |(P A P)^p| <= 10 (2/pi)^(1/2) max_i |(P A P)^p w_i|                                                         (3)
//! ```
//!
//! but with the probability `10^-r`, for `r` vectors `w_i` of normal numbers. Where the space would be nearly as large as the matrix nothing is
//! said.
//!
//! Source: Saad (2011), Numerical Methods for Large Eigenvalue Problems, 2nd edition, chapter 6 for (1) (block Arnoldi), chapter 3 for (2); Halko, Martinsson and
//! Tropp (2011), SIAM Rev. 53, lemma 4.1, for (3).

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::spectrum::{ITERATIONS, balance};

/// Matrices of fewer rows have all of their eigenvalues computed.
pub(crate) const MANY: usize = 130;
/// Those are wanted that are larger than this part of the largest one, or than this if the largest is.
const WANTED: f64 = 0.5;
/// All others are shown to be smaller than this many times that: of those between, some may be missing.
pub(crate) const OTHERS: f64 = 1.6;
/// Vectors of a block, one after the other: one leads to the smallest space, and does not see eigenvalues of copies, which come as often as there
/// are copies.
const BLOCKS: [usize; 2] = [1, 4];
/// The first size of a space, and how it grows.
const FIRST: usize = 32;
const GROWTH: f64 = 1.25;
/// The largest space, as a part of the matrix.
const LARGEST: f64 = 0.45;
/// So many times as large as their number a space has to be.
const TWICE: usize = 2;
/// (2) relative to the largest eigenvalue.
const ROUNDING: f64 = 1e-13;
/// The vectors of (3), and the powers that are tried.
const VECTORS: usize = 10;
const POWERS: i32 = 24;
/// Of what is left of a vector by a projection, less than this part is rounding.
const DEPENDENT: f64 = 1e-12;

/// What those are larger than that are wanted, beside the largest.
pub(crate) fn least(largest: f64) -> f64 {
    WANTED * largest.min(1.0)
}

/// The eigenvalues that are larger than [`least`]; none where too many are, or they do not settle.
pub(crate) fn leading(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let n = matrix.nrows();
    if n < MANY || matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let mut matrix = matrix.clone();
    balance(&mut matrix);
    for block in BLOCKS {
        match Krylov::new(&matrix, block)?.leading(&matrix) {
            Outcome::Found(found) => return Some(found.values),
            Outcome::TooMany => return None,
            Outcome::NotYet => {}
        }
    }
    None
}

/// Numbers that are normal for the purpose: always the same.
struct Normal {
    state: u64,
}

impl Normal {
    /// In (0, 1).
    fn uniform(&mut self) -> f64 {
        // Steele, Lea and Flood (2014), SplitMix.
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * 2_f64.powi(-53) + 2_f64.powi(-54)
    }

    /// Box and Muller (1958).
    fn next(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    fn block(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| self.next())
    }
}

/// (1)
struct Krylov {
    /// Vectors of a block.
    block: usize,
    /// `Q` and `W`, column by column.
    basis: DMatrix<f64>,
    /// `H` and `B` below it.
    projected: DMatrix<f64>,
    /// Columns of `Q`.
    size: usize,
    normal: Normal,
}

/// What a space has shown.
enum Outcome {
    Found(Found),
    NotYet,
    /// The largest space will not do.
    TooMany,
}

/// Those that settled.
struct Found {
    /// The largest first.
    values: Vec<Complex<f64>>,
    /// An orthonormal basis of their eigenvectors.
    vectors: DMatrix<f64>,
    /// Those that are wanted are larger than this.
    least: f64,
}

impl Krylov {
    fn new(matrix: &DMatrix<f64>, block: usize) -> Option<Self> {
        let n = matrix.nrows();
        let most = (LARGEST * n as f64) as usize;
        let room = most + block;
        let mut normal = Normal { state: 1 };
        let mut basis = DMatrix::zeros(n, room);
        basis
            .columns_mut(0, block)
            .copy_from(&normal.block(n, block));
        let mut space = Self {
            block,
            basis,
            projected: DMatrix::zeros(room, most),
            size: 0,
            normal,
        };
        space.orthonormalise(0)?;
        Some(space)
    }

    /// The eigenvalues that are larger than a part of the largest, if they settle, and others are seen to be smaller.
    fn leading(mut self, matrix: &DMatrix<f64>) -> Outcome {
        let most = self.projected.ncols();
        let mut size = FIRST.min(most);
        loop {
            self.grow(matrix, size);
            match self.settled() {
                Outcome::NotYet if size < most => {}
                Outcome::Found(found) if !are_others_small(matrix, &found) => {
                    return Outcome::NotYet;
                }
                outcome => return outcome,
            }
            size = ((GROWTH * size as f64) as usize).min(most);
        }
    }

    /// Makes a block orthonormal within itself, after those before it; its factor. What depends on others is taken anew, by chance.
    fn orthonormalise(&mut self, first: usize) -> Option<DMatrix<f64>> {
        let mut factor = DMatrix::zeros(self.block, self.block);
        for j in 0..self.block {
            let column = first + j;
            let before = self.basis.column(column).norm();
            let mut vector = self.basis.column(column).into_owned();
            for _ in 0..2 {
                for i in 0..j {
                    let other = self.basis.column(first + i);
                    let part = other.dot(&vector);
                    vector.axpy(-part, &other, 1.0);
                    factor[(i, j)] += part;
                }
            }
            let mut length = vector.norm();
            if length > DEPENDENT * before {
                factor[(j, j)] = length;
            } else {
                vector = self.another(column)?;
                length = vector.norm();
            }
            self.basis.set_column(column, &(vector / length));
        }
        Some(factor)
    }

    /// A vector by chance that is orthogonal to the first columns.
    fn another(&mut self, columns: usize) -> Option<DVector<f64>> {
        let n = self.basis.nrows();
        let mut vector = DVector::from_fn(n, |_, _| self.normal.next());
        let before = vector.norm();
        let others = self.basis.columns(0, columns);
        for _ in 0..3 {
            let parts = others.tr_mul(&vector);
            vector -= others * parts;
        }
        (vector.norm() > DEPENDENT * before).then_some(vector)
    }

    /// Grows to so many columns.
    fn grow(&mut self, matrix: &DMatrix<f64>, size: usize) {
        while self.size + self.block <= size {
            let first = self.size;
            let next = first + self.block;
            let mut block = matrix * self.basis.columns(first, self.block);
            let known = self.basis.columns(0, next);
            for _ in 0..2 {
                let parts = known.tr_mul(&block);
                block -= known * &parts;
                let mut entries = self.projected.view_mut((0, first), (next, self.block));
                entries += parts;
            }
            self.basis.columns_mut(next, self.block).copy_from(&block);
            let Some(factor) = self.orthonormalise(next) else {
                return;
            };
            let mut below = self
                .projected
                .view_mut((next, first), (self.block, self.block));
            below.copy_from(&factor);
            self.size = next;
        }
    }

    /// Those that are wanted, if (2) is rounding for all of them.
    fn settled(&self) -> Outcome {
        let size = self.size;
        let h = self.projected.view((0, 0), (size, size)).into_owned();
        if h.iter().any(|x| !x.is_finite()) {
            return Outcome::NotYet;
        }
        let below = self
            .projected
            .view((size, size - self.block), (self.block, self.block))
            .map(|x| Complex::new(x, 0.0));
        let Some(form) = Triangular::of(h) else {
            return Outcome::NotYet;
        };
        let largest = form.values().map(Complex::norm).fold(0.0, f64::max);
        let least = least(largest);
        let is_wanted = |place: &usize| form.t[(*place, *place)].norm() > least;
        let wanted: Vec<usize> = (0..size).filter(is_wanted).collect();
        if wanted.is_empty() {
            return Outcome::NotYet;
        }
        if TWICE * wanted.len() > self.projected.ncols() {
            return Outcome::TooMany;
        }
        let mut found = Vec::new();
        for place in wanted {
            let value = form.t[(place, place)];
            let (vector, condition) = form.vector(place);
            let last = vector.rows(size - self.block, self.block);
            if (&below * last).norm() * condition > ROUNDING * largest {
                return Outcome::NotYet;
            }
            found.push((value, vector));
        }
        let mut vectors = Vec::new();
        for (_, vector) in &found {
            vectors.extend([vector.map(|x| x.re), vector.map(|x| x.im)]);
        }
        let basis = self.basis.columns(0, size);
        let vectors = orthonormal(vectors, size);
        Outcome::Found(Found {
            values: found.into_iter().map(|(value, _)| value).collect(),
            vectors: basis * vectors,
            least,
        })
    }
}

/// An orthonormal basis of what vectors of some length span.
fn orthonormal(vectors: Vec<DVector<f64>>, length: usize) -> DMatrix<f64> {
    let mut columns: Vec<DVector<f64>> = Vec::with_capacity(vectors.len());
    for mut vector in vectors {
        let before = vector.norm();
        for _ in 0..2 {
            for other in &columns {
                let part = other.dot(&vector);
                vector.axpy(-part, other, 1.0);
            }
        }
        let after = vector.norm();
        if after > DEPENDENT * before {
            columns.push(vector / after);
        }
    }
    DMatrix::from_fn(length, columns.len(), |i, j| columns[j][i])
}

/// Whether (3) shows that all others are small.
fn are_others_small(matrix: &DMatrix<f64>, found: &Found) -> bool {
    let factor = 10.0 * (2.0 / std::f64::consts::PI).sqrt();
    let beside = |vectors: DMatrix<f64>| {
        let parts = found.vectors.tr_mul(&vectors);
        vectors - &found.vectors * parts
    };
    let mut normal = Normal { state: 2 };
    let mut vectors = beside(normal.block(matrix.nrows(), VECTORS));
    for power in 1..=POWERS {
        vectors = beside(matrix * vectors);
        let lengths = vectors.column_iter().map(|vector| vector.norm());
        let lengths: Vec<f64> = lengths.collect();
        if lengths.iter().any(|length| !length.is_finite()) {
            return false;
        }
        let most = factor * lengths.iter().copied().fold(0.0, f64::max);
        if most <= (OTHERS * found.least).powi(power) {
            return true;
        }
    }
    false
}

/// `H = Z T Z^*` with a triangular `T`.
struct Triangular {
    t: DMatrix<Complex<f64>>,
    z: DMatrix<Complex<f64>>,
}

impl Triangular {
    fn of(h: DMatrix<f64>) -> Option<Self> {
        let (z, t) = Schur::try_new(h, f64::EPSILON, ITERATIONS)?.unpack();
        let complex = |x: f64| Complex::new(x, 0.0);
        let mut form = Self {
            t: t.map(complex),
            z: z.map(complex),
        };
        for row in 1..form.t.nrows() {
            form.split(row);
        }
        Some(form)
    }

    /// Rotates the entry below the diagonal of a row away, where it belongs to a pair.
    fn split(&mut self, row: usize) {
        let n = self.t.nrows();
        let above = row - 1;
        let below = self.t[(row, above)];
        if below == Complex::ZERO {
            return;
        }
        let [a, b, d] = [(above, above), (above, row), (row, row)].map(|place| self.t[place]);
        // An eigenvalue of the two rows less `d`.
        let half = 0.5 * (a - d);
        let root = (half * half + b * below).sqrt();
        let [plus, minus] = [half + root, half - root];
        let shift = if plus.norm() > minus.norm() {
            plus
        } else {
            minus
        };
        let length = shift.norm().hypot(below.norm());
        let [c, s] = [shift / length, below / length];
        // Its eigenvector is `(c, s)`.
        for j in 0..n {
            let [x, y] = [self.t[(above, j)], self.t[(row, j)]];
            self.t[(above, j)] = c.conj() * x + s.conj() * y;
            self.t[(row, j)] = c * y - s * x;
        }
        for matrix in [&mut self.t, &mut self.z] {
            for i in 0..n {
                let [x, y] = [matrix[(i, above)], matrix[(i, row)]];
                matrix[(i, above)] = c * x + s * y;
                matrix[(i, row)] = c.conj() * y - s.conj() * x;
            }
        }
        self.t[(row, above)] = Complex::ZERO;
        // A pair is one to the last bit.
        if self.t[(above, above)].im != 0.0 {
            self.t[(row, row)] = self.t[(above, above)].conj();
        }
    }

    fn values(&self) -> impl Iterator<Item = Complex<f64>> {
        (0..self.t.nrows()).map(|place| self.t[(place, place)])
    }

    /// A difference of eigenvalues that is no smaller than rounding.
    fn apart(&self, i: usize, value: Complex<f64>) -> Complex<f64> {
        let apart = self.t[(i, i)] - value;
        let least = f64::EPSILON * value.norm().max(f64::MIN_POSITIVE);
        if apart.norm() < least {
            Complex::new(least, 0.0)
        } else {
            apart
        }
    }

    /// The eigenvector of a place of the diagonal, of length one, and the condition `|z|` of its eigenvalue.
    fn vector(&self, place: usize) -> (DVector<Complex<f64>>, f64) {
        let n = self.t.nrows();
        let value = self.t[(place, place)];
        let mut y = DVector::zeros(place + 1);
        y[place] = Complex::ONE;
        for i in (0..place).rev() {
            let sum: Complex<f64> = (i + 1..=place).map(|j| self.t[(i, j)] * y[j]).sum();
            y[i] = -sum / self.apart(i, value);
        }
        let mut z = DVector::zeros(n - place);
        z[0] = Complex::ONE;
        for i in place + 1..n {
            let sum: Complex<f64> = (place..i).map(|j| self.t[(j, i)] * z[j - place]).sum();
            z[i - place] = -sum / self.apart(i, value);
        }
        let condition = z.norm() * y.norm();
        let vector = self.z.columns(0, place + 1) * y;
        let length = vector.norm();
        (vector.unscale(length), condition)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::spectrum::{distance, eigenvalues};

    /// Modes that turn and decay, and a perturbation of small rank.
    fn map(modes: usize, decay: f64, coupling: f64) -> DMatrix<f64> {
        let n = 2 * modes;
        let mut normal = Normal { state: 7 };
        let mut map = DMatrix::zeros(n, n);
        for mode in 0..modes {
            let size = (-decay * (2.0 * mode as f64 + 1.0)).exp();
            let (s, c) = (1.7 * mode as f64 + 0.3).sin_cos();
            let mut block = map.view_mut((2 * mode, 2 * mode), (2, 2));
            block[(0, 0)] = size * c;
            block[(0, 1)] = -size * s;
            block[(1, 0)] = size * s;
            block[(1, 1)] = size * c;
        }
        let (a, b) = (normal.block(n, 6), normal.block(n, 6));
        let scale = |mut matrix: DMatrix<f64>| {
            for (row, mut entries) in matrix.row_iter_mut().enumerate() {
                entries *= (-0.5 * decay * row as f64).exp();
            }
            matrix
        };
        map + coupling * scale(a) * scale(b).transpose()
    }

    fn largest(values: &[Complex<f64>], count: usize) -> &[Complex<f64>] {
        &values[..count]
    }

    #[test]
    fn they_are_the_largest_of_all() {
        for (modes, decay, coupling) in [
            (70, 0.06, 0.0),
            (70, 0.06, 0.05),
            (70, 0.06, 0.2),
            (100, 0.06, 0.1),
            (120, 0.03, 0.02),
            (70, 0.3, 0.3),
        ] {
            let map = map(modes, decay, coupling);
            let found = leading(&map).unwrap_or_else(|| panic!("{modes} {decay} {coupling}"));
            let all = eigenvalues(&map);
            let least = least(all[0].norm());
            let count = all.iter().filter(|value| value.norm() > least).count();
            assert_eq!(found.len(), count, "{modes} {decay} {coupling}");
            let mut found = found;
            found.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
            let off = distance(&found, largest(&all, count));
            assert!(
                off < 1e-12 * all[0].norm(),
                "{modes} {decay} {coupling}: {off:e}"
            );
        }
    }

    /// Two equal parts have every eigenvalue twice.
    #[test]
    fn copies_are_found() {
        let one = map(60, 0.1, 0.2);
        let n = one.nrows();
        let two = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
            if (i < n) == (j < n) {
                one[(i % n, j % n)]
            } else {
                0.0
            }
        });
        let found = leading(&two).unwrap();
        let all = eigenvalues(&two);
        let off = distance(&found, largest(&all, found.len()));
        assert!(off < 1e-12, "{off:e}");
        assert!(all[found.len()].norm() < WANTED);
    }

    /// Modes that hardly decay need all of the space: nothing is said.
    #[test]
    fn where_most_are_large_nothing_is_said() {
        assert_eq!(leading(&map(70, 1e-4, 0.01)), None);
        assert_eq!(leading(&map(10, 0.1, 0.1)), None);
        let mut broken = map(70, 0.1, 0.1);
        broken[(3, 4)] = f64::NAN;
        assert_eq!(leading(&broken), None);
        assert_eq!(leading(&DMatrix::zeros(140, 140)), None);
    }

    /// An eigenvalue that the first block has no part of is not passed over: (3) sees it.
    #[test]
    fn others_that_are_large_are_seen() {
        let map = map(40, 0.1, 0.0);
        let n = map.nrows();
        let known = Found {
            values: Vec::new(),
            vectors: DMatrix::zeros(n, 0),
            least: 0.5,
        };
        assert!(!are_others_small(&map, &known));
        let all_of_them = Found {
            vectors: DMatrix::identity(n, 20),
            ..known
        };
        assert!(are_others_small(&map, &all_of_them));
    }
}
