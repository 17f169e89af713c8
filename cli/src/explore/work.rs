//! What is asked for, who asks, and which of it is still wanted.

use std::collections::{HashMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use hertzian::Cancel;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::asked::{Asked, Effort};
use super::declared::{self, Texts};
use super::exported::{self, Form, Scale};
use super::fault::{Fault, Kind};
use super::traced::{Tell, Traced, trace};
use super::{curve, measured, orbits};

/// Curves that are kept for clicks on them and for other measures.
const KEPT: usize = 8;
/// Characters of what a page calls itself, at most.
const LONGEST_NAME: usize = 64;

/// A page by what it calls itself, and a kind of request: what takes the place of each other.
type Lane = (String, &'static str);

/// A request of a page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Request {
    /// What the page calls itself: a newer request of the same page, for the same, takes the place of an older one.
    pub client: String,
    /// Its number among the requests of the page: they may arrive in another order than they were sent in.
    #[serde(default)]
    pub number: u64,
    /// What is asked for.
    pub ask: Ask,
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", rename_all_fields = "kebab-case")]
pub enum Ask {
    /// What a text declares.
    Declaration {
        /// The text.
        text: String,
    },
    /// A curve.
    Curve {
        /// Of what.
        of: Asked,
        /// What is drawn, as `x:p2p`; empty for what leads.
        plot: String,
        /// How exactly.
        effort: Effort,
    },
    /// All orbits at a value.
    Orbits {
        /// Of which curve.
        of: Asked,
        /// What is drawn.
        plot: String,
        /// The value.
        at: f64,
    },
    /// Measured values, to be drawn over a curve.
    Table {
        /// Of which curve.
        of: Asked,
        /// The table, as `hertzian fit` reads it.
        table: String,
    },
    /// Parameters that are fitted to measured values.
    Fit {
        /// Where it begins.
        of: Asked,
        /// The table.
        table: String,
        /// Which are free.
        free: Vec<String>,
    },
    /// A file.
    Export {
        /// Of which curve.
        of: Asked,
        /// What is drawn.
        plot: String,
        /// The scale of the picture.
        scale: Scale,
        /// In which form.
        form: Form,
    },
}

impl Request {
    /// A request from what a page sent.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(body: &[u8]) -> Result<Self, Fault> {
        let request: Self = serde_json::from_slice(body)
            .map_err(|error| Fault::request(format!("this is no request: {error}")))?;
        if request.client.len() > LONGEST_NAME {
            return Err(Fault::request("the name of the page is too long"));
        }
        Ok(request)
    }

    /// What of the same page takes the place of each other.
    fn lane(&self) -> Lane {
        let lane = match self.ask {
            Ask::Declaration { .. } => "declaration",
            Ask::Curve { .. } => "curve",
            Ask::Orbits { .. } => "orbits",
            Ask::Export { .. } => "export",
            Ask::Table { .. } => "table",
            Ask::Fit { .. } => "fit",
        };
        (self.client.clone(), lane)
    }
}

/// Takes the lines of an answer.
pub type Emit = Arc<dyn Fn(Value) + Send + Sync>;

/// What lasts from request to request.
#[derive(Debug, Default)]
pub struct Work {
    texts: Texts,
    kept: Mutex<VecDeque<(Asked, Arc<Traced>)>>,
    running: Mutex<HashMap<Lane, Running>>,
    next: AtomicU64,
}

/// The newest request of a lane.
#[derive(Debug)]
struct Running {
    /// That of its ticket.
    stamp: u64,
    /// Of the page.
    number: u64,
    cancel: Cancel,
}

/// A request that is worked on; nobody waits for it when this is dropped.
#[derive(Debug)]
pub struct Ticket {
    work: Arc<Work>,
    lane: Lane,
    /// Which no other ticket has.
    stamp: u64,
    /// Cancelled when a newer request takes its place, or nobody waits any more.
    pub cancel: Cancel,
}

impl Drop for Ticket {
    fn drop(&mut self) {
        self.cancel.cancel();
        let mut running = unpoisoned(&self.work.running);
        let newest = running.get(&self.lane);
        if newest.is_some_and(|newest| newest.stamp == self.stamp) {
            running.remove(&self.lane);
        }
    }
}

/// What one thread left half done is whole here: every change is one insertion or removal.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Work {
    /// Takes in a request, and cancels the one whose place it takes; or this one, if it is the older.
    pub fn begin(self: &Arc<Self>, request: &Request, all: &Cancel) -> Ticket {
        let (lane, cancel) = (request.lane(), all.child());
        let stamp = self.next.fetch_add(1, Ordering::Relaxed);
        let mut running = unpoisoned(&self.running);
        let newest = running.get(&lane);
        if newest.is_some_and(|newest| newest.number > request.number) {
            cancel.cancel();
        } else {
            let entry = Running {
                stamp,
                number: request.number,
                cancel: cancel.clone(),
            };
            if let Some(older) = running.insert(lane.clone(), entry) {
                older.cancel.cancel();
            }
        }
        drop(running);
        Ticket {
            work: Arc::clone(self),
            lane,
            stamp,
            cancel,
        }
    }

    /// Number of requests that are worked on.
    pub fn running(&self) -> usize {
        unpoisoned(&self.running).len()
    }

    /// Answers a request, in one or several lines of JSON; the last one has what was asked for, or a fault. Nothing in it ends the server.
    pub fn answer(&self, ask: &Ask, cancel: &Cancel, emit: &Emit) {
        let answered = catch_unwind(AssertUnwindSafe(|| self.try_answer(ask, cancel, emit)));
        let fault = match answered {
            Ok(Ok(value)) => return emit(value),
            Ok(Err(fault)) => fault,
            Err(_) => Fault::new(
                Kind::Computation,
                "the program has a mistake here, which stopped this computation: please report it with the declaration and the values",
            ),
        };
        emit(json!({ "fault": fault }));
    }

    fn try_answer(&self, ask: &Ask, cancel: &Cancel, emit: &Emit) -> Result<Value, Fault> {
        if cancel.is_cancelled() {
            return Err(Fault::cancelled());
        }
        match ask {
            Ask::Declaration { text } => {
                let declared = declared::of(text, &self.texts)?;
                Ok(json!({ "declaration": declared }))
            }
            Ask::Curve { of, plot, effort } => self.curve(of, plot, *effort, cancel, emit),
            Ask::Orbits { of, plot, at } => {
                let traced = self.traced(of, true, cancel, emit)?;
                let orbits = orbits::at(&traced, *at, plot, cancel)?;
                Ok(json!({ "orbits": orbits }))
            }
            Ask::Table { of, table } => {
                let sets = measured::read(of, table, &self.texts)?;
                Ok(json!({ "table": sets }))
            }
            Ask::Fit { of, table, free } => {
                let tell = tell(emit);
                let fitted = measured::fit(of, table, free, &self.texts, cancel, &tell)?;
                Ok(json!({ "fit": fitted }))
            }
            Ask::Export {
                of,
                plot,
                scale,
                form,
            } => {
                let traced = self.traced(of, true, cancel, emit)?;
                let file = exported::of(&traced, *form, plot, *scale, &self.texts, cancel)?;
                Ok(json!({ "export": file }))
            }
        }
    }

    fn curve(
        &self,
        of: &Asked,
        plot: &str,
        effort: Effort,
        cancel: &Cancel,
        emit: &Emit,
    ) -> Result<Value, Fault> {
        if effort == Effort::Screen {
            let traced = trace(of, effort, false, &self.texts, cancel, &tell(emit))?;
            return Ok(json!({ "curve": curve::of(&traced, plot, effort)? }));
        }
        let traced = self.traced(of, false, cancel, emit)?;
        let first = curve::of(&traced, plot, effort)?;
        if !first.lacks {
            return Ok(json!({ "curve": first }));
        }
        // What there is so far, while the rest of the range is looked into.
        emit(json!({ "curve": first }));
        let traced = self.traced(of, true, cancel, emit)?;
        Ok(json!({ "curve": curve::of(&traced, plot, effort)? }))
    }

    /// The branches, from those that are kept if they are; with `whole` all that cover the range.
    fn traced(
        &self,
        of: &Asked,
        whole: bool,
        cancel: &Cancel,
        emit: &Emit,
    ) -> Result<Arc<Traced>, Fault> {
        let known = unpoisoned(&self.kept)
            .iter()
            .find(|(asked, traced)| asked == of && (!whole || !traced.lacks()))
            .map(|(_, traced)| Arc::clone(traced));
        if let Some(known) = known {
            return Ok(known);
        }
        let traced = trace(of, Effort::Full, whole, &self.texts, cancel, &tell(emit))?;
        let traced = Arc::new(traced);
        let mut kept = unpoisoned(&self.kept);
        kept.retain(|(asked, _)| asked != of);
        kept.push_front((of.clone(), Arc::clone(&traced)));
        kept.truncate(KEPT);
        Ok(traced)
    }
}

/// Progress as a line of the answer.
fn tell(emit: &Emit) -> Tell {
    let emit = Arc::clone(emit);
    Arc::new(move |text: &str| emit(json!({ "progress": text })))
}
