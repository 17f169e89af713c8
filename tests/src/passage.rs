//! A branch as either method gives it, as far as branches are compared.

use std::fmt::Write as _;

use hertzian::{Branch, EventKind, Point, Stop, Turn, Verdict};

/// Ends of branches whose peak-to-peak differ by this part are one.
const ALIKE: f64 = 1e-4;
/// Orbits at one value whose peak-to-peak differ by this part are one.
const SAME: f64 = 1e-9;
/// The stated error of an event that may be beyond an end of the range is taken for this part of the range at most.
const AT_END: f64 = 0.02;

/// An event of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// What happens there.
    pub kind: EventKind,
    /// Value of what is varied.
    pub value: f64,
    /// Of the value, as it is stated.
    pub error: f64,
    /// Of the first coordinate.
    pub peak_to_peak: f64,
    /// Number of points before it.
    pub after: usize,
}

/// A point of a branch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Value of what is varied.
    pub value: f64,
    /// Of the first coordinate.
    pub peak_to_peak: f64,
    /// Of peak-to-peak, as it is stated.
    pub error: f64,
    /// Whether it is stable.
    pub verdict: Verdict,
    /// Largest modulus of a multiplier and its error.
    pub modulus: [f64; 2],
}

impl Place {
    fn of(point: &Point) -> Self {
        let stability = &point.stability;
        let largest = stability.multipliers.first();
        Self {
            value: point.value,
            peak_to_peak: point.peak_to_peak(),
            error: point.error.unwrap_or(0.0),
            verdict: stability.verdict,
            modulus: [largest.map_or(f64::NAN, |m| m.norm()), stability.error],
        }
    }
}

/// A branch from one end of the range on.
#[derive(Debug, Clone)]
pub struct Passage {
    /// How it was found.
    pub name: &'static str,
    /// Its points in their order.
    pub places: Vec<Place>,
    /// Its events in their order.
    pub events: Vec<Seen>,
    /// Where it turns.
    pub turns: Vec<Turn>,
    /// Whether it came to the other end.
    pub whole: bool,
    /// Whether it ended for having as many points as it may.
    pub cut: bool,
    /// Why it ended.
    pub ended: String,
}

impl Passage {
    /// Of a branch.
    pub fn of(name: &'static str, branch: &Branch) -> Self {
        let places = branch.points.iter().map(Place::of);
        let events = branch.events.iter().map(|event| Seen {
            kind: event.kind,
            value: event.point.value,
            error: event.error,
            peak_to_peak: event.point.peak_to_peak(),
            after: event.after,
        });
        Self {
            name,
            places: places.collect(),
            events: events.collect(),
            turns: branch.turns.clone(),
            whole: branch.stopped == Stop::ReachedEnd,
            cut: matches!(branch.stopped, Stop::PointLimit { .. }),
            ended: branch.stopped.to_string(),
        }
    }

    /// Changes of the verdict between neighbours, points that are undecided left out, with nothing between that explains them.
    pub fn unexplained(&self) -> Vec<String> {
        let mut found = Vec::new();
        let decided = |index: &usize| self.places[*index].verdict != Verdict::Undecided;
        let decided: Vec<usize> = (0..self.places.len()).filter(decided).collect();
        for pair in decided.windows(2) {
            let [before, after] = [pair[0], pair[1]].map(|index| self.places[index]);
            if before.verdict == after.verdict {
                continue;
            }
            let between = pair[0] + 1..=pair[1];
            let event = self
                .events
                .iter()
                .any(|event| between.contains(&event.after));
            let turn = self.turns.iter().any(|turn| between.contains(&turn.after));
            if !event && !turn {
                let mut text = format!("{}: ", self.name);
                for place in [before, after] {
                    let _ = write!(
                        text,
                        "{} at {:?} (|mu| {:.9} +- {:.0e}) ",
                        place.verdict, place.value, place.modulus[0], place.modulus[1]
                    );
                }
                found.push(text);
            }
        }
        found
    }

    /// Whether both begin and end at the same orbits, one followed from one end, the other from the same or the other one.
    pub fn shares_ends(&self, other: &Self) -> bool {
        let ends = |passage: &Self| {
            let mut ends = [passage.places[0], passage.places[passage.places.len() - 1]];
            ends.sort_by(|a, b| a.value.total_cmp(&b.value));
            ends
        };
        let alike = |(a, b): (&Place, &Place)| {
            let size = a.peak_to_peak.max(b.peak_to_peak);
            (a.peak_to_peak - b.peak_to_peak).abs() < ALIKE * size
        };
        ends(self).iter().zip(&ends(other)).all(alike)
    }
}

/// Two branches, one or both of which were cut at so many points, up to where the shorter one ends, which is an orbit of the longer one.
///
/// Rounding changes what an iteration leaves, the step control makes more of that from point to point, and after as many steps two
/// walks along one curve are not equally far; one may just have come to the end of the range. What is compared is the curve: its
/// orbits at a value, and its events as far as both go. `None` if neither ends on the other one.
pub fn as_far(one: &Walked<'_>, other: &Walked<'_>) -> Option<[Passage; 2]> {
    let [a, b] = [&one.passage, &other.passage];
    let goes_on = |passage: &Passage| passage.cut || passage.whole;
    if !(goes_on(a) && goes_on(b)) {
        return None;
    }
    if b.cut
        && let Some(shorter) = one.up_to(b)
    {
        return Some([shorter, b.clone()]);
    }
    let shorter = a.cut.then(|| other.up_to(a))??;
    Some([a.clone(), shorter])
}

