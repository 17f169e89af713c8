//! About how far coordinates move, from a few phases of the period. Where no error is of coordinates, nothing but units of size and what completes
//! an orbit depends on them: extremes of all modes of a structure, the fastest ones followed as they ring, would take most of the time of a point.

use std::f64::consts::TAU;

use super::motion::Motion;
use super::positions::positions;
use crate::branches::observed::Motion as Extent;

/// Phases in a period of the declaration, each a part of the whole period after the last one that no harmonic or number of parts has in common with them:
/// the golden section.
const PHASES: usize = 48;
const PART: f64 = 0.618_033_988_749_894_8;

/// Smallest and largest values of all coordinates at these phases.
pub(in crate::contact_equation) fn sampled(motion: &Motion<'_>) -> Vec<Extent> {
    let skeleton = &motion.equations.skeleton;
    let coordinates = motion.equations.values.linear.positions.nrows();
    let mut extents = vec![Extent::NONE; coordinates];
    let period = skeleton.recurrence().period;
    let phase = |sample: usize| {
        let part = (PART * sample as f64).fract();
        skeleton.begin + TAU * period as f64 * part
    };
    let phases: Vec<f64> = (0..PHASES * period).map(phase).collect();
    for positions in positions(motion, &phases).chunks_exact(coordinates) {
        for (extent, x) in extents.iter_mut().zip(positions) {
            extent.include(*x);
        }
    }
    extents
}
