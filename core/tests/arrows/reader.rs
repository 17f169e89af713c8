//! Reads the paths of a crate from its tokens.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A module that takes something from another one.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrow {
    /// The module, from the root.
    pub module: String,
    /// The room that it is in.
    pub from: String,
    /// The room that it names, or the name of the root.
    pub to: String,
    /// The path as resolved.
    pub path: String,
}

impl Arrow {
    /// Whether it names a room that stands before its own.
    pub fn runs_down(&self, order: &[&str]) -> bool {
        let place = |room: &str| order.iter().position(|known| *known == room);
        match (place(&self.from), place(&self.to)) {
            (Some(from), Some(to)) => to < from,
            _ => false,
        }
    }
}

/// What is known while the tokens of a module are read.
#[derive(Debug, Default)]
pub struct Reader {
    /// The room of the file; nothing for the root, which names all rooms.
    room: String,
    /// The module that the tokens are in, from the root.
    module: Vec<String>,
    pub arrows: BTreeSet<Arrow>,
    /// Modules in files of their own that are declared here.
    pub declared: Vec<String>,
}

impl Reader {
    /// The arrows of a text, as a module.
    pub fn of(module: &[String], text: &str) -> Self {
        let mut reader = Self {
            room: module.first().cloned().unwrap_or_default(),
            module: module.to_vec(),
            ..Self::default()
        };
        reader.read(text.parse().expect("tokens of Rust"));
        reader
    }

    fn read(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut i = 0;
        let mut tests_only = false;
        while i < tokens.len() {
            i = match &tokens[i] {
                TokenTree::Punct(mark) if mark.as_char() == '#' => {
                    tests_only |= self.attribute(tokens.get(i + 1));
                    // An inner attribute has a mark before its brackets, which is passed over.
                    i + 1 + usize::from(is_group(tokens.get(i + 1), Delimiter::Bracket))
                }
                TokenTree::Ident(word) if word == "pub" => {
                    i + 1 + usize::from(is_group(tokens.get(i + 1), Delimiter::Parenthesis))
                }
                _ if tests_only => {
                    tests_only = false;
                    end_of_item(&tokens, i)
                }
                TokenTree::Ident(word) if word == "mod" => self.module(&tokens, i),
                TokenTree::Ident(word) if begins_path(&tokens, i, &word.to_string()) => {
                    self.path(&tokens, i, &mut Vec::new())
                }
                TokenTree::Group(group) => {
                    self.read(group.stream());
                    i + 1
                }
                _ => i + 1,
            };
        }
    }

    /// Reads the paths that an attribute holds as text; whether it says that what follows is for tests only.
    fn attribute(&mut self, group: Option<&TokenTree>) -> bool {
        let Some(TokenTree::Group(group)) = group else {
            return false;
        };
        let text = group.stream().to_string().replace(' ', "");
        if text.starts_with("doc=") {
            return false;
        }
        self.texts(group.stream());
        text == "cfg(test)" || text.starts_with("cfg(all(test,")
    }

