//! Faults of a declaration: where they are, and how all of them are gathered.

use std::fmt;

use proc_macro2::{Ident, Span, TokenStream, TokenTree};

/// A stretch of the declaration, from the first to the last token of something.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    start: Span,
    end: Span,
}

impl Extent {
    /// One token.
    pub fn at(span: Span) -> Self {
        Self {
            start: span,
            end: span,
        }
    }

    /// From the start of this one to the end of another.
    #[must_use]
    pub fn to(self, last: Self) -> Self {
        Self {
            start: self.start,
            end: last.end,
        }
    }

    /// A fault at this place.
    ///
    /// A stable compiler cannot join two spans, but it underlines from the first to the last token of an error.
    pub fn fault(self, message: impl fmt::Display) -> syn::Error {
        let marks = [Ident::new("start", self.start), Ident::new("end", self.end)];
        syn::Error::new_spanned(
            marks
                .map(TokenTree::from)
                .into_iter()
                .collect::<TokenStream>(),
            message,
        )
    }
}

/// Longer than a name that anyone writes.
pub(crate) const LONGEST_NAME: usize = 64;

/// More than anyone reads at once.
const MOST_FAULTS: usize = 64;

/// What a message quotes of something that may be long.
const LONGEST_QUOTE: usize = 120;

/// As much of something written as a message may quote, and `...` for the rest.
pub(crate) fn shortened(whole: impl fmt::Display) -> String {
    let mut quote = Quote::default();
    // An error is how the rest is told not to be written.
    if fmt::write(&mut quote, format_args!("{whole}")).is_err() {
        quote.0.push_str("...");
    }
    quote.0
}

/// Takes text as long as there is room.
#[derive(Default)]
struct Quote(String);

impl fmt::Write for Quote {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let room = LONGEST_QUOTE.saturating_sub(self.0.chars().count());
        self.0.extend(text.chars().take(room));
        if text.chars().nth(room).is_some() {
            Err(fmt::Error)
        } else {
            Ok(())
        }
    }
}

/// Gathers faults, so that one compilation reports all of them. Must be asked with [`Diagnostics::finish`].
#[derive(Debug, Default)]
#[must_use]
pub struct Diagnostics {
    fault: Option<syn::Error>,
    count: usize,
    asked: bool,
}

impl Diagnostics {
    /// Adds a fault.
    pub fn report(&mut self, at: Extent, message: impl fmt::Display) {
        self.add(at.fault(message));
    }

    /// Adds a fault made elsewhere.
    pub fn add(&mut self, mut fault: syn::Error) {
        self.count += 1;
        if self.count > MOST_FAULTS {
            return;
        }
        if self.count == MOST_FAULTS {
            let message = format!("{fault} (what is wrong beyond this is not listed)");
            fault = syn::Error::new(fault.span(), message);
        }
        match &mut self.fault {
            Some(first) => first.combine(fault),
            None => self.fault = Some(fault),
        }
    }

    /// Puts one fault in the place of all.
    pub fn only(&mut self, fault: syn::Error) {
        self.count = 1;
        self.fault = Some(fault);
    }

    /// Keeps the value of a success, and the fault of a failure.
    pub fn keep<T>(&mut self, result: syn::Result<T>) -> Option<T> {
        result.map_err(|fault| self.add(fault)).ok()
    }

    /// How often something has been reported so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether nothing has been reported so far.
    pub fn is_clean(&self) -> bool {
        self.fault.is_none()
    }

    /// The faults, if there are any.
    ///
    /// # Errors
    /// All that was reported.
    pub fn finish(mut self) -> Result<(), Errors> {
        self.asked = true;
        self.fault.take().map_or(Ok(()), |fault| Err(Errors(fault)))
    }
}

impl Drop for Diagnostics {
    fn drop(&mut self) {
        debug_assert!(
            self.asked || std::thread::panicking(),
            "faults were gathered and never asked for"
        );
    }
}

/// Everything that is wrong with a declaration; at least one fault.
#[derive(Debug, Clone)]
pub struct Errors(syn::Error);

impl Errors {
    /// A stage failed and said nothing: a defect of the compiler, which must not become a panic.
    pub(crate) fn internal() -> Self {
        let message =
            "hertzian could not compile this declaration and does not know why; please report it";
        Self(syn::Error::new(Span::call_site(), message))
    }

    /// The faults one by one, in order.
    pub(crate) fn faults(&self) -> Vec<syn::Error> {
        self.0.clone().into_iter().collect()
    }

    /// The messages, in order.
    pub fn messages(&self) -> Vec<String> {
        self.faults().iter().map(ToString::to_string).collect()
    }

    /// What the macro emits: a `compile_error!` at each place.
    pub fn into_compile_error(self) -> TokenStream {
        self.0.into_compile_error()
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.messages().join("\n"))
    }
}

impl std::error::Error for Errors {}

/// The candidate that is nearest to a name, if one is near enough to be what was meant.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST_NAME {
        return None;
    }
    let near = |candidate: &'a str| (distance(name, candidate), candidate);
    let (edits, candidate) = candidates.into_iter().map(near).min()?;
    let letters = name.chars().count().max(candidate.chars().count());
    // A word of which every letter is another one is another word.
    let is_alike = edits < letters || name.eq_ignore_ascii_case(candidate);
    (edits <= 1 + name.chars().count() / 4 && is_alike).then_some(candidate)
}

/// Number of insertions, deletions and replacements between two words (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let replaced = diagonal + usize::from(letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
