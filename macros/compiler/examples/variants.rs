//! Writes a crate of many models twice: as declarations, and as the code that they expand to. `benches/compile_time.sh`
//! compares the times of compiling both.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, error, fs};

use quote::quote;

/// Declarations, in which `NAME` and the numeral `NUMBER` differ between the variants.
const DECLARATIONS: [&str; 5] = [
    "pub NAME(x) {
    param zeta in 0.0..;
    param load;
    param drive;
    law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^NUMBER, else => 0 }
    ddot(x) + contact(x) = drive*cos(omega*t) + load;
}",
    "pub NAME(x) {
    param zeta in 0.0..;
    param alpha > 0;
    param drive;
    ddot(x) + 2*zeta*dot(x) + NUMBER*sgn(x)*|x|^alpha = drive*cos(omega*t);
}",
    "pub NAME(x) {
    param k > 0;
    param c in 0.0..;
    law contact(gap) { gap > 0 => k*gap^NUMBER*(1 + c*dot(gap)), else => 0 }
    ddot(x) + contact(x) = 0.1*cos(omega*t) + 1;
}",
    "pub NAME(x) {
    param play > 0;
    law teeth(gap) { gap > play => gap - play, gap < -play => NUMBER*(gap + play), else => 0 }
    ddot(x) + 0.064*dot(x) + teeth(x) = 0.1*cos(omega*t);
}",
    "pub NAME(x, y) {
    param k > 0;
    param drive;
    law stop(gap) { gap > NUMBER => k*(gap - NUMBER), else => 0 }
    ddot(x) + 0.03*(dot(x) - dot(y)) + x - y + stop(x) = 0;
    ddot(y) + 0.03*(2*dot(y) - dot(x)) + 2*y - x = drive*cos(omega*t);
}",
];

fn main() -> Result<(), Box<dyn error::Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [count, by_macro, by_hand] = arguments.as_slice() else {
        return Err("usage: variants COUNT DECLARED.rs EXPANDED.rs".into());
    };
    let (mut declared, mut expanded) = (String::new(), String::new());
    for variant in 0..count.parse()? {
        let declaration = declaration(variant);
        writeln!(declared, "hertzian::oscillator! {{\n{declaration}\n}}\n")?;
        let file = syn::parse2(hertzian_compiler::oscillator(
            &quote!(::hertzian),
            declaration.parse()?,
        ))?;
        writeln!(expanded, "{}", prettyplease::unparse(&file))?;
    }
    fs::write(Path::new(by_macro), declared)?;
    fs::write(Path::new(by_hand), expanded)?;
    Ok(())
}

fn declaration(variant: usize) -> String {
    let number = format!("{:.2}", 1.05 + 0.01 * variant as f64);
    DECLARATIONS[variant % DECLARATIONS.len()]
        .replace("NAME", &format!("Variant{variant}"))
        .replace("NUMBER", &number)
}
