//! A study over the ranks of MPI: rank 0 hands out numbers of blocks, the others compute and keep them in the folder that all share.
//!
//! Messages hold the number of a block, eight bytes: a rank asks by sending the block that it has done (or none), and is answered by the next
//! one (or none). What is computed by whom does not matter to any row, since a block has its place by its number. Each rank computes on one
//! thread: as many ranks are started as there are processors, and one for rank 0, which computes nothing.

use std::ops::ControlFlow;

use ::mpi::Threading;
use ::mpi::topology::{Communicator, SimpleCommunicator};
use ::mpi::traits::{Destination, Source as _};
use hertzian::{Cancel, Progress, Stage};

use crate::error::StudyError;
use crate::folder::Folder;
use crate::run::{Part, Ran, Runner};
use crate::study::Prepared;

/// No block, in a message.
const NONE: u64 = u64::MAX;
/// A rank cannot write what it has computed.
const FAILED: u64 = u64::MAX - 1;

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

    /// Computes what is missing of a study, as rank 0 says; every rank calls this. What comes back of rank 0 is of all.
    ///
    /// # Errors
    /// If a block cannot be written; those that were are kept.
    pub fn run(
        &self,
        study: &Prepared,
        folder: &Folder,
        cancel: &Cancel,
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Result<Ran, StudyError> {
        let runner = Runner::new(study, folder)
            .part(Part::WHOLE)
            .threads(1)
            .cancel(cancel);
        if self.rank() == 0 {
            return Ok(self.hand_out(&runner, study, cancel, see));
        }
        let world = self.world();
        let zero = world.process_at_rank(0);
        let ask = |done: u64| {
            zero.send(&done);
            let (block, _) = zero.receive::<u64>();
            (block != NONE).then_some(block as usize)
        };
        let ran = runner.run_here(|done| ask(done.map_or(NONE, |block| block as u64)));
        if ran.is_err() {
            ask(FAILED);
        }
        ran
    }

    /// Answers until every rank has been told that there is nothing more.
    fn hand_out(
        &self,
        runner: &Runner<'_>,
        study: &Prepared,
        cancel: &Cancel,
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Ran {
        let started = std::time::Instant::now();
        let (missing, mut ran) = runner.missing();
        let mut blocks = missing.into_iter();
        let world = self.world();
        let mut others = self.count() - 1;
        while others > 0 {
            let (done, status) = world.any_process().receive::<u64>();
            if let Ok(block) = usize::try_from(done)
                && done < FAILED
            {
                ran.computed += study.variants_of(block).len();
                let mut progress = Progress::new(Stage::Study, ran.before + ran.computed);
                progress.total = Some(ran.asked);
                if see(progress).is_break() {
                    cancel.cancel();
                }
            }
            let goes_on = !cancel.is_cancelled() && done != FAILED;
            let next = goes_on.then(|| blocks.next()).flatten();
            others -= usize::from(next.is_none());
            let next = next.map_or(NONE, |block| block as u64);
            world.process_at_rank(status.source_rank()).send(&next);
        }
        ran.interrupted = cancel.is_cancelled();
        ran.elapsed = started.elapsed();
        ran
    }
}
