//! Equations of which most unknowns are states that are coupled in pairs only, as those of modes: link by link, before anything is eliminated.
//!
//! States `s_0 = T^-1 u` where a motion begins go through links, as in [`chain`](crate::continuation::chain), and come back. With the unknowns
//! `x_k` of link `k`, the other unknowns `z` and the parameter among them,
//!
//! ```text
//! A_k x_k + B_k s_k + L_k z = r_k                                                                             (1)
//! s_k+1 = E_k s_k + F_k x_k + G_k z,    E_k with blocks of order two                                          (2)
//! sum_k P_ik s_k + Q_i z = r_i,    as many as there are `z`, without the parameter                             (3)
//! T (s_end - sign s_0) = r                                                                                    (4)
//! ```
//!
//! where a link has an effect of `z` by what moves with where it begins, with where it ends, and with the parameter: `G_k` has three columns that
//! differ.

use std::sync::Arc;

use crate::numeric::sparse::SparseRows;

/// A matrix of order two.
pub(crate) type Square = [[f64; 2]; 2];

/// `T` and `T^-1`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Basis {
    pub(crate) to: SparseRows,
    pub(crate) from: SparseRows,
}

/// One link.
#[derive(Debug)]
pub(crate) struct PairLink {
    /// The place of its first unknown behind the `z` that are not the parameter.
    pub(super) first: usize,
    pub(super) count: usize,
    /// `A`, `B` and `L`, row by row.
    pub(super) own: Vec<f64>,
    pub(super) by_states: Vec<f64>,
    pub(super) direct: Vec<f64>,
    /// Rows of the blocks of `E`, and `F` row by row.
    pub(super) carried: Vec<[f64; 2]>,
    pub(super) driven: Vec<f64>,
    /// `G` of every state: by where the link begins, by where it ends, and by the parameter.
    pub(super) slopes: Vec<[f64; 3]>,
    /// How these places change with `z`.
    pub(super) ends: [Vec<(usize, f64)>; 2],
}

/// A term of (3).
#[derive(Debug, Clone, Copy)]
pub(super) struct Read {
    pub(super) equation: usize,
    /// Of the states behind it.
    pub(super) link: usize,
    /// Which of the factors.
    pub(super) index: usize,
}

/// All of them.
#[derive(Debug)]
pub(crate) struct PairLinks {
    pub(super) pairs: usize,
    /// Unknowns `z`, without the parameter.
    pub(super) others: usize,
    /// Unknowns of links.
    pub(super) inner: usize,
    pub(super) links: Vec<PairLink>,
    /// `Q`, row by row.
    pub(super) direct: Vec<f64>,
    /// In the order of links once an arrow has taken them.
    pub(super) reads: Vec<Read>,
    /// `P`, read by read.
    pub(super) factors: Vec<f64>,
    /// `sign` of (4).
    pub(super) sign: f64,
    pub(super) basis: Arc<Basis>,
    /// Derivatives of all equations by the parameter, where it does more than (1) to (3) have, else nothing: of (4) for states.
    pub(super) parameter: Vec<f64>,
}

impl PairLink {
    fn new(first: usize, count: usize, pairs: usize, others: usize) -> Self {
        let states = 2 * pairs;
        Self {
            first,
            count,
            own: vec![0.0; count * count],
            by_states: vec![0.0; count * states],
            direct: vec![0.0; count * (others + 1)],
            carried: vec![[0.0; 2]; states],
            driven: vec![0.0; states * count],
            slopes: vec![[0.0; 3]; states],
            ends: [Vec::with_capacity(4), Vec::with_capacity(4)],
        }
    }

    /// One of (1), to be written: rows of `A`, `B` and `L`.
    pub(crate) fn equation_mut(&mut self, row: usize) -> [&mut [f64]; 3] {
        let (count, states) = (self.count, self.carried.len());
        let columns = self.direct.len() / count.max(1);
        [
            &mut self.own[row * count..][..count],
            &mut self.by_states[row * states..][..states],
            &mut self.direct[row * columns..][..columns],
        ]
    }

