//! Why a computation has no answer: one type for all rooms, which holds what a room says and knows no room itself.
//!
//! Each room has its own enum of errors, with the numbers of each case and the sentence beside it, and writes `From` for [`Error`].
//! What a program asks first is [`Error::kind`]; an enum that is public comes back by [`Error::downcast_ref`], as those of requests, models,
//! orbits and motions are.

mod debug;
#[cfg(feature = "serde")]
mod serialise;

use std::error::Error as StdError;
use std::fmt;
use std::sync::Arc;

pub(crate) use debug::room_error;

/// Why there is no result.
///
/// Its sentence is that of the room's error, its source the room's source. A program whose `main` returns it shows both, as
/// [`chain`] writes them.
///
/// ```
/// # hertzian::oscillator! {
/// #     Linear(x) {
/// #         param drive = 0.1;
/// #         ddot(x) + 0.2*dot(x) + x = drive*cos(omega*t);
/// #     }
/// # }
/// use hertzian::error::ErrorKind;
/// use hertzian::{FrequencyResponse, RequestError};
///
/// let error = FrequencyResponse::of(&Linear::default()).orbit(-1.0).unwrap_err();
/// assert_eq!(error.kind(), ErrorKind::Request);
/// let Some(RequestError::Option { name, value, .. }) = error.downcast_ref() else {
///     panic!("{error}");
/// };
/// assert_eq!((*name, *value), ("omega", -1.0));
/// ```
#[derive(Clone)]
pub struct Error {
    kind: ErrorKind,
    /// The error of the room. It is shared: sources need not be cloneable, and results that keep an error are.
    room: Arc<dyn StdError + Send + Sync>,
}

/// What is to be changed for an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum ErrorKind {
    /// The request: an option, a parameter or a name is not usable.
    Request,
    /// The model: its declaration, its structure, its masses or its levels are not usable, or the method is not for it.
    Model,
    /// Nothing: no orbit was found where it was looked for, and more work of the same kind is not expected to find one.
    NoOrbit,
    /// The work that is allowed: a search ended before it could say that there is none.
    Limit,
    /// The motion: from its state it cannot be continued.
    Motion,
    /// Nothing: the computation was [cancelled](crate::Cancel) before there was a result.
    Cancelled,
    /// The file: it cannot be read, written or used.
    File,
    /// What the operating system gives.
    System,
}

impl Error {
    /// Holds the error of a room.
    pub(crate) fn new(kind: ErrorKind, room: impl StdError + Send + Sync + 'static) -> Self {
        let room = Arc::new(room);
        Self { kind, room }
    }

    /// What is to be changed for an answer.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The error of the room that said no.
    pub fn get_ref(&self) -> &(dyn StdError + Send + Sync + 'static) {
        &*self.room
    }

    /// The error of the room, with its numbers, if it is of this type.
    pub fn downcast_ref<E: StdError + 'static>(&self) -> Option<&E> {
        self.room.downcast_ref()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.room, f)
    }
}

/// `{:?}` is the sentence with its sources, `{:#?}` the variant with everything that it carries.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            fmt::Debug::fmt(&*self.room, f)
        } else {
            fmt::Display::fmt(&chain(self), f)
        }
    }
}

/// Errors are equal where all that they show is, numbers included.
impl PartialEq for Error {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && format!("{self:#?}") == format!("{other:#?}")
    }
}

impl StdError for Error {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        self.room.source()
    }
}

/// An error as people read it: its sentence, and that of each source after a colon.
pub fn chain<'a>(error: &'a (dyn StdError + 'a)) -> impl fmt::Display + 'a {
    Chain(error)
}

struct Chain<'a>(&'a (dyn StdError + 'a));

impl fmt::Display for Chain<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self.0, f)?;
        let mut next = self.0.source();
        while let Some(source) = next {
            write!(f, ": {source}")?;
            next = source.source();
        }
        Ok(())
    }
}
