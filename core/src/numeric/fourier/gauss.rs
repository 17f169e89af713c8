//! Gauss-Legendre rules on `[0, 1]`, computed once per process.
//!
//! Source: Press et al. (2007), Numerical Recipes, section 4.6: Newton's method on the three-term recurrence.

use std::f64::consts::PI;
use std::sync::OnceLock;

/// Numbers of nodes that are kept: each at most a third more than the one before.
pub(crate) const COUNTS: [usize; 13] = [8, 12, 16, 20, 24, 32, 40, 48, 56, 64, 80, 96, 128];

/// Nodes and weights.
#[derive(Debug)]
pub(crate) struct Rule {
    /// In increasing order, inside `[0, 1]`.
    pub(crate) nodes: Vec<f64>,
    /// They sum to one.
    pub(crate) weights: Vec<f64>,
    /// For each of the highest degrees `n` below the number of nodes, `(2 n + 1) w_j P_n(s_j)`: the product with a
    /// function's values is its Legendre coefficient.
    pub(crate) highest: [Vec<f64>; CHECKED],
}

/// How many of the highest Legendre coefficients are known.
pub(crate) const CHECKED: usize = 3;

/// The smallest rule with at least this many nodes, or the largest there is.
pub(crate) fn rule(at_least: usize) -> &'static Rule {
    static RULES: [OnceLock<Rule>; COUNTS.len()] = [const { OnceLock::new() }; COUNTS.len()];
    let index = COUNTS
        .iter()
        .position(|&count| count >= at_least)
        .unwrap_or(COUNTS.len() - 1);
    RULES[index].get_or_init(|| legendre(COUNTS[index]))
}

fn legendre(count: usize) -> Rule {
    let n = count as f64;
    let mut rule = Rule {
        nodes: vec![0.0; count],
        weights: vec![0.0; count],
        highest: std::array::from_fn(|_| vec![0.0; count]),
    };
    for i in 0..count.div_ceil(2) {
        // With x = cos theta the node is sin^2(theta / 2) from the end, to full relative accuracy.
        let mut theta = PI * (i as f64 + 0.75) / (n + 0.5);
        let mut slope = 0.0;
        for _ in 0..10 {
            let x = theta.cos();
            let (mut p, mut before) = (1.0, 0.0);
            for j in 0..count {
                let j = j as f64;
                let next = ((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0);
                before = p;
                p = next;
            }
            let sine = theta.sin();
            // d P_n(cos theta) / d theta = n (x P_n - P_(n-1)) / sin theta
            slope = n * (x * p - before) / sine;
            let step = p / slope;
            theta -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        let s = (0.5 * theta).sin().powi(2);
        let weight = 1.0 / (slope * slope);
        rule.nodes[i] = s;
        rule.nodes[count - 1 - i] = 1.0 - s;
        rule.weights[i] = weight;
        rule.weights[count - 1 - i] = weight;
    }
    for (below, coefficients) in rule.highest.iter_mut().enumerate() {
        let degree = count - 1 - below;
        for (j, (s, w)) in rule.nodes.iter().zip(&rule.weights).enumerate() {
            coefficients[j] = (2.0 * degree as f64 + 1.0) * w * polynomial(degree, 2.0 * s - 1.0);
        }
    }
    rule
}

/// `P_n(x)`
fn polynomial(degree: usize, x: f64) -> f64 {
    let (mut p, mut before) = (1.0, 0.0);
    for j in 0..degree {
        let j = j as f64;
        let next = ((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0);
        before = p;
        p = next;
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_powers_exactly_up_to_their_degree() {
        for &count in &COUNTS {
            let rule = rule(count);
            assert_eq!(rule.nodes.len(), count);
            for degree in [0, 1, 2, 7, 2 * count as i32 - 1] {
                let sum: f64 = rule
                    .nodes
                    .iter()
                    .zip(&rule.weights)
                    .map(|(s, w)| w * s.powi(degree))
                    .sum();
                let exact = 1.0 / f64::from(degree + 1);
                assert!(
                    (sum - exact).abs() < 4e-15,
                    "{count} {degree} {sum} {exact}"
                );
            }
        }
    }

    #[test]
    fn highest_coefficients_are_those_of_legendre_polynomials() {
        let rule = rule(20);
        for (below, coefficients) in rule.highest.iter().enumerate() {
            for degree in 15..20 {
                let coefficient: f64 = rule
                    .nodes
                    .iter()
                    .zip(coefficients)
                    .map(|(s, c)| c * polynomial(degree, 2.0 * s - 1.0))
                    .sum();
                let expected = f64::from(u8::from(degree == 19 - below));
                assert!((coefficient - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_next_larger_rule_is_taken() {
        assert_eq!(rule(0).nodes.len(), 8);
        assert_eq!(rule(33).nodes.len(), 40);
        assert_eq!(rule(1000).nodes.len(), 128);
    }
}
