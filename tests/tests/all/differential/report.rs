//! What all models came to: counts, coverage of stated errors, and findings.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// What a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The library panicked.
    Panic,
    /// Stated to be stable or unstable, and it is not.
    FalseVerdict,
    /// No orbit is near one that was found.
    NotClosed,
    /// The orbit near one that was found is farther than an orbit may err.
    Elsewhere,
    /// The error of peak-to-peak is more than three times the one stated.
    PeakToPeak,
    /// Values of one event differ by more than three times the errors stated.
    EventValue,
    /// A number that is none.
    NotFinite,
    /// The text was refused.
    Refused,
    /// No first orbit, though motion from rest settles.
    NoStart,
    /// The verdict changes between neighbours without an event or a turn.
    ChangeWithoutEvent,
    /// Found going one way only.
    OneDirection,
    /// Found by the balance or by shooting only.
    OneMethod,
    /// Found by shooting or by the contact equation only.
    OneEquation,
    /// Found in other units, or not.
    OtherUnits,
    /// Found once, and stated to have no known place: an event of the discrete equations that multipliers contradict.
    Unplaced,
    /// The error of the multipliers is more than three times the one stated; the verdict is right.
    Multipliers,
}

impl Kind {
    /// Whether one of them is a failure, however many models there are. Stated errors have a share.
    pub fn fails(self) -> bool {
        matches!(
            self,
            Self::Panic
                | Self::FalseVerdict
                | Self::NotClosed
                | Self::Elsewhere
                | Self::NotFinite
                | Self::Refused
        )
    }
}

impl Display for Kind {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Panic => "panicked",
            Self::FalseVerdict => "false verdict",
            Self::NotClosed => "no orbit is there",
            Self::Elsewhere => "the true orbit is elsewhere",
            Self::PeakToPeak => "error of peak-to-peak beyond three times the stated one",
            Self::EventValue => "values of an event beyond three times the stated errors",
            Self::NotFinite => "not a number",
            Self::Refused => "text refused",
            Self::NoStart => "no start, though motion from rest settles",
            Self::ChangeWithoutEvent => "change of verdict without an event",
            Self::OneDirection => "event in one direction only",
            Self::OneMethod => "event by one method only",
            Self::OneEquation => "event by shooting or the contact equation only",
            Self::OtherUnits => "another branch in other units",
            Self::Unplaced => "event without a known place, found once",
            Self::Multipliers => "error of multipliers beyond three times the stated one",
        })
    }
}

/// Something to look at, of one model.
#[derive(Debug, Clone)]
pub struct Finding {
    pub kind: Kind,
    pub model: u64,
    pub text: String,
}

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { kind, model, text } = self;
        write!(f, "HERTZIAN_MODEL={model}: {kind}: {text}")
    }
}

/// What one model came to, or several.
#[derive(Debug, Default)]
pub struct Report {
    pub counts: BTreeMap<&'static str, usize>,
    pub findings: Vec<Finding>,
    /// True errors over stated ones: of peak-to-peak, of multipliers, of events between both methods.
    pub ratios: BTreeMap<&'static str, Vec<f64>>,
    /// Declarations and ranges of the models with findings.
    pub texts: BTreeMap<u64, String>,
    /// Seconds of the processor, and the model.
    pub times: Vec<(f64, u64)>,
}

impl Report {
    pub fn count(&mut self, what: &'static str) {
        *self.counts.entry(what).or_default() += 1;
    }

    pub fn ratio(&mut self, of: &'static str, ratio: f64) {
        self.ratios.entry(of).or_default().push(ratio);
    }

    pub fn find(&mut self, kind: Kind, model: u64, text: String) {
        self.findings.push(Finding { kind, model, text });
    }

    pub fn add(&mut self, other: Self) {
        for (what, count) in other.counts {
            *self.counts.entry(what).or_default() += count;
        }
        for (of, ratios) in other.ratios {
            self.ratios.entry(of).or_default().extend(ratios);
        }
        self.findings.extend(other.findings);
        self.texts.extend(other.texts);
        self.times.extend(other.times);
    }

    /// Part of the ratios that are at most this.
    pub fn within(&self, of: &str, factor: f64) -> f64 {
        let Some(ratios) = self.ratios.get(of) else {
            return 1.0;
        };
        let within = ratios.iter().filter(|ratio| **ratio <= factor).count();
        within as f64 / ratios.len() as f64
    }

    pub fn print(&mut self) {
        self.findings
            .sort_by_key(|finding| (finding.kind, finding.model));
        for finding in &self.findings {
            println!("{finding}");
        }
        for text in self.texts.values() {
            println!("{text}");
        }
        for (what, count) in &self.counts {
            println!("{count:7}  {what}");
        }
        for (of, ratios) in &self.ratios {
            let worst = ratios.iter().copied().fold(0.0, f64::max);
            println!(
                "{:7}  {of}: {:.2} % within the stated error, {:.2} % within three times, worst {worst:.1}",
                ratios.len(),
                100.0 * self.within(of, 1.0),
                100.0 * self.within(of, 3.0),
            );
        }
        let mut kinds: BTreeMap<Kind, Vec<u64>> = BTreeMap::new();
        for finding in &self.findings {
            kinds.entry(finding.kind).or_default().push(finding.model);
        }
        for (kind, mut models) in kinds {
            let all = models.len();
            models.dedup();
            println!("{all:7}  {kind}, in {} models: {models:?}", models.len());
        }
        self.times.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total: f64 = self.times.iter().map(|(time, _)| time).sum();
        println!(
            "{} models, {total:.0} s of the processor; the longest: {:.1?}",
            self.times.len(),
            &self.times[..self.times.len().min(5)]
        );
    }
}
