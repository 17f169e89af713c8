//! Structures drawn at random: chains, bars, frames of springs and beams, held, free or held by their contacts alone.
//!
//! The lowest elastic frequency is one. A contact meets what the structure would do without it somewhere between rarely and nearly always.

use std::fmt::Write as _;

use hertzian::Complex;
use hertzian::structure::Value;
use hertzian_structure::{
    Damping, Gyroscopic, Load, LoadKind, Ratios, SparseContact, SparseStructure,
};
use hertzian_tests::random::Random;
use nalgebra::{DMatrix, DVector};

use super::laws::Law;
use super::matrices::{along, bonds, matrices, modes_of, ratio, sparse};

/// Numbers of coordinates, few of them more often.
const SIZES: [[usize; 2]; 10] = [
    [2, 2],
    [2, 3],
    [3, 4],
    [3, 6],
    [4, 8],
    [5, 10],
    [8, 16],
    [10, 20],
    [16, 30],
    [25, 40],
];
/// Frequencies at which the response without contacts is looked at.
const LOOKED_AT: usize = 60;

/// A load: of this kind along a direction, `amplitude * cos(harmonic omega t + phase)`.
#[derive(Debug, Clone)]
pub struct DrawnLoad {
    pub kind: LoadKind,
    pub direction: DVector<f64>,
    pub harmonic: u32,
    pub phase: f64,
    pub amplitude: f64,
}

/// A contact, its gap `gap . q - offset`, and the direction of its force.
#[derive(Debug, Clone)]
pub struct DrawnContact {
    pub law: Law,
    pub gap: DVector<f64>,
    pub force: DVector<f64>,
    pub offset: f64,
}

/// A structure with all of its matrices, and the same as the library takes it.
#[derive(Debug, Clone)]
pub struct Drawn {
    pub random: Random,
    pub mass: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Skew-symmetric, times the frequency where that is the speed.
    pub gyroscopic: Option<(DMatrix<f64>, bool)>,
    pub loads: Vec<DrawnLoad>,
    pub contacts: Vec<DrawnContact>,
    /// What is read first.
    pub tip: DVector<f64>,
    pub range: [f64; 2],
    /// Rigid modes, and whether contacts hold them.
    pub rigid: usize,
    pub held: bool,
    damped_as: Damping,
    frequencies: Vec<f64>,
    modes: DMatrix<f64>,
}

/// The structure of a number.
pub fn structure(index: u64) -> Drawn {
    let mut random = Random::of(index);
    let [least, most] = random.one_of(&SIZES);
    let size = least + random.below(most - least + 1);
    let free = size > 2 && random.once_in(5);
    let [mass, stiffness] = matrices(&mut random, size, free);
    let (squares, _) = modes_of(&mass, &stiffness);
    let elastic = |squares: &[f64]| {
        squares
            .iter()
            .position(|s| *s > 1e-9 * squares[squares.len() - 1])
    };
    let rigid = elastic(&squares).unwrap_or(0);
    let stiffness = stiffness / squares[rigid];
    let (squares, modes) = modes_of(&mass, &stiffness);
    // Rigid modes have none, which rounding would leave something of.
    let frequency = |(mode, square): (usize, &f64)| if mode < rigid { 0.0 } else { square.sqrt() };
    let frequencies: Vec<f64> = squares.iter().enumerate().map(frequency).collect();
    let n = mass.nrows();
    let mut drawn = Drawn {
        mass,
        damping: DMatrix::zeros(n, n),
        stiffness,
        gyroscopic: None,
        loads: Vec::new(),
        contacts: Vec::new(),
        tip: DVector::zeros(n),
        range: [0.0; 2],
        rigid,
        held: rigid != 1 || !random.once_in(4),
        damped_as: Damping::None,
        frequencies,
        modes,
        random,
    };
    drawn.range();
    drawn.damp();
    drawn.turn();
    drawn.load();
    drawn.touch();
    drawn
}

