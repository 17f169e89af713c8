//! The parameters of a model by their names: which may vary, and which values they may have.

use hertzian::System;
use hertzian::law::Bound;
use hertzian::system::{ParameterFacts, SystemFacts};

use crate::error::StudyError;
use crate::plan::Plan;
use crate::study::Study;

/// Names of parameters, with that of the frequency at the end.
pub(crate) struct Names {
    names: Vec<String>,
    facts: SystemFacts,
}

impl Names {
    pub(crate) fn of(system: &dyn System, plan: &Plan) -> Self {
        let facts = system.facts().clone();
        let mut names: Vec<String> = facts
            .parameters
            .iter()
            .map(|parameter| parameter.name.to_string())
            .collect();
        if plan.request.vary != "omega" {
            names.push("omega".to_owned());
        }
        Self { names, facts }
    }

    /// Whether there is a parameter besides one.
    pub(crate) fn has_another(&self, name: &str) -> bool {
        self.facts.parameters.iter().any(|facts| facts.name != name)
    }

    /// The names of all but one.
    pub(crate) fn besides(&self, name: &str) -> Vec<String> {
        let others = self.names.iter().filter(|other| *other != name);
        others.cloned().collect()
    }

    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Whether this may vary from variant to variant.
    pub(crate) fn varies(&self, key: &str, name: &str, plan: &Plan) -> Result<(), StudyError> {
        if name == plan.request.vary {
            let message = format!("{name} varies along each branch, from `from` to `to`");
            return Err(StudyError::value(key, message));
        }
        if plan.parameters.contains_key(name) || (name == "omega" && plan.request.omega.is_some()) {
            let message = format!("{name} has a value for all variants already");
            return Err(StudyError::value(key, message));
        }
        self.known(key, name).map(|_| ())
    }

    pub(crate) fn known(&self, key: &str, name: &str) -> Result<usize, StudyError> {
        self.place(name).ok_or_else(|| {
            let known = match self.names.join(", ") {
                known if known.is_empty() => "the model has none".to_owned(),
                known => format!("there are {known}"),
            };
            StudyError::value(key, format!("no parameter `{name}`: {known}"))
        })
    }

    /// Whether a value is in the range of its parameter.
    pub(crate) fn admits(&self, key: &str, name: &str, value: f64) -> Result<(), StudyError> {
        let parameter = self
            .facts
            .parameters
            .iter()
            .find(|facts| facts.name == name);
        match parameter {
            Some(facts) if !facts.admits(value) => {
                let message = format!(
                    "{value} is outside of the range of {name}, {}",
                    range(facts)
                );
                Err(StudyError::value(key, message))
            }
            None if name == "omega" && !(value.is_finite() && value > 0.0) => Err(
                StudyError::value(key, format!("omega = {value} is not positive")),
            ),
            _ => Ok(()),
        }
    }

    /// The values that the system has, with those that the study gives.
    pub(crate) fn held(&self, study: &Study, plan: &Plan) -> Result<Vec<f64>, StudyError> {
        let mut values = vec![0.0; self.facts.parameters.len()];
        study.system.values(&mut values);
        let parameters = plan.parameters.iter();
        for (name, &value) in parameters.filter(|(name, _)| !study.constants.contains(name)) {
            let key = format!("parameters.{name}");
            let place = self.known(&key, name)?;
            let message = "the frequency is `omega` of `request`";
            *values
                .get_mut(place)
                .ok_or_else(|| StudyError::value(key.as_str(), message))? = value;
            self.admits(&key, name, value)?;
        }
        Ok(values)
    }

    /// Whether every parameter has a value, or varies.
    pub(crate) fn complete(
        &self,
        values: &[f64],
        vary: &[String],
        plan: &Plan,
    ) -> Result<(), StudyError> {
        let along = &plan.request.vary;
        for (name, value) in self.names.iter().zip(values) {
            if value.is_nan() && !vary.contains(name) && name != along {
                let message = format!("{name} has no value: give one, or let it vary");
                return Err(StudyError::value("parameters", message));
            }
        }
        if along != "omega" {
            if !self.names.contains(along) {
                return self.known("request.vary", along).map(|_| ());
            }
            if plan.request.omega.is_none() && !vary.iter().any(|name| name == "omega") {
                let message = format!("{along} varies: which frequency do the branches have?");
                return Err(StudyError::value("request.omega", message));
            }
        } else if plan.request.omega.is_some() {
            let message = "the frequency varies along each branch, from `from` to `to`";
            return Err(StudyError::value("request.omega", message));
        }
        Ok(())
    }
}

/// The range of a parameter in words.
fn range(facts: &ParameterFacts) -> String {
    let low = match facts.minimum {
        Bound::Included(value) => Some(format!("{value} or more")),
        Bound::Excluded(value) => Some(format!("more than {value}")),
        Bound::Unbounded => None,
    };
    let high = match facts.maximum {
        Bound::Included(value) => Some(format!("{value} or less")),
        Bound::Excluded(value) => Some(format!("less than {value}")),
        Bound::Unbounded => None,
    };
    let both: Vec<String> = low.into_iter().chain(high).collect();
    match both.join(" and ") {
        range if range.is_empty() => "all numbers".to_owned(),
        range => range,
    }
}
