//! Which motion a start leads to: `cargo run --release --example basin` draws `basin.svg`.
//!
//! A mass on a contact that opens, driven so that motions of several periods are possible. From every cell of a grid of initial states a
//! motion is followed until it is known where it settles. To make it your own, change the equation and the ranges of the grid.

use hertzian::attractors::basin::{Axis, Basin, Fate, Grid};
use hertzian::chart::{Chart, Colour, Raster, Series};

hertzian::oscillator! {
    /// Contact that opens
    pub OneSided(x) {
        /// damping ratio
        param zeta in 0.0..;
        /// load
        param load;
        /// excitation amplitude
        param drive;

        law contact(gap) {
            gap > 0 => 2*zeta*dot(gap) + gap,
            else    => 0,
        }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

/// Cells along each side of the grid: more of them for a finer picture.
const CELLS: usize = 100;

/// Follows the motions, says how many settle where, and draws it.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = OneSided {
        zeta: 0.032,
        load: 1.0,
        drive: 1.0,
    };
    let axis = |entry, from, to| Axis::of(entry).from(from).to(to).cells(CELLS);
    let (columns, rows) = (axis(0, -30.0, 10.0), axis(1, -8.0, 8.0));
    let sides = ([columns.from, columns.to], [rows.from, rows.to]);
    let grid = Grid::new(vec![0.0, 0.0], columns, rows);
    let basins = Basin::of(&model).omega(1.0).grid(grid).threads(2).run()?;

    let mut classes = Vec::new();
    let mut letters = Vec::new();
    for (index, attractor) in basins.attractors.iter().enumerate() {
        let share = basins.count(Fate::Periodic(index)) as f64 / (CELLS * CELLS) as f64;
        // Two of them may have one period.
        let letter = char::from(b'a' + index as u8).to_string();
        let label = format!(
            "{letter}, period {}: {:.1} %",
            attractor.period,
            100.0 * share
        );
        println!("{label} of the starts");
        let points = attractor.points.iter().map(|state| [state[0], state[1]]);
        let points: Vec<[f64; 2]> = points.collect();
        letters.push(Series::new(letter, points));
        classes.push((label, Colour::Class(index)));
    }
    let others = classes.len();
    classes.push(("not periodic, or escaped".to_owned(), Colour::Fault));
    let class = |fate: &Fate| match fate {
        Fate::Periodic(index) => *index,
        _ => others,
    };
    let mut chart =
        Chart::new("Contact that opens, where motions settle: ζ = 0.032, W = 1, A = 1, ω = 1")
            .x("initial x / static deflection")
            .y("initial rate of x / (static deflection × linear frequency)")
            .raster(Raster {
                x: sides.0,
                y: sides.1,
                columns: CELLS,
                cells: basins.fates.iter().map(|fate| class(fate) as u8).collect(),
                classes,
            });
    for points in letters {
        chart = chart.letters(points);
    }
    let chart = chart.remark("letters: the orbit itself, once in each period of the excitation");
    chart.write("basin.svg")?;
    println!("written basin.svg");
    Ok(())
}
