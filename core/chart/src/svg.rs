//! The few elements of SVG that a chart needs, written as text.

use std::fmt::{self, Display, Write};

use super::glyphs;

/// A point in pixels, y downwards.
pub(super) type Pixel = [f64; 2];

/// Colours of axes and text.
pub(super) const INK: &str = "#222222";

/// Colour of bands around curves.
pub(super) const BAND: &str = "#bdbdbd";

/// A document that grows.
pub(super) struct Svg {
    text: String,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: &'static str,
    pub(super) width: f64,
    /// Lengths of dashes and gaps in pixels; empty for a solid line.
    pub(super) dashes: &'static str,
}

pub(super) const fn pen(colour: &'static str, width: f64, dashes: &'static str) -> Pen {
    Pen {
        colour,
        width,
        dashes,
    }
}

/// Where a text stands relative to its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
    /// Centred, and read from below.
    Upwards,
}

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rectangle {
    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }

    pub(super) fn contains(&self, [x, y]: Pixel) -> bool {
        (self.left..=self.right()).contains(&x) && (self.top..=self.bottom()).contains(&y)
    }

    /// Lines so close that nothing fits between them.
    pub(super) fn scanned(&self) -> Vec<Vec<Pixel>> {
        let line = |i: i32| {
            let y = self.top + self.height * f64::from(i) / 20.0;
            vec![[self.left, y], [self.right(), y]]
        };
        (0..=20).map(line).collect()
    }

    /// The nearest point of it.
    pub(super) fn nearest(&self, [x, y]: Pixel) -> Pixel {
        [
            x.clamp(self.left, self.right()),
            y.clamp(self.top, self.bottom()),
        ]
    }

    /// Larger by a margin on every side.
    pub(super) fn grown(&self, margin: f64) -> Self {
        Self {
            left: self.left - margin,
            top: self.top - margin,
            width: self.width + 2.0 * margin,
            height: self.height + 2.0 * margin,
        }
    }
}

