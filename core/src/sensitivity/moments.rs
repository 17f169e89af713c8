//! Extremes, integrals and series of one signal, with their derivatives along directions, and the measures that they make.

use crate::orbit::observe::Measure;

/// Derivatives of two extremes that differ by no more than this part are the same: flows leave less.
const ALIKE: f64 = 1e-6;
/// Two extremes of a symmetric motion differ by no more than so many times what a flow leaves: resonance makes that larger.
const SYMMETRIC: f64 = 100.0;

/// A number, and its derivatives along all directions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slope {
    pub(super) value: f64,
    pub(super) by: Vec<f64>,
}

impl Slope {
    pub(super) fn zero(directions: usize) -> Self {
        Self {
            value: 0.0,
            by: vec![0.0; directions],
        }
    }

    /// A function of several numbers, with its derivatives by them.
    fn of<const N: usize>(parts: [&Self; N], value: f64, slopes: [f64; N]) -> Self {
        let sum = |index: usize| {
            parts
                .iter()
                .zip(slopes)
                .map(|(part, s)| s * part.by[index])
                .sum()
        };
        Self {
            value,
            by: (0..parts[0].by.len()).map(sum).collect(),
        }
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.value *= factor;
        self.by.iter_mut().for_each(|x| *x *= factor);
    }
}

/// What is read off one signal.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    pub(super) largest: Option<Slope>,
    pub(super) smallest: Option<Slope>,
    /// Mean, mean of the square, and the series.
    pub(super) mean: Slope,
    pub(super) square: Slope,
    pub(super) series: Vec<[Slope; 2]>,
    /// It is the force of a contact that never meets.
    pub(super) is_nothing: bool,
}

impl Moments {
    /// Adds a signal with a weight, and with sine and cosine of every harmonic.
    pub(super) fn add(&mut self, value: f64, by: &[f64], weight: f64, waves: &[[f64; 2]]) {
        self.mean.add(value, weight, by, weight);
        self.square
            .add(value * value, weight, by, 2.0 * weight * value);
        for ([cosine, sine], [s, c]) in self.series.iter_mut().zip(waves) {
            cosine.add(value, weight * c, by, weight * c);
            sine.add(value, weight * s, by, weight * s);
        }
    }

    pub(super) fn jump(&mut self, [before, after]: [f64; 2], shifts: &[f64], angle: f64) {
        let jump = before - after;
        self.mean.add(0.0, 0.0, shifts, jump);
        self.square
            .add(0.0, 0.0, shifts, before * before - after * after);
        for (index, [cosine, sine]) in self.series.iter_mut().enumerate() {
            let (s, c) = ((index + 1) as f64 * angle).sin_cos();
            cosine.add(0.0, 0.0, shifts, jump * c);
            sine.add(0.0, 0.0, shifts, jump * s);
        }
    }

    pub(super) fn divide(&mut self, whole: f64) {
        for sum in [&mut self.mean, &mut self.square] {
            sum.scale(1.0 / whole);
        }
        for part in self.series.iter_mut().flatten() {
            part.scale(2.0 / whole);
        }
    }

    /// A harmonic and its amplitude, if that is above a part of the effective value: of one that vanishes, as even ones of a symmetric motion,
    /// neither amplitude nor phase has a derivative.
    fn harmonic(&self, number: usize, vanishes: f64) -> Option<(&[Slope; 2], f64)> {
        let parts = self.series.get(number.checked_sub(1)?)?;
        let amplitude = parts[0].value.hypot(parts[1].value);
        let least = vanishes * self.square.value.max(0.0).sqrt();
        (amplitude > least).then_some((parts, amplitude))
    }

    /// Largest and smallest value, if they are apart by more than a part of their size: at rest any motion has a larger one. What is
    /// nothing stays so.
    fn extremes(&self, vanishes: f64) -> Option<[&Slope; 2]> {
        let (a, b) = (self.largest.as_ref()?, self.smallest.as_ref()?);
        let size = a.value.abs().max(b.value.abs());
        let moves = a.value - b.value > vanishes * size;
        (moves || self.is_nothing).then_some([a, b])
    }

    /// What is asked of the signal; `None` where it has no derivative, or is one of contacts. A derivative that is no number is one to each
    /// side.
    pub(super) fn measure(&self, measure: Measure, vanishes: f64) -> Option<Slope> {
        let rms = || {
            let rms = self.square.value.max(0.0).sqrt();
            (rms > 0.0).then(|| Slope::of([&self.square], rms, [0.5 / rms]))
        };
        Some(match measure {
            Measure::PeakToPeak => {
                let [a, b] = self.extremes(vanishes)?;
                Slope::of([a, b], a.value - b.value, [1.0, -1.0])
            }
            Measure::Maximum => self.extremes(vanishes)?[0].clone(),
            Measure::Minimum => self.extremes(vanishes)?[1].clone(),
            Measure::Mean => self.mean.clone(),
            Measure::Rms => rms()?,
            Measure::CrestFactor => {
                let ([a, b], rms) = (self.extremes(vanishes)?, rms()?);
                let far = farthest(a, b, vanishes);
                let crest = far.value / rms.value;
                Slope::of([&far, &rms], crest, [1.0 / rms.value, -crest / rms.value])
            }
            Measure::Amplitude(harmonic) => {
                let ([c, s], amplitude) = self.harmonic(harmonic, vanishes)?;
                let parts = [c.value / amplitude, s.value / amplitude];
                Slope::of([c, s], amplitude, parts)
            }
            Measure::Phase(harmonic) => {
                let ([c, s], amplitude) = self.harmonic(harmonic, vanishes)?;
                let parts = [-s.value / amplitude.powi(2), c.value / amplitude.powi(2)];
                Slope::of([c, s], s.value.atan2(c.value), parts)
            }
            _ => return None,
        })
    }
}

/// The larger one of the sizes of a largest and a smallest value. Where these are the same within a part, and do not grow alike, it has a
/// derivative to each side and none.
fn farthest(largest: &Slope, smallest: &Slope, vanishes: f64) -> Slope {
    let (a, b) = (largest.value, -smallest.value);
    let is_both = (a - b).abs() <= SYMMETRIC * vanishes * a.abs().max(b.abs());
    let slopes = largest.by.iter().zip(&smallest.by);
    let by = slopes.map(|(&a_slope, smallest)| {
        let b_slope = -smallest;
        let apart = (a_slope - b_slope).abs();
        if is_both && apart > ALIKE * a_slope.abs().max(b_slope.abs()) {
            f64::NAN
        } else if a >= b {
            a_slope
        } else {
            b_slope
        }
    });
    Slope {
        value: a.max(b),
        by: by.collect(),
    }
}

impl Slope {
    /// Adds a value times a weight, and derivatives times another one.
    fn add(&mut self, value: f64, weight: f64, by: &[f64], times: f64) {
        self.value += weight * value;
        self.by
            .iter_mut()
            .zip(by)
            .for_each(|(sum, x)| *sum += times * x);
    }
}
