//! What a branch was asked for by, and what it goes on from.

use std::fmt;

use super::both_ways::BothWays;
use super::in_turn::{Either, First, Otherwise};
use super::kind::OrbitMethodKind;
use super::sealed::Follow;
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::balance_branch::run;
use crate::branches::branch::{self, Branch, Further, Model};
use crate::branches::request::Request;
use crate::contact_equation::{self, ContactEquation};
use crate::error::Error;
use crate::shooting::{self, Shooting};

/// What a branch was asked for by.
#[derive(Clone)]
pub(super) enum Following {
    Balance {
        context: Box<BranchContext>,
        request: Request,
        balance: HarmonicBalance,
        rest: Left<run::Rest>,
    },
    Shooting {
        request: Request,
        shooting: Shooting,
        rest: Left<shooting::Rest>,
        /// What is tried where it leads no further; nothing where shooting was asked for.
        otherwise: Option<Otherwise>,
    },
    ContactEquation {
        request: Request,
        equation: ContactEquation,
        rest: Left<contact_equation::Rest>,
        /// What is tried where it leads no further; nothing where the contact equation was asked for.
        otherwise: Option<Otherwise>,
    },
}

/// What the method gives that followed a branch, or the balance where that is tried otherwise.
pub(super) fn by_any(
    following: &Following,
    bifurcations: Option<bool>,
    follow: impl FnOnce(&dyn Follow) -> Result<Branch, Error>,
) -> Result<Branch, Error> {
    match following.either() {
        Some(either) => follow(&either.bifurcations(bifurcations)),
        None => by_one(following, bifurcations, follow),
    }
}

/// What the method gives alone that followed a branch.
pub(super) fn by_one(
    following: &Following,
    bifurcations: Option<bool>,
    follow: impl FnOnce(&dyn Follow) -> Result<Branch, Error>,
) -> Result<Branch, Error> {
    match following {
        Following::Balance { balance, .. } => {
            let wanted = bifurcations.unwrap_or(balance.bifurcations);
            follow(&balance.bifurcations(wanted))
        }
        Following::Shooting { shooting, .. } => follow(shooting),
        Following::ContactEquation { equation, .. } => follow(equation),
    }
}

/// What a branch goes on from.
#[derive(Debug, Clone)]
pub(super) enum Left<R> {
    /// It was not interrupted.
    Nothing,
    /// It was, on the way to the end of its range.
    OneWay(Box<R>),
    /// It was followed both ways, whether it was interrupted or not.
    BothWays(Box<BothWays<R>>),
}

impl<R> Left<R> {
    /// Of a branch that was followed one way.
    pub(super) fn one_way(rest: Option<Box<R>>) -> Self {
        rest.map_or(Self::Nothing, Self::OneWay)
    }
}

/// Tells what keeps a branch what it is.
///
/// # Errors
/// If it cannot be kept.
pub(super) fn begin(request: &Request, further: impl FnOnce() -> Further) -> Result<(), Error> {
    let Some(keep) = &request.keep else {
        return Ok(());
    };
    let model = Model::of(request.system.as_ref());
    keep.begin(&model, &request.varied(), &further())
}

impl fmt::Debug for Following {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.request().fmt(f)
    }
}

impl branch::Asked for Following {
    #[cfg(feature = "serde")]
    fn written(&self) -> serde_json::Result<serde_json::Value> {
        serde_json::to_value(self.written())
    }
}

impl Following {
    pub(super) fn request(&self) -> &Request {
        match self {
            Self::Balance { request, .. }
            | Self::Shooting { request, .. }
            | Self::ContactEquation { request, .. } => request,
        }
    }

    /// The method.
    pub(super) fn method(&self) -> OrbitMethodKind {
        match self {
            Self::Balance { .. } => OrbitMethodKind::HarmonicBalance,
            Self::Shooting { .. } => OrbitMethodKind::Shooting,
            Self::ContactEquation { .. } => OrbitMethodKind::ContactEquation,
        }
    }

    /// What is tried where the method leads no further.
    pub(super) fn otherwise(&self) -> Option<Otherwise> {
        match self {
            Self::Balance { .. } => None,
            Self::Shooting { otherwise, .. } | Self::ContactEquation { otherwise, .. } => {
                *otherwise
            }
        }
    }

    /// The method with what is tried otherwise, where there is something.
    pub(super) fn either(&self) -> Option<Either> {
        let first = match self {
            Self::Balance { .. } => return None,
            Self::Shooting { shooting, .. } => First::Shooting(*shooting),
            Self::ContactEquation { equation, .. } => First::ContactEquation(*equation),
        };
        let otherwise = self.otherwise()?;
        Some(Either::of(first, otherwise.balance))
    }

    /// By which motions in time are computed.
    pub(super) fn shooting(&self) -> Shooting {
        match self {
            Self::Shooting { shooting, .. } => *shooting,
            Self::ContactEquation { equation, .. } => equation.shooting(),
            Self::Balance { balance, .. } => Shooting {
                accuracy: balance.accuracy,
                ..Shooting::new()
            },
        }
    }

    /// The contact equation, where that is the method.
    pub(super) fn equation(&self) -> Option<ContactEquation> {
        match self {
            Self::ContactEquation { equation, .. } => Some(*equation),
            _ => None,
        }
    }

    /// Of a branch that was followed both ways the value from which it was, and the place of the orbit there.
    pub(super) fn both_ways(&self) -> Option<(f64, usize)> {
        match self {
            Self::Balance {
                rest: Left::BothWays(both),
                ..
            } => Some((both.value, both.middle())),
            Self::Shooting {
                rest: Left::BothWays(both),
                ..
            } => Some((both.value, both.middle())),
            Self::ContactEquation {
                rest: Left::BothWays(both),
                ..
            } => Some((both.value, both.middle())),
            _ => None,
        }
    }
}
