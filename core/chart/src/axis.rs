//! Ranges, ticks and their labels.

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm. Values that are not positive are not drawn.
    Logarithmic,
    /// By their logarithm too, with ticks in decibels: twenty times that to the base ten. What stands for one is said by the label.
    Decibel,
}

/// The part of an axis that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    scale: Scale,
    low: f64,
    high: f64,
}

/// Marks along an axis; positions from 0 to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Ticks {
    pub(super) labelled: Vec<(f64, String)>,
    pub(super) minor: Vec<f64>,
    /// Labels are to be multiplied by ten to this power.
    pub(super) power: i32,
}

/// Which powers of ten labels may be divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Powers {
    /// That of the largest number, where it has many zeros.
    Any,
    /// Those that prefixes of units stand for.
    Thousands,
}

impl Powers {
    /// That for numbers of about ten to the power of `size`.
    fn of(self, size: i32) -> i32 {
        match self {
            Self::Thousands if (-1..4).contains(&size) => 0,
            Self::Thousands if (-12..15).contains(&size) => 3 * size.div_euclid(3),
            _ if (-3..5).contains(&size) => 0,
            _ => size.clamp(-300, 300),
        }
    }
}

impl Range {
    /// A range that shows all values, with a margin; from zero where that wastes little and is asked for.
    pub(super) fn of(scale: Scale, values: impl Iterator<Item = f64>, from_zero: bool) -> Self {
        let coordinates = values.filter_map(|value| coordinate(scale, value));
        let (low, high) = coordinates.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| {
            (low.min(u), high.max(u))
        });
        if low > high {
            let (low, high) = (0.0, 1.0);
            return Self { scale, low, high };
        }
        let size = low.abs().max(high.abs());
        // A range of one value, or of values that differ by rounding alone, is opened.
        let (low, high) = if high - low > 1e-9 * size {
            (low, high)
        } else if size > 0.0 {
            (low - 0.1 * size, high + 0.1 * size)
        } else {
            (-1.0, 1.0)
        };
        let margin = 0.02 * (high - low);
        let zero = from_zero && scale == Scale::Linear && low >= 0.0 && low < 0.3 * high;
        let low = if zero { 0.0 } else { low - margin };
        Self {
            scale,
            low,
            high: high + margin,
        }
    }

    /// A range with these ends; opened if they are the same, or one of them has no place on such an axis.
    pub(super) fn between(scale: Scale, [from, to]: [f64; 2]) -> Self {
        if let (Some(a), Some(b)) = (coordinate(scale, from), coordinate(scale, to))
            && a != b
        {
            let (low, high) = (a.min(b), a.max(b));
            return Self { scale, low, high };
        }
        Self::of(scale, [from, to].into_iter(), false)
    }

    /// Where a value is on the axis: 0 at the low end, 1 at the high end. `None` if it cannot be drawn.
    pub(super) fn position(&self, value: f64) -> Option<f64> {
        let position = (coordinate(self.scale, value)? - self.low) / (self.high - self.low);
        // Far outside, the exact place does not matter, but the arithmetic of clipping must not overflow.
        Some(position.clamp(-1e6, 1e6))
    }

    /// A value divided by a power of ten, with as many digits as tell it from what is a thousandth of the range beside it.
    pub(super) fn written(&self, value: f64, power: i32) -> String {
        let part = 1e-3 * (self.high - self.low);
        let beside = match self.scale {
            Scale::Linear => part,
            Scale::Logarithmic | Scale::Decibel => value.abs() * (10_f64.powf(part) - 1.0),
        };
        let unit = 10_f64.powi(power);
        let decimals = (-(beside / unit).log10().floor()).clamp(0.0, 17.0) as usize;
        format!("{:.decimals$}", value / unit).replace('-', "−")
    }

    /// At most about `count` labelled ticks, and minor ones between them.
    pub(super) fn ticks(&self, count: usize, powers: Powers) -> Ticks {
        let by_value = |value: f64| self.position(value);
        match self.scale {
            Scale::Linear => even_ticks([self.low, self.high], count, powers, by_value),
            Scale::Logarithmic if self.high - self.low < 0.9 => {
                let ends = [self.low, self.high].map(|end| 10_f64.powf(end));
                even_ticks(ends, count, powers, by_value)
            }
            Scale::Logarithmic => self.decades(count),
            Scale::Decibel => even_ticks([self.low, self.high], count, powers, |level| {
                Some((level - self.low) / (self.high - self.low))
            }),
        }
    }

    /// Ticks at powers of ten, and at 2 and 5 times those where there would be few.
    fn decades(&self, count: usize) -> Ticks {
        let decades = (self.low.floor() as i32)..=(self.high.floor() as i32);
        let few = self.high - self.low < 3.0;
        let every = ((self.high - self.low) / count.max(2) as f64).ceil() as i32;
        let mut ticks = Ticks::default();
        for decade in decades {
            for digit in 1..10 {
                let coordinate = f64::from(decade) + f64::from(digit).log10();
                let position = (coordinate - self.low) / (self.high - self.low);
                if !(0.0..=1.0).contains(&position) {
                    continue;
                }
                if (few && matches!(digit, 2 | 5)) || (digit == 1 && decade.rem_euclid(every) == 0)
                {
                    ticks.labelled.push((position, power_label(digit, decade)));
                } else if digit == 1 || every == 1 {
                    ticks.minor.push(position);
                }
            }
        }
        ticks
    }
}

