//! Results through serde, with feature `serde`: what has a name is that name, as it is printed.

use serde::{Serialize, Serializer};

use crate::attractors::sweep::Ended;
use crate::continuation::follow::Stop;
use crate::event::EventKind;
use crate::numeric::serialise::text;
use crate::orbit::stability::{Method, Verdict};
use crate::shooting::{SpecialKind, TrackEnd};

macro_rules! as_text {
    ($($name:ty),*) => {$(
        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                text(self, serializer)
            }
        }
    )*};
}

as_text!(
    EventKind,
    Stop,
    SpecialKind,
    TrackEnd,
    Ended,
    Method,
    Verdict
);
