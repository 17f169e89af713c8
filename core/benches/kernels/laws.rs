//! The laws that are measured, and what is asked of them.

use hertzian::law;
use hertzian::law::Law;

use super::dual::Sides;

/// What is asked of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// The force alone.
    Force,
    /// Force, by gap, by rate.
    Derivatives,
    /// The same and by one argument.
    ByArgument(usize),
}

impl Call {
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::Derivatives => "force, by gap, by rate",
            Self::ByArgument(_) => "the same and by an argument",
        }
    }
}

/// A law to be measured.
pub struct Subject {
    pub name: &'static str,
    pub law: &'static dyn Law,
    pub arguments: &'static [f64],
    /// The argument that derivatives are taken by.
    pub argument: usize,
    /// The call for which others compete.
    pub compared: Call,
    /// What others compute, if it is a power of the gap with linear damping.
    pub sides: Option<Sides>,
}

impl Subject {
    /// Everything that is asked of it.
    pub fn calls(&self) -> [Call; 3] {
        [
            Call::Force,
            Call::Derivatives,
            Call::ByArgument(self.argument),
        ]
    }
}

pub static SUBJECTS: [Subject; 5] = [
    Subject {
        name: "continuous, 3/2",
        law: &Continuous,
        arguments: &[0.032],
        argument: 0,
        compared: Call::Derivatives,
        sides: Some(Sides::Both),
    },
    Subject {
        name: "one-sided, 3/2",
        law: &OneSided,
        arguments: &[0.032],
        argument: 0,
        compared: Call::Derivatives,
        sides: Some(Sides::One),
    },
    Subject {
        name: "continuous, alpha",
        law: &ContinuousPower,
        arguments: &[0.032, 1.7],
        argument: 1,
        compared: Call::ByArgument(1),
        sides: Some(Sides::Both),
    },
    Subject {
        name: "one-sided, alpha",
        law: &OneSidedPower,
        arguments: &[0.032, 1.7],
        argument: 1,
        compared: Call::ByArgument(1),
        sides: Some(Sides::One),
    },
    Subject {
        name: "backlash",
        law: &Backlash,
        arguments: &[0.3],
        argument: 0,
        compared: Call::Derivatives,
        sides: None,
    },
];

law! {
    /// A spring of exponent 3/2 of either sign, with damping.
    pub Continuous(gap, zeta) {
        gap > 0 => 2*zeta*dot(gap) + gap^1.5,
        else    => 2*zeta*dot(gap) - (-gap)^1.5,
    }
}

law! {
    /// Hertz contact with damping: nothing without penetration.
    pub OneSided(gap, zeta) {
        gap > 0 => 2*zeta*dot(gap) + gap^1.5,
        else    => 0,
    }
}

law! {
    /// As `Continuous`, the exponent an argument.
    pub ContinuousPower(gap, zeta, alpha > 0) {
        gap > 0 => 2*zeta*dot(gap) + gap^alpha,
        else    => 2*zeta*dot(gap) - (-gap)^alpha,
    }
}

law! {
    /// As `OneSided`, the exponent an argument.
    pub OneSidedPower(gap, zeta, alpha > 0) {
        gap > 0 => 2*zeta*dot(gap) + gap^alpha,
        else    => 0,
    }
}

law! {
    /// Backlash: no force within the play.
    pub Backlash(gap, play > 0) {
        gap > play  => gap - play,
        gap < -play => gap + play,
        else        => 0,
    }
}
