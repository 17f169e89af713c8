//! The numerical flow of any system: collocation of high order, from switch to switch.
//!
//! Each step is a Gauss-Legendre collocation whose polynomial is the motion itself, as accurate between the nodes as at its
//! ends. A step never passes a level: it ends there. Beside a level at which the force has a broken power of the distance,
//! steps are graded so that the motion is analytic in the variable that the polynomial is in. Errors are those of the
//! first Legendre coefficient left out, relative to the largest coordinates and rates since the motion began.
//!
//! Steps are explicit in that they are iterated: a vibration with an angle of more than about `S` on the step makes them
//! shorter than accuracy would.

mod crossing;
mod engine;
mod kept;
mod kink;
mod map;
mod noise;
mod piece_switch;
mod roots;
pub(super) mod rule;
mod step;
mod step_control;
mod tangent;
#[cfg(test)]
mod tests;
mod view;

use super::error::{admits, check_entries};
use super::field::Field;
use super::{Flow, FlowError, See, Show, Stretch, Tangent, Work};
use crate::cancel::Cancel;
use crate::error::Error;
use crate::model::error::ModelError;
use crate::model::validate;
use crate::system::{System, Variable};
use crate::time::MotionError;
use engine::Engine;

/// The flow of a system by numerical integration.
pub struct Integrated {
    engine: Rank,
}

impl std::fmt::Debug for Integrated {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Integrated")
            .field("coordinates", &self.coordinates())
            .field("work", &self.work())
            .finish_non_exhaustive()
    }
}

/// The engine, by its number of nodes.
enum Rank {
    Low(Box<Engine<8>>),
    Middle(Box<Engine<12>>),
    High(Box<Engine<16>>),
}

macro_rules! engine {
    ($self:expr, $engine:ident => $result:expr) => {
        match $self {
            Rank::Low($engine) => $result,
            Rank::Middle($engine) => $result,
            Rank::High($engine) => $result,
        }
    };
}

impl Integrated {
    /// The flow of a system at values of its parameters and at a frequency. The tolerance is the error allowed in the
    /// states of a motion, relative to its largest ones; tangents are held to the same.
    ///
    /// # Errors
    /// If a parameter, the frequency or the tolerance is outside its range, levels are out of order, the mass matrix is singular,
    /// or the system has no coordinates.
    pub fn new(
        system: &dyn System,
        values: &[f64],
        omega: f64,
        tolerance: f64,
    ) -> Result<Self, Error> {
        validate::option(
            "tolerance",
            tolerance,
            1e-14..=1e-2,
            "must be between 1e-14 and 1e-2",
        )?;
        if system.facts().coordinates.is_empty() {
            return Err(ModelError::NoCoordinates.into());
        }
        validate::values(system, values, omega)?;
        let field = Field::new(system, values, omega).map_err(|reason| match reason {
            FlowError::SingularMass { determinant } => {
                ModelError::SingularMass { determinant }.into()
            }
            _ => Error::from(MotionError {
                value: omega,
                reason,
            }),
        })?;
        let engine = match tolerance {
            t if t > 1e-6 => Rank::Low(Box::new(Engine::new(field, tolerance))),
            t if t > 1e-9 => Rank::Middle(Box::new(Engine::new(field, tolerance))),
            _ => Rank::High(Box::new(Engine::new(field, tolerance))),
        };
        Ok(Self { engine })
    }
}

impl Flow for Integrated {
    fn coordinates(&self) -> usize {
        engine!(&self.engine, engine => engine.field.coordinates())
    }

    fn admits(&self, variable: Variable, value: f64) -> bool {
        engine!(&self.engine, engine => admits(engine.field.system.as_ref(), variable, value))
    }

    fn set(&mut self, variable: Variable, value: f64) -> Result<(), FlowError> {
        engine!(&mut self.engine, engine => engine.set(variable, value))
    }

    fn until(&mut self, cancel: &Cancel) {
        engine!(&mut self.engine, engine => engine.cancel = cancel.clone());
    }

    fn advance(
        &mut self,
        from: f64,
        to: f64,
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        check_entries(self.coordinates(), state, tangent.as_deref())?;
        let tangent = tangent.filter(|tangent| !tangent.columns.is_empty());
        let Some(see) = see else {
            return engine!(&mut self.engine, engine => engine.advance(from, to, state, tangent, None));
        };
        engine!(&mut self.engine, engine => {
            engine.advance(from, to, state, tangent, Some(&mut |view| see(view)))
        })
    }

    fn advance_by(
        &mut self,
        [from, to]: [f64; 2],
        stops: &[f64],
        state: &mut [f64],
        tangent: &mut Tangent,
        show: Show<'_>,
    ) -> Result<(), FlowError> {
        check_entries(self.coordinates(), state, Some(tangent))?;
        let side = if to < from { -1.0 } else { 1.0 };
        let mut next = 0;
        // What is shown, apart from what moves.
        let mut at = state.to_vec();
        let mut columns = tangent.columns.clone();
        engine!(&mut self.engine, engine => {
            engine.advance(from, to, state, Some(tangent), Some(&mut |view| {
                let (begin, end) = view.phases();
                while let Some(&stop) = stops.get(next).filter(|&&stop| side * (stop - end) <= 0.0) {
                    let stop = if side * (stop - begin) < 0.0 { begin } else { stop };
                    view.tangent(stop, &mut at, &mut columns);
                    show(next, &at, &columns);
                    next += 1;
                }
            }))
        })?;
        for number in next..stops.len() {
            show(number, state, &tangent.columns);
        }
        Ok(())
    }

    fn work(&self) -> Work {
        engine!(&self.engine, engine => engine.work)
    }
}
