//! The texts: each made to a size.

/// A text of about so many characters.
pub type Make = fn(usize) -> String;

/// A model with items and a force.
fn model(items: &str, force: &str) -> String {
    format!("M(x) {{ {items} ddot(x) + x + {force} = cos(omega*t); }}")
}

/// `piece` as often as fits.
fn fill(size: usize, piece: &str) -> String {
    piece.repeat(size / piece.len())
}

/// Numbered pieces until it is full, and how many there are.
fn numbered(size: usize, piece: impl Fn(usize) -> String) -> (String, usize) {
    let mut text = String::new();
    let mut count = 0;
    while text.len() < size {
        text.push_str(&piece(count));
        count += 1;
    }
    (text, count)
}

fn number(size: usize, piece: impl Fn(usize) -> String) -> String {
    numbered(size, piece).0
}

/// A model with the force `0 + piece + ...`, numbered.
fn sum(size: usize, items: &str, piece: impl Fn(usize) -> String) -> String {
    model(
        items,
        &format!("0{}", number(size, |i| format!("+{}", piece(i)))),
    )
}

/// A model with the force `x*(piece)*...`, numbered.
fn product(size: usize, items: &str, piece: impl Fn(usize) -> String) -> String {
    model(
        items,
        &format!("x{}", number(size, |i| format!("*({})", piece(i)))),
    )
}

/// `let a0 = first; let a1 = next(a0); ...` and the last of them in the equation.
fn chain(size: usize, items: &str, first: &str, next: impl Fn(&str) -> String) -> String {
    let (lets, count) = numbered(size, |i| match i {
        0 => format!("let a0={first};"),
        _ => format!("let a{i}={};", next(&format!("a{}", i - 1))),
    });
    model(&format!("{items}{lets}"), &format!("a{}*x", count - 1))
}

/// Laws, each called once.
fn laws(size: usize, force: impl Fn(usize) -> String) -> String {
    let (laws, count) = numbered(size * 2 / 3, |i| format!("law f{i}(g){{{}}}", force(i)));
    let calls: Vec<String> = (0..count).map(|i| format!("f{i}(x)")).collect();
    model(&laws, &calls.join("+"))
}

/// A law with pieces.
fn pieces(law: &str) -> String {
    model(&format!("law f(g) {{ {law} }}"), "f(x)")
}

/// Parameters, each used.
fn parameters(size: usize) -> String {
    let (items, count) = numbered(size / 2, |i| format!("param a{i};"));
    let uses: Vec<String> = (0..count).map(|i| format!("a{i}*x")).collect();
    model(&items, &uses.join("+"))
}

/// Words of the language without an order.
fn words(size: usize) -> String {
    const WORDS: [&str; 25] = [
        "x", "(", ")", "+", "*", "^", "2", "let", "param", "a", ";", "=", "law", "{", "}", "for",
        "j", "in", "..", ",", "|", ">", "dot", "-", "[",
    ];
    let mut state = 1_u64;
    let mut text = String::new();
    while text.len() < size {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        text.push_str(WORDS[(state >> 33) as usize % WORDS.len()]);
        text.push(' ');
    }
    model("", &text)
}

