//! Curves of branches for charts of one's own.

use hertzian::FrequencyResponse;

hertzian::oscillator! {
    Linear(x) {
        ddot(x) + 0.1*dot(x) + x = 0.2*cos(omega*t);
    }
}

/// Between its orbits the curve lies nearer to the closed form, `0.4 / |1 - omega^2 + 0.1 i omega|`, than the chords of its orbits do, by
/// their distance across the curve in parts of the chart, which is four high and one wide.
#[test]
fn runs_bend_as_the_closed_form_does() {
    let branch = FrequencyResponse::of(&Linear {}).from(0.5).to(1.5);
    let branch = branch.run().expect("a branch");
    let off = |[omega, size]: [f64; 2]| {
        let (inertia, damping) = (1.0 - omega * omega, 0.1 * omega);
        let modulus = inertia.hypot(damping);
        let exact = 0.4 / modulus;
        // The derivative of the closed form by omega.
        let slope = exact * (2.0 * inertia * omega - 0.1 * damping) / modulus.powi(2);
        (size - exact).abs() / 4.0_f64.hypot(slope)
    };
    let places = branch.points.iter().map(|p| [p.value, p.peak_to_peak()]);
    let places: Vec<[f64; 2]> = places.collect();
    let middles = places
        .windows(2)
        .map(|pair| [0, 1].map(|axis| 0.5 * (pair[0][axis] + pair[1][axis])));
    let chords = middles.map(off).fold(0.0, f64::max);
    let runs = branch.runs();
    let curve = runs.iter().flat_map(|run| run.points.iter().copied());
    let bent = curve.clone().map(off).fold(0.0, f64::max);
    assert!(runs.len() == 1 && curve.count() > places.len());
    assert!(bent < 0.5 * chords, "{bent} {chords}");
    let named = branch.curve("x").expect("a curve");
    assert_eq!(named.runs, runs);
}
