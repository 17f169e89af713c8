//! What is said of a map.

use std::fmt;

use super::{Cell, Map};
use crate::bifurcation::diagram::Reason;
use crate::bifurcation::solutions::DEPTH;
use crate::numeric::decimal::Decimal;

fn orbits(stable: usize) -> String {
    match stable {
        0 => "no stable orbit".to_owned(),
        1 => "1 stable orbit".to_owned(),
        more => format!("{more} stable orbits"),
    }
}

fn in_cells(count: usize) -> String {
    match count {
        1 => "1 cell".to_owned(),
        more => format!("{more} cells"),
    }
}

impl fmt::Display for Map {
    /// How many cells have how many stable orbits, where the largest is, and what was searched.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [along, across] = &self.names;
        let [columns, rows] = [self.values[0].len(), self.values[1].len()];
        writeln!(f, "{columns} values of {along}, {rows} of {across}")?;
        let known = || self.cells.iter().filter(|cell| cell.reason.is_none());
        let most = known().map(|cell| cell.stable).max();
        for stable in 0..=most.unwrap_or(0) {
            match known().filter(|cell| cell.stable == stable).count() {
                0 => {}
                cells => writeln!(f, "{} in {}", orbits(stable), in_cells(cells))?,
            }
        }
        let some = |count: fn(&Cell) -> usize| known().filter(|cell| count(cell) > 0).count();
        for (cells, what) in [
            (some(|cell| cell.restless), "motions settle to no orbit"),
            (
                some(|cell| cell.undecided),
                "the stability of an orbit is undecided",
            ),
            (
                some(|cell| cell.missed),
                "an orbit was found and its branch missed",
            ),
        ] {
            if cells > 0 {
                writeln!(f, "in {} {what}", in_cells(cells))?;
            }
        }
        self.write_largest(f)?;
        let without: Vec<&Reason> = self
            .cells
            .iter()
            .filter_map(|c| c.reason.as_ref())
            .collect();
        let (unseen, failed): (Vec<&Reason>, Vec<&Reason>) = without
            .into_iter()
            .partition(|reason| **reason == Reason::Interrupted);
        if !unseen.is_empty() {
            writeln!(f, "not looked at: {}", in_cells(unseen.len()))?;
        }
        if let Some(first) = failed.first() {
            writeln!(f, "nothing in {}, first: {first}", in_cells(failed.len()))?;
        }
        let motions: usize = self.cells.iter().map(|cell| cell.motions).sum();
        let [branches, lost] =
            [&self.branches, &self.lost].map(|counts| counts.iter().sum::<usize>());
        writeln!(
            f,
            "searched: {branches} branches, with what begins on them to depth {DEPTH}; {motions} motions"
        )?;
        match lost {
            0 => Ok(()),
            lost => writeln!(f, "not followed: {lost} branches"),
        }
    }
}

impl Map {
    fn write_largest(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sizes = self.cells.iter().enumerate();
        let sizes = sizes.filter_map(|(place, cell)| Some((place, cell.largest?)));
        let largest = sizes.max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, size)) = largest else {
            return Ok(());
        };
        let Some([value, other]) = self.at(place) else {
            return Ok(());
        };
        let [along, across] = &self.names;
        let with = |value: Decimal, unit: &str| match unit {
            "" => value.to_string(),
            unit => format!("{value} {unit}"),
        };
        let varied =
            |name: &str, value: f64| with(Decimal::plain(value), self.model.unit_of_varied(name));
        let size = with(Decimal::rounded(size, 6), self.model.unit_of(&self.signal));
        writeln!(
            f,
            "largest stable: peak-to-peak of {} {size} at {along} = {}, {across} = {}",
            self.signal,
            varied(along, value),
            varied(across, other)
        )
    }
}
