//! No panic and no runaway, whatever the tokens: valid declarations with tokens exchanged, dropped, doubled or nested.

use std::str::FromStr;
use std::time::{Duration, Instant};

use proc_macro2::TokenStream;
use quote::quote;

const DECLARATIONS: [&str; 8] = [
    "pub A ( x ) { param zeta in 0.0 .. ; param alpha > 0 ; param load ; law contact ( gap ) { gap > 0 => 2 * zeta * dot ( gap ) + gap ^ alpha , else => 0 } ddot ( x ) + contact ( x ) = cos ( omega * t ) + load ; }",
    "B ( x , y ) { param m > 0 ; param k ; let s = 2 / 5 * omega * t ; law h ( g , c ) { 0 < g <= 1 => c * g , g > 1 => c , else => 0 } m * ddot ( x ) + h ( x * cos ( s ) + y * sin ( s ) - 1 , k ) * sin ( s ) = 0 ; m * ddot ( y ) + 3 * y = m * omega ^ 2 * cos ( omega * t + pi ) ; }",
    "C ( x ) { param a > 0 ; ddot ( x ) + | | x | - 1 | ^ a + ( x ^ 2 - 1 ) * dot ( x ) + sgn ( x ) * x ^ 2 = cos ( omega * t ) ^ 3 ; }",
    "D ( x ) { param play > 0 ; law b ( g ) { g > play => ( g - play ) ^ 1.5 , g < - play => - ( - g - play ) ^ 1.5 , - play <= g && g <= play => 0 } ddot ( x ) + ( 1 + 0.2 * cos ( omega * t ) ) * b ( x ) = 0 ; }",
    "E ( u , v ) { param e ; ddot ( u ) + ( u - v ) ^ 3 / 2 + H ( u - v ) * sqrt ( | u - v | ) + tanh ( v ) = exp ( e ) ; ddot ( v ) + ( v - u ) ^ 3 + abs ( dot ( v ) ) * dot ( v ) = 0 ; }",
    "F ( x [ 5 ] , y ) { param k = 1e3 in 0.0 .. ; let n = 5 ; law c ( g ) { g > 0 => k * g ^ 1.5 , else => 0 } for j in 0 .. n - 1 { ddot ( x [ j ] ) + c ( x [ j ] - x [ j + 1 ] ) = 0 ; } ddot ( x [ 4 ] ) = 0 ; ddot ( y ) + for j in 0 ..= 7 { let a = 2 * pi * j / 8 ; cos ( omega * t + a ) * c ( y * cos ( a ) - j ) } = 0 ; }",
    "G ( x : mm , y : mm ) { param m : t = 1e-3 > 0 ; param k : N / mm ^ ( 3 / 2 ) = 1e9 in 0.0 .. ; param c : s / mm in 0.0 .. ; param g : N / mm ^ 3 ; law h ( u ) { u > 0 => max ( 0 , k * u ^ 1.5 * ( 1 + c * dot ( u ) ) ) , else => 0 } m * ddot ( x ) + h ( x ) + g * x * y ^ 2 = 0 ; m * ddot ( y ) + g * x ^ 2 * y = 0 ; }",
    "H1 ( x , y , z ) { param k > 0 ; param c >= 0 ; ddot ( x ) + max ( x , min ( 2 * x , 1 ) ) + | k * x + c * dot ( x ) | = 0 ; ddot ( y ) + x * y * z + ( x + y ) ^ 2 * ( z - 1 ) = 0 ; ddot ( z ) + dot ( x ) * dot ( y ) = for i in 1 .. 4 { cos ( i / 3 * omega * t ) } ; }",
];

const EXTRAS: [&str; 54] = [
    "+",
    "-",
    "*",
    "/",
    "^",
    "|",
    "(",
    ")",
    "{",
    "}",
    "[",
    "]",
    ",",
    ";",
    "=",
    "=>",
    ">",
    "<",
    ">=",
    "..",
    "&&",
    "#",
    "0",
    "1",
    "2zeta",
    "1e30",
    "1.5",
    "-1",
    "x",
    "gap",
    "t",
    "omega",
    "pi",
    "dot",
    "ddot",
    "H",
    "sgn",
    "param",
    "output",
    "force",
    "law",
    "let",
    "else",
    "170141183460469231731687303715884105727",
    "sin",
    "0.000000000001",
    "for j in 0 .. 3 {",
    "for",
    "in",
    "j",
    ":",
    "x [ j ]",
    "N",
    "max",
];

/// A small generator of numbers (xorshift), so that every run is the same.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % bound as u64).unwrap_or(0)
    }
}

fn is_bracket(word: &str) -> bool {
    word.contains(['(', ')', '[', ']', '{', '}'])
}

/// Something of the kind of a word: an operator for an operator, a number for a number, else the other word if it fits.
fn alike<'a>(word: &'a str, other: &'a str, random: &mut Random) -> &'a str {
    const OPERATORS: [&str; 5] = ["+", "-", "*", "/", "^"];
    const NUMBERS: [&str; 9] = ["0", "1", "2", "3", "1.5", "0.6", "1e-9", "1e30", "17"];
    let is_number = |word: &str| word.starts_with(|first: char| first.is_ascii_digit());
    let is_name = |word: &str| word.starts_with(|first: char| first.is_alphabetic());
    if OPERATORS.contains(&word) {
        OPERATORS[random.below(OPERATORS.len())]
    } else if is_number(word) {
        NUMBERS[random.below(NUMBERS.len())]
    } else if is_name(word) && is_name(other) {
        other
    } else {
        word
    }
}

