//! Several coordinates: resonance in closed form, and a chain with a stop.

use std::f64::consts::TAU;

use super::flow;
use super::reference::Reference;
use crate::model::structure::{Contact, DMatrix, Structure};
use crate::oscillator;
use crate::time::{Flow, Tangent};

oscillator! {
    /// Two equal masses on three equal springs; the frequencies are one and the root of three.
    Pair(x, y) {
        ddot(x) + 2*x - y = cos(omega*t);
        ddot(y) + 2*y - x = 0;
    }
}

hertzian::law! {
    /// A spring that is touched at gap zero.
    Spring(gap, k) { gap > 0 => k*gap, else => 0 }
}

/// From rest the first mode, `x + y`, grows as `t sin t / 2`, and the second, `x - y`, is a difference of two cosines.
#[test]
fn one_mode_at_resonance() {
    let mut flow = flow(&Pair {}, 1.0);
    let mut state = [0.0; 4];
    flow.advance(0.0, 4.3 * TAU, &mut state, None, None)
        .unwrap();
    let (t, w) = (4.3 * TAU, 3.0_f64.sqrt());
    let (sum, sum_rate) = (0.5 * t * t.sin(), 0.5 * (t.sin() + t * t.cos()));
    let (difference, rate) = (
        0.5 * (t.cos() - (w * t).cos()),
        0.5 * (w * (w * t).sin() - t.sin()),
    );
    let exact = [
        0.5 * (sum + difference),
        0.5 * (sum - difference),
        0.5 * (sum_rate + rate),
        0.5 * (sum_rate - rate),
    ];
    for (found, exact) in state.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-13, "{found} {exact}");
    }
}

/// Eight masses in a row, of which the last meets a stop.
#[test]
fn a_chain_with_a_stop() {
    let n = 8;
    let stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let direction: Vec<_> = (0..n).map(|i| if i + 1 == n { 1.0 } else { 0.0 }).collect();
    let stop = Contact::new(Spring)
        .arguments([20.0])
        .direction(direction)
        .offset(0.1);
    let chain = Structure::of(&DMatrix::identity(n, n), &(0.02 * &stiffness), &stiffness)
        .cosine(0, 1, 0.3)
        .sine(2, 3, 0.1)
        .contact(stop)
        .build()
        .unwrap();
    let mut flow = flow(&chain, 0.4);
    let mut state = vec![0.05; 2 * n];
    let mut exact = state.clone();
    let mut tangent = Tangent::of_state(n, None);
    flow.advance(0.0, 11.0, &mut state, Some(&mut tangent), None)
        .unwrap();
    let crossings = Reference::new(&chain, 0.4).advance(0.0, 11.0, 0.02, &mut exact);
    assert!(
        crossings > 4 && flow.work().switches == crossings,
        "{crossings}"
    );
    let growth = tangent
        .columns
        .iter()
        .fold(1.0_f64, |size, x| size.max(x.abs()));
    for (found, exact) in state.iter().zip(&exact) {
        assert!((found - exact).abs() < 1e-12 * growth, "{found} {exact}");
    }
}
