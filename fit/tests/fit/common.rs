//! Models, and data that were made by `measured/make.py`.

use hertzian_fit::{DataSet, Sweep};

hertzian::oscillator! {
    /// One-sided contact of any exponent.
    pub OneSided(x) {
        param alpha > 0;
        param zeta in 0.0..;
        param load;
        param drive;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^alpha, else => 0 }
        ddot(x) + contact(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Springs behind a play on both sides.
    pub Backlash(x) {
        param zeta in 0.0..;
        param stiffness > 0;
        param play > 0;
        param load;
        param drive;
        law tooth(gap) {
            gap > play => stiffness*(gap - play),
            gap < -play => stiffness*(gap + play),
            else => 0,
        }
        ddot(x) + 2*zeta*dot(x) + tooth(x) = drive*cos(omega*t) + load;
    }
}

hertzian::oscillator! {
    /// Two masses of which the first meets a stop.
    pub TwoMasses(x, z) {
        param stop > 0;
        param distance > 0;
        param coupling;
        param zeta in 0.0..;
        param drive;
        law hertz(gap) { gap > 0 => stop*gap^1.5, else => 0 }
        ddot(x) + 2*zeta*dot(x) + x + coupling*(x - z) + hertz(x - distance) = drive*cos(omega*t);
        ddot(z) + 2*zeta*dot(z) + z + coupling*(z - x) = 0;
    }
}

/// The rows of a table of these, as numbers of the columns that are.
pub fn rows(text: &str) -> Vec<(f64, f64, Sweep, Option<f64>)> {
    let lines = text.lines().skip(1);
    let rows = lines.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |index: usize| cells[index].parse::<f64>().expect("a number");
        let sweep = if cells[2] == "rising" {
            Sweep::Rising
        } else {
            Sweep::Falling
        };
        (
            number(0),
            number(1),
            sweep,
            (cells.len() > 3).then(|| number(3)),
        )
    });
    rows.collect()
}

/// The data sets of a table of these: a sweep each, and a level of the drive.
pub fn sets(text: &str) -> Vec<DataSet> {
    let rows = rows(text);
    let mut kinds: Vec<(Sweep, Option<f64>)> = Vec::new();
    for (_, _, sweep, level) in &rows {
        if !kinds.contains(&(*sweep, *level)) {
            kinds.push((*sweep, *level));
        }
    }
    let sets = kinds.into_iter().map(|(sweep, level)| {
        let own = rows.iter().filter(|row| (row.2, row.3) == (sweep, level));
        let (omegas, values): (Vec<f64>, Vec<f64>) = own.map(|row| (row.0, row.1)).unzip();
        let name = format!(
            "{sweep:?}{}",
            level.map_or(String::new(), |level| format!(" {level}"))
        );
        let set = DataSet::new("x:p2p", omegas, values)
            .named(name)
            .sweep(sweep);
        level.map_or(set.clone(), |level| set.at("drive", level))
    });
    sets.collect()
}
