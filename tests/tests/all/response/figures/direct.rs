//! Direct integration at tight tolerance: a classical Runge-Kutta method with steps so small that the kink of the
//! stiffness at zero does not matter, on the oscillator written out by hand.

use std::f64::consts::TAU;

use hertzian::Complex;

/// `x'' + 2 zeta x' + sgn(x) |x|^alpha = A cos(omega t) + W`
pub struct PowerForm {
    pub alpha: f64,
    pub zeta: f64,
    pub drive: f64,
    pub load: f64,
    pub omega: f64,
}

const STEPS: usize = 40_000;

impl PowerForm {
    /// State `(x, v)` and the two columns of its sensitivity, over one period.
    fn flow(&self, x: f64, v: f64) -> [f64; 6] {
        let h = TAU / self.omega / STEPS as f64;
        let mut y = [x, v, 1.0, 0.0, 0.0, 1.0];
        let moved = |y: &[f64; 6], k: &[f64; 6], h: f64| {
            let mut z = *y;
            for i in 0..6 {
                z[i] += h * k[i];
            }
            z
        };
        for step in 0..STEPS {
            let t = h * step as f64;
            let k1 = self.slope(t, &y);
            let k2 = self.slope(t + 0.5 * h, &moved(&y, &k1, 0.5 * h));
            let k3 = self.slope(t + 0.5 * h, &moved(&y, &k2, 0.5 * h));
            let k4 = self.slope(t + h, &moved(&y, &k3, h));
            for i in 0..6 {
                y[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
            }
        }
        y
    }

    fn slope(&self, t: f64, y: &[f64; 6]) -> [f64; 6] {
        let size = y[0].abs();
        let lower = size.powf(self.alpha - 1.0);
        let force = self.drive * (self.omega * t).cos() + self.load - lower * y[0];
        let stiffness = self.alpha * lower;
        let damping = 2.0 * self.zeta;
        [
            y[1],
            force - damping * y[1],
            y[3],
            -stiffness * y[2] - damping * y[3],
            y[5],
            -stiffness * y[4] - damping * y[5],
        ]
    }

    /// The state of the periodic orbit near a state, by three steps of Newton's method.
    pub fn periodic(&self, mut x: f64, mut v: f64) -> (f64, f64) {
        for _ in 0..3 {
            let [x1, v1, a, c, b, d] = self.flow(x, v);
            let (rx, rv) = (x1 - x, v1 - v);
            let determinant = (a - 1.0) * (d - 1.0) - b * c;
            x -= ((d - 1.0) * rx - b * rv) / determinant;
            v -= ((a - 1.0) * rv - c * rx) / determinant;
        }
        (x, v)
    }

    /// Multipliers of the periodic orbit near a state, largest modulus first and positive imaginary part first.
    pub fn multipliers(&self, x: f64, v: f64) -> [Complex<f64>; 2] {
        let (x, v) = self.periodic(x, v);
        let [_, _, a, c, b, d] = self.flow(x, v);
        let mean = 0.5 * (a + d);
        let square = (0.5 * (a - d)).powi(2) + b * c;
        let root = Complex::new(square, 0.0).sqrt();
        let mut pair = [mean + root, mean - root];
        pair.sort_by(|p, q| q.norm().total_cmp(&p.norm()).then(q.im.total_cmp(&p.im)));
        pair
    }
}
