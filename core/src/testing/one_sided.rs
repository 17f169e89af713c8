//! The paper's oscillator with the exponent one, of which much is known exactly.

crate::oscillator! {
    /// Wang et al. (2021), Eq. (1), one-sided, exponent one.
    pub(crate) OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// normal load
        param load;
        /// excitation amplitude
        param drive;

        /// gap > 0 is penetration
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }

        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// With the damping and the load of the paper.
pub(crate) const fn one_sided(drive: f64) -> OneSided {
    OneSided {
        zeta: 0.032,
        load: 1.0,
        drive,
    }
}
