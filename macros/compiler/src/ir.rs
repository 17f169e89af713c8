//! The checked model: what lowering makes of a declaration, and what the later stages read.
//!
//! Every scalar is an expression in one shared graph, and everything but the laws is a coefficient with a place of the contract.

use hertzian_contract::system::{
    Bound, ContactFacts, OutputFacts, ParameterFacts, Place, SystemFacts,
};

use crate::dag::{Dag, Id};

/// A declared model, checked.
#[derive(Debug, Clone)]
pub struct Model {
    /// The graph that every [`Id`] below belongs to.
    pub dag: Dag,
    /// Visibility of the type to emit.
    pub visibility: syn::Visibility,
    /// Name of the type to emit.
    pub name: syn::Ident,
    /// Documentation of the type.
    pub documentation: String,
    /// The equations as written, and the constants and laws that are in them, in one line each.
    pub equation: String,
    /// Names of the coordinates; those of an array are `x[0]`, `x[1]`, and so on.
    pub coordinates: Vec<String>,
    /// Their units, empty for plain numbers; none at all where the declaration has no units.
    pub units: Vec<String>,
    /// Parameters in order of declaration.
    pub parameters: Vec<Parameter>,
    /// Base frequency is `omega / divisor`.
    pub divisor: u32,
    /// Distinct laws.
    pub laws: Vec<Law>,
    /// Terms `e_c phi_c`; the law of each.
    pub contacts: Vec<ContactFacts>,
    /// Coefficients: functions of parameters and omega, with their places.
    pub coefficients: Vec<(Place, Id)>,
    /// What is read.
    pub outputs: Vec<Output>,
}

/// A declared output; its coefficients are among those of the model.
#[derive(Debug, Clone)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its documentation.
    pub documentation: String,
    /// Its unit; empty where there is none, and for plain numbers.
    pub unit: String,
    /// What it is equal to, as written.
    pub written: String,
}

/// A declared parameter.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// Name of the field.
    pub name: syn::Ident,
    /// Its documentation.
    pub documentation: String,
    /// Its unit; empty where there is none, and for plain numbers.
    pub unit: String,
    /// Range.
    pub minimum: Bound,
    /// Range.
    pub maximum: Bound,
    /// Its value where none is given.
    pub default: Option<f64>,
}

impl Model {
    /// What is known of the system without evaluating it.
    pub fn facts(&self) -> SystemFacts {
        let parameters = self.parameters.iter().map(|parameter| {
            ParameterFacts::new(parameter.name.to_string())
                .documentation(parameter.documentation.clone())
                .unit(parameter.unit.clone())
                .range(parameter.minimum, parameter.maximum)
        });
        let outputs = self.outputs.iter().map(|output| {
            OutputFacts::new(output.name.clone())
                .documentation(output.documentation.clone())
                .unit(output.unit.clone())
        });
        SystemFacts::new(self.name.to_string())
            .equation(self.equation.clone())
            .coordinates(self.coordinates.iter().cloned())
            .units(self.units.iter().cloned())
            .parameters(parameters)
            .divisor(self.divisor)
            .contacts(self.laws.len(), self.contacts.iter().cloned())
            .places(self.coefficients.iter().map(|&(place, _)| place))
            .outputs(outputs)
    }
}

/// A force of one gap, its rate and arguments.
///
/// Its expressions contain only `Variable::Gap`, `Variable::Rate` and `Variable::Argument(i)`. No step, sign or
/// absolute value of the gap is left in a piece: lowering has resolved them, so that a piece is smooth inside, and
/// every base of a non-integer power is provably not negative on it (`gap`, `-gap`, `gap - b`, ...).
#[derive(Debug, Clone)]
pub struct Law {
    /// Name in the declaration, or one made up for a law found in the equation.
    pub name: String,
    /// Names of the arguments.
    pub arguments: Vec<String>,
    /// Ranges of the arguments, as far as known.
    pub ranges: Vec<(Bound, Bound)>,
    /// Levels in increasing order.
    pub levels: Vec<Level>,
    /// Forces of the `levels.len() + 1` pieces, in increasing order of the gap.
    pub pieces: Vec<Id>,
}

/// Where two pieces meet.
#[derive(Debug, Clone, Copy)]
pub struct Level {
    /// Its value, a function of the arguments.
    pub value: Id,
    /// The level itself belongs to the piece above.
    pub belongs_above: bool,
}
