//! A contact that begins where the branch turns back: behind the touch the force grows as a power of 0.54 of the gap, and steps to it lead far away.

use std::ops::ControlFlow;

use hertzian::{
    Branch, ContactEquation, Error, EventKind, FrequencyResponse, HarmonicBalance, OrbitMethod,
    Stop,
};

hertzian::oscillator! {
    /// A mass of 0.14 kg before a stop that is stiff from the first touch on.
    Sticky(x) {
        law stop(gap) {
            gap > 0 => max(0, 2.417884519136738e-7 * (gap / 2.431340793519915e-6)^0.5436245329211427
                * (1 + 19682.53055962297 * dot(gap))),
            else => 0
        }
        0.1384187362299917*ddot(x) + 0.0014223889104881952*dot(x) + 0.38940596966429053*x
            + stop(x - 6.84559353969908e-7)
            = 5.429572736886959e-7*cos(omega*t) + 2.2618618696674215e-7*sin(2/5*omega*t);
    }
}

/// From the beginning of the range to 2.19, behind both turns.
fn by(method: impl OrbitMethod) -> Result<Branch, Error> {
    let request = FrequencyResponse::of(&Sticky {}).from(2.181_422_586_288_869);
    let request = request.to(3.464_186_347_962_882_3).by(method);
    request.run_with(|progress| match progress.value {
        Some(value) if value > 2.19 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    })
}

/// Where the branch turns, with the errors.
fn turns(branch: &Branch) -> Vec<[f64; 2]> {
    let turns = branch.events.iter().filter(|event| {
        matches!(
            event.kind,
            EventKind::Fold | EventKind::Grazing { turns: true }
        )
    });
    turns.map(|turn| [turn.point.value, turn.error]).collect()
}

/// The walk went back from one and the same point for ever, and the balance divided contacts of a gap that is rounding.
#[test]
fn a_branch_that_turns_where_a_contact_begins_is_followed_by_both() -> Result<(), Error> {
    let exact = turns(&by(ContactEquation::new())?);
    let balanced = turns(&by(HarmonicBalance::new())?);
    assert_eq!(
        [exact.len(), balanced.len()],
        [2, 2],
        "{exact:?} {balanced:?}"
    );
    for ([a, stated], [b, other]) in exact.into_iter().zip(balanced) {
        assert!(
            (a - b).abs() < 3.0 * (stated + other),
            "{a} {stated} {b} {other}"
        );
        assert!(stated < 1e-9 && other < 1e-7);
    }
    Ok(())
}

/// In a range that is short, so that steps are, equations of few nodes have orbits behind the touch where there are none.
#[test]
fn no_orbit_that_more_nodes_do_not_have_ends_a_branch() -> Result<(), Error> {
    let request = FrequencyResponse::of(&Sticky {}).from(2.181_422_586_288_869);
    let branch = request.to(2.1872).by(ContactEquation::new()).run()?;
    assert_eq!(branch.stopped, Stop::ReachedEnd);
    Ok(())
}
