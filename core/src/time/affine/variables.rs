//! Derivatives by several variables, one after the other: the tables of a model have the derivatives of all its terms by one.

use super::Affine;
use crate::time::{Flow, FlowError, See, Show, Tangent};

impl Affine {
    /// A motion with derivatives by several variables.
    ///
    /// # Errors
    /// As those of one.
    pub(super) fn advance_by_each(
        &mut self,
        ends: [f64; 2],
        state: &mut [f64],
        tangent: Option<&mut Tangent>,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let Some(tangent) = tangent else {
            return Ok(());
        };
        let [from, to] = ends;
        let start = state.to_vec();
        for mut part in parts(tangent, start.len()) {
            state.copy_from_slice(&start);
            // It is the same motion each time, to the same end, and shown once.
            let moved = self.advance(from, to, state, Some(&mut part.tangent), see.take());
            part.put(&mut tangent.columns);
            moved?;
        }
        Ok(())
    }

    /// The same, shown at phases between.
    ///
    /// # Errors
    /// As there.
    pub(super) fn shown_by_each(
        &mut self,
        [from, to]: [f64; 2],
        stops: &[f64],
        state: &mut [f64],
        tangent: &mut Tangent,
        show: Show<'_>,
    ) -> Result<(), FlowError> {
        let (order, size) = (state.len(), tangent.columns.len());
        let start = state.to_vec();
        let mut states = vec![0.0; order * stops.len()];
        let mut columns = vec![0.0; size * stops.len()];
        for mut part in parts(tangent, order) {
            state.copy_from_slice(&start);
            let mut here = from;
            for (number, &stop) in stops.iter().enumerate() {
                let next = stop.max(here.min(to)).min(here.max(to));
                if next != here {
                    self.advance(here, next, state, Some(&mut part.tangent), None)?;
                }
                states[number * order..][..order].copy_from_slice(state);
                part.put(&mut columns[number * size..][..size]);
                here = next;
            }
            self.advance(here, to, state, Some(&mut part.tangent), None)?;
            part.put(&mut tangent.columns);
        }
        for number in 0..stops.len() {
            let state = &states[number * order..][..order];
            show(number, state, &columns[number * size..][..size]);
        }
        Ok(())
    }
}

/// Some columns of a tangent: those that are homogeneous with the first variable, or that by another one.
struct Part {
    tangent: Tangent,
    /// Its first entry in the whole.
    first: usize,
}

impl Part {
    fn put(&self, columns: &mut [f64]) {
        columns[self.first..][..self.tangent.columns.len()].copy_from_slice(&self.tangent.columns);
    }
}

fn parts(tangent: &Tangent, order: usize) -> Vec<Part> {
    let homogeneous = tangent.homogeneous(order);
    let count = tangent.by.len().max(1);
    let part = |number: usize| {
        let first = if number == 0 { 0 } else { homogeneous + number } * order;
        let end = (homogeneous + number + 1) * order;
        Part {
            tangent: Tangent {
                columns: tangent.columns[first..end.min(tangent.columns.len())].to_vec(),
                by: tangent.by.get(number).copied().into_iter().collect(),
            },
            first,
        }
    };
    (0..count).map(part).collect()
}
