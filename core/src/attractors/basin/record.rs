//! What a block of cells gave, as bytes in a log.

use super::attractor::{Attractor, Fate};
use crate::attractors::log::{Reader, Writer};

/// What a block of cells gave.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    pub(super) round: usize,
    pub(super) index: usize,
    /// What becomes of each cell. Orbits are counted through those known when the round began, then through `found`.
    pub(super) fates: Vec<Fate>,
    pub(super) found: Vec<Attractor>,
    /// Periods that were computed.
    pub(super) periods: u64,
}

impl Block {
    pub(super) fn written(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.whole(self.round);
        writer.whole(self.index);
        writer.whole(self.periods as usize);
        writer.whole(self.fates.len());
        for fate in &self.fates {
            fate.written(&mut writer);
        }
        writer.whole(self.found.len());
        for attractor in &self.found {
            attractor.written(&mut writer);
        }
        writer.0
    }

    pub(super) fn read(record: &[u8]) -> Option<Self> {
        let mut reader = Reader(record);
        let (round, index, periods) = (reader.whole()?, reader.whole()?, reader.whole()?);
        let count = reader.whole()?;
        let fates = (0..count)
            .map(|_| Fate::read(&mut reader))
            .collect::<Option<_>>()?;
        let count = reader.whole()?;
        let found = (0..count).map(|_| Attractor::read(&mut reader));
        let found = found.collect::<Option<_>>()?;
        Some(Self {
            round,
            index,
            fates,
            found,
            periods: periods as u64,
        })
    }
}
