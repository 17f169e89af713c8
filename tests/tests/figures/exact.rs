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
