//! A branch goes on the way it went where its equations change and the step before has been looked at.

use crate::{ContactEquation, EventKind, FrequencyResponse, Shooting, Stop};

crate::oscillator! {
    /// Beside a stop that moves, of which the pieces of the motion come to lie otherwise: the unknowns at 76006 are half as many.
    MovingStop(x) {
        param m = 2.050277680436693;
        param k = 14256045001.05976;
        param width = 0.27191692296502296 > 0;
        law stop(gap) { gap > 0 => 7510630327.778269*(gap/width)^2.3502710127559525, else => 0 }
        m*ddot(x) + 63455.007894972296*dot(x) + k*x - stop(0.1210904347500238 - x - 0.1070421505497526*sin(2*omega*t))
            = 8460102743.041043*cos(omega*t);
    }
}

/// It turned back there, and back again, in motions that are stable all along, and said one fold of them.
#[test]
fn no_fold_is_said_where_nothing_but_equations_change() {
    let model = MovingStop::default();
    let request = FrequencyResponse::of(&model)
        .from(60_882.573_789_884_2)
        .to(77_996.500_127_711_53);
    for branch in [
        request.clone().by(ContactEquation::new()).run().unwrap(),
        request.by(Shooting::new()).run().unwrap(),
    ] {
        assert_eq!(branch.stopped, Stop::ReachedEnd);
        assert_eq!(branch.turns, []);
        let events = branch.events.iter().map(|event| event.kind);
        let events: Vec<_> = events.collect();
        assert_eq!(events, [EventKind::Grazing { turns: false }]);
        assert!(branch.points.is_sorted_by(|a, b| a.value < b.value));
    }
}