/// A passage with its branch, values of which are so many times as large in the units of the passage, and positions.
pub struct Walked<'b> {
    /// In its own units.
    pub passage: Passage,
    /// The branch.
    pub branch: &'b Branch,
    /// Of values and positions.
    pub units: [f64; 2],
}

impl Walked<'_> {
    /// It as far as another one goes, if that ends on it.
    fn up_to(&self, other: &Passage) -> Option<Passage> {
        let end = other.places.last()?;
        let places = &self.passage.places;
        let size = |a: f64, b: f64| (a - b).abs() / a.abs().max(b.abs());
        // Where it is on the way, as far as straight lines tell.
        let off = |index: usize| {
            let [a, b] = [places[index], places[index + 1]];
            let part = (end.value - a.value) / (b.value - a.value);
            let straight = a.peak_to_peak + part * (b.peak_to_peak - a.peak_to_peak);
            size(straight, end.peak_to_peak)
        };
        let passes = |index: &usize| {
            let ends = [places[*index].value, places[index + 1].value];
            (ends[0] <= end.value) != (ends[1] <= end.value)
        };
        let segments = (0..places.len().saturating_sub(1)).filter(passes);
        let last = segments.min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        // What is compared is most of both.
        if 2 * (last + 1) < places.len() {
            return None;
        }
        let orbits = || {
            self.branch
                .at(end.value / self.units[0])
                .unwrap_or_default()
        };
        let is_end = |orbit: &Point| {
            let known = orbit.error.unwrap_or(0.0) + end.error;
            let apart = size(orbit.peak_to_peak() * self.units[1], end.peak_to_peak);
            apart <= SAME.max(if known.is_finite() { known } else { 0.0 })
        };
        if !orbits().iter().any(is_end) {
            return None;
        }
        let mut shorter = self.passage.clone();
        shorter.places.truncate(last + 1);
        let from = places[last].value;
        let before = |event: &Seen| {
            event.after <= last
                || event.after == last + 1 && (event.value - from).abs() < (end.value - from).abs()
        };
        shorter.events.retain(before);
        Some(shorter)
    }
}

/// Events of two passages, put together.
#[derive(Debug, Default)]
pub struct Matched {
    /// Difference of the values over the sum of the errors, with both.
    pub both: Vec<(f64, Seen, Seen)>,
    /// Of the first passage alone, and of the second.
    pub alone: [Vec<Seen>; 2],
}

/// Puts events of the same kind with nearly the same value and size together; those beside the ends of the range are left out.
pub fn matched(a: &Passage, b: &Passage, range: [f64; 2]) -> Matched {
    let width = (range[1] - range[0]).abs();
    let inside = |seen: &&Seen| {
        range
            .iter()
            .all(|end| (seen.value - end).abs() > 1e-5 * width)
    };
    let mut free: Vec<Seen> = b.events.iter().filter(inside).cloned().collect();
    let mut matched = Matched::default();
    for event in a.events.iter().filter(inside) {
        let near = |other: &Seen| {
            let kind = std::mem::discriminant(&event.kind) == std::mem::discriminant(&other.kind);
            let apart = (event.value - other.value).abs();
            let known = [event.error, other.error].iter().sum::<f64>();
            let window = (1e-4 * width).max(if known.is_finite() { 5.0 * known } else { 0.0 });
            let size = (event.peak_to_peak - other.peak_to_peak).abs();
            (kind && apart <= window.min(0.02 * width) && size <= 0.02 * event.peak_to_peak)
                .then_some(apart)
        };
        let best = (0..free.len())
            .filter_map(|index| Some((near(&free[index])?, index)))
            .min_by(|x, y| x.0.total_cmp(&y.0));
        match best {
            Some((apart, index)) => {
                let other = free.swap_remove(index);
                let rounding = 1e-13 * event.value.abs();
                let ratio = apart / (event.error + other.error + rounding);
                matched.both.push((ratio, event.clone(), other));
            }
            None => matched.alone[0].push(event.clone()),
        }
    }
    matched.alone[1] = free;
    // What may as well be beyond an end of the range, as far as is stated, the other one need not have.
    let is_in = |seen: &Seen| {
        let ends = range.iter();
        ends.fold(f64::INFINITY, |least: f64, end| {
            least.min((seen.value - end).abs())
        }) > seen.error.min(AT_END * (range[1] - range[0]).abs())
    };
    for alone in &mut matched.alone {
        alone.retain(is_in);
    }
    matched
}

impl std::fmt::Display for Seen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            kind,
            value,
            error,
            peak_to_peak,
            ..
        } = self;
        write!(
            f,
            "{kind} at {value:?} (error {error:.0e}, peak-to-peak {peak_to_peak:.6e})"
        )
    }
}
