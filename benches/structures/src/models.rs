//! The structures that are timed.

use std::f64::consts::{PI, SQRT_2, TAU};
use std::sync::Arc;

use hertzian::structure::{Contact, DMatrix, Structure, Turn, parameter};
use hertzian::{Error, law::Law};
use hertzian_structure::{
    Damping, Direction, Load, LoadKind, MatrixError, SparseContact, SparseMatrix, SparseStructure,
};

hertzian::law! {
    /// An elastic stop.
    pub Elastic(gap, k >= 0) { gap > 0 => k*gap, else => 0 }
}

hertzian::law! {
    /// A ball on a plane.
    pub Hertz(gap, k >= 0) { gap > 0 => k*gap^1.5, else => 0 }
}

hertzian::oscillator! {
    /// A shaft in shear, 25 masses in two planes, held by a spring at one end and by a bearing of eight balls at the other.
    ///
    /// The balls go round with `omega`. Its mass and its stiffness over the whole length are one, and its damping is that of the bearing of Sunnersjo (1978) beside a part of
    /// the stiffness, so that it has a ratio in every mode.
    pub Rotor(x[25], y[25]) {
        param load = 1;
        param inner = 0.002;
        let n = 25;
        let cage = omega*t;
        law ball(gap) { gap > 0 => gap^1.5, else => 0 }

        ddot(x[0])/n + 0.05*dot(x[0])/n + n*(x[0] - x[1]) + inner*n*(dot(x[0]) - dot(x[1])) + for j in 0..8 {
            cos(cage + pi/4*j)*ball(x[0]*cos(cage + pi/4*j) + y[0]*sin(cage + pi/4*j) - 0.1)
        } = load;
        ddot(y[0])/n + 0.05*dot(y[0])/n + n*(y[0] - y[1]) + inner*n*(dot(y[0]) - dot(y[1])) + for j in 0..8 {
            sin(cage + pi/4*j)*ball(x[0]*cos(cage + pi/4*j) + y[0]*sin(cage + pi/4*j) - 0.1)
        } = 0;
        for j in 1..24 {
            ddot(x[j])/n + 0.05*dot(x[j])/n + n*(2*x[j] - x[j-1] - x[j+1]) + inner*n*(2*dot(x[j]) - dot(x[j-1]) - dot(x[j+1])) = 0;
            ddot(y[j])/n + 0.05*dot(y[j])/n + n*(2*y[j] - y[j-1] - y[j+1]) + inner*n*(2*dot(y[j]) - dot(y[j-1]) - dot(y[j+1])) = 0;
        }
        ddot(x[24])/n + 0.05*dot(x[24])/n + n*(2*x[24] - x[23]) + inner*n*(2*dot(x[24]) - dot(x[23])) = 0;
        ddot(y[24])/n + 0.05*dot(y[24])/n + n*(2*y[24] - y[23]) + inner*n*(2*dot(y[24]) - dot(y[23])) = 0;
    }
}

/// A structure of which nothing but its modes is known: their frequencies and what a unit force at its tip does to each.
pub struct Modes {
    frequencies: Vec<f64>,
    tip: Vec<f64>,
    drive: f64,
    distance: f64,
}

impl Modes {
    /// A bar of unit length, mass and stiffness, clamped at one end.
    pub fn bar(count: usize) -> Self {
        Self {
            frequencies: (0..count).map(|r| (r as f64 + 0.5) * PI).collect(),
            tip: (0..count).map(|r| SQRT_2 * alternating(r)).collect(),
            drive: 0.05,
            distance: 1.0,
        }
    }

    /// A cantilever of unit length, mass and bending stiffness. Beyond the fourth mode the roots of its equation are odd multiples of a right
    /// angle to rounding.
    pub fn cantilever(count: usize) -> Self {
        let known = [
            1.875_104_068_711_961,
            4.694_091_132_974_175,
            7.854_757_438_237_613,
            10.995_540_734_875_467,
        ];
        let root = |r: usize| known.get(r).copied().unwrap_or((r as f64 + 0.5) * PI);
        Self {
            frequencies: (0..count).map(|r| root(r).powi(2)).collect(),
            tip: (0..count).map(|r| 2.0 * alternating(r)).collect(),
            drive: 0.03,
            distance: 0.1,
        }
    }