/// Ticks at round numbers between two ends, each at the place that it has on the axis.
fn even_ticks(
    [low, high]: [f64; 2],
    count: usize,
    powers: Powers,
    place: impl Fn(f64) -> Option<f64>,
) -> Ticks {
    let step = Step::of((high - low) / count.max(2) as f64);
    let size = low.abs().max(high.abs()).log10().floor() as i32;
    let power = powers.of(size);
    let decimals = (power - step.power).clamp(0, 17) as usize;
    let multiples = |step: f64| ((low / step).ceil() as i64)..=((high / step).floor() as i64);
    let labelled = multiples(step.size())
        .filter_map(|i| {
            let value = i as f64 * step.size();
            let label = format!("{:.decimals$}", value / 10_f64.powi(power));
            Some((place(value)?, label.replace('-', "−")))
        })
        .collect();
    let minor = step.size() / step.parts();
    Ticks {
        labelled,
        minor: multiples(minor)
            .filter_map(|i| place(i as f64 * minor))
            .collect(),
        power,
    }
}

/// A distance of ticks: 1, 2 or 5 times a power of ten.
struct Step {
    digit: f64,
    power: i32,
}

impl Step {
    /// The smallest step that is at least this large.
    fn of(least: f64) -> Self {
        let power = least.log10().floor().clamp(-300.0, 300.0) as i32;
        let leading = least / 10_f64.powi(power);
        let (digit, power) = match leading {
            ..=1.0 => (1.0, power),
            ..=2.0 => (2.0, power),
            ..=5.0 => (5.0, power),
            _ => (1.0, power + 1),
        };
        Self { digit, power }
    }

    fn size(&self) -> f64 {
        // Dividing by a whole power of ten rounds once; multiplying by a negative one would round twice.
        if self.power < 0 {
            self.digit / 10_f64.powi(-self.power)
        } else {
            self.digit * 10_f64.powi(self.power)
        }
    }

    /// Into how many parts minor ticks divide it.
    fn parts(&self) -> f64 {
        if self.digit == 2.0 { 4.0 } else { 5.0 }
    }
}

fn coordinate(scale: Scale, value: f64) -> Option<f64> {
    let coordinate = match scale {
        Scale::Linear => value,
        Scale::Logarithmic if value > 0.0 => value.log10(),
        Scale::Decibel if value > 0.0 => 20.0 * value.log10(),
        Scale::Logarithmic | Scale::Decibel => return None,
    };
    // Beyond that, the width of the range may overflow.
    (coordinate.abs() < 1e300).then_some(coordinate)
}

fn power_label(digit: i32, power: i32) -> String {
    match (digit, power) {
        (_, -2..=3) => format!("{}", f64::from(digit) * 10_f64.powi(power)),
        (1, _) => format!("10{}", superscript(power)),
        _ => format!("{digit}·10{}", superscript(power)),
    }
}

