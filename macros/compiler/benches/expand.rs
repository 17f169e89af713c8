//! Time to expand one declaration: `cargo bench -p hertzian-compiler --bench expand`.
//!
//! A crate with a hundred models waits for a hundred of these, so each must stay below 20 ms.

use std::hint::black_box;
use std::time::Instant;

use proc_macro2::TokenStream;
use quote::quote;

/// Turns of each declaration; the median and the slowest are printed.
const TURNS: usize = 50;

const DECLARATIONS: [(&str, &str); 4] = [
    (
        "one-sided contact",
        "pub OneSided(x) {
            param zeta in 0.0..; param load; param drive;
            law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
            ddot(x) + contact(x) = drive*cos(omega*t) + load;
        }",
    ),
    (
        "the same as in the paper",
        "pub Paper(x) {
            param zeta in 0.0..; param alpha > 0; param load; param drive;
            ddot(x) + 2*zeta*H(x)*dot(x) + H(x)*sgn(x)*|x|^alpha = drive*cos(omega*t) + load;
        }",
    ),
    (
        "Hunt-Crossley, exponent a parameter",
        "pub HuntCrossley(x) {
            param k > 0; param c in 0.0..; param alpha > 0; param a > 0;
            law contact(gap) { gap > a => k*(gap - a)^alpha*(1 + c*gap*dot(gap)), else => 0 }
            ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
        }",
    ),
    (
        "two masses with a stop",
        "pub Stop(x, y) {
            param k > 0; param drive;
            law stop(gap) { gap > 1 => k*(gap - 1), else => 0 }
            ddot(x) + 0.03*(dot(x) - dot(y)) + x - y + stop(x) = 0;
            ddot(y) + 0.03*(2*dot(y) - dot(x)) + 2*y - x = drive*cos(omega*t);
        }",
    ),
];

fn main() {
    let runtime = quote!(::hertzian);
    println!("milliseconds per declaration, {TURNS} turns");
    println!(
        "{:<40}{:>8}{:>10}{:>10}",
        "declaration", "median", "slowest", "lines"
    );
    for (name, text) in DECLARATIONS {
        let tokens: TokenStream = text.parse().expect("the declaration is made of tokens");
        let mut times: Vec<f64> = (0..TURNS)
            .map(|_| {
                let start = Instant::now();
                let tokens = black_box(tokens.clone());
                black_box(hertzian_compiler::oscillator(&runtime, tokens));
                1e3 * start.elapsed().as_secs_f64()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let file = syn::parse2(hertzian_compiler::oscillator(&runtime, tokens))
            .expect("it expands to Rust");
        let lines = prettyplease::unparse(&file).lines().count();
        let (median, slowest) = (times[TURNS / 2], times[TURNS - 1]);
        println!("{name:<40}{median:>8.2}{slowest:>10.2}{lines:>10}");
    }
}
