//! Prints the code that a declaration expands to: `expand FILE`, where the file holds what stands between the braces of
//! `hertzian::oscillator! { ... }`.

use std::{env, error, fs};

use quote::quote;

fn main() -> Result<(), Box<dyn error::Error>> {
    let path = env::args().nth(1).ok_or("usage: expand FILE")?;
    let tokens = fs::read_to_string(path)?.parse()?;
    let code = syn::parse2(hertzian_compiler::oscillator(&quote!(::hertzian), tokens))?;
    print!("{}", prettyplease::unparse(&code));
    Ok(())
}
