//! Motions of a system that turns freely, less what is known of the turning: see [`Centre`].
//!
//! Its period map has the multiplier one for every shift, and once more for every constant speed, so that nothing tells which of these orbits is
//! meant, and rounding alone lets a motion drift. Here a state is taken to the one that does not drift after each stretch that is asked for.

use std::sync::Arc;

use super::{Flow, FlowError, See, Tangent, Work};
use crate::cancel::Cancel;
use crate::model::layout::Layout;
use crate::model::rigid::Place;
use crate::model::rigid::centre::{Centre, Room};
use crate::system::{System, Variable};

/// A flow whose states have the rigid motion that is known.
pub(crate) struct Centred {
    flow: Box<dyn Flow>,
    system: Arc<dyn System>,
    layout: Layout,
    parameters: Vec<f64>,
    omega: f64,
    centre: Centre,
    /// The same for other variables, by which derivatives have been asked for at the present values.
    beside: Vec<Centre>,
    room: Room,
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
        room: centre.room(),
        centre,
        beside: Vec::new(),
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

    /// Adds how a state changes with a variable by the centre alone; nothing where there is none beside the value.
    fn add_slope(&mut self, variable: Variable, phase: f64, state: &[f64], derivative: &mut [f64]) {
        let is_of = |centre: &&Centre| centre.variable() == variable;
        if !is_of(&&self.centre) && !self.beside.iter().any(|centre| is_of(&centre)) {
            self.beside
                .extend(self.at(variable, self.place(variable).value()));
        }
        let mut known = std::iter::once(&self.centre).chain(&self.beside);
        if let Some(centre) = known.find(is_of) {
            centre.add_slope(phase, state, derivative, &mut self.room);
        }
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
        self.beside.clear();
        Ok(())
    }

    fn until(&mut self, cancel: &Cancel) {
        self.flow.until(cancel);
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
                self.centre.take_homogeneous(column, &mut self.room);
            }
            let first = columns.len() - by.len() * state.len();
            let columns = columns[first..].chunks_exact_mut(state.len());
            for (&variable, column) in by.iter().zip(columns) {
                self.add_slope(variable, to, state, column);
            }
        }
        self.centre.take(to, state, &mut self.room);
        Ok(())
    }

    fn is_closed_form(&self) -> bool {
        self.flow.is_closed_form()
    }

    fn work(&self) -> Work {
        self.flow.work()
    }
}
