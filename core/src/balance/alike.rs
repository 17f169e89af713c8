//! Contacts of which one speaks for others.
//!
//! Where a part of the period later every contact takes the place of another one, orbits that come back after that part have forces
//! `F_j(tau) = F_0(tau - j 2 pi / m)` on the equations. Their harmonics that are multiples of `m` are equal, and no others are asked for:
//!
//! ```text
//! sum_j (F_j)_k = N (F_0)_k,    k = 0, m, 2 m, ...                                                              (1)
//! ```
//!
//! with as many contacts `N` as take each other's place. Of eight balls of a bearing one is evaluated in each iteration.
//! The others are where they were, so the same holds of the derivatives by orbits of this kind.
//!
//! Source: Golubitsky, Stewart and Schaeffer (1988), Singularities and Groups in Bifurcation Theory II, chapter XVI.

use super::symmetry::cycles;
use super::{Balance, Lattice, Resolution};
use crate::model::rigid::Place;
use crate::numeric::fourier::series;

/// Where the variable is, and how far from there, in its own size, contacts are compared: two may be alike at one value by chance.
const COMPARED: [f64; 4] = [0.0, 0.137, 0.36, -0.083];

/// A contact, and for how many it speaks, itself included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Alike {
    pub(super) contact: usize,
    pub(super) count: f64,
}

/// The contacts that are evaluated.
pub(super) fn of(place: Place<'_>, resolution: Resolution) -> Vec<Alike> {
    let contacts = place.layout.contacts.len();
    let each = |contact| Alike {
        contact,
        count: 1.0,
    };
    let Resolution { stride, period, .. } = resolution;
    let found = (stride > 1 && stride.is_multiple_of(period)).then(|| {
        let value = place.value();
        let size = if value == 0.0 { 1.0 } else { value.abs() };
        let values = COMPARED.map(|part| place.coefficients(value + part * size));
        cycles(place.system, place.layout, &values, stride / period)
    });
    let Some(cycles) = found.flatten() else {
        return (0..contacts).map(each).collect();
    };
    let one = |cycle: &Vec<usize>| Alike {
        contact: cycle[0],
        count: cycle.len() as f64,
    };
    cycles.iter().map(one).collect()
}

impl Balance<'_> {
    /// Whether one contact speaks for others, so that what is summed up has harmonics that would cancel.
    fn has_alike(&self) -> bool {
        self.alike.len() < self.layout.contacts.len()
    }

    /// Takes those away from a vector of all harmonics.
    pub(super) fn keep_unknowns(&self, values: &mut [f64]) {
        if !self.has_alike() {
            return;
        }
        let Lattice { first, step } = self.resolution.lattice();
        let is_unknown = |k: usize| k >= first && (k - first).is_multiple_of(step);
        for of_one in values.chunks_exact_mut(self.length()) {
            keep(of_one, is_unknown);
        }
    }

    /// The same of the series that couple harmonics.
    pub(super) fn keep_couplings(&mut self) {
        if !self.has_alike() {
            return;
        }
        let stride = self.resolution.stride;
        for block in &mut self.blocks {
            for series in block.series_mut() {
                keep(series, |k| k.is_multiple_of(stride));
            }
        }
    }
}

