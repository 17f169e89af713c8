//! One table of all blocks, whoever computed them: block by block, so that it takes the same memory for ten rows and for ten million.

use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::StudyError;
use crate::folder::{Block, Folder, Missing};
use crate::plan::Format;
use crate::study::Prepared;
use crate::table::{ColumnKind, Value};
use crate::write;

/// What came of a merge.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Merged {
    /// Rows of the table.
    pub rows: usize,
    /// Variants that are in it.
    pub variants: usize,
    /// Variants that could not be computed.
    pub failed: usize,
    /// Variants of blocks that are not there, as ranges from the first to the last.
    pub missing: Vec<[usize; 2]>,
    /// What is said of files that are damaged; their variants are missing.
    pub damaged: Vec<String>,
    /// The files that were written.
    pub files: Vec<PathBuf>,
    /// Seconds of all variants together, and of the slowest.
    pub seconds: [f64; 2],
    /// Bytes of the longest text of each column.
    pub(crate) widths: Vec<usize>,
}

/// Where blocks are looked for.
pub(crate) struct Source<'s> {
    pub(crate) study: &'s Prepared,
    folders: &'s [Folder],
}

impl<'s> Source<'s> {
    pub(crate) fn new(study: &'s Prepared, folders: &'s [Folder]) -> Self {
        Self { study, folders }
    }

    /// A block from the first folder that has it whole.
    fn read(&self, number: usize) -> Result<Block, Vec<String>> {
        let mut damaged = Vec::new();
        for folder in self.folders {
            match folder.read(self.study, number) {
                Ok(block) => return Ok(block),
                Err(Missing::NotThere) => {}
                Err(Missing::Damaged(why)) => {
                    damaged.push(format!("{}: {why}", folder.file(number).display()));
                }
            }
        }
        Err(damaged)
    }

    /// Shows every row of every block that is there.
    pub(crate) fn each(&self, mut see: impl FnMut(Vec<Value>) -> io::Result<()>) -> io::Result<()> {
        for number in 0..self.study.blocks() {
            if let Ok(block) = self.read(number) {
                for row in parsed(self.study, &block.rows)? {
                    see(row)?;
                }
            }
        }
        Ok(())
    }
}

/// The rows of a block.
fn parsed(study: &Prepared, rows: &str) -> io::Result<Vec<Vec<Value>>> {
    let reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(rows.as_bytes());
    let wrong = || io::Error::new(io::ErrorKind::InvalidData, "a row is no row of this study");
    let records = reader.into_records().map(|record| {
        let record = record.map_err(io::Error::other)?;
        if record.len() != study.columns.len() {
            return Err(wrong());
        }
        let values = record.iter().zip(&study.columns);
        let values = values.map(|(text, column)| Value::read(text, column.kind).ok_or_else(wrong));
        values.collect::<io::Result<Vec<Value>>>()
    });
    records.collect()
}

impl Prepared {
    /// Writes the table of all blocks of these folders into the first one, in every form that the study asks for, and the times of the
    /// variants. What is missing is left out and said.
    ///
    /// # Errors
    /// If a table cannot be written.
    pub fn merge(&self, folders: &[Folder]) -> Result<Merged, StudyError> {
        let Some(into) = folders.first().map(|folder| folder.path().to_path_buf()) else {
            return Ok(Merged::default());
        };
        let source = Source::new(self, folders);
        let mut merged = self.survey(&source, &into)?;
        for &format in &self.plan.formats {
            let path = into.join(format!("results.{}", format.extension()));
            let written = match format {
                // The same text as in the blocks.
                Format::Csv => filled(&path, |to| write::csv(&source, to)),
                Format::Jsonl => filled(&path, |to| write::json_lines(&source, to)),
                Format::Npy => filled(&path, |to| write::npy(&source, &merged, to)),
                #[cfg(feature = "parquet")]
                Format::Parquet => filled(&path, |to| crate::parquet::parquet(&source, to)),
                #[cfg(not(feature = "parquet"))]
                Format::Parquet => Err(io::ErrorKind::Unsupported.into()),
            };
            written.map_err(|error| StudyError::io(&path, error))?;
            merged.files.push(path);
        }
        Ok(merged)
    }

    /// Goes through all blocks once: writes the times, and counts.
    fn survey(&self, source: &Source<'_>, into: &Path) -> Result<Merged, StudyError> {
        let mut merged = Merged {
            widths: vec![1; self.columns.len()],
            ..Merged::default()
        };
        let path = into.join("times.csv");
        let written = filled(&path, |to| {
            writeln!(to, "variant,seconds")?;
            for number in 0..self.blocks() {
                match source.read(number) {
                    Ok(block) => {
                        let first = self.variants_of(number).start;
                        for (place, seconds) in block.seconds.iter().enumerate() {
                            writeln!(to, "{},{seconds:?}", first + place)?;
                        }
                        merged.count(self, &block)?;
                    }
                    Err(damaged) => {
                        merged.damaged.extend(damaged);
                        merged.miss(self, number);
                    }
                }
            }
            Ok(())
        });
        written.map_err(|error| StudyError::io(&path, error))?;
        merged.files.push(path);
        Ok(merged)
    }
}

/// Writes a file through a buffer.
fn filled(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> io::Result<()> {
    hertzian_file::write_with(path, |file| {
        let mut to = BufWriter::new(file);
        fill(&mut to)?;
        to.flush()
    })
}

impl Merged {
    fn count(&mut self, study: &Prepared, block: &Block) -> io::Result<()> {
        let about = study.designed.names.len() + 1;
        let mut last = None;
        for row in parsed(study, &block.rows)? {
            self.rows += 1;
            for ((width, value), column) in self.widths.iter_mut().zip(&row).zip(&study.columns) {
                if let (Value::Text(text), ColumnKind::Text) = (value, column.kind) {
                    *width = (*width).max(text.len());
                }
            }
            if row[about] == Value::text("failed") && last.as_ref() != Some(&row[0]) {
                self.failed += 1;
                last = Some(row[0].clone());
            }
        }
        self.variants += block.seconds.len();
        self.seconds[0] += block.seconds.iter().sum::<f64>();
        self.seconds[1] = block
            .seconds
            .iter()
            .copied()
            .fold(self.seconds[1], f64::max);
        Ok(())
    }

    /// A block is not there.
    fn miss(&mut self, study: &Prepared, number: usize) {
        let variants = study.variants_of(number);
        let last = variants.end - 1;
        match self.missing.last_mut() {
            Some(range) if range[1] + 1 == variants.start => range[1] = last,
            _ => self.missing.push([variants.start, last]),
        }
    }

    /// How many variants are missing.
    pub fn lost(&self) -> usize {
        self.missing.iter().map(|[from, to]| to - from + 1).sum()
    }
}

impl fmt::Display for Merged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            rows,
            variants,
            failed,
            seconds: [all, slowest],
            ..
        } = self;
        writeln!(
            f,
            "variants   {variants}, of which {failed} could not be computed"
        )?;
        writeln!(f, "rows       {rows}")?;
        let mean = all / (*variants).max(1) as f64;
        writeln!(
            f,
            "time       {all:.1} s of processors; {mean:.4} s a variant, the slowest {slowest:.3} s"
        )?;
        for file in &self.files {
            writeln!(f, "written    {}", file.display())?;
        }
        Ok(())
    }
}
