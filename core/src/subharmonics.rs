//! Orbits of several excitation periods, and whether a shorter period would do.

/// Least share of the mean square that the harmonics of a longer period must have. Samples of a force that jumps disturb a
/// simple orbit a little; that is not a longer period.
const SUBHARMONIC_SHARE: f64 = 1e-4;

/// Whether no divisor of the period is a period of the orbit: for every prime divisor some harmonic is no multiple of it.
/// The last of the extended unknowns is no harmonic; each coordinate has a series of the length.
pub(crate) fn has_shortest_period(u: &[f64], length: usize, period: usize) -> bool {
    let n = u.len() - 1;
    let square = |counts: &dyn Fn(usize) -> bool| -> f64 {
        let counted = (0..n).filter(|i| counts((i % length).div_ceil(2)));
        counted.map(|i| u[i] * u[i]).sum()
    };
    let total = square(&|k| k > 0);
    primes(period).all(|prime| square(&|k| !k.is_multiple_of(prime)) > SUBHARMONIC_SHARE * total)
}

/// The prime divisors of a period.
fn primes(period: usize) -> impl Iterator<Item = usize> {
    (2..=period).filter(move |p| period.is_multiple_of(*p) && (2..*p).all(|q| !p.is_multiple_of(q)))
}