/// Clears the harmonics that are not kept.
fn keep(of: &mut [f64], kept: impl Fn(usize) -> bool) {
    debug_assert!(of.is_empty() || of.len() == series::length(series::harmonics(of)));
    for (index, x) in of.iter_mut().enumerate() {
        if !kept(index.div_ceil(2)) {
            *x = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::values;
    use super::*;
    use crate::balance::Parity;
    use crate::balance::aft::Aft;
    use crate::continuation::jacobian::Jacobian;
    use crate::continuation::problem::Problem;
    use crate::system::{System, Variable};
    use crate::testing::random::Random;

    hertzian::oscillator! {
        /// Four balls whose cage turns once in the period of the declaration.
        Bearing(x, y) {
            param clearance;
            let cage = omega*t/2;
            law ball(gap, c) { gap > c => (gap - c)^1.5, else => 0 }
            ddot(x) + 0.05*dot(x) + for j in 0..4 {
                let angle = cage + 2*pi*j/4;
                cos(angle)*ball(x*cos(angle) + y*sin(angle), clearance)
            } = 0.3;
            ddot(y) + 0.05*dot(y) + for j in 0..4 {
                let angle = cage + 2*pi*j/4;
                sin(angle)*ball(x*cos(angle) + y*sin(angle), clearance)
            } = 0.1;
        }
    }

    hertzian::oscillator! {
        /// The same, and a stop that is where it was after half of the period, and not before.
        WithStop(x, y) {
            param clearance;
            let cage = omega*t/2;
            law ball(gap, c) { gap > c => (gap - c)^1.5, else => 0 }
            ddot(x) + 0.05*dot(x) + for j in 0..4 {
                let angle = cage + 2*pi*j/4;
                cos(angle)*ball(x*cos(angle) + y*sin(angle), clearance)
            } + cos(2*cage)*ball(x*cos(2*cage), 0.2) = 0.3;
            ddot(y) + 0.05*dot(y) + for j in 0..4 {
                let angle = cage + 2*pi*j/4;
                sin(angle)*ball(x*cos(angle) + y*sin(angle), clearance)
            } = 0.1;
        }
    }

    fn balance(model: &dyn System, stride: usize, core: usize) -> Balance<'_> {
        let resolution = Resolution {
            harmonics: 24,
            core,
            parity: Parity::All,
            stride,
            samples: 64,
            aft: Aft::Switched,
            period: 1,
        };
        let values = values(model);
        Balance::new(model, &values, 0.9, Variable::Parameter(0), resolution)
    }

    fn assert_close(a: &[f64], b: &[f64]) {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    /// Residual, Jacobian and a derivative in a direction, by what some contacts say for others and by all of them.
    fn check(model: &dyn System, stride: usize, counts: &[f64]) {
        let mut random = Random::seeded(7);
        let mut one = balance(model, stride, 12);
        let mut all = balance(model, stride, 12);
        let each = (0..all.layout.contacts.len()).map(|contact| Alike {
            contact,
            count: 1.0,
        });
        all.alike = each.collect();
        let found: Vec<f64> = one.alike.iter().map(|alike| alike.count).collect();
        assert_eq!(found, counts);
        let length = one.length();
        let mut vector = |size: f64| -> Vec<f64> {
            let entries = (0..2 * length).map(|index| {
                let k = (index % length).div_ceil(2);
                let part = if k.is_multiple_of(stride) { size } else { 0.0 };
                random.between(-part, part) / (1 + k * k) as f64
            });
            entries.chain([0.1]).collect()
        };
        let (u, direction) = (vector(1.0), vector(1.0));
        let [a, b] = [&mut one, &mut all].map(|balance| {
            let (mut residual, mut plain) = (vec![0.0; 2 * length], vec![0.0; 2 * length]);
            let mut jacobian = Jacobian::new(balance.partition());
            balance.evaluate(&u, &mut residual, Some(&mut jacobian));
            balance.evaluate(&u, &mut plain, None);
            assert_close(&residual, &plain);
            let mut derivative = vec![0.0; 2 * length];
            balance.apply(&u, &direction, &mut derivative);
            (residual, derivative, jacobian.entries())
        });
        assert!(a.0.iter().any(|x| x.abs() > 0.01));
        assert_close(&a.0, &b.0);
        assert_close(&a.1, &b.1);
        assert_close(a.2.as_slice(), b.2.as_slice());
    }

    #[test]
    fn one_speaks_for_those_that_take_its_place() {
        let bearing = Bearing { clearance: 0.1 };
        check(&bearing, 4, &[4.0]);
        check(&bearing, 2, &[2.0, 2.0]);
        check(&bearing, 1, &[1.0; 4]);
        let with_stop = WithStop { clearance: 0.1 };
        check(&with_stop, 2, &[2.0, 2.0, 1.0]);
    }

    /// Orbits that come back after a quarter there are none: nothing is left out.
    #[test]
    fn contacts_without_the_symmetry_are_all_evaluated() {
        let with_stop = WithStop { clearance: 0.1 };
        let found = balance(&with_stop, 4, 12);
        assert_eq!(found.alike.len(), 5);
    }
}
