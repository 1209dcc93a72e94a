//! A report as PDF. In: a [`Document`]. Out: bytes, identical for the same document: date and identifier come from the document, the
//! fonts from the program. Every text is passed to the template as data, never as markup. It is set on threads of its own.

use std::borrow::Cow;
use std::fmt::Write as _;

use serde_json::Value;
use typst::diag::SourceDiagnostic;
use typst::foundations::{Datetime, Smart};
use typst_layout::PagedDocument;
use typst_pdf::{PdfOptions, PdfStandard, PdfStandards};

use super::Document;
use super::fonts::{FIGURE_FAMILIES, PAGE_FAMILIES, PAGE_OVER_FIGURE};
use super::world::Sealed;
use psd_text::glyphs;

const TEMPLATE: &str = include_str!("report.typ");
/// Stack size of the threads that set a report: enough for the deepest nesting of the template, also in a build without optimisation.
const STACK: usize = 32 << 20;

/// The report as a tagged PDF: PDF/UA-1, and PDF/A-3a, which requires a date, if the day of the test is known.
pub(crate) fn pdf(document: &Document) -> Result<Vec<u8>, String> {
    let day = document.date.as_deref().and_then(day);
    let mut data = serde_json::to_value(document).map_err(|error| error.to_string())?;
    data["day"] = day.map_or(Value::Null, |(year, month, day)| {
        serde_json::json!([year, month, day])
    });
    data["attachments"] = document
        .attachments
        .iter()
        .map(|file| serde_json::json!([file.name, file.text]))
        .collect();
    for key in [
        "title", "kind", "logo", "id", "date", "dated", "front", "verdict", "notices", "body",
        "end",
    ] {
        make_settable(&mut data[key]);
    }
    let mut files = vec![("report.json".to_owned(), data.to_string().into_bytes())];
    files.extend(document.figures().map(|figure| {
        (
            format!("figure-{}.svg", figure.number),
            in_letters_of_the_page(&figure.svg).into_bytes(),
        )
    }));
    files.extend(
        document
            .photos()
            .map(|photo| (photo.name.clone(), photo.picture.bytes.clone())),
    );
    let world = Sealed::new(TEMPLATE, files)?;
    on_own_threads(&|| set(&world, &document.id, day.is_some()))
}

/// The result of `work`, on a thread pool with [`STACK`]. typst spreads its work over the pool that it finds: the pool of the caller, or the
/// global one with the stack size of the system. A thread that waits in such a pool begins other work of it on the same stack, such
/// as the next report, so that no stack size is enough there. The caller's thread only waits.
fn on_own_threads<T: Send>(work: &(dyn Fn() -> Result<T, String> + Sync)) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .stack_size(STACK)
        .build()
        .map_err(|error| format!("no threads to set the report on: {error}"))?;
    std::thread::scope(|scope| {
        let waiting = std::thread::Builder::new()
            .spawn_scoped(scope, || pool.install(work))
            .map_err(|error| format!("no thread to set the report on: {error}"))?;
        waiting
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// The typeset bytes, by the strictest standard that accepts them; of a dated report or not.
fn set(world: &Sealed, id: &str, dated: bool) -> Result<Vec<u8>, String> {
    let paged = typst::compile::<PagedDocument>(world)
        .output
        .map_err(|errors| messages(&errors))?;
    let mut refused = String::new();
    for standards in standards(dated) {
        let options = PdfOptions {
            ident: Smart::Custom(id.to_owned()),
            creator: Smart::Custom(Some("psd".to_owned())),
            standards: PdfStandards::new(standards).map_err(|error| error.message().to_string())?,
            tagged: true,
            ..PdfOptions::default()
        };
        match typst_pdf::pdf(&paged, &options) {
            Ok(bytes) => return Ok(bytes),
            Err(errors) => refused = messages(&errors),
        }
    }
    Err(refused)
}

/// A figure in the typeface of the page, each text in the size at which it is as high as before. A text of the figure has no quotation
/// mark that is not escaped, so that an attribute is not taken from it.
fn in_letters_of_the_page(svg: &str) -> String {
    const SIZE: &str = " font-size=\"";
    let svg = svg.replacen(FIGURE_FAMILIES, PAGE_FAMILIES, 1);
    let mut parts = svg.split(SIZE);
    let mut drawn = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (size, rest) = part.split_once('"').unwrap_or((part, ""));
        let size = size.parse::<f64>().unwrap_or_default() * PAGE_OVER_FIGURE;
        let _ = write!(drawn, "{SIZE}{size:.2}\"{rest}");
    }
    drawn
}

/// Standards of the file, the strictest first: archived and accessible. A text of the plan may have a character that the first does
/// not allow; the report is then made after the next.
const fn standards(dated: bool) -> &'static [&'static [PdfStandard]] {
    if dated {
        &[
            &[PdfStandard::A_3a, PdfStandard::Ua_1],
            &[PdfStandard::A_3b],
            &[PdfStandard::V_1_7],
        ]
    } else {
        &[
            &[PdfStandard::V_1_7, PdfStandard::Ua_1],
            &[PdfStandard::V_1_7],
        ]
    }
}

fn messages(errors: &[SourceDiagnostic]) -> String {
    errors
        .iter()
        .map(|error| error.message.to_string())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Year, month and day where a text begins with a day of the calendar.
fn day(text: &str) -> Option<(i32, u8, u8)> {
    let mut parts = text.get(..10)?.split('-');
    let (year, month, day) = (
        parts.next()?.parse().ok()?,
        parts.next()?.parse().ok()?,
        parts.next()?.parse().ok()?,
    );
    Datetime::from_ymd(year, month, day).map(|_| (year, month, day))
}

/// Prepares every string below for typesetting: only characters of the fonts, and line breaks in long words.
fn make_settable(value: &mut Value) {
    match value {
        Value::String(text) => {
            if let Cow::Owned(new) = settable(text) {
                *text = new;
            }
        }
        Value::Array(items) => items.iter_mut().for_each(make_settable),
        Value::Object(fields) => fields.values_mut().for_each(make_settable),
        _ => {}
    }
}

/// A character without a glyph becomes its code point. A word longer than most lines may be broken after every few letters.
fn settable(text: &str) -> Cow<'_, str> {
    const LONGEST_WORD: usize = 40;
    const ZERO_WIDTH_SPACE: char = '\u{200b}';
    let long = text
        .split(char::is_whitespace)
        .any(|word| word.chars().count() > LONGEST_WORD);
    if !long {
        return glyphs::shown(text);
    }
    let mut settable = String::with_capacity(2 * text.len());
    for part in text.split_inclusive(char::is_whitespace) {
        let breaks = part.chars().count() > LONGEST_WORD;
        for (index, c) in part.chars().enumerate() {
            if breaks && index > 0 && index % 8 == 0 {
                settable.push(ZERO_WIDTH_SPACE);
            }
            glyphs::push(&mut settable, c);
        }
    }
    Cow::Owned(settable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_has_the_typeface_of_the_page() {
        let svg = format!(
            "<svg font-family=\"{FIGURE_FAMILIES}\"><text x=\"1\" font-size=\"10\" fill=\"#000\">font-size=&quot;9&quot; µΔ</text></svg>"
        );
        // 10 · 0.729/0.647
        assert_eq!(
            in_letters_of_the_page(&svg),
            "<svg font-family=\"Libertinus Serif, DejaVu Sans\"><text x=\"1\" font-size=\"11.27\" fill=\"#000\">font-size=&quot;9&quot; µΔ</text></svg>"
        );
    }
}
