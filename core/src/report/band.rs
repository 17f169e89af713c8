//! A band around the curve of a branch, from uncertainties of parameters, to first order.
//!
//! At a fixed value `lambda` of what is varied, what is drawn, `y`, changes by `y_p u` with the uncertainty `u` of a parameter; the curve has
//! the slope `y_lambda`. In units of the axes' lengths the curve moves across itself by
//!
//! ```text
//! n^2 = sum_p (y_p u_p)^2 / (1 + y_lambda^2),                                                                 (1)
//! ```
//!
//! for uncertainties that are independent. Near folds `y_p` and `y_lambda` are unbounded alike, and (1) is not. It holds where the curve does not bend within
//! its band; where it does there is none, and the chart says so. Where the axis is one of logarithms, `y` is the logarithm: an edge is never
//! at or below zero, where it would have no place.
//!
//! Source: JCGM 100 (2008), Guide to the expression of uncertainty in measurement, section 5.1.

use hertzian_chart::{Chart, Scale};

use crate::branches::branch::Branch;
use crate::error::{Error, ErrorKind};
use crate::report::view::{Seen, View};
use crate::sensitivity::{Sensitivities, Uncertain};

/// The curve turns by less than this angle, in radians, within half the width of its band to either side.
const BENT: f64 = 0.5;

/// A band around a curve.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Band {
    /// Its two edges, a point for each orbit of the branch; one that is not a number where there is no band.
    pub edges: [Vec<[f64; 2]>; 2],
    /// Orbits at which the curve bends within the band's width, so that nothing can be said to first order.
    pub bent: usize,
    /// Orbits without derivatives.
    pub missing: usize,
}

/// An orbit on the chart.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: [f64; 2],
    /// Half of the band's height at this value of what is varied, and the slope of the curve.
    height: f64,
    slope: f64,
}

impl Branch {
    /// The band around what a view shows of this branch that uncertainties of parameters make, one standard uncertainty to each side. Of the
    /// amplitudes of several harmonics there is none.
    ///
    /// ```
    /// use hertzian::FrequencyResponse;
    /// use hertzian::chart::View;
    ///
    /// hertzian::oscillator! {
    ///     Linear(x) {
    ///         param zeta in 0.0..;
    ///         ddot(x) + 2*zeta*dot(x) + x = cos(omega*t);
    ///     }
    /// }
    ///
    /// let branch = FrequencyResponse::of(&Linear { zeta: 0.1 }).from(0.5).to(1.5).run()?;
    /// let band = branch.band(&View::new(), &["zeta=10%".parse()?])?;
    /// assert_eq!(band.edges[0].len(), branch.points.len());
    /// let svg = band.on(branch.chart(), "zeta ± 10 %").to_svg();
    /// assert!(svg.contains("zeta ± 10 %"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is no parameter of a name, what is shown has no derivative, or the branch is a [backbone](crate::backbone), the frequency of
    /// which is not fixed, or was read from a file and has no [model](Self::attach).
    pub fn band(&self, view: &View, uncertain: &[Uncertain]) -> Result<Band, Error> {
        self.is_no_backbone()?;
        let seen = view.on(self)?;
        let wanted = [seen.wanted.clone()];
        let mut by: Vec<&str> = uncertain.iter().map(Uncertain::name).collect();
        by.push(&self.varied);
        let mut places = Vec::with_capacity(self.points.len());
        for point in &self.points {
            if view.harmonics > 0 {
                places.push(None);
                continue;
            }
            let there = match self.quick_sensitivities_of(point, &wanted, &by) {
                Ok(there) => place(&seen, &there, uncertain, point.value),
                Err(error) if error.kind() == ErrorKind::Request => return Err(error),
                Err(_) => None,
            };
            places.push(there);
        }
        let mut band = edges(&places);
        if by_logarithm(&seen) {
            for [_, y] in band.edges.iter_mut().flatten() {
                *y = y.exp();
            }
        }
        Ok(band)
    }
}

