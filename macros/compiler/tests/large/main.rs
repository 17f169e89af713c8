//! Texts of a million characters, of every kind: each is compiled or refused within two seconds and 200 megabytes, and none
//! fills the stack. `HERTZIAN_SIZES=3000,30000,300000` tries other sizes.
//!
//! Each text is read in a process of its own, so that its memory is its own and a full stack is seen.

mod corpus;

use std::env;
use std::fs;
use std::iter;
use std::num::NonZero;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use hertzian_compiler::interpret::{Coefficients, Family};
use hertzian_compiler::text::{Fault, compile_text};
use quote::quote;

use corpus::CORPUS;

/// Seconds of the processor for one text, read as data or expanded to code.
const MOST_SECONDS: f64 = 2.0;
/// Memory of the process.
const MOST_MEGABYTES: f64 = 200.0;
/// What all messages on one text have together.
const MOST_CHARACTERS: usize = 20_000;

/// Seconds that this thread has computed, where the system says so; else those that have passed.
fn seconds(start: Instant) -> f64 {
    let spent = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = spent.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |spent| spent * 1e-9)
}

/// Most memory used so far, in megabytes, where the system says so.
fn peak() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// Reads a text as far as the data of its laws and coefficients.
fn read(text: &str) -> Result<(), Vec<Fault>> {
    let mut model = compile_text(text)?;
    for law in model.laws.clone() {
        let _ = Family::of(&mut model.dag, &law);
    }
    let _ = Coefficients::of(&mut model);
    Ok(())
}

/// What runs in the process of one text. Without a name in the environment there is nothing to do.
#[test]
fn one_text() {
    let Ok(name) = env::var("HERTZIAN_TEXT") else {
        return;
    };
    let size = env::var("HERTZIAN_SIZE").expect("a size is given with the name");
    let size = size.parse().expect("a size is a number");
    let (_, make) = CORPUS
        .iter()
        .find(|(own, _)| *own == name)
        .expect("it is in the corpus");
    let text = make(size);
    let clock = Instant::now();
    let before = seconds(clock);
    let result = read(&text);
    let after = seconds(clock);
    assert!(
        after - before < MOST_SECONDS,
        "{} s to read",
        after - before
    );
    let said = result.err().unwrap_or_default();
    let characters: usize = said.iter().map(|fault| fault.message.len()).sum();
    assert!(characters < MOST_CHARACTERS, "{characters} characters");
    if let Ok(tokens) = text.parse() {
        let before = seconds(clock);
        let _ = hertzian_compiler::oscillator(&quote!(::hertzian), tokens);
        let expanded = seconds(clock) - before;
        assert!(expanded < MOST_SECONDS, "{expanded} s to expand");
        println!("expanded in {expanded:.2} s");
    }
    let megabytes = peak().unwrap_or_default();
    assert!(megabytes < MOST_MEGABYTES, "{megabytes} MB");
    let first = said.first().map_or("a model", |fault| &fault.message);
    println!(
        "read in {:.2} s, {megabytes:.0} MB: {first}",
        after - before
    );
}

/// Reads the text of a name in a process of its own; why it failed, if it did.
fn judged(name: &str, size: &str) -> Option<String> {
    let output = Command::new(env::current_exe().expect("this program has a path"))
        .args(["--exact", "one_text", "--nocapture"])
        .env("HERTZIAN_TEXT", name)
        .env("HERTZIAN_SIZE", size)
        .output()
        .expect("this program runs again");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{name}, {size}: {said}");
    let why = String::from_utf8_lossy(&output.stderr);
    let why: String = why.chars().take(300).collect();
    (!output.status.success())
        .then(|| format!("{name}, {size} characters: {}, {why}", output.status))
}

#[test]
fn large_texts_are_compiled_or_refused_soon() {
    let sizes = env::var("HERTZIAN_SIZES").unwrap_or_else(|_| "5000,1000000".to_owned());
    let texts: Vec<_> = sizes
        .split(',')
        .flat_map(|size| CORPUS.iter().map(move |(name, _)| (*name, size)))
        .collect();
    let next = AtomicUsize::new(0);
    let work = || {
        let mine = iter::from_fn(|| texts.get(next.fetch_add(1, Ordering::Relaxed)));
        mine.filter_map(|(name, size)| judged(name, size))
            .collect::<Vec<_>>()
    };
    let failed: Vec<String> = thread::scope(|scope| {
        let workers = thread::available_parallelism().map_or(1, NonZero::get);
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        let ended = workers
            .into_iter()
            .map(|worker| worker.join().expect("it ends"));
        ended.flatten().collect()
    });
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