/// A whole number in raised digits.
pub(super) fn superscript(number: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32('⁰' as u32 + (c as u32 - '0' as u32)).unwrap_or(c),
    };
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, values: &[f64]) -> (Vec<String>, i32) {
        let ticks = Range::of(scale, values.iter().copied(), false).ticks(6, Powers::Any);
        let labels = ticks.labelled.into_iter().map(|(position, label)| {
            assert!((0.0..=1.0).contains(&position), "{position}");
            label
        });
        (labels.collect(), ticks.power)
    }

    #[test]
    fn chosen_ends_are_kept_on_both_scales() {
        let linear = Range::between(Scale::Linear, [0.0, 4.0]);
        assert_eq!(linear.position(1.0), Some(0.25));
        let decades = Range::between(Scale::Logarithmic, [100.0, 1.0]);
        assert!((decades.position(10.0).unwrap() - 0.5).abs() < 1e-15);
        // Zero has no place there: only the other end is shown.
        let half = Range::between(Scale::Logarithmic, [0.0, 10.0]);
        assert!((half.position(10.0).unwrap() - 0.5).abs() < 1e-12);
    }

    #[test]
    fn values_have_the_digits_that_a_chart_shows() {
        let linear = Range::between(Scale::Linear, [0.0, 2.5]);
        assert_eq!(linear.written(-1.234_56, 0), "−1.235");
        assert_eq!(linear.written(1.234_56, -3), "1235");
        let decades = Range::between(Scale::Logarithmic, [1e-2, 1e2]);
        assert_eq!(decades.written(0.012_345_6, 0), "0.0123");
        assert_eq!(decades.written(98.765_4, 0), "98.8");
    }

    #[test]
    fn linear_ticks_are_round_numbers() {
        let (found, power) = labels(Scale::Linear, &[0.6, 1.6]);
        assert_eq!(found, ["0.6", "0.8", "1.0", "1.2", "1.4", "1.6"]);
        assert_eq!(power, 0);
        let (found, power) = labels(Scale::Linear, &[-2e-7, 3e-7]);
        assert_eq!(found, ["−2", "−1", "0", "1", "2", "3"]);
        assert_eq!(power, -7);
    }

    #[test]
    fn numbers_with_a_prefix_are_between_one_and_a_thousand() {
        for (high, expected, power) in [
            (2.5e-7, ["0", "100", "200"], -9),
            (2.5e-2, ["0", "10", "20"], -3),
            (0.25, ["0.0", "0.1", "0.2"], 0),
            (2500.0, ["0", "1000", "2000"], 0),
            (2.5e4, ["0", "10", "20"], 3),
            (2.5e-30, ["0", "1", "2"], -30),
        ] {
            let range = Range::between(Scale::Linear, [0.0, high]);
            let ticks = range.ticks(3, Powers::Thousands);
            let found: Vec<String> = ticks.labelled.into_iter().map(|(_, label)| label).collect();
            assert_eq!(
                (&found[..], ticks.power),
                (&expected.map(str::to_owned)[..], power),
                "{high}"
            );
        }
    }

    #[test]
    fn logarithmic_ticks_are_decades() {
        assert_eq!(
            labels(Scale::Logarithmic, &[1e-4, 1.0]).0,
            ["10⁻⁴", "10⁻³", "0.01", "0.1", "1"]
        );
        assert_eq!(
            labels(Scale::Logarithmic, &[0.1, 3.0]).0,
            ["0.1", "0.2", "0.5", "1", "2"]
        );
    }

    #[test]
    fn decibels_are_twenty_times_the_logarithm() {
        let range = Range::between(Scale::Decibel, [0.1, 1000.0]);
        // 1 is 0 dB, 10 is 20 dB, and twice as much is 6.02 dB more.
        assert!((range.position(1.0).unwrap() - 0.25).abs() < 1e-15);
        assert!((range.position(10.0).unwrap() - 0.5).abs() < 1e-15);
        let twice = range.position(20.0).unwrap() - range.position(10.0).unwrap();
        assert!((80.0 * twice - 6.020_599_913_279_624).abs() < 1e-12);
        let ticks = range.ticks(4, Powers::Any).labelled;
        let found: Vec<(i32, &str)> = ticks
            .iter()
            .map(|(place, label)| ((100.0 * place).round() as i32, label.as_str()))
            .collect();
        assert_eq!(
            found,
            [(0, "−20"), (25, "0"), (50, "20"), (75, "40"), (100, "60")]
        );
        assert_eq!(range.position(0.0), None);
    }

    #[test]
    fn any_values_give_a_range() {
        let extreme = [
            vec![],
            vec![0.0],
            vec![-3.0],
            vec![f64::NAN, f64::INFINITY],
            vec![f64::MAX, f64::MIN],
            vec![5e-324, 1e-320],
            vec![1.0, 1.0 + f64::EPSILON],
        ];
        for values in extreme {
            for scale in [Scale::Linear, Scale::Logarithmic, Scale::Decibel] {
                let range = Range::of(scale, values.iter().copied(), true);
                assert!(range.low < range.high, "{values:?}");
                let ticks = range.ticks(6, Powers::Any);
                assert!(ticks.labelled.len() < 20, "{values:?}");
                assert!(ticks.minor.len() < 100, "{values:?}");
            }
        }
    }
}
