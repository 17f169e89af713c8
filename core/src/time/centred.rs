//! Motions of a system that turns freely, less what is known of the turning: see [`Centre`].
//!
//! Its period map has the multiplier one for every shift, and once more for every constant speed, so that nothing tells which of these orbits is
//! meant, and rounding alone lets a motion drift. Here a state is taken to the one that does not drift after each stretch that is asked for.

use std::sync::Arc;

use super::{Flow, FlowError, See, Tangent, Work};
use crate::model::layout::Layout;
use crate::model::rigid::Place;
use crate::model::rigid::centre::Centre;
use crate::system::{System, Variable};

/// Central differences by a parameter are taken over this part of its value: masses, by which the centre depends on it, are smooth.
const STEP: f64 = 1e-5;

/// A flow whose states have the rigid motion that is known.
pub(crate) struct Centred {
    flow: Box<dyn Flow>,
    system: Arc<dyn System>,
    layout: Layout,
    parameters: Vec<f64>,
    omega: f64,
    centre: Centre,
}

/// The flow itself, or that of a system that turns freely less its turning.
pub(crate) fn centred(
    flow: Box<dyn Flow>,
    system: &Arc<dyn System>,
    parameters: &[f64],
    omega: f64,
) -> Box<dyn Flow> {
    let layout = Layout::of(system.as_ref());
    let Some(centre) = centre(system.as_ref(), &layout, parameters, omega) else {
        return flow;
    };
    Box::new(Centred {
        flow,
        system: Arc::clone(system),
        layout,
        parameters: parameters.to_vec(),
        omega,
        centre,
    })
}

/// What is known of the turning of a system, if it turns freely.
pub(crate) fn centre(
    system: &dyn System,
    layout: &Layout,
    parameters: &[f64],
    omega: f64,
) -> Option<Centre> {
    Centre::at(Place {
        system,
        layout,
        parameters,
        omega,
        variable: Variable::Omega,
    })
}

impl Centred {
    fn place(&self, variable: Variable) -> Place<'_> {
        Place {
            system: self.system.as_ref(),
            layout: &self.layout,
            parameters: &self.parameters,
            omega: self.omega,
            variable,
        }
    }

    /// The centre where a variable has another value.
    fn at(&self, variable: Variable, value: f64) -> Option<Centre> {
        let mut parameters = self.parameters.clone();
        Centre::at(self.place(variable).moved(value, &mut parameters))
    }

    /// How a state changes with a variable by the centre alone; zero where there is none beside the value.
    fn slope(&self, variable: Variable, phase: f64, state: &[f64]) -> Vec<f64> {
        let value = self.place(variable).value();
        let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
        let taken = |value: f64| {
            let mut state = state.to_vec();
            self.at(variable, value)?.take(phase, &mut state);
            Some(state)
        };
        let (Some(below), Some(above)) = (taken(value - step), taken(value + step)) else {
            return vec![0.0; state.len()];
        };
        let pairs = above.iter().zip(&below);
        pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
    }
}

impl Flow for Centred {
    fn coordinates(&self) -> usize {
        self.flow.coordinates()
    }

    fn admits(&self, variable: Variable, value: f64) -> bool {
        self.flow.admits(variable, value)
    }

    fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        let before = self.place(variable).value();
        self.flow.set(variable, value)?;
        if value == before {
            return Ok(());
        }
        let Some(centre) = self.at(variable, value) else {
            self.flow.set(variable, before)?;
            return Err(FlowError::Value { variable, value });
        };
        match variable {
            Variable::Omega => self.omega = value,
            Variable::Parameter(index) => self.parameters[index] = value,
        }
        self.centre = centre;
        Ok(())
    }

    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        mut tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        self.flow
            .advance(from, to, state, tangent.as_deref_mut(), see)?;
        if let Some(Tangent { columns, by }) = tangent {
            for column in columns.chunks_exact_mut(state.len()) {
                self.centre.take_homogeneous(column);
            }
            if let Some(variable) = *by {
                let first = columns.len() - state.len();
                let slope = self.slope(variable, to, state);
                for (x, slope) in columns[first..].iter_mut().zip(slope) {
                    *x += slope;
                }
            }
        }
        self.centre.take(to, state);
        Ok(())
    }

    fn work(&self) -> Work {
        self.flow.work()
    }
}
