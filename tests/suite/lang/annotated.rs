//! A plan with what psd finds in it: below each line the marks and texts of the diagnostics that point at it, as comments. In: a plan
//! and its diagnostics. Out: the plan with these comments, or without.
//!
//! ```text
//! striker hammer {
//!   velocty = 1 m/s
//! # ^^^^^^^ error[E202]: `striker` has no field `velocty`
//! #         = no such field
//! #         = help: did you mean `velocity`?
//! }
//! ```
//!
//! `^` marks each character of a span, `|` the position of an empty one. In `#^^` the character `#` marks the first column too, in `#<`
//! that column alone; a span from the second column begins with `>`. `(to 3:2)` names the end of a span of several lines: 3 lines
//! below, before column 2. If a plan has several diagnostics, each has a number, and its further spans have the same number. What has
//! no position is at the end, after `#=`.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use psd_text::diagnostic::Diagnostic;
use psd_text::diagnostic::excerpt::one_line;
use psd_text::diagnostic::render::severity_name;
use psd_text::source::{Position, Sources, Span};

/// Whether a line is a comment that [`annotated`] writes.
fn is_found(line: &str) -> bool {
    let text = line.strip_prefix('#').unwrap_or_default();
    let text = text.trim_start_matches(' ');
    let rest = text.trim_start_matches(['^', '|', '<', '>', '=']);
    rest.len() < text.len() && (rest.is_empty() || rest.starts_with(' '))
}

/// The plan without these comments.
pub fn plain(text: &str) -> String {
    let lines = text.split_inclusive('\n');
    lines.filter(|line| !is_found(line.trim_end())).collect()
}

/// The plan with the diagnostics below the lines at which they point, and `end` after its last line. The plan is the end of the first
/// source, from the line after `before`.
pub fn annotated(
    plan: &str,
    before: usize,
    diagnostics: &[Diagnostic],
    sources: &Sources,
    end: &str,
) -> Result<String, String> {
    let mut below: BTreeMap<usize, String> = BTreeMap::new();
    let mut last = String::new();
    for (index, diagnostic) in diagnostics.iter().enumerate() {
        let number = if diagnostics.len() > 1 {
            format!("{} ", index + 1)
        } else {
            String::new()
        };
        let severity = severity_name(diagnostic.severity);
        let (code, message) = (diagnostic.code, one_line(&diagnostic.message));
        let head = format!("{number}{severity}[{code}]: {message}");
        let help = diagnostic.help.as_ref().map(|help| format!("help: {help}"));
        if diagnostic.labels.is_empty() {
            let _ = writeln!(last, "#= {head}");
            if let Some(help) = &help {
                write_note(&mut last, "", help);
            }
            continue;
        }
        for (place, label) in diagnostic.labels.iter().enumerate() {
            let start = sources.position(label.span);
            let line = start.line.checked_sub(before + 1);
            let line = line
                .filter(|_| label.span.file.0 == 0)
                .ok_or_else(|| format!("outside the plan: {}: {}", head, label.text))?;
            let marks = marks(start, label.span, sources);
            let text = below.entry(line).or_default();
            if place > 0 {
                let note = format!("{marks} {number}{}", one_line(&label.text));
                let _ = writeln!(text, "{}", note.trim_end());
                continue;
            }
            let _ = writeln!(text, "{marks} {head}");
            let indent = " ".repeat(marks.chars().count());
            let label = Some(label.text.clone()).filter(|label| !label.is_empty());
            for note in label.into_iter().chain(help.clone()) {
                write_note(text, &indent, &note);
            }
        }
    }
    let lines = plan.split_inclusive('\n').count().max(1);
    let mut text = String::new();
    for (index, line) in plan.split_inclusive('\n').enumerate() {
        text.push_str(line);
        text.push_str(&below.remove(&index).unwrap_or_default());
    }
    // An error at the end of a plan is on the line after its last one.
    below.retain(|line, found| {
        let at_the_end = *line == lines;
        if at_the_end {
            let _ = write!(text, "#= after the last line:\n{found}");
        }
        !at_the_end
    });
    if !below.is_empty() {
        return Err(format!("outside the plan: {below:?}"));
    }
    text.push_str(&last);
    text.extend(end.lines().map(|line| format!("#= {line}\n")));
    Ok(text)
}

/// `#   = help: add`, and further lines of the note below it.
fn write_note(text: &mut String, indent: &str, note: &str) {
    for (index, line) in note.lines().enumerate() {
        let further = if index > 0 { "  " } else { "" };
        let _ = writeln!(text, "#{indent}= {further}{}", one_line(line));
    }
}

/// `#   ^^^`: a comment that marks the span on the line above.
fn marks(start: Position, span: Span, sources: &Sources) -> String {
    let end = sources.position(Span {
        start: span.end,
        ..span
    });
    let several = end.line > start.line;
    let width = if several {
        let rest = sources.file(span.file).text[span.range()]
            .split('\n')
            .next();
        rest.unwrap_or_default().chars().count()
    } else {
        end.column - start.column
    };
    let marks = match (start.column, width) {
        (1, 0) => "#|".to_owned(),
        (1, 1) => "#<".to_owned(),
        (1, width) => format!("#{}", "^".repeat(width - 1)),
        (2, 0) => "#>|".to_owned(),
        (2, width) => format!("#>{}", "^".repeat(width - 1)),
        (column, 0) => format!("#{}|", " ".repeat(column - 2)),
        (column, width) => format!("#{}{}", " ".repeat(column - 2), "^".repeat(width)),
    };
    if several {
        format!("{marks} (to {}:{})", end.line - start.line, end.column)
    } else {
        marks
    }
}

#[test]
fn marks_name_the_position_of_every_span() {
    use psd_text::diagnostic::Code;

    let plan = "let a = 1\nx\nlet b = 2\n";
    let mut sources = Sources::default();
    let file = sources.add("plan.psd", plan);
    let span = |start, end| Span::new(file, start, end);
    let found = [
        Diagnostic::new(Code::new("E208"), "first")
            .at(span(4, 5), "here")
            .at(span(0, 3), "of this")
            .at(span(1, 3), "")
            .at(span(1, 1), "empty")
            .at(span(8, 8), "before 1")
            .help("write\nboth"),
        Diagnostic::new(Code::new("W706"), "second").at(span(10, 11), ""),
        Diagnostic::new(Code::new("W706"), "third")
            .at(span(18, 22), "to the end")
            .at(span(22, 22), "after it"),
        Diagnostic::new(Code::new("E603"), "fourth").help("name one"),
    ];
    let text = annotated(plan, 0, &found, &sources, "completed\n").expect("all is in the plan");
    insta::assert_snapshot!(text, @r"
    let a = 1
    #   ^ 1 error[E208]: first
    #     = here
    #     = help: write
    #     =   both
    #^^ 1 of this
    #>^ 1
    #>| 1 empty
    #       | 1 before 1
    x
    #< 2 warning[W706]: second
    let b = 2
    #     ^^^ (to 1:1) 3 warning[W706]: third
    #                  = to the end
    #= after the last line:
    #| 3 after it
    #= 4 error[E603]: fourth
    #= help: name one
    #= completed
    ");
    assert_eq!(plain(&text), plan);
    assert!(annotated("x\n", 1, &found[1..2], &sources, "").is_ok());
    assert!(annotated("x\n", 2, &found[1..2], &sources, "").is_err());
}
