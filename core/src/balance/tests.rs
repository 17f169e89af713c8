//! quick look

use crate::FrequencyResponse;
use crate::by_hand::PowerForm;

#[test]
fn quick_look() {
    for n in [512, 2048, 4096] {
        for (os, alpha, zeta, load, from, to, k) in [
            (false, 1.5, 0.01, 0.0, 0.6, 1.7, 20),
            (false, 1.5, 0.01, 1.0, 0.7, 1.7, 20),
            (false, 1.5, 0.01, 5.0, 1.0, 2.2, 20),
            (true, 1.5, 0.032, 1.0, 0.6, 1.6, 20),
            (true, 1.0, 0.032, 1.0, 0.6, 1.4, 20),
            (true, 0.6, 0.032, 1.0, 0.5, 1.2, 20),
            (false, 0.6, 0.01, 0.0, 0.66, 1.4, 20),
        ] {
            let system = PowerForm::new(os, alpha, zeta, load, 0.1);
            let branch = FrequencyResponse::of(&system)
                .from(from)
                .to(to)
                .harmonics(k)
                .samples(n)
                .max_points(5000)
                .run();
            let branch = match branch {
                Ok(b) => b,
                Err(e) => {
                    eprintln!("{e}");
                    continue;
                }
            };
            eprintln!(
                "{os} {alpha} {load} K{k}: {} points {:?} {} {}",
                branch.points.len(),
                branch.elapsed,
                branch.stopped,
                branch.statistics
            );
            for f in branch.folds().take(6) {
                eprintln!(
                    "    {f} {:?} {:.1e}",
                    f.point.stability.multipliers, f.point.stability.error
                );
            }
            for f in branch.turns.iter().take(6) {
                eprintln!("    {f:?}");
            }
            let mut last = None;
            let mut runs = String::new();
            for p in &branch.points {
                if Some(p.stability.verdict) != last {
                    last = Some(p.stability.verdict);
                    runs += &format!("{} from {:.5}; ", p.stability.verdict, p.value)
                }
            }
            if runs.len() < 2000 {
                eprintln!("    {runs}");
            }
            let worst = branch
                .points
                .iter()
                .map(|p| (p.observed.input_power - p.observed.dissipated_power).abs())
                .fold(0.0, f64::max);
            let p = &branch.points[branch.points.len() / 3];
            eprintln!(
                "    power {worst:.1e} {:?} {:?} {:?}",
                p.value, p.observed, p.stability
            );
        }
    }
}
