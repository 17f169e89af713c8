//! Powers and functions of terms: of constants, of waves, and of the motion.

use crate::ast::Expr;
use crate::dag::{Function, Id, Node, Rational, Variable};
use crate::differentiate::differentiate;
use crate::errors::{Extent, shortened};
use crate::simplify::factors_of;

use super::expand::Expander;
use super::interval::Stretch;
use super::rules::powers;
use super::term::{Term, collect};
use super::wave::Wave;
use super::written::{Quote, Written};

impl Expander {
    pub(super) fn power(
        &mut self,
        base: Vec<Term>,
        exponent: Id,
        quote: Quote,
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let whole = self.dag.as_number(exponent).and_then(Rational::to_integer);
        if base.iter().all(Term::is_constant) {
            let base = self.constant(&base, extent, "the base")?;
            let power = self.dag.power(base, exponent);
            powers::power_is_defined(self, base, exponent, Stretch::ALL, Some(&quote))
                .map_err(|message| extent.fault(message))?;
            return Ok(vec![Term::constant(power, extent)]);
        }
        if base.iter().any(Term::moves) {
            if whole == Some(1) {
                return Ok(base);
            }
            let base = self.value(&base, extent)?;
            let power = self.dag.power(base, exponent);
            self.written
                .push(Written::power(power, base, quote, extent));
            return Ok(self.nonlinear(power, extent));
        }
        let Some(whole @ 0..=8) = whole else {
            return Err(extent.fault(
                "not harmonic in omega*t: time may stand only in cos and sin, their sums, products and whole powers up to 8",
            ));
        };
        let one = self.dag.integer(1);
        let mut product = vec![Term::constant(one, extent)];
        for _ in 0..whole {
            product = self.multiply(&product, &base, extent)?;
        }
        Ok(product)
    }

    pub(super) fn function(
        &mut self,
        function: Function,
        operand: &[Term],
        written: &Expr,
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let trigonometric = matches!(function, Function::Sine | Function::Cosine);
        if operand.iter().any(Term::moves) {
            let operand = self.value(operand, extent)?;
            let value = self.dag.call(function, operand);
            self.note_switch(value, &Quote::switch(written), extent);
            return Ok(self.nonlinear(value, extent));
        }
        if trigonometric {
            if operand.iter().all(Term::is_constant) {
                self.omega_is_no_angle(operand, written, extent)?;
            }
            return self.oscillation(function == Function::Sine, operand, extent);
        }
        steady(operand, extent)?;
        let operand = self.constant(operand, extent, "the operand")?;
        let value = self.without_step(function, operand);
        Ok(vec![Term::constant(value, extent)])
    }

    /// The larger of two, or the smaller: `max(a, b) = a H(a - b) + b H(b - a)`, which is continuous.
    pub(super) fn extremum(
        &mut self,
        larger: bool,
        of: [&Expr; 2],
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let [first, second] = [self.expand(of[0])?, self.expand(of[1])?];
        let moves = first.iter().chain(&second).any(Term::moves);
        if !moves {
            steady(&first, extent)?;
            steady(&second, extent)?;
        }
        let [first, second] = [self.value(&first, extent)?, self.value(&second, extent)?];
        let mut parts = Vec::new();
        for (own, other) in [(first, second), (second, first)] {
            let (minuend, subtrahend) = if larger { (own, other) } else { (other, own) };
            let excess = self.dag.difference(minuend, subtrahend);
            let chosen = if moves {
                let quote = if minuend == first {
                    Quote::difference(of[0], of[1])
                } else {
                    Quote::difference(of[1], of[0])
                };
                let step = self.dag.call(Function::Step, excess);
                self.note_switch(step, &quote, extent);
                step
            } else {
                self.without_step(Function::Step, excess)
            };
            parts.push(self.dag.product(&[own, chosen]));
        }
        if first == second {
            parts = vec![first];
        }
        let value = self.dag.sum(&parts);
        Ok(self.nonlinear(value, extent))
    }

