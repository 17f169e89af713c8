//! What a computation cost.

/// Counts of the work done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Statistics {
    /// Evaluations of the residual alone.
    pub residuals: usize,
    /// Evaluations of the residual together with its Jacobian.
    pub jacobians: usize,
    /// Evaluations of the derivative of the residual in one direction, where the Jacobian leaves something out.
    pub derivatives: usize,
    /// Factorisations of a dense matrix.
    pub factorisations: usize,
    /// Continuation steps that gave a point.
    pub accepted_steps: usize,
    /// Continuation steps that were tried again with a smaller length.
    pub rejected_steps: usize,
    /// Floquet multipliers computed, counted by orbit.
    pub monodromies: usize,
}

// Counts of multipliers (`Cost`) and of motions in time (`Work`) are summed alike: other counts, of rooms above.
impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.residuals += other.residuals;
        self.jacobians += other.jacobians;
        self.derivatives += other.derivatives;
        self.factorisations += other.factorisations;
        self.accepted_steps += other.accepted_steps;
        self.rejected_steps += other.rejected_steps;
        self.monodromies += other.monodromies;
    }
}

impl std::fmt::Display for Statistics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} steps accepted, {} rejected; {} Jacobians, {} derivatives, {} residuals, {} factorisations, {} monodromies",
            self.accepted_steps,
            self.rejected_steps,
            self.jacobians,
            self.derivatives,
            self.residuals,
            self.factorisations,
            self.monodromies
        )
    }
}
