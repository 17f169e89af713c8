//! Models, and data that were made by `measured/make.py`.

use hertzian_fit::{DataSet, Sweep};

hertzian::oscillator! {
    /// One-sided contact of any exponent.
    pub OneSided(x) {
        param alpha > 0;
        param zeta in 0.0..;
        param load;
        param drive;
        param stiffness > 0;
        law contact(gap) { gap > 0 => 2*zeta*dot(gap) + stiffness*gap^alpha, else => 0 }
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
    sets_with(text, |_, value| value, None)
}

/// The same with normal noise of a part of each value, which is stated. The same number gives the same noise.
pub fn noisy(text: &str, part: f64, number: u64) -> Vec<DataSet> {
    let mut normal = normal(number);
    sets_with(text, |_, value| value * (1.0 + part * normal()), Some(part))
}

fn sets_with(
    text: &str,
    mut change: impl FnMut(f64, f64) -> f64,
    part: Option<f64>,
) -> Vec<DataSet> {
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
        let deviations: Option<Vec<f64>> =
            part.map(|part| values.iter().map(|value| part * value).collect());
        let values: Vec<f64> = omegas
            .iter()
            .zip(values)
            .map(|(&omega, value)| change(omega, value))
            .collect();
        let name = format!(
            "{sweep:?}{}",
            level.map_or(String::new(), |level| format!(" {level}"))
        );
        let mut set = DataSet::new("x:p2p", omegas, values)
            .named(name)
            .sweep(sweep);
        if let Some(deviations) = deviations {
            set = set.deviations(deviations);
        }
        level.map_or(set.clone(), |level| set.at("drive", level))
    });
    sets.collect()
}

/// Normal numbers by the method of Box and Muller (1958), from those of `SplitMix64` (Steele, Lea and Flood 2014).
pub fn normal(seed: u64) -> impl FnMut() -> f64 {
    // Seeds that differ by a step of the sequence would give the same numbers a place later.
    let mut state = mixed(seed);
    let mut uniform = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mixed(state) >> 11) as f64 * 0.5_f64.powi(53)
    };
    move || (-2.0 * (1.0 - uniform()).ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos()
}

fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