impl Svg {
    /// A white page. The title is what a screen reader says.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let mut svg = Self {
            text: String::new(),
        };
        svg.push(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>",
            Escaped(title)
        ));
        svg
    }

    pub(super) fn finish(mut self) -> String {
        self.push(format_args!("</svg>"));
        self.text
    }

    /// Polylines drawn with one pen.
    pub(super) fn lines(&mut self, lines: &[Vec<Pixel>], pen: Pen) {
        if lines.is_empty() {
            return;
        }
        let path = Path(lines);
        let Pen { colour, width, .. } = pen;
        let dashes = Dashes(pen.dashes);
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\"{dashes}/>"
        ));
    }

    /// Lines with round ends; one of a single point is a dot.
    pub(super) fn dots(&mut self, lines: &[Vec<Pixel>], pen: Pen) {
        if lines.is_empty() {
            return;
        }
        let Pen { colour, width, .. } = pen;
        let mut path = String::new();
        for line in lines {
            let end = if line.len() == 1 { "h0" } else { "" };
            // Writing to a string does not fail.
            let _ = write!(path, "{}{end}", Path(std::slice::from_ref(line)));
        }
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\"/>"
        ));
    }

    /// A picture in PNG format, stretched over a rectangle without smoothing: the attribute is for programs that do not know the word in the style.
    pub(super) fn image(&mut self, place: &Rectangle, base64: &str) {
        let (x, y) = (Number(place.left), Number(place.top));
        let (width, height) = (Number(place.width), Number(place.height));
        self.push(format_args!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
             image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
             xlink:href=\"data:image/png;base64,{base64}\"/>"
        ));
    }

    /// Polygons that all go round in one sense, as one pale area.
    pub(super) fn pale_area(&mut self, polygons: &[Vec<Pixel>], colour: &str) {
        self.area(polygons, colour, 0.13);
    }

    /// The same as a band, through which lines of the grid are seen.
    pub(super) fn band(&mut self, polygons: &[Vec<Pixel>]) {
        self.area(polygons, BAND, 0.7);
    }

    fn area(&mut self, polygons: &[Vec<Pixel>], colour: &str, opacity: f64) {
        if polygons.is_empty() {
            return;
        }
        let mut path = String::new();
        for polygon in polygons {
            // Writing to a string does not fail.
            let _ = write!(path, "{}Z", Path(std::slice::from_ref(polygon)));
        }
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"{colour}\" fill-opacity=\"{opacity}\" fill-rule=\"nonzero\"/>"
        ));
    }

    /// A closed shape.
    pub(super) fn polygon(&mut self, corners: &[Pixel], fill: &str, pen: Pen) {
        let path = Path(&[corners.to_vec()]).to_string();
        let Pen { colour, width, .. } = pen;
        self.push(format_args!(
            "<path d=\"{path}Z\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
        ));
    }

    /// Rectangles of one filling, without an outline; those that touch have no seam.
    pub(super) fn rectangles(&mut self, all: impl Iterator<Item = Rectangle>, fill: &str) {
        let mut path = String::new();
        for rectangle in all {
            let [left, right] = [rectangle.left, rectangle.right()].map(Number);
            let [top, bottom] = [rectangle.top, rectangle.bottom()].map(Number);
            // Writing to a string does not fail.
            let _ = write!(path, "M{left} {bottom}H{right}V{top}H{left}Z");
        }
        self.push(format_args!(
            "<path d=\"{path}\" fill=\"{fill}\" shape-rendering=\"crispEdges\"/>"
        ));
    }

    /// A pattern to fill areas with: a white square of eight pixels with a path.
    pub(super) fn pattern(&mut self, id: &str, path: &str, width: f64) {
        self.push(format_args!(
            "<pattern id=\"{id}\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\">\
             <rect width=\"8\" height=\"8\" fill=\"#ffffff\"/>\
             <path d=\"{path}\" fill=\"none\" stroke=\"#555555\" stroke-width=\"{width}\" stroke-linecap=\"round\"/></pattern>"
        ));
    }

    pub(super) fn circle(&mut self, [x, y]: Pixel, radius: f64, fill: &str, pen: Pen) {
        let (x, y) = (Number(x), Number(y));
        let Pen { colour, width, .. } = pen;
        self.push(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{colour}\" \
             stroke-width=\"{width}\"/>"
        ));
    }

    /// A line of text on its base line; nothing for no text.
    pub(super) fn text(&mut self, [x, y]: Pixel, size: f64, anchor: Anchor, text: &str) {
        if text.is_empty() {
            return;
        }
        let width = glyphs::width(text);
        let (begin, turned) = match anchor {
            Anchor::Start => (0.0, ""),
            Anchor::Middle => (-0.5 * width, ""),
            Anchor::End => (-width, ""),
            Anchor::Upwards => (-0.5 * width, " rotate(-90)"),
        };
        let path = glyphs::path(text, begin);
        let (x, y, text) = (Number(x), Number(y), Escaped(text));
        let scale = size / glyphs::EM;
        // What is read aloud and searched for is the label.
        self.push(format_args!(
            "<path transform=\"translate({x} {y}){turned} scale({scale:.6} -{scale:.6})\" fill=\"{INK}\" \
             role=\"img\" aria-label=\"{text}\" d=\"{path}\"/>"
        ));
    }

    fn push(&mut self, line: fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "{line}");
    }
}

/// Width of a text in pixels.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    size * glyphs::width(text) / glyphs::EM
}

/// The size at which a text is at most `width` wide, at most `size`.
pub(super) fn fitted(text: &str, size: f64, width: f64) -> f64 {
    size * (width / width_of(text, size).max(1.0)).min(1.0)
}

/// A coordinate to a hundredth of a pixel.
#[derive(Clone, Copy)]
struct Number(f64);

impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding zero turns a negative zero into a positive one.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}

struct Path<'a>(&'a [Vec<Pixel>]);

impl Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for line in self.0 {
            for (index, &[x, y]) in line.iter().enumerate() {
                let command = ["M", "L", " "][index.min(2)];
                write!(f, "{command}{} {}", Number(x), Number(y))?;
            }
        }
        Ok(())
    }
}

struct Dashes(&'static str);

impl Display for Dashes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return Ok(());
        }
        write!(f, " stroke-dasharray=\"{}\"", self.0)
    }
}

/// Text without the characters that mean something to XML, or nothing at all to it.
struct Escaped<'a>(&'a str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '&' => f.write_str("&amp;")?,
                '"' => f.write_str("&quot;")?,
                c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => f.write_char(' ')?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}
