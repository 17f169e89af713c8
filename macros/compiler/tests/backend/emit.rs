//! The emitted code, as text. `UPDATE_EXPANSIONS=1 cargo test -p hertzian-compiler` rewrites the expected text.

use std::path::PathBuf;

use hertzian_compiler::emit::emit;
use hertzian_compiler::ir::Model;
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

fn expansion(model: &Model) -> String {
    let file = syn::parse2(emit(&quote!(::hertzian), model)).expect("the emitted code is Rust");
    prettyplease::unparse(&file)
}

#[test]
fn expansions_are_as_expected() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/backend_expansions");
    let update = std::env::var_os("UPDATE_EXPANSIONS").is_some();
    for model in crate::models::all() {
        let path = folder.join(format!("{}.txt", model.name));
        let text = expansion(&model);
        if update {
            std::fs::write(&path, &text).expect("the folder is writable");
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            text == expected,
            "{} differs from {}",
            model.name,
            path.display()
        );
    }
}

/// The words of a stream, also within brackets.
fn words(tokens: TokenStream, found: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => words(group.stream(), found),
            TokenTree::Ident(word) => found.push(word.to_string()),
            _ => {}
        }
    }
}

#[test]
fn the_runtime_is_named_by_the_given_path_alone() {
    let runtime = quote!(here::vibration);
    let mut expansions: Vec<TokenStream> = crate::models::all()
        .iter()
        .map(|model| emit(&runtime, model))
        .collect();
    for text in [
        "pub Faulty(x) { param k; ddot(x) + q = 0; }",
        "Beads(x[3]) { param k > 0; for j in 0..3 { ddot(x[j]) + k*x[j]^3 = cos(omega*t); } }",
    ] {
        let tokens = text.parse().expect("tokens");
        expansions.push(hertzian_compiler::oscillator(&runtime, tokens));
    }
    for text in [
        "Hertz(gap, k > 0) { gap > 0 => k*gap^1.5, else => 0 }",
        "Faulty(gap) { gap^1.5 }",
    ] {
        let tokens = text.parse().expect("tokens");
        expansions.push(hertzian_compiler::law(&runtime, tokens));
    }
    for expansion in expansions {
        let text = expansion.to_string();
        let mut found = Vec::new();
        words(expansion, &mut found);
        let named = |name: &str| found.iter().filter(|word| *word == name).count();
        assert_eq!(named("vibration"), 1, "{text}");
        assert_eq!(named("hertzian"), 0, "{text}");
    }
}
