//! Rules on the pieces of a law: together they hold every gap once.

use std::cmp::Ordering;

use crate::dag::{Id, Variable};
use crate::errors::{Diagnostics, Extent};
use crate::lower::expand::Expander;
use crate::lower::interval::Stretch;

/// Where a piece holds, as far as it says so: ends of the gap, and whether they are included.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    /// Lower end.
    pub low: Option<(Id, bool)>,
    /// Upper end.
    pub high: Option<(Id, bool)>,
    /// Index of the piece in the declaration.
    pub index: usize,
    /// Its condition.
    pub extent: Extent,
}

/// Which of two levels is the higher one, by the declared ranges. Levels that may coincide count as ordered.
pub fn order(context: &mut Expander, a: Id, b: Id) -> Option<Ordering> {
    if a == b {
        return Some(Ordering::Equal);
    }
    let difference = context.dag.difference(b, a);
    let bounds = context
        .ranges
        .bounds(&mut context.dag, difference, Stretch::ALL);
    if bounds.is_not_negative() {
        Some(Ordering::Less)
    } else if bounds.is_not_positive() {
        Some(Ordering::Greater)
    } else {
        None
    }
}

/// The order of two levels is known.
pub fn order_is_known(
    context: &mut Expander,
    a: Id,
    b: Id,
    extent: Extent,
) -> syn::Result<Ordering> {
    order(context, a, b).ok_or_else(|| {
        let difference = context.dag.difference(b, a);
        let advice = super::powers::advice_on_ranges(context, difference, ">");
        let (a, b) = (context.show(a), context.show(b));
        extent.fault(format!(
            "whether the level `{a}` or `{b}` is the higher one is not known: {advice}"
        ))
    })
}

/// Sorts the pieces, and fills what they leave with the piece `rest`, if there is one.
pub fn arranged(
    context: &mut Expander,
    mut pieces: Vec<Piece>,
    rest: Option<(usize, Extent)>,
    law: Extent,
    diagnostics: &mut Diagnostics,
) -> Option<Vec<Piece>> {
    for piece in &pieces {
        diagnostics.keep(piece_is_not_empty(context, piece))?;
    }
    diagnostics.keep(sort(context, &mut pieces))?;
    let mut arranged: Vec<Piece> = Vec::new();
    let mut filled = false;
    let mut sound = true;
    // The end of what is covered so far; `None` is minus infinity before the first piece.
    for index in 0..=pieces.len() {
        let next = pieces.get(index).copied();
        let below = arranged.last().map(|piece| piece.high);
        let hole = diagnostics.keep(hole_between(context, below, next.as_ref()));
        sound &= hole.is_some();
        if let Some((low, high)) = hole.flatten() {
            if let Some((index, extent)) = rest {
                filled = true;
                arranged.push(Piece {
                    low,
                    high,
                    index,
                    extent,
                });
            } else {
                sound = false;
                diagnostics.add(pieces_leave_no_gap(context, low, high, law));
            }
        }
        arranged.extend(next);
    }
    if let (Some((_, extent)), false, true) = (rest, filled, sound) {
        diagnostics.report(
            extent,
            "`else` never applies: the other pieces hold for every gap; remove it",
        );
        sound = false;
    }
    sound.then_some(arranged)
}

fn sort(context: &mut Expander, pieces: &mut [Piece]) -> syn::Result<()> {
    for end in 1..pieces.len() {
        let mut position = end;
        while position > 0 {
            let (left, right) = (pieces[position - 1], pieces[position]);
            let swapped = match (left.low, right.low) {
                (_, None) => left.low.is_some(),
                (None, Some(_)) => false,
                (Some((a, _)), Some((b, _))) => {
                    order_is_known(context, a, b, right.extent)? == Ordering::Greater
                }
            };
            if !swapped {
                break;
            }
            pieces.swap(position - 1, position);
            position -= 1;
        }
    }
    Ok(())
}

/// A piece holds somewhere.
fn piece_is_not_empty(context: &mut Expander, piece: &Piece) -> syn::Result<()> {
    let (Some((low, above)), Some((high, below))) = (piece.low, piece.high) else {
        return Ok(());
    };
    match order_is_known(context, low, high, piece.extent)? {
        Ordering::Less => Ok(()),
        Ordering::Equal if above && below => Err(piece
            .extent
            .fault("this piece is a single gap, where a force has no effect: remove it, and include the level with `>=` in a neighbour")),
        _ => Err(piece.extent.fault("no gap fulfils this condition: write the lower level first")),
    }
}

type End = Option<(Id, bool)>;

/// What lies between the end of one piece and the start of the next: nothing, or a stretch without a piece.
fn hole_between(
    context: &mut Expander,
    below: Option<End>,
    next: Option<&Piece>,
) -> syn::Result<Option<(End, End)>> {
    let opposite = |end: End| end.map(|(level, included)| (level, !included));
    let (end, start) = match (below, next) {
        (None, None) => return Ok(Some((None, None))),
        (None, Some(next)) => return Ok(next.low.map(|low| (None, opposite(Some(low))))),
        (Some(end), None) => return Ok(end.map(|end| (opposite(Some(end)), None))),
        (Some(end), Some(next)) => (end, next),
    };
    pieces_do_not_overlap(context, end, start)?;
    let (Some(end), Some(low)) = (end, start.low) else {
        return Ok(None);
    };
    if order(context, end.0, low.0) == Some(Ordering::Equal) {
        if !end.1 && !low.1 {
            let gap = context.label(Variable::Gap);
            let level = context.show(low.0);
            return Err(start.extent.fault(format!(
                "no piece holds at `{gap} = {level}` itself: write `>=` or `<=` in one of the two pieces that meet there"
            )));
        }
        return Ok(None);
    }
    Ok(Some((opposite(Some(end)), opposite(Some(low)))))
}

/// No gap belongs to two pieces.
fn pieces_do_not_overlap(context: &mut Expander, end: End, next: &Piece) -> syn::Result<()> {
    let overlap = match (end, next.low) {
        (Some((end, included)), Some((low, also))) => {
            match order_is_known(context, end, low, next.extent)? {
                Ordering::Less => false,
                Ordering::Equal => included && also,
                Ordering::Greater => true,
            }
        }
        _ => true,
    };
    if overlap {
        let gap = context.label(Variable::Gap);
        let until = end.map_or_else(
            || "for all larger gaps".to_owned(),
            |(end, _)| format!("up to `{gap} = {}`", context.show(end)),
        );
        return Err(next.extent.fault(format!(
            "this piece overlaps another one, which holds {until}: every gap must belong to one piece"
        )));
    }
    Ok(())
}

/// Every gap belongs to a piece.
fn pieces_leave_no_gap(context: &Expander, low: End, high: End, law: Extent) -> syn::Error {
    let gap = context.label(Variable::Gap);
    let relation = |included| if included { "<=" } else { "<" };
    let text = match (low, high) {
        (Some((low, above)), Some((high, below))) => {
            format!(
                "{} {} {gap} {} {}",
                context.show(low),
                relation(above),
                relation(below),
                context.show(high)
            )
        }
        (None, Some((high, below))) => format!("{gap} {} {}", relation(below), context.show(high)),
        (Some((low, above)), None) => format!(
            "{gap} {} {}",
            if above { ">=" } else { ">" },
            context.show(low)
        ),
        (None, None) => "every gap".to_owned(),
    };
    law.fault(format!(
        "no piece holds for `{text}`: add one, or `else => 0`"
    ))
}
