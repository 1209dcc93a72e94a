//! The work of a check grows in proportion to the length of a plan, whatever is in it.
//!
//! The work is the processor time of the thread, which does not depend on other programs as the time of a clock does. A text eight times
//! as long takes eight times the work, or sixty-four times if the work grows with the square of the length. Twenty-four, the ratio that
//! fails, is between the two. Memory cannot grow faster than the work that fills it.

use psd::check::{Options, check, no_files};
use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// Bytes of the short text of each shape.
const SHORT: usize = 12_000;
const LONGER: usize = 8;
const MOST: f64 = 24.0;
/// A ratio that is too large by chance is small in another trial.
const TRIALS: usize = 3;

/// Processor time of a check of `text` in this thread [s].
fn work(text: &str) -> f64 {
    let now = || {
        let time = clock_gettime(ClockId::ThreadCPUTime);
        Duration::try_from(time).map_or(f64::NAN, |time| time.as_secs_f64())
    };
    let start = now();
    let checked = check("plan.psd", text, &no_files, &Options::default());
    assert!(
        checked.diagnostics.len() <= 1_001,
        "{} diagnostics",
        checked.diagnostics.len()
    );
    now() - start
}

/// `unit` again and again, about `size` bytes.
fn repeated(unit: &str, size: usize) -> String {
    unit.repeat(size / unit.len())
}

/// `before` and `after` so many times that the whole has about `size` bytes, and `before` is in front of all `after`.
fn nested(before: &str, after: &str, size: usize) -> String {
    let count = size / (before.len() + after.len());
    format!("let a = {}{}", before.repeat(count), after.repeat(count))
}

/// A line for each number, about `size` bytes in all.
fn numbered(line: impl Fn(usize) -> String, size: usize) -> String {
    let mut text = String::new();
    for index in 0.. {
        if text.len() >= size {
            break;
        }
        text.push_str(&line(index));
    }
    text
}

/// A text of about the given number of bytes.
type Shape = Box<dyn Fn(usize) -> String>;

fn shapes() -> Vec<(String, Shape)> {
    let units = [
        "}{",
        "}",
        "{",
        "x {",
        "x }",
        "a { x = 1 {",
        "if } ",
        "if a {\n}",
        "specimen s {}\n", // braces
        "(",
        "[",
        "let a = (",
        "((((",
        "f(",
        "..", // brackets
        "\"a\" \"b\" ",
        "\"",
        "\"abc",
        "'a' ",
        "“a” ",
        "\"\\q\" ", // strings
        "/* a",
        "// a",
        "# a", // comments
        "@@@ ",
        "\0",
        "ж",
        "1,000.0.0 ",
        "- ",
        "a b c d ",
        "let a = ", // words and characters
        "let a = 1 kN/m*s/s/s/s",
        "require \"a\" b < 1 mm",
        "param a = 1 mm between 0 mm .. 2 mm",
        "use \"a.psd\"",
    ];
    let mut shapes: Vec<(String, Shape)> = Vec::new();
    for unit in units {
        shapes.push((
            format!("{unit:?} on one line"),
            Box::new(move |size| repeated(unit, size)),
        ));
        shapes.push((
            format!("{unit:?} on each line"),
            Box::new(move |size| repeated(&format!("{unit}\n"), size)),
        ));
        // As many on a line as the limit of a line permits.
        shapes.push((
            format!("{unit:?} on lines of 4,000 bytes"),
            Box::new(move |size| repeated(&format!("{}\n", repeated(unit, 4_000)), size)),
        ));
    }
    let mut add = |name: &str, shape: Shape| shapes.push((name.to_owned(), shape));
    let pairs = [
        ("((((\n", "]]]]\n"),
        ("[\n", "]\n"),
        ("f(\n", ")\n"),
        ("a {\n", "}\n"),
    ];
    for (before, after) in pairs {
        add(
            &format!("{before:?}, then {after:?}"),
            Box::new(move |size| nested(before, after, size)),
        );
    }
    for (start, rest) in [("(", "\n"), ("1 +", "\n"), ("(", "# a\n"), ("[", "1, 2,\n")] {
        add(
            &format!("{start:?}, then {rest:?}"),
            Box::new(move |size| format!("let a = {start}\n{}", repeated(rest, size))),
        );
    }
    add(
        "fields of one block",
        Box::new(|size| {
            let fields = numbered(|index| format!("  m{index} = 1 kg\n"), size);
            format!("specimen s {{\n{fields}}}\n")
        }),
    );
    add(
        "values that read the one before",
        Box::new(|size| {
            let values = numbered(|index| format!("let a{} = a{index}\n", index + 1), size);
            format!("let a0 = 1 mm\n{values}")
        }),
    );
    add(
        "unknown names",
        Box::new(|size| numbered(|index| format!("let a{index} = b{index} * 2\n"), size)),
    );
    add(
        "specimens, and an impact on each",
        Box::new(|size| {
            let pair = |index| {
                format!(
                    "specimen s{index} {{\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 kN/m)\n}}\n\
                     impact h{index} {{\n  striker = p\n  duration = 1 ms\n}}\n"
                )
            };
            let striker = "striker p {\n  mass = 20 kg\n  velocity = 0.1 m/s\n}\n";
            format!("{striker}{}", numbered(pair, size))
        }),
    );
    shapes
}

#[test]
fn the_work_of_a_check_is_proportional_to_the_length_of_the_plan() {
    let mut faults = Vec::new();
    for (name, shape) in shapes() {
        let (short, long) = (shape(SHORT), shape(LONGER * SHORT));
        let mut ratio = f64::INFINITY;
        for _ in 0..TRIALS {
            ratio = ratio.min(work(&long) / work(&short));
            if ratio <= MOST {
                break;
            }
        }
        if ratio > MOST {
            faults.push(format!("{name}: {ratio:.0} times the work"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
