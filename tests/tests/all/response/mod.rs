//! Orbits and curves: the public interface of the runtime, with closed forms, edges, errors and what comes back; and curves against exact
//! values (`figures`), models of the literature (`reference`), shooting (`shooting`), random models (`robust`), and where methods
//! fail (`failures`).

mod bumps;
mod closed_forms;
mod copies;
mod coupled;
mod failures;
mod figures;
mod first_orbits;
mod free;
mod given;
mod left_out;
mod reference;
mod requests;
mod robust;
mod rounds;
mod serialised;
mod shooting;
mod start;
mod values;

pub use hertzian_tests::{Continuous, OneSided};

hertzian::oscillator! {
    /// Nothing but linear terms.
    pub Linear(x) {
        param zeta >= 0;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    pub Duffing(x) {
        param zeta in 0.0..;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x + x^3 = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// Force at twice a third of the frequency: the orbit needs three excitation periods.
    pub Fractional(x) {
        ddot(x) + 0.2*dot(x) + x = cos(2/3*omega*t);
    }
}

hertzian::oscillator! {
    /// A pair of linear oscillators, with a stiffness that pulses at a multiple of the excitation.
    pub Pair(x, y) {
        param mass;
        param pulse;
        mass*ddot(x) + 0.1*dot(x) + (1 + pulse*cos(7*omega*t))*x + 0.2*(x - y) = cos(omega*t);
        ddot(y) + 0.1*dot(y) + y + 0.2*(y - x) = 0;
    }
}

/// A contact under its load, weakly driven.
pub const CONTACT: OneSided = OneSided {
    zeta: 0.032,
    alpha: 1.5,
    load: 1.0,
    drive: 0.1,
};
