//! Basins on one thread and on two, of the one-sided oscillator at `A = 1`, `omega = 1`:
//!
//!     cargo bench -p hertzian --bench basin
//!
//! prints the times and their ratio. `cargo bench -p hertzian --bench basin -- 512` takes a grid of another size.

use std::time::Instant;

use hertzian::attractors::basin::{Axis, Basin, Basins, Grid};

hertzian::oscillator! {
    OneSided(x) {
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut sizes = std::env::args().filter_map(|argument| argument.parse().ok());
    let count = sizes.next_back().unwrap_or(256);
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(count);
    let grid = Grid::new(vec![0.0; 2], axis(0, -110.0, 15.0), axis(1, -16.0, 16.0));
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let basin = Basin::of(&model).omega(1.0).grid(grid);
    let compute = |threads: usize| -> Result<(f64, Basins), Box<dyn std::error::Error>> {
        let start = Instant::now();
        let basins = basin.clone().threads(threads).run()?;
        Ok((start.elapsed().as_secs_f64(), basins))
    };
    let (one, alone) = compute(1)?;
    let (two, both) = compute(2)?;
    assert_eq!(alone, both, "the number of threads changes the result");
    println!("{count} x {count} cells, {} periods", alone.periods);
    println!(
        "one thread    {one:8.2} s, {:.3} us per period",
        1e6 * one / alone.periods as f64
    );
    println!("two threads   {two:8.2} s, {:.2} times as fast", one / two);
    Ok(())
}
