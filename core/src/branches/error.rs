//! Why there is no orbit, or none was found.

use crate::cancel::Cancel;
use crate::continuation::newton::NewtonError;
use crate::error::{Error, ErrorKind};
use crate::event::EventKind;
use crate::numeric::decimal::Decimal;

/// Why there is no orbit, or none was found.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrbitError {
    /// No orbit was found at the start of the range.
    #[error("no periodic orbit found at {}", Decimal::plain(*.value))]
    NoStart {
        /// Where.
        value: f64,
        /// What the last attempt said.
        #[source]
        reason: NewtonError,
    },
    /// No orbit was found at the start of the range with the work that a search may take.
    #[error(
        "no periodic orbit found at {} in {evaluations} evaluations of the balance, which took the {:.0e} multiplications that a search is allowed",
        Decimal::plain(*.value),
        *.multiplications as f64
    )]
    SearchLimit {
        /// Where.
        value: f64,
        /// Evaluations of the balance.
        evaluations: usize,
        /// The limit that was reached: multiplications, as estimated.
        multiplications: u64,
        /// What the last attempt said.
        #[source]
        reason: NewtonError,
    },
    /// Orbits were found, but none whose shortest period is the one asked for.
    #[error(
        "no orbit of period {period} found at {}: {}; start where there is one, and follow it from there",
        Decimal::plain(*.value),
        attempts_said(*.planned, *.made, *.shorter, *.evaluations)
    )]
    NoSuchPeriod {
        /// The period asked for, in periods of the declaration.
        period: usize,
        /// Where.
        value: f64,
        /// Attempts: as many as there are disturbances to begin with.
        planned: usize,
        /// Attempts that were made: fewer if they took the work that a search is allowed.
        made: usize,
        /// Those that led to an orbit of a shorter period.
        shorter: usize,
        /// Evaluations of the balance.
        evaluations: usize,
    },
    /// There is no orbit: the branch that comes near turns back before.
    #[error(
        "no periodic orbit at {} near the given one: its branch turns back at {}, {:.1e} away",
        Decimal::plain(*.value),
        Decimal::rounded(*.fold, 12),
        (.value - .fold).abs()
    )]
    Beyond {
        /// The value asked for.
        value: f64,
        /// The fold.
        fold: f64,
    },
    /// A branch passes a value between two of its points, but the orbit there could not be computed.
    #[error(
        "the orbit at {}, between those at {} and {}, could not be computed",
        Decimal::plain(*.value),
        Decimal::plain(*.from),
        Decimal::plain(*.to)
    )]
    Lost {
        /// The value.
        value: f64,
        /// The value at the point before.
        from: f64,
        /// The value at the point behind.
        to: f64,
    },
    /// No branch begins at an event, or none was found.
    #[error("no further branch was found at the {kind} at {}", Decimal::rounded(*.value, 9))]
    NoBranch {
        /// What kind of event it is.
        kind: EventKind,
        /// Value of what is varied there.
        value: f64,
    },
    /// The search for an orbit was [cancelled](crate::Cancel).
    #[error("cancelled before there was a periodic orbit at {}", Decimal::plain(*.value))]
    Cancelled {
        /// Where it was looked for.
        value: f64,
    },
}

crate::error::room_error! {
    OrbitError, OrbitError::kind;
    NoStart { value, reason }
    SearchLimit { value, evaluations, multiplications, reason }
    NoSuchPeriod { period, value, planned, made, shorter, evaluations }
    Beyond { value, fold }
    Lost { value, from, to }
    NoBranch { kind, value }
    Cancelled { value }
    ;
}

impl OrbitError {
    /// The one orbit that was found has a shorter period.
    pub(crate) fn of_shorter_period(period: usize, value: f64) -> Self {
        let attempts = Attempts {
            planned: 1,
            made: 1,
            shorter: 1,
            evaluations: 0,
        };
        attempts.without_period(period, value)
    }

    fn kind(&self) -> ErrorKind {
        match self {
            Self::SearchLimit { .. } => ErrorKind::Limit,
            Self::NoSuchPeriod { planned, made, .. } if made < planned => ErrorKind::Limit,
            Self::Cancelled { .. } => ErrorKind::Cancelled,
            _ => ErrorKind::NoOrbit,
        }
    }
}

/// What is said of a search at a value that failed: where it was cancelled that it was, and not what that made of it.
pub(crate) fn unless_cancelled(cancel: &Cancel, value: f64, error: Error) -> Error {
    match error.kind() {
        ErrorKind::NoOrbit | ErrorKind::Limit | ErrorKind::Motion if cancel.is_cancelled() => {
            OrbitError::Cancelled { value }.into()
        }
        _ => error,
    }
}

/// What attempts to find an orbit of a longer period came to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Attempts {
    /// As many as there are disturbances to begin with.
    pub(crate) planned: usize,
    /// Fewer if they took the work that a search is allowed.
    pub(crate) made: usize,
    /// Those that led to an orbit of a shorter period.
    pub(crate) shorter: usize,
    /// Evaluations of the balance.
    pub(crate) evaluations: usize,
}

impl Attempts {
    /// None of them led to an orbit of this period.
    pub(crate) fn without_period(self, period: usize, value: f64) -> OrbitError {
        OrbitError::NoSuchPeriod {
            period,
            value,
            planned: self.planned,
            made: self.made,
            shorter: self.shorter,
            evaluations: self.evaluations,
        }
    }
}

/// What attempts came to, in words.
fn attempts_said(planned: usize, made: usize, shorter: usize, evaluations: usize) -> String {
    let of_them = if made < planned {
        format!(
            "a search may take no more work after {made} of {planned} attempts and {evaluations} evaluations of the balance; {shorter}"
        )
    } else {
        format!("{shorter} of {made} attempts")
    };
    format!("{of_them} led to an orbit of a shorter period, the others to none")
}
