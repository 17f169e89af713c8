//! What a skeleton is made from, as data: where a period begins, and its switches.
//!
//! Of an orbit that comes back after a part of its period, with coordinates or contacts in each other's place, that part is all there is.

use std::f64::consts::TAU;

use crate::branches::recurrence::Recurrence;
use crate::contact_equation::linear_part::contact::Contact;

/// How a switch is told by its unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(in crate::contact_equation) enum Told {
    /// By its phase.
    Alone,
    /// It is the first of two: its unknown is `c` of (2) of [`skeleton`](crate::contact_equation::skeleton), and half of `g''` and the lean `l` there belong to
    /// it, by the phase.
    First {
        other: usize,
        #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
        bend: f64,
        #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
        lean: f64,
    },
    /// It is the second of two: its unknown is `H`.
    Second { other: usize },
}

impl Told {
    /// `l` of (2) of [`skeleton`](crate::contact_equation::skeleton); zero where it is not the first of two.
    pub(in crate::contact_equation) fn lean(self) -> f64 {
        match self {
            Self::First { lean, .. } => lean,
            _ => 0.0,
        }
    }
}

/// A gap at a level.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Switch {
    pub(in crate::contact_equation) contact: usize,
    pub(in crate::contact_equation) level: usize,
    /// The gap rises there.
    pub(in crate::contact_equation) rises: bool,
    pub(in crate::contact_equation) told: Told,
}

impl Switch {
    /// Whether it may meet the next one of its gap: at one level, the other way.
    pub(in crate::contact_equation) fn can_meet(&self, next: &Self) -> bool {
        (self.contact, self.level) == (next.contact, next.level) && self.rises != next.rises
    }
}

/// A switch with the phase where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Placed {
    pub(in crate::contact_equation) switch: Switch,
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) phase: f64,
}

/// Nearer to a switch than this part of the way there is no kink, nor nearer than the other to another one.
pub(in crate::contact_equation) const EDGE: f64 = 1e-6;
pub(in crate::contact_equation) const APART: f64 = 1e-9;
/// Kinks of a way, at most, with those about narrow places.
pub(in crate::contact_equation) const MOST: usize = 256;

/// Where the slope of a force jumps between two cuts, or where panels end about a place where it turns sharply.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Kink {
    /// Switches before it.
    pub(in crate::contact_equation) after: usize,
    /// Part of the way from the last of these, or the beginning, to the next one, or the end.
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) part: f64,
    /// How far from there panels may end as well; zero where the slope jumps.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::serialise"))]
    pub(in crate::contact_equation) free: f64,
}

/// Nodes of a stretch and panels of a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Resolution {
    pub(in crate::contact_equation) nodes: usize,
    /// Nodes, with finer panels the longer the stretch: so many panels in a whole period.
    pub(in crate::contact_equation) panels: usize,
}

/// Where a period or a part of it begins, how the orbit comes back after it, and on which pieces the gaps are at its beginning.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Beginning {
    #[cfg_attr(feature = "serde", serde(with = "crate::serialise"))]
    pub(in crate::contact_equation) phase: f64,
    pub(in crate::contact_equation) recurrence: Recurrence,
    pub(in crate::contact_equation) pieces: Vec<usize>,
}

impl Beginning {
    /// Phase until the orbit comes back.
    pub(in crate::contact_equation) fn length(&self) -> f64 {
        length(&self.recurrence)
    }
}

/// Phase of the declaration until an orbit comes back.
pub(in crate::contact_equation) fn length(recurrence: &Recurrence) -> f64 {
    TAU * recurrence.period as f64 / recurrence.parts as f64
}

/// What a skeleton is made from: its beginning, and switches and kinks in the order of time.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(in crate::contact_equation) struct Placement {
    pub(in crate::contact_equation) beginning: Beginning,
    pub(in crate::contact_equation) placed: Vec<Placed>,
    /// Panels end there.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(in crate::contact_equation) kinks: Vec<Kink>,
    pub(in crate::contact_equation) resolution: Resolution,
}

impl Placement {
    /// Whether it is one of these contacts: it may have been read from a file.
    pub(in crate::contact_equation) fn fits(&self, contacts: &[Contact]) -> bool {
        let Beginning { phase, pieces, .. } = &self.beginning;
        let length = self.beginning.length();
        let mut levels = contacts.iter().map(|contact| contact.levels.len());
        let on_pieces = pieces.len() == contacts.len()
            && pieces.iter().all(|piece| levels.next() >= Some(*piece));
        let has_level = |placed: &Placed| {
            let Switch { contact, level, .. } = placed.switch;
            contacts
                .get(contact)
                .is_some_and(|of| level < of.levels.len())
        };
        let end = phase + length;
        let within = |placed: &Placed| (*phase..=end).contains(&placed.phase);
        let told = |index: usize| self.is_told(index);
        let places = self.kinks.iter().map(|kink| (kink.after, kink.part));
        let between = |kink: &Kink| {
            let inside = kink.part >= EDGE && kink.part <= 1.0 - EDGE;
            kink.after <= self.placed.len() && inside && (0.0..=1.0).contains(&kink.free)
        };
        let apart = |a: &Kink, b: &Kink| a.after != b.after || b.part - a.part >= APART;
        on_pieces
            && (0.0..=length).contains(phase)
            && self.placed.iter().all(has_level)
            && self.placed.iter().all(within)
            && self.placed.is_sorted_by(|a, b| a.phase <= b.phase)
            && (0..self.placed.len()).all(told)
            && places.is_sorted_by(|a, b| a < b)
            && self.kinks.iter().all(between)
            && self.kinks.is_sorted_by(apart)
            && self.kinks.len() <= MOST * (self.placed.len() + 1)
    }

    /// Whether a switch is alone, or one of two that name each other: of the same gap at the same level, which rises at one of them.
    fn is_told(&self, index: usize) -> bool {
        let own = self.placed[index].switch;
        let other = |place: usize| {
            let of = self.placed.get(place).map(|placed| placed.switch);
            of.filter(|of| {
                (of.contact, of.level) == (own.contact, own.level) && of.rises != own.rises
            })
        };
        match own.told {
            Told::Alone => true,
            Told::First {
                other: place,
                bend,
                lean,
            } => {
                let second = other(place).map(|second| second.told);
                let known = bend.is_finite() && lean.is_finite();
                place > index && known && second == Some(Told::Second { other: index })
            }
            Told::Second { other: place } => {
                let first = other(place).map(|first| first.told);
                place < index && matches!(first, Some(Told::First { other, .. }) if other == index)
            }
        }
    }
}
