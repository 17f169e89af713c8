//! What the search costs: `cargo test --release -p hertzian --lib crossings -- --ignored --nocapture`.

use std::hint::black_box;
use std::time::Instant;

use super::super::CrossingFinder;

/// Least time of one call in nanoseconds, but for four outliers.
fn time(mut f: impl FnMut()) -> f64 {
    const CALLS: usize = 100;
    let mut times: Vec<f64> = (0..400)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..CALLS {
                f();
            }
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    1e9 * times[4] / CALLS as f64
}

#[test]
#[ignore = "it measures and asserts no time"]
fn time_of_two_crossings() {
    println!("nanoseconds: K, sample, crossings, both; crossings of a close pair, near misses");
    for harmonics in [5, 10, 20, 40, 100] {
        let mut series = vec![0.1, 0.9, 0.4];
        for k in 2..=harmonics {
            let k = f64::from(k);
            let size = 0.5 / k.powi(3);
            series.extend([size * (1.3 * k).cos(), size * (1.7 * k).sin()]);
        }
        let mut finder = CrossingFinder::new(harmonics as usize);
        let (mut found, mut misses) = (Vec::new(), Vec::new());
        let sample = time(|| finder.sample(black_box(&series)));
        finder.near_misses(2.0, 2.0, &mut misses);
        let close = 2.0 - misses[0].distance - 1e-9;
        let mut cross = |level: f64| {
            let time = time(|| {
                found.clear();
                finder.crossings(black_box(level), &mut found);
            });
            assert_eq!(found.len(), 2);
            time
        };
        let (two, pair) = (cross(0.3), cross(close));
        let near = time(|| {
            misses.clear();
            finder.near_misses(black_box(close + 0.01), 0.1, &mut misses);
        });
        let both = time(|| {
            found.clear();
            finder.sample(black_box(&series));
            finder.crossings(black_box(0.3), &mut found);
        });
        println!("{harmonics:4}{sample:8.0}{two:8.0}{both:8.0}{pair:8.0}{near:8.0}");
    }
}
