//! Which values each variant has: known from its number alone, so that any part of a study can be computed by itself.
//!
//! A design is a way from the number of a variant to a point of the unit cube; [`Distribution`] makes values of it.
//!
//! Sources: `McKay`, Beckman and Conover (1979), A comparison of three methods for selecting values of input variables; Sobol (1967), with
//! the direction numbers of Joe and Kuo (2008), and the digital shift of L'Ecuyer and Lemieux (2002), Recent advances in randomized
//! quasi-Monte Carlo methods. Point `i` of the sequence is
//!
//! ```text
//! x_i = shift xor v_1 g_1 xor v_2 g_2 xor ...,    g = i xor (i >> 1)                                          (1)
//! ```

use chacha20::ChaCha8Rng;
use rand::seq::SliceRandom;
use rand::{Rng, SeedableRng};
use sobol::Sobol;
use sobol::params::JoeKuoD6;

use crate::error::StudyError;
use crate::plan::{Design, Variants};
use crate::spread::{Distribution, Spread};

/// The variants of a study.
#[derive(Debug, Clone)]
pub(crate) struct Designed {
    /// Names of what varies.
    pub(crate) names: Vec<String>,
    /// How many there are.
    pub(crate) count: usize,
    way: Way,
}

#[derive(Debug, Clone)]
enum Way {
    /// The values of every side.
    Grid(Vec<Vec<f64>>),
    /// The values of every variant.
    List(Vec<Vec<f64>>),
    Cube {
        cube: Cube,
        distributions: Vec<Distribution>,
    },
}

/// Points of the unit cube.
#[derive(Debug, Clone)]
enum Cube {
    /// For each dimension the part that a variant is in.
    Latin {
        seed: u64,
        parts: Vec<Vec<u32>>,
    },
    /// For each dimension the direction numbers, and the shift.
    Sobol {
        directions: Vec<Vec<u64>>,
        shift: Vec<u64>,
    },
    Random {
        seed: u64,
    },
}

/// More variants than this cannot be counted by the names of their files.
const MOST: usize = 1 << 32;
/// Places of a Latin hypercube, one a variant and parameter, that are held: 256 MiB.
const MOST_PLACES: usize = 1 << 26;
/// Dimensions that there are direction numbers of.
const DIMENSIONS: usize = 100;
/// Streams of random numbers: those of variants have their number, those of dimensions begin here.
const OF_DIMENSIONS: u64 = 1 << 40;

impl Designed {
    /// Of what a study file says, with `order` for the names; a list is read already.
    ///
    /// # Errors
    /// What cannot be used.
    pub(crate) fn new(
        variants: &Variants,
        seed: u64,
        order: impl Fn(&str) -> usize,
        list: Option<List>,
    ) -> Result<Self, StudyError> {
        if let Some(list) = list {
            return Self::list(variants, list);
        }
        if variants.design == Design::List {
            return Err(StudyError::value("variants.file", "a list needs a table"));
        }
        if variants.file.is_some() {
            let message = "a table is for the design `list`";
            return Err(StudyError::value("variants.file", message));
        }
        let mut names: Vec<String> = variants.over.keys().cloned().collect();
        names.sort_by_key(|name| order(name));
        let over: Vec<&Spread> = names.iter().map(|name| &variants.over[name]).collect();
        let of = |name: &String, message: String| {
            StudyError::value(format!("variants.over.{name}"), message)
        };
        if variants.design == Design::Grid {
            return Self::grid(variants, names, &over);
        }
        let count = counted(variants)?;
        if names.is_empty() {
            return Err(StudyError::value("variants.over", "nothing varies"));
        }
        let distributions = names
            .iter()
            .zip(&over)
            .map(|(name, spread)| spread.distribution().map_err(|message| of(name, message)));
        let distributions: Vec<Distribution> = distributions.collect::<Result<_, _>>()?;
        let cube = Cube::new(variants.design, seed, count, names.len())?;
        Ok(Self {
            names,
            count,
            way: Way::Cube {
                cube,
                distributions,
            },
        })
    }

