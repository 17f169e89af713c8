//! Marks upon each other: one stands for all of them, and says how many.

use super::svg::Pixel;

/// Marks nearer to each other than this, in pixels, cannot be told apart.
const NEAR: f64 = 8.0;

/// One kind of marks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind<'k> {
    pub(super) label: &'k str,
    pub(super) pixels: &'k [Pixel],
}

/// A mark that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Merged {
    /// Number of its kind.
    pub(super) kind: usize,
    pub(super) pixel: Pixel,
    /// What stands there: nothing for one mark, a count for several of a kind, names with counts for several kinds.
    pub(super) text: String,
}

/// Marks that can be told apart. Each is at the place of the first of those that it stands for.
pub(super) fn merged(kinds: &[Kind<'_>]) -> Vec<Merged> {
    let mut heaps: Vec<Heap> = Vec::new();
    for (kind, Kind { pixels, .. }) in kinds.iter().enumerate() {
        for &pixel in *pixels {
            let near = |heap: &&mut Heap| {
                let [x, y] = heap.pixel;
                (x - pixel[0]).hypot(y - pixel[1]) < NEAR
            };
            match heaps.iter_mut().find(near) {
                Some(heap) => heap.kinds.push(kind),
                None => heaps.push(Heap {
                    pixel,
                    kinds: vec![kind],
                }),
            }
        }
    }
    let merged = |heap: Heap| Merged {
        kind: heap.kinds[0],
        pixel: heap.pixel,
        text: heap.text(kinds),
    };
    heaps.into_iter().map(merged).collect()
}

/// Marks at one place.
struct Heap {
    pixel: Pixel,
    /// The kind of each, in increasing order.
    kinds: Vec<usize>,
}

impl Heap {
    fn text(&self, known: &[Kind<'_>]) -> String {
        let of_kind = self.kinds.chunk_by(|a, b| a == b);
        let parts: Vec<(&str, usize)> = of_kind
            .map(|alike| (known[alike[0]].label, alike.len()))
            .collect();
        match parts[..] {
            [(_, 1)] => String::new(),
            [(_, count)] => format!("×{count}"),
            _ => {
                let part = |&(label, count): &(&str, usize)| match count {
                    1 => label.to_owned(),
                    _ => format!("{label} ×{count}"),
                };
                parts.iter().map(part).collect::<Vec<_>>().join(", ")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_upon_each_other_are_counted_by_kind() {
        let folds = [[10.0, 10.0], [11.0, 12.0], [200.0, 10.0]];
        let touches = [[200.0, 13.0], [199.0, 10.0], [300.0, 10.0], [12.0, 100.0]];
        let kinds = [
            Kind {
                label: "fold",
                pixels: &folds,
            },
            Kind {
                label: "grazing",
                pixels: &touches,
            },
        ];
        let found = merged(&kinds);
        let expected = [
            (0, [10.0, 10.0], "×2"),
            (0, [200.0, 10.0], "fold, grazing ×2"),
            (1, [300.0, 10.0], ""),
            (1, [12.0, 100.0], ""),
        ];
        let expected = expected.map(|(kind, pixel, text)| Merged {
            kind,
            pixel,
            text: text.to_owned(),
        });
        assert_eq!(found, expected);
        assert_eq!(merged(&[]), []);
    }
}