/// Every kind of text that is long, deep, wide, or grows while it is compiled.
pub const CORPUS: &[(&str, Make)] = &[
    // Characters.
    ("nothing", |_| String::new()),
    ("spaces", |n| fill(n, " ")),
    ("comment", |n| model(&format!("/*{}*/", fill(n, "a")), "0")),
    ("nested comments", |n| fill(n, "/*")),
    ("line comments", |n| model(&fill(n, "//\n"), "0")),
    ("documentation", |n| {
        format!("{}{}", fill(n, "/// a\n"), model("", "0"))
    }),
    ("documentation of nothing", |n| {
        model(&fill(n, "/// a\n"), "0")
    }),
    ("one documentation", |n| {
        format!("/** {} */{}", fill(n, "a"), model("", "0"))
    }),
    ("strings", |n| fill(n, "\"")),
    ("string", |n| model("", &format!("\"{}\"", fill(n, "a")))),
    ("open string", |n| format!("\"{}", fill(n, "a"))),
    ("characters", |n| fill(n, "'")),
    ("lifetimes", |n| fill(n, "'a ")),
    ("raw string", |n| format!("r{}", fill(n, "#"))),
    ("zero bytes", |n| fill(n, "\0")),
    ("letters", |n| fill(n, "\u{e9}")),
    ("marks", |n| model("", &fill(n, "\u{2211}"))),
    ("words", words),
    // Names and numbers.
    ("name of the model", |n| {
        format!("{}(x) {{ ddot(x) = 0; }}", fill(n, "a"))
    }),
    ("name of a coordinate", |n| {
        let q = fill(n / 3, "q");
        format!("M({q}) {{ ddot({q}) + {q} = 0; }}")
    }),
    ("name of a parameter", |n| {
        model(&format!("param {};", fill(n / 2, "q")), &fill(n / 2, "p"))
    }),
    ("unknown name", |n| {
        model("param q;", &format!("q*{}", fill(n, "p")))
    }),
    ("unknown names", |n| {
        sum(n, "param qqqqqqqqqqqqq0;", |i| format!("p{i}"))
    }),
    ("unknown function", |n| {
        model("", &format!("{}(x)", fill(n, "p")))
    }),
    ("method", |n| model("", &format!("x.{}(1)", fill(n, "p")))),
    ("digits", |n| model("", &fill(n, "9"))),
    ("digits after the point", |n| {
        model("", &format!("0.{}", fill(n, "3")))
    }),
    ("zeros after the point", |n| {
        model("", &format!("0.{}1*x^3", fill(n, "0")))
    }),
    ("underscores", |n| {
        model("", &format!("1{}*x", fill(n, "_")))
    }),
    ("digits of an exponent", |n| {
        model("", &format!("1e{}*x", fill(n, "9")))
    }),
    ("large number", |_| model("", "1e999999*x")),
    ("small number", |_| model("", "1e-999999*x")),
    ("small numbers", |n| sum(n, "", |_| "1e-30*x^3".to_owned())),
    ("suffix", |n| model("", &format!("1{}", fill(n, "z")))),
    ("primes", |n| model("", &fill(n, "x'' + "))),
    // Brackets and signs.
    ("open parentheses", |n| model("", &fill(n, "("))),
    ("parentheses", |n| {
        model("", &format!("{}x{}", fill(n / 2, "("), fill(n / 2, ")")))
    }),
    ("brackets", |n| {
        format!("{}{}", fill(n / 2, "["), fill(n / 2, "]"))
    }),
    ("braces", |n| {
        format!("M(x) {}{}", fill(n / 2, "{"), fill(n / 2, "}"))
    }),
    ("braces in a row", |n| {
        format!("M(x) {{ {} }}", fill(n, "{}"))
    }),
    ("closing parentheses", |n| fill(n, ")")),
    ("calls in calls", |n| {
        model(
            "",
            &format!("{}x{}", fill(n * 4 / 5, "exp("), fill(n / 5, ")")),
        )
    }),
    ("indices in indices", |n| {
        model(
            "",
            &format!("{}x{}", fill(n * 2 / 3, "x["), fill(n / 3, "]")),
        )
    }),
    ("bars", |n| model("", &format!("{}x", fill(n, "|")))),
    ("bars in bars", |n| {
        model(
            "",
            &format!("{}x{}", fill(n * 3 / 4, "|1+"), fill(n / 4, "|")),
        )
    }),
    ("minus", |n| model("", &format!("{}x", fill(n, "-")))),
    ("plus", |n| model("", &format!("{}x", fill(n, "+")))),
    ("stars", |n| model("", &format!("x{}", fill(n, "*")))),
    ("equals", |n| model("", &format!("x{}", fill(n, "=x")))),
    ("semicolons", |n| fill(n, ";")),
    ("semicolons inside", |n| model(&fill(n, ";"), "0")),
    ("commas", |n| model("", &format!("max({})", fill(n, "x,")))),
    ("colons", |n| format!("M(x{}) {{}}", fill(n, ":"))),
    ("attributes", |n| fill(n, "#[doc = \"a\"]")),
    ("open attributes", |n| fill(n, "#")),
    ("visibility", |n| {
        format!("pub({}) M(x) {{ ddot(x) = 0; }}", fill(n, "in a::"))
    }),
    ("methods", |n| {
        model("", &format!("x{}", fill(n, ".powi(2)")))
    }),
    ("fields", |n| model("", &format!("x{}", fill(n, ".x")))),
    // Sums, products and powers.
    ("sum", |n| sum(n, "", |_| "x".to_owned())),
    ("sum of powers", |n| {
        sum(n, "", |i| format!("x^{}", i % 90 + 2))
    }),
    ("sum of squares", |n| sum(n, "", |i| format!("(x+{i})^2"))),
    ("sum of steps", |n| sum(n, "", |i| format!("H(x-{i})"))),
    ("sum of bars", |n| sum(n, "", |i| format!("|x-{i}|"))),
    ("sum of maxima", |n| sum(n, "", |i| format!("max(0,x-{i})"))),
    ("sum of waves", |n| {
        sum(n, "", |i| format!("cos({i}*omega*t)"))
    }),
    ("sum of fractions of waves", |n| {
        sum(n, "", |i| format!("cos(omega*t/{})", i + 1))
    }),
    ("sum of quotients", |n| {
        sum(n, "", |i| format!("x/{}", i + 1))
    }),
    ("sum of exponentials", |n| {
        sum(n, "", |i| format!("exp({i}*x)"))
    }),
    ("sum of calls", |n| {
        let law = "law f(g) { g > 0 => g^1.5, else => 0 }";
        sum(n, law, |i| format!("f(x-{i})"))
    }),
    ("product", |n| product(n, "", |_| "x".to_owned())),
    ("product of sums", |n| product(n, "", |_| "x+1".to_owned())),
    ("product of other sums", |n| {
        product(n, "", |i| format!("x+{i}"))
    }),
    ("product of parameters", |n| {
        product(n, "param a; param b;", |i| format!("a+{i}*b"))
    }),
    ("product of waves", |n| {
        product(n, "", |_| "cos(omega*t)".to_owned())
    }),
    ("product of numbers", |n| product(n, "", |_| "7".to_owned())),
    ("product of functions", |n| {
        product(n, "", |i| format!("tanh({i}*x)"))
    }),
    ("product of bars", |n| {
        product(n, "", |i| format!("|x-{i}|"))
    }),
    ("quotients", |n| model("", &format!("x{}", fill(n, "/2")))),
    ("quotients of sums", |n| {
        model(
            "param a>0;",
            &format!("x{}", number(n, |i| format!("/(a+{i})"))),
        )
    }),
    ("powers in powers", |n| {
        model("", &format!("x{}", fill(n, "^2")))
    }),
    ("powers of one", |n| {
        model("", &format!("x{}", fill(n, "^1")))
    }),
    ("large power", |_| model("", "(1+x)^999999999")),
    ("powers of powers", |_| {
        model("", "((((((((x+1)^12)^12)^12)^12)^12)^12)^12)^12")
    }),
    ("polynomial of many", |n| {
        let terms = number(n.min(60_000), |i| {
            format!("x[{}]*x[{}]+", i % 20, 7 * i % 20)
        });
        format!("M(x[20]) {{ for j in 0..20 {{ ddot(x[j]) + ({terms}0)^4 = 0; }} }}")
    }),
    // Names for parts.
    ("lets", |n| chain(n, "", "1", str::to_owned)),
    ("lets of squares", |n| {
        chain(n, "", "x+1", |a| format!("{a}*{a}"))
    }),
    ("lets of sums", |n| {
        chain(n, "", "x", |a| format!("{a}+{a}^2"))
    }),
    ("lets of functions", |n| {
        chain(n, "", "x", |a| format!("tanh({a})+{a}"))
    }),
    ("lets of nested functions", |n| {
        chain(n, "", "x", |a| format!("sin(1+{a})"))
    }),
    ("lets of bars", |n| {
        chain(n, "", "x", |a| format!("|{a}-1|"))
    }),
    ("lets of parameters", |n| {
        chain(n, "param p;", "p", |a| format!("exp({a})+{a}*{a}"))
    }),
    ("lets of numbers", |n| {
        chain(n, "", "1.5", |a| format!("{a}*{a}"))
    }),
    ("lets of waves", |n| {
        chain(n, "", "cos(omega*t)", |a| format!("{a}*{a}"))
    }),
    // Items.
    ("parameters", parameters),
    ("idle parameters", |n| {
        model(&number(n, |i| format!("param a{i};")), "0")
    }),
    ("equal parameters", |n| model(&fill(n, "param a;"), "0")),
    ("faulty parameters", |n| model(&fill(n, "param "), "0")),
    ("unit", |n| {
        format!(
            "M(x: m) {{ param k: N{}; ddot(x) + k*x = 0; }}",
            fill(n, "*m")
        )
    }),
    ("unit in parentheses", |n| {
        let (open, close) = (fill(n / 2, "("), fill(n / 2, ")"));
        format!("M(x: {open}m{close}) {{ ddot(x) = 0; }}")
    }),
    ("equal laws", |n| laws(n, |_| "g^3".to_owned())),
    ("laws", |n| laws(n, |i| format!("g^3+{i}*g^5"))),
    ("idle laws", |n| {
        model(&number(n, |i| format!("law f{i}(g){{g^3}}")), "0")
    }),
    ("arguments", |n| {
        let arguments = number(n, |i| format!(",a{i}"));
        model(&format!("law f(g{arguments}){{g^3}}"), "f(x)")
    }),
    ("pieces", |n| {
        let between = number(n, |i| format!("{i} <= g < {} => {i}*g^2,", i + 1));
        pieces(&format!("g < 0 => 0, {between} else => 1"))
    }),
    ("equal pieces", |n| {
        pieces(&format!("{} else => 1", fill(n, "g < 0 => 0,")))
    }),
    ("conditions", |n| {
        pieces(&format!("g < 0 {} => 0, else => 1", fill(n, "&& g < 0")))
    }),
    ("chained conditions", |n| {
        pieces(&format!(
            "g {} => 0, else => 1",
            number(n, |i| format!("< {i}"))
        ))
    }),
    ("equations", |n| {
        format!("M(x) {{ {} }}", fill(n, "ddot(x) = 0;"))
    }),
    ("coordinates", |n| {
        format!("M({}) {{ ddot(x0) = 0; }}", number(n, |i| format!("x{i},")))
    }),
    // Arrays and loops.
    ("long array", |_| {
        "M(x[100000]) { for j in 0..100000 { ddot(x[j]) + x[j]^3 = 0; } }".to_owned()
    }),
    ("longest array", |_| {
        "M(x[1024]) { for j in 0..1024 { ddot(x[j]) + x[j]^3 = 0; } }".to_owned()
    }),
    ("all with all", |_| {
        "M(x[64]) { for j in 0..64 { ddot(x[j]) + for i in 0..64 { (x[j] - x[i])^3 } = 0; } }"
            .to_owned()
    }),
    ("loops", |n| {
        sum(n, "", |_| "for j in 0..9 { x }".to_owned())
    }),
    ("loops in loops", |_| {
        model(
            "",
            "for i in 0..99 { for j in 0..99 { for k in 0..99 { x^3 } } }",
        )
    }),
    ("endless loop", |_| {
        model("", "for i in 0..99999999999999999999999999999999 { x }")
    }),
    ("endless empty loop", |_| {
        "M(x) { for i in 0..9999999 { } ddot(x) = 0; }".to_owned()
    }),
    ("long loop", |n| {
        let body = number(n, |i| format!("+{i}*x"));
        model("", &format!("for i in 0..4000 {{ i{body} }}"))
    }),
    ("long loop of lets", |n| {
        let body = number(n, |i| format!("let a{i}=i*{i};"));
        model("", &format!("for i in 0..4000 {{ {body} a0*x }}"))
    }),
    ("open loops", |n| model("", &fill(n, "for j in 0..9 { "))),
    ("loops of equations in loops", |n| {
        let (open, close) = (fill(n * 15 / 16, "for j in 0..9{"), fill(n / 16, "}"));
        format!("M(x) {{ {open};{close} }}")
    }),
];
