//! The procedural macros of `hertzian`: a thin wrapper around `hertzian-compiler`.
//!
//! Depend on `hertzian`, which re-exports them: generated code calls it.

use proc_macro::TokenStream;

/// Declares a system of oscillators: a type with one public `f64` field per parameter, which implements
/// `hertzian::system::System`.
///
/// # Grammar
///
/// ```text
/// model       = { doc } [ visibility ] name "(" coordinate { "," coordinate } [ "," ] ")" "{" { item } "}"
/// coordinate  = name [ "[" number "]" ] [ ":" unit ]
/// item        = { doc } ( parameter | law | let | statement )
/// parameter   = "param" name [ ":" unit ] [ "=" bound ] [ range ] ";"
/// range       = "in" [ bound ] ( ".." | "..=" ) [ bound ] | ( ">" | ">=" | "<" | "<=" ) bound
/// bound       = [ "-" ] number
/// unit        = factor { ( "*" | "/" ) factor }
/// factor      = ( symbol | "1" | "(" unit ")" ) [ "^" ( bound | "(" bound [ "/" bound ] ")" ) ]
/// law         = "law" name "(" name { "," name } [ "," ] ")" pieces
/// pieces      = "{" ( expression | piece { "," piece } [ "," ] ) "}"
/// piece       = ( condition | "else" ) "=>" expression
/// condition   = chain { "&&" chain }
/// chain       = expression relation expression { relation expression }
/// relation    = ">" | ">=" | "<" | "<="
/// let         = "let" name "=" expression ";"
/// statement   = equation | "for" head "{" { let } { statement } "}"
/// equation    = expression "=" expression ";"
/// head        = name "in" expression ( ".." | "..=" ) expression
/// expression  = product { ( "+" | "-" ) product }
/// product     = signed { ( "*" | "/" ) signed }
/// signed      = ( "-" | "+" ) signed | power
/// power       = operand [ "^" signed ]
/// operand     = number | name | name "[" expression "]" | name "(" expression { "," expression } ")"
///             | "(" expression ")" | "|" expression "|" | "for" head "{" { let } expression "}"
/// ```
///
/// The chapter "Declaring contacts" of the book has an example of each production.
///
/// A power binds tighter than a sign in front of it and to the right: `-x^2` is `-(x^2)`, `2^3^2` is `2^9`. Products need
/// their star: `2*zeta`. Numbers are exact: `1.5` is three halves.
///
/// # Names
///
/// - `omega` is the frequency of excitation, `t` is time, `pi` is the number.
/// - `dot` and `ddot` are the first and second derivative by time.
/// - `H` is the step (one for a positive operand, zero otherwise), `sgn` the sign, `abs(x)` or `|x|` the absolute value.
/// - `cos`, `sin`, `exp`, `tanh` and `sqrt` are what they are everywhere, and so are `max` and `min`, of two operands.
///
/// # Arrays and loops
///
/// `Chain(x[64])` has the coordinates `x[0]` to `x[63]`. A loop around equations repeats them, and a loop around a term
/// is the sum of its repetitions. Both are written out while compiling, so the ends of a range and every index are made
/// of whole numbers, indices of loops, and `let` items that are numbers.
///
/// ```text
/// for j in 1..63 { ddot(x[j]) + contact(x[j] - x[j + 1]) - contact(x[j - 1] - x[j]) = 0; }
/// m*ddot(y) + for j in 0..8 { cos(2*pi*j/8)*contact(y*cos(2*pi*j/8) - clearance) } = 0;
/// ```
///
/// # Defaults and units
///
/// If every parameter has a default (`param k = 1e9;`), the type implements `Default`. If every parameter and every
/// coordinate has a unit, the equations are checked for them; `1` is the unit of a plain number. Exponents of units are
/// exact, as in `N/m^1.5`. A power whose exponent is a parameter has a plain number as its base. Values are used as they
/// are: `mm` and `m` do not agree.
///
/// # Equations
///
/// Each coordinate has one equation. What depends on the motion stands on the left; constants and forcing may stand on
/// either side. Forcing is a sum of products of `cos` and `sin` of rational multiples of `omega*t`, with phases
/// (`cos(2/5*omega*t + phi)`) and coefficients that may depend on parameters and `omega`.
///
/// Terms that are linear in the coordinates become mass, damping and stiffness, the stiffness also with harmonic
/// coefficients: `(1 + e*cos(2*omega*t))*x`. All others are forces of a *gap*, a fixed combination of coordinates. They may
/// be written in place, and are grouped by gap:
///
/// ```text
/// ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
/// ```
///
/// # Laws
///
/// A law is a force of its gap, of the rate `dot(gap)` and of arguments, in pieces or as one expression. It may use every
/// parameter. Pieces are bounded by comparisons of the gap with numbers and parameters, and hold every gap once; which
/// level is the higher one follows from the ranges of the parameters.
///
/// ```text
/// param play > 0;
/// law backlash(gap, k) {
///     gap > play  => k*(gap - play),
///     gap < -play => k*(gap + play),
///     else        => 0,
/// }
/// ```
///
/// The gap of a call is linear in the coordinates and may move with time; a factor of the force may as well:
///
/// ```text
/// ddot(x) + cos(omega*t)*contact(x*cos(omega*t) + y*sin(omega*t) - clearance) = 0;
/// ```
///
/// The base of a power that is not whole must not be negative on its piece (`max(0, u)` never is), and where it can vanish
/// the exponent must be positive: declare `param alpha > 0;`. A force may jump where the gap crosses a level. It may not jump with the rate, as
/// dry friction does; it may have a kink there, as `max(0, k*gap + c*dot(gap))` has.
///
/// A force depends on one gap. Polynomials of several coordinates, or of several velocities, are taken apart into powers
/// of sums: `x*y^2` is `((x + y)^3 + (x - y)^3 - 2*x^3)/6`. Other mixtures are refused.
#[proc_macro]
pub fn oscillator(declaration: TokenStream) -> TokenStream {
    hertzian_compiler::oscillator(declaration.into()).into()
}

/// Declares a law without a model: a type without fields that implements `hertzian::law::Law`, to be attached to the
/// matrices of a `hertzian::structure::Structure` while the program runs.
///
/// # Grammar
///
/// ```text
/// alone       = { doc } [ visibility ] name "(" name { "," argument } [ "," ] ")" pieces
/// argument    = name [ range ]
/// ```
///
/// The first name is that of the gap. `pieces` and `range` are those of [`oscillator!`], with the same rules: an
/// exponent whose base can vanish must be positive, and it must be known which level is the higher one. Here the ranges
/// of the arguments say so, where a law in a model goes by the ranges of the parameters. A structure refuses values
/// outside of them; `hertzian::law::LawFacts` holds them. An argument has neither default nor unit. A law that is linear in gap and
/// rate everywhere is refused: it belongs into the matrices.
#[proc_macro]
pub fn law(declaration: TokenStream) -> TokenStream {
    hertzian_compiler::law(declaration.into()).into()
}
