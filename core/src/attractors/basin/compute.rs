//! All cells of a grid: round by round, block by block, on several threads.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::attractor::Fate;
use super::catalogue::Catalogue;
use super::grid::Grid;
use super::recognise::Recogniser;
use super::record::Block;
use super::threads::Threads;
use super::{Basin, BasinError, Basins, Moving, Visit};
use crate::attractors::log::{Log, LogError};
use crate::branches::branch::Model;
use crate::branches::progress::{Progress, Stage};
use crate::time::FlowError;
use crate::time::stroboscope::Stroboscope;

/// Cells of a block: so many that a thread seldom waits for another, so few that little is lost when a run ends.
const BLOCK: usize = 256;

/// What the threads share.
struct Shared<'w> {
    basin: &'w Basin,
    grid: &'w Grid,
    /// Those that no thread uses now.
    idle: Mutex<Vec<Recogniser>>,
    log: Mutex<Option<&'w mut Log>>,
    error: Mutex<Option<LogError>>,
    done: AtomicUsize,
    ended: AtomicBool,
    visit: Mutex<Visit<'w>>,
}

pub(super) fn compute(
    basin: &Basin,
    grid: &Grid,
    moving: Moving,
    log: Option<&mut Log>,
    visit: Visit<'_>,
) -> Result<Basins, BasinError> {
    let Moving {
        flows,
        parameters,
        omega,
    } = moving;
    let threads = Threads::new(flows.len())?;
    let known = log.as_deref().map_or(&[][..], Log::records);
    let mut kept: Kept = known
        .iter()
        .filter_map(|record| Block::read(record))
        .map(|block| ((block.round, block.index), block))
        .collect();
    let recogniser = |flow| Recogniser::new(Stroboscope::new(flow).phase(basin.phase));
    let shared = Shared {
        basin,
        grid,
        idle: Mutex::new(flows.into_iter().map(recogniser).collect()),
        log: Mutex::new(log),
        error: Mutex::new(None),
        done: AtomicUsize::new(kept.values().map(|block| block.fates.len()).sum()),
        ended: AtomicBool::new(false),
        visit: Mutex::new(visit),
    };
    let mut basins = Basins {
        model: Model::of(basin.request.system.as_ref()),
        parameters,
        omega,
        phase: basin.phase,
        grid: grid.clone(),
        fates: vec![Fate::Unknown; grid.cells()],
        attractors: Vec::new(),
        periods: 0,
        complete: true,
    };
    let mut catalogue = Catalogue::default();
    for (round, cells) in grid.rounds().iter().enumerate() {
        shared.round(
            &threads,
            round,
            cells,
            &mut catalogue,
            &mut kept,
            &mut basins,
        );
        if !basins.complete {
            break;
        }
    }
    shared.finish(&basins)?;
    basins.attractors = catalogue.0;
    basins.number();
    Ok(basins)
}

/// Blocks that are computed and not yet taken over, by round and by index.
type Kept = HashMap<(usize, usize), Block>;

