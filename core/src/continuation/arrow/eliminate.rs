//! What is left without pairs, from the links of all of them: pair after pair, with what belongs to one in registers or near them.
//!
//! Numbers of equations are those of [`arrow`](super).
#![allow(
    clippy::inline_always,
    reason = "what is not inlined is not compiled for the instruction set of its caller"
)]

use multiversion::multiversion;

use super::Arrow;
use super::links::{PairLink, PairLinks, Square};
use crate::numeric::linear::{Group, LANES};

/// Of one pair.
#[derive(Debug)]
pub(super) struct Room {
    /// `K`, or `R`.
    response: [Vec<Group>; 2],
    /// `W`
    forms: [Vec<Group>; 2],
}

impl Room {
    /// Of so many groups of unknowns.
    pub(super) fn new(groups: usize) -> Self {
        let one = || vec![[0.0; LANES]; groups];
        Self {
            response: [one(), one()],
            forms: [one(), one()],
        }
    }
}

/// `E_end .. E_0` of a pair.
pub(super) fn whole(of: &PairLinks, pair: usize) -> Square {
    let start = [[1.0, 0.0], [0.0, 1.0]];
    let links = of.links.iter();
    links.fold(start, |whole, link| product(link.block(pair), whole))
}

pub(super) fn minus([[a, b], [c, d]]: Square, sign: f64) -> Square {
    [[a - sign, b], [c, d - sign]]
}

#[inline(always)]
fn product(a: Square, b: Square) -> Square {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

#[inline(always)]
pub(super) fn times(a: Square, x: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| a[i][0] * x[0] + a[i][1] * x[1])
}

#[inline(always)]
pub(super) fn row_times(x: [f64; 2], a: Square) -> [f64; 2] {
    [0, 1].map(|j| x[0] * a[0][j] + x[1] * a[1][j])
}

/// (2) of [`arrow`](super), pair after pair.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn eliminate(to: &mut Arrow, of: &PairLinks) {
    let groups = to.values.len();
    let mut kept = 0;
    for pair in 0..of.pairs {
        let response = &mut to.room.response;
        respond(of, pair, to.others - 1, response);
        let place = 2 * pair * groups..2 * (pair + 1) * groups;
        let by_others = &mut to.by_others[place.clone()];
        let inverse = to.inverses[pair];
        let stays = to.kept.get(kept) == Some(&pair);
        if stays {
            for (i, row) in response.iter_mut().enumerate() {
                let entries = to.matrix.row_mut(2 * kept + i);
                entries[2 * to.kept.len()..].copy_from_slice(&row.as_flattened()[..to.others]);
                let own = minus(whole(of, pair), of.sign)[i];
                entries[2 * kept..2 * kept + 2].copy_from_slice(&own);
                row.fill([0.0; LANES]);
            }
        }
        let [first, second] = response;
        for (g, (x, y)) in first.iter_mut().zip(second).enumerate() {
            for l in 0..LANES {
                let [a, b] = times(inverse, [x[l], y[l]]);
                (by_others[g][l], by_others[groups + g][l]) = (a, b);
                (x[l], y[l]) = (-a, -b);
            }
        }
        read(of, pair, to.others - 1, &mut to.room, &mut to.sums);
        let Room { forms, .. } = &to.room;
        let of_states = &mut to.of_states[place];
        for g in 0..groups {
            for l in 0..LANES {
                let [a, b] = row_times([forms[0][g][l], forms[1][g][l]], inverse);
                (of_states[g][l], of_states[groups + g][l]) = (a, b);
            }
        }
        if stays {
            for (row, x) in forms[0].as_flattened()[..to.others].iter().enumerate() {
                let entries = to.matrix.row_mut(2 * to.kept.len() + row);
                entries[2 * kept] = *x;
                entries[2 * kept + 1] = forms[1].as_flattened()[row];
            }
            kept += 1;
        }
    }
}

/// What the others do to a pair until the end of all links, from rest: `K`.
#[inline(always)]
fn respond(of: &PairLinks, pair: usize, last: usize, response: &mut [Vec<Group>; 2]) {
    for row in response.iter_mut() {
        row.fill([0.0; LANES]);
    }
    for (index, link) in of.links.iter().enumerate() {
        go(link, [pair, of.others, last], response, index > 0);
    }
    let parameter = of.parameter.iter().skip(2 * pair);
    for (row, by) in response.iter_mut().zip(parameter) {
        row.as_flattened_mut()[last] += by;
    }
}

/// Adds what is read of a pair to the rows of `C`, from `R_0` on, and writes what is read of its states where the motion begins.
#[inline(always)]
fn read(of: &PairLinks, pair: usize, last: usize, room: &mut Room, sums: &mut [Group]) {
    let Room { response, forms } = room;
    for row in forms.iter_mut() {
        row.fill([0.0; LANES]);
    }
    let groups = response[0].len();
    let states = 2 * of.pairs;
    let mut whole = [[1.0, 0.0], [0.0, 1.0]];
    let mut reads = of.reads.iter().peekable();
    for (index, link) in of.links.iter().enumerate() {
        let rows = (of.others + link.first)..(of.others + link.first + link.count);
        let sums_of = sums[rows.start * groups..rows.end * groups].chunks_exact_mut(groups);
        for ((sums, by), row) in sums_of.zip(link.by_states.chunks_exact(states)).zip(rows) {
            let by = [by[2 * pair], by[2 * pair + 1]];
            add_form(by, response, sums);
            add_states(row_times(by, whole), row, forms);
        }
        go(link, [pair, of.others, last], response, true);
        whole = product(link.block(pair), whole);
        while let Some(read) = reads.next_if(|read| read.link == index) {
            let by = &of.factors[read.index * states + 2 * pair..][..2];
            let by = [by[0], by[1]];
            add_form(by, response, &mut sums[read.equation * groups..][..groups]);
            add_states(row_times(by, whole), read.equation, forms);
        }
    }
}

/// Adds a form of a pair to a row of `C`.
#[inline(always)]
fn add_form(by: [f64; 2], response: &[Vec<Group>; 2], sums: &mut [Group]) {
    for ((sum, x), y) in sums.iter_mut().zip(&response[0]).zip(&response[1]) {
        for l in 0..LANES {
            sum[l] += by[0] * x[l] + by[1] * y[l];
        }
    }
}

/// Adds it to a row of `W`.
#[inline(always)]
fn add_states(by: [f64; 2], row: usize, forms: &mut [Vec<Group>; 2]) {
    for (form, x) in forms.iter_mut().zip(by) {
        form.as_flattened_mut()[row] += x;
    }
}

/// Goes over a link.
#[inline(always)]
fn go(
    link: &PairLink,
    [pair, others, last]: [usize; 3],
    response: &mut [Vec<Group>; 2],
    begun: bool,
) {
    if begun {
        let block = link.block(pair);
        let [first, second] = &mut *response;
        for (x, y) in first.iter_mut().zip(second) {
            for l in 0..LANES {
                let [a, b] = times(block, [x[l], y[l]]);
                (x[l], y[l]) = (a, b);
            }
        }
    }
    for (i, row) in response.iter_mut().enumerate() {
        let row = row.as_flattened_mut();
        let state = 2 * pair + i;
        let driven = &link.driven[state * link.count..][..link.count];
        let own = &mut row[others + link.first..][..link.count];
        for (x, by) in own.iter_mut().zip(driven) {
            *x += by;
        }
        let slopes = link.slopes[state];
        for (ends, slope) in link.ends.iter().zip(slopes) {
            for &(other, factor) in ends {
                row[other] += slope * factor;
            }
        }
        row[last] += slopes[2];
    }
}