    /// One of (2), to be written: rows of a block of `E` and of `F`.
    pub(crate) fn state_mut(&mut self, row: usize) -> [&mut [f64]; 2] {
        [
            &mut self.carried[row],
            &mut self.driven[row * self.count..][..self.count],
        ]
    }

    /// `G` of a state, to be written.
    pub(crate) fn slopes_mut(&mut self, row: usize) -> &mut [f64; 3] {
        &mut self.slopes[row]
    }

    /// How the places where it begins and ends change with `z`.
    pub(crate) fn set_ends(&mut self, ends: [impl Iterator<Item = (usize, f64)>; 2]) {
        for (to, of) in self.ends.iter_mut().zip(ends) {
            to.clear();
            to.extend(of);
        }
    }

    /// Everything is zero, but that states go on as they are.
    pub(crate) fn clear(&mut self) {
        let all = [&mut self.own, &mut self.by_states, &mut self.driven];
        for of in all.into_iter().chain([&mut self.direct]) {
            of.fill(0.0);
        }
        for pair in self.carried.chunks_exact_mut(2) {
            pair.copy_from_slice(&[[1.0, 0.0], [0.0, 1.0]]);
        }
        self.slopes.fill([0.0; 3]);
        self.ends.iter_mut().for_each(Vec::clear);
    }

    /// A block of `E`.
    #[inline]
    pub(super) fn block(&self, pair: usize) -> Square {
        [self.carried[2 * pair], self.carried[2 * pair + 1]]
    }
}

impl PairLinks {
    /// Of links with so many unknowns each, between so many pairs, beside so many other unknowns.
    pub(crate) fn new(counts: impl Iterator<Item = usize>, pairs: usize, others: usize) -> Self {
        let mut inner = 0;
        let links = counts.map(|count| {
            let link = PairLink::new(inner, count, pairs, others);
            inner += count;
            link
        });
        let links: Vec<PairLink> = links.collect();
        Self {
            pairs,
            others,
            inner,
            links,
            direct: vec![0.0; others * (others + 1)],
            reads: Vec::new(),
            factors: Vec::new(),
            sign: 1.0,
            basis: Arc::default(),
            parameter: Vec::new(),
        }
    }

    /// Begins anew, with `T` and the sign of (4).
    pub(crate) fn begin(&mut self, basis: &Arc<Basis>, sign: f64) {
        self.basis.clone_from(basis);
        self.sign = sign;
        self.direct.fill(0.0);
        self.reads.clear();
        self.factors.clear();
        self.parameter.clear();
    }

    pub(crate) fn link_mut(&mut self, link: usize) -> &mut PairLink {
        &mut self.links[link]
    }

    /// A row of `Q`, to be written.
    pub(crate) fn direct_mut(&mut self, equation: usize) -> &mut [f64] {
        let columns = self.others + 1;
        &mut self.direct[equation * columns..][..columns]
    }

    /// Adds a multiple of a linear form of the states behind a link to one of (3).
    pub(crate) fn read(&mut self, equation: usize, link: usize, factor: f64, form: &[f64]) {
        self.reads.push(Read {
            equation,
            link,
            index: self.reads.len(),
        });
        self.factors.extend(form.iter().map(|x| factor * x));
    }

    /// Takes derivatives of all residuals by the parameter, which it does not have otherwise.
    pub(crate) fn set_parameter(&mut self, derivatives: &[f64]) {
        self.parameter.clear();
        self.parameter.extend_from_slice(derivatives);
        self.basis.from.times(derivatives, &mut self.parameter);
    }

    /// Multiplications of an elimination of the states and of what is left, about.
    pub(crate) fn operations(&self) -> u64 {
        operations(self.links.len(), self.inner, self.pairs, self.others)
    }
}

/// Multiplications for so many links with so many unknowns in all.
pub(crate) fn operations(links: usize, inner: usize, pairs: usize, others: usize) -> u64 {
    let [links, pairs, rows] = [links, pairs, inner + others + 1].map(|n| n as u64);
    rows.pow(3) / 3 + 2 * pairs * rows * (4 * links + rows)
}
