//! Closed branches of orbits of three periods, on which contacts begin and end: each walk round them comes back to where it began.

use crate::{ContactEquation, FrequencyResponse, OrbitMethodKind, Shooting, Stop};

crate::oscillator! {
    /// A round stop at one side.
    RoundStop(x) {
        param drive;
        param k;
        law stop(gap, c) { gap > 0 => c*gap^1.5, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x - 1, k) = drive*cos(omega*t);
    }
}

/// From an orbit that the last step passes while a contact changes in it, and from every fourth one of the same branch by shooting.
#[test]
fn walks_close_where_contacts_change_in_the_last_step() {
    let model = RoundStop { drive: 1.0, k: 4.0 };
    let (value, state) = (
        1.586_652_147_473_762,
        [-0.055_160_408_218_735_274, -0.710_897_019_895_127_3],
    );
    let request = FrequencyResponse::of(&model).period(3).near_state(&state);
    let request = request.from(1.2).to(6.0).max_points(500);
    let shot = request.clone().by(Shooting::new()).through(value).unwrap();
    assert_eq!(shot.stopped, Stop::Closed);
    let others = shot.points.iter().skip(1).step_by(4);
    let others = others.map(|point| (point.value, point.orbit.state()));
    let first = (value, state.to_vec());
    let mut open = Vec::new();
    for (value, state) in std::iter::once(first).chain(others) {
        let request = request.clone().near_state(&state);
        let branch = request.by(ContactEquation::new()).through(value).unwrap();
        assert_eq!(branch.method(), Some(OrbitMethodKind::ContactEquation));
        if (branch.begin, branch.stopped) != (None, Stop::Closed) {
            open.push((value, branch.stopped, branch.points.len()));
        }
    }
    assert_eq!(open, []);
}