fn mutated(random: &mut Random) -> String {
    let mut words: Vec<&str> = DECLARATIONS[random.below(DECLARATIONS.len())]
        .split(' ')
        .collect();
    for _ in 0..=random.below(3) {
        let position = random.below(words.len());
        let other = random.below(words.len());
        // Most changes leave brackets alone, or few of the declarations would lex.
        let plain = !is_bracket(words[position]) && !is_bracket(words[other]);
        match random.below(12) {
            0 => words.insert(position, EXTRAS[random.below(EXTRAS.len())]),
            1 => drop(words.remove(position)),
            2 if plain => words[position] = EXTRAS[random.below(EXTRAS.len())],
            3 if plain => words.swap(position, other),
            4..=10 => words[position] = alike(words[position], words[other], random),
            11 if plain => {
                let (start, end) = (
                    position.min(other),
                    position.max(other).min(position.min(other) + 12),
                );
                let copy: Vec<&str> = words[start..end].to_vec();
                words.splice(end..end, copy);
            }
            _ => {}
        }
    }
    words.join(" ")
}

/// Compiles and expands, if the text lexes at all: whether it is a model, and the time that took.
fn compile(text: &str) -> Option<(bool, Duration)> {
    let tokens = TokenStream::from_str(text).ok()?;
    let start = Instant::now();
    let sound = hertzian_compiler::compile(tokens.clone()).is_ok();
    let _ = hertzian_compiler::oscillator(&quote!(::hertzian), tokens);
    Some((sound, start.elapsed()))
}

/// How many declarations are mutated; ten times as many random ones are tried. `HERTZIAN_FUZZ=100000` is a thorough run.
fn count() -> usize {
    let given = std::env::var("HERTZIAN_FUZZ").ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(2000)
}

#[test]
fn unmutated_declarations_are_models() {
    for text in DECLARATIONS {
        assert!(compile(text).is_some_and(|(sound, _)| sound), "{text}");
    }
}

/// Prints how many there were, with `--nocapture`.
#[test]
fn mutated_declarations_do_not_panic() {
    let count = count();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut lexed, mut models, mut longest) = (0, 0, Duration::ZERO);
    for _ in 0..count {
        let text = mutated(&mut random);
        if let Some((sound, elapsed)) = compile(&text) {
            lexed += 1;
            models += usize::from(sound);
            longest = longest.max(elapsed);
            assert!(elapsed < Duration::from_secs(2), "took {elapsed:?}: {text}");
        }
    }
    println!("{count} mutated, {lexed} lexed, {models} models, {longest:?} at most");
    assert!(lexed > count / 4);
}

#[test]
fn random_tokens_do_not_panic() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for _ in 0..count() * 10 / 4 {
        let length = 1 + random.below(40);
        let words: Vec<&str> = (0..length)
            .map(|_| EXTRAS[random.below(EXTRAS.len())])
            .collect();
        compile(&words.join(" "));
        compile(&format!("M(x) {{ {} }}", words.join(" ")));
        compile(&format!("M(x) {{ ddot(x) + {} = 0; }}", words.join(" ")));
        compile(&format!(
            "M(x) {{ law f(gap) {{ {} }} ddot(x) + f(x) = 0; }}",
            words.join(" ")
        ));
    }
}

#[test]
fn deep_and_long_declarations_end() {
    for depth in [30, 45, 3000] {
        for (open, close) in [
            ("(", ")"),
            ("|", "|"),
            ("abs(", ")"),
            ("-", ""),
            ("2^", ""),
            ("sin(", ")"),
        ] {
            let text = format!(
                "M(x) {{ ddot(x) + {}x{} = 0; }}",
                open.repeat(depth),
                close.repeat(depth)
            );
            let _ = compile(&text);
        }
    }
    let doubled: Vec<String> = (0..400)
        .map(|i| format!("let a{} = a{i} + |a{i}|*a{i};", i + 1))
        .collect();
    let doubled = doubled.join(" ");
    let texts = [
        format!(
            "M(x) {{ ddot(x) + {} = 0; }}",
            vec!["x^3"; 5000].join(" + ")
        ),
        format!(
            "M(x) {{ ddot(x) + {} = 0; }}",
            vec!["(1 + cos(omega*t))"; 60].join("*")
        ),
        format!("M(x) {{ ddot(x) + {}x = 0; }}", "(x + 1)*".repeat(2000)),
        format!("M(x) {{ let a0 = x; {doubled} ddot(x) + a400 = 0; }}"),
        format!(
            "M(x) {{ ddot(x) + {} = 0; }}",
            (0..200)
                .map(|i| format!("|x - {i}|"))
                .collect::<Vec<_>>()
                .join("+")
        ),
        format!(
            "M(x) {{ ddot(x) + x = {}; }}",
            (1..500)
                .map(|i| format!("cos(1/{i}*omega*t)"))
                .collect::<Vec<_>>()
                .join("+")
        ),
    ];
    for text in texts {
        let (_, elapsed) = compile(&text).expect("lexes");
        assert!(
            elapsed < Duration::from_secs(10),
            "took {elapsed:?}: {}",
            &text[..80]
        );
    }
}
