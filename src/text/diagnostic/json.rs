//! Diagnostics for an editor. In: diagnostics and their sources. Out: a JSON value, every diagnostic with file, line,
//! column (characters, from 1) and byte span. Nothing is omitted and nothing is drawn.

use crate::sanitize;
use crate::source::{Position, Sources, Span};
use serde_json::{Value, json};

use super::render::severity_name;
use super::{Code, Diagnostic, Label};

/// Name of the format, in the document's `schema`.
pub const SCHEMA: &str = "psd.diagnostics/1";

/// The document around the diagnostics of one or more plans.
#[must_use]
pub fn document(diagnostics: &[Value]) -> Value {
    let count = |severity: &str| {
        diagnostics
            .iter()
            .filter(|diagnostic| diagnostic["severity"] == severity)
            .count()
    };
    let (errors, warnings) = (count("error"), count("warning"));
    json!({ "schema": SCHEMA, "errors": errors, "warnings": warnings, "diagnostics": diagnostics })
}

/// The document as it is printed: indented, with no control character from the text of a plan.
#[must_use]
pub fn printed_diagnostics(diagnostics: &[Value]) -> String {
    printed(&document(diagnostics))
}

/// [`printed_diagnostics`] with the predicted run of each plan.
#[must_use]
pub fn printed_with_predictions(diagnostics: &[Value], predictions: Vec<Value>) -> String {
    let mut document = document(diagnostics);
    document["predictions"] = predictions.into();
    printed(&document)
}

fn printed(document: &Value) -> String {
    sanitize::json(&format!("{document:#}\n"))
}

/// One diagnostic. `plan` names the file of a diagnostic without a span; `folder` is put before the name of every file.
#[must_use]
pub fn diagnostic(diagnostic: &Diagnostic, sources: &Sources, plan: &str, folder: &str) -> Value {
    let location = diagnostic.span().map_or_else(
        || json!({ "file": format!("{folder}{plan}"), "line": null, "column": null, "end_line": null, "end_column": null, "span": null }),
        |span| location(span, sources, folder),
    );
    let labels: Vec<Value> = diagnostic
        .labels
        .iter()
        .map(|label| self::label(label, sources, folder))
        .collect();
    let mut value = json!({
        "code": diagnostic.code.id(),
        "severity": severity_name(diagnostic.severity),
        "message": diagnostic.message,
    });
    extend(&mut value, location);
    extend(
        &mut value,
        json!({ "labels": labels, "help": diagnostic.help }),
    );
    value
}

/// A plan that cannot be read: an error without a code, with a span only where the text is not valid UTF-8.
#[must_use]
pub fn unreadable(file: &str, message: &str, at: Option<(Code, Position)>) -> Value {
    let (line, column) = (at.map(|(_, at)| at.line), at.map(|(_, at)| at.column));
    json!({
        "code": at.map(|(code, _)| code.id()), "severity": "error", "message": message, "file": file, "line": line, "column": column,
        "end_line": line, "end_column": column, "span": null, "labels": [], "help": null,
    })
}

fn label(label: &Label, sources: &Sources, folder: &str) -> Value {
    let mut value = location(label.span, sources, folder);
    extend(&mut value, json!({ "text": label.text }));
    value
}

fn location(span: Span, sources: &Sources, folder: &str) -> Value {
    let start = sources.position(span);
    let end = sources.position(Span {
        start: span.end,
        ..span
    });
    json!({
        "file": format!("{folder}{}", sources.file(span.file).name),
        "line": start.line,
        "column": start.column,
        "end_line": end.line,
        "end_column": end.column,
        "span": { "start": span.start, "end": span.end },
    })
}

fn extend(value: &mut Value, more: Value) {
    if let (Some(object), Value::Object(more)) = (value.as_object_mut(), more) {
        object.extend(more);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    #[test]
    fn an_editor_gets_positions_in_characters_and_in_bytes() {
        let mut sources = Sources::default();
        let file = sources.add("a.psd", "# ä\nlet ä = 3 mx\n");
        let fault = Diagnostic::new(Code::new("E204"), "no unit `mx`")
            .at(Span::new(file, 16, 18), "unknown")
            .help("`m`?");
        let value = diagnostic(&fault, &sources, "a.psd", "plans/");
        assert_eq!(
            (&value["file"], &value["line"], &value["column"]),
            (&json!("plans/a.psd"), &json!(2), &json!(11))
        );
        assert_eq!(value["span"], json!({ "start": 16, "end": 18 }));
        assert_eq!(
            (&value["end_line"], &value["end_column"]),
            (&json!(2), &json!(13))
        );
        assert_eq!(
            (&value["code"], &value["severity"], &value["help"]),
            (&json!("E204"), &json!("error"), &json!("`m`?"))
        );
        assert_eq!(value["labels"][0]["text"], json!("unknown"));
    }

    #[test]
    fn a_fault_of_the_command_line_has_no_line() {
        let fault = Diagnostic::new(Code::new("E214"), "no parameter `v`");
        let value = diagnostic(&fault, &Sources::default(), "a.psd", "");
        assert_eq!(
            (&value["file"], &value["line"]),
            (&json!("a.psd"), &Value::Null)
        );
        assert_eq!(document(&[value])["errors"], json!(1));
    }
}
