//! The emitted code, as text. `UPDATE_EXPANSIONS=1 cargo test -p hertzian-compiler` rewrites the expected text.

mod backend_models;

use std::path::PathBuf;

use hertzian_compiler::emit::emit;
use hertzian_compiler::ir::Model;

fn expansion(model: &Model) -> String {
    let file = syn::parse2(emit(model)).expect("the emitted code is Rust");
    prettyplease::unparse(&file)
}

#[test]
fn expansions_are_as_expected() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/backend_expansions");
    let update = std::env::var_os("UPDATE_EXPANSIONS").is_some();
    for model in backend_models::all() {
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
