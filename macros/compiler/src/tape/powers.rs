//! Powers as code: products and roots where the exponent is a known multiple of 1/2, 1/3 or 1/4; otherwise one logarithm
//! per base, one exponential per exponent modulo one.
//!
//! Cube roots, logarithms and exponentials are not part of a kernel. The runtime computes them for a whole block of
//! samples, before the kernel combines them. What is to be computed is a [`Plan`]: the bases, and groups of exponents that
//! count up by one. The lowest power of a group is an exponential, the others are its products with the base.
//!
//! # Accuracy
//!
//! A product adds one rounding. The exponents of a group are written out each for itself, because the runtime takes an
//! exponential of its own where the lowest power may overflow and the others do not.
//!
//! Powers of what is the same for all samples, and powers of powers, are left to the standard library.

use std::collections::HashMap;

use super::{Builder, Operation};
use crate::dag::{Dag, Id, Node, Rational, Variable};

/// Fractional powers above this one are computed by logarithm and exponential; beyond it no exponential is shared.
const MAX_WHOLE: i128 = 64;

/// How many multiplications by the base are worth less than an exponential.
const MAX_STEPS: i128 = 4;

/// Sets of powers are the bits of a word at run time.
const MAX_PLANNED: usize = 64;

/// Powers of one base that share an exponential.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The position of the base.
    pub base: usize,
    /// The position of the lowest power; the others follow it.
    pub first: usize,
    /// How many there are.
    pub count: usize,
    /// It is the cube root.
    pub cube_root: bool,
}

/// Powers of one base whose exponents differ by whole numbers.
struct Family {
    base: Id,
    /// What the exponents have in common.
    rest: Id,
    /// The exponents, each after its whole part.
    members: Vec<(i128, Id)>,
}

/// What is computed before a kernel runs.
#[derive(Debug, Default)]
pub struct Plan {
    /// The bases.
    pub bases: Vec<Id>,
    /// The exponents, one for each power.
    pub exponents: Vec<Id>,
    /// Which powers share an exponential.
    pub groups: Vec<Group>,
    /// Where each base is.
    positions: HashMap<Id, usize>,
    powers: HashMap<(Id, Id), usize>,
    cube_roots: HashMap<Id, usize>,
}

impl Plan {
    /// Plans the powers of all expressions under `roots`.
    pub fn of(dag: &mut Dag, roots: &[Id]) -> Self {
        let mut plan = Self::default();
        let mut families: Vec<Family> = Vec::new();
        for id in dag.reachable(roots) {
            if let Some((base, Root::Cube)) = root_of(dag, id) {
                plan.add_cube_root(dag, base);
            }
            let Some((base, exponent)) = real_power(dag, id) else {
                continue;
            };
            let simple = dag.as_number(exponent).and_then(simple).is_some();
            if !plan.admits(dag, base) || simple {
                continue;
            }
            let (rest, whole) = split_whole(dag, exponent);
            let of_family = |family: &&mut Family| family.base == base && family.rest == rest;
            match families.iter_mut().find(of_family) {
                Some(family) => family.members.push((whole, exponent)),
                None => families.push(Family {
                    base,
                    rest,
                    members: vec![(whole, exponent)],
                }),
            }
        }
        for Family {
            base, mut members, ..
        } in families
        {
            members.sort_unstable();
            members.dedup();
            for chain in members.chunk_by(|(below, _), (above, _)| above - below <= MAX_STEPS) {
                plan.add_group(dag, base, chain);
            }
        }
        plan
    }

    /// Whether there is nothing to be computed before.
    pub fn is_empty(&self) -> bool {
        self.bases.is_empty()
    }

    /// The position of the logarithm of a base, which is that of the base.
    pub fn logarithm(&self, base: Id) -> Option<usize> {
        self.positions.get(&base).copied()
    }

    /// The position of a power.
    pub fn power(&self, base: Id, exponent: Id) -> Option<usize> {
        self.powers.get(&(base, exponent)).copied()
    }

    /// The position of the cube root of a base among the powers.
    pub fn cube_root(&self, base: Id) -> Option<usize> {
        self.cube_roots.get(&base).copied()
    }

