//! A branch that is vertical: at a parametric resonance orbits of any size have one frequency as long as all that is met is linear.

use hertzian::{EventKind, FrequencyResponse, Shooting, Side, Stop};

hertzian::oscillator! {
    /// Deformation of the mesh of two gears under load, which is now stiffer and now softer, and whose teeth part.
    Mesh(x) {
        param play = 0.05 > 0;
        law teeth(gap) { gap > play => gap - play, -play <= gap <= play => 0, gap < -play => gap + play }
        2/3*ddot(x) + dot(x) + 200*(1 + 0.2*cos(omega*t))*teeth(x) = 2;
    }
}

/// At the doubling of the motion with teeth that meet always. The orbits grow there until teeth part, from where on the branch goes to lower
/// frequencies, as a softening one does: it never turns.
#[test]
fn a_doubling_of_a_linear_stretch_has_no_folds() {
    let mesh = Mesh { play: 0.05 };
    let request = FrequencyResponse::of(&mesh).from(32.0).to(34.5);
    let branch = request.clone().doublings(true).run().unwrap();
    let doubling = branch.events(EventKind::PeriodDoubling).next().unwrap();
    let by_balance = branch.switch(doubling, Side::One).unwrap();
    let by_shooting = request.by(Shooting::new()).switch(doubling, Side::One);
    for branch in [by_balance, by_shooting.unwrap()] {
        assert_eq!(
            (branch.stopped, &branch.turns[..]),
            (Stop::LeftAtStart, &[][..])
        );
        assert_eq!(branch.folds().next(), None);
        let vertical = branch.points.iter();
        let vertical: Vec<_> = vertical
            .take_while(|point| (point.value - doubling.point.value).abs() < 1e-9)
            .collect();
        assert!(vertical.len() > 10, "{}", vertical.len());
        let least = "x:min".parse().unwrap();
        for point in &vertical[..vertical.len() - 1] {
            let least = branch.measured(&least, point).unwrap().unwrap();
            assert!(least > mesh.play, "{least}");
        }
        let rest = &branch.points[vertical.len()..];
        assert!(rest.windows(2).all(|pair| pair[1].value < pair[0].value));
    }
}
