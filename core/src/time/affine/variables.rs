//! Derivatives by several variables. The tables of a model have the derivatives of all its terms by one of them: each of the others has a flow of
//! its own, whose tables stay as long as the values do.

use super::Affine;
use crate::time::{Flow, FlowError, See, Show, Tangent, from_stop_to_stop};

impl Affine {
    /// A motion with derivatives by several variables.
    ///
    /// # Errors
    /// As those of one.
    pub(super) fn advance_by_each(
        &mut self,
        ends: [f64; 2],
        state: &mut [f64],
        tangent: &mut Tangent,
        mut see: Option<See<'_>>,
    ) -> Result<(), FlowError> {
        let [from, to] = ends;
        let start = state.to_vec();
        for mut part in parts(tangent, start.len()) {
            state.copy_from_slice(&start);
            // It is the same motion each time, to the same end, and shown once.
            let see = see.take();
            let moved = self.with(&mut part, |flow, tangent| {
                flow.advance(from, to, state, Some(tangent), see)
            });
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
        ends: [f64; 2],
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
            let first = part.first;
            let mut keep = |number: usize, state: &[f64], own: &[f64]| {
                states[number * order..][..order].copy_from_slice(state);
                columns[number * size + first..][..own.len()].copy_from_slice(own);
            };
            self.with(&mut part, |flow, own| {
                from_stop_to_stop(flow, ends, stops, state, own, &mut keep)
            })?;
            part.put(&mut tangent.columns);
        }
        for number in 0..stops.len() {
            let state = &states[number * order..][..order];
            show(number, state, &columns[number * size..][..size]);
        }
        Ok(())
    }

    /// Moves a part of a tangent by the flow whose tables are by its variable.
    fn with<T>(
        &mut self,
        part: &mut Part,
        advance: impl FnOnce(&mut Self, &mut Tangent) -> T,
    ) -> T {
        let variable = part.tangent.by.first().copied();
        let Some(variable) = variable.filter(|_| part.first > 0) else {
            return advance(self, &mut part.tangent);
        };
        let known = self.beside.iter().position(|(own, _)| *own == variable);
        let index = known.unwrap_or_else(|| {
            let model = self.model.again();
            let mut flow = Self::of(model);
            flow.until(&self.cancel);
            self.beside.push((variable, flow));
            self.beside.len() - 1
        });
        let flow = &mut self.beside[index].1;
        let moved = advance(flow, &mut part.tangent);
        self.work += std::mem::take(&mut flow.work);
        moved
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