    /// The positions of the logarithms and of the powers that expressions need.
    pub fn uses(&self, dag: &Dag, roots: &[Id]) -> [Vec<usize>; 2] {
        let (mut logarithms, mut powers) = (Vec::new(), Vec::new());
        for id in dag.reachable(roots) {
            if let Some((base, Root::Cube)) = root_of(dag, id) {
                powers.extend(self.cube_root(base));
            }
            match *dag.node(id) {
                Node::Power(base, exponent) => powers.extend(self.power(base, exponent)),
                Node::PowerLog(base, exponent) => {
                    powers.extend(self.power(base, exponent));
                    let fraction = dag.as_number(exponent).and_then(Rational::fraction);
                    if fraction.is_some_and(|(_, denominator)| denominator == 3) {
                        powers.extend(self.cube_root(base));
                    }
                    logarithms.extend(self.logarithm(base));
                }
                _ => {}
            }
        }
        [logarithms, powers].map(|mut positions| {
            positions.sort_unstable();
            positions.dedup();
            positions
        })
    }

    /// Whether a base is planned: one that varies from sample to sample, and is made of no other power that is. It is added
    /// then.
    fn admits(&mut self, dag: &Dag, base: Id) -> bool {
        if self.positions.contains_key(&base) {
            return true;
        }
        let inner = dag.reachable(&[base]).into_iter();
        let mut inner = inner.filter_map(|id| real_power(dag, id));
        let nested = inner.any(|(base, _)| varies(dag, base));
        let admitted = varies(dag, base) && !nested && self.bases.len() < MAX_PLANNED;
        if admitted {
            self.positions.insert(base, self.bases.len());
            self.bases.push(base);
        }
        admitted
    }

    /// Adds powers of one base, in increasing order of their exponents, and those between them.
    fn add_group(&mut self, dag: &mut Dag, base: Id, members: &[(i128, Id)]) {
        let (Some(&(low, lowest)), Some(&(high, _))) = (members.first(), members.last()) else {
            return;
        };
        let (first, count) = (self.exponents.len(), (high - low) as usize + 1);
        if first + count > MAX_PLANNED {
            return;
        }
        for whole in low..=high {
            let member = members.iter().find(|member| member.0 == whole);
            let exponent = if let Some(&(_, exponent)) = member {
                self.powers.insert((base, exponent), self.exponents.len());
                exponent
            } else {
                let steps = dag.number(Rational::integer(whole - low));
                dag.sum(&[lowest, steps])
            };
            self.exponents.push(exponent);
        }
        let base = self.positions[&base];
        self.groups.push(Group {
            base,
            first,
            count,
            cube_root: false,
        });
    }

    fn add_cube_root(&mut self, dag: &mut Dag, base: Id) {
        let (first, Some(third)) = (self.exponents.len(), Rational::new(1, 3)) else {
            return;
        };
        if self.cube_roots.contains_key(&base) || first == MAX_PLANNED || !self.admits(dag, base) {
            return;
        }
        self.cube_roots.insert(base, first);
        self.exponents.push(dag.number(third));
        self.groups.push(Group {
            base: self.positions[&base],
            first,
            count: 1,
            cube_root: true,
        });
    }
}

/// Base and exponent of what needs a logarithm.
fn real_power(dag: &Dag, id: Id) -> Option<(Id, Id)> {
    match *dag.node(id) {
        Node::Power(base, exponent) => {
            let simple = dag.as_number(exponent).and_then(simple).is_some();
            (!simple).then_some((base, exponent))
        }
        Node::PowerLog(base, exponent) => Some((base, exponent)),
        _ => None,
    }
}

/// What the guarded powers of a base have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Root {
    /// The square root.
    Square,
    /// The cube root.
    Cube,
    /// The logarithm.
    Logarithm,
}

/// The base of a guarded power, which is not negative where it is used, and what is computed of it. Of a whole power it may
/// be negative.
pub fn root_of(dag: &Dag, id: Id) -> Option<(Id, Root)> {
    if let Some((base, _)) = real_power(dag, id) {
        return Some((base, Root::Logarithm));
    }
    let Node::Power(base, exponent) = *dag.node(id) else {
        return None;
    };
    match dag.as_number(exponent)?.fraction()?.1 {
        1 => None,
        3 => Some((base, Root::Cube)),
        _ => Some((base, Root::Square)),
    }
}

/// Whether an expression changes from sample to sample.
pub fn varies(dag: &Dag, id: Id) -> bool {
    dag.variables(id).into_iter().any(Variable::varies)
}

