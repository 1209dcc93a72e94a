//! Hostile and unusual files: rejected with the correct code or accepted, always quickly.

use std::time::Duration;

use crate::codes::*;
use proptest::prelude::*;
use psd_text::diagnostic::Code;
use rustix::time::{ClockId, clock_gettime};

use super::{errors, outline, read, sound};

/// Processor time of this thread \[s\], independent of the load of the machine.
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(
        time.tv_sec.cast_unsigned(),
        u32::try_from(time.tv_nsec).unwrap(),
    )
    .as_secs_f64()
}

fn refused(text: &str, code: Code) {
    let start = processor_time();
    let (_, found, _) = read(text);
    // Not a measurement: these take well under a second, and would not end if parsing were not linear.
    let seconds = processor_time() - start;
    assert!(seconds < 60.0, "{seconds} s for {} bytes", text.len());
    let codes: Vec<Code> = found.iter().map(|error| error.code).collect();
    assert!(codes.contains(&code), "{codes:?}");
}

#[test]
fn empty_files_and_lone_comments_are_sound() {
    for text in ["", "\n", "\n\n  \n", "# only a comment", "#"] {
        assert!(sound(text).0.items.is_empty());
    }
}

#[test]
fn hostile_files_are_refused_quickly() {
    refused("\u{feff}", E106);
    refused("p\0l\0a\0n\0", E106);
    refused("let x = 1\rlet y = 2\r", E106);
    refused("let x = \"abc", E106);
    refused(&format!("let x = \"{}", "a".repeat(1 << 20)), E107);
    refused(&format!("let x = \"{}", "a".repeat(1 << 19)), E107);
    refused(&"/*\n".repeat(10_000), E101);
    // As many of a bracket as the longest line holds.
    let (open, close) = ("(".repeat(4_000) + "\n", ")".repeat(4_000) + "\n");
    refused(&format!("let x = {}", open.repeat(25)), E105);
    refused(
        &format!("let x = {}1{}", open.repeat(25), close.repeat(25)),
        E105,
    );
    refused(
        &format!("let x = {}1{}", "(\n".repeat(100_000), ")\n".repeat(99_000)),
        E105,
    );
    refused(&format!("let x = {}1", "(".repeat(100_000)), E107);
    refused(&format!("let x = {}1", "-".repeat(100_000)), E107);
    refused(&format!("let x = 1{}", " + 1".repeat(199_999)), E107);
    refused(&format!("let x = 1{}", " +\n 1".repeat(60_000)), E107);
    refused(&format!("let x = 1{}", " ^\n 1".repeat(60_000)), E107);
    refused(&format!("let x = {}", "a".repeat(1 << 19)), E107);
    refused("plan { }\n l\u{456}mits { }\n", E106);
    refused("plan \"a\u{202e}b\" { }\n", E106);
    refused(&format!("let x = {}\n", "1".repeat(400)), E103);
    refused(&"{\n".repeat(90_000), E102);
    refused(&"a {\n".repeat(60_000), E102);
    refused(&"x = f(\n".repeat(35_000), E102);
    refused(&("\u{1}a".repeat(2_000) + "\n").repeat(50), E106);
    refused(&"1 1\n".repeat(60_000), E101);
    refused(&("«".repeat(2_000) + "\n").repeat(250), E101);
    refused(&"a\nx = 1\n".repeat(30_000), E101);
    let mut words = String::new();
    for word in 0..60_000 {
        words.push('б');
        words.push_str(&word.to_string());
        words.push(if word % 200 == 0 { '\n' } else { ' ' });
    }
    refused(&words, E106);
}