impl Drawn {
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }

    /// From below an elastic frequency to above it or the next one, or the other way round.
    fn range(&mut self) {
        let elastic = &self.frequencies[self.rigid..];
        let first = self.random.below(elastic.len().min(3));
        let last = (first + self.random.below(2)).min(elastic.len() - 1);
        let low = elastic[first] * self.random.between(0.75, 0.95);
        let high = elastic[last] * self.random.between(1.05, 1.35);
        self.range = if self.random.once_in(2) {
            [low, high]
        } else {
            [high, low]
        };
    }

    fn damp(&mut self) {
        let n = self.size();
        let random = &mut self.random;
        let zeta = random.magnitude(0.004, 0.06);
        let ratios = match random.below(7) {
            0 => Ratios::One(zeta),
            1 => Ratios::PerMode(
                (0..n.div_ceil(2))
                    .map(|_| zeta * random.between(0.3, 2.0))
                    .collect(),
            ),
            2 => Ratios::Table(vec![[0.5, zeta], [1.5, 2.0 * zeta], [6.0, 0.5 * zeta]]),
            3 => {
                // Times mass and times stiffness: the ratio at a frequency of one is zeta.
                let part = random.between(0.0, 1.0);
                let [mass, stiffness] = [2.0 * zeta * part, 2.0 * zeta * (1.0 - part)];
                self.damping = mass * &self.mass + stiffness * &self.stiffness;
                self.damped_as = Damping::Rayleigh { mass, stiffness };
                return;
            }
            kind => {
                // Dampers to the ground and between places: few, or everywhere and a little of stiffness.
                let few = kind == 4;
                let count = if few { 1 + random.below(3) } else { n };
                let mut matrix = if few {
                    DMatrix::zeros(n, n)
                } else {
                    0.3 * zeta * &self.stiffness
                };
                for _ in 0..count {
                    let (a, b) = (random.below(n), random.below(n));
                    let part = if few { n as f64 / count as f64 } else { 1.0 };
                    let c = 2.0 * zeta * part * random.between(0.3, 1.7) * self.mass[(a, a)];
                    let damper = [(a, b, c)];
                    matrix += if a == b {
                        bonds(n, &damper, [0.5, 0.0])
                    } else {
                        bonds(n, &damper, [1.0, -1.0])
                    };
                }
                self.damped_as = Damping::Matrix(sparse(&matrix));
                self.damping = matrix;
                return;
            }
        };
        let critical = DVector::from_iterator(
            n,
            (0..n).map(|i| 2.0 * ratio(&ratios, i, self.frequencies[i]) * self.frequencies[i]),
        );
        let left = &self.mass * &self.modes;
        self.damping = &left * DMatrix::from_diagonal(&critical) * left.transpose();
        self.damped_as = Damping::Modal(ratios);
    }

    /// A gyroscopic matrix, now and then.
    fn turn(&mut self) {
        let n = self.size();
        if !self.random.once_in(6) {
            return;
        }
        let mut matrix = DMatrix::zeros(n, n);
        for _ in 0..=self.random.below(2) {
            let a = self.random.below(n - 1);
            let strength = self.random.between(0.05, 0.6) * self.mass[(a, a)];
            matrix[(a, a + 1)] += strength;
            matrix[(a + 1, a)] -= strength;
        }
        self.gyroscopic = Some((matrix, self.random.once_in(2)));
    }

    /// One coordinate, the difference of two, or the mean of several; one that moves.
    fn direction(&mut self) -> DVector<f64> {
        let n = self.size();
        let mut direction = DVector::zeros(n);
        let (a, b) = (self.random.below(n), self.random.below(n));
        match self.random.below(6) {
            0 if a != b && self.held => {
                direction[a] = 1.0;
                direction[b] = -1.0;
            }
            1 if a + 1 < n => {
                direction[a] = 0.5;
                direction[a + 1] = 0.5;
            }
            _ => direction[a] = self.random.one_of(&[1.0, 1.0, 1.0, -1.0]),
        }
        direction
    }

    fn load(&mut self) {
        let n = self.size();
        self.tip = self.direction();
        let kinds = [
            LoadKind::Force,
            LoadKind::Force,
            LoadKind::Force,
            LoadKind::Unbalance,
            LoadKind::Base,
            LoadKind::Acceleration,
        ];
        let count = self.random.one_of(&[1, 1, 1, 2]);
        for place in 0..count {
            let kind = self.random.one_of(&kinds);
            let direction = match kind {
                LoadKind::Base | LoadKind::Acceleration => DVector::from_element(n, 1.0),
                _ => self.direction(),
            };
            let harmonic = if place == 0 {
                1
            } else {
                self.random.one_of(&[1, 2, 3])
            };
            self.loads.push(DrawnLoad {
                kind,
                direction,
                harmonic,
                phase: if self.random.once_in(2) {
                    0.0
                } else {
                    self.random.between(-3.0, 3.0)
                },
                amplitude: if place == 0 {
                    1.0
                } else {
                    self.random.between(0.05, 0.4)
                },
            });
        }
        // Without contact the tip moves by one at most.
        let largest = self.without_contact(&self.tip.clone());
        if largest > 0.0 {
            for load in &mut self.loads {
                load.amplitude /= largest;
            }
        }
    }

    /// The force of a load at a frequency, cosine and sine.
    pub fn force(&self, load: &DrawnLoad, omega: f64) -> [DVector<f64>; 2] {
        let frequency = f64::from(load.harmonic) * omega;
        let amplitude = load.amplitude
            * match load.kind {
                LoadKind::Force | LoadKind::Acceleration => 1.0,
                LoadKind::Unbalance => omega * omega,
                LoadKind::Base => frequency * frequency,
            };
        let along = match load.kind {
            LoadKind::Base | LoadKind::Acceleration => &self.mass * &load.direction,
            LoadKind::Force | LoadKind::Unbalance => load.direction.clone(),
        };
        let (sine, cosine) = load.phase.sin_cos();
        [amplitude * cosine * &along, -amplitude * sine * along]
    }

    /// Damping with the gyroscopic matrix at a frequency.
    pub fn damping_at(&self, omega: f64) -> DMatrix<f64> {
        let mut damping = self.damping.clone();
        if let Some((matrix, turns)) = &self.gyroscopic {
            damping += matrix * if *turns { omega } else { 1.0 };
        }
        damping
    }

    /// The largest amplitude along a direction in the range, without contacts.
    fn without_contact(&self, along: &DVector<f64>) -> f64 {
        let complex = |m: &DMatrix<f64>| m.map(|x| Complex::new(x, 0.0));
        let mut largest = 0.0_f64;
        for place in 0..LOOKED_AT {
            let part = place as f64 / (LOOKED_AT - 1) as f64;
            let omega = self.range[0] + part * (self.range[1] - self.range[0]);
            let damping = self.damping_at(omega);
            let mut sum = 0.0;
            for load in &self.loads {
                let s = f64::from(load.harmonic) * omega;
                let matrix = complex(&(&self.stiffness - s * s * &self.mass))
                    + complex(&damping) * Complex::new(0.0, s);
                let [cosine, sine] = self.force(load, omega);
                let force = cosine.zip_map(&sine, |c, s| Complex::new(c, -s));
                if let Some(response) = matrix.lu().solve(&force) {
                    let terms = along.iter().zip(response.iter());
                    sum += terms.map(|(a, x)| x * *a).sum::<Complex<f64>>().norm();
                }
            }
            largest = largest.max(sum);
        }
        largest
    }

    /// The compliance along a direction, where nothing holds it that of a slow motion.
    fn compliance(&self, along: &DVector<f64>) -> f64 {
        let shift = if self.rigid > 0 { 1.0 } else { 0.0 };
        let held = &self.stiffness + shift * &self.mass;
        let response = held.lu().solve(along).expect("held");
        along.dot(&response)
    }

    fn touch(&mut self) {
        let count = (1 + self.random.below(self.size().min(4))).max(self.rigid);
        for place in 0..count {
            let holds = self.rigid > 0 && self.held && place < self.rigid;
            self.contact(place, holds);
        }
        if self.held && (self.rigid > 0 || self.random.once_in(3)) {
            // Weight.
            let n = self.size();
            let along = &self.contacts[0].gap;
            let sign = if along.sum() < 0.0 { -1.0 } else { 1.0 };
            let direction = DVector::from_element(n, sign);
            let weight = self.mass.row_sum().transpose().dot(&direction).abs();
            let amount = self.random.between(0.05, 0.6) / self.compliance(along);
            self.loads.push(DrawnLoad {
                kind: LoadKind::Acceleration,
                direction,
                harmonic: 0,
                phase: 0.0,
                amplitude: amount / weight,
            });
        }
    }

    /// A contact, which holds what is free to move along it if it must.
    fn contact(&mut self, place: usize, holds: bool) {
        let n = self.size();
        let gap = if holds {
            // At both ends of what may move and turn.
            let mut at = DVector::zeros(n);
            at[if place == 0 { n - self.rigid } else { 0 }] = 1.0;
            at
        } else if self.held {
            self.direction()
        } else {
            // Between two places, which no shift of the whole changes.
            let (a, b) = (self.random.below(n), self.random.below(n));
            let mut apart = DVector::zeros(n);
            apart[a] = 1.0;
            apart[if a == b { (a + 1) % n } else { b }] = -1.0;
            apart
        };
        let moves = self.without_contact(&gap).max(1e-3);
        let stiffness = self.random.magnitude(0.3, 30.0) / self.compliance(&gap);
        let law = self.law(holds, stiffness, moves);
        let random = &mut self.random;
        let offset = match (law, random.below(5)) {
            (Law::Play { .. }, 0..3) => 0.0,
            (Law::Play { .. }, _) => moves * random.between(-0.3, 0.3),
            (_, 0) => 0.0,
            (_, 1) => -moves * random.between(0.05, 0.6),
            _ => moves * random.between(0.1, 0.9),
        };
        let mut force = gap.clone();
        if !holds && self.held && random.once_in(15) {
            // A lever between.
            force *= random.between(0.6, 1.4);
        }
        self.contacts.push(DrawnContact {
            law,
            gap,
            force,
            offset,
        });
    }

    /// The law of a contact where a spring would have this stiffness and the structure moves so much without it.
    fn law(&mut self, holds: bool, stiffness: f64, moves: f64) -> Law {
        let from = self.range[0];
        let random = &mut self.random;
        // A power has the force of such a spring at a third of the motion.
        let at = 0.3 * moves;
        match if holds { 3 } else { random.below(8) } {
            0 | 1 => Law::Stop { k: stiffness },
            2 => Law::Power {
                k: stiffness * at.powf(-0.5),
                alpha: 1.5,
            },
            3 => Law::Play {
                k: stiffness,
                half: moves * random.between(0.1, 0.6),
            },
            4 => Law::Damped {
                k: stiffness,
                c: stiffness * random.magnitude(0.003, 0.1) / from,
            },
            5 => Law::Lossy {
                k: stiffness * at.powf(-0.5),
                c: random.between(0.05, 0.5) / moves,
            },
            _ => {
                let alpha = random.between(0.7, 3.0);
                Law::Power {
                    k: stiffness * at.powf(1.0 - alpha),
                    alpha,
                }
            }
        }
    }

    /// As the library takes it. The first output is the tip; others follow.
    pub fn of_library(&self) -> SparseStructure {
        let mut structure = SparseStructure::new(sparse(&self.mass), sparse(&self.stiffness))
            .damping(self.damped_as.clone());
        if let Some((matrix, turns)) = &self.gyroscopic {
            let one = Value::from(1.0);
            structure = structure.gyroscopic(Gyroscopic {
                matrix: sparse(matrix),
                speed: if *turns { one.times_omega(1) } else { one },
            });
        }
        for load in &self.loads {
            let direction = along(&load.direction);
            let load = Load::new(load.kind, direction, load.amplitude)
                .harmonic(load.harmonic)
                .phase(load.phase);
            structure = structure.load(load);
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let (law, arguments) = contact.law.of_library();
            let mut of = SparseContact::new(&format!("contact{index}"), law, along(&contact.gap))
                .arguments(arguments)
                .offset(contact.offset);
            if contact.force != contact.gap {
                of = of.force_direction(along(&contact.force));
            }
            structure = structure.contact(of);
        }
        structure.output("tip", along(&self.tip))
    }

    /// What it is, in a few lines.
    pub fn text(&self) -> String {
        let n = self.size();
        let mut text = format!(
            "{n} coordinates, {} rigid, held {}, range {:?}\n",
            self.rigid, self.held, self.range
        );
        let few = &self.frequencies[..n.min(6)];
        let _ = writeln!(
            text,
            "  frequencies {few:.4?} .. {:.3}",
            self.frequencies[n - 1]
        );
        let damping = match &self.damped_as {
            Damping::Matrix(matrix) => format!("matrix of {} entries", matrix.triplets().count()),
            other => format!("{other:?}"),
        };
        let _ = writeln!(
            text,
            "  damping {damping}, gyroscopic {}",
            self.gyroscopic.is_some()
        );
        for load in &self.loads {
            let _ = writeln!(
                text,
                "  {:?} of {:.4}, harmonic {}",
                load.kind, load.amplitude, load.harmonic
            );
        }
        for contact in &self.contacts {
            let at: Vec<_> = contact
                .gap
                .iter()
                .enumerate()
                .filter(|(_, x)| **x != 0.0)
                .collect();
            let _ = writeln!(
                text,
                "  {:?} along {at:?}, offset {:.4}",
                contact.law, contact.offset
            );
        }
        text
    }
}
