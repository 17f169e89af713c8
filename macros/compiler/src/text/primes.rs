//! Primes, `x''`. They are no tokens of Rust, so they are looked for in the text itself, once it has been found faulty.

use super::Fault;

/// Every name with primes behind it, outside of comments; each once.
pub(super) fn faults(text: &str) -> Vec<Fault> {
    let mut faults: Vec<Fault> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let code = line.find("//").map_or(line, |comment| &line[..comment]);
        for (start, _) in code.match_indices('\'') {
            let (before, after) = code.split_at(start);
            let Some(name) = name_at_end(before) else {
                continue;
            };
            let primes: String = after.chars().take_while(|&mark| mark == '\'').collect();
            let written = format!("{name}{primes}");
            let message = match primes.len() {
                1 => format!("a derivative by time is written `dot({name})`, not `{written}`"),
                2 => format!(
                    "a second derivative by time is written `ddot({name})`, not `{written}`"
                ),
                _ => format!(
                    "`{written}` is a higher derivative than the second, which has no place here"
                ),
            };
            if faults.iter().all(|fault| fault.message != message) {
                faults.push(Fault {
                    message,
                    line: index + 1,
                    column: before.chars().count() - name.chars().count() + 1,
                });
            }
        }
    }
    faults
}

/// The name, with its index in brackets, that ends a text.
fn name_at_end(text: &str) -> Option<&str> {
    let base = if text.ends_with(']') {
        &text[..text.rfind('[')?]
    } else {
        text
    };
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let start = base.trim_end_matches(is_part).len();
    let name = &text[start..];
    let is_name = base[start..].starts_with(|first: char| first.is_alphabetic() || first == '_');
    is_name.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primes_are_found_where_they_stand() {
        let text = "M(x, y[2]) { // don't look here'\n  x'' + 2*x' + x' = 0;\n  y[0]'' = x''';\n}";
        let found = faults(text).into_iter().map(|fault| fault.to_string());
        let expected = [
            "2:3: a second derivative by time is written `ddot(x)`, not `x''`",
            "2:11: a derivative by time is written `dot(x)`, not `x'`",
            "3:3: a second derivative by time is written `ddot(y[0])`, not `y[0]''`",
            "3:12: `x'''` is a higher derivative than the second, which has no place here",
        ];
        assert_eq!(found.collect::<Vec<_>>(), expected);
        assert!(faults("'1' + '' + 2' ]'\n /// it's").is_empty());
    }
}
