//! Text with errors: each error with its code and span, the valid rest in the tree.

use crate::codes::*;
use psd_text::diagnostic::Code;

use super::{errors, outline, read};

fn one(text: &str, code: Code, text_at_fault: &str) {
    assert_eq!(errors(text), [(code, text_at_fault.to_owned())], "{text}");
}

fn field(value: &str, code: Code, text_at_fault: &str) {
    one(
        &format!("b {{\n  x = {value}\n  y = 2\n}}\n"),
        code,
        text_at_fault,
    );
}

#[test]
fn syntax_errors_state_what_was_found_and_expected() {
    field("", E101, "");
    field("1 kg 2", E101, "2");
    field("* 2", E101, "*");
    field("1 + * 2", E101, "*");
    field("a b", E101, "b");
    field("[1, 2", E102, "[");
    field("f(1; 2)", E101, ";");
    field("f(a: 1, 2)", E101, "2");
    field("1)", E101, ")");
    field("--1", E101, "-");
    field("step", E101, "step");
    field("1 < 2 < 3", E101, "<");
    field("a.", E101, "");
    one("let = 3\n", E101, "=");
    one("require 3 < 4\n", E101, "3");
    one("}\n", E101, "}");
    one("limits 3 {\n  x = 1\n}\n", E101, "3");
    one("a {\n x = 1\n  limits {\n  y = 2\n }\n}\n", E101, "limits");
    one("a { x = 1 } let b = 2\n", E101, "let");
    one("a { x = 1 kg y = 2 }\n", E101, "y");
    one("x = 3\n", E101, "x");
    one("striker pendulum\n", E101, "striker pendulum");
    one("3\n", E101, "3");
    let (_, found, _) = read("b {\n  mass =\n}\n");
    assert_eq!(
        found[0].message,
        "found the end of the line, expected a value"
    );
    let (_, found, _) = read("b {\n  mass 3\n}\n");
    assert_eq!(found[0].message, "found `3`, expected `=`");
    let (_, found, _) = read("b {\n  mass = 3 kg x\n}\n");
    assert!(
        found[0]
            .message
            .starts_with("found `x`, expected an operator"),
        "{}",
        found[0].message
    );
    assert!(found[0].help.is_some());
}

#[test]
fn an_open_bracket_is_reported_where_it_opens_and_swallows_nothing() {
    for open in ["f(1", "[1, 2", "(1 + (2)", "f(1,\n    [2"] {
        let text = format!("a {{\n  x = {open}\n  y = 2\n}}\nlet z = 3\n");
        let (ast, found, sources) = read(&text);
        assert_eq!(found.len(), 1, "{found:#?}");
        assert_eq!(found[0].code, E102);
        assert!(["(", "["].contains(&sources.text(found[0].span().unwrap())));
        assert_eq!(outline(&ast), "a\n  x = ?\n  y = 2\nlet z = 3\n");
    }
    let (ast, found, sources) = read("a {\n  x = 1\n\nb {\n  y = 2\n}\nlet c = [1\n");
    assert_eq!(
        found.iter().map(|error| error.code).collect::<Vec<_>>(),
        [E102, E102]
    );
    assert_eq!(sources.position(found[0].span().unwrap()).line, 1);
    assert_eq!(outline(&ast), "a\n  x = 1\nb\n  y = 2\nlet c = ?\n");
    one("a {", E102, "{");
    let many = format!("a {{\n{}}}\n", "x = f(\n".repeat(100));
    assert!(errors(&many).iter().all(|(code, _)| *code == E102) && errors(&many).len() == 100);
    field("f([1, 2)", E102, "[");
}

#[test]
fn numbers_are_decimal_with_digits_on_both_sides() {
    for (written, help) in [
        ("1,5", "write `1.5`"),
        ("1_000", "write `1000`"),
        ("0x10", "write `16`"),
        (".5", "write `0.5`"),
        ("5.", "write `5`"),
        ("1e", "write `1`"),
        ("1e-400", "write `0`"),
        ("1e400", "write a number such as `0.5` or `1.5e6`"),
        ("1.2.3", "write a number such as `0.5` or `1.5e6`"),
        (".5e3", "write `0.5e3`"),
    ] {
        field(&format!("{written} kg"), E103, written);
        let (_, found, _) = read(&format!("let x = {written}\n"));
        assert_eq!(found[0].help.as_deref(), Some(help), "{written}");
    }
    for (written, help) in [
        ("1 000", "write `1000`"),
        ("12 345 678.5", "write `12345678.5`"),
        ("1'000", "write `1000`"),
        ("1,000", "write `1000` or `1.000`"),
        ("1,000,000.5", "write `1000000.5`"),
        ("1.000,5", "write `1000.5`"),
    ] {
        field(&format!("{written} kg"), E103, written);
        let (_, found, _) = read(&format!("let x = f({written} kg)\n"));
        assert_eq!(
            found.first().and_then(|error| error.help.as_deref()),
            Some(help).filter(|_| !written.contains(',')),
            "{written}"
        );
    }
    // In a list a comma is missing.
    field("[100 200]", E101, "100 200");
    let long = "1".repeat(41);
    field(&long, E103, &long);
    assert_eq!(errors(&format!("let x = {}\n", "1".repeat(40))), []);
    assert_eq!(errors("let x = [1,5] m\n"), []);
}

