//! The whole curve of Fig. 5a: `cargo bench -p hertzian --bench curve`.
use hertzian::{FrequencyResponse, oscillator};
use std::time::Instant;
oscillator! {
    /// One-sided contact with a linear spring.
    pub OneSidedLinear(x) {
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}
fn main() {
    let model = OneSidedLinear {
        zeta: 0.032,
        load: 1.0,
        drive: 0.1,
    };
    let only: Option<usize> = std::env::args().nth(1).and_then(|k| k.parse().ok());
    for k in [5, 10, 20, 40, 80] {
        if only.is_some_and(|only| only != k) {
            continue;
        }
        let request = FrequencyResponse::of(&model)
            .from(0.6)
            .to(1.4)
            .harmonics(k)
            .stability(false);
        let mut times = Vec::new();
        let mut last = None;
        for _ in 0..21 {
            let start = Instant::now();
            let branch = request.run().unwrap();
            times.push(start.elapsed().as_secs_f64());
            last = Some(branch);
        }
        times.sort_by(f64::total_cmp);
        let branch = last.unwrap();
        print!(
            "K {k} median {:.3} ms best {:.3} points {} {} folds",
            1e3 * times[10],
            1e3 * times[0],
            branch.points.len(),
            branch.statistics
        );
        for fold in branch.folds() {
            print!(" {:.9}", fold.point.value);
        }
        println!();
    }
}