/// An exponent as a rest plus a whole number; of a symbolic one, the rest keeps the symbols.
fn split_whole(dag: &mut Dag, exponent: Id) -> (Id, i128) {
    let number = match dag.node(exponent) {
        Node::Number(number) => Some(*number),
        Node::Sum(terms) => terms.iter().find_map(|&term| dag.as_number(term)),
        _ => None,
    };
    let fraction = number.and_then(Rational::fraction);
    let whole = fraction.map_or(0, |(numerator, denominator)| {
        numerator.div_euclid(denominator)
    });
    if whole.abs() > MAX_WHOLE {
        return (exponent, 0);
    }
    let offset = dag.number(Rational::integer(whole));
    (dag.difference(exponent, offset), whole)
}

/// Numerator and denominator of an exponent for which products and roots suffice.
fn simple(exponent: Rational) -> Option<(i128, i128)> {
    let bound = Rational::integer(MAX_WHOLE);
    let small = exponent
        .absolute()
        .is_some_and(|magnitude| magnitude <= bound);
    let fraction = exponent.fraction();
    fraction.filter(|&(_, denominator)| denominator == 1 || small && denominator <= 4)
}

impl Builder<'_> {
    pub(super) fn code_power(&mut self, base: Id, exponent: Id) -> usize {
        if let Some(exact) = self.dag.as_number(exponent).and_then(simple) {
            let (numerator, denominator) = exact;
            return self.simple_power(base, numerator, denominator);
        }
        match self.plan.power(base, exponent) {
            Some(planned) => self.push(Operation::Planned(planned)),
            None => self.push(Operation::Power(self.at[&base], self.at[&exponent])),
        }
    }

    pub(super) fn code_power_log(&mut self, base: Id, exponent: Id) -> usize {
        let Some(planned) = self.plan.logarithm(base) else {
            return self.push(Operation::PowerLog(self.at[&base], self.at[&exponent]));
        };
        let logarithm = self.push(Operation::Logarithm(planned));
        if self.dag.as_number(exponent) == Some(Rational::ZERO) {
            return logarithm;
        }
        let power = self.code_power(base, exponent);
        self.push(Operation::Multiply(power, logarithm))
    }

    /// `base^(k + j/n)` with `n` at most 4. The root is zero for a negative base, and so is the product.
    fn simple_power(&mut self, base: Id, numerator: i128, denominator: i128) -> usize {
        let magnitude = numerator.saturating_abs();
        let (whole, part) = (magnitude / denominator, magnitude % denominator);
        let position = self.at[&base];
        if part == 0 && numerator < 0 && self.varies(base) {
            // The negative powers of one base share its reciprocal.
            let reciprocal = self.push(Operation::Reciprocal(position));
            return self.whole_power(reciprocal, whole);
        }
        let mut power = None;
        if whole > 0 {
            power = Some(self.whole_power(position, whole));
        }
        if part > 0 {
            let root = self.root(base, part, denominator);
            power = Some(match power {
                Some(power) => self.push(Operation::Multiply(power, root)),
                None => root,
            });
        }
        let Some(power) = power else {
            return self.number(1.0);
        };
        if numerator >= 0 {
            power
        } else if self.varies(base) {
            self.push(Operation::Reciprocal(power))
        } else {
            let one = self.number(1.0);
            self.push(Operation::Divide(one, power))
        }
    }

    /// `base^(part/of)` for a proper fraction.
    fn root(&mut self, base: Id, part: i128, of: i128) -> usize {
        if of == 3 {
            let root = match self.plan.cube_root(base) {
                Some(planned) => self.push(Operation::Planned(planned)),
                None => self.push(Operation::CubeRoot(self.at[&base])),
            };
            return self.whole_power(root, part);
        }
        let half = self.push(Operation::Root(self.at[&base]));
        if of == 2 {
            return half;
        }
        let quarter = self.push(Operation::Root(half));
        if part == 1 {
            quarter
        } else {
            self.push(Operation::Multiply(half, quarter))
        }
    }

    /// A positive whole power by squaring.
    fn whole_power(&mut self, base: usize, exponent: i128) -> usize {
        if exponent == 1 {
            return base;
        }
        let half = self.whole_power(base, exponent / 2);
        let even = self.push(Operation::Multiply(half, half));
        if exponent % 2 == 0 {
            even
        } else {
            self.push(Operation::Multiply(even, base))
        }
    }
}
