//! What the charts of results show, and how they look.

use hertzian::EventKind;
use hertzian::chart::{Frequency, Scale, View};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::event;
use crate::point::wanted;

/// What a chart shows.
pub fn view(of: Option<&str>, frequency: &str) -> PyResult<View> {
    let frequency = match frequency {
        "omega" => Frequency::Omega,
        "hertz" => Frequency::Hertz,
        "rpm" => Frequency::Rpm,
        _ => {
            return Err(PyValueError::new_err(format!(
                "{frequency} is no frequency: omega, hertz or rpm"
            )));
        }
    };
    let view = View::new().frequency(frequency);
    Ok(match of {
        Some(text) => view.of(wanted(text)?),
        None => view,
    })
}

/// How the chart of a branch looks.
pub struct Look {
    scale: Scale,
    stack: usize,
    events: Option<Vec<EventKind>>,
}

impl Look {
    pub fn new(scale: &str, stack: usize, events: Option<Vec<String>>) -> PyResult<Self> {
        let scale = match scale {
            "linear" => Scale::Linear,
            "log" => Scale::Logarithmic,
            "db" => Scale::Decibel,
            _ => {
                let text = format!("{scale} is no scale: linear, log or db");
                return Err(PyValueError::new_err(text));
            }
        };
        let kinds = events.map(|names| names.iter().map(|name| event::kind(name)).collect());
        Ok(Self {
            scale,
            stack,
            events: kinds.transpose()?,
        })
    }

    pub fn on(self, view: View) -> View {
        let view = view.scale(self.scale).harmonics(self.stack);
        match self.events {
            Some(kinds) => view.events(kinds),
            None => view,
        }
    }
}
