//! What `rustc` shows of the faults that the macros emit.

use std::fmt::Write as _;

use proc_macro2::{Delimiter, LineColumn, TokenStream, TokenTree};
use quote::quote;

/// A message and what it is about: from the first to behind the last character; lines from one, columns from zero.
struct Fault {
    message: String,
    start: LineColumn,
    end: LineColumn,
}

/// The messages of all declarations in a text, in their order, as `rustc` shows them of a file.
pub fn of(text: &str, file: &str) -> String {
    let mut faults = Vec::new();
    read(text.parse().expect("tokens of Rust"), &mut faults);
    let lines: Vec<&str> = text.lines().collect();
    let shown: Vec<String> = faults
        .iter()
        .map(|fault| show(fault, file, &lines))
        .collect();
    shown.join("\n")
}

/// Expands every `hertzian::oscillator! { ... }` and `hertzian::law! { ... }`, and takes the faults from what they emit.
fn read(tokens: TokenStream, faults: &mut Vec<Fault>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at..] {
            [path, first, second, name, mark, TokenTree::Group(group), ..]
                if is(path, "hertzian") && is(first, ":") && is(second, ":") && is(mark, "!") =>
            {
                let runtime = quote!(::hertzian);
                let expansion = if is(name, "law") {
                    hertzian_compiler::law(&runtime, group.stream())
                } else {
                    hertzian_compiler::oscillator(&runtime, group.stream())
                };
                emitted(expansion, faults);
                at += 6;
            }
            [TokenTree::Group(group), ..] if group.delimiter() == Delimiter::Brace => {
                read(group.stream(), faults);
                at += 1;
            }
            _ => at += 1,
        }
    }
}

fn is(token: &TokenTree, text: &str) -> bool {
    token.to_string() == text
}

/// Every `::core::compile_error! { "message" }`. What is wrong goes from the first of its tokens to the last.
fn emitted(expansion: TokenStream, faults: &mut Vec<Fault>) {
    let tokens: Vec<TokenTree> = expansion.into_iter().collect();
    for call in tokens.windows(8) {
        let [first, .., name, mark, TokenTree::Group(group)] = call else {
            continue;
        };
        if is(name, "compile_error") && is(mark, "!") {
            let message: syn::LitStr = syn::parse2(group.stream()).expect("a message");
            faults.push(Fault {
                message: message.value(),
                start: first.span().start(),
                end: group.span().end(),
            });
        }
    }
}

/// One message: what is wrong, the place, and the lines with what is meant underlined.
fn show(fault: &Fault, file: &str, lines: &[&str]) -> String {
    let Fault {
        message,
        start,
        end,
    } = fault;
    let width = end.line.to_string().len();
    let (row, column) = (start.line, start.column + 1);
    let mut shown = format!("error: {message}\n{:width$}--> {file}:{row}:{column}\n", "");
    let mut line = |number: &str, text: &str| {
        let _ = writeln!(shown, "{}", format!("{number:width$} {text}").trim_end());
    };
    line("", "|");
    let text = |number: usize| lines[number - 1];
    if start.line == end.line {
        line(&start.line.to_string(), &format!("| {}", text(start.line)));
        let marks = "^".repeat(end.column - start.column);
        line("", &format!("| {}{marks}", " ".repeat(start.column)));
    } else {
        for number in start.line..=end.line {
            let mark = if number == start.line { '/' } else { '|' };
            line(&number.to_string(), &format!("| {mark} {}", text(number)));
        }
        line("", &format!("| |{}^", "_".repeat(end.column)));
    }
    shown
}
