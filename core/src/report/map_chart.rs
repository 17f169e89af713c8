//! The charts of a map: coloured cells.

use hertzian_chart::{Chart, Colour, Raster, STEPS, Series};

use crate::bifurcation::{Cell, CellVerdict, Map};
use crate::report::export::map::unit;
use crate::report::labels::{Labels, name_of};
use crate::report::prefix::with_unit;
use crate::report::view::Frequency;

/// Cells along a side, where they are not of one size in the picture.
const FINE: usize = 720;
/// Values in a larger ratio than this are classed over decades.
const DECADES: f64 = 50.0;
/// Numbers 1, 2, 5 of all decades between the smallest and the largest number.
const PLACES: i32 = 3 * 640;

/// The class of every cell, and what the legend says of them.
#[derive(Debug, Default)]
struct Classes {
    known: Vec<(String, Colour)>,
    of: Vec<u8>,
}

impl Classes {
    /// Adds a cell.
    fn add(&mut self, label: &str, colour: Colour) {
        let place = self.known.iter().position(|known| known.0 == label);
        let place = place.unwrap_or_else(|| {
            self.known.push((label.to_owned(), colour));
            self.known.len() - 1
        });
        self.of.push(place as u8);
    }

    /// With the classes in this order of the legend.
    fn in_order(mut self, order: impl Fn(&str) -> usize) -> Self {
        let mut places: Vec<usize> = (0..self.known.len()).collect();
        places.sort_by_key(|&place| order(&self.known[place].0));
        let mut numbers = vec![0; places.len()];
        for (number, &place) in places.iter().enumerate() {
            numbers[place] = number as u8;
        }
        self.known = places
            .iter()
            .map(|&place| self.known[place].clone())
            .collect();
        self.of
            .iter_mut()
            .for_each(|class| *class = numbers[usize::from(*class)]);
        self
    }
}

/// What a cell is that has no number to show.
fn without(cell: &Cell) -> (String, Colour) {
    let label = |verdict: CellVerdict| verdict.to_string();
    match cell.verdict() {
        verdict @ CellVerdict::NotLookedAt => (label(verdict), Colour::None),
        verdict @ CellVerdict::Failed => (label(verdict), CROSSED),
        _ if cell.stable > 0 => ("size not known".to_owned(), DOTS),
        _ if cell.restless > 0 => (NOT_SETTLING.to_owned(), DIAGONALS),
        _ => (NONE.to_owned(), UPRIGHTS),
    }
}

const DIAGONALS: Colour = Colour::Hatched(0);
const CROSSED: Colour = Colour::Hatched(1);
const DOTS: Colour = Colour::Hatched(2);
const UPRIGHTS: Colour = Colour::Hatched(3);
const NOT_SETTLING: &str = "none, not settling";
const NONE: &str = "no stable orbit";

impl Map {
    /// Cells coloured by the number of stable orbits. Cells where an orbit was found and its branch missed are marked.
    pub fn chart_of_stable(&self) -> Chart {
        let known = || self.cells.iter().filter(|cell| cell.reason.is_none());
        let mut counts: Vec<usize> = known().map(|cell| cell.stable).filter(|&n| n > 0).collect();
        counts.sort_unstable();
        counts.dedup();
        let most = counts.get(STEPS - 1).copied();
        counts.truncate(STEPS);
        let label = |count: usize| match (count, most) {
            (1, _) => "1 stable orbit".to_owned(),
            (count, Some(most)) if count >= most => format!("{most} or more"),
            (count, _) => format!("{count} stable orbits"),
        };
        let mut classes = Classes::default();
        for cell in &self.cells {
            if cell.reason.is_some() || cell.stable == 0 {
                let (label, colour) = without(cell);
                classes.add(&label, colour);
                continue;
            }
            let place = counts.partition_point(|&count| count <= cell.stable) - 1;
            classes.add(&label(cell.stable), Colour::in_order(place, counts.len()));
        }
        let labels: Vec<String> = counts.into_iter().map(label).collect();
        self.drawn(
            "number of stable orbits that were found",
            classes.in_order(|label| order(&labels, label)),
        )
    }