/// Where an orbit is, with (1) in the chart's own units.
fn place(
    seen: &Seen<'_>,
    there: &Sensitivities,
    uncertain: &[Uncertain],
    value: f64,
) -> Option<Place> {
    let row = there.measured.first()?;
    let (slope, others) = row.by.split_last()?;
    let values = others.iter().zip(&there.values).zip(uncertain);
    let squares = values.map(|((by, value), own)| (by.value * own.of(*value)).powi(2));
    let height = squares.sum::<f64>().sqrt();
    let stretch = seen.varied(1.0);
    let (y, by_value) = if by_logarithm(seen) {
        (row.value.ln(), 1.0 / row.value)
    } else {
        (row.value, 1.0)
    };
    let place = Place {
        at: [seen.varied(value), y],
        height: height * by_value,
        slope: slope.value * by_value / stretch,
    };
    let is_finite = y.is_finite() && place.height.is_finite() && place.slope.is_finite();
    is_finite.then_some(place)
}

/// Whether what is shown is on an axis of logarithms, decibels among them.
fn by_logarithm(seen: &Seen<'_>) -> bool {
    seen.scale != Scale::Linear
}

/// Extent of finite numbers.
fn extent(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if high > low { high - low } else { 1.0 }
}

/// A place in units of the axes' lengths.
#[derive(Debug, Clone, Copy)]
struct Scaled {
    at: [f64; 2],
    /// Across the curve, of length one, on the same side all along it.
    across: [f64; 2],
    /// (1)
    width: f64,
}

/// Both edges of the band.
fn edges(places: &[Option<Place>]) -> Band {
    let known = || places.iter().flatten();
    let lengths = [0, 1].map(|axis| extent(known().map(|place| place.at[axis])));
    let scaled = scaled(places, lengths);
    let nothing = [f64::NAN; 2];
    let mut band = Band {
        edges: [vec![nothing; places.len()], vec![nothing; places.len()]],
        bent: 0,
        missing: places.iter().filter(|place| place.is_none()).count(),
    };
    for (index, place) in scaled.iter().enumerate() {
        let Some(Scaled { at, across, width }) = *place else {
            continue;
        };
        if bends(&scaled, index) {
            band.bent += 1;
            continue;
        }
        for (edge, side) in band.edges.iter_mut().zip([width, -width]) {
            let moved = [at[0] + side * across[0], at[1] + side * across[1]];
            edge[index] = [moved[0] * lengths[0], moved[1] * lengths[1]];
        }
    }
    band
}

fn scaled(places: &[Option<Place>], lengths: [f64; 2]) -> Vec<Option<Scaled>> {
    let mut before: Option<[f64; 2]> = None;
    let scaled = places.iter().map(|place| {
        let place = place.as_ref()?;
        let slope = place.slope * lengths[0] / lengths[1];
        let along = slope.hypot(1.0);
        let mut across = [-slope / along, 1.0 / along];
        if before.is_some_and(|before| dot(before, across) < 0.0) {
            across = across.map(|x| -x);
        }
        before = Some(across);
        Some(Scaled {
            at: [place.at[0] / lengths[0], place.at[1] / lengths[1]],
            across,
            width: place.height / lengths[1] / along,
        })
    });
    scaled.collect()
}

/// Whether the curve turns within the width of its band, as it does beside a place where it turns sharply.
fn bends(places: &[Option<Scaled>], index: usize) -> bool {
    let Some(own) = places[index] else {
        return false;
    };
    let turns = |others: &mut dyn Iterator<Item = &Option<Scaled>>| {
        let (mut passed, mut last) = (0.0, own.at);
        for other in others.map_while(|other| other.as_ref()) {
            passed += (other.at[0] - last[0]).hypot(other.at[1] - last[1]);
            last = other.at;
            if passed > own.width {
                return false;
            }
            if dot(own.across, other.across) < BENT.cos() {
                return true;
            }
        }
        false
    };
    turns(&mut places[index + 1..].iter()) || turns(&mut places[..index].iter().rev())
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl Band {
    /// Puts it behind the curves of a chart, and says below where there is none.
    #[must_use]
    pub fn on(self, chart: Chart, label: &str) -> Chart {
        let (bent, missing) = (self.bent, self.missing);
        let mut chart = chart.band(label, self.edges);
        if bent > 0 {
            chart = chart.remark(format!(
                "no band at {bent} orbits: the curve bends within its width, and first order says nothing there"
            ));
        }
        if missing > 0 {
            chart = chart.remark(format!(
                "no band at {missing} orbits, which have no derivatives"
            ));
        }
        chart
    }
}
