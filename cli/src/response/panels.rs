//! `--panels`: a page about every orbit at the values of `--at`.

use hertzian::chart::Page;
use hertzian::error::chain;
use hertzian::{Branch, Point, export};

use super::options::Options;
use super::run::Failure;

/// Writes the page if it was asked for; returns why something is missing on it.
///
/// # Errors
/// If the file cannot be written.
pub fn write(
    options: &Options,
    branches: &[Branch],
    orbits: &[(usize, Point)],
) -> Result<Vec<String>, Failure> {
    let mut missing = Vec::new();
    let Some(path) = &options.panels else {
        return Ok(missing);
    };
    let mut page = Page::new(2);
    let views = options.views();
    for (number, point) in orbits {
        let branch = &branches[*number];
        let path = match &options.path[..] {
            [up, across] => Some(branch.path([across, up], point)),
            _ => None,
        };
        let path = path.map(|path| ("path", path.map(|chart| Page::new(2).chart(chart))));
        let panels = ("panels", branch.panels(point, &views[0]));
        for (what, drawn) in std::iter::once(panels).chain(path) {
            match drawn {
                Ok(panels) => page = page.page(panels),
                Err(error) => missing.push(format!(
                    "no {what} at {} = {}: {}",
                    options.varied(),
                    point.value,
                    chain(&error)
                )),
            }
        }
    }
    export::write(path, page.to_svg()).map_err(|error| Failure::File(path.clone(), error))?;
    Ok(missing)
}
