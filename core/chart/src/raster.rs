//! Coloured cells: as rectangles, or where these would be too many as a picture inside the SVG.
//!
//! Rectangles are sharp in every program that shows them; of a picture some make the cells blurred. A grid of 512 by 512 cells may
//! be as many rectangles. As a picture with a palette it is half a byte for each. It is stored
//! without compression: a compressor would be another dependency, and what is written is small.
//!
//! Source: PNG specification (ISO/IEC 15948); RFC 1950, 1951 (stored blocks) and 4648.

use super::svg::{Rectangle, Svg};

/// Coloured cells over a range of both axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// The ends of the horizontal range.
    pub x: [f64; 2],
    /// The ends of the vertical range.
    pub y: [f64; 2],
    /// Number of cells in a row.
    pub columns: usize,
    /// The class of every cell, row by row, the lowest first.
    pub cells: Vec<u8>,
    /// What the legend says of each class, and its colour. Cells of further classes are white.
    pub classes: Vec<(String, Colour)>,
}

/// A colour of cells. All differ in lightness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Colour {
    /// One of twelve; neighbours in the list are far from each other in lightness. Others repeat them.
    Class(usize),
    /// One of [`STEPS`] from light to dark, for classes that have an order; the last for what is beyond.
    Step(usize),
    /// White with thin lines or dots, in one of four patterns: diagonals, crossed diagonals, dots, uprights. Others repeat them. For what
    /// has no place in an order, as no colour stands beside five steps of lightness in grey.
    Hatched(usize),
    /// White.
    None,
    /// Light grey.
    Light,
    /// Grey.
    Middle,
    /// Red.
    Fault,
}

/// Hues that colour-blind readers tell apart, ordered so that neighbours differ in lightness; the first six are at lightnesses 94, 31, 67, 47,
/// 78 and 0 of 100.
const COLOURS: [&str; 12] = [
    "#f7f0c8", "#104a86", "#dd9415", "#1b7f5a", "#8cc8ea", "#000000", "#d55e00", "#c9e59a",
    "#6a2c8c", "#e9a3c9", "#3f88c5", "#7a4a1e",
];

/// Number of the colours that have an order.
pub const STEPS: usize = 5;
/// From the map `viridis` of Smith and van der Walt (2015), at lightnesses 91, 71, 47, 32, 15 of 100.
const ORDERED: [&str; STEPS] = ["#fde725", "#52c569", "#2a788e", "#414487", "#440154"];

impl Colour {
    /// That of a class among so many in order, such that they are as far apart as can be.
    pub const fn in_order(class: usize, count: usize) -> Self {
        if count < 2 {
            return Self::Step(0);
        }
        Self::Step(class * (STEPS - 1) / (count - 1))
    }

    fn code(self) -> &'static str {
        match self {
            Self::Class(index) => COLOURS[index % COLOURS.len()],
            Self::Step(index) => ORDERED[index.min(STEPS - 1)],
            Self::None | Self::Hatched(_) => "#ffffff",
            Self::Light => "#c8c8c8",
            Self::Middle => "#8a8a8a",
            Self::Fault => "#e00000",
        }
    }

    /// What an area is filled with.
    fn fill(self) -> &'static str {
        match self {
            Self::Hatched(index) => HATCHES[index % HATCHES.len()].fill,
            _ => self.code(),
        }
    }
}

/// A pattern of a square of eight pixels.
struct Hatch {
    id: &'static str,
    fill: &'static str,
    path: &'static str,
    width: f64,
}

const HATCHES: [Hatch; 4] = [
    Hatch {
        id: "hatch-0",
        fill: "url(#hatch-0)",
        path: "M0 8L8 0M-2 2L2 -2M6 10L10 6",
        width: 1.2,
    },
    Hatch {
        id: "hatch-1",
        fill: "url(#hatch-1)",
        path: "M0 0L8 8M0 8L8 0",
        width: 1.2,
    },
    Hatch {
        id: "hatch-2",
        fill: "url(#hatch-2)",
        path: "M2 2h0M6 6h0",
        width: 2.2,
    },
    Hatch {
        id: "hatch-3",
        fill: "url(#hatch-3)",
        path: "M4 0V8",
        width: 1.2,
    },
];

/// A rectangle of cells: the first of its columns and rows, and what follows the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Area {
    columns: [usize; 2],
    rows: [usize; 2],
}

/// More rectangles than these are drawn as a picture.
const RECTANGLES: usize = 20_000;

/// Classes that a palette of four bits has room for, besides white.
const CLASSES: u8 = 15;

impl Raster {
    /// Colours and labels of the classes that cells have.
    pub(super) fn shown(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let classes = self.classes.iter().take(usize::from(CLASSES)).enumerate();
        classes
            .filter(|(class, _)| self.cells.iter().any(|&cell| usize::from(cell) == *class))
            .map(|(_, (label, colour))| (colour.fill(), label.as_str()))
    }

