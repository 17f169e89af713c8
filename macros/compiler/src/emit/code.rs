//! Straight-line operations as Rust expressions.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::dag::{Function, Variable};
use crate::tape::{Operation, Tape};

/// An expression that is used once is written in place if it has no more operations than this; a longer one is named.
const MAX_INLINE: usize = 6;

/// How tightly the outermost operation of an expression binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Sign,
    Atom,
}

/// An expression, how tightly it binds, and how many operations it holds.
#[derive(Clone)]
struct Expression {
    tokens: TokenStream,
    binding: Binding,
    size: usize,
}

/// A tape as code.
pub struct Code {
    /// `let t0 = ...;` for what is used more than once, or long.
    pub statements: TokenStream,
    /// One expression per root.
    pub roots: Vec<TokenStream>,
    /// The variables it uses.
    pub inputs: Vec<Variable>,
    /// The planned logarithms it uses.
    pub logarithms: Vec<usize>,
    /// The planned powers it uses.
    pub powers: Vec<usize>,
}

impl Code {
    /// Writes a tape; `name` gives the identifier of a variable.
    pub fn of(tape: &Tape, name: &dyn Fn(Variable) -> Ident) -> Self {
        let uses = tape.uses();
        let mut statements = TokenStream::new();
        let (mut inputs, mut logarithms, mut powers) = (Vec::new(), Vec::new(), Vec::new());
        let mut written: Vec<Expression> = Vec::new();
        let mut temporaries = 0;
        for (position, &operation) in tape.operations.iter().enumerate() {
            match operation {
                Operation::Input(variable) => inputs.push(variable),
                Operation::Logarithm(position) => logarithms.push(position),
                Operation::Planned(position) => powers.push(position),
                _ => {}
            }
            let mut expression = write(operation, &written, name);
            let short = expression.size <= MAX_INLINE;
            if expression.size > 0 && !(short && uses[position] == 1) {
                let temporary = format_ident!("t{temporaries}");
                temporaries += 1;
                let value = expression.tokens;
                statements.extend(quote!(let #temporary = #value;));
                expression = atom(quote!(#temporary), 0);
            }
            written.push(expression);
        }
        let roots = tape
            .roots
            .iter()
            .map(|&root| written[root].tokens.clone())
            .collect();
        Self {
            statements,
            roots,
            inputs,
            logarithms,
            powers,
        }
    }
}

/// The name of a planned logarithm.
pub fn logarithm(position: usize) -> Ident {
    format_ident!("l{position}")
}

/// The name of a planned power.
pub fn power(position: usize) -> Ident {
    format_ident!("p{position}")
}

/// The name of a base that is chosen by piece.
pub fn base(position: usize) -> Ident {
    format_ident!("b{position}")
}

fn atom(tokens: TokenStream, size: usize) -> Expression {
    Expression {
        tokens,
        binding: Binding::Atom,
        size,
    }
}

/// Two operands with a sign between them.
fn binary(operands: [&Expression; 2], sign: &TokenStream, binding: Binding) -> Expression {
    let [left, right] = operands;
    let size = left.size + right.size + 1;
    // The right operand needs brackets at equal binding: the order of operations is that of the tape.
    let left = bracketed(left, left.binding < binding);
    let right = bracketed(right, right.binding <= binding);
    Expression {
        tokens: quote!(#left #sign #right),
        binding,
        size,
    }
}

/// A call of a function of the runtime.
fn call(function: &str, operands: &[&Expression]) -> Expression {
    let size: usize = operands.iter().map(|operand| operand.size).sum();
    let operands = operands.iter().map(|operand| &operand.tokens);
    let function = format_ident!("{function}");
    atom(quote!(__emitted::#function(#(#operands),*)), size + 1)
}

/// The name of what the runtime calls for a function.
fn name_of(function: Function) -> &'static str {
    match function {
        Function::Sign => "sign",
        Function::Step => "step",
        Function::Absolute => "absolute",
        Function::Sine => "sine",
        Function::Cosine => "cosine",
        Function::Exponential => "exponential",
        Function::Tanh => "tanh",
    }
}

fn write(
    operation: Operation,
    written: &[Expression],
    name: &dyn Fn(Variable) -> Ident,
) -> Expression {
    let two = |a: usize, b: usize| [&written[a], &written[b]];
    match operation {
        Operation::Number(value) => Expression {
            tokens: number(value),
            binding: if value.is_sign_negative() {
                Binding::Sign
            } else {
                Binding::Atom
            },
            size: 0,
        },
        Operation::Input(variable) => {
            let name = name(variable);
            atom(quote!(#name), 0)
        }
        Operation::Add(a, b) => binary(two(a, b), &quote!(+), Binding::Sum),
        Operation::Subtract(a, b) => binary(two(a, b), &quote!(-), Binding::Sum),
        Operation::Multiply(a, b) => binary(two(a, b), &quote!(*), Binding::Product),
        Operation::Divide(a, b) => binary(two(a, b), &quote!(/), Binding::Product),
        Operation::Negate(a) => {
            let operand = bracketed(&written[a], written[a].binding < Binding::Atom);
            Expression {
                tokens: quote!(-#operand),
                binding: Binding::Sign,
                size: written[a].size + 1,
            }
        }
        Operation::Call(function, a) => call(name_of(function), &[&written[a]]),
        Operation::Root(a) => call("root", &[&written[a]]),
        Operation::CubeRoot(a) => call("cube_root", &[&written[a]]),
        Operation::Reciprocal(a) => call("reciprocal", &[&written[a]]),
        Operation::Logarithm(position) => {
            let name = logarithm(position);
            atom(quote!(#name), 0)
        }
        Operation::Planned(position) => {
            let name = power(position);
            atom(quote!(#name), 0)
        }
        Operation::Power(base, exponent) => call("power", &two(base, exponent)),
        Operation::PowerLog(base, exponent) => call("power_log", &two(base, exponent)),
        Operation::Integer(base, exponent) => {
            let base = &written[base];
            let (tokens, size) = (&base.tokens, base.size + 1);
            let exponent = Literal::i32_unsuffixed(exponent);
            atom(quote!(__emitted::integer_power(#tokens, #exponent)), size)
        }
    }
}

fn bracketed(expression: &Expression, needed: bool) -> TokenStream {
    let tokens = &expression.tokens;
    if needed {
        quote!((#tokens))
    } else {
        quote!(#tokens)
    }
}

/// A double as Rust source.
pub fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        quote!(::core::primitive::f64::NAN)
    } else if value.is_infinite() {
        let magnitude = quote!(::core::primitive::f64::INFINITY);
        if value > 0.0 {
            magnitude
        } else {
            quote!(-#magnitude)
        }
    } else {
        let magnitude = Literal::f64_unsuffixed(value.abs());
        if value.is_sign_negative() {
            quote!(-#magnitude)
        } else {
            quote!(#magnitude)
        }
    }
}

/// A position or a length as Rust source.
pub fn position(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}