    /// Cells coloured by the largest peak-to-peak of [what leads](Self::signal) among the stable orbits, in a few classes. Cells where an
    /// orbit was found and its branch missed are marked.
    pub fn chart_of_largest(&self) -> Chart {
        let unit = self.model.unit_of(&self.signal);
        let sizes: Vec<f64> = self.cells.iter().filter_map(|cell| cell.largest).collect();
        let edges = edges(&sizes);
        let labels: Vec<String> = edges
            .windows(2)
            .map(|ends| {
                format!(
                    "{} to {}",
                    with_unit(ends[0], unit),
                    with_unit(ends[1], unit)
                )
            })
            .collect();
        let mut classes = Classes::default();
        for cell in &self.cells {
            let Some(size) = cell.largest else {
                let (label, colour) = without(cell);
                classes.add(&label, colour);
                continue;
            };
            let above = edges.partition_point(|&edge| edge <= size);
            let place = above.saturating_sub(1).min(labels.len() - 1);
            classes.add(&labels[place], Colour::in_order(place, labels.len()));
        }
        let shown = format!(
            "largest peak-to-peak of {} of stable orbits that were found",
            self.signal
        );
        self.drawn(&shown, classes.in_order(|label| order(&labels, label)))
    }

    /// Cells coloured by what can be said of all solutions together: whether all are stable, some or none, and whether motions settle.
    pub fn chart_of_verdicts(&self) -> Chart {
        let mut classes = Classes::default();
        for cell in &self.cells {
            let verdict = cell.verdict();
            let colour = match verdict {
                CellVerdict::AllStable => Colour::Step(0),
                CellVerdict::SomeStable => Colour::Step(1),
                CellVerdict::NoneStable => Colour::Step(2),
                CellVerdict::StableAndRestless => UPRIGHTS,
                CellVerdict::Restless => DIAGONALS,
                CellVerdict::Uncertain => DOTS,
                CellVerdict::Empty => Colour::Step(4),
                CellVerdict::Failed => CROSSED,
                CellVerdict::NotLookedAt => Colour::None,
            };
            classes.add(&verdict.to_string(), colour);
        }
        let labels = CellVerdict::ALL.map(|verdict| verdict.to_string());
        self.drawn(
            "periodic orbits that were found",
            classes.in_order(|label| order(&labels, label)),
        )
    }

    fn drawn(&self, shown: &str, classes: Classes) -> Chart {
        let [along, across] = [&self.values[0], &self.values[1]].map(|values| Side::of(values));
        let columns = self.values[0].len();
        let rows = across.cells.iter();
        let cells = rows.flat_map(|&row| {
            let cells = along.cells.iter();
            cells.map(move |&column| row * columns + column)
        });
        let raster = Raster {
            x: along.range,
            y: across.range,
            columns: along.cells.len(),
            cells: cells
                .map(|cell| classes.of.get(cell).copied().unwrap_or(u8::MAX))
                .collect(),
            classes: classes.known,
        };
        let [x, y] = [&self.names[0], &self.names[1]]
            .map(|name| name_of(&self.model, name, Frequency::Omega));
        let missed = self.cells.iter().enumerate();
        let missed = missed.filter(|(_, cell)| cell.missed > 0);
        Chart::new(self.title(shown))
            .x(x)
            .y(y)
            .raster(raster)
            .markers(Series {
                label: "an orbit missed".to_owned(),
                points: missed.filter_map(|(place, _)| self.at(place)).collect(),
            })
    }

    /// The system, everything that is the same in all cells, and what is shown.
    fn title(&self, shown: &str) -> String {
        let labels = Labels {
            title: self.model.name.clone(),
            ..Labels::default()
        };
        let held = self.model.parameters.iter().zip(&self.parameters);
        let held = held.filter(|(parameter, _)| !self.names.contains(&parameter.name));
        let values =
            held.map(|(held, value)| format!("{} = {}", held.name, with_unit(*value, &held.unit)));
        let per_time = unit(&self.model, "omega");
        let omega = self
            .omega
            .map(|omega| format!("ω = {}", with_unit(omega, per_time)));
        let labels = values
            .chain(omega)
            .fold(labels, |labels, value| labels.with(&value));
        format!("{}; {shown}", labels.title)
    }
}

/// Where a label stands in the legend: those of numbers first.
fn order(labels: &[String], label: &str) -> usize {
    let place = labels.iter().position(|other| other == label);
    place.unwrap_or(labels.len())
}

/// A side of the picture: its range, and for each of its parts, from the lowest on, the number of the value there.
struct Side {
    range: [f64; 2],
    cells: Vec<usize>,
}

impl Side {
    /// Borders are halfway between neighbours.
    fn of(values: &[f64]) -> Self {
        let mut cells: Vec<usize> = (0..values.len()).collect();
        cells.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let sorted: Vec<f64> = cells.iter().map(|&cell| values[cell]).collect();
        let ([first, ..], [.., last]) = (&sorted[..], &sorted[..]) else {
            return Self {
                range: [0.0, 1.0],
                cells,
            };
        };
        if sorted.len() == 1 {
            let half = if *first == 0.0 {
                0.5
            } else {
                0.05 * first.abs()
            };
            return Self {
                range: [first - half, first + half],
                cells,
            };
        }
        let gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let range = [first - 0.5 * gaps[0], last + 0.5 * gaps[gaps.len() - 1]];
        let mean = (last - first) / gaps.len() as f64;
        if gaps.iter().all(|gap| (gap - mean).abs() < 1e-6 * mean) {
            return Self { range, cells };
        }
        let borders: Vec<f64> = sorted
            .windows(2)
            .map(|pair| 0.5 * (pair[0] + pair[1]))
            .collect();
        let part = |index: usize| {
            let along = (index as f64 + 0.5) / FINE as f64;
            let value = range[0] + along * (range[1] - range[0]);
            cells[borders.partition_point(|&border| border <= value)]
        };
        let cells = (0..FINE).map(part).collect();
        Self { range, cells }
    }
}

