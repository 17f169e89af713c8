//! Orbits without the odd symmetry that others of the system have: near one that has it, disturbed in what it does not have.
//!
//! Means along the coordinates are tried, and with them a second harmonic: in parts of the orbit's own oscillation, for orbits that
//! have lost the symmetry, and where the residual has a valley along the mean, for those that never had it, as in one of two wells.
//! Of what is found the orbit of smallest oscillation is taken. Its mirror image is another one.

use super::StartRequest;
use super::effort::Effort;
use super::fixed::{Fixed, geometric, oscillation, spread};
use crate::balance::Parity;
use crate::balance::symmetry::is_broken;
use crate::continuation::newton::NewtonOptions;

/// Sizes of a disturbance, three a decade from a twentieth of the orbit's own oscillation.
const SIZES: i32 = 8;
/// Second harmonics, cosine and sine, as parts of the mean.
const SECOND: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]];
/// Harmonics of the search.
const FEW: usize = 10;

/// An orbit without the symmetry, if one is found.
pub(super) fn orbit(
    request: StartRequest<'_>,
    symmetric: &[f64],
    effort: &mut Effort,
) -> Option<Vec<f64>> {
    let mut request = request;
    request.resolution.parity = Parity::All;
    let harmonics = request.resolution.harmonics;
    let mut coarse = Fixed::new(request, harmonics.min(FEW));
    let length = coarse.balance.length();
    let coordinates = coarse.balance.layout().coordinates;
    let from = spread(symmetric, &coarse);
    let size = oscillation(&from, length).sqrt();
    let options = NewtonOptions {
        tolerance: request.newton.tolerance.max(1e-5),
        ..request.damped(40)
    };
    let mut found: Vec<Vec<f64>> = Vec::new();
    for coordinate in 0..coordinates {
        let mean = coordinate * length;
        let own = (0..SIZES).map(|step| 0.05 * size * 10_f64.powf(f64::from(step) / 3.0));
        let mut means: Vec<f64> = own.filter(|mean| *mean > 0.0).collect();
        means.extend(valleys(&mut coarse, &from, mean, effort));
        for by in means {
            for second in SECOND {
                if effort.is_spent() {
                    break;
                }
                let mut u = from.clone();
                u[mean] += by;
                if length > 4 {
                    u[mean + 3] += second[0] * by;
                    u[mean + 4] += second[1] * by;
                }
                if coarse.solve(&mut u, options, effort).is_ok() && is_broken(&u, length) {
                    found.push(u);
                    break;
                }
            }
        }
    }
    found.sort_by(|a, b| oscillation(a, length).total_cmp(&oscillation(b, length)));
    let mut full = Fixed::new(request, harmonics);
    let length = full.balance.length();
    found.iter().find_map(|candidate| {
        let mut u = spread(candidate, &full);
        let solved = full.solve(&mut u, request.damped(60), effort).is_ok();
        (solved && is_broken(&u, length)).then_some(u)
    })
}

/// Means of one coordinate where the residual is smaller than for those beside.
fn valleys(fixed: &mut Fixed<'_>, from: &[f64], mean: usize, effort: &mut Effort) -> Vec<f64> {
    let along: Vec<(f64, f64)> = geometric()
        .map(|by| {
            let mut u = from.to_vec();
            u[mean] += by;
            (by, fixed.residual(&u, effort))
        })
        .collect();
    let valleys = along.windows(3);
    let valleys = valleys.filter(|w| w[1].1 < w[0].1 && w[1].1 < w[2].1);
    valleys.map(|w| w[1].0).collect()
}