    fn list(variants: &Variants, list: List) -> Result<Self, StudyError> {
        if variants.design != Design::List || !variants.over.is_empty() {
            let message =
                "a table says all variants: leave out `over`, and write design = \"list\"";
            return Err(StudyError::value("variants", message));
        }
        if list.rows.is_empty() {
            return Err(StudyError::value("variants.file", "the table has no rows"));
        }
        let count = variants.count.unwrap_or(list.rows.len());
        if count > list.rows.len() {
            let message = format!(
                "count = {count}, and the table has {} rows",
                list.rows.len()
            );
            return Err(StudyError::value("variants.count", message));
        }
        Ok(Self {
            names: list.names,
            count,
            way: Way::List(list.rows),
        })
    }

    fn grid(variants: &Variants, names: Vec<String>, over: &[&Spread]) -> Result<Self, StudyError> {
        if variants.count.is_some() {
            let message = "the values of a grid say how many variants there are";
            return Err(StudyError::value("variants.count", message));
        }
        let sides = names.iter().zip(over).map(|(name, spread)| {
            let side = spread.side();
            side.map_err(|message| StudyError::value(format!("variants.over.{name}"), message))
        });
        let sides: Vec<Vec<f64>> = sides.collect::<Result<_, _>>()?;
        let count = sides
            .iter()
            .try_fold(1_usize, |count, side| count.checked_mul(side.len()))
            .filter(|count| *count <= MOST)
            .ok_or_else(|| StudyError::value("variants.over", "too many variants"))?;
        Ok(Self {
            names,
            count,
            way: Way::Grid(sides),
        })
    }

    /// The values of a variant, by its number from zero on.
    pub(crate) fn values(&self, index: usize) -> Vec<f64> {
        match &self.way {
            Way::Grid(sides) => {
                let mut rest = index;
                let mut values: Vec<f64> = sides
                    .iter()
                    .rev()
                    .map(|side| {
                        let value = side[rest % side.len()];
                        rest /= side.len();
                        value
                    })
                    .collect();
                values.reverse();
                values
            }
            Way::List(rows) => rows[index].clone(),
            Way::Cube {
                cube,
                distributions,
            } => {
                let point = cube.point(index, self.count, distributions.len());
                let pairs = distributions.iter().zip(point);
                pairs.map(|(of, part)| of.value(part)).collect()
            }
        }
    }

    /// One variant of the same parameters.
    pub(crate) fn one(&self, values: Vec<f64>) -> Self {
        Self {
            names: self.names.clone(),
            count: 1,
            way: Way::List(vec![values]),
        }
    }

    /// Mean and standard deviation of everything that varies, where it has a distribution.
    pub(crate) fn moments(&self) -> Option<Vec<[f64; 2]>> {
        match &self.way {
            Way::Cube { distributions, .. } => {
                Some(distributions.iter().map(Distribution::moments).collect())
            }
            _ => None,
        }
    }

    /// The side of a grid over one parameter, with its name.
    pub(crate) fn side(&self) -> Option<(&str, &[f64])> {
        match (&self.way, &self.names[..]) {
            (Way::Grid(sides), [name]) => Some((name, &sides[0])),
            _ => None,
        }
    }

    /// All values that are known before, with the name of what has them.
    pub(crate) fn known<'d>(
        &'d self,
        variants: &'d Variants,
    ) -> Box<dyn Iterator<Item = (&'d str, f64)> + 'd> {
        if let Way::List(rows) = &self.way {
            let of_row = |row: &'d Vec<f64>| {
                let names = self.names.iter().map(String::as_str);
                names.zip(row.iter().copied())
            };
            return Box::new(rows[..self.count].iter().flat_map(of_row));
        }
        let over = variants.over.iter();
        Box::new(over.flat_map(|(name, spread)| {
            spread
                .ends()
                .into_iter()
                .map(move |end| (name.as_str(), end))
        }))
    }
}

