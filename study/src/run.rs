//! A study on the threads of one machine, or a part of it: block by block, each kept as it is done.
//!
//! Every variant starts by itself and is computed by one thread, and a block has its place by its number: results do not depend on how many
//! threads or parts there are, nor on which of them computes what.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use hertzian::{Cancel, Progress, Stage};

use crate::error::StudyError;
use crate::folder::{Block, Folder, Missing};
use crate::study::Prepared;

/// A part of a study: every block whose number leaves `number - 1` when it is divided by `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    number: usize,
    of: usize,
}

impl Part {
    /// All of it.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// A part, from one on.
    ///
    /// # Errors
    /// If there is none of this number.
    pub fn new(number: usize, of: usize) -> Result<Self, StudyError> {
        if (1..=of).contains(&number) {
            Ok(Self { number, of })
        } else {
            Err(StudyError::Part { number, of })
        }
    }

    /// Whether a block belongs to it.
    pub fn has(self, block: usize) -> bool {
        block % self.of == self.number - 1
    }
}

/// What came of a run.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Ran {
    /// Variants that were computed now.
    pub computed: usize,
    /// Variants that had been computed before.
    pub before: usize,
    /// Variants that belong to the part.
    pub asked: usize,
    /// What is said of files that were damaged, and computed once more.
    pub damaged: Vec<String>,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// Time of the computation.
    pub elapsed: Duration,
    /// Time of all variants that were computed now, together.
    pub worked: Duration,
}

/// How a study is run.
#[derive(Debug, Clone)]
pub struct Runner<'r> {
    study: &'r Prepared,
    folder: &'r Folder,
    part: Part,
    threads: usize,
    cancel: Cancel,
}

/// Who is told how far it is.
type See<'v> = &'v mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send);

/// What the threads share.
struct Shared<'v> {
    /// Ends this run: with the token of the caller, or alone.
    cancel: Cancel,
    see: Mutex<See<'v>>,
    done: AtomicUsize,
    total: usize,
    computed: AtomicUsize,
    worked: Mutex<Duration>,
    failed: Mutex<Option<StudyError>>,
}

impl<'v> Shared<'v> {
    fn new(ran: &Ran, cancel: &Cancel, see: See<'v>) -> Self {
        Self {
            cancel: cancel.child(),
            see: Mutex::new(see),
            done: AtomicUsize::new(ran.before),
            total: ran.asked,
            computed: AtomicUsize::new(0),
            worked: Mutex::new(Duration::ZERO),
            failed: Mutex::new(None),
        }
    }
}

impl<'r> Runner<'r> {
    /// All of a study, on as many threads as the machine runs at once.
    pub fn new(study: &'r Prepared, folder: &'r Folder) -> Self {
        Self {
            study,
            folder,
            part: Part::WHOLE,
            threads: 0,
            cancel: Cancel::new(),
        }
    }

    /// A part of it.
    #[must_use]
    pub fn part(mut self, part: Part) -> Self {
        self.part = part;
        self
    }

    /// On so many threads; zero for as many as the machine runs at once.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// It ends when this token is cancelled; whole blocks are kept. The run itself never cancels it.
    #[must_use]
    pub fn cancel(mut self, cancel: &Cancel) -> Self {
        self.cancel = cancel.clone();
        self
    }

