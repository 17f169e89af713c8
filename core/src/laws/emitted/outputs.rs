//! Outputs of a batch: which of the values of a kernel are stored, and where.

// Merged into the loops of every instruction set.
#![allow(clippy::inline_always)]

use super::batch::Uses;
use crate::law::Derivatives;

/// Where some of the values of a kernel go.
pub(super) trait Outputs<const V: usize> {
    /// What the written ones of all values depend on.
    fn needs(uses: &[Uses; V]) -> Uses;

    /// Writes the values of `count` samples from `start` on.
    fn write(&mut self, start: usize, count: usize, values: impl Fn(usize) -> [f64; V]);
}

/// The force alone.
pub(super) struct Force<'a>(pub(super) &'a mut [f64]);

impl<const V: usize> Outputs<V> for Force<'_> {
    #[inline(always)]
    fn needs(uses: &[Uses; V]) -> Uses {
        uses[0]
    }

    #[inline(always)]
    fn write(&mut self, start: usize, count: usize, values: impl Fn(usize) -> [f64; V]) {
        write_1(&mut self.0[start..][..count], values);
    }
}

/// Force, by gap and by rate.
pub(super) struct Slopes<'a>(pub(super) Derivatives<'a>);

impl<const V: usize> Outputs<V> for Slopes<'_> {
    #[inline(always)]
    fn needs(uses: &[Uses; V]) -> Uses {
        uses[0].and(uses[1]).and(uses[2])
    }

    #[inline(always)]
    fn write(&mut self, start: usize, count: usize, values: impl Fn(usize) -> [f64; V]) {
        let out = &mut self.0;
        write_3(
            &mut out.force[start..][..count],
            &mut out.by_gap[start..][..count],
            &mut out.by_rate[start..][..count],
            values,
        );
    }
}

/// Force, by gap and by rate, and the value at a position, a derivative by an argument.
pub(super) struct SlopesAndBy<'a, const AT: usize> {
    pub(super) out: Derivatives<'a>,
    pub(super) by_argument: &'a mut [f64],
}

impl<const V: usize, const AT: usize> Outputs<V> for SlopesAndBy<'_, AT> {
    #[inline(always)]
    fn needs(uses: &[Uses; V]) -> Uses {
        uses[0].and(uses[1]).and(uses[2]).and(uses[AT])
    }

    #[inline(always)]
    fn write(&mut self, start: usize, count: usize, values: impl Fn(usize) -> [f64; V]) {
        let out = &mut self.out;
        write_4::<AT, V>(
            &mut out.force[start..][..count],
            &mut out.by_gap[start..][..count],
            &mut out.by_rate[start..][..count],
            &mut self.by_argument[start..][..count],
            values,
        );
    }
}

// Every output is a parameter of its own, so that the compiler knows that they do not overlap.

#[inline(always)]
fn write_1<const V: usize>(force: &mut [f64], values: impl Fn(usize) -> [f64; V]) {
    for i in 0..force.len() {
        force[i] = values(i)[0];
    }
}

#[inline(always)]
fn write_3<const V: usize>(
    force: &mut [f64],
    by_gap: &mut [f64],
    by_rate: &mut [f64],
    values: impl Fn(usize) -> [f64; V],
) {
    let count = force.len();
    let (by_gap, by_rate) = (&mut by_gap[..count], &mut by_rate[..count]);
    for i in 0..count {
        let values = values(i);
        force[i] = values[0];
        by_gap[i] = values[1];
        by_rate[i] = values[2];
    }
}

#[inline(always)]
fn write_4<const AT: usize, const V: usize>(
    force: &mut [f64],
    by_gap: &mut [f64],
    by_rate: &mut [f64],
    by_argument: &mut [f64],
    values: impl Fn(usize) -> [f64; V],
) {
    let count = force.len();
    let (by_gap, by_rate) = (&mut by_gap[..count], &mut by_rate[..count]);
    let by_argument = &mut by_argument[..count];
    for i in 0..count {
        let values = values(i);
        force[i] = values[0];
        by_gap[i] = values[1];
        by_rate[i] = values[2];
        by_argument[i] = values[AT];
    }
}
