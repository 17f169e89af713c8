//! Figures of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722, as command lines.

use std::ffi::OsString;

/// Name of a figure, and the options it stands for.
pub const FIGURES: [(&str, &str); 5] = [
    (
        "8b",
        "--sweep drive --alpha 1 --from 0.1 --to 2.1 --values 1001 --transient 400 --periods 150 --up --down",
    ),
    (
        "9b",
        "--phase --alpha 1 --drive 1 --x-range -60 10 --v-range -12 12 --starts 24 --longest 5 --patience 3000 \
         --zoom -12 6 -6 6",
    ),
    (
        "10a",
        "--history --alpha 1 --drive 1.78 --start -0.35 0.335 --transient 2000 --periods 12000 --every 8",
    ),
    (
        "10b",
        "--history --alpha 1 --drive 1.785 --start -0.35 0.335 --transient 2000 --periods 12000 --every 1",
    ),
    (
        "11",
        "--phase --alpha 1 --drives 1.7798 1.78 1.785 --mark 1.77983 --start -0.35 0.335 --starts 0 \
         --zoom -8 4 -4.5 4.5",
    ),
];

/// Puts the options of a figure in the place of `--figure NAME`. Options that are given again after it take their place.
pub fn expanded(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut expanded = Vec::new();
    let mut arguments = arguments.into_iter();
    while let Some(argument) = arguments.next() {
        let text = argument.to_str().unwrap_or_default();
        let name = match text.strip_prefix("--figure=") {
            Some(name) => Some(OsString::from(name)),
            None if text == "--figure" => arguments.next(),
            None => None,
        };
        let known = name.as_ref().and_then(|name| options_of(name.to_str()?));
        match (known, name) {
            (Some(options), _) => expanded.extend(options.split_whitespace().map(OsString::from)),
            // The parser says what is wrong.
            (None, Some(name)) => expanded.extend(["--figure".into(), name]),
            (None, None) => expanded.push(argument),
        }
    }
    expanded
}

/// The options of a figure.
pub fn options_of(name: &str) -> Option<&'static str> {
    let figure = FIGURES.iter().find(|figure| figure.0 == name);
    figure.map(|figure| figure.1)
}

/// The commands, for `--help`.
pub fn help() -> String {
    let lines = FIGURES
        .iter()
        .map(|(name, options)| format!("  --figure {name:<4} {options}\n"));
    format!(
        "Examples:\n  \
         hertzian attractors --sweep drive --alpha 1 --from 0.1 --to 2.1 --up --down\n  \
         hertzian attractors --basin --alpha 1 --drive 1 --grid 512 --checkpoint basin.log\n  \
         hertzian attractors --lyapunov --alpha 1 --drive 1.785\n  \
         hertzian attractors --figure 10a --out figure10a\n\n\
         Figures of Wang, Zhang, Ying and Pang (2021), Appl. Sci. 11, 7722, and the options they stand for; options given after \
         them take their place:\n{}\n\
         Exit codes: 0 all was computed; 2 bad input; 3 ended before (what was computed is written).",
        lines.collect::<String>()
    )
}
