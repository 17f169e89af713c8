//! One series made ready for evaluation at single phases, with bounds on its derivatives.
//!
//! Without its mean, and scaled by a power of two so that its largest coefficient is near one: no bound overflows or
//! vanishes, whatever the unit of the series, and no digit is lost. With `a_k = hypot(c_k, s_k)`, and since no wave
//! exceeds its amplitude,
//!
//! ```text
//! |x^(n)(tau)| <= M_n = sum_k k^n a_k                                                                         (1)
//! ```
//!
//! Phases are evaluated by powers of `z = exp(i tau)`, four harmonics at a time. An angular error of `z` is an error of
//! the phase, common to all harmonics; Clenshaw's recurrence instead loses digits near `0` and `pi` (Gentleman (1969), An
//! error analysis of Goertzel's (Watt's) method for computing Fourier coefficients).

/// Harmonics evaluated together.
const LANES: usize = 4;

/// Units in the last place, of mean and amplitudes together, within which a value counts as on the level.
const TOLERANCE_ULPS: f64 = 4.0;

#[derive(Debug, Clone, Copy, Default)]
struct Block {
    cosine: [f64; LANES],
    sine: [f64; LANES],
}

/// Bounds (1), and errors of rounding.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bounds {
    pub third: f64,
    pub fourth: f64,
    /// A value closer to the level than this is on neither side.
    pub tolerance: f64,
    /// Error of a value.
    pub value: f64,
    /// Error of a slope.
    pub slope: f64,
}

/// Value, first and second derivative.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    pub x: f64,
    pub slope: f64,
    pub curvature: f64,
}

#[derive(Debug)]
pub(super) struct Waves {
    blocks: Vec<Block>,
    /// Scaled pairs of coefficients up to the highest harmonic that is not zero.
    pairs: Vec<[f64; 2]>,
    mean: f64,
    scale: f64,
    bounds: Bounds,
}

/// The highest harmonic that is not zero.
pub(super) fn highest(series: &[f64]) -> usize {
    let waves = series.get(1..).unwrap_or(&[]).chunks_exact(2);
    let last = waves
        .into_iter()
        .rposition(|pair| pair[0] != 0.0 || pair[1] != 0.0);
    last.map_or(0, |last| last + 1)
}

impl Waves {
    pub fn new(harmonics: usize) -> Self {
        Self {
            blocks: Vec::with_capacity(harmonics.div_ceil(LANES)),
            pairs: Vec::with_capacity(harmonics),
            mean: 0.0,
            scale: 1.0,
            bounds: Bounds::default(),
        }
    }

    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    pub fn pairs(&self) -> &[[f64; 2]] {
        &self.pairs
    }

    /// Takes a series. One that is constant, or not finite, leaves no waves.
    pub fn load(&mut self, series: &[f64], highest: usize) {
        self.pairs.clear();
        self.blocks.clear();
        let Some((&mean, waves)) = series.split_first() else {
            return;
        };
        let Some(scale) = scale(&waves[..2 * highest]).filter(|_| mean.is_finite()) else {
            return;
        };
        (self.mean, self.scale) = (mean, scale);
        let scaled = waves[..2 * highest]
            .chunks_exact(2)
            .map(|pair| [pair[0] * scale, pair[1] * scale]);
        self.pairs.extend(scaled);
        for pairs in self.pairs.chunks(LANES) {
            let mut block = Block::default();
            for (lane, pair) in pairs.iter().enumerate() {
                (block.cosine[lane], block.sine[lane]) = (pair[0], pair[1]);
            }
            self.blocks.push(block);
        }
        self.bound();
    }

    fn bound(&mut self) {
        let (mut m0, mut m1, mut m2, mut m3, mut m4) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut k = 0.0;
        for [c, s] in &self.pairs {
            k += 1.0;
            let amplitude = (c * c + s * s).sqrt();
            m0 += amplitude;
            m1 += k * amplitude;
            m2 += k * k * amplitude;
            m3 += k * k * k * amplitude;
            m4 += k * k * k * k * amplitude;
        }
        let tolerance = TOLERANCE_ULPS * f64::EPSILON * ((self.mean * self.scale).abs() + m0);
        self.bounds = Bounds {
            third: m3,
            fourth: m4,
            tolerance,
            value: tolerance + 4.0 * f64::EPSILON * m1,
            slope: 8.0 * f64::EPSILON * m2,
        };
    }

    /// What the waves have to reach for the series to reach a level.
    pub fn target(&self, level: f64) -> f64 {
        let difference = level - self.mean;
        if difference.is_finite() {
            difference * self.scale
        } else {
            level * self.scale - self.mean * self.scale
        }
    }

    pub fn scaled(&self, length: f64) -> f64 {
        length * self.scale
    }

    pub fn unscaled(&self, length: f64) -> f64 {
        length / self.scale
    }

    pub fn at(&self, tau: f64) -> Jet {
        let (sine, cosine) = tau.sin_cos();
        let (c2, s2) = (cosine * cosine - sine * sine, 2.0 * sine * cosine);
        let (c3, s3) = (c2 * cosine - s2 * sine, s2 * cosine + c2 * sine);
        let (c4, s4) = (c2 * c2 - s2 * s2, 2.0 * s2 * c2);
        let mut c = [cosine, c2, c3, c4];
        let mut s = [sine, s2, s3, s4];
        let mut k = [1.0, 2.0, 3.0, 4.0];
        let (mut x, mut slope, mut curvature) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for block in &self.blocks {
            for lane in 0..LANES {
                let (a, b) = (block.cosine[lane], block.sine[lane]);
                let in_phase = a * c[lane] + b * s[lane];
                x[lane] += in_phase;
                slope[lane] += k[lane] * (b * c[lane] - a * s[lane]);
                curvature[lane] -= k[lane] * k[lane] * in_phase;
                (c[lane], s[lane]) = (c[lane] * c4 - s[lane] * s4, s[lane] * c4 + c[lane] * s4);
                k[lane] += LANES as f64;
            }
        }
        let sum = |lanes: [f64; LANES]| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
        Jet {
            x: sum(x),
            slope: sum(slope),
            curvature: sum(curvature),
        }
    }
}

/// The power of two that brings the largest coefficient near one; nothing if all are zero or one is not finite.
fn scale(coefficients: &[f64]) -> Option<f64> {
    const INFINITE: u64 = 2047;
    // Positive numbers are in the order of their bits, infinities and NaN last.
    let largest = coefficients.iter().map(|x| x.abs().to_bits()).max()?;
    let exponent = largest >> 52;
    let inverse = (2046 - exponent.min(2046)).clamp(1, 2046);
    (largest > 0 && exponent < INFINITE).then(|| f64::from_bits(inverse << 52))
}
