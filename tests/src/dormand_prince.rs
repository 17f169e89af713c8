//! A step of an integration that shares nothing with the library.
//!
//! Source: Dormand and Prince (1980), J. Comput. Appl. Math. 6, 19-26, RK5(4)7M.

/// Weights of the earlier stages in each stage but the first.
const A: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
    ],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
/// Places of these stages in a step.
const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
/// The fifth order less the fourth.
const E: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// The state after a step by the fifth order, and how far the fourth is from it; the first slope is known.
pub fn step<const N: usize>(
    time: f64,
    (state, first): (&[f64; N], [f64; N]),
    width: f64,
    slope: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> ([f64; N], [f64; N]) {
    let mut slopes = [first; 7];
    let mut next = *state;
    for (stage, row) in A.iter().enumerate() {
        next = std::array::from_fn(|i| {
            let sum: f64 = row.iter().zip(&slopes).map(|(a, slope)| a * slope[i]).sum();
            state[i] + width * sum
        });
        slopes[stage + 1] = slope(time + C[stage] * width, &next);
    }
    let apart = std::array::from_fn(|i| {
        let sum: f64 = E.iter().zip(&slopes).map(|(e, slope)| e * slope[i]).sum();
        (width * sum).abs()
    });
    (next, apart)
}

/// Of a polynomial of degree four in time both orders are exact, and of `x' = x` the fifth has the terms of the exponential.
#[test]
fn orders_are_what_they_are_said_to_be() {
    for degree in 0..5 {
        let slope = |t: f64, _: &[f64; 1]| [f64::from(degree + 1) * t.powi(degree)];
        let (next, apart) = step(0.5, (&[0.0], slope(0.5, &[0.0])), 1.5, slope);
        let exact = 2.0_f64.powi(degree + 1) - 0.5_f64.powi(degree + 1);
        assert!(
            (next[0] - exact).abs() < 1e-12 * exact,
            "{degree}: {next:?}"
        );
        assert!(
            degree > 3 || apart[0] < 1e-12 * exact,
            "{degree}: {apart:?}"
        );
    }
    let exponential = |width: f64| {
        let (next, apart) = step(0.0, (&[1.0], [1.0]), width, |_, x| *x);
        [(next[0] - width.exp()).abs(), apart[0]]
    };
    let [coarse, fine] = [0.1, 0.05].map(exponential);
    let orders = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
    assert!(orders[0] > 5.8 && orders[1] > 4.8, "{orders:?}");
}
