//! Where a structure is pushed and read.

use crate::description::direction::Direction;
use crate::description::load::LoadKind;
use crate::description::structure::SparseStructure;

/// Where a structure is pushed and read.
pub(super) struct Directions {
    /// Of all rows of a [`Reduced`], in its order.
    pub(super) rows: Vec<Vec<f64>>,
    /// Those of contacts and loads, whose static responses are kept in every step, then of outputs.
    pub(super) attached: Vec<Vec<f64>>,
    /// How many of them are contacts and loads.
    pub(super) driven: usize,
}

impl Directions {
    pub(super) fn of(structure: &SparseStructure) -> Self {
        let n = structure.coordinates();
        let full = |direction: &Direction| direction.full(n);
        let contacts = structure
            .contacts
            .iter()
            .flat_map(|contact| [full(&contact.gap), full(contact.second())]);
        let loads = structure.loads.iter().map(|load| match load.kind {
            LoadKind::Force | LoadKind::Unbalance => full(&load.direction),
            LoadKind::Base | LoadKind::Acceleration => structure.mass.times(&full(&load.direction)),
        });
        let driven: Vec<Vec<f64>> = contacts.chain(loads).collect();
        let count = driven.len();
        let outputs = structure
            .outputs
            .iter()
            .map(|output| full(&output.direction));
        let rows: Vec<Vec<f64>> = driven.into_iter().chain(outputs).collect();
        Self {
            attached: rows.clone(),
            rows,
            driven: count,
        }
    }
}
