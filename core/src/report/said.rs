//! Orbits and events in words.

use std::fmt::Write;

use crate::branches::branch::Branch;
use crate::branches::point::{DECIMALS, Event, Point};
use crate::numeric::decimal::Decimal;
use crate::report::unit::with;

impl Branch {
    /// An event in words: what happens, where, and the size of [what leads](Self::leading) there, with names where there are several,
    /// units, and as many digits as their errors bear.
    pub fn describe(&self, event: &Event) -> String {
        let Event {
            kind,
            point,
            error,
            contacts,
            ..
        } = event;
        let unit = self.model.unit_of_varied(&self.varied);
        let value = with(&Decimal::to_error(point.value, *error).to_string(), unit);
        let size = self.describe_size(point);
        let mut text = format!("{kind} at {value} (error {error:.0e}), {size}");
        if *contacts > 1 {
            // Writing to a string does not fail.
            let _ = write!(text, ", {contacts} contacts at once");
        }
        text
    }

    /// The size of [what leads](Self::leading) at an orbit in words: `peak-to-peak of tip 1.25 um`.
    pub fn describe_size(&self, point: &Point) -> String {
        let (wanted, model) = (self.leading(), &self.model);
        let measured = self.measured(&wanted, point).ok().flatten();
        let size = measured.unwrap_or(f64::NAN);
        let of_this = |_: &f64| self.accuracy_of().is_none_or(|name| name == wanted.name);
        let digits = match point.error.filter(of_this) {
            Some(error) => Decimal::to_error(size, error * size),
            None => Decimal::rounded(size, DECIMALS),
        };
        let name = match (model.outputs.len(), model.coordinates.len()) {
            (0, 1) => String::new(),
            _ => format!(" of {}", wanted.name),
        };
        let size = with(&digits.to_string(), model.unit_of(&wanted.name));
        format!("peak-to-peak{name} {size}")
    }
}
