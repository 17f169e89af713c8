//! Whether what was read of a branch belongs together: a file may have been written, or changed, by others.

use serde::de::Error as _;

use crate::branches::branch::Branch;
use crate::branches::point::{Event, Point};

impl Branch {
    /// Itself, if its numbers belong together.
    pub(super) fn checked(self) -> serde_json::Result<Self> {
        if !self.belongs_together() {
            let reason = "what it says of its model and of its events does not belong together";
            return Err(serde_json::Error::custom(reason));
        }
        match self.disagrees() {
            None => Ok(self),
            Some(at) => {
                let reason = format!("the numbers of the orbit at {at} disagree");
                Err(serde_json::Error::custom(reason))
            }
        }
    }

    /// Whether names, units and contacts of the model are as many as there must be, and events lie on the branch.
    fn belongs_together(&self) -> bool {
        let (model, points) = (&self.model, self.points.len());
        let parameter = |name: &str| model.parameters.iter().any(|own| own.name == name);
        let events = self.events.iter().map(|event| event.after);
        let mut after = events.chain(self.turns.iter().map(|turn| turn.after));
        [0, model.coordinates.len()].contains(&model.units.len())
            && [0, model.pieces.len()].contains(&model.contacts.len())
            && [0, model.pieces.len()].contains(&model.force_units.len())
            && (self.varied == "omega" || parameter(&self.varied))
            && after.all(|after| after <= points)
            && self.leaps.is_sorted_by(|a, b| a.after < b.after)
            && self
                .leaps
                .iter()
                .all(|leap| (1..points).contains(&leap.after))
    }

    /// Where an orbit, one of events too, has not as many numbers as those of the model.
    fn disagrees(&self) -> Option<f64> {
        if let Some(value) = self.changes_form() {
            return Some(value);
        }
        let events = self.events.iter().filter(|event| !self.holds_event(event));
        let points = self.points.iter().filter(|point| !self.holds(point));
        let mut points = points.chain(events.map(|event| &event.point));
        points.next().map(|point| point.value)
    }

    /// The value of an orbit that is not of the period and the form of the first one.
    fn changes_form(&self) -> Option<f64> {
        let form = |point: &Point| (point.orbit.period, point.orbit.states.len());
        let first = form(self.points.first()?);
        let events = self.events.iter().map(|event| &event.point);
        let mut others = self.points.iter().chain(events);
        let other = others.find(|point| form(point) != first);
        other.map(|point| point.value)
    }

    fn holds_event(&self, event: &Event) -> bool {
        let tangent = event.tangent.split_last();
        let tangent = tangent.filter(|_| event.point.orbit.states.is_empty());
        self.holds(&event.point) && tangent.is_none_or(|(_, series)| self.has_series(series))
    }

    fn holds(&self, point: &Point) -> bool {
        let (model, orbit, observed) = (&self.model, &point.orbit, &point.observed);
        let coordinates = model.coordinates.len();
        let contacts = observed.contacts.len();
        let mut pieces = observed.on_pieces.iter().zip(&model.pieces);
        orbit.is_of(coordinates)
            && observed.motions.len() == coordinates
            && point.parameters.len() == model.parameters.len()
            && [0, model.outputs.len()].contains(&observed.outputs.len())
            && [0, model.pieces.len()].contains(&contacts)
            && observed.on_pieces.len() == contacts
            && pieces.all(|(parts, pieces)| parts.len() == *pieces)
    }

    /// Whether these are a mean and pairs of cosine and sine for each coordinate.
    fn has_series(&self, series: &[f64]) -> bool {
        let coordinates = self.model.coordinates.len();
        series.len().is_multiple_of(coordinates) && (series.len() / coordinates) % 2 == 1
    }
}
