//! The ways from an orbit to its multipliers: one trait, and their names.

use nalgebra::Complex;

use super::hill::Hill;
use super::koopman_hill::KoopmanHill;
use super::monodromy::Monodromy;
use super::orbit::Orbit;

/// A way from an orbit to its multipliers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "Family", into = "Family"))]
#[non_exhaustive]
pub enum Method {
    /// The monodromy matrix with as few steps as the verdict needs, which measurements show to be the cheapest: see
    /// [`stability`](super).
    #[default]
    Default,
    /// The monodromy matrix, integrated from switch to switch: the authority.
    Monodromy,
    /// Eigenvalues of the Hill matrix: those whose eigenvectors have their weighted mean closest to the middle, but none that is a shifted copy
    /// of another. Nothing is found where the matrix would be of an order above 4000: twice as many rows as coordinates, for
    /// the mean and each cosine and sine of the orbit, which is corrected with twice its harmonics.
    Hill,
    /// Of the same eigenvalues those with the smallest imaginary part by size. Two real negative multipliers can come out as one of them
    /// twice.
    HillImaginaryPart,
    /// Of the same eigenvalues those whose eigenvectors have their weighted mean closest to the middle (Guillot et al. 2020), copies or not.
    HillWeightedMean,
    /// An exponential of the Hill matrix, with the same limit; the solution is read off it from its mean.
    KoopmanHill,
    /// The same, read off from all harmonics and those of half the frequency: twice the cost, and squared error where the orbit is smooth.
    KoopmanHillSubharmonic,
}

/// The same, with what methods have in common: so they are written to files too.
#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
enum Family {
    Default,
    Monodromy,
    Hill(Sorting),
    KoopmanHill(Projection),
}

/// Which eigenvalues of the Hill matrix are taken for Floquet exponents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(super) enum Sorting {
    /// Those with the smallest imaginary part by size. Two real negative multipliers can come out as one of them twice.
    ImaginaryPart,
    /// Those whose eigenvectors have their weighted mean closest to the middle (Guillot et al. 2020).
    WeightedMean,
    /// The same, but none that is a shifted copy of another.
    Symmetry,
}

/// How the solution is read off the exponential of the Hill matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub(super) enum Projection {
    /// From its mean.
    Direct,
    /// From all harmonics and those of half the frequency: twice the cost, and squared error where the orbit is smooth.
    Subharmonic,
}

/// A method with what it is in files, its name, and what computes it.
struct Row {
    method: Method,
    #[cfg_attr(
        not(feature = "serde"),
        expect(dead_code, reason = "files are a feature")
    )]
    family: Family,
    name: &'static str,
    engine: fn() -> Box<dyn Floquet>,
}

/// All methods, each named here once; the first is the default.
#[rustfmt::skip]
const ROWS: &[Row] = &[
    row(Method::Default, Family::Default, "default", || Box::new(Monodromy::new(false))),
    row(Method::Monodromy, Family::Monodromy, "monodromy", || Box::new(Monodromy::new(true))),
    row(Method::Hill, Family::Hill(Sorting::Symmetry), "hill", || Box::new(Hill::new(Sorting::Symmetry))),
    row(Method::HillImaginaryPart, Family::Hill(Sorting::ImaginaryPart), "hill-imaginary-part", || Box::new(Hill::new(Sorting::ImaginaryPart))),
    row(Method::HillWeightedMean, Family::Hill(Sorting::WeightedMean), "hill-weighted-mean", || Box::new(Hill::new(Sorting::WeightedMean))),
    row(Method::KoopmanHill, Family::KoopmanHill(Projection::Direct), "koopman-hill", || Box::new(KoopmanHill::new(Projection::Direct))),
    row(Method::KoopmanHillSubharmonic, Family::KoopmanHill(Projection::Subharmonic), "koopman-hill-subharmonic", || Box::new(KoopmanHill::new(Projection::Subharmonic))),
];

const fn row(
    method: Method,
    family: Family,
    name: &'static str,
    engine: fn() -> Box<dyn Floquet>,
) -> Row {
    Row {
        method,
        family,
        name,
        engine,
    }
}

impl Method {
    /// Without a row of its own that of the default; `method_tests` looks for this.
    fn row(self) -> &'static Row {
        let own = ROWS.iter().find(|row| row.method == self);
        own.unwrap_or(&ROWS[0])
    }

    /// What computes it.
    pub(crate) fn engine(self) -> Box<dyn Floquet> {
        (self.row().engine)()
    }
}

#[cfg(feature = "serde")]
impl From<Method> for Family {
    fn from(method: Method) -> Self {
        method.row().family
    }
}

#[cfg(feature = "serde")]
impl From<Family> for Method {
    fn from(family: Family) -> Self {
        let own = ROWS.iter().find(|row| row.family == family);
        own.unwrap_or(&ROWS[0]).method
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.row().name)
    }
}

/// What multipliers cost.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Cost {
    /// Evaluations of the derivatives of a contact's force at one instant.
    pub(crate) slopes: usize,
    /// Contacts whose slopes were made into Fourier coefficients.
    pub(crate) contacts: usize,
    /// Exponentials of a matrix.
    pub(crate) exponentials: usize,
    /// Matrices whose eigenvalues were computed.
    pub(crate) spectra: usize,
    /// Order of the largest matrix among these.
    pub(crate) order: usize,
}

// Counts of a continuation (`Statistics`) and of motions in time (`Work`) are summed alike: other counts.
impl std::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.slopes += other.slopes;
        self.contacts += other.contacts;
        self.exponentials += other.exponentials;
        self.spectra += other.spectra;
        self.order = self.order.max(other.order);
    }
}

/// Multipliers of an orbit as it is, whatever its own error.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// Largest modulus first; empty if nothing is known.
    pub(crate) multipliers: Vec<Complex<f64>>,
    /// Estimated error of the method.
    pub(crate) error: f64,
    /// A bound on the error of the monodromy matrix, where there is one.
    pub(crate) bound: Option<f64>,
    /// The monodromy matrix, column by column; empty if the method has none.
    pub(crate) matrix: Vec<f64>,
}

impl Found {
    /// Nothing is known.
    pub(crate) const NOTHING: Self = Self {
        multipliers: Vec::new(),
        error: f64::INFINITY,
        bound: None,
        matrix: Vec::new(),
    };
}

/// Computes multipliers of one orbit after the other, and keeps its workspace.
pub(crate) trait Floquet: std::fmt::Debug {
    /// Multipliers of an orbit. An error below `aim` is of no use to the caller.
    fn multipliers(&mut self, orbit: &Orbit<'_>, aim: f64) -> Found;

    /// Whether the error of what is [found](Found) is all that the method leaves. Otherwise it shows only when the orbit is given
    /// more harmonics.
    fn knows_its_error(&self) -> bool;

    /// Whether the law changes between the nodes of the last orbit where they do not see it: then nothing is known of it.
    fn overlooks(&self) -> bool {
        false
    }

    /// What it takes over from one orbit to the next, as a number.
    fn pace(&self) -> f64 {
        0.0
    }

    /// As after an orbit that left this. What cannot be is left out.
    fn keep_pace(&mut self, pace: f64) {
        let _ = pace;
    }

    /// The work done so far.
    fn cost(&self) -> Cost;
}
