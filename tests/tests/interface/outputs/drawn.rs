//! Charts of outputs.

use hertzian::chart::{Frequency, View};

use super::*;

hertzian::oscillator! {
    /// The second mass moves most.
    Pair(first: m, second: m, turn: rad) {
        param m: kg = 1 > 0;
        param k: N/m = 1e9 in 0.0..;
        param c: N*s/m = 1e3 in 0.0..;
        param soft: N/m = 1e6;
        param inertia: N*s^2 = 1 > 0;
        param spring: N = 1;
        param rub: N*s = 1;
        param drive: N = 1;
        m*ddot(first) + c*dot(first) + k*first - soft*second = 0;
        m*ddot(second) + c*dot(second) + soft*(second - first) = drive*cos(omega*t);
        inertia*ddot(turn) + rub*dot(turn) + spring*turn = 0;
    }
}

fn chart(branch: &Branch, view: &View) -> String {
    branch.chart_of(view).expect("a chart").to_svg()
}

#[test]
fn axes_say_what_is_shown_and_in_which_unit() {
    let (branch, _) = at(&Thrown::default(), 0.9);
    let usual = branch.chart().to_svg();
    for part in [
        "peak-to-peak of tooth [mN]",
        "excitation frequency ω [rad/s]",
        "k = 1 N/mm^1.5",
        "load = 1 N",
    ] {
        assert!(usual.contains(part), "{part}");
    }
    let view = View::new().of("shaking:h2".parse().expect("a signal"));
    let other = chart(&branch, &view.frequency(Frequency::Hertz));
    for part in [
        "amplitude of harmonic 2 of shaking (what an accelerometer shows) [mm/s^2]",
        "excitation frequency [Hz]",
    ] {
        assert!(other.contains(part), "{part}");
    }
    let of_contact = View::new().of("ground:impulse".parse().expect("a signal"));
    let impulse = chart(&branch, &of_contact.frequency(Frequency::Rpm));
    assert!(impulse.contains("impulse per period of ground") && impulse.contains("[rpm]"));
    let unknown = View::new().of("tuth".parse().expect("a name"));
    assert!(branch.chart_of(&unknown).is_err());
}

#[test]
fn hertz_are_where_the_orbits_are() {
    let (branch, point) = at(&Isolated::default(), 0.8);
    let size = branch.reading("speed", &point).expect("an output");
    close(Frequency::Hertz.of(TAU), 1.0, 1e-15);
    close(Frequency::Rpm.of(TAU), 60.0, 1e-15);
    assert_eq!(branch.leading().to_string(), "path:p2p");
    let rates = branch
        .points
        .iter()
        .map(|p| p.observed.outputs[1].peak_to_peak());
    assert_eq!(rates.into_iter().next(), Some(size.motion.peak_to_peak()));
}

#[test]
fn the_coordinate_that_moves_most_leads() {
    let (branch, _) = at(&Pair::default(), 900.0);
    assert_eq!(branch.leading().name, "second");
    let svg = branch.chart().to_svg();
    for part in [
        "peak-to-peak of second [um]",
        "k = 1 GN/m",
        "soft = 1 MN/m",
        "c = 1000 N*s/m",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}
