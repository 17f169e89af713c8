//! Polynomials in several coordinates as sums of powers of linear forms, each of which is a force of one gap:
//!
//! ```text
//! x y^2 = ((x + y)^3 + (x - y)^3 - 2 x^3)/6
//! ```
//!
//! Every monomial is such a sum. Two variables, with the forms `x + t y` for as many numbers `t` as it takes, which all
//! monomials of one degree share:
//!
//! ```text
//! x^(d-b) y^b = sum_i w_i (x + t_i y)^d,   binomial(d, j) sum_i w_i t_i^j = [j = b]  for j = 0..d            (1)
//! ```
//!
//! and any number of variables, by polarisation,
//!
//! ```text
//! 2^d d! prod_i x_i^a_i = sum_k (-1)^|k| prod_i binomial(a_i, k_i) (sum_i (a_i - 2 k_i) x_i)^d              (2)
//! ```

use crate::dag::{Dag, Id, Node, Rational, Variable};
use crate::simplify::expand;

use super::algebra::{addends, split_factor};
use super::expand::is_motion;

/// Larger than in any force, and small enough for exact numbers. A monomial of this degree has at most 128 forms.
pub(super) const LARGEST_DEGREE: i32 = 8;

/// A linear form, and what its power is multiplied by.
type Form = (Vec<Rational>, Rational);

/// The terms of a polynomial in coordinates, or in velocities, as powers of linear forms; terms of one gap, and those that do not
/// move, are returned as they are, and `None` where a term is neither.
pub fn powers_of_forms(
    dag: &mut Dag,
    id: Id,
    is_of_one_gap: impl Fn(&mut Dag, Id) -> bool,
) -> Option<Vec<Id>> {
    let expanded = expand(dag, id);
    let mut powers = Vec::new();
    for term in addends(dag, expanded) {
        let moving: Vec<Variable> = dag
            .variables(term)
            .into_iter()
            .filter(|&v| is_motion(v))
            .collect();
        if moving.is_empty() || is_of_one_gap(dag, term) {
            powers.push(term);
            continue;
        }
        let (factor, monomial) = split_factor(dag, term, &moving);
        let (variables, exponents) = exponents(dag, monomial)?;
        let degree: i32 = exponents
            .iter()
            .try_fold(0_i32, |sum, &own| sum.checked_add(own))?;
        if degree > LARGEST_DEGREE {
            return None;
        }
        let forms = match exponents[..] {
            [_, second] => forms_of_two(degree, second)?,
            _ => forms_of_many(degree, &exponents)?,
        };
        for (form, weight) in forms {
            let power = power_of_form(dag, &variables, &form, degree);
            let weight = dag.number(weight);
            powers.push(dag.product(&[weight, factor, power]));
        }
    }
    Some(powers)
}

fn power_of_form(dag: &mut Dag, variables: &[Id], form: &[Rational], degree: i32) -> Id {
    let mut terms = Vec::new();
    for (&variable, &coefficient) in variables.iter().zip(form) {
        let coefficient = dag.number(coefficient);
        terms.push(dag.product(&[coefficient, variable]));
    }
    let (sum, degree) = (dag.sum(&terms), dag.integer(degree));
    dag.power(sum, degree)
}

/// The variables of a monomial and their exponents: only coordinates, or only velocities.
fn exponents(dag: &Dag, monomial: Id) -> Option<(Vec<Id>, Vec<i32>)> {
    let factors = match dag.node(monomial) {
        Node::Product(factors) => factors.clone(),
        _ => vec![monomial],
    };
    let (mut variables, mut exponents) = (Vec::new(), Vec::new());
    for factor in factors {
        let (base, exponent) = match *dag.node(factor) {
            Node::Power(base, exponent) => (base, dag.as_number(exponent)?.to_integer()?),
            _ => (factor, 1),
        };
        if !matches!(dag.node(base), Node::Variable(_)) || exponent < 1 {
            return None;
        }
        variables.push(base);
        exponents.push(exponent);
    }
    let is_coordinate = |&id: &Id| matches!(dag.node(id), Node::Variable(Variable::Coordinate(_)));
    let is_velocity = |&id: &Id| matches!(dag.node(id), Node::Variable(Variable::Velocity(_)));
    (variables.iter().all(is_coordinate) || variables.iter().all(is_velocity))
        .then_some((variables, exponents))
}

