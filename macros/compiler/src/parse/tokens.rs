//! Tokens in a row, with a position that can be moved: what recovery from a fault needs.

use proc_macro2::{Delimiter, Ident, Spacing, Span, TokenStream, TokenTree};

use crate::errors::{Extent, shortened};

/// More tokens than a declaration that compiles in good time has.
const MOST_TOKENS: usize = 1 << 16;

/// One token. The brackets of a group are tokens of their own.
#[derive(Debug, Clone)]
pub enum Token {
    /// A name.
    Name(Ident),
    /// A literal, as written.
    Literal(String),
    /// A character of an operator; whether the next one follows without a space.
    Mark(char, bool),
    /// An opening bracket, and the position of the closing one.
    Open(Delimiter, usize),
    /// A closing bracket.
    Close(Delimiter),
    /// After the last token.
    End,
}

/// The tokens of a declaration and a position among them.
#[derive(Debug)]
pub struct Tokens {
    tokens: Vec<(Token, Span)>,
    position: usize,
}

impl Tokens {
    /// Flattens a stream, without recursion: nothing is known yet of how deep it is.
    ///
    /// # Errors
    /// If it has too many tokens; the fault is at the first of these.
    pub fn new(stream: TokenStream) -> syn::Result<Self> {
        let mut tokens: Vec<(Token, Span)> = Vec::new();
        let mut open: Vec<(usize, Delimiter, Span, proc_macro2::token_stream::IntoIter)> =
            Vec::new();
        let mut rest = stream.into_iter();
        loop {
            if tokens.len() > MOST_TOKENS {
                let place = tokens
                    .last()
                    .map_or_else(Span::call_site, |(_, span)| *span);
                return Err(Extent::at(place).fault(format!(
                    "more than {MOST_TOKENS} names, numbers and marks: write what repeats as a loop"
                )));
            }
            match rest.next() {
                Some(TokenTree::Group(group)) => {
                    open.push((tokens.len(), group.delimiter(), group.span_close(), rest));
                    tokens.push((Token::Open(group.delimiter(), 0), group.span_open()));
                    rest = group.stream().into_iter();
                }
                Some(TokenTree::Ident(name)) => {
                    let span = name.span();
                    tokens.push((Token::Name(name), span));
                }
                Some(TokenTree::Literal(literal)) => {
                    tokens.push((Token::Literal(literal.to_string()), literal.span()));
                }
                Some(TokenTree::Punct(mark)) => {
                    let joint = mark.spacing() == Spacing::Joint;
                    tokens.push((Token::Mark(mark.as_char(), joint), mark.span()));
                }
                None => match open.pop() {
                    Some((opening, delimiter, span, outer)) => {
                        tokens[opening].0 = Token::Open(delimiter, tokens.len());
                        tokens.push((Token::Close(delimiter), span));
                        rest = outer;
                    }
                    None => break,
                },
            }
        }
        let last = tokens
            .last()
            .map_or_else(Span::call_site, |(_, span)| *span);
        tokens.push((Token::End, last));
        Ok(Self {
            tokens,
            position: 0,
        })
    }

    /// The next token.
    pub fn peek(&self) -> &Token {
        self.ahead(0)
    }

    /// The token after the next `distance` ones.
    pub fn ahead(&self, distance: usize) -> &Token {
        let last = self.tokens.len() - 1;
        &self.tokens[(self.position + distance).min(last)].0
    }

    /// Where the next token stands.
    pub fn here(&self) -> Extent {
        Extent::at(self.tokens[self.position].1)
    }

    /// Where the last token before the position stands.
    pub fn before(&self) -> Extent {
        Extent::at(self.tokens[self.position.saturating_sub(1)].1)
    }

    /// Takes the next token.
    pub fn next(&mut self) -> Token {
        let token = self.tokens[self.position].0.clone();
        self.position = (self.position + 1).min(self.tokens.len() - 1);
        token
    }

    /// Where the position is, for a later look at [`Tokens::is_past`].
    pub fn position(&self) -> usize {
        self.position
    }

    /// Moves to a position.
    pub fn go_to(&mut self, position: usize) {
        self.position = position.min(self.tokens.len() - 1);
    }

    /// Skips one token, or a whole group.
    pub fn skip(&mut self) {
        if let Token::Open(_, close) = *self.peek() {
            self.position = close;
        }
        self.next();
    }

    /// Whether an operator is next: its characters, one after the other without spaces.
    pub fn is(&self, operator: &str) -> bool {
        let length = operator.chars().count();
        operator.chars().enumerate().all(|(index, expected)| {
            matches!(self.ahead(index), Token::Mark(mark, joint) if *mark == expected && (*joint || index + 1 == length))
        })
    }

    /// Takes an operator if it is next.
    pub fn take(&mut self, operator: &str) -> bool {
        let found = self.is(operator);
        if found {
            self.position += operator.chars().count();
        }
        found
    }

    /// Takes a certain word if it is next.
    pub fn take_word(&mut self, word: &str) -> bool {
        let found = matches!(self.peek(), Token::Name(name) if name == word);
        if found {
            self.position += 1;
        }
        found
    }

    /// Whether the group that closes at a position ends with `;`, or with a group that does.
    pub fn ends_with_mark(&self, close: usize) -> bool {
        let last = self.tokens[..close]
            .iter()
            .rev()
            .map(|(token, _)| token)
            .find(|token| !matches!(token, Token::Close(Delimiter::Brace)));
        matches!(
            last,
            Some(Token::Mark(';', _) | Token::Open(Delimiter::Brace, _))
        )
    }

    /// The next token as a message names it.
    pub fn found(&self) -> String {
        match self.peek() {
            Token::Name(name) => format!("`{}`", shortened(name)),
            Token::Literal(text) => format!("`{}`", shortened(text)),
            Token::Mark(mark, _) => format!("`{mark}`"),
            Token::Open(delimiter, _) => format!("`{}`", brackets(*delimiter).0),
            Token::Close(delimiter) => format!("`{}`", brackets(*delimiter).1),
            Token::End => "the end of the declaration".into(),
        }
    }
}

/// The two brackets of a group; a group without any comes from an outer macro.
fn brackets(delimiter: Delimiter) -> (char, char) {
    match delimiter {
        Delimiter::Parenthesis | Delimiter::None => ('(', ')'),
        Delimiter::Brace => ('{', '}'),
        Delimiter::Bracket => ('[', ']'),
    }
}
