//! The pictures: errors by harmonics and by time, both axes logarithmic.

use hertzian::chart::{Chart, Markers, Page, Reference, Scale, Trace};

use super::study::{METHODS, Measured};

/// Errors by harmonics, with lines of two orders.
pub fn by_harmonics(all: &[(&str, Vec<Measured>)]) -> Page {
    let page = |page: Page, (name, measured): &(&str, Vec<Measured>)| {
        let chart = chart(name, measured, |m| m.harmonics as f64);
        let harmonics = measured.iter().map(|m| m.harmonics as f64);
        let [least, most] =
            harmonics.fold([f64::INFINITY, 0.0_f64], |[a, b], k| [a.min(k), b.max(k)]);
        let line = |order: i32, label: &str| Reference {
            label: label.to_owned(),
            points: vec![[least, 0.1], [most, 0.1 * (most / least).powi(-order)]],
        };
        page.chart(
            chart
                .x("harmonics per period of the excitation")
                .reference(line(2, "order 2"))
                .reference(line(4, "order 4")),
        )
    };
    all.iter().fold(Page::new(2), page)
}

/// Errors by time.
pub fn by_time(all: &[(&str, Vec<Measured>)]) -> Page {
    let page = |page: Page, (name, measured): &(&str, Vec<Measured>)| {
        let chart = chart(name, measured, |m| m.microseconds);
        page.chart(chart.x("microseconds for the orbit and the corrected orbit"))
    };
    all.iter().fold(Page::new(2), page)
}

fn chart(name: &str, measured: &[Measured], x: impl Fn(&Measured) -> f64) -> Chart {
    let mut chart = Chart::new(name)
        .y("largest error of a multiplier")
        .scales(Scale::Logarithmic, Scale::Logarithmic);
    for method in METHODS {
        let of_method = measured.iter().filter(|m| m.method == method);
        let points: Vec<_> = of_method.map(|m| [x(m), m.error]).collect();
        let label = method.to_string();
        chart = chart
            .trace(Trace {
                label: String::new(),
                points: points.clone(),
            })
            .markers(Markers { label, points });
    }
    chart
}
