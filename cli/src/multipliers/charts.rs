//! The pictures: errors by harmonics and by time, both axes logarithmic.

use hertzian::chart::{Chart, Note, Page, Scale, Series};
use hertzian::stability::Method;

use super::study::{METHODS, Measured};

/// Errors by harmonics, with lines of two orders.
pub fn by_harmonics(all: &[(&str, Vec<Measured>)]) -> Page {
    let page = |page: Page, (name, measured): &(&str, Vec<Measured>)| {
        let chart = chart(name, measured, |m| [m.harmonics as f64, m.error]);
        let of_monodromy = measured.iter().filter(|m| m.method == Method::Monodromy);
        let points: Vec<_> = of_monodromy
            .map(|m| (m.harmonics as f64, m.error))
            .collect();
        let mut chart = chart.x("harmonics per period of the excitation");
        if let [(least, error), .., (most, _)] = points[..] {
            for order in [2, 4] {
                let end = error * (most / least).powi(-order);
                // A third of the way along, where the name finds room before curves part.
                let at = least * (most / least).powf(0.35);
                let point = [at, error * (at / least).powi(-order)];
                let label = format!("order {order}");
                chart = chart
                    .reference(Series::new("", [[least, error], [most, end]]))
                    .text(Note { label, point });
            }
        }
        page.chart(chart)
    };
    all.iter().fold(Page::new(2), page)
}

/// Errors by time: of what is given, for which the orbit and the corrected orbit are computed.
pub fn by_time(all: &[(&str, Vec<Measured>)]) -> Page {
    let page = |page: Page, (name, measured): &(&str, Vec<Measured>)| {
        let chart = chart(name, measured, |m| [m.microseconds, m.corrected]);
        let chart = chart.x("time of the multipliers, microseconds");
        page.chart(chart.remark(
            "errors after the orbit is corrected for what its harmonics leave out; times are without that",
        ))
    };
    all.iter().fold(Page::new(2), page)
}

fn chart(name: &str, measured: &[Measured], point: impl Fn(&Measured) -> [f64; 2]) -> Chart {
    let mut chart = Chart::new(format!("Contact oscillator, {name}"))
        .y("largest error of a multiplier")
        .scales(Scale::Logarithmic, Scale::Logarithmic);
    for (method, _) in METHODS {
        let of_method = measured.iter().filter(|m| m.method == method);
        let points: Vec<_> = of_method.map(&point).collect();
        chart = chart.joined(Series::new(method.to_string(), points));
    }
    chart
}
