//! What is asked of a branch is the same for both methods, and so is what it answers.

use hertzian::bifurcation::DiagramBranch;
use hertzian::{
    Bifurcations, Branch, EventKind, FrequencyResponse, HarmonicBalance, Method, OrbitMethod,
    RequestError, Shooting, Side, Stop,
};
use proptest::prelude::*;

hertzian::oscillator! {
    /// A loaded contact spring.
    OneSided(x) {
        param load;
        param drive;
        law contact(gap) { gap > 0 => 0.064*dot(gap) + gap, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

const MODEL: OneSided = OneSided {
    load: 1.0,
    drive: 0.1,
};
/// The first doubling of the drive at frequency one, of Wang et al. (2021), figure 8: to all digits.
const DOUBLING: f64 = 1.282_584_167_663_768;

fn over_frequency() -> FrequencyResponse {
    FrequencyResponse::of(&MODEL).from(0.6).to(1.6)
}

fn over_drive() -> FrequencyResponse {
    FrequencyResponse::of(&MODEL)
        .vary("drive")
        .omega(1.0)
        .from(1.0)
        .to(1.4)
}

/// Everything that a branch answers.
fn answers<M: OrbitMethod>(request: &FrequencyResponse<M>) -> Branch {
    let branch = request.run().expect("a branch");
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    assert_eq!((branch.period(), branch.folds().count()), (1, 2));
    assert_eq!(branch.to_csv().lines().count(), branch.points.len() + 1);
    assert!(branch.chart().to_svg().contains("peak-to-peak of x"));
    assert_eq!(
        branch.model.equation,
        branch.system().expect("it was computed").facts().equation
    );
    let [a, b] = [0, 1].map(|index| branch.folds().nth(index).expect("two").point.value);
    let between = branch.at(0.5 * (a + b)).expect("orbits");
    assert_eq!(between.len(), 3);
    for point in &between {
        let whole = branch.complete(point).expect("a motion");
        let (mean, rms) = (whole.motion().mean, whole.motion().rms);
        assert!(mean.expect("it is read off").abs() <= rms.expect("it is read off"));
        assert_eq!(whole.observed.contacts.len(), 1);
        assert!((whole.peak_to_peak() - point.peak_to_peak()).abs() < 1e-12);
        let largest = branch
            .multipliers(point, Method::default())
            .expect("they are known");
        let stated = largest.stability.error + point.stability.error;
        let [x, y] = [&largest.stability, &point.stability].map(|s| s.multipliers[0].norm());
        assert!((x - y).abs() <= stated, "{x} {y} {stated:e}");
    }
    branch
}

#[test]
fn a_branch_answers_alike_by_both_methods() {
    let by_balance = answers(&over_frequency());
    let by_shooting = answers(&over_frequency().by(Shooting::new()));
    for (a, b) in by_balance.folds().zip(by_shooting.folds()) {
        let error = (a.point.value - b.point.value).abs();
        assert!(error <= a.error + b.error, "{a} {b}");
        // A curve in two parameters goes on from either, and is the same one.
        let curves = [(&by_balance, a), (&by_shooting, b)]
            .map(|(branch, event)| branch.track(event, "drive", [0.05, 0.15]).expect("a curve"));
        let ends = curves.map(|curve| *curve.values.last().expect("points"));
        assert!((ends[0][0] - ends[1][0]).abs() < 1e-8, "{ends:?}");
    }
}

/// What begins at a doubling, of the same method and of the other one.
#[test]
fn events_of_one_method_are_taken_by_the_other() {
    let balance = HarmonicBalance::new().harmonics(20).doublings(true);
    let balance = over_drive().by(balance);
    let shooting = over_drive().by(Shooting::new());
    let branches = [balance.run(), shooting.run()].map(|branch| branch.expect("a branch"));
    let doublings = branches.each_ref().map(|branch| {
        let mut events = branch.events(EventKind::PeriodDoubling);
        events.next().expect("it doubles")
    });
    assert!((doublings[0].point.value - DOUBLING).abs() < 1e-4);
    assert!((doublings[1].point.value - DOUBLING).abs() < 1e-11);
    for event in doublings {
        let longer = [
            balance.switch(event, Side::One),
            shooting.switch(event, Side::One),
        ];
        for branch in longer.map(|branch| branch.expect("a branch begins there")) {
            assert_eq!(branch.period(), 2);
            assert!((branch.points[0].value - DOUBLING).abs() < 0.01);
        }
    }
    for (branch, event) in branches.iter().zip(doublings) {
        assert_eq!(
            branch.switch(event, Side::One).expect("a branch").period(),
            2
        );
    }
}

#[test]
fn a_branch_through_a_value_goes_both_ways() {
    let check = |branch: Branch| {
        assert_eq!(branch.begin, Some(Stop::ReachedEnd));
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        let ends = [branch.points.first(), branch.points.last()];
        assert_eq!(ends.map(|point| point.expect("points").value), [0.6, 1.6]);
        assert_eq!(branch.folds().count(), 2);
    };
    check(over_frequency().through(1.2).expect("a branch"));
    check(
        over_frequency()
            .by(Shooting::new())
            .through(1.2)
            .expect("a branch"),
    );
}

/// The branch of twice the period at a doubling.
#[test]
fn diagrams_are_made_by_both_methods() {
    let request = Bifurcations::of(&MODEL)
        .vary("drive")
        .omega(1.0)
        .from(1.0)
        .to(1.4);
    let by_shooting = request.clone().depth(1).run().expect("a diagram");
    let balance = HarmonicBalance::new().harmonics(20);
    let by_balance = request.by(balance).depth(1).run().expect("a diagram");
    for diagram in [by_shooting, by_balance] {
        let branches = diagram.branches.iter();
        let periods: Vec<_> = branches.map(DiagramBranch::period).collect();
        assert_eq!(periods, [1, 2]);
    }
}

#[test]
fn a_model_is_attached_to_its_own_branches_only() {
    let mut branch = over_frequency().run().expect("a branch");
    branch.attach(&MODEL).expect("it is its own");
    let heavier = OneSided { load: 1.1, ..MODEL };
    let error = branch.attach(&heavier).expect_err("another load");
    assert!(
        matches!(error.downcast_ref(), Some(RequestError::Parameter { name, .. }) if name == "load")
    );
    hertzian::oscillator! {
        Other(x) { param drive; ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t); }
    }
    let error = branch
        .attach(&Other { drive: 0.1 })
        .expect_err("another model");
    assert!(matches!(
        error.downcast_ref(),
        Some(RequestError::OtherModel { .. })
    ));
}

/// An orbit by shooting is a guess for the balance at another value, and an event of another system is refused.
#[test]
fn what_one_method_found_is_checked_by_the_other() {
    let shooting = over_drive().by(Shooting::new());
    let orbit = shooting.orbit(1.1).expect("an orbit").orbit;
    let near = over_drive().near_orbit(&orbit);
    let there = near.orbit(1.15).expect("an orbit");
    let exact = shooting.orbit(1.15).expect("an orbit");
    assert!((there.peak_to_peak() / exact.peak_to_peak() - 1.0).abs() < 1e-5);
    let branch = shooting.run().expect("a branch");
    let doubling = branch.events(EventKind::PeriodDoubling).next();
    let doubling = doubling.expect("it doubles");
    let heavier = OneSided { load: 1.1, ..MODEL };
    let heavier = FrequencyResponse::of(&heavier).vary("drive").omega(1.0);
    let error = heavier.from(1.0).to(1.4).switch(doubling, Side::One);
    let error = error.expect_err("another load");
    let named = |name: &str| name == "load";
    assert!(
        matches!(error.downcast_ref(), Some(RequestError::Parameter { name, .. }) if named(name)),
        "{error}"
    );
}

hertzian::oscillator! {
    /// Two wells.
    Wells(x) {
        param drive;
        ddot(x) + 0.3*dot(x) - x + x^3 = drive*cos(omega*t);
    }
}

/// The balance that judges an orbit in one of two wells has all harmonics.
#[test]
fn multipliers_of_an_orbit_without_the_symmetry_of_its_system() {
    let model = Wells { drive: 0.05 };
    let request = FrequencyResponse::of(&model).by(Shooting::new());
    let request = request.near_state(&[1.0, 0.0]).from(1.0).to(1.1);
    let branch = request.run().expect("a branch");
    let point = &branch.points[0];
    assert!(point.motion().minimum > 0.5);
    let answer = branch.multipliers(point, Method::default());
    let found = answer.expect("they are known").stability;
    let [a, b] = [&found, &point.stability].map(|stability| stability.multipliers[0].norm());
    assert!((a - b).abs() < 1e-6 && found.error < 1e-4, "{a} {b}");
}

type Setter<M> = fn(FrequencyResponse<M>) -> FrequencyResponse<M>;

fn points_in_order<M: OrbitMethod>(
    first: FrequencyResponse<M>,
    setters: &[Setter<M>],
) -> Vec<hertzian::Point> {
    let request = setters.iter().fold(first, |request, set| set(request));
    request.run().expect("a branch").points
}

fn common<M: OrbitMethod>() -> Vec<Setter<M>> {
    vec![
        |request| request.vary("drive"),
        |request| request.omega(1.1),
        |request| request.from(0.05),
        |request| request.to(0.1),
        |request| request.tolerance(1e-5),
        |request| request.period(1),
        |request| request.max_points(3),
        |request| request.largest_step(0.05),
        |request| request.stability(true),
        |request| request.near_state(&[1.0, 0.0]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn the_order_of_calls_does_not_matter(
        (of_balance, of_shooting) in {
            let mut of_balance = common::<HarmonicBalance>();
            of_balance.extend([
                (|request| request.harmonics(7)) as Setter<HarmonicBalance>,
                |request| request.samples(256),
                |request| request.doublings(true),
                |request| request.bifurcations(false),
                |request| request.symmetric(false),
            ]);
            (Just(of_balance).prop_shuffle(), Just(common::<Shooting>()).prop_shuffle())
        }
    ) {
        let first = || FrequencyResponse::of(&MODEL).by(HarmonicBalance::new());
        let mut sorted = common::<HarmonicBalance>();
        sorted.extend([
            (|request| request.harmonics(7)) as Setter<HarmonicBalance>,
            |request| request.samples(256),
            |request| request.doublings(true),
            |request| request.bifurcations(false),
            |request| request.symmetric(false),
        ]);
        prop_assert_eq!(points_in_order(first(), &of_balance), points_in_order(first(), &sorted));
        let first = || first().by(Shooting::new());
        prop_assert_eq!(
            points_in_order(first(), &of_shooting),
            points_in_order(first(), &common::<Shooting>())
        );
    }
}
