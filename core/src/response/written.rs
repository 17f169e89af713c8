//! What a branch was asked for by, in a file, with feature `serde`.

use serde::{Deserialize, Serialize};

use super::following::Following;
use crate::balance::resolution::Chooser;
use crate::balance::{Parity, Resolution};
use crate::balance_branch::check::Asked;
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::balance_branch::run;
use crate::branches::request::{Options, Request};
use crate::error::Error;
use crate::model::request::RequestError;
use crate::shooting::{self, Shooting};
use crate::system::System;

/// What a branch was asked for by, without the system.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Written {
    asked: Options,
    by: Method,
}

/// A method with its options.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Method {
    HarmonicBalance {
        options: HarmonicBalance,
        resolution: Resolution,
        asymmetric: bool,
        rest: Option<Box<run::Rest>>,
    },
    Shooting {
        options: Shooting,
        rest: Option<Box<shooting::Rest>>,
    },
}

impl Following {
    /// Without the system.
    pub(super) fn written(&self) -> Written {
        Written {
            asked: self.request().options(),
            by: match self {
                Self::Balance {
                    context,
                    balance,
                    rest,
                    ..
                } => Method::HarmonicBalance {
                    options: *balance,
                    resolution: context.resolution,
                    asymmetric: context.asymmetric,
                    rest: rest.clone(),
                },
                Self::Shooting { shooting, rest, .. } => Method::Shooting {
                    options: *shooting,
                    rest: rest.clone(),
                },
            },
        }
    }

    /// Of a system, as it was written.
    ///
    /// # Errors
    /// If that is none of this system.
    pub(super) fn of(system: &dyn System, written: Written) -> Result<Self, Error> {
        let request = Request::with(system, written.asked)?;
        match written.by {
            Method::HarmonicBalance {
                options: balance,
                resolution,
                asymmetric,
                rest,
            } => {
                let (mut context, _) = Asked::of(&request, &balance).check()?;
                if !is_one_of(resolution, &context) {
                    return Err(RequestError::Rest.into());
                }
                (context.resolution, context.asymmetric) = (resolution, asymmetric);
                Ok(Self::Balance {
                    context: Box::new(context),
                    request,
                    balance,
                    rest,
                })
            }
            Method::Shooting {
                options: shooting,
                rest,
            } => {
                shooting::Asked::of(&request, &shooting).ranged()?;
                Ok(Self::Shooting {
                    request,
                    shooting,
                    rest,
                })
            }
        }
    }
}

/// Whether a branch that was asked for like this may have such a resolution: at events symmetries are lost, and harmonics are chosen.
fn is_one_of(resolution: Resolution, context: &BranchContext) -> bool {
    let asked = context.resolution;
    let chosen = context.chooser.as_ref().map_or(0, Chooser::most);
    let Resolution {
        harmonics,
        parity,
        stride,
        ..
    } = resolution;
    let same = Resolution {
        harmonics: asked.harmonics,
        parity: asked.parity,
        stride: asked.stride,
        ..resolution
    };
    same == asked
        && parity != Parity::Even
        && (1..=harmonics).contains(&stride)
        && harmonics <= chosen.max(asked.harmonics)
}