fn counted(variants: &Variants) -> Result<usize, StudyError> {
    let count = variants
        .count
        .ok_or_else(|| StudyError::value("variants.count", "how many variants are there to be?"))?;
    if !(1..=MOST).contains(&count) {
        let message = format!("{count} is not between 1 and {MOST}");
        return Err(StudyError::value("variants.count", message));
    }
    Ok(count)
}

impl Cube {
    fn new(design: Design, seed: u64, count: usize, dimensions: usize) -> Result<Self, StudyError> {
        match design {
            Design::LatinHypercube => {
                let places = count.saturating_mul(dimensions);
                if places > MOST_PLACES {
                    let message = format!(
                        "a Latin hypercube of {count} variants over {dimensions} parameters has {places} places, more than {MOST_PLACES}: take design = \"sobol\""
                    );
                    return Err(StudyError::value("variants.count", message));
                }
                let parts = (0..dimensions).map(|dimension| {
                    let mut parts: Vec<u32> = (0..count as u64).map(|part| part as u32).collect();
                    parts.shuffle(&mut stream(seed, OF_DIMENSIONS + dimension as u64));
                    parts
                });
                let parts = parts.collect();
                Ok(Self::Latin { seed, parts })
            }
            Design::Sobol => {
                if dimensions > DIMENSIONS {
                    let message = format!(
                        "{dimensions} parameters vary, and the sequence of Sobol is for {DIMENSIONS}"
                    );
                    return Err(StudyError::value("variants.over", message));
                }
                let parameters = JoeKuoD6::minimal();
                let directions =
                    Sobol::<u64>::init_direction_vals::<u32>(dimensions, 64, &parameters);
                let shift = (0..dimensions as u64)
                    .map(|dimension| stream(seed, OF_DIMENSIONS + dimension).next_u64());
                let shift = shift.collect();
                Ok(Self::Sobol { directions, shift })
            }
            _ => Ok(Self::Random { seed }),
        }
    }

    /// The point of a variant, inside the cube.
    fn point(&self, index: usize, count: usize, dimensions: usize) -> Vec<f64> {
        match self {
            Self::Latin { seed, parts } => {
                let mut random = stream(*seed, index as u64);
                let within = |parts: &Vec<u32>| {
                    (f64::from(parts[index]) + unit(random.next_u64())) / count as f64
                };
                parts.iter().map(within).collect()
            }
            Self::Sobol { directions, shift } => {
                let gray = index as u64 ^ (index as u64 >> 1);
                let bits = |directions: &Vec<u64>| {
                    let set = directions.iter().enumerate();
                    let set = set.filter(|(bit, _)| gray >> bit & 1 == 1);
                    set.fold(0, |point, (_, direction)| point ^ direction)
                };
                let pairs = directions.iter().zip(shift);
                pairs.map(|(of, shift)| unit(bits(of) ^ shift)).collect()
            }
            Self::Random { seed } => {
                let mut random = stream(*seed, index as u64);
                (0..dimensions).map(|_| unit(random.next_u64())).collect()
            }
        }
    }
}

/// Random numbers that belong to a seed and a number.
fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}

/// Bits as a number between zero and one, neither of which it is.
fn unit(bits: u64) -> f64 {
    ((bits >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

/// A table of variants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct List {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl List {
    /// From a text with commas, whose first line has names.
    ///
    /// # Errors
    /// What is wrong, with its line.
    pub(crate) fn parse(text: &str) -> Result<Self, StudyError> {
        let failed = |message: String| StudyError::value("variants.file", message);
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let headers = reader
            .headers()
            .map_err(|error| failed(error.to_string()))?;
        let names: Vec<String> = headers.iter().map(str::to_owned).collect();
        for (place, name) in names.iter().enumerate() {
            if names[..place].contains(name) {
                return Err(failed(format!("two columns have the name `{name}`")));
            }
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| failed(error.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |(text, name): (&str, &String)| {
                let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
                value.ok_or_else(|| failed(format!("line {line}: `{text}` is no value for {name}")))
            };
            rows.push(
                record
                    .iter()
                    .zip(&names)
                    .map(number)
                    .collect::<Result<_, _>>()?,
            );
        }
        Ok(Self { names, rows })
    }
}
