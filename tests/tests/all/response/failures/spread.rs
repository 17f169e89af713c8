//! Multipliers over many decades.

use std::f64::consts::TAU;

use hertzian::stability::Method;
use hertzian::time;
use hertzian::time::Tangent;
use hertzian::{Complex, FrequencyResponse};
use nalgebra::DMatrix;

use super::models::{answer, first};

hertzian::oscillator! {
    /// Stiffness eigenvalues 2 and -1: an oscillation and a saddle, coupled.
    Saddle(x, y) {
        param c;
        param drive;
        ddot(x) + c*dot(x) + 0.5*x + 1.5*y = drive*cos(omega*t);
        ddot(y) + c*dot(y) + 1.5*x + 0.5*y = 0;
    }
}

/// A monodromy matrix knows its smallest eigenvalue to a rounding error of its largest.
#[test]
fn a_product_forgets_small_multipliers() {
    println!("omega, largest, smallest, relative error of the smallest by the matrix, by default");
    for omega in [0.45, 0.35] {
        let model = Saddle {
            c: 0.01,
            drive: 0.1,
        };
        let exponent = |k: f64, sign: f64| {
            let root = Complex::new(0.25 * model.c * model.c - k, 0.0).sqrt();
            (root.scale(sign) - 0.5 * model.c).scale(TAU / omega).exp()
        };
        let [largest, smallest] = [exponent(-1.0, 1.0), exponent(-1.0, -1.0)];
        let mut flow = time::of(&model, omega, 1e-10).unwrap();
        let mut tangent = Tangent::of_state(2, None);
        flow.advance(0.0, TAU, &mut [0.0; 4], Some(&mut tangent), None)
            .unwrap();
        let product = DMatrix::from_column_slice(4, 4, &tangent.columns);
        let eigenvalues = product.complex_eigenvalues();
        let by_product = eigenvalues.iter().map(|m| (m - smallest).norm());
        let by_product = by_product.fold(f64::INFINITY, f64::min) / smallest.norm();
        let branch = first(&FrequencyResponse::of(&model).from(omega).to(0.5));
        let answer = answer(&branch, Method::Default).stability;
        let relative =
            |found: Complex<f64>, exact: Complex<f64>| (found - exact).norm() / exact.norm();
        let default = relative(answer.multipliers[3], smallest);
        println!(
            "{omega}, {:.0e}, {:.0e}, {by_product:.0e}, {default:.0e}",
            largest.re, smallest.re
        );
        assert!(largest.re > 1e6 && smallest.re < 1e-6);
        assert!(by_product > 1e-6, "{by_product:e}");
        assert!(default < 1e-9 && relative(answer.multipliers[0], largest) < 1e-9);
    }
}