#[test]
fn operators_keep_off_units() {
    for (written, glued, corrected) in [
        ("2 kg*3", "kg*3", "kg * 3"),
        ("2 kg*(x)", "kg*(x)", "kg * (x)"),
        ("2 kg*k0.mass", "kg*k0.mass", "kg * k0.mass"),
        ("[1, 2] m/2", "m/2", "m / 2"),
        ("10 %*2", "%*2", "% * 2"),
        ("2 m* 3", "m*", "m *"),
    ] {
        field(written, E104, glued);
        let (_, found, _) = read(&format!("let x = {written}\n"));
        assert!(
            found[0].help.as_ref().unwrap().contains(corrected),
            "{:?}",
            found[0].help
        );
    }
    assert_eq!(
        errors("let x = 2 kg*x\nlet y = 1 m/s..3 m/s\nlet z = 2*x\n"),
        []
    );
}

#[test]
fn characters_that_hide_are_refused_and_shown() {
    one("\u{feff}let x = 1\n", E106, "\u{feff}");
    one("let x = 1\0\n", E106, "\0");
    one("let x = \"a\u{202e}b\"\n", E106, "\u{202e}");
    one("let x\u{200d}y = 1\n", E106, "\u{200d}");
    one("let l\u{456}m = 1\n", E106, "\u{456}");
    one("let x = \"\u{1b}]0;t\"\n", E106, "\u{1b}");
    one("# \u{1b}[2J\n", E106, "\u{1b}");
    one("let x = \"abc\n", E106, "\"");
    one("let x = \"a\\qb\"\n", E106, "\\q");
    one("let x = 1\rlet y = 2\n", E106, "\r");
    assert_eq!(errors("# \u{202e} in a comment\n"), []);
    let (_, found, _) = read("let x = \"a\u{202e}b\"\n");
    assert!(found[0].message.contains("\\u{202e}"));
}

/// Offsets stay those of the written text, and the text that is read is the one that was meant.
#[test]
fn what_only_looks_like_the_language_is_read_as_it_was_meant() {
    for (written, meant, text_at_fault) in [
        ("b {\n  x\u{a0}= 1 kg\n}\n", "b\n  x = 1 kg\n", "\u{a0}"),
        ("b {\n  x = −1 kg\n}\n", "b\n  x = (- 1 kg)\n", "−"),
        ("b {\n  x = 2 × 3\n}\n", "b\n  x = (2 * 3)\n", "×"),
        ("require \"r\" a ≤ 2\n", "require \"r\" (a <= 2)\n", "≤"),
        ("require \"r\" a => 2\n", "require \"r\" (a >= 2)\n", "=>"),
        ("b {\n  x = 2 m² # m²\n}\n", "b\n  x = 2 m^2\n", "²"),
        ("b {\n  x = 2 s⁻¹\n}\n", "b\n  x = 2 s^-1\n", "⁻¹"),
        ("b {\n  x = “é”\n}\n", "b\n  x = \"é\"\n", "“é”"),
        ("b {\n  x = 'a'\n}\n", "b\n  x = \"a\"\n", "'a'"),
        ("b {\n  x = \"a”\n}\n", "b\n  x = \"a\"\n", "\"a”"),
        ("b {\n  x = 1; y = 2;\n}\n", "b\n  x = ?\n", ";"),
        ("b {\n  x = 1; # c\n}\n", "b\n  x = 1\n", ";"),
        ("let x = 1 // = one\n", "let x = 1\n", "//"),
        ("/* a\n} */ let x = 1\n", "let x = 1\n", "/*"),
        (
            "let hämmer = 1\nlet y = hämmer\n",
            "let hammer = 1\nlet y = hammer\n",
            "ä",
        ),
        (
            "l\u{456}mits {\n  x = 1\n}\n",
            "limits\n  x = 1\n",
            "\u{456}",
        ),
        ("impact hit\n{\n  x = 1\n}\n", "impact hit\n  x = 1\n", "{"),
        (
            "impact hit\n  x = 1\n}\nlet y = 2\n",
            "impact hit\n  x = 1\nlet y = 2\n",
            "impact hit",
        ),
        ("let y = a->b\n", "let y = (a . b)\n", "->"),
    ] {
        let (ast, found, sources) = read(written);
        assert_eq!(outline(&ast), meant, "{written}");
        let found_texts: Vec<&str> = found
            .iter()
            .map(|error| sources.text(error.span().unwrap()))
            .collect();
        assert_eq!(found_texts, [text_at_fault], "{written}: {found:#?}");
    }
    for sound in [
        "# “x” − //\nlet x = 1\n",
        "let x = \"“a” − /* ; = < ²\"\n",
        "let x = 5 µm\nlet y = 5 μm\n",
    ] {
        assert_eq!(errors(sound), []);
    }
    let (_, found, _) = read("let a = 1\u{a0}m\nlet b = 2\u{a0}m\nlet c = 3\u{a0}m\n");
    assert_eq!(found.len(), 1, "reported once, however often");
    assert!(
        found[0].message.ends_with("here and in 2 other lines"),
        "{}",
        found[0].message
    );
}

