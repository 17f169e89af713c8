//! What charts say of a branch: the system with its parameters, and what is at the axes.

use crate::numeric::decimal::Decimal;
use crate::system::SystemFacts;

/// Title and axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Labels {
    /// The system, and everything that is the same all along the branch.
    pub title: String,
    /// What is varied: a parameter by its name and the first line of its documentation.
    pub varied: String,
    /// The size of an orbit, by its first coordinate.
    pub size: String,
}

impl Labels {
    /// At values of the parameters and of omega, of which one is varied.
    pub(crate) fn of(facts: &SystemFacts, varied: &str, parameters: &[f64], omega: f64) -> Self {
        let known = facts.parameters.iter().zip(parameters);
        let held = known.filter(|(parameter, _)| parameter.name != varied);
        let values = held
            .map(|(parameter, value)| format!("{} = {}", parameter.name, Decimal::plain(*value)));
        let omega = (varied != "omega").then(|| format!("omega = {}", Decimal::plain(omega)));
        let omega = omega.filter(|_| !parameters.is_empty());
        let labels = Self {
            title: facts.name.to_string(),
            varied: name_of(facts, varied),
            size: format!("peak-to-peak of {}", facts.coordinates[0]),
        };
        values
            .chain(omega)
            .fold(labels, |labels, value| labels.with(&value))
    }

    /// With one more value in the title.
    fn with(mut self, value: &str) -> Self {
        let first = !self.title.contains(": ");
        self.title += if first { ": " } else { ", " };
        self.title += value;
        self
    }

    /// Of orbits of this period.
    #[cfg(feature = "plot")]
    pub(crate) fn with_period(self, period: usize) -> Self {
        if period > 1 {
            self.with(&format!("period {period}"))
        } else {
            self
        }
    }
}

/// A parameter by its name and the first line of its documentation.
fn name_of(facts: &SystemFacts, varied: &str) -> String {
    if varied == "omega" {
        return "excitation frequency ω".to_owned();
    }
    let parameter = facts.parameters.iter().find(|p| p.name == varied);
    let documentation = parameter.and_then(|p| p.documentation.lines().next());
    match documentation.map(str::trim).filter(|line| !line.is_empty()) {
        Some(line) => format!("{varied} ({line})"),
        None => varied.to_owned(),
    }
}
