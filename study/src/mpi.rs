//! A study over the ranks of MPI: rank 0 hands out numbers of blocks, the others compute and keep them in the folder that all share.
//!
//! Messages hold the number of a block, eight bytes: a rank asks by sending the block that it has kept (or none), and is answered by the next
//! one (or none). One that cannot write, has no folder or is stopped says so, and its block is handed out again ([`HandOut`]). What is
//! computed by whom does not matter to any row, since a block has its place by its number. Each rank computes on one
//! thread: as many ranks are started as there are processors, and one for rank 0, which computes nothing.

use std::ops::ControlFlow;

use ::mpi::Threading;
use ::mpi::topology::{Communicator, SimpleCommunicator};
use ::mpi::traits::{Destination, Source as _};
use hertzian::{Cancel, Progress, Stage};

use crate::error::StudyError;
use crate::folder::Folder;
use crate::hand_out::{HandOut, Said};
use crate::run::{Part, Ran, Runner};
use crate::study::Prepared;

/// No block, in a message.
const NONE: u64 = u64::MAX;
/// A rank computes nothing more, and has not kept the block that it was given.
const LEAVES: u64 = u64::MAX - 1;

/// The ranks that were started together.
pub struct Ranks {
    universe: ::mpi::environment::Universe,
}

impl std::fmt::Debug for Ranks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (rank, count) = (self.rank(), self.count());
        f.debug_struct("Ranks")
            .field("rank", &rank)
            .field("count", &count)
            .finish()
    }
}

impl Ranks {
    /// Joins the others; `None` where there are none, or MPI has been begun already.
    pub fn join() -> Option<Self> {
        let (universe, _) = ::mpi::initialize_with_threading(Threading::Funneled)?;
        let ranks = Self { universe };
        (ranks.count() > 1).then_some(ranks)
    }

    fn world(&self) -> SimpleCommunicator {
        self.universe.world()
    }

    /// Number of this one.
    pub fn rank(&self) -> usize {
        self.world().rank() as usize
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.world().size() as usize
    }

    /// Computes what is missing of a study, as rank 0 says; every rank calls this with its own result of opening the folder, which comes
    /// back. What comes back of rank 0 is of all.
    ///
    /// # Errors
    /// If the folder could not be opened, or a block cannot be written; those that were are kept. The other ranks have been told by then.
    pub fn run(
        &self,
        study: &Prepared,
        folder: Result<Folder, StudyError>,
        cancel: &Cancel,
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Result<(Ran, Folder), StudyError> {
        if self.rank() == 0 {
            return self.first(study, folder, cancel, see);
        }
        let world = self.world();
        let zero = world.process_at_rank(0);
        let ask = |said: u64| {
            zero.send(&said);
            let (block, _) = zero.receive::<u64>();
            (block != NONE).then_some(block as usize)
        };
        let ran = folder.and_then(|folder| {
            let runner = runner(study, &folder, cancel);
            let ran = runner.run_here(|kept| ask(kept.map_or(NONE, |block| block as u64)))?;
            Ok((ran, folder))
        });
        let is_let_go = matches!(&ran, Ok((ran, _)) if !ran.interrupted);
        if !is_let_go {
            ask(LEAVES);
        }
        ran
    }

    /// Rank 0: hands out, and without a folder lets all others go.
    fn first(
        &self,
        study: &Prepared,
        folder: Result<Folder, StudyError>,
        cancel: &Cancel,
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Result<(Ran, Folder), StudyError> {
        let started = std::time::Instant::now();
        let opened = folder.as_ref().ok();
        let missing = opened.map(|folder| runner(study, folder, cancel).missing());
        let (blocks, mut ran) = missing.unwrap_or_default();
        let mut out = HandOut::new(blocks, self.count() - 1);
        let world = self.world();
        while !out.is_over() {
            let (message, status) = world.any_process().receive::<u64>();
            let rank = status.source_rank() as usize;
            let said = match message {
                NONE => Said::Asks,
                LEAVES => Said::Leaves,
                _ => Said::Kept,
            };
            if let (Said::Kept, Some(block)) = (said, out.held(rank)) {
                ran.computed += study.variants_of(block).len();
                let mut progress = Progress::new(Stage::Study, ran.before + ran.computed);
                progress.total = Some(ran.asked);
                if see(progress).is_break() {
                    out.stop();
                }
            }
            if cancel.is_cancelled() {
                out.stop();
            }
            for (rank, block) in out.hear(rank, said) {
                let block = block.map_or(NONE, |block| block as u64);
                world.process_at_rank(rank as i32).send(&block);
            }
        }
        ran.interrupted = cancel.is_cancelled() || out.is_left();
        ran.elapsed = started.elapsed();
        Ok((ran, folder?))
    }
}

fn runner<'r>(study: &'r Prepared, folder: &'r Folder, cancel: &Cancel) -> Runner<'r> {
    let runner = Runner::new(study, folder).part(Part::WHOLE);
    runner.threads(1).cancel(cancel)
}
