//! Motions against what is known of them.
#![allow(
    clippy::unreadable_literal,
    clippy::excessive_precision,
    reason = "numbers as they were published, to be searched for"
)]

mod accuracy;
mod exact;
mod tangents;
mod touch;

use std::f64::consts::TAU;

use super::*;
use crate::testing::by_hand::PowerForm;
use crate::time::Stretch;