    /// Notes what an absolute value, sign or step is taken of, which the graph has freed of constant factors.
    fn note_switch(&mut self, value: Id, quote: &Quote, extent: Extent) {
        for factor in factors_of(&self.dag, value) {
            if let Node::Call(Function::Absolute | Function::Sign | Function::Step, operand) =
                *self.dag.node(factor)
            {
                self.written
                    .push(Written::switch(operand, quote.clone(), extent));
            }
        }
    }

    /// A function of parameters; a step is written with the sign.
    fn without_step(&mut self, function: Function, operand: Id) -> Id {
        if function == Function::Step && self.dag.as_number(operand).is_none() {
            return super::resolve::step_as_sign(&mut self.dag, operand);
        }
        self.dag.call(function, operand)
    }

    /// A multiple of `omega` is an angle only with a time beside it: `cos(omega)` is a constant that nobody means.
    fn omega_is_no_angle(
        &mut self,
        operand: &[Term],
        written: &Expr,
        extent: Extent,
    ) -> syn::Result<()> {
        let coefficients: Vec<Id> = operand.iter().map(|term| term.coefficient).collect();
        let phase = self.dag.sum(&coefficients);
        let by_omega = differentiate(&mut self.dag, phase, Variable::Omega);
        let is_multiple = self
            .dag
            .as_number(by_omega)
            .is_some_and(|slope| !slope.is_zero());
        if is_multiple {
            let written = shortened(written);
            return Err(extent.fault(format!(
                "`{written}` is a frequency, not an angle, and this does not change with time: did you mean `omega*t`, as in `cos(omega*t)`?"
            )));
        }
        Ok(())
    }

    /// `cos(a omega t + phi)` as `cos phi cos(a omega t) - sin phi sin(a omega t)`, and the sine likewise.
    fn oscillation(
        &mut self,
        sine: bool,
        operand: &[Term],
        extent: Extent,
    ) -> syn::Result<Vec<Term>> {
        let (mut phase, mut rate) = (Vec::new(), Vec::new());
        for term in operand {
            match (term.time, term.wave == Wave::CONSTANT) {
                (0, true) => phase.push(term.coefficient),
                (1, true) => rate.push(term.coefficient),
                _ => return Err(extent.fault("not harmonic in omega*t: the argument must be a multiple of omega*t, plus a phase")),
            }
        }
        let (phase, rate) = (self.dag.sum(&phase), self.dag.sum(&rate));
        let multiple = self.multiple_of_omega(rate).ok_or_else(|| {
            extent.fault(
                "quasi-periodic: every frequency must be a rational multiple of omega, as in `cos(2/5*omega*t)`",
            )
        })?;
        let (cosine_of, sine_of) = (
            self.dag.call(Function::Cosine, phase),
            self.dag.call(Function::Sine, phase),
        );
        let parts = if sine {
            [(cosine_of, true), (sine_of, false)]
        } else {
            let minus = self.dag.negate(sine_of);
            [(cosine_of, false), (minus, true)]
        };
        let mut terms = Vec::new();
        for (coefficient, sine) in parts {
            if let Some((sign, wave)) = Wave::new(multiple, sine) {
                let sign = self.dag.number(sign);
                let coefficient = self.dag.product(&[coefficient, sign]);
                terms.push(Term {
                    wave,
                    ..Term::constant(coefficient, extent)
                });
            }
        }
        Ok(collect(&mut self.dag, terms))
    }

    fn multiple_of_omega(&mut self, rate: Id) -> Option<Rational> {
        let omega = self.dag.variable(Variable::Omega);
        let ratio = self.dag.quotient(rate, omega);
        self.dag.as_number(ratio)
    }
}

fn steady(operand: &[Term], extent: Extent) -> syn::Result<()> {
    if operand.iter().all(Term::is_steady) {
        return Ok(());
    }
    Err(extent.fault(
        "not harmonic in omega*t: write a Fourier series, as in `drive*cos(omega*t) + drive/3*cos(3*omega*t)`",
    ))
}
