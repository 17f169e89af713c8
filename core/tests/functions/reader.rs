//! Reads the functions of a text from its tokens.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

/// A function, with or without a body.
#[derive(Debug)]
pub struct Function {
    pub name: String,
    /// The line of its `fn`.
    pub line: usize,
    /// Lines of code between the braces of its body.
    pub lines: usize,
    /// An attribute says that it is long for a reason.
    pub may_be_long: bool,
    /// Parameters that are tuples.
    pub tuples: Vec<String>,
}

/// All functions of a text, those inside of others too.
pub fn functions(text: &str) -> Vec<Function> {
    let mut found = Vec::new();
    read(text.parse().expect("tokens of Rust"), &mut found);
    found
}

fn read(tokens: TokenStream, found: &mut Vec<Function>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut may_be_long = false;
    for (i, token) in tokens.iter().enumerate() {
        match token {
            TokenTree::Ident(word) if word == "fn" => {
                found.extend(function(&tokens, i, may_be_long));
                may_be_long = false;
            }
            TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket => {
                let text = group.stream().to_string().replace(' ', "");
                may_be_long |= text.starts_with("expect(clippy::too_many_lines,reason=");
                read(group.stream(), found);
            }
            TokenTree::Group(group) => {
                // What stands before a body or a list belongs to nothing behind it, but for `pub(crate)`.
                may_be_long &= group.delimiter() == Delimiter::Parenthesis;
                read(group.stream(), found);
            }
            _ => {}
        }
    }
}

/// The function whose `fn` is at a place; nothing where that is the type of a pointer, or a name that a macro puts in.
fn function(tokens: &[TokenTree], place: usize, may_be_long: bool) -> Option<Function> {
    let TokenTree::Ident(name) = tokens.get(place + 1)? else {
        return None;
    };
    let parameters = tokens[place..].iter().find_map(|token| match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis => Some(group),
        _ => None,
    })?;
    let mut lines = BTreeSet::new();
    let mut rest = tokens[place..].iter();
    let end = rest.find(|token| is_mark(token, ';') || is_group(token, Delimiter::Brace))?;
    if let TokenTree::Group(body) = end {
        add_lines(body.stream(), &mut lines);
    }
    Some(Function {
        name: name.to_string(),
        line: tokens[place].span().start().line,
        lines: lines.len(),
        may_be_long,
        tuples: tuples(parameters),
    })
}

/// Adds the lines that tokens stand on, but for documentation.
fn add_lines(tokens: TokenStream, lines: &mut BTreeSet<usize>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is_doc = |place: usize| match tokens.get(place) {
        Some(TokenTree::Group(group)) => group.stream().to_string().starts_with("doc ="),
        _ => false,
    };
    let mut add = |span: Span| lines.extend(span.start().line..=span.end().line);
    let mut inner = Vec::new();
    for (place, token) in tokens.iter().enumerate() {
        match token {
            _ if is_doc(place) || (is_mark(token, '#') && is_doc(place + 1)) => {}
            TokenTree::Group(group) => {
                add(group.span_open());
                add(group.span_close());
                inner.push(group.stream());
            }
            token => add(token.span()),
        }
    }
    for tokens in inner {
        add_lines(tokens, lines);
    }
}

/// Those of a list of parameters whose pattern or type is a tuple, or a reference to one.
fn tuples(parameters: &Group) -> Vec<String> {
    let parts = split(parameters.stream());
    let is_packed = |part: &&Vec<TokenTree>| {
        let colon = part.iter().position(|token| is_mark(token, ':'));
        let (pattern, of_type) = part.split_at(colon.unwrap_or(part.len()));
        is_tuple(pattern) || is_tuple(of_type.get(1..).unwrap_or_default())
    };
    let packed = parts.iter().filter(is_packed);
    let text = |part: &Vec<TokenTree>| part.iter().cloned().collect::<TokenStream>().to_string();
    packed.map(text).collect()
}

/// Whether tokens are a group of two things or more, behind a reference or not.
fn is_tuple(tokens: &[TokenTree]) -> bool {
    let mut before = None;
    for token in tokens {
        match token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis => {
                return split(group.stream()).len() > 1;
            }
            TokenTree::Punct(mark) if matches!(mark.as_char(), '&' | '\'') => {}
            TokenTree::Ident(word) if word == "mut" || before == Some('\'') => {}
            _ => return false,
        }
        before = match token {
            TokenTree::Punct(mark) => Some(mark.as_char()),
            _ => None,
        };
    }
    false
}

/// The parts of a list between its commas; those between angle brackets divide nothing.
fn split(tokens: TokenStream) -> Vec<Vec<TokenTree>> {
    let mut parts = vec![Vec::new()];
    let (mut depth, mut arrow) = (0, false);
    for token in tokens {
        let ends = depth == 0 && is_mark(&token, ',');
        if is_mark(&token, '<') {
            depth += 1;
        } else if is_mark(&token, '>') && !arrow {
            depth -= 1;
        }
        arrow = is_mark(&token, '-');
        if ends {
            parts.push(Vec::new());
        } else if let Some(part) = parts.last_mut() {
            part.push(token);
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

fn is_group(token: &TokenTree, delimiter: Delimiter) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == delimiter)
}

fn is_mark(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(found) if found.as_char() == mark)
}