    /// With a damping ratio of one per cent in each mode, a harmonic force at the tip and a stop there.
    pub fn stopped(&self, law: impl Law + 'static, k: f64) -> Result<Structure, Error> {
        let n = self.frequencies.len();
        let diagonal = |of: &dyn Fn(f64) -> f64| {
            DMatrix::from_fn(
                n,
                n,
                |i, j| {
                    if i == j { of(self.frequencies[i]) } else { 0.0 }
                },
            )
        };
        let mut structure = Structure::of(
            &DMatrix::identity(n, n),
            &diagonal(&|w| 0.02 * w),
            &diagonal(&|w| w * w),
        );
        for (mode, factor) in self.tip.iter().enumerate() {
            let drive = parameter("drive", self.drive).times(*factor);
            structure = structure.cosine(mode, 1, drive);
        }
        let stop = Contact::new(law)
            .arguments([parameter("k", k)])
            .direction(self.tip.clone())
            .offset(parameter("distance", self.distance));
        structure
            .contact(stop)
            .output("tip", self.tip.clone())
            .build()
    }

    /// The same as matrices, to be reduced to what the excitation needs.
    ///
    /// # Errors
    /// None of what is made here: those of a sparse matrix.
    pub fn sparse(&self, law: impl Law + 'static, k: f64) -> Result<SparseStructure, MatrixError> {
        let n = self.frequencies.len();
        let diagonal = |of: &dyn Fn(f64) -> f64| {
            let entries = self.frequencies.iter().enumerate();
            SparseMatrix::from_triplets(n, n, entries.map(|(i, w)| (i, i, of(*w))))
        };
        let tip = Direction::weighted(self.tip.iter().copied().enumerate());
        let stop = SparseContact::new("stop", Arc::new(law), tip.clone());
        Ok(
            SparseStructure::new(diagonal(&|_| 1.0)?, diagonal(&|w| w * w)?)
                .damping(Damping::ratio(0.01))
                .load(Load::force(tip.clone(), self.drive))
                .contact(stop.arguments([k]).offset(self.distance))
                .output("tip", tip),
        )
    }
}

/// Tips move one way in one mode and the other way in the next.
fn alternating(mode: usize) -> f64 {
    if mode.is_multiple_of(2) { 1.0 } else { -1.0 }
}

/// A chain of unit masses and springs, free at the first and clamped beyond the last one, which is driven: the first so many meet an elastic stop
/// each.
pub fn chain(masses: usize, stops: usize) -> Result<Structure, Error> {
    let stiffness = DMatrix::from_fn(masses, masses, |i, j| match i.abs_diff(j) {
        0 if i == 0 => 1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    });
    let mut structure = Structure::of(
        &DMatrix::identity(masses, masses),
        &(0.03 * &stiffness),
        &stiffness,
    )
    .cosine(masses - 1, 1, parameter("drive", 0.1));
    for mass in 0..stops {
        let mut direction = vec![0.0; masses];
        direction[mass] = 1.0;
        let stop = Contact::new(Elastic)
            .arguments([parameter("k", 100.0)])
            .direction(direction)
            .offset(parameter("distance", 1.0));
        structure = structure.contact(stop);
    }
    structure.build()
}

/// The shaft of [`Rotor`] from its matrices, so many masses in each of two planes, by all of its modes, on contacts that turn: every
/// mode moves every ball.
pub fn shaft(masses: usize) -> Result<SparseStructure, Box<dyn std::error::Error>> {
    let n = masses as f64;
    let matrix = |entries: Vec<(usize, usize, f64)>| {
        let planes = [0, masses].into_iter();
        let both = planes.flat_map(|by| entries.iter().map(move |(i, j, x)| (i + by, j + by, *x)));
        SparseMatrix::from_triplets(2 * masses, 2 * masses, both)
    };
    let mass = (0..masses).map(|i| (i, i, 1.0 / n)).collect();
    let stiffness = (0..masses).flat_map(|i| {
        let own = if i == 0 { n } else { 2.0 * n };
        let beside = (i > 0).then(|| [(i, i - 1, -n), (i - 1, i, -n)]);
        beside.into_iter().flatten().chain([(i, i, own)])
    });
    let shaft = SparseStructure::new(matrix(mass)?, matrix(stiffness.collect())?);
    let shaft = shaft.damping(Damping::Rayleigh {
        mass: 0.05,
        stiffness: 0.002,
    });
    let weight = Load::new(LoadKind::Force, Direction::at(0), 1.0).harmonic(0);
    let shaft = shaft.load(weight).output("down", Direction::at(0));
    Ok((0..8).fold(shaft, |shaft, ball| {
        let turn = Turn::by(1, 1).from(TAU / 8.0 * f64::from(ball));
        let hertz = Arc::new(Hertz);
        let ball = SparseContact::new(&format!("ball{ball}"), hertz, Direction::at(0));
        let ball = ball.arguments([1.0]).offset(0.1);
        shaft.contact(ball.turning(Direction::at(masses), turn))
    }))
}
