//! The macros where the crate is not called `hertzian`: in a package that renames it, and in one that has it from that one.

use std::f64::consts::PI;

/// Amplitude of `ddot(x) + 2 zeta dot(x) + x = drive cos(omega t)`.
fn amplitude(zeta: f64, drive: f64, omega: f64) -> f64 {
    drive / (1.0 - omega * omega).hypot(2.0 * zeta * omega)
}

#[test]
fn a_renamed_dependency_declares_models() {
    let found = hertzian_renamed::amplitude(0.1, 0.3, 0.8);
    let expected = amplitude(0.1, 0.3, 0.8);
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    assert_eq!(hertzian_renamed::force(3.0, 2.0), 12.0);
}

#[test]
fn a_re_exporting_package_passes_the_macros_on() {
    let found = hertzian_through::amplitude(0.2, 0.5, 1.3);
    let expected = amplitude(0.2, 0.5, 1.3);
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    // The integral of gap^1.5 from 0 to 4 is 64/5.
    let steps = 1000;
    let force = |k: usize| hertzian_through::force(4.0 * (k as f64 + 0.5) / steps as f64);
    let work = (0..steps).map(force).sum::<f64>() * 4.0 / steps as f64;
    assert!((work - 12.8).abs() < 1e-4, "{work}");
    assert_eq!(hertzian_through::force(-PI), 0.0);
}
