//! What a study file says, put together in Rust.

use crate::plan::{Design, Keep, Method, Picture, Request, Shown, Variants, What, Which};
use crate::spread::Spread;

impl Variants {
    fn of(design: Design, count: Option<usize>) -> Self {
        Self {
            design,
            count,
            ..Self::default()
        }
    }

    /// Every value of one parameter with every value of the others.
    pub fn grid() -> Self {
        Self::of(Design::Grid, None)
    }

    /// The rows of a table: see [`Study::table`](crate::Study::table).
    pub(crate) fn list() -> Self {
        Self::of(Design::List, None)
    }

    /// So many variants, with as many parts of every parameter, each met once.
    pub fn latin_hypercube(count: usize) -> Self {
        Self::of(Design::LatinHypercube, Some(count))
    }

    /// So many points of the sequence of Sobol.
    pub fn sobol(count: usize) -> Self {
        Self::of(Design::Sobol, Some(count))
    }

    /// So many variants, independently.
    pub fn random(count: usize) -> Self {
        Self::of(Design::Random, Some(count))
    }

    /// With a parameter that varies.
    #[must_use]
    pub fn over(mut self, parameter: impl Into<String>, spread: Spread) -> Self {
        self.over.insert(parameter.into(), spread);
        self
    }
}

impl Request {
    fn of(what: What, from: f64, to: f64) -> Self {
        Self {
            what,
            from,
            to,
            vary: "omega".to_owned(),
            ..Self::default()
        }
    }

    /// A branch from one end of the range to the other.
    pub fn response(from: f64, to: f64) -> Self {
        Self::of(What::Response, from, to)
    }

    /// That, and all branches that begin on it.
    pub fn bifurcations(from: f64, to: f64) -> Self {
        Self::of(What::Bifurcations, from, to)
    }

    /// Which orbits there are at these values.
    pub fn solutions(from: f64, to: f64, values: &[f64]) -> Self {
        Self {
            at: Some(Spread::list(values)),
            ..Self::of(What::Solutions, from, to)
        }
    }

    /// Varies a parameter along the branches, at this frequency of the excitation.
    #[must_use]
    pub fn vary(mut self, parameter: impl Into<String>, omega: f64) -> Self {
        self.vary = parameter.into();
        self.omega = Some(omega);
        self
    }

    /// By this method.
    #[must_use]
    pub fn by(mut self, method: Method) -> Self {
        self.method = Some(method);
        self
    }

    /// Relative accuracy of peak-to-peak.
    #[must_use]
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    /// Whether multipliers are computed.
    #[must_use]
    pub fn stability(mut self, wanted: bool) -> Self {
        self.stability = Some(wanted);
        self
    }
}

impl Picture {
    /// A map of `stable`, the number of stable orbits, of their `largest` peak-to-peak, or of the `verdict` of all.
    pub fn map(of: &str) -> Self {
        Self {
            what: Shown::Map,
            of: Some(of.to_owned()),
            ..Self::default()
        }
    }

    /// How often the highest or the lowest event of a kind lies where.
    pub fn histogram(kind: &str, which: Which) -> Self {
        Self {
            what: Shown::Histogram,
            kind: Some(kind.to_owned()),
            which,
            ..Self::default()
        }
    }

    /// Quantiles over what varies along the branches.
    pub fn fan() -> Self {
        Self {
            what: Shown::Fan,
            ..Self::default()
        }
    }

    /// Whether what linear propagation of the distributions says is drawn over a histogram.
    #[must_use]
    pub fn linear(mut self, wanted: bool) -> Self {
        self.linear = wanted;
        self
    }

    /// Whether curves of folds and doublings are followed and drawn over a map.
    #[must_use]
    pub fn tracks(mut self, wanted: bool) -> Self {
        self.tracks = wanted;
        self
    }
}

impl Keep {
    /// All events, with peak-to-peak of what leads.
    pub fn new() -> Self {
        Self::default()
    }

    /// Events of these kinds only, by their names.
    #[must_use]
    pub fn events<'k>(mut self, kinds: impl IntoIterator<Item = &'k str>) -> Self {
        self.events = Some(kinds.into_iter().map(str::to_owned).collect());
        self
    }

    /// These signals at every orbit that has a row.
    #[must_use]
    pub fn signals<'k>(mut self, signals: impl IntoIterator<Item = &'k str>) -> Self {
        self.signals = Some(signals.into_iter().map(str::to_owned).collect());
        self
    }

    /// A row where each of these is largest.
    #[must_use]
    pub fn largest<'k>(mut self, signals: impl IntoIterator<Item = &'k str>) -> Self {
        self.largest = signals.into_iter().map(str::to_owned).collect();
        self
    }

    /// How the place of every event moves with every parameter.
    #[must_use]
    pub fn sensitivities(mut self, wanted: bool) -> Self {
        self.sensitivities = wanted;
        self
    }

    /// Rows at these values of what varies.
    #[must_use]
    pub fn at(mut self, values: &[f64]) -> Self {
        self.at = Some(Spread::list(values));
        self
    }
}
