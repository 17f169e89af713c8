//! The subcommand `attractors`: what it accepts, what it writes, and how it goes on after it was ended.

mod accepted;
mod resumed;
mod written;

use hertzian::Cancel;
use hertzian_cli::attractors::options::Options;
use hertzian_cli::attractors::run::{Failure, Outcome, run};
use hertzian_cli::command::{Program, Task};
use hertzian_cli::response::progress::Progress;

use crate::folder::Folder;

impl Folder {
    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).expect(name)
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("text")
    }

    /// The bytes of all three results.
    fn results(&self, prefix: &str) -> [Vec<u8>; 3] {
        ["csv", "npy", "svg"].map(|extension| self.read(&format!("{prefix}.{extension}")))
    }
}

/// What the words of a command line ask for.
fn read(arguments: &[&str]) -> Result<Options, clap::Error> {
    let words = ["hertzian", "attractors"]
        .into_iter()
        .chain(arguments.iter().copied());
    match Program::read(words.map(Into::into))?.task {
        Task::Attractors(options) => Ok(*options),
        other => panic!("{other:?}"),
    }
}

fn options(arguments: &[&str]) -> Options {
    read(arguments).expect("arguments that can be parsed")
}

fn run_in(folder: &Folder, prefix: &str, arguments: &[&str]) -> Result<Outcome, Failure> {
    let out = folder.file(prefix);
    let arguments = [arguments, &["--out", &out]].concat();
    let never = Cancel::new();
    run(&options(&arguments), &never, &mut Progress::hidden())
}

/// Rows of a table of numbers, without its head.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().skip(1);
    lines
        .map(|line| {
            line.split(',')
                .map(|x| x.parse().expect("a number"))
                .collect()
        })
        .collect()
}

/// Numbers of an array in NPY format, and its shape as text.
fn array(bytes: &[u8]) -> (String, Vec<f64>) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]])) + 10;
    assert_eq!(length % 64, 0);
    let header = String::from_utf8(bytes[10..length].to_vec()).expect("a header");
    let data = &bytes[length..];
    let numbers = if header.contains("'<f8'") {
        let numbers = data.chunks_exact(8);
        numbers
            .map(|x| f64::from_le_bytes(x.try_into().expect("eight")))
            .collect()
    } else {
        assert!(header.contains("'<i2'"), "{header}");
        let numbers = data.chunks_exact(2);
        numbers
            .map(|x| f64::from(i16::from_le_bytes([x[0], x[1]])))
            .collect()
    };
    (header, numbers)
}
