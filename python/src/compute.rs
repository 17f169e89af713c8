//! Computations without the interpreter's lock, which Ctrl-C ends.
//!
//! Python runs the handlers of signals on its main thread only, and a computation may go on for long between two of its orbits. So it has a
//! thread of its own; the calling thread waits, and takes the lock every now and then to let handlers run. What one of them raises cancels
//! the token of the computation, which every iteration looks at. What was computed by then goes along with the exception, as `result`.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use hertzian::error::Error;
use hertzian::{Cancel, Progress};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::errors::exception;
use crate::held::Owner;
use crate::progress::PyProgress;

/// So often signals are looked for.
const POLL: Duration = Duration::from_millis(50);
/// As much as a main thread has, for models of many coordinates.
const STACK: usize = 8 << 20;

/// What is told of progress, from any thread.
pub type Visit<'v> = &'v mut (dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send);

/// What has been raised while a computation went on.
#[derive(Default)]
struct Raised {
    error: Mutex<Option<PyErr>>,
    cancel: Cancel,
}

impl Raised {
    /// Keeps the first one, and ends the computation.
    fn set(&self, error: PyErr) {
        let mut kept = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get_or_insert(error);
        self.cancel.cancel();
    }

    /// Calls a callback; `False` ends the computation, whose result is returned.
    fn tell(&self, see: &Watch, progress: Progress<'_>) -> ControlFlow<()> {
        if self.cancel.is_cancelled() {
            return ControlFlow::Break(());
        }
        let Some(callback) = &see.callback else {
            return ControlFlow::Continue(());
        };
        let answer = Python::attach(|py| -> PyResult<bool> {
            let progress = PyProgress::of(progress, &see.owner);
            let answer = callback.call1(py, (progress,))?;
            Ok(answer.bind(py).is(false.into_pyobject(py)?))
        });
        match answer {
            Ok(false) => ControlFlow::Continue(()),
            Ok(true) => ControlFlow::Break(()),
            Err(error) => {
                self.set(error);
                ControlFlow::Break(())
            }
        }
    }
}

/// Who is told of progress.
pub struct Watch {
    callback: Option<Py<PyAny>>,
    /// What orbits are of, while they are on no branch.
    owner: Owner,
}

impl Watch {
    pub fn new(callback: Option<Py<PyAny>>, owner: Owner) -> Self {
        Self { callback, owner }
    }
}

/// Does the work, and makes an object of what comes of it.
pub fn compute<'py, T, O>(
    py: Python<'py>,
    watch: Watch,
    work: impl FnOnce(&Cancel, Visit<'_>) -> Result<T, Error> + Send,
    object: impl FnOnce(T) -> O,
) -> PyResult<Bound<'py, PyAny>>
where
    T: Send,
    O: IntoPyObject<'py>,
{
    let raised = Raised::default();
    let found = py.detach(|| beside(&raised, &watch, work));
    let found = found.map_err(PyErr::from)?;
    let object = |found: T| -> PyResult<Bound<'py, PyAny>> { object(found).into_bound_py_any(py) };
    let error = raised.error.into_inner();
    match error.unwrap_or_else(PoisonError::into_inner) {
        None => object(found.map_err(exception)?),
        Some(error) => {
            let result = found.ok().map(object).transpose()?;
            error.value(py).setattr("result", result)?;
            Err(error)
        }
    }
}

/// Does the work on a thread of its own while this one looks for signals.
fn beside<T: Send>(
    raised: &Raised,
    watch: &Watch,
    work: impl FnOnce(&Cancel, Visit<'_>) -> Result<T, Error> + Send,
) -> std::io::Result<Result<T, Error>> {
    let (working, done) = channel::<()>();
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK);
        let worker = builder.spawn_scoped(scope, move || {
            // Hung up when this ends, however it does.
            let _working = working;
            work(&raised.cancel, &mut |progress| raised.tell(watch, progress))
        })?;
        while let Err(RecvTimeoutError::Timeout) = done.recv_timeout(POLL) {
            let handled = Python::attach(|py| py.check_signals());
            if let Err(error) = handled {
                raised.set(error);
            }
        }
        worker.join().map_or_else(|panic| resume_unwind(panic), Ok)
    })
}
