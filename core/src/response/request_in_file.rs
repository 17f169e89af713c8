//! What a branch was asked for by, in a file, with feature `serde`.

use serde::{Deserialize, Serialize};

use super::both_ways::BothWays;
use super::following::{Following, Left};
use super::in_turn::Otherwise;
use crate::balance::resolution::Chooser;
use crate::balance::{Parity, Resolution};
use crate::balance_branch::check::Asked;
use crate::balance_branch::context::BranchContext;
use crate::balance_branch::options::HarmonicBalance;
use crate::balance_branch::run;
use crate::branches::branch::Model;
use crate::branches::request::{Options, Request};
use crate::contact_equation::{self, ContactEquation};
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
        #[serde(default, skip_serializing_if = "Option::is_none")]
        both_ways: Option<Box<BothWays<run::Rest>>>,
    },
    Shooting {
        options: Shooting,
        rest: Option<Box<shooting::Rest>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        both_ways: Option<Box<BothWays<shooting::Rest>>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        otherwise: Option<Otherwise>,
    },
    ContactEquation {
        options: ContactEquation,
        rest: Option<Box<contact_equation::Rest>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        both_ways: Option<Box<BothWays<contact_equation::Rest>>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        otherwise: Option<Otherwise>,
    },
}

impl Method {
    /// Whether a model has what its accuracy is of, and that of the balance that is tried otherwise.
    fn is_of(&self, model: &Model) -> bool {
        let (accuracy, otherwise) = match self {
            Self::HarmonicBalance { options, .. } => (options.accuracy, None),
            Self::Shooting {
                options, otherwise, ..
            } => (options.accuracy, *otherwise),
            Self::ContactEquation {
                options, otherwise, ..
            } => (options.accuracy, *otherwise),
        };
        let same = otherwise.is_none_or(|otherwise| otherwise.balance.accuracy == accuracy);
        same && accuracy.is_of(model)
    }
}

impl<R: Clone> Left<R> {
    /// What is left of a branch that was followed one way, or both ways.
    fn apart(&self) -> (Option<Box<R>>, Option<Box<BothWays<R>>>) {
        match self {
            Self::Nothing => (None, None),
            Self::OneWay(rest) => (Some(rest.clone()), None),
            Self::BothWays(both) => (None, Some(both.clone())),
        }
    }

    /// The same from both.
    fn of(rest: Option<Box<R>>, both_ways: Option<Box<BothWays<R>>>) -> Self {
        both_ways.map_or_else(|| Self::one_way(rest), Self::BothWays)
    }
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
                } => {
                    let (rest, both_ways) = rest.apart();
                    Method::HarmonicBalance {
                        options: *balance,
                        resolution: context.resolution,
                        asymmetric: context.asymmetric,
                        rest,
                        both_ways,
                    }
                }
                Self::Shooting {
                    shooting,
                    rest,
                    otherwise,
                    ..
                } => {
                    let (rest, both_ways) = rest.apart();
                    Method::Shooting {
                        options: *shooting,
                        rest,
                        both_ways,
                        otherwise: *otherwise,
                    }
                }
                Self::ContactEquation {
                    equation,
                    rest,
                    otherwise,
                    ..
                } => {
                    let (rest, both_ways) = rest.apart();
                    Method::ContactEquation {
                        options: *equation,
                        rest,
                        both_ways,
                        otherwise: *otherwise,
                    }
                }
            },
        }
    }

    /// Of a system, as it was written.
    ///
    /// # Errors
    /// If that is none of this system.
    pub(super) fn of(system: &dyn System, written: Written) -> Result<Self, Error> {
        let request = Request::with(system, written.asked)?;
        if !written.by.is_of(&Model::of(system)) {
            return Err(RequestError::Rest.into());
        }
        match written.by {
            Method::HarmonicBalance {
                options: balance,
                resolution,
                asymmetric,
                rest,
                both_ways,
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
                    rest: Left::of(rest, both_ways),
                })
            }
            Method::Shooting {
                options: shooting,
                rest,
                both_ways,
                otherwise,
            } => {
                shooting::Asked::of(&request, &shooting).ranged()?;
                Ok(Self::Shooting {
                    request,
                    shooting,
                    rest: Left::of(rest, both_ways),
                    otherwise,
                })
            }
            Method::ContactEquation {
                options: equation,
                rest,
                both_ways,
                otherwise,
            } => {
                equation.problem(&request)?;
                Ok(Self::ContactEquation {
                    request,
                    equation,
                    rest: Left::of(rest, both_ways),
                    otherwise,
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
