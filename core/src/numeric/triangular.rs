//! Eigenvectors from a real Schur form.
//!
//! `A = Q T Q^T` with `T` triangular but for blocks of order two on its diagonal. An eigenvector of `T` for an eigenvalue of the
//! block at `j` has zeros below that block; above, `(T - lambda) x = 0` is solved upwards, block by block.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, section 7.6.4.

use nalgebra::{Complex, DMatrix};

type Value = Complex<f64>;

/// Eigenvalues and eigenvectors of `A`, in the order of the diagonal of `T`.
pub(crate) fn eigenvectors(q: &DMatrix<f64>, t: &DMatrix<f64>) -> Vec<(Value, Vec<Value>)> {
    let order = t.nrows();
    // What a pivot that vanishes is replaced by.
    let smallest = f64::EPSILON * t.amax().max(f64::MIN_POSITIVE);
    let mut found = Vec::with_capacity(order);
    let mut start = 0;
    while start < order {
        let size = size(t, start);
        for value in values(t, start, size) {
            let mut x = vec![Value::new(0.0, 0.0); order];
            first(t, start, size, value, &mut x);
            upwards(t, start, value, smallest, &mut x);
            found.push((value, turned(q, &x[..start + size])));
        }
        start += size;
    }
    found
}

/// Order of the diagonal block that begins here.
fn size(t: &DMatrix<f64>, start: usize) -> usize {
    let coupled = start + 1 < t.nrows() && t[(start + 1, start)] != 0.0;
    1 + usize::from(coupled)
}

/// Eigenvalues of a diagonal block.
fn values(t: &DMatrix<f64>, start: usize, size: usize) -> Vec<Value> {
    if size == 1 {
        return vec![Value::new(t[(start, start)], 0.0)];
    }
    let [a, b, c, d] = block(t, start);
    let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
    let root = Value::new(half * half + b * c, 0.0).sqrt();
    vec![root + mean, -root + mean]
}

fn block(t: &DMatrix<f64>, start: usize) -> [f64; 4] {
    let end = start + 1;
    [
        t[(start, start)],
        t[(start, end)],
        t[(end, start)],
        t[(end, end)],
    ]
}

/// The part of the eigenvector in its own block.
fn first(t: &DMatrix<f64>, start: usize, size: usize, value: Value, x: &mut [Value]) {
    if size == 1 {
        x[start] = Value::new(1.0, 0.0);
        return;
    }
    let [_, _, c, d] = block(t, start);
    x[start] = value - d;
    x[start + 1] = Value::new(c, 0.0);
}

/// The rest of it.
fn upwards(t: &DMatrix<f64>, start: usize, value: Value, smallest: f64, x: &mut [Value]) {
    let mut end = start;
    while end > 0 {
        let begin = if end > 1 && t[(end - 1, end - 2)] != 0.0 {
            end - 2
        } else {
            end - 1
        };
        let right = |row: usize, x: &[Value]| -> Value {
            -(end..x.len())
                .map(|column| x[column].scale(t[(row, column)]))
                .sum::<Value>()
        };
        if end - begin == 1 {
            let mut pivot = Value::new(t[(begin, begin)], 0.0) - value;
            if pivot.norm() < smallest {
                pivot = Value::new(smallest, 0.0);
            }
            x[begin] = right(begin, x) / pivot;
        } else {
            let [a, b, c, d] = block(t, begin).map(|entry| Value::new(entry, 0.0));
            let (a, d) = (a - value, d - value);
            let mut determinant = a * d - b * c;
            if determinant.norm() < smallest * smallest {
                determinant = Value::new(smallest * smallest, 0.0);
            }
            let (upper, lower) = (right(begin, x), right(begin + 1, x));
            x[begin] = (d * upper - b * lower) / determinant;
            x[begin + 1] = (a * lower - c * upper) / determinant;
        }
        end = begin;
    }
}

/// `Q x`, of length one.
fn turned(q: &DMatrix<f64>, x: &[Value]) -> Vec<Value> {
    let mut y = vec![Value::new(0.0, 0.0); q.nrows()];
    for (column, x) in q.column_iter().zip(x) {
        for (y, q) in y.iter_mut().zip(column.iter()) {
            *y += x.scale(*q);
        }
    }
    let size = y.iter().map(Value::norm_sqr).sum::<f64>().sqrt();
    for y in &mut y {
        *y = y.unscale(size);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random::Random;
    use nalgebra::Schur;

    #[test]
    fn eigenvectors_are_what_they_are_called() {
        let mut random = Random::seeded(2);
        for order in [1, 2, 3, 7, 12] {
            let a = DMatrix::from_fn(order, order, |_, _| random.between(-1.0, 1.0));
            let (q, t) = Schur::new(a.clone()).unpack();
            let found = eigenvectors(&q, &t);
            assert_eq!(found.len(), order);
            for (value, vector) in found {
                for i in 0..order {
                    let product: Value = (0..order).map(|j| vector[j].scale(a[(i, j)])).sum();
                    let error = (product - value * vector[i]).norm();
                    assert!(error < 1e-12, "{order} {value} {error:e}");
                }
            }
        }
    }
}