/// (1), with `t = 0, infinity, 1, -1, 2, ...`; the form of `infinity` is `y`.
fn forms_of_two(degree: i32, second: i32) -> Option<Vec<Form>> {
    let mut forms = vec![
        vec![Rational::ONE, Rational::ZERO],
        vec![Rational::ZERO, Rational::ONE],
    ];
    for index in 2..=i128::from(degree) {
        let magnitude = index / 2;
        let t = if index % 2 == 0 {
            magnitude
        } else {
            -magnitude
        };
        forms.push(vec![Rational::ONE, Rational::integer(t)]);
    }
    let mut rows = Vec::new();
    for j in 0..=degree {
        let binomial = Rational::integer(binomial(degree, j));
        let mut row = Vec::new();
        for form in &forms {
            let powers = form[0]
                .integer_power(degree - j)?
                .checked_mul(form[1].integer_power(j)?)?;
            row.push(binomial.checked_mul(powers)?);
        }
        row.push(Rational::integer(i128::from(j == second)));
        rows.push(row);
    }
    let weights = solve(rows)?;
    let forms = forms.into_iter().zip(weights);
    Some(forms.filter(|(_, weight)| !weight.is_zero()).collect())
}

/// (2), with forms that are equal up to a factor merged.
fn forms_of_many(degree: i32, exponents: &[i32]) -> Option<Vec<Form>> {
    let mut divisor = Rational::integer(2).integer_power(degree)?;
    for factor in 1..=i128::from(degree) {
        divisor = divisor.checked_mul(Rational::integer(factor))?;
    }
    let mut merged: Vec<Form> = Vec::new();
    let mut choice = vec![0; exponents.len()];
    loop {
        let mut weight = divisor.reciprocal()?;
        let mut form = Vec::new();
        for (&own, &chosen) in exponents.iter().zip(&choice) {
            let sign = if chosen % 2 == 0 { 1 } else { -1 };
            weight = weight.checked_mul(Rational::integer(sign * binomial(own, chosen)))?;
            form.push(Rational::integer(i128::from(own - 2 * chosen)));
        }
        if let Some(&leading) = form.iter().find(|coefficient| !coefficient.is_zero()) {
            for coefficient in &mut form {
                *coefficient = coefficient.checked_div(leading)?;
            }
            weight = weight.checked_mul(leading.integer_power(degree)?)?;
            match merged.iter_mut().find(|(other, _)| *other == form) {
                Some((_, sum)) => *sum = sum.checked_add(weight)?,
                None => merged.push((form, weight)),
            }
        }
        // Counts up, one digit for each variable.
        let digit = (0..choice.len()).find(|&digit| choice[digit] < exponents[digit]);
        let Some(digit) = digit else { break };
        choice[digit] += 1;
        choice[..digit].fill(0);
    }
    merged.retain(|(_, weight)| !weight.is_zero());
    Some(merged)
}

fn binomial(n: i32, k: i32) -> i128 {
    (0..i128::from(k)).fold(1, |value, index| {
        value * (i128::from(n) - index) / (index + 1)
    })
}

/// Gauss-Jordan elimination, exactly; the last column is the right side.
fn solve(mut rows: Vec<Vec<Rational>>) -> Option<Vec<Rational>> {
    let size = rows.len();
    for column in 0..size {
        let pivot = (column..size).find(|&row| !rows[row][column].is_zero())?;
        rows.swap(column, pivot);
        let head = rows[column][column];
        for entry in &mut rows[column] {
            *entry = entry.checked_div(head)?;
        }
        let chosen = rows[column].clone();
        for (_, row) in rows
            .iter_mut()
            .enumerate()
            .filter(|(index, _)| *index != column)
        {
            let factor = row[column];
            for (entry, other) in row.iter_mut().zip(&chosen) {
                *entry = entry.checked_sub(factor.checked_mul(*other)?)?;
            }
        }
    }
    rows.into_iter().map(|row| row.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(forms: &[Form], degree: i32, point: &[f64]) -> f64 {
        let term = |(form, weight): &Form| {
            let terms = form.iter().zip(point).map(|(c, x)| c.to_f64() * x);
            weight.to_f64() * terms.sum::<f64>().powi(degree)
        };
        forms.iter().map(term).sum()
    }

    #[test]
    fn monomials_are_sums_of_powers() {
        let point = [0.7_f64, -1.3, 0.4];
        for degree in 2..=LARGEST_DEGREE {
            for second in 1..degree {
                let expected = point[0].powi(degree - second) * point[1].powi(second);
                for forms in [
                    forms_of_two(degree, second).unwrap(),
                    forms_of_many(degree, &[degree - second, second]).unwrap(),
                ] {
                    assert!((value(&forms, degree, &point) - expected).abs() < 1e-10);
                }
            }
        }
        let forms = forms_of_many(4, &[1, 2, 1]).unwrap();
        let expected = point[0] * point[1] * point[1] * point[2];
        assert!((value(&forms, 4, &point) - expected).abs() < 1e-14);
    }
}
