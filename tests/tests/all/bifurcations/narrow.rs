//! Smooth laws that change within a distance far smaller than a step: what the branch does there is found, by either method and in
//! either direction.

use hertzian::{Branch, Event, EventKind, FrequencyResponse, Shooting, System};

hertzian::oscillator! {
    /// Beside a linear oscillator, a spring that pushes on within a width `w` of a place `c`, as a quotient.
    Quotient(x, y) {
        param p;
        param a;
        param w > 0;
        param c;
        law push(gap) { gap/(1 + gap^2/w^2) }
        ddot(x) + 0.1*dot(x) + 4*x = 0.2*cos(omega*t);
        ddot(y) + 2*dot(y) + y - a*push(y - c) = p + 0.000001*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The same with a hyperbolic tangent.
    Saturating(x, y) {
        param p;
        param a;
        param w > 0;
        param c;
        law push(gap) { w*tanh(gap/w) }
        ddot(x) + 0.1*dot(x) + 4*x = 0.2*cos(omega*t);
        ddot(y) + 2*dot(y) + y - a*push(y - c) = p + 0.000001*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The same with a bump of the force, of a height `a w`.
    Bump(x, y) {
        param p;
        param a;
        param w > 0;
        param c;
        law push(gap) { w*exp(-(gap/w)^2) }
        ddot(x) + 0.1*dot(x) + 4*x = 0.2*cos(omega*t);
        ddot(y) + 2*dot(y) + y - a*push(y - c) = p + 0.000001*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// The same with a logistic function.
    Logistic(x, y) {
        param p;
        param a;
        param w > 0;
        param c;
        law push(gap) { w/(1 + exp(-gap/w)) }
        ddot(x) + 0.1*dot(x) + 4*x = 0.2*cos(omega*t);
        ddot(y) + 2*dot(y) + y - a*push(y - c) = p + 0.000001*cos(omega*t);
    }
}

hertzian::oscillator! {
    /// An oscillator whose upper turning point passes a narrow spring.
    Passing(x) {
        law narrow(gap) { 0.104725*gap/0.000358/(1 + (gap/0.000358)^2) }
        1.39*ddot(x) + 0.179*dot(x) + 1.844*x + narrow(x - 0.5813) = 0.275*cos(omega*t) + 0.386;
    }
}

/// Branches by both methods, in both directions, with all events.
fn branches(request: &FrequencyResponse, range: [f64; 2]) -> Vec<Branch> {
    let mut found = Vec::new();
    for [from, to] in [range, [range[1], range[0]]] {
        let request = request.clone().from(from).to(to);
        found.push(request.clone().bifurcations(true).run().unwrap());
        found.push(request.by(Shooting::new()).run().unwrap());
    }
    found
}

/// In the order of their values.
fn sorted(branch: &Branch) -> Vec<&Event> {
    let mut events: Vec<&Event> = branch.events.iter().collect();
    events.sort_by(|a, b| a.point.value.total_cmp(&b.point.value));
    events
}

/// The events are two folds at these loads.
fn assert_two_folds<M: System>(model: &M, mut known: [f64; 2]) {
    known.sort_by(f64::total_cmp);
    let request = FrequencyResponse::of(model).vary("p").omega(1.0);
    for branch in branches(&request, [0.0, 1.0]) {
        let events = sorted(&branch);
        let kinds: Vec<EventKind> = events.iter().map(|event| event.kind).collect();
        assert_eq!(
            kinds,
            [EventKind::Fold; 2],
            "{known:?} {:?} {:?}",
            branch.events,
            branch.turns
        );
        for (event, known) in events.into_iter().zip(known) {
            let error = (event.point.value - known).abs();
            // The drive of the spring moves the folds by the square of its 1e-6, in units of the width.
            assert!(
                error <= event.error + 1e-9 && error < 1e-8,
                "{event} {known} {error:.1e}"
            );
        }
    }
}

/// Two folds at `z = w x`, with the load `c + z - a w f(x)` and `1 = a f'(x)`.
fn loads(a: f64, w: f64, c: f64, at: [f64; 2], f: impl Fn(f64) -> f64) -> [f64; 2] {
    at.map(|x| c + w * (x - a * f(x)))
}

/// Widths, and places.
const NARROW: [(f64, f64); 2] = [(3e-3, 0.534_954), (3e-4, 0.31)];

#[test]
fn folds_of_a_quotient() {
    let a = 1.3_f64;
    // f' = (1 - s)/(1 + s)^2, s = x^2: s^2 + (2 + a) s + 1 - a = 0
    let s = 0.5 * ((a + 2.0).powi(2) + 4.0 * (a - 1.0)).sqrt() - 0.5 * (a + 2.0);
    for (w, c) in NARROW {
        let known = loads(a, w, c, [-s.sqrt(), s.sqrt()], |x| x / (1.0 + x * x));
        assert_two_folds(&Quotient { p: 0.5, a, w, c }, known);
    }
}

#[test]
fn folds_of_a_hyperbolic_tangent() {
    let a = 1.3_f64;
    // f' = 1/cosh^2 x
    let x = a.sqrt().acosh();
    for (w, c) in NARROW {
        let known = loads(a, w, c, [-x, x], f64::tanh);
        assert_two_folds(&Saturating { p: 0.5, a, w, c }, known);
    }
}

#[test]
fn folds_of_a_bump() {
    let a = 1.3_f64;
    // f' = -2 x exp(-x^2), on either side of its largest value
    let slope = |x: f64| -2.0 * a * x * (-x * x).exp() - 1.0;
    let root = |mut low: f64, mut high: f64| {
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(low) * slope(middle) <= 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    };
    let top = -0.5_f64.sqrt();
    let at = [root(-3.0, top), root(top, 0.0)];
    for (w, c) in NARROW {
        let known = loads(a, w, c, at, |x| (-x * x).exp());
        assert_two_folds(&Bump { p: 0.5, a, w, c }, known);
    }
}

#[test]
fn folds_of_a_logistic_function() {
    let a = 5.2_f64;
    // f' = 1/(4 cosh^2 (x/2))
    let x = 2.0 * (0.25 * a).sqrt().acosh();
    for (w, c) in NARROW {
        let known = loads(a, w, c, [-x, x], |x| 1.0 / (1.0 + (-x).exp()));
        assert_two_folds(&Logistic { p: 0.5, a, w, c }, known);
    }
}

/// The steps are a hundred widths long where the turning point comes to the place. Short steps are the reference.
#[test]
fn folds_of_a_turning_point() {
    let model = Passing {};
    let request = FrequencyResponse::of(&model);
    let short = request.clone().by(Shooting::new()).from(1.345).to(1.355);
    let short = short.largest_step(5e-3).run().unwrap();
    let known = sorted(&short);
    assert_eq!(known.len(), 2, "{:?}", short.events);
    for branch in branches(&request, [1.3, 1.9]) {
        let events = sorted(&branch);
        let kinds: Vec<EventKind> = events.iter().map(|event| event.kind).collect();
        assert_eq!(
            kinds,
            [EventKind::Fold; 2],
            "{:?} {:?}",
            branch.events,
            branch.turns
        );
        for (event, known) in events.into_iter().zip(&known) {
            let apart = (event.point.value - known.point.value).abs();
            assert!(apart <= event.error + known.error, "{event} {known}");
            assert!(event.error < 1e-5, "{event}");
        }
    }
}