/// Round numbers that divide sizes into a few classes, at least one: evenly, or over decades.
fn edges(sizes: &[f64]) -> Vec<f64> {
    let finite = || sizes.iter().copied().filter(|size| size.is_finite());
    let low = finite().fold(f64::INFINITY, f64::min);
    let high = finite().fold(0.0, f64::max);
    if low > high || high == 0.0 {
        return vec![0.0, 1.0];
    }
    if low > 0.0 && high > DECADES * low {
        let from = (-PLACES..=0)
            .rev()
            .find(|&place| series(place, high) <= low);
        let from = from.unwrap_or(-PLACES);
        let to = (0..PLACES).find(|&place| series(place, high) > high);
        let to = to.unwrap_or(PLACES);
        let stride = (to - from + STEPS as i32 - 1) / STEPS as i32;
        let count = (to - from + stride - 1) / stride;
        return (0..=count)
            .map(|step| series(from + step * stride, high))
            .collect();
    }
    let power = 10_f64.powi((high.log10().floor() as i32) - 3);
    // The largest is beyond all sizes.
    let steps = (0..=4).flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(decade)));
    let mut steps = steps.map(|step| step * power);
    let count = |step: &f64| (high / step).floor() - (low / step).floor() + 1.0;
    let step = steps
        .find(|step| count(step) <= STEPS as f64)
        .unwrap_or(high);
    let from = (low / step).floor();
    let count = count(&step) as usize;
    (0..=count)
        .map(|index| rounded((from + index as f64) * step))
        .collect()
}

/// The numbers 1, 2, 5 of all decades, counted from that of a size.
fn series(place: i32, size: f64) -> f64 {
    let digit = [1.0, 2.0, 5.0][place.rem_euclid(3) as usize];
    let decade = size.log10().floor() as i32 + place.div_euclid(3);
    rounded(digit * 10_f64.powi(decade))
}

/// Without what rounding leaves in its last digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_few_and_hold_all_sizes() {
        for sizes in [
            vec![1.0],
            vec![0.0],
            vec![0.0, 3.0],
            vec![0.2, 6.5],
            vec![3.0, 3.0, 3.1],
            vec![1e-7, 2e-3],
            vec![1e-300, 1e300],
            vec![9.99, 10.0],
            vec![1.0, 49.9],
            vec![5.0, 250.1],
        ] {
            let edges = edges(&sizes);
            assert!(
                (2..=STEPS + 1).contains(&edges.len()),
                "{sizes:?}: {edges:?}"
            );
            assert!(edges.windows(2).all(|pair| pair[0] < pair[1]), "{edges:?}");
            let (first, last) = (edges[0], edges[edges.len() - 1]);
            assert!(
                sizes.iter().all(|&size| (first..=last).contains(&size)),
                "{sizes:?}: {edges:?}"
            );
        }
        assert_eq!(edges(&[0.2, 6.5]), [0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(edges(&[0.2, 0.9]), [0.2, 0.4, 0.6, 0.8, 1.0]);
        assert_eq!(edges(&[0.15, 90.0])[..2], [0.1, 0.5]);
        assert_eq!(edges(&[]), [0.0, 1.0]);
    }

    #[test]
    fn sides_have_borders_halfway() {
        let even = Side::of(&[3.0, 1.0, 2.0]);
        assert_eq!((even.range, even.cells), ([0.5, 3.5], vec![1, 2, 0]));
        let one = Side::of(&[2.0]);
        assert_eq!((one.range, one.cells), ([1.9, 2.1], vec![0]));
        // Borders at 1.5 and 3.
        let uneven = Side::of(&[1.0, 2.0, 4.0]);
        assert_eq!((uneven.range, uneven.cells.len()), ([0.5, 5.0], FINE));
        for (cell, part) in [(0, 1.0 / 4.5), (1, 1.5 / 4.5), (2, 2.0 / 4.5)] {
            let count = uneven.cells.iter().filter(|&&other| other == cell).count();
            assert_eq!(count, (part * FINE as f64) as usize);
        }
    }
}
