//! The folder of a study: what it is, and a file for each block of variants that has been computed.
//!
//! A block is written when all of its variants are there, beside its place, and put there when it is on the disk: a run that ends at any
//! moment leaves whole blocks. It begins with a line that says of which study it is, and ends with one that has a checksum of all before, so
//! that a damaged file is recognised:
//!
//! ```text
//! hertzian study 1, block 3 of 157, variants 192 to 255, study 5f0c3a91
//! 192,0.0417,0.0987,event,fold,0,1,1.1383,2e-10,1.41,1e-9,undecided,reached the end of the range
//! ...
//! #seconds 0.031 0.028 ...
//! #end 1c291ca3
//! ```
//!
//! Processes on several machines may write into one folder: each block has a name of its own, and whoever writes it writes the same rows.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use hertzian::Branch;

use crate::error::StudyError;
use crate::plan::Plan;
use crate::study::Prepared;
use crate::table::Value;

/// The folder of a study.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
    /// Checksum of what the study is.
    identity: u32,
}

/// A block of variants as it was kept.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Block {
    /// Rows as they stand in a table with commas, each with the end of its line.
    pub(crate) rows: String,
    /// Time of each variant.
    pub(crate) seconds: Vec<f64>,
}

/// What is wrong with the file of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Missing {
    /// It is not there.
    NotThere,
    /// It is damaged.
    Damaged(String),
}

impl Folder {
    /// The folder of a study, which is made if it is not there.
    ///
    /// # Errors
    /// If it cannot be made or written, or holds the results of another study.
    pub fn open(path: impl AsRef<Path>, study: &Prepared) -> Result<Self, StudyError> {
        let path = path.as_ref().to_path_buf();
        let blocks = path.join(BLOCKS);
        fs::create_dir_all(&blocks).map_err(|error| StudyError::io(&blocks, error))?;
        let folder = Self {
            identity: study.identity(),
            path,
        };
        for (name, text) in study.descriptions() {
            folder.describe(name, &text)?;
        }
        hertzian_file::can_write(blocks.join("0"))
            .map_err(|error| StudyError::io(&blocks, error))?;
        Ok(folder)
    }

    /// A folder that is there and of this study, to be read.
    ///
    /// # Errors
    /// If it is not.
    pub fn existing(path: impl AsRef<Path>, study: &Prepared) -> Result<Self, StudyError> {
        let path = path.as_ref().to_path_buf();
        for (name, text) in study.descriptions() {
            let file = path.join(name);
            let found = fs::read_to_string(&file).map_err(|error| StudyError::io(&file, error))?;
            same(&path, name, &text, &found)?;
        }
        Ok(Self {
            identity: study.identity(),
            path,
        })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what the study is, unless that is there.
    fn describe(&self, name: &str, text: &str) -> Result<(), StudyError> {
        let file = self.path.join(name);
        match fs::read_to_string(&file) {
            Ok(found) => same(&self.path, name, text, &found),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                hertzian_file::write(&file, text).map_err(|error| StudyError::io(file, error))
            }
            Err(error) => Err(StudyError::io(file, error)),
        }
    }

    /// The file of a block.
    pub(crate) fn file(&self, block: usize) -> PathBuf {
        self.path.join(BLOCKS).join(format!("{block:08}.csv"))
    }

    /// Keeps a block.
    pub(crate) fn write(
        &self,
        study: &Prepared,
        number: usize,
        block: &Block,
    ) -> Result<(), StudyError> {
        let mut text = self.head(study, number);
        text += &block.rows;
        text += SECONDS;
        for seconds in &block.seconds {
            text.push(' ');
            text += &Value::Number(*seconds).written();
        }
        text.push('\n');
        let checksum = crc32fast::hash(text.as_bytes());
        text = format!("{text}{END}{checksum:08x}\n");
        let file = self.file(number);
        hertzian_file::write(&file, text).map_err(|error| StudyError::io(file, error))
    }

    /// Keeps a branch of a variant.
    pub(crate) fn write_branch(
        &self,
        variant: usize,
        number: usize,
        branch: &Branch,
    ) -> Result<(), StudyError> {
        let folder = self.path.join(BRANCHES);
        fs::create_dir_all(&folder).map_err(|error| StudyError::io(&folder, error))?;
        let file = folder.join(format!("{variant:08}-{number}.json"));
        let written = branch.write(&file);
        written.map_err(|error| StudyError::io(file, std::io::Error::other(error.to_string())))
    }

