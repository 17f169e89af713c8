//! What was measured.

/// How the frequency, or whatever varies, went while a data set was measured: it says which of several stable motions was met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sweep {
    /// It rose: the motion stays on its branch to where that ends, and goes over to another one there.
    Rising,
    /// It fell.
    Falling,
    /// Every value was measured for itself: each may belong to any branch that can be stable.
    #[default]
    Settled,
    /// The branch was followed by control, so that unstable motions were measured as well.
    Controlled,
}

/// Where a sweep left its branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    pub(crate) value: f64,
    pub(crate) deviation: f64,
    pub(crate) is_bound: bool,
}

impl Jump {
    /// The branch ends at this value of what was varied, with this standard deviation.
    pub fn at(value: f64, deviation: f64) -> Self {
        Self {
            value,
            deviation,
            is_bound: false,
        }
    }

    /// The branch goes on to this value at least, in the direction of the sweep: noise and the rate of a sweep make it leave a branch early, and
    /// never late.
    pub fn not_before(value: f64, deviation: f64) -> Self {
        Self {
            is_bound: true,
            ..Self::at(value, deviation)
        }
    }
}

/// Standard deviations of measured values.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Deviations {
    Unknown,
    All(f64),
    Each(Vec<f64>),
}

/// Values that were measured in one go: a sweep at one level of the drive, as a rule.
///
/// ```
/// use hertzian_fit::{DataSet, Jump, Sweep};
///
/// let set = DataSet::new("x:p2p", [0.8, 0.9, 1.0], [1.4, 1.9, 0.6])
///     .named("rising, 0.1 N")
///     .sweep(Sweep::Rising)
///     .deviation(0.02)
///     .at("drive", 0.1)
///     .jump(Jump::at(0.95, 0.05));
/// assert_eq!(set.len(), 3);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DataSet {
    pub(crate) name: String,
    pub(crate) wanted: String,
    pub(crate) varied: String,
    pub(crate) omega: Option<f64>,
    pub(crate) places: Vec<f64>,
    pub(crate) values: Vec<f64>,
    pub(crate) deviations: Deviations,
    pub(crate) place_deviation: Option<f64>,
    pub(crate) sweep: Sweep,
    pub(crate) settings: Vec<(String, f64)>,
    pub(crate) jumps: Vec<Jump>,
}

impl DataSet {
    /// Of what was measured, as [`Wanted`](hertzian::observe::Wanted) is written (`x:p2p`, `tip:rms`, `x:h1`, `x:phase1`), over the excitation
    /// frequency in radians per unit of time. Rates and accelerations are outputs of the model: `output a = ddot(x);`.
    pub fn new(
        wanted: impl Into<String>,
        omegas: impl Into<Vec<f64>>,
        values: impl Into<Vec<f64>>,
    ) -> Self {
        let wanted = wanted.into();
        Self {
            name: wanted.clone(),
            wanted,
            varied: "omega".to_owned(),
            omega: None,
            places: omegas.into(),
            values: values.into(),
            deviations: Deviations::Unknown,
            place_deviation: None,
            sweep: Sweep::default(),
            settings: Vec::new(),
            jumps: Vec::new(),
        }
    }

    /// What it is called; by default what was measured.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// A parameter was varied, and not the frequency, which was `omega`: [`new`](Self::new) has the values of the parameter then.
    #[must_use]
    pub fn varied(mut self, parameter: impl Into<String>, omega: f64) -> Self {
        self.varied = parameter.into();
        self.omega = Some(omega);
        self
    }

    /// The standard deviation of every value, in its unit. Without any, all values of a set count alike, and how far they scatter is
    /// taken from the fit.
    #[must_use]
    pub fn deviation(mut self, deviation: f64) -> Self {
        self.deviations = Deviations::All(deviation);
        self
    }

    /// The standard deviation of each value.
    #[must_use]
    pub fn deviations(mut self, deviations: impl Into<Vec<f64>>) -> Self {
        self.deviations = Deviations::Each(deviations.into());
        self
    }

    /// The standard deviation of the frequency, or of what was varied: distances to the curve are measured across it by both. Default: a
    /// hundredth of the usual step between neighbours.
    #[must_use]
    pub fn place_deviation(mut self, deviation: f64) -> Self {
        self.place_deviation = Some(deviation);
        self
    }

    /// How the frequency went. Default: [`Sweep::Settled`].
    #[must_use]
    pub fn sweep(mut self, sweep: Sweep) -> Self {
        self.sweep = sweep;
        self
    }

    /// The value that a parameter had in this set, such as the level of the drive.
    #[must_use]
    pub fn at(mut self, parameter: impl Into<String>, value: f64) -> Self {
        self.settings.push((parameter.into(), value));
        self
    }

    /// Where the sweep left its branch, as a datum of its own: the fold that ends it.
    #[must_use]
    pub fn jump(mut self, jump: Jump) -> Self {
        self.jumps.push(jump);
        self
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What was measured, as `x:p2p`.
    pub fn wanted(&self) -> &str {
        &self.wanted
    }

    /// What was varied: `omega`, or a parameter.
    pub fn over(&self) -> &str {
        &self.varied
    }

    /// The values of that, in units of the model.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// The measured values, in units of the model.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Number of measured values, jumps apart.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether nothing was measured.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
}
