//! One step of a linear differential equation by Magnus' expansion, sixth order, with what the fourth order lacks.
//!
//! For `Y' = A(s) Y` and a step `h` with `A_1, A_2, A_3` at the three Gauss-Legendre nodes of the step,
//!
//! ```text
//! a_1 = h A_2,    a_2 = h sqrt(15)/3 (A_3 - A_1),    a_3 = h 10/3 (A_3 - 2 A_2 + A_1)                        (1)
//! C_1 = [a_1, a_2],    C_2 = -[a_1, 2 a_3 + C_1] / 60                                                        (2)
//! Omega = a_1 + a_3/12 + [-20 a_1 - a_3 + C_1, a_2 + C_2] / 240,    Y(h) = exp(Omega) Y(0)                   (3)
//! ```
//!
//! The fourth order stops after the first commutator, `Omega_4 = a_1 + a_3/12 - C_1/12`. The commutator is of the order `h^3`
//! and what is missing, `D = Omega - Omega_4`, of the order `h^5`; what (3) lacks in turn is of the order `h^7`, about
//! `D |D| / |C_1/12|`. A constant `A` is integrated exactly.
//!
//! Source: Blanes, Casas, Oteo and Ros (2009), The Magnus expansion and some of its applications, Physics Reports 470,
//! section 5.

use nalgebra::DMatrix;

use crate::numeric::exponential::Exponential;

/// Nodes of the three-point Gauss-Legendre rule on `[0, 1]`.
pub(super) const NODES: [f64; 3] = [0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7];

/// Workspace for steps of one order.
#[derive(Debug)]
pub(super) struct Magnus {
    /// `A_1, A_2, A_3`, each times the step: what the caller writes.
    pub(super) scaled: [DMatrix<f64>; 3],
    /// `Omega` of the last step.
    pub(super) omega: DMatrix<f64>,
    /// `exp Omega`.
    pub(super) propagator: DMatrix<f64>,
    /// `D`
    pub(super) lack: DMatrix<f64>,
    a2: DMatrix<f64>,
    a3: DMatrix<f64>,
    c1: DMatrix<f64>,
    c2: DMatrix<f64>,
    exponential: Exponential,
}

impl Magnus {
    pub(super) fn new(order: usize) -> Self {
        let zeros = || DMatrix::zeros(order, order);
        Self {
            scaled: std::array::from_fn(|_| zeros()),
            omega: zeros(),
            propagator: zeros(),
            lack: zeros(),
            a2: zeros(),
            a3: zeros(),
            c1: zeros(),
            c2: zeros(),
            exponential: Exponential::new(order),
        }
    }

    /// A step with the matrices in [`scaled`](Self::scaled). Returns the sizes of the first commutator and of what the fourth
    /// order lacks.
    pub(super) fn step(&mut self) -> [f64; 2] {
        let [first, a1, third] = &self.scaled;
        let entries = first
            .as_slice()
            .iter()
            .zip(a1.as_slice())
            .zip(third.as_slice());
        let to = self
            .a2
            .as_mut_slice()
            .iter_mut()
            .zip(self.a3.as_mut_slice());
        for (((x, y), z), (a2, a3)) in entries.zip(to) {
            *a2 = 15.0_f64.sqrt() / 3.0 * (z - x);
            *a3 = 10.0 / 3.0 * (z - 2.0 * y + x);
        }
        commutator(a1, &self.a2, &mut self.c1);
        // 2 a_3 + C_1, then -20 a_1 - a_3 + C_1, take the place of Omega.
        combine(&mut self.omega, [(2.0, &self.a3), (1.0, &self.c1)]);
        commutator(a1, &self.omega, &mut self.c2);
        self.c2.scale_mut(-1.0 / 60.0);
        // The fourth order has -20 [a_1, a_2] / 240; the rest of the commutator of (3) is what it lacks.
        commutator(a1, &self.c2, &mut self.lack);
        self.lack.scale_mut(-20.0);
        combine(&mut self.omega, [(-1.0, &self.a3), (1.0, &self.c1)]);
        add(&mut self.c2, 1.0, &self.a2);
        self.propagator.gemm(1.0, &self.omega, &self.c2, 0.0);
        self.propagator.gemm(-1.0, &self.c2, &self.omega, 1.0);
        add(&mut self.lack, 1.0, &self.propagator);
        self.lack.scale_mut(1.0 / 240.0);
        combine(&mut self.omega, [(1.0, a1), (1.0 / 12.0, &self.a3)]);
        add(&mut self.omega, -1.0 / 12.0, &self.c1);
        add(&mut self.omega, 1.0, &self.lack);
        self.exponential.of(&self.omega, &mut self.propagator);
        [size(&self.c1) / 12.0, size(&self.lack)]
    }

    /// A step with one constant matrix, the first of [`scaled`](Self::scaled).
    pub(super) fn constant(&mut self) {
        self.exponential.of(&self.scaled[0], &mut self.propagator);
    }
}

fn commutator(a: &DMatrix<f64>, b: &DMatrix<f64>, result: &mut DMatrix<f64>) {
    result.gemm(1.0, a, b, 0.0);
    result.gemm(-1.0, b, a, 1.0);
}

fn combine(to: &mut DMatrix<f64>, terms: [(f64, &DMatrix<f64>); 2]) {
    to.fill(0.0);
    for (factor, matrix) in terms {
        add(to, factor, matrix);
    }
}

fn add(to: &mut DMatrix<f64>, factor: f64, matrix: &DMatrix<f64>) {
    for (to, from) in to.as_mut_slice().iter_mut().zip(matrix.as_slice()) {
        *to += factor * from;
    }
}

/// Largest entry.
fn size(a: &DMatrix<f64>) -> f64 {
    a.as_slice().iter().fold(0.0, |m, x| m.max(x.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Airy's equation `y'' = s y`: the error falls with the sixth power of the step, and is what the lack of the fourth order
    /// makes of it.
    #[test]
    fn order_is_six() {
        let matrix = |s: f64| DMatrix::from_row_slice(2, 2, &[0.0, 1.0, s, 0.0]);
        let integrate = |steps: usize| {
            let h = 2.0 / steps as f64;
            let mut magnus = Magnus::new(2);
            let mut y = DMatrix::identity(2, 2);
            let mut lack = DMatrix::zeros(2, 2);
            let mut sizes = [0.0; 2];
            for k in 0..steps {
                magnus.scaled = NODES.map(|node| matrix((k as f64 + node) * h) * h);
                let [a, b] = magnus.step();
                y = &magnus.propagator * y;
                lack = &magnus.propagator * lack + &magnus.lack * &y;
                sizes = [sizes[0] + a, sizes[1] + b];
            }
            (y, lack.amax() * sizes[1] / sizes[0])
        };
        // From the series solutions of Airy's equation, summed in exact arithmetic: y1(2) and y2(2).
        let y1: f64 = (1..40)
            .fold((1.0, 1.0), |(sum, term), k| {
                let k3 = 3.0 * f64::from(k);
                let term = term * 8.0 / (k3 * (k3 - 1.0));
                (sum + term, term)
            })
            .0;
        let exact = integrate(256).0;
        assert!((exact[(0, 0)] - y1).abs() < 1e-13 * y1);
        let error = |steps| (integrate(steps).0 - &exact).amax();
        let order = (error(4) / error(8)).log2();
        assert!((5.5..6.8).contains(&order), "{order}");
        for steps in [2, 4, 8, 16] {
            let ratio = integrate(steps).1 / error(steps);
            assert!((0.5..3.0).contains(&ratio), "{steps} {ratio}");
        }
    }
}