#[test]
fn all_errors_of_a_file_are_found_at_once() {
    let text = "use lib\n\nspecimen beam {\n  length = 1,4 m\n  mass = elastic(3 kg\n  density = 5 kg\n  q = = 3\n  r = \"ok\"\n}\n\nlet good = 1 m\nrequire \"r\" 1 <\n\nstriker p {\n  mass = 20 kg\n  velocity = 2 m*3\n}\nlet k = (1\n";
    assert_eq!(
        errors(text)
            .iter()
            .map(|(code, text_at_fault)| (*code, text_at_fault.as_str()))
            .collect::<Vec<_>>(),
        [
            (E101, "lib"),
            (E103, "1,4"),
            (E102, "("),
            (E101, "="),
            (E101, ""),
            (E104, "m*3"),
            (E102, "(")
        ]
    );
    let (ast, ..) = read(text);
    assert_eq!(
        outline(&ast),
        "specimen beam\n  length = ?\n  mass = ?\n  density = 5 kg\n  q = ?\n  r = \"ok\"\nlet good = 1 m\nrequire \"r\" ?\nstriker p\n  mass = 20 kg\n  velocity = ?\nlet k = ?\n"
    );
}

#[test]
fn a_faulty_list_over_lines_is_one_error() {
    one(
        "a {\n  x = [\n    f(1, 2),\n    f(; 2),\n    f(3),\n  ]\n  y = 1\n}\n",
        E101,
        ";",
    );
}

#[test]
fn helps_are_written_for_the_error() {
    let found = |text: &str| {
        let (_, found, _) = read(text);
        format!("{} | {}", found[0].message, found[0].help.clone().unwrap())
    };
    for (text, expected) in [
        ("b {\n  x 3\n}", "found `3`, expected `=` | write `=` here"),
        (
            "b {\n  x = f(1 2)\n}",
            "a comma is missing between two values | write `1, 2`",
        ),
        (
            "b {\n  x = 1 kg y\n}",
            "found `y`, expected an operator or the end of the line | write one field or item per line",
        ),
        (
            "striker p\n",
            "`striker p` is neither a block nor an item | write `{` on this line for a block, as in `striker hammer {`; write `#` before a comment",
        ),
        (
            "plan \"a\" x {\n}\n",
            "found `x`, expected `{` | write `{` here",
        ),
        (
            "foo = 3\n",
            "field `foo` outside a block, expected an item | move it into its block, or name a value with `let foo = …`",
        ),
        (
            "}\n",
            "found `}`, expected an item | remove this `}`, or open the block that it closes",
        ),
        (
            "let step = 3\n",
            "found `step`, expected a name | choose another name: `step` is a keyword",
        ),
        (
            "use lib\n",
            "found `lib`, expected a string in quotes | write a string in quotes here",
        ),
        (
            "b {\n x = (1 + a y)\n}",
            "found `y`, expected an operator or `)` | write an operator or `)` here",
        ),
        (
            "b {\n 3 = 4\n}\n",
            "found `3`, expected a field | write `key = value`",
        ),
        (
            "let x = 1 and\n",
            "found the end of the line, expected a value | write a number with its unit, a string, a name, a list or a range",
        ),
    ] {
        assert_eq!(found(text), expected);
    }
}

/// Everything else in the file waits until the line is short: the work on one line may grow with the square of its length.
#[test]
fn the_length_of_a_line_is_checked_before_anything_else() {
    for text in ["}{".repeat(10_000), "“a” ".repeat(1_000), "x".repeat(4_097)] {
        let whole = format!("let a = \n{text}\n}}\n");
        let start: String = text.chars().take(40).collect();
        let (_, found, sources) = read(&whole);
        let codes: Vec<Code> = found.iter().map(|error| error.code).collect();
        assert_eq!(codes, [E107]);
        let at = sources.text(found[0].span().unwrap());
        assert!(at.len() <= 42 && start.starts_with(at), "{at}");
    }
    let longest = format!("let a = 1 {}", "# ".repeat(2_043));
    assert_eq!(longest.len(), 4_096);
    assert_eq!(errors(&format!("{longest}  \r\n")), []);
    one(&format!("{longest}#\n"), E107, &longest[..40]);
}

#[test]
fn a_long_paragraph_around_the_plan_of_a_document_is_no_line_of_the_plan() {
    let mut sources = psd_text::source::Sources::default();
    let text = format!("{}\n\n```psd\nlet a = 1\n```\n", "word ".repeat(2_000));
    let file = sources.add("plan.md", text);
    assert_eq!(super::parse(&sources, file).1, []);
}
