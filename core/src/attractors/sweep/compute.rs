//! The sweep, value by value, and what a log keeps of each.

use std::ops::ControlFlow;

use super::{Checked, Row, Sweep, Swept};
use crate::attractors::log::{Log, Reader, Writer};
use crate::branches::progress::{Progress, Stage};
use crate::error::Error;
use crate::time::FlowError;
use crate::time::poincare::Crossing;
use crate::time::stroboscope::Stroboscope;

impl Sweep {
    pub(super) fn sweep(
        &self,
        mut log: Option<&mut Log>,
        visit: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> Result<Swept, Error> {
        let Checked {
            variable,
            values,
            start,
            mut map,
        } = self.check()?;
        let records = log.as_deref().map_or(&[][..], Log::records);
        let known: Vec<Known> = records
            .iter()
            .map_while(|record| Row::read(record))
            .collect();
        let mut rows: Vec<Row> = Vec::new();
        let mut state = start.clone();
        for (index, &value) in values.iter().enumerate() {
            if let Some(Known::Seen(row)) = known.get(index) {
                state.clone_from(&row.last);
                rows.push(row.clone());
                continue;
            }
            let mut points = Vec::new();
            let ended = map.set(variable, value);
            let ended = ended.and_then(|()| self.row(&mut map, &mut state, &mut points));
            let ended = ended.err();
            if self.request.cancel.is_cancelled() {
                break;
            }
            if ended.is_some() {
                points.clear();
                state.clone_from(&start);
            }
            let row = Row {
                value,
                points,
                ended,
                last: state.clone(),
            };
            if let Some(log) = log.as_mut().filter(|_| index >= known.len()) {
                log.append(&row.written())?;
            }
            rows.push(row);
            let progress = Progress {
                total: Some(values.len()),
                value: Some(value),
                ..Progress::new(Stage::Sweep, rows.len())
            };
            if visit(progress).is_break() {
                break;
            }
        }
        Ok(Swept {
            complete: rows.len() == values.len(),
            rows,
        })
    }

    /// One value.
    fn row(
        &self,
        map: &mut Stroboscope,
        state: &mut [f64],
        points: &mut Vec<f64>,
    ) -> Result<(), FlowError> {
        for _ in 0..self.transient {
            map.map(state)?;
            self.stays(state)?;
        }
        for _ in 0..self.periods {
            if let Some(section) = &self.section {
                let mut see = |crossing: Crossing<'_>| points.extend_from_slice(crossing.state);
                section.follow(map, state, map.stride(), &mut see)?;
            } else {
                map.map(state)?;
                points.extend_from_slice(state);
            }
            self.stays(state)?;
        }
        Ok(())
    }

    fn stays(&self, state: &[f64]) -> Result<(), FlowError> {
        let inside = state.iter().all(|x| x.abs() <= self.request.escape);
        if inside {
            Ok(())
        } else {
            Err(FlowError::Escaped)
        }
    }
}

impl Row {
    fn written(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.numbers(&[self.value]);
        writer.numbers(&self.points);
        writer.numbers(&match self.ended {
            None => vec![],
            Some(FlowError::Escaped) => vec![0.0],
            Some(_) => vec![1.0],
        });
        writer.numbers(&self.last);
        writer.0
    }

    fn read(record: &[u8]) -> Option<Known> {
        let mut reader = Reader(record);
        let value = *reader.numbers()?.first()?;
        let points = reader.numbers()?;
        let ended = match reader.numbers()?[..] {
            [] => None,
            [0.0] => Some(FlowError::Escaped),
            _ => return Some(Known::Failed),
        };
        Some(Known::Seen(Self {
            value,
            points,
            ended,
            last: reader.numbers()?,
        }))
    }
}

/// What a log says of a value. Why a motion failed there, it says itself when it is computed again, and again in the same way.
enum Known {
    Seen(Row),
    Failed,
}