    /// Computes what is missing. `see` is told after every variant how many are done, and ends the run by breaking.
    ///
    /// # Errors
    /// If a block cannot be written; those that were are kept.
    pub fn run(
        &self,
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Result<Ran, StudyError> {
        let (missing, ran) = self.missing();
        let next = AtomicUsize::new(0);
        let give = || {
            let place = next.fetch_add(1, Ordering::Relaxed);
            missing.get(place).copied()
        };
        self.run_given(ran, &give, see)
    }

    /// Blocks of the part that are not kept, and what is known of the others.
    pub(crate) fn missing(&self) -> (Vec<usize>, Ran) {
        let mut ran = Ran::default();
        let mut missing = Vec::new();
        for block in (0..self.study.blocks()).filter(|block| self.part.has(*block)) {
            let count = self.study.variants_of(block).len();
            ran.asked += count;
            match self.folder.read(self.study, block) {
                Ok(_) => ran.before += count,
                Err(why) => {
                    if let Missing::Damaged(why) = why {
                        let path = self.folder.file(block);
                        let said = format!("{}: {why}; computed once more", path.display());
                        ran.damaged.push(said);
                    }
                    missing.push(block);
                }
            }
        }
        (missing, ran)
    }

    /// Computes the blocks that are given, until none is.
    pub(crate) fn run_given(
        &self,
        mut ran: Ran,
        give: &(dyn Fn() -> Option<usize> + Sync),
        see: &mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send),
    ) -> Result<Ran, StudyError> {
        let started = Instant::now();
        let shared = Shared::new(&ran, &self.cancel, see);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build();
        let pool = pool.map_err(|error| StudyError::Threads {
            threads: self.threads,
            message: error.to_string(),
        })?;
        pool.broadcast(|_| {
            while !shared.cancel.is_cancelled()
                && let Some(block) = give()
            {
                if let Err(error) = self.block(block, &shared) {
                    // What cannot be written now cannot be a moment later: the other threads need not compute what would be lost.
                    shared.cancel.cancel();
                    lock(&shared.failed).get_or_insert(error);
                }
            }
        });
        if let Some(error) = lock(&shared.failed).take() {
            return Err(error);
        }
        ran.computed = shared.computed.load(Ordering::Relaxed);
        ran.worked = *lock(&shared.worked);
        ran.interrupted = shared.cancel.is_cancelled();
        ran.elapsed = started.elapsed();
        Ok(ran)
    }

    /// Computes the blocks that are given on this thread, until none is or it is cancelled: `give` is told which block was kept last.
    #[cfg(feature = "mpi")]
    pub(crate) fn run_here(
        &self,
        mut give: impl FnMut(Option<usize>) -> Option<usize>,
    ) -> Result<Ran, StudyError> {
        let started = Instant::now();
        let mut ran = Ran::default();
        let mut nobody = |_: Progress<'_>| ControlFlow::Continue(());
        let shared = Shared::new(&ran, &self.cancel, &mut nobody);
        let mut last = None;
        while let Some(block) = give(last) {
            if !self.block(block, &shared)? {
                ran.interrupted = true;
                break;
            }
            last = Some(block);
        }
        ran.computed = shared.computed.load(Ordering::Relaxed);
        ran.worked = *lock(&shared.worked);
        ran.elapsed = started.elapsed();
        Ok(ran)
    }

    /// Computes a block and keeps it, unless it is cancelled: whether it is kept.
    fn block(&self, number: usize, shared: &Shared<'_>) -> Result<bool, StudyError> {
        let mut block = Block::default();
        for variant in self.study.variants_of(number) {
            let started = Instant::now();
            let Ok(found) = self.study.found(variant, &shared.cancel) else {
                return Ok(false);
            };
            for (place, branch) in found.branches.iter().enumerate() {
                self.folder.write_branch(variant, place, branch)?;
            }
            block.add(&found.rows, started.elapsed());
            Self::tell(shared);
        }
        self.folder.write(self.study, number, &block)?;
        shared
            .computed
            .fetch_add(block.seconds.len(), Ordering::Relaxed);
        *lock(&shared.worked) += Duration::from_secs_f64(block.seconds.iter().sum());
        Ok(true)
    }

    /// Says that a variant more is done.
    fn tell(shared: &Shared<'_>) {
        let mut progress = Progress::new(
            Stage::Study,
            1 + shared.done.fetch_add(1, Ordering::Relaxed),
        );
        progress.total = Some(shared.total);
        if (lock(&shared.see))(progress).is_break() {
            shared.cancel.cancel();
        }
    }
}

/// What a thread that panicked left is still whole.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}
