//! All cells of a grid: round by round, block by block, on several threads.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::attractor::Fate;
use super::catalogue::Catalogue;
use super::recognise::Recogniser;
use super::record::Block;
use super::threads::Threads;
use super::{Basin, BasinError, Basins, Progress};
use crate::attractors::log::{Log, LogError};
use crate::time::Flow;
use crate::time::stroboscope::Stroboscope;

/// Cells of a block: so many that a thread seldom waits for another, so few that little is lost when a run ends.
const BLOCK: usize = 256;

/// What the threads share.
struct Shared<'w> {
    basin: &'w Basin,
    /// Those that no thread uses now.
    idle: Mutex<Vec<Recogniser>>,
    log: Mutex<Option<Log>>,
    error: Mutex<Option<LogError>>,
    done: AtomicUsize,
    ended: AtomicBool,
    watch: &'w (dyn Fn(Progress) -> bool + Sync),
}

pub(super) fn compute(
    basin: &Basin,
    flows: Vec<Box<dyn Flow>>,
    log: Option<Log>,
    watch: &(dyn Fn(Progress) -> bool + Sync),
) -> Result<Basins, BasinError> {
    let threads = Threads::new(flows.len())?;
    let known = log.as_ref().map_or(&[][..], Log::records);
    let mut kept: HashMap<(usize, usize), Block> = known
        .iter()
        .filter_map(|record| Block::read(record))
        .map(|block| ((block.round, block.index), block))
        .collect();
    let recogniser = |flow| Recogniser::new(Stroboscope::new(flow).phase(basin.phase));
    let shared = Shared {
        basin,
        idle: Mutex::new(flows.into_iter().map(recogniser).collect()),
        log: Mutex::new(log),
        error: Mutex::new(None),
        done: AtomicUsize::new(kept.values().map(|block| block.fates.len()).sum()),
        ended: AtomicBool::new(false),
        watch,
    };
    let mut basins = Basins {
        fates: vec![Fate::Unknown; basin.grid.cells()],
        attractors: Vec::new(),
        periods: 0,
        complete: true,
    };
    let mut catalogue = Catalogue::default();
    for (round, cells) in basin.grid.rounds().iter().enumerate() {
        // The blocks of the first round know nothing, so it is one.
        let size = if round == 0 { cells.len() } else { BLOCK };
        let blocks: Vec<&[usize]> = cells.chunks(size).collect();
        let missing: Vec<usize> = (0..blocks.len())
            .filter(|&index| !kept.contains_key(&(round, index)))
            .collect();
        let base = catalogue.0.len();
        let computed = threads.map(&missing, |index| {
            shared.block((round, index), blocks[index], &catalogue)
        });
        let computed = computed.into_iter().flatten();
        kept.extend(computed.map(|block| ((round, block.index), block)));
        for (index, cells) in blocks.iter().enumerate() {
            match kept.remove(&(round, index)) {
                Some(block) => basins.take(block, cells, base, &mut catalogue),
                None => basins.complete = false,
            }
        }
        if !basins.complete {
            break;
        }
    }
    if let Some(error) = shared.error.into_inner().ok().flatten() {
        return Err(error.into());
    }
    if basins.fates.iter().all(|&fate| fate == Fate::Failed) {
        let mut start = basin.grid.start.clone();
        basin.grid.state(0, &mut start);
        let idle = shared.idle.into_inner().ok();
        let recogniser = idle.and_then(|mut idle| idle.pop());
        let fault = recogniser.and_then(|mut recogniser| recogniser.fault(basin, &start));
        if let Some(reason) = fault {
            return Err(BasinError::Motion { reason });
        }
    }
    basins.attractors = catalogue.0;
    basins.number();
    Ok(basins)
}

impl Shared<'_> {
    /// One block; `None` if the computation has been ended.
    fn block(&self, id: (usize, usize), cells: &[usize], known: &Catalogue) -> Option<Block> {
        if self.ended.load(Ordering::Relaxed) {
            return None;
        }
        // There is one for each thread. A poisoned lock means that another thread has panicked, and so will the caller.
        let mut recogniser = self.idle.lock().ok()?.pop()?;
        let before = recogniser.map.periods();
        let mut own = Catalogue::default();
        let mut start = self.basin.grid.start.clone();
        let mut fates = Vec::with_capacity(cells.len());
        for &cell in cells {
            self.basin.grid.state(cell, &mut start);
            fates.push(recogniser.fate(self.basin, &start, known, &mut own));
        }
        let block = Block {
            round: id.0,
            index: id.1,
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
            done: self.done.fetch_add(cells.len(), Ordering::Relaxed) + cells.len(),
            cells: self.basin.grid.cells(),
        };
        if !(self.watch)(progress) {
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
