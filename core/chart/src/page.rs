//! Several charts on one page.

use std::fmt::Write;
use std::path::Path;

use super::drawing::{HEIGHT, WIDTH};
use super::{Chart, ChartError};

/// Charts side by side and below each other.
///
/// ```
/// use hertzian_chart::{Chart, Page};
///
/// let page = Page::new(2).chart(Chart::new("left")).chart(Chart::new("right"));
/// assert!(page.to_svg().contains("width=\"1800\" height=\"600\""));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    columns: usize,
    charts: Vec<Chart>,
}

impl Page {
    /// An empty page with so many charts in a row.
    pub fn new(columns: usize) -> Self {
        Self {
            columns: columns.max(1),
            charts: Vec::new(),
        }
    }

    /// Adds a chart: to the right of the last one, or at the left of the next row.
    #[must_use]
    pub fn chart(mut self, chart: Chart) -> Self {
        self.charts.push(chart);
        self
    }

    /// Adds all charts of another page.
    #[must_use]
    pub fn page(mut self, other: Self) -> Self {
        self.charts.extend(other.charts);
        self
    }

    /// The page as the text of an SVG document.
    pub fn to_svg(&self) -> String {
        let columns = self.columns.min(self.charts.len()).max(1);
        let rows = self.charts.len().div_ceil(columns);
        let (width, height) = (WIDTH * columns as f64, HEIGHT * rows as f64);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n"
        );
        for (index, chart) in self.charts.iter().enumerate() {
            let x = WIDTH * (index % columns) as f64;
            let y = HEIGHT * (index / columns) as f64;
            let chart = chart.to_svg();
            let inside = chart.strip_prefix("<svg ").unwrap_or(&chart);
            // Writing to a string does not fail.
            let _ = write!(text, "<svg x=\"{x}\" y=\"{y}\" {inside}");
        }
        text.push_str("</svg>\n");
        text
    }

    /// Writes the page to a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), ChartError> {
        let path = path.as_ref();
        hertzian_file::write(path, self.to_svg()).map_err(|source| ChartError {
            path: path.to_path_buf(),
            source,
        })
    }
}
