//! Requests and results own the system: they can be returned, kept, and sent to other threads.

use std::sync::Arc;
use std::thread;

use hertzian::attractors::basin::{Basin, Basins};
use hertzian::backbone::{FreeOscillation, PhaseResonance};
use hertzian::bifurcation::Diagram;
use hertzian::shooting::BifurcationCurve;
use hertzian::structure::Structure;
use hertzian::time::affine::Affine;
use hertzian::time::stroboscope::Stroboscope;
use hertzian::time::{Flow, FlowError, Integrated};
use hertzian::{Bifurcations, Branch, Error, Event, FrequencyResponse, Point, Shooting, System};

hertzian::oscillator! {
    Linear(x) {
        param zeta in 0.0..;
        param drive;
        ddot(x) + 2*zeta*dot(x) + x = drive*cos(omega*t);
    }
}

const ZETA: f64 = 0.1;
const OMEGA: f64 = 0.8;

/// Twice `drive / |1 - omega^2 + 2 i zeta omega|`.
fn exact(drive: f64) -> f64 {
    2.0 * drive / (1.0 - OMEGA * OMEGA).hypot(2.0 * ZETA * OMEGA)
}

fn is_near(point: &Point, drive: f64) -> bool {
    (point.peak_to_peak() / exact(drive) - 1.0).abs() < 1e-9
}

fn request(drive: f64) -> FrequencyResponse {
    let model = Linear { zeta: ZETA, drive };
    FrequencyResponse::of(&model).from(0.5).to(1.5).harmonics(3)
}

fn branch(drive: f64) -> Result<Branch, Error> {
    request(drive).run()
}

#[test]
fn everything_computed_can_be_kept_and_sent() {
    fn is<T: Send + Sync + 'static>() {}
    is::<FrequencyResponse>();
    is::<Branch>();
    is::<Point>();
    is::<Event>();
    is::<FrequencyResponse<Shooting>>();
    is::<BifurcationCurve>();
    is::<Bifurcations>();
    is::<Diagram>();
    is::<FreeOscillation>();
    is::<PhaseResonance>();
    is::<Basin>();
    is::<Basins>();
    is::<Structure>();
    is::<Box<dyn System>>();
    is::<Error>();
}

#[test]
fn motions_can_be_kept_and_sent() {
    fn is<T: Send + 'static>() {}
    is::<Box<dyn Flow>>();
    is::<Stroboscope>();
    is::<Affine>();
    is::<Integrated>();
    let map = || {
        let model = Linear {
            zeta: ZETA,
            drive: 0.3,
        };
        Stroboscope::of(&model, OMEGA)
    };
    let mut map = map().expect("it is sound");
    let settled = thread::spawn(move || {
        let mut state = [0.0; 2];
        (0..100).try_for_each(|_| map.map(&mut state))?;
        Ok::<_, FlowError>(state)
    });
    let [x, velocity] = settled.join().expect("no panic").expect("a motion");
    assert!((2.0 * x.hypot(velocity / OMEGA) / exact(0.3) - 1.0).abs() < 1e-9);
}

#[test]
fn a_branch_outlives_its_model_and_is_asked_in_another_thread() {
    let branch = branch(0.3).expect("it runs");
    let system = branch.system().expect("it was computed");
    assert_eq!(system.facts().name, "Linear");
    let at = thread::spawn(move || branch.at(OMEGA)).join();
    let points = at.expect("no panic").expect("it was passed");
    assert!(matches!(&points[..], [point] if is_near(point, 0.3)));
}

#[test]
fn values_are_those_of_the_moment() {
    let mut model = Linear {
        zeta: ZETA,
        drive: 0.3,
    };
    let (response, shooting) = (
        FrequencyResponse::of(&model),
        FrequencyResponse::of(&model).by(Shooting::new()),
    );
    let interpreted = model.generic();
    model.drive = 0.5;
    assert!(is_near(&response.orbit(OMEGA).expect("it runs"), 0.3));
    let point = shooting.orbit(OMEGA).expect("it runs");
    assert_eq!(point.parameters, [ZETA, 0.3]);
    let interpreted = FrequencyResponse::of(&interpreted).orbit(OMEGA);
    assert!(is_near(&interpreted.expect("it runs"), 0.3));
    let later = FrequencyResponse::of(&model).orbit(OMEGA);
    assert!(is_near(&later.expect("it runs"), 0.5));
}

#[test]
fn a_shared_system_is_not_copied_again() {
    let shared = Linear {
        zeta: ZETA,
        drive: 0.3,
    }
    .shared();
    let point = FrequencyResponse::of(&shared).orbit(OMEGA);
    assert!(is_near(&point.expect("it runs"), 0.3));
    assert!(Arc::ptr_eq(&shared, &System::shared(&shared)));
}
