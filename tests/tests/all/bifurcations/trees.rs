//! Trees by the contact equation alone: what begins at its events, and what passes an orbit, is followed by it too, and is what shooting finds.

use std::time::Instant;

use hertzian::bifurcation::{Bifurcations, Diagram};
use hertzian::{Branch, ContactEquation, FrequencyResponse, OrbitMethod, Shooting, Stop, System};
use hertzian_tests::OneSidedLinear;

use crate::bifurcations::cascade::MODEL;

fn tree<M: OrbitMethod>(method: M, depth: usize) -> Diagram {
    let request = FrequencyResponse::of(&MODEL).by(method);
    let request = request.vary("drive").omega(1.0).from(0.1).to(2.0);
    Bifurcations::starting_with(request)
        .depth(depth)
        .run()
        .unwrap()
}

fn say(branch: &Branch) {
    println!(
        "  period {} by {:?}: {} points {} .. {} {:?} {} turns {}",
        branch.period(),
        branch.method(),
        branch.points.len(),
        branch.points[0].value,
        branch.points.last().unwrap().value,
        branch.begin,
        branch.stopped,
        branch.turns.len()
    );
    for event in &branch.events {
        println!("     {event} after {}", event.after);
    }
    for turn in &branch.turns {
        println!("     TURN {turn:?}");
    }
}

#[test]
fn explore_tree() {
    for depth in [3] {
        let start = Instant::now();
        let shot = tree(Shooting::new(), depth);
        println!("shooting {:?}", start.elapsed());
        for b in &shot.branches {
            println!("{:?}", b.origin);
            say(&b.branch);
        }
        let start = Instant::now();
        let own = tree(ContactEquation::new(), depth);
        println!("contact {:?}", start.elapsed());
        for b in &own.branches {
            println!("{:?}", b.origin);
            say(&b.branch);
        }
        println!("{:?} {:?}", shot.omitted, own.omitted);
    }
}

#[test]
fn explore_isolas() {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    for (period, state) in [
        (2, [-5.632_060_192_753_841, 3.526_590_078_650_18]),
        (3, [-31.334_287_816_436_888, 0.605_360_285_158_400_4]),
        (3, [-6.36, -0.0231]),
        (4, [-58.4, -2.28]),
        (5, [-99.53, 1.207]),
    ] {
        let request = FrequencyResponse::of(&model)
            .from(0.4)
            .to(2.2)
            .period(period)
            .near_state(&state);
        for _ in 0..1 {
            let start = Instant::now();
            match request.clone().by(Shooting::new()).through(1.0) {
                Ok(branch) => {
                    println!("shooting {:?}", start.elapsed());
                    say(&branch);
                }
                Err(e) => println!("{e}"),
            }
            let start = Instant::now();
            match request.clone().by(ContactEquation::new()).through(1.0) {
                Ok(branch) => {
                    println!("contact {:?}", start.elapsed());
                    say(&branch);
                }
                Err(e) => println!("{e}"),
            }
        }
    }
}

hertzian::oscillator! {
    pub Stopped(x) {
        param k;
        param drive;
        law stop(gap, c) { gap > 0 => c*gap, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x - 1, k) = drive*cos(omega*t);
    }
}

hertzian::oscillator! {
    pub Hertz(x) {
        param k;
        param drive;
        law stop(gap, c) { gap > 0 => c*gap^1.5, else => 0 }
        ddot(x) + 0.02*dot(x) + x + stop(x - 1, k) = drive*cos(omega*t);
    }
}

fn isolas(model: &dyn System, vary: Option<&str>, range: [f64; 2]) {
    use hertzian::bifurcation::Settling;
    let request = FrequencyResponse::of(model).by(Shooting::new());
    let request = match vary {
        Some(name) => request.vary(name).omega(1.0),
        None => request,
    };
    let request = request.from(range[0]).to(range[1]);
    let found = Bifurcations::starting_with(request.clone())
        .depth(0)
        .cover(Settling::new().values(12).longest(6))
        .run();
    let found = match found {
        Ok(found) => found,
        Err(error) => {
            println!("{error}");
            return;
        }
    };
    for b in &found.branches {
        let branch = &b.branch;
        println!(
            "{:?} period {} {} points {:?} {}",
            b.origin,
            branch.period(),
            branch.points.len(),
            branch.begin,
            branch.stopped
        );
        if branch.stopped == Stop::Closed {
            say(branch);
            let first = branch.points.first().unwrap();
            println!("  START {:?} at {}", first.orbit.state(), first.value);
            for place in [0, branch.points.len() / 3, 2 * branch.points.len() / 3] {
                let first = &branch.points[place];
                let again = request
                    .clone()
                    .by(ContactEquation::new())
                    .period(first.orbit.period)
                    .near_state(&first.orbit.state())
                    .max_points(500);
                let start = Instant::now();
                match again.through(first.value) {
                    Ok(own) => {
                        println!("contact {:?}", start.elapsed());
                        say(&own)
                    }
                    Err(error) => println!("{error}"),
                }
            }
        }
    }
}

#[test]
fn explore_closed() {
    for drive in [0.5, 1.0, 2.0, 4.0] {
        for k in [4.0, 30.0] {
            println!("=== stopped {drive} {k}");
            isolas(&Stopped { k, drive }, None, [1.2, 6.0]);
            println!("=== hertz {drive} {k}");
            isolas(&Hertz { k, drive }, None, [1.2, 6.0]);
        }
    }
    println!("=== linear over drive");
    isolas(&MODEL, Some("drive"), [0.05, 6.0]);
}
