//! Letters as outlines, so that a chart looks the same everywhere and needs no font of its reader.
//!
//! The outlines are those of `DejaVu` Sans (licence in `glyphs.license`), as `docs/glyphs.py` writes them: in units of
//! `1/1024` of the size, y upwards, every command relative to where the pen stands.

use std::collections::HashMap;
use std::fmt::Write;
use std::sync::OnceLock;

/// Units in the size of a text.
pub(super) const EM: f64 = 1024.0;

/// What stands for a character that has no outline here.
const UNKNOWN: Glyph = Glyph {
    advance: 615,
    outline: "m100-180l0 1020l410 0l0-1020zm60 60l290 0l0 900l-290 0z",
};

#[derive(Debug, Clone, Copy)]
struct Glyph {
    advance: u32,
    outline: &'static str,
}

fn table() -> &'static HashMap<char, Glyph> {
    static TABLE: OnceLock<HashMap<char, Glyph>> = OnceLock::new();
    TABLE.get_or_init(|| {
        include_str!("glyphs.txt")
            .lines()
            .filter_map(parsed)
            .collect()
    })
}

/// `code advance outline`; a blank has no outline.
fn parsed(line: &'static str) -> Option<(char, Glyph)> {
    let (code, rest) = line.split_once(' ')?;
    let (advance, outline) = rest.split_once(' ').unwrap_or((rest, ""));
    let character = char::from_u32(u32::from_str_radix(code, 16).ok()?)?;
    let advance = advance.parse().ok()?;
    Some((character, Glyph { advance, outline }))
}

fn glyph(character: char) -> Glyph {
    table().get(&character).copied().unwrap_or(UNKNOWN)
}

/// Width of a line of text in units.
pub(super) fn width(text: &str) -> f64 {
    let advances = text.chars().map(|character| glyph(character).advance);
    f64::from(advances.sum::<u32>())
}

/// The path of a line of text that begins at so many units.
pub(super) fn path(text: &str, begin: f64) -> String {
    let mut path = String::new();
    let mut pen = begin.round() as i64;
    for character in text.chars() {
        let Glyph { advance, outline } = glyph(character);
        if !outline.is_empty() {
            // Writing to a string does not fail.
            let _ = write!(path, "M{pen} 0{outline}");
        }
        pen += i64::from(advance);
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_table_is_read() {
        assert_eq!(table().len(), include_str!("glyphs.txt").lines().count());
        let needed = ('!'..='~').chain("αζωσλ−×⁻²₁′≤".chars());
        for character in needed {
            assert!(!table()[&character].outline.is_empty(), "{character}");
        }
        assert!(table()[&' '].outline.is_empty());
    }

    #[test]
    fn outlines_are_closed_and_stay_within_the_line() {
        for (character, glyph) in table() {
            let mut pen = [0, 0];
            let mut start = pen;
            let commands = glyph
                .outline
                .split_inclusive(|c: char| c.is_ascii_alphabetic());
            let mut command = None;
            for part in commands {
                let numbers = part.trim_end_matches(|c: char| c.is_ascii_alphabetic());
                let numbers = numbers.replace('-', " -");
                let numbers: Vec<i32> = numbers
                    .split_whitespace()
                    .map(|n| n.parse().unwrap())
                    .collect();
                if let [.., x, y] = numbers[..] {
                    pen = [pen[0] + x, pen[1] + y];
                }
                match command {
                    Some('m') => start = pen,
                    Some('z') => assert!(numbers.is_empty()),
                    _ => {}
                }
                command = part.chars().last().filter(char::is_ascii_alphabetic);
                if command == Some('z') {
                    pen = start;
                }
                let inside = (-300..=1400).contains(&pen[0]) && (-500..=1200).contains(&pen[1]);
                assert!(inside, "{character} {pen:?}");
            }
            assert!(
                glyph.outline.is_empty() || command == Some('z'),
                "{character}"
            );
        }
    }

    #[test]
    fn a_text_is_as_wide_as_its_letters() {
        assert_eq!(width("AB"), width("A") + width("B"));
        assert_eq!(path(" A", 0.0), path("A", width(" ")));
        assert_eq!(path("", 3.0), "");
        assert!(path("\u{4e2d}", 0.0).contains(UNKNOWN.outline));
    }
}
