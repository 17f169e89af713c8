//! What a branch was asked for by, and what it goes on from.

use std::fmt;

use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::balance_branch::run;
use crate::branches::branch;
use crate::branches::request::Request;
use crate::shooting::{self, Shooting};

/// What a branch was asked for by.
#[derive(Clone)]
pub(super) enum Following {
    Balance {
        context: Box<BranchContext>,
        request: Request,
        balance: HarmonicBalance,
        rest: Option<Box<run::Rest>>,
    },
    Shooting {
        request: Request,
        shooting: Shooting,
        rest: Option<Box<shooting::Rest>>,
    },
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
            Self::Balance { request, .. } | Self::Shooting { request, .. } => request,
        }
    }
}
