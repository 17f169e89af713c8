//! Why a computation has no answer: one type for all rooms, which holds what a room says and knows no room itself.
//!
//! Each room has its own enum of errors, with the numbers of each case and the sentence beside it, and writes `From` for [`Error`].
//! What a program asks first is [`Error::kind`]; [`Error::variant`] and [`Error::values`] are the name and the numbers of the case, of whatever
//! room. An enum that is public comes back by [`Error::downcast_ref`], as those of requests, models, orbits and motions are.

mod room;
#[cfg(feature = "serde")]
mod serialise;

use std::error::Error as StdError;
use std::fmt;
use std::sync::Arc;

pub(crate) use room::{Field, Room, room_error};

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
///
/// An enum that is not public says why as well, and its numbers are [values](Self::values):
///
/// ```
/// use hertzian::structure::{DMatrix, Structure};
///
/// let one = DMatrix::identity(2, 2);
/// let structure = Structure::of(&one, &(0.1 * &one), &one);
/// let error = structure.cosine(3, 1, 0.5).build().unwrap_err();
/// assert_eq!(error.variant(), "NoCoordinate");
/// assert_eq!(error.value("coordinate"), Some(3.0));
/// assert_eq!(error.values(), [("coordinate", 3.0), ("coordinates", 2.0)]);
/// ```
#[derive(Clone)]
pub struct Error {
    kind: ErrorKind,
    /// The error of the room. It is shared: sources need not be cloneable, and results that keep an error are.
    room: Arc<dyn Room>,
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
    pub(crate) fn new(kind: ErrorKind, room: impl Room) -> Self {
        let room = Arc::new(room);
        Self { kind, room }
    }

    /// What is to be changed for an answer.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The name of the case, as `"SingularMass"`: that of the variant in the enum of the room that said no. [`ErrorKind`] says what is to be
    /// changed, and this which of the errors of that kind it is. One that was read from a file has the name that it had.
    pub fn variant(&self) -> &str {
        self.room.variant()
    }

    /// All numbers that it carries, by the names of their fields: first its own, then those of what it comes from, so that a name may come
    /// twice. A field with several numbers gives each of them under its name. Nothing where it carries none.
    pub fn values(&self) -> Vec<(&str, f64)> {
        let mut values = Vec::new();
        self.room.append_values(&mut values);
        values
    }

    /// The first of its [values](Self::values) of this name; `None` if it carries none.
    ///
    /// ```
    /// use hertzian::error::ErrorKind;
    ///
    /// # hertzian::oscillator! {
    /// #     Driven(x) {
    /// #         param drive;
    /// #         ddot(x) + 0.1*dot(x) + x = drive*cos(omega*t);
    /// #     }
    /// # }
    /// use hertzian::backbone::PhaseResonance;
    ///
    /// // The resonance is at one, and it is looked for above.
    /// let request = PhaseResonance::of(&Driven { drive: 0.1 }).vary("drive").to(0.2);
    /// let error = request.between(2.0, 3.0).run().unwrap_err();
    /// assert_eq!(error.kind(), ErrorKind::NoOrbit);
    /// assert_eq!((error.value("from"), error.value("to")), (Some(2.0), Some(3.0)));
    /// assert_eq!(error.value("phase"), None);
    /// ```
    pub fn value(&self, name: &str) -> Option<f64> {
        let values = self.values();
        let found = values.iter().find(|(own, _)| *own == name);
        found.map(|(_, value)| *value)
    }

    /// The error of the room that said no.
    pub fn get_ref(&self) -> &(dyn StdError + Send + Sync + 'static) {
        &*self.room
    }

    /// The error of the room, with its numbers, if it is of this type.
    pub fn downcast_ref<E: StdError + 'static>(&self) -> Option<&E> {
        self.get_ref().downcast_ref()
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
