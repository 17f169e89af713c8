//! Tests of hertzian across its crates, and what several of them need.

hertzian::oscillator! {
    /// Two masses in a row, the second held to the ground, the first with an elastic stop at distance one.
    /// Stiffness and clearance as in example 03 of NLvib (Krack and Gross 2019); damping is 0.03 of the stiffness matrix.
    pub TwoMasses(x1, x2) {
        /// stiffness of the stop
        param stop > 0;
        /// amplitude
        param drive;
        law stop_spring(gap) { gap > 1 => stop*(gap - 1), else => 0 }
        ddot(x1) + 0.03*(dot(x1) - dot(x2)) + x1 - x2 + stop_spring(x1) = 0;
        ddot(x2) + 0.03*(2*dot(x2) - dot(x1)) + 2*x2 - x1 = drive*cos(omega*t);
    }
}

/// The one whose value is nearest to a wanted one.
pub fn nearest<T>(
    among: impl IntoIterator<Item = T>,
    wanted: f64,
    value: impl Fn(&T) -> f64,
) -> Option<T> {
    let apart = |x: &T| (value(x) - wanted).abs();
    among
        .into_iter()
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
}