    /// `with = "crate::room::function"` and the like.
    fn texts(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.texts(group.stream()),
                TokenTree::Literal(literal) => {
                    let text = literal.to_string();
                    let inner = text.trim_matches('"');
                    let path = ["crate::", "self::", "super::"];
                    if path.iter().any(|begin| inner.starts_with(begin)) {
                        self.read(inner.parse().expect("a path"));
                    }
                }
                _ => {}
            }
        }
    }

    /// `mod name;` or `mod name { .. }` at a place.
    fn module(&mut self, tokens: &[TokenTree], i: usize) -> usize {
        let Some(TokenTree::Ident(name)) = tokens.get(i + 1) else {
            return i + 1;
        };
        if let Some(TokenTree::Group(body)) = tokens.get(i + 2) {
            self.module.push(name.to_string());
            self.read(body.stream());
            self.module.pop();
        } else {
            self.declared.push(name.to_string());
        }
        i + 3
    }

    /// A path from a place on, with everything in its braces; the place behind it.
    fn path(&mut self, tokens: &[TokenTree], mut i: usize, path: &mut Vec<String>) -> usize {
        let before = path.len();
        loop {
            match tokens.get(i) {
                Some(TokenTree::Ident(word)) => path.push(word.to_string()),
                Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                    for part in inner.split(|token| is_mark(Some(token), ',')) {
                        self.path(part, 0, path);
                    }
                    path.truncate(before);
                    return i + 1;
                }
                _ => break,
            }
            i += 1;
            if !has_colons(tokens, i) {
                break;
            }
            i += 2;
        }
        if path.len() > before || is_mark(tokens.get(i), '*') {
            self.arrow(path);
        }
        path.truncate(before);
        i
    }

    fn arrow(&mut self, path: &[String]) {
        let from_root = path[0] == "crate" || path[0] == "hertzian";
        let mut at = if from_root {
            Vec::new()
        } else {
            self.module.clone()
        };
        for (k, part) in path.iter().enumerate() {
            match part.as_str() {
                "super" => drop(at.pop()),
                "self" => {}
                _ if k == 0 && from_root => {}
                _ => at.push(part.clone()),
            }
        }
        let from = self.room.clone();
        let to = at.first().cloned().unwrap_or_default();
        if from != to && !from.is_empty() {
            self.arrows.insert(Arrow {
                module: self.module.join("::"),
                from,
                to,
                path: at.join("::"),
            });
        }
    }
}

fn is_group(token: Option<&TokenTree>, delimiter: Delimiter) -> bool {
    matches!(token, Some(TokenTree::Group(group)) if group.delimiter() == delimiter)
}

fn is_mark(token: Option<&TokenTree>, mark: char) -> bool {
    matches!(token, Some(TokenTree::Punct(found)) if found.as_char() == mark)
}

fn has_colons(tokens: &[TokenTree], i: usize) -> bool {
    is_mark(tokens.get(i), ':') && is_mark(tokens.get(i + 1), ':')
}

/// Whether a word is the beginning of a path within the crate, and not a part of one.
fn begins_path(tokens: &[TokenTree], i: usize, word: &str) -> bool {
    let inside =
        i >= 3 && has_colons(tokens, i - 2) && matches!(tokens[i - 3], TokenTree::Ident(_));
    let renamed = matches!(tokens.get(i + 1), Some(TokenTree::Ident(word)) if word == "as");
    match word {
        "crate" | "super" | "self" => !inside && (has_colons(tokens, i + 1) || renamed),
        "hertzian" => !inside && has_colons(tokens, i + 1),
        _ => false,
    }
}

/// The place behind the item, field or arm that begins at a place.
fn end_of_item(tokens: &[TokenTree], i: usize) -> usize {
    let ends = |token: &TokenTree| {
        let mark = is_mark(Some(token), ';') || is_mark(Some(token), ',');
        mark || is_group(Some(token), Delimiter::Brace)
    };
    let length = tokens[i..].iter().position(ends);
    length.map_or(tokens.len(), |length| i + length + 1)
}

/// All arrows from a file on, through the modules that it declares.
pub fn arrows(file: &Path, module: &[String]) -> BTreeSet<Arrow> {
    let text = fs::read_to_string(file).expect("a file of the crate");
    let mut reader = Reader::of(module, &text);
    let folder = match file.file_stem().and_then(|stem| stem.to_str()) {
        Some("lib" | "mod") => file.with_file_name(""),
        _ => file.with_extension(""),
    };
    for name in &reader.declared {
        let own = folder.join(name).with_extension("rs");
        let inner = [module, std::slice::from_ref(name)].concat();
        let file = if own.exists() {
            own
        } else {
            folder.join(name).join("mod.rs")
        };
        reader.arrows.append(&mut arrows(&file, &inner));
    }
    reader.arrows
}
