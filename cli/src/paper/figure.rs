//! What a figure is, and what comes of it.

use hertzian::Cancel;

/// As many times the stated error is allowed.
const MARGIN: f64 = 3.0;
/// Allowed where no error is stated, relative, and absolute below one.
const ROUNDING: f64 = 1e-11;

/// A figure or table of the paper.
pub struct Figure {
    /// Name of its files, and of the option `--only`.
    pub id: &'static str,
    /// Its number in the paper.
    pub name: &'static str,
    /// The system and its parameters.
    pub parameters: &'static str,
    /// What it shows, in a sentence.
    pub shows: &'static str,
    /// Whether it takes seconds.
    pub long: bool,
    /// Computes and draws it.
    pub draw: fn(&Task<'_>) -> Result<Drawing, String>,
}

impl Figure {
    /// Title of its picture: what is said of the parameters stays on the page.
    pub fn title(&self) -> String {
        let parameters = self.parameters.split(';').next().unwrap_or_default();
        format!("{}: {parameters}", self.name)
    }
}

/// What a figure is computed with.
pub struct Task<'t> {
    /// The figure.
    pub figure: &'t Figure,
    /// Ends the computation when it is set.
    pub cancel: &'t Cancel,
}

/// What came of a figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// The picture.
    pub svg: String,
    /// Names of the columns of its data, and the rows.
    pub data: Table,
    /// Values to compare.
    pub values: Vec<Value>,
    /// What is to be said of the differences.
    pub note: String,
}

/// Names of columns, and rows.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Rows with as many entries.
    pub rows: Vec<Vec<String>>,
}

/// A number of ours beside the exact one and the one that the paper prints.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// What it is.
    pub what: String,
    /// Ours, unless there is none.
    pub ours: Option<f64>,
    /// Error that our program states.
    pub stated: Option<f64>,
    /// The exact value, unless it is not known, or there is none.
    pub exact: Option<f64>,
    /// Standard error of the exact value, where that is a mean.
    pub uncertain: f64,
    /// What the paper prints.
    pub printed: Option<&'static str>,
}

impl Value {
    /// A value of ours.
    pub fn of(what: impl Into<String>, ours: f64) -> Self {
        Self {
            what: what.into(),
            ours: Some(ours),
            stated: None,
            exact: None,
            uncertain: 0.0,
            printed: None,
        }
    }

    /// A value that should be there, and is not.
    pub fn missing(what: impl Into<String>, exact: f64) -> Self {
        Self {
            what: what.into(),
            ours: None,
            stated: None,
            exact: Some(exact),
            uncertain: 0.0,
            printed: None,
        }
    }

    /// With the error that the program states.
    #[must_use]
    pub fn stated(mut self, error: f64) -> Self {
        self.stated = Some(error);
        self
    }

    /// With the exact value, if it is known.
    #[must_use]
    pub fn exact(mut self, value: Option<f64>) -> Self {
        self.exact = value;
        self
    }

    /// With the standard error of the exact value.
    #[must_use]
    pub fn uncertain(mut self, error: f64) -> Self {
        self.uncertain = error;
        self
    }

    /// With what the paper prints.
    #[must_use]
    pub fn printed(mut self, text: &'static str) -> Self {
        self.printed = Some(text);
        self
    }

    /// Difference of ours from the exact value.
    pub fn error(&self) -> Option<f64> {
        Some((self.ours? - self.exact?).abs())
    }

    /// What is wrong with it: it is not there, or differs from the exact value by more than three times the errors of both. Where
    /// none is stated, ours is computed as exactly as numbers are kept.
    pub fn fault(&self) -> Option<String> {
        let what = &self.what;
        let Some(ours) = self.ours else {
            return Some(format!("{what}: not found"));
        };
        let (exact, error) = (self.exact?, self.error()?);
        let rounding = ROUNDING * exact.abs().max(1.0);
        let errors = self.stated.unwrap_or(0.0).hypot(self.uncertain);
        let allowed = (MARGIN * errors).max(rounding);
        // An error that is not a number is too large too.
        let holds = error <= allowed;
        (!holds).then(|| {
            format!("{what}: {ours} instead of {exact}, and {allowed:.0e} is the largest difference that is explained")
        })
    }
}
