//! Names of local variables.

use proc_macro2::Ident;
use quote::format_ident;

/// An identifier for each name: the name itself where it is one, is not reserved for the code around it, and is not
/// taken; a numbered one otherwise. A name with a capital gets a number too: if the module around has a constant of that
/// name, a pattern would mean the constant.
pub fn locals(names: &[String], reserved: &[&str]) -> Vec<Ident> {
    let mut taken: Vec<Ident> = Vec::new();
    for (index, name) in names.iter().enumerate() {
        let identifier = syn::parse_str::<Ident>(name)
            .ok()
            .filter(|identifier| !taken.contains(identifier))
            .filter(|_| !reserved.contains(&name.as_str()) && !is_numbered(name))
            .filter(|_| !name.starts_with(char::is_uppercase));
        taken.push(identifier.unwrap_or_else(|| format_ident!("a{index}")));
    }
    taken
}

/// `t0`, `a0`, `b0`, `l0` and `p0` are names that the code itself makes up, and `a` is the array of arguments.
fn is_numbered(name: &str) -> bool {
    let digits = name.strip_prefix(['t', 'a', 'b', 'l', 'p']);
    let numbered = digits.is_some_and(|digits| digits.chars().all(|c| c.is_ascii_digit()));
    name == "a" || (numbered && name.len() > 1)
}