    pub(super) fn draw(&self, svg: &mut Svg, place: &Rectangle) {
        if self.columns == 0 || self.cells.len() < self.columns {
            return;
        }
        let filled = self.filled();
        let count: usize = filled.iter().map(|(_, areas)| areas.len()).sum();
        let as_picture = count > RECTANGLES;
        if as_picture {
            svg.image(place, &base64(&self.png()));
        }
        for (fill, areas) in filled {
            let hatch = HATCHES.iter().find(|hatch| hatch.fill == fill);
            if let Some(Hatch {
                id, path, width, ..
            }) = hatch
            {
                svg.pattern(id, path, *width);
            } else if as_picture {
                continue;
            }
            let rectangles = areas.iter().map(|area| self.rectangle(area, place));
            svg.rectangles(rectangles, fill);
        }
    }

    /// What cells are filled with, each once, and where. What has no class stays white.
    fn filled(&self) -> Vec<(&'static str, Vec<Area>)> {
        let mut filled: Vec<(&'static str, Vec<Area>)> = Vec::new();
        for (_, colour) in self.classes.iter().take(usize::from(CLASSES)) {
            let fill = colour.fill();
            let areas = self.areas(fill);
            if !areas.is_empty() && filled.iter().all(|(other, _)| *other != fill) {
                filled.push((fill, areas));
            }
        }
        filled
    }

    /// The rectangles of cells that are filled so: as tall as rows that follow each other have the same columns.
    fn areas(&self, fill: &str) -> Vec<Area> {
        let filled = |class: &u8| {
            let class = self.classes.get(usize::from(*class));
            class.is_some_and(|(_, colour)| colour.fill() == fill)
        };
        let mut areas: Vec<Area> = Vec::new();
        let mut open: Vec<Area> = Vec::new();
        for (row, cells) in self.cells.chunks_exact(self.columns).enumerate() {
            let mut next = Vec::new();
            let mut from = 0;
            for run in cells.chunk_by(|a, b| filled(a) == filled(b)) {
                let columns = [from, from + run.len()];
                from = columns[1];
                if !filled(&run[0]) {
                    continue;
                }
                let same = open.iter().position(|area| area.columns == columns);
                let first = same.map_or(row, |place| open.swap_remove(place).rows[0]);
                let rows = [first, row + 1];
                next.push(Area { columns, rows });
            }
            areas.append(&mut open);
            open = next;
        }
        areas.append(&mut open);
        areas
    }

    fn rectangle(&self, area: &Area, place: &Rectangle) -> Rectangle {
        let rows = (self.cells.len() / self.columns) as f64;
        let [left, right] = area
            .columns
            .map(|column| place.left + place.width * column as f64 / self.columns as f64);
        let [bottom, top] = area
            .rows
            .map(|row| place.bottom() - place.height * row as f64 / rows);
        Rectangle {
            left,
            top,
            width: right - left,
            height: bottom - top,
        }
    }

    /// The cells as a PNG file with a palette.
    fn png(&self) -> Vec<u8> {
        let rows = self.cells.len() / self.columns;
        let codes = self.classes.iter().map(|(_, colour)| colour.code());
        let codes = codes.take(usize::from(CLASSES));
        let palette: Vec<u8> = codes.chain(["#ffffff"]).flat_map(bytes_of).collect();
        let white = (palette.len() / 3 - 1) as u8;
        let mut pixels = Vec::with_capacity(rows * (self.columns.div_ceil(2) + 1));
        // Rows from the top; each begins with the number of its filter, which is none.
        for row in self.cells.chunks_exact(self.columns).rev() {
            pixels.push(0);
            for pair in row.chunks(2) {
                let index = |i: usize| pair.get(i).map_or(white, |&class| class.min(white));
                pixels.push(index(0) << 4 | index(1));
            }
        }
        let mut header = Vec::new();
        header.extend((self.columns as u32).to_be_bytes());
        header.extend((rows as u32).to_be_bytes());
        // Four bits for each pixel, a palette, the usual compression and filter, no interlacing.
        header.extend([4, 3, 0, 0, 0]);
        let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
        for (name, data) in [
            (b"IHDR", header),
            (b"PLTE", palette),
            (b"IDAT", stored(&pixels)),
            (b"IEND", Vec::new()),
        ] {
            png.extend((data.len() as u32).to_be_bytes());
            let from = png.len();
            png.extend(name);
            png.extend(data);
            let sum = crc(&png[from..]);
            png.extend(sum.to_be_bytes());
        }
        png
    }
}

/// Red, green and blue of `#rrggbb`.
fn bytes_of(code: &'static str) -> [u8; 3] {
    let number = u32::from_str_radix(&code[1..], 16).unwrap_or(0);
    let [_, red, green, blue] = number.to_be_bytes();
    [red, green, blue]
}

/// A zlib stream of blocks that are not compressed.
fn stored(bytes: &[u8]) -> Vec<u8> {
    let mut stream = vec![0x78, 0x01];
    let blocks = bytes.chunks(0xffff);
    let last = blocks.len().saturating_sub(1);
    for (index, block) in blocks.enumerate() {
        let length = block.len() as u16;
        stream.push(u8::from(index == last));
        stream.extend(length.to_le_bytes());
        stream.extend((!length).to_le_bytes());
        stream.extend(block);
    }
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in bytes {
        a = (a + u32::from(byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    stream.extend((b << 16 | a).to_be_bytes());
    stream
}

/// The checksum of a PNG chunk.
fn crc(bytes: &[u8]) -> u32 {
    let sum = bytes.iter().fold(u32::MAX, |sum, &byte| {
        let bit = |sum: u32, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
        (0..8).fold(sum ^ u32::from(byte), bit)
    });
    !sum
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= group.len() {
                letter as char
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of RFC 4648, section 10, and of the PNG and zlib specifications (the CRC of `IEND`, Adler-32 of "Wikipedia").
    #[test]
    fn encodings_agree_with_their_specifications() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(crc(b"IEND"), 0xae42_6082);
        let stream = stored(b"Wikipedia");
        assert_eq!(stream[stream.len() - 4..], 0x11e6_0398_u32.to_be_bytes());
        assert_eq!(stream[..7], [0x78, 0x01, 1, 9, 0, 0xf6, 0xff]);
    }

    #[test]
    fn classes_without_cells_are_not_in_the_legend() {
        let raster = Raster {
            x: [0.0, 1.0],
            y: [0.0, 1.0],
            columns: 2,
            cells: vec![0, 2, 2, 9],
            classes: ["a", "b", "c"]
                .map(|label| (label.to_owned(), Colour::Class(0)))
                .to_vec(),
        };
        let shown: Vec<_> = raster.shown().map(|(_, label)| label).collect();
        assert_eq!(shown, ["a", "c"]);
    }

    #[test]
    fn hatched_cells_are_joined_to_rectangles() {
        let raster = Raster {
            x: [0.0, 3.0],
            y: [0.0, 3.0],
            columns: 3,
            cells: vec![1, 1, 0, 1, 1, 0, 0, 1, 1],
            classes: vec![
                ("a".to_owned(), Colour::Step(0)),
                ("b".to_owned(), Colour::Hatched(5)),
            ],
        };
        let area = |columns, rows| Area { columns, rows };
        let expected = [area([0, 2], [0, 2]), area([1, 3], [2, 3])];
        assert_eq!(raster.areas("url(#hatch-1)"), expected);
        assert_eq!(raster.areas("url(#hatch-0)"), []);
        let place = Rectangle {
            left: 10.0,
            top: 20.0,
            width: 30.0,
            height: 60.0,
        };
        let known = Rectangle {
            left: 20.0,
            top: 20.0,
            width: 20.0,
            height: 20.0,
        };
        assert_eq!(raster.rectangle(&expected[1], &place), known);
        let mut svg = Svg::new(90.0, 90.0, "");
        raster.draw(&mut svg, &place);
        let text = svg.finish();
        assert!(text.contains("<pattern id=\"hatch-1\""), "{text}");
        assert_eq!(text.matches("url(#hatch-1)").count(), 1);
        assert!(!text.contains("hatch-0"));
        // Of the other class the right of the two lower rows, and the left of the upper one: no picture is needed.
        assert!(
            text.contains("M30 80H40V40H30ZM10 40H20V20H10Z\" fill=\"#fde725\""),
            "{text}"
        );
        assert!(!text.contains("<image"));
    }

    #[test]
    fn cells_of_too_many_rectangles_are_a_picture() {
        let columns = 201;
        let raster = Raster {
            x: [0.0, 1.0],
            y: [0.0, 1.0],
            columns,
            cells: (0..columns * columns)
                .map(|cell| (cell % 2) as u8)
                .collect(),
            classes: vec![
                ("a".to_owned(), Colour::Step(0)),
                ("b".to_owned(), Colour::Hatched(0)),
            ],
        };
        let place = Rectangle {
            left: 0.0,
            top: 0.0,
            width: 100.0,
            height: 100.0,
        };
        let mut svg = Svg::new(100.0, 100.0, "");
        raster.draw(&mut svg, &place);
        let text = svg.finish();
        assert!(text.contains("<image") && !text.contains("#fde725"));
        assert!(text.contains("url(#hatch-0)"));
    }
}