#[test]
fn limits_hold_at_the_limit_and_not_past_it() {
    let name = |length: usize| format!("let {} = 1\n", "a".repeat(length));
    assert_eq!(errors(&name(64)), []);
    refused(&name(65), E107);
    let text = |length: usize| format!("use \"{}\"\n", "a".repeat(length));
    assert_eq!(errors(&text(1024)), []);
    refused(&text(1025), E107);
    let line = |length: usize| format!("#{}\n", "a".repeat(length - 1));
    assert_eq!(errors(&line(4096)), []);
    refused(&line(4097), E107);
    let deep = |depth: usize| format!("let x = {}1{}\n", "(".repeat(depth), ")".repeat(depth));
    assert_eq!(errors(&deep(64)), []);
    refused(&deep(65), E105);
    let file = |length: usize| "#a\n".repeat(length / 3) + &"\n".repeat(length % 3);
    let under_token_limit = "#".to_owned() + &"a".repeat(4000) + "\n";
    let lines = under_token_limit.repeat((1 << 20) / under_token_limit.len());
    let full = lines.clone() + &"\n".repeat((1 << 20) - lines.len());
    assert_eq!(full.len(), 1 << 20);
    assert_eq!(errors(&full), []);
    refused(&(full + "\n"), E107);
    refused(&file(900_000), E107);
    let sum = |operators: usize| format!("let x = 1{}\n", " +\n1".repeat(operators));
    assert_eq!(errors(&sum(999)), []);
    refused(&sum(1000), E107);
}

/// A rule that read what nests twice would need 2⁶⁰ steps.
#[test]
fn what_nests_is_read_once() {
    for (open, close) in [
        ("a.b(", ")"),
        ("a(b: ", ")"),
        ("a[", "]"),
        ("[1 .. ", "]"),
        ("-(", ")"),
        ("1 < (", ")"),
    ] {
        sound(&format!(
            "let x = {}1{}\n",
            open.repeat(60),
            close.repeat(60)
        ));
    }
}

#[test]
fn what_only_meaning_can_refuse_is_read() {
    for value in ["nan", "inf", "-inf", "-0.0", "5 kNm", "3 mm", "1e-300", "0"] {
        let (ast, _) = sound(&format!("b {{\n  x = {value}\n}}\n"));
        assert!(!outline(&ast).contains('?'));
    }
    sound("let a = b\nlet b = a\nuse \"../x.psd\"\nrequire \"<script>\" a < b\n");
    sound("let a = 1\r\nlet b = 2\nlet c = 3\r\n");
}

/// Pieces of plans in any order.
pub fn soup() -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "let ",
        "use ",
        "param ",
        "require ",
        "plan ",
        "x",
        " = ",
        "1",
        "1.5e3",
        " kg",
        "m/s",
        "%",
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ",",
        ":",
        "..",
        " step ",
        " between ",
        "within",
        " of ",
        " and ",
        "\"t\"",
        "\"",
        "#c",
        "\n",
        "\r\n",
        "\r",
        " + ",
        "-",
        "*",
        "/",
        "^",
        ".",
        "<",
        "==",
        "!=",
        "µ",
        "é",
        "\u{202e}",
        "\0",
        ";",
        "0x1",
        "1_0",
        "1,5",
        "5.",
        "\\",
    ]);
    prop::collection::vec(pieces, 0..60).prop_map(|pieces| pieces.concat())
}

/// Each is read as a one-byte character followed by spaces: the next token begins in the middle of the letter.
#[test]
fn a_letter_of_several_bytes_that_is_read_as_a_sign_ends_no_text_within_itself() {
    for letter in [
        "［", "］", "（", "｛", "≤", "×", "“", "‘", "«", "…", "−", "²",
    ] {
        for text in [
            letter.to_owned(),
            format!("a {letter}"),
            format!("let a = {letter}"),
            format!("let a = 1 {letter}\nlet b = {letter}{letter}"),
        ] {
            let _ = errors(&text);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_read_without_panic(text in any::<String>()) {
        let _ = errors(&text);
    }

    #[test]
    fn any_bytes_made_text_are_read(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = errors(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn a_soup_of_words_is_read_and_a_faulty_tree_has_a_error(text in soup()) {
        let (ast, found, sources) = read(&text);
        for error in &found {
            prop_assert!(error.help.is_some());
            let _ = sources.text(error.span().unwrap());
        }
        prop_assert!(!found.is_empty() || !outline(&ast).contains('?'));
    }
}
