//! What a computation by the contact equation works with: checked, and the same for all orbits of a branch.

use super::equations::setting::Setting;
use super::skeleton::placement::Resolution;
use crate::shooting::problem::ShootingProblem;

/// Nodes of a stretch and panels of a whole period, coarser ones first.
pub(super) const RESOLUTIONS: [Resolution; 10] = [
    resolution(8, 1),
    resolution(12, 1),
    resolution(16, 1),
    resolution(20, 1),
    resolution(24, 2),
    resolution(32, 2),
    resolution(32, 4),
    resolution(32, 8),
    resolution(32, 16),
    resolution(32, 32),
];
/// The one that a branch begins with.
pub(super) const FIRST: usize = 2;

const fn resolution(nodes: usize, panels: usize) -> Resolution {
    Resolution { nodes, panels }
}

/// The system, what is varied, and how.
pub(crate) struct ContactProblem {
    pub(super) setting: Setting,
    /// What was asked for, in the time domain.
    pub(crate) asked: ShootingProblem,
    /// Asked of peak-to-peak.
    pub(super) tolerance: f64,
}

impl ContactProblem {
    /// Of what was asked for.
    pub(crate) fn new(asked: ShootingProblem, tolerance: f64) -> Self {
        let setting = Setting::new(
            &asked.system,
            asked.variable,
            asked.parameters.clone(),
            asked.omega,
            &asked.cancel,
        );
        Self {
            setting,
            asked,
            tolerance,
        }
    }
}
