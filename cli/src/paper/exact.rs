//! Exact values of the special orbits in the figures.
//!
//! They were computed independently of this project: those of exponent one from the closed-form flow between switches, in
//! 80-bit arithmetic, confirmed with 60 digits; the others by event-located integration of eighth order in 80-bit arithmetic,
//! confirmed by a second integrator. Errors are below 1e-12.
#![allow(
    clippy::unreadable_literal,
    clippy::excessive_precision,
    reason = "numbers as they were computed, to be searched for"
)]

use hertzian::EventKind::{self, Fold, PeriodDoubling, SymmetryBreaking};

/// Special orbits on a curve of a figure: what happens, and at which frequency.
pub fn frequencies(curve: &str) -> &'static [(EventKind, f64)] {
    let found = FREQUENCIES.iter().find(|(name, _)| *name == curve);
    found.map_or(&[], |(_, events)| events)
}

const FREQUENCIES: [(&str, &[(EventKind, f64)]); 9] = [
    (
        "2a",
        &[
            (Fold, 0.909513715044238),
            (Fold, 1.332696002393464),
            (SymmetryBreaking, 0.402310407656194),
            (SymmetryBreaking, 0.353730954670214),
            (Fold, 0.241956653790653),
            (Fold, 0.252011071022547),
            (Fold, 0.382084326345429),
            (Fold, 0.385408321288445),
        ],
    ),
    (
        "2b",
        &[
            (Fold, 0.704927892945083),
            (Fold, 1.320305358301798),
            (SymmetryBreaking, 0.973916250536018),
            (SymmetryBreaking, 0.868864958044575),
            (Fold, 0.600295303778675),
            (Fold, 0.655311078341127),
            (Fold, 0.396401365447262),
            (Fold, 0.401353864568085),
            (Fold, 0.400955186850763),
            (Fold, 0.457909272249307),
            (Fold, 0.902396742342991),
            (Fold, 0.934177569964217),
            (PeriodDoubling, 0.904833344193996),
            (PeriodDoubling, 0.896507260971036),
        ],
    ),
    (
        "2a, primary",
        &[(Fold, 0.909513715044238), (Fold, 1.332696002393464)],
    ),
    (
        "2b, primary",
        &[
            (Fold, 0.704927892945083),
            (Fold, 1.320305358301798),
            (SymmetryBreaking, 0.973916250536018),
            (SymmetryBreaking, 0.868864958044575),
            (Fold, 0.600295303778675),
            (Fold, 0.655311078341127),
        ],
    ),
    (
        "4a, W = 1",
        &[
            (Fold, 1.09502860674539),
            (Fold, 1.136461722203842),
            (Fold, 1.158212487926707),
            (Fold, 1.337227934760159),
        ],
    ),
    (
        "4a, W = 5",
        &[(Fold, 1.484450028723123), (Fold, 1.56555114602055)],
    ),
    ("5a", &[(Fold, 0.715119549676419), (Fold, 0.96016367187857)]),
    (
        "5b",
        &[(Fold, 0.685842253572486), (Fold, 1.144516913788162)],
    ),
    (
        "5c",
        &[
            (Fold, 0.845526217725541),
            (Fold, 0.849176252131873),
            (Fold, 0.631308249440869),
            (Fold, 0.765568492941199),
        ],
    ),
];

/// Bifurcations of the one-sided system of exponent one at frequency one: period, what happens, and at which amplitude.
pub const AMPLITUDES: [(usize, EventKind, f64, &str); 6] = [
    (
        1,
        PeriodDoubling,
        1.282584167663767669,
        "A₁: period 1 doubles",
    ),
    (2, Fold, 0.2945288061872164957, "A₂: period 2 folds, lower"),
    (2, Fold, 2.009554757004067908, "A₃: period 2 folds, upper"),
    (
        2,
        PeriodDoubling,
        1.531044135499983048,
        "A₄: period 2 doubles",
    ),
    (
        2,
        PeriodDoubling,
        1.880077405264828835,
        "A₆: period 2 doubles",
    ),
    (8, Fold, 1.779836025884334200, "A₈: period 8 folds"),
];

/// Orbits of period one, two and three at amplitude and frequency one: displacement at phase zero, peak-to-peak.
pub const COEXISTING: [(usize, f64, f64); 3] = [
    (1, -1.9997761227576426582, 5.065330201056806),
    (2, -5.632060192753840953, 16.34670511780529),
    (3, -31.334287816436888456, 40.70230743287871),
];

/// A column of Table 1: period eight at an amplitude.
pub struct Column {
    /// The amplitude.
    pub drive: f64,
    /// Both multipliers; nothing where there is no orbit.
    pub multipliers: Option<[f64; 2]>,
    /// What the paper prints.
    pub printed: [&'static str; 2],
}

/// Table 1.
pub const TABLE_1: [Column; 4] = [
    Column {
        drive: 1.7798,
        multipliers: Some([0.9902634294356096, 0.18601252117560596]),
        printed: ["0.9920", "0.1857"],
    },
    Column {
        drive: 1.77982,
        multipliers: Some([0.9905639798300239, 0.18579985821399464]),
        printed: ["0.9927", "0.1854"],
    },
    Column {
        drive: 1.779835,
        multipliers: Some([0.99652374785176, 0.18445843299969783]),
        printed: ["0.9991", "0.1839"],
    },
    Column {
        drive: 1.77983603,
        multipliers: None,
        printed: ["1.0020", "0.1833"],
    },
];

/// Largest Lyapunov exponents per period at two amplitudes, with their standard errors.
pub const LYAPUNOV: [Exponent; 2] = [
    Exponent {
        drive: 1.78,
        value: 0.0129,
        error: 0.0005,
    },
    Exponent {
        drive: 1.785,
        value: 0.214,
        error: 0.004,
    },
];

/// The largest Lyapunov exponent per period at an amplitude, with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponent {
    /// Amplitude of the excitation.
    pub drive: f64,
    /// The exponent.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// Frequency of the free vibration of amplitude one without load, for some exponents: the closed form.
pub const BACKBONES: [(f64, f64); 4] = [
    (0.6, 1.040748834943126),
    (1.5, 0.95469356972851),
    (2.0, 0.9146813565019625),
    (3.0, 0.8472130847939791),
];