impl Shared<'_> {
    /// Computes the blocks of a round that are missing, and takes all of them over.
    fn round(
        &self,
        threads: &Threads,
        round: usize,
        cells: &[usize],
        catalogue: &mut Catalogue,
        kept: &mut Kept,
        basins: &mut Basins,
    ) {
        // The blocks of the first round know nothing, so it is one.
        let size = if round == 0 { cells.len() } else { BLOCK };
        let blocks: Vec<&[usize]> = cells.chunks(size).collect();
        let missing: Vec<usize> = (0..blocks.len())
            .filter(|&index| !kept.contains_key(&(round, index)))
            .collect();
        let base = catalogue.0.len();
        let computed = threads.map(&missing, |index| {
            self.block([round, index], blocks[index], catalogue)
        });
        let computed = computed.into_iter().flatten();
        kept.extend(computed.map(|block| ((round, block.index), block)));
        for (index, cells) in blocks.iter().enumerate() {
            match kept.remove(&(round, index)) {
                Some(block) => basins.take(block, cells, base, catalogue),
                None => basins.complete = false,
            }
        }
    }

    /// What went wrong, if anything did: with the log, or with every motion.
    fn finish(self, basins: &Basins) -> Result<(), BasinError> {
        if let Some(error) = self.error.into_inner().ok().flatten() {
            return Err(error.into());
        }
        if basins.fates.iter().any(|&fate| fate != Fate::Failed) {
            return Ok(());
        }
        let mut start = self.grid.start.clone();
        self.grid.state(0, &mut start);
        let idle = self.idle.into_inner().ok();
        let recogniser = idle.and_then(|mut idle| idle.pop());
        let fault = recogniser.and_then(|mut recogniser| recogniser.fault(self.basin, &start));
        match fault {
            None | Some(FlowError::Cancelled { .. }) => Ok(()),
            Some(reason) => Err(BasinError::Motion { reason }),
        }
    }

    /// Whether no further cell is to be looked at.
    fn is_ended(&self) -> bool {
        self.ended.load(Ordering::Relaxed) || self.basin.request.cancel.is_cancelled()
    }

    /// One block, by its round and index; `None` if the computation has been ended.
    fn block(
        &self,
        [round, index]: [usize; 2],
        cells: &[usize],
        known: &Catalogue,
    ) -> Option<Block> {
        if self.is_ended() {
            return None;
        }
        // There is one for each thread. A poisoned lock means that another thread has panicked, and so will the caller.
        let mut recogniser = self.idle.lock().ok()?.pop()?;
        let before = recogniser.map.periods();
        let mut own = Catalogue::default();
        let mut start = self.grid.start.clone();
        let mut fates = Vec::with_capacity(cells.len());
        for &cell in cells {
            self.grid.state(cell, &mut start);
            let fate = recogniser.fate(self.basin, &start, known, &mut own);
            // A motion that was cut short has no fate.
            if self.basin.request.cancel.is_cancelled() {
                return None;
            }
            fates.push(fate);
        }
        let block = Block {
            round,
            index,
            fates,
            found: own.0,
            periods: recogniser.map.periods() - before,
        };
        self.idle.lock().ok()?.push(recogniser);
        if let Some(log) = self.log.lock().ok()?.as_mut()
            && let Err(error) = log.append(&block.written())
        {
            self.ended.store(true, Ordering::Relaxed);
            *self.error.lock().ok()? = Some(error);
            return None;
        }
        let progress = Progress {
            total: Some(self.grid.cells()),
            ..Progress::new(
                Stage::Basin,
                self.done.fetch_add(cells.len(), Ordering::Relaxed) + cells.len(),
            )
        };
        if (self.visit.lock().ok()?)(progress).is_break() {
            self.ended.store(true, Ordering::Relaxed);
        }
        Some(block)
    }
}

impl Basins {
    /// Takes over a block, which counts its own attractors from `base`. They join the catalogue, and its cells refer to that.
    fn take(&mut self, block: Block, cells: &[usize], base: usize, catalogue: &mut Catalogue) {
        let found: Vec<usize> = block
            .found
            .into_iter()
            .map(|new| catalogue.add(new))
            .collect();
        for (&cell, fate) in cells.iter().zip(block.fates) {
            self.fates[cell] = match fate {
                Fate::Periodic(index) if index >= base => Fate::Periodic(found[index - base]),
                fate => fate,
            };
        }
        self.periods += block.periods;
    }

    /// Numbers the attractors in their order, without those that no cell settles to.
    fn number(&mut self) {
        let mut used = vec![false; self.attractors.len()];
        for fate in &self.fates {
            if let Fate::Periodic(index) = fate {
                used[*index] = true;
            }
        }
        let mut order: Vec<usize> = (0..used.len()).filter(|&index| used[index]).collect();
        order.sort_by(|&a, &b| self.attractors[a].before(&self.attractors[b]));
        let mut numbers = vec![0; used.len()];
        for (number, &index) in order.iter().enumerate() {
            numbers[index] = number;
        }
        for fate in &mut self.fates {
            if let Fate::Periodic(index) = fate {
                *index = numbers[*index];
            }
        }
        self.attractors = order
            .iter()
            .map(|&index| self.attractors[index].clone())
            .collect();
    }
}
