//! Exact values, computed independently of this project: event-located DOP853 in 80-bit arithmetic, errors in omega
//! below 1e-12, confirmed by a second integrator.
#![allow(
    clippy::unreadable_literal,
    reason = "numbers as they were published, to be searched for"
)]

/// A fold.
#[derive(Debug, Clone, Copy)]
pub struct Exact {
    pub omega: f64,
    pub peak_to_peak: f64,
}

/// Continuous, alpha 1.5, zeta 0.01, drive 0.1, no load; omega from 0.6 to 1.7.
pub const FIGURE_2A: [Exact; 2] = [
    Exact {
        omega: 0.909513715044238,
        peak_to_peak: 0.73119729640989,
    },
    Exact {
        omega: 1.332696002393464,
        peak_to_peak: 7.58758050982389,
    },
];

/// The same with load 1; omega from 0.7 to 1.7.
pub const FIGURE_4A_LOAD_1: [Exact; 4] = [
    Exact {
        omega: 1.09502860674539,
        peak_to_peak: 2.51105266160399,
    },
    Exact {
        omega: 1.136461722203842,
        peak_to_peak: 1.3720908015233,
    },
    Exact {
        omega: 1.158212487926707,
        peak_to_peak: 2.79711894879371,
    },
    Exact {
        omega: 1.337227934760159,
        peak_to_peak: 7.54601168339949,
    },
];

/// The same with load 5; omega from 1 to 2.2.
pub const FIGURE_4A_LOAD_5: [Exact; 2] = [
    Exact {
        omega: 1.484450028723123,
        peak_to_peak: 6.61956624711188,
    },
    Exact {
        omega: 1.56555114602055,
        peak_to_peak: 2.52464397380281,
    },
];

/// Figure 2a below its main resonance; omega from 0.2 to 0.7, orbits with odd symmetry.
pub const FIGURE_2A_BELOW: [Exact; 2] = [
    Exact {
        omega: 0.241956653790653,
        peak_to_peak: 0.82516070425166,
    },
    Exact {
        omega: 0.252011071022547,
        peak_to_peak: 0.74770373992845,
    },
];

/// As 2a with alpha 0.6; omega from 0.66 to 1.4.
pub const FIGURE_2B: [Exact; 2] = [
    Exact {
        omega: 0.704927892945083,
        peak_to_peak: 13.95841092159222,
    },
    Exact {
        omega: 1.320305358301798,
        peak_to_peak: 0.16810907816816,
    },
];

/// The same; omega from 0.37 to 0.66, orbits with odd symmetry. There is another pair of folds, see `FIGURE_2B_UNLISTED`.
pub const FIGURE_2B_BELOW: [Exact; 6] = [
    Exact {
        omega: 0.396401365447262,
        peak_to_peak: 0.08912386642737,
    },
    Exact {
        omega: 0.400955186850763,
        peak_to_peak: 0.07834108073471,
    },
    Exact {
        omega: 0.401353864568085,
        peak_to_peak: 0.08501365087996,
    },
    Exact {
        omega: 0.457909272249307,
        peak_to_peak: 0.052470322683,
    },
    Exact {
        omega: 0.600295303778675,
        peak_to_peak: 0.16365127739608,
    },
    Exact {
        omega: 0.655311078341127,
        peak_to_peak: 0.08855353862405,
    },
];

/// One-sided, alpha 1, zeta 0.032, drive 0.1, load 1; omega from 0.6 to 1.4.
pub const FIGURE_5A: [Exact; 2] = [
    Exact {
        omega: 0.715119549676419,
        peak_to_peak: 6.57285386554094,
    },
    Exact {
        omega: 0.96016367187857,
        peak_to_peak: 2.03840168022514,
    },
];

/// The same with alpha 1.5; omega from 0.6 to 1.6.
pub const FIGURE_5B: [Exact; 2] = [
    Exact {
        omega: 0.685842253572486,
        peak_to_peak: 8.49925607475378,
    },
    Exact {
        omega: 1.144516913788162,
        peak_to_peak: 1.42840466595153,
    },
];

/// The same with alpha 0.6; omega from 0.5 to 1.2.
pub const FIGURE_5C: [Exact; 4] = [
    Exact {
        omega: 0.631308249440869,
        peak_to_peak: 6.70995724971599,
    },
    Exact {
        omega: 0.765568492941199,
        peak_to_peak: 2.5062453564083,
    },
    Exact {
        omega: 0.845526217725541,
        peak_to_peak: 2.04759428540706,
    },
    Exact {
        omega: 0.849176252131873,
        peak_to_peak: 2.2597031710872,
    },
];

/// The larger folds of Fig. 5a in omega at 5, 10, 20, 40 and 80 harmonics, from an independent harmonic balance with contact
/// forces integrated exactly (Galerkin's equations), to nine digits.
pub const FIGURE_5A_GALERKIN: [(usize, f64); 5] = [
    (5, 0.713765891),
    (10, 0.714851667),
    (20, 0.715089581),
    (40, 0.715115544),
    (80, 0.715119029),
];

/// Folds in drive of orbits of period two: one-sided, alpha 1, zeta 0.032, load 1, omega 1. From the closed-form flow between
/// switches, in 60-digit arithmetic.
pub const PERIOD_2_FOLDS: [f64; 2] = [0.2945288061872165, 2.009554757004068];

/// Folds of Fig. 2b that the exact values do not list: a sweep with longer steps than they are apart passes over both. By
/// this project, at 120 harmonics; the orbits in between are confirmed by direct integration.
pub const FIGURE_2B_UNLISTED: [f64; 2] = [0.6394528, 0.6401352];

/// Where orbits with odd symmetry lose it, in Fig. 2a below its main resonance.
pub const FIGURE_2A_BREAKS: [f64; 2] = [0.353730954670214, 0.402310407656194];

/// The same in Fig. 2b, above its folds.
pub const FIGURE_2B_BREAKS: [f64; 2] = [0.868864958044575, 0.973916250536018];
