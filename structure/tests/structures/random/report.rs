//! What all structures came to: counts, coverage of stated errors, and findings.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

/// What a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The library panicked.
    Panic,
    /// Stated to be stable or unstable, and it is not.
    FalseVerdict,
    /// The same of a reduced structure, with what the reduction changes.
    FalseReduced,
    /// No orbit is near one that was found.
    NotClosed,
    /// The orbit near one that was found is farther than an orbit may err.
    Elsewhere,
    /// Something that was compared is no number.
    NoNumber,
    /// A structure, or a request of it, was refused.
    Refused,
    /// An error of an orbit beyond three times the one stated.
    Orbit,
    /// The same of a reduced structure.
    Reduced,
    /// An error of multipliers beyond three times the one stated.
    Multipliers,
    /// Values of one event differ by more than three times the errors stated.
    EventValue,
    /// An event that one method has and the other has not.
    OneMethod,
    /// The verdict changes between neighbours without an event or a turn.
    ChangeWithoutEvent,
}

impl Kind {
    /// Whether one of them is a failure, however many structures there are. Stated errors have a share.
    pub fn fails(self) -> bool {
        self <= Self::Refused
    }
}

impl Display for Kind {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Panic => "panicked",
            Self::FalseVerdict => "false verdict",
            Self::FalseReduced => "false verdict on the whole structure",
            Self::NotClosed => "no orbit is there",
            Self::Elsewhere => "the true orbit is elsewhere",
            Self::NoNumber => "no number",
            Self::Refused => "refused",
            Self::Orbit => "error of an orbit beyond three times the stated one",
            Self::Reduced => "error of a reduction beyond three times the stated one",
            Self::Multipliers => "error of multipliers beyond three times the stated one",
            Self::EventValue => "values of an event beyond three times the stated errors",
            Self::OneMethod => "event by one method only",
            Self::ChangeWithoutEvent => "change of verdict without an event",
        })
    }
}

/// Something to look at, of one structure.
#[derive(Debug, Clone)]
pub struct Finding {
    pub kind: Kind,
    pub structure: u64,
    pub text: String,
}

impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self {
            kind,
            structure,
            text,
        } = self;
        write!(f, "HERTZIAN_MODEL={structure}: {kind}: {text}")
    }
}

/// What one structure came to, or several.
#[derive(Debug, Default)]
pub struct Report {
    pub counts: BTreeMap<&'static str, usize>,
    pub findings: Vec<Finding>,
    /// True errors over stated ones.
    pub ratios: BTreeMap<&'static str, Vec<f64>>,
    /// Structures with findings.
    pub texts: BTreeMap<u64, String>,
    /// Seconds of the processor, and the structure.
    pub times: Vec<(f64, u64)>,
}

impl Report {
    pub fn count(&mut self, what: &'static str) {
        *self.counts.entry(what).or_default() += 1;
    }

    pub fn ratio(&mut self, of: &'static str, ratio: f64) {
        self.ratios.entry(of).or_default().push(ratio);
    }

    pub fn find(&mut self, kind: Kind, structure: u64, text: String) {
        self.findings.push(Finding {
            kind,
            structure,
            text,
        });
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

    pub fn print(&mut self) {
        self.findings
            .sort_by_key(|finding| (finding.kind, finding.structure));
        for finding in &self.findings {
            println!("{finding}");
        }
        for (index, text) in &self.texts {
            println!("{index}: {text}");
        }
        for (what, count) in &self.counts {
            println!("{count:7}  {what}");
        }
        for (of, ratios) in &self.ratios {
            let worst = ratios.iter().copied().fold(0.0, f64::max);
            let within = |factor: f64| {
                let within = ratios.iter().filter(|ratio| **ratio <= factor).count();
                100.0 * within as f64 / ratios.len() as f64
            };
            println!(
                "{:7}  {of}: {:.2} % within the stated error, {:.2} % within three times, worst {worst:.1}",
                ratios.len(),
                within(1.0),
                within(3.0),
            );
        }
        self.times.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total: f64 = self.times.iter().map(|(time, _)| time).sum();
        println!(
            "{} structures, {total:.0} s of the processor; the longest: {:.1?}",
            self.times.len(),
            &self.times[..self.times.len().min(5)]
        );
    }
}