    /// A block that was kept.
    pub(crate) fn read(&self, study: &Prepared, number: usize) -> Result<Block, Missing> {
        let bytes = match fs::read(self.file(number)) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Err(Missing::NotThere),
            Err(error) => return Err(Missing::Damaged(error.to_string())),
        };
        let damaged = |why: &str| Missing::Damaged(why.to_owned());
        let text = String::from_utf8(bytes).map_err(|_| damaged("it is no text"))?;
        let end = text
            .rfind(END)
            .ok_or_else(|| damaged("its end is missing"))?;
        let (before, last) = text.split_at(end);
        let checksum = u32::from_str_radix(last[END.len()..].trim_end(), 16).ok();
        if checksum != Some(crc32fast::hash(before.as_bytes())) {
            return Err(damaged("its checksum is another one"));
        }
        let head = self.head(study, number);
        let body = before
            .strip_prefix(head.as_str())
            .ok_or_else(|| damaged("it is of another study"))?;
        let seconds = body
            .rfind(SECONDS)
            .ok_or_else(|| damaged("it has no times"))?;
        let (rows, seconds) = body.split_at(seconds);
        let times = seconds[SECONDS.len()..].split_whitespace();
        let times: Result<Vec<f64>, _> = times.map(str::parse).collect();
        Ok(Block {
            rows: rows.to_owned(),
            seconds: times.map_err(|_| damaged("its times are no numbers"))?,
        })
    }

    /// What the file of a block begins with.
    fn head(&self, study: &Prepared, number: usize) -> String {
        let variants = study.variants_of(number);
        format!(
            "hertzian study 1, block {number} of {}, variants {} to {}, study {:08x}\n",
            study.blocks(),
            variants.start,
            variants.end - 1,
            self.identity
        )
    }
}

const BLOCKS: &str = "blocks";
const BRANCHES: &str = "branches";
const SECONDS: &str = "#seconds";
const END: &str = "#end ";

/// Whether two descriptions are the same.
fn same(folder: &Path, name: &str, expected: &str, found: &str) -> Result<(), StudyError> {
    if expected == found {
        return Ok(());
    }
    let mut lines = expected.lines().zip(found.lines());
    let pair = lines.find(|(expected, found)| expected != found);
    let difference = pair.map_or_else(
        || format!("{name} has another length"),
        |(expected, found)| format!("{name} says `{found}` there, and `{expected}` here"),
    );
    Err(StudyError::Other {
        folder: folder.to_path_buf(),
        difference,
    })
}

impl Block {
    /// Adds the rows of a variant, and its time.
    pub(crate) fn add(&mut self, rows: &[Vec<Value>], time: Duration) {
        let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
        for row in rows {
            // Into memory, which takes everything; all rows have as many values as there are columns.
            let _ = writer.write_record(row.iter().map(Value::written));
        }
        let bytes = writer.into_inner().unwrap_or_default();
        self.rows += &String::from_utf8_lossy(&bytes);
        self.seconds.push(time.as_secs_f64());
    }
}

impl Prepared {
    /// The variants of a block.
    pub(crate) fn variants_of(&self, block: usize) -> std::ops::Range<usize> {
        let from = block * self.block();
        from..(from + self.block()).min(self.count())
    }

    /// What the study is, as files by their names: with them, and the program, it is run again.
    pub(crate) fn descriptions(&self) -> Vec<(&'static str, String)> {
        let columns: Vec<&str> = self
            .columns
            .iter()
            .map(|column| column.name.as_str())
            .collect();
        let version = format!(
            "hertzian {}, {}-{}\ncolumns: {}\n",
            env!("CARGO_PKG_VERSION"),
            std::env::consts::ARCH,
            std::env::consts::OS,
            columns.join(" ")
        );
        let mut all = vec![
            ("study.toml", self.described.clone()),
            (MODEL, self.model.clone()),
            ("version.txt", version),
        ];
        all.extend(self.table.clone().map(|table| (TABLE, table)));
        all
    }

    /// A checksum of all that.
    pub(crate) fn identity(&self) -> u32 {
        let mut hasher = crc32fast::Hasher::new();
        for (name, text) in self.descriptions() {
            hasher.update(name.as_bytes());
            hasher.update(text.as_bytes());
        }
        hasher.finalize()
    }
}

/// A plan as the study file of its folder: without what does not touch the rows.
///
/// # Errors
/// If a study file cannot hold it: without a text it would be taken for another study without one.
pub(crate) fn described(plan: &Plan, has_table: bool) -> Result<String, StudyError> {
    let mut plan = plan.clone();
    plan.results = None;
    plan.formats.clear();
    plan.pictures.clear();
    if Path::new(&plan.model).components().count() > 1 || plan.model.contains('.') {
        MODEL.clone_into(&mut plan.model);
    }
    if has_table {
        plan.variants.file = Some(PathBuf::from(TABLE));
    }
    let written = toml::to_string(&plan);
    written.map_err(|error| StudyError::value("the study", format!("no file holds it: {error}")))
}

const MODEL: &str = "model.txt";
const TABLE: &str = "variants.csv";
