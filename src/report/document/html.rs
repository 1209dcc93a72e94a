//! A report as one self-contained HTML page. In: a [`Document`]. Out: HTML without scripts and without external files. The template
//! escapes every text, and a figure is an image that runs no script.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::text::Piece;
use super::{Block, Document, Figure, Notice, Style, Table, Text};
use crate::report::wording::LABELS;

/// Inline style and embedded images only: markup in a label could neither load nor run anything.
pub(crate) const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// The whole page.
pub(crate) fn html(document: &Document) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (plain(&document.title)) " · " (document.id) }
                style { (PreEscaped(style(document))) }
            }
            body {
                (watermark(document))
                (top(document))
                @for section in sections(&document.body) {
                    section { @for block in section { (render(block)) } }
                }
                footer { p.end { (line(&document.end)) } }
            }
        }
    };
    page.into_string()
}

/// The style, with the id of the report at the foot of every printed page. Only letters and digits of the id are printed.
fn style(document: &Document) -> String {
    let id: String = document
        .id
        .chars()
        .filter(char::is_ascii_alphanumeric)
        .collect();
    let report = LABELS.report;
    let foot = format!(
        "@page {{ @bottom-left {{ content: \"{report} {id}\"; font: 8pt \"DejaVu Sans\", sans-serif; color: #5d6870; }} }}\n"
    );
    let watermark = if document.watermarks.is_empty() {
        ""
    } else {
        include_str!("watermark.css")
    };
    include_str!("style.css").to_owned() + watermark + &foot
}

fn watermark(document: &Document) -> Markup {
    html! {
        @if !document.watermarks.is_empty() {
            div.watermark aria-hidden="true" { @for words in &document.watermarks { div { (words) } } }
        }
    }
}

/// Title, particulars, verdict and notices.
fn top(document: &Document) -> Markup {
    html! {
        header.title {
            div {
                p.kind { (document.kind) }
                @if let Some(replaced) = &document.replaces { p.kind { b { (LABELS.amendment_to) " " (replaced) } } }
                h1 { (line(&document.title)) }
            }
            div.run {
                (LABELS.report) " " span.id { (document.id) } br;
                @if let Some(date) = &document.date { (LABELS.tested) " " (date) } @else { (LABELS.date_not_given) }
            }
        }
        div.front {
            @for (name, value) in in_two_columns(&document.front) { div { span.name { (line(name)) } span { (line(value)) } } }
        }
        @if !document.missing_fields.is_empty() { p.note.lacking { (LABELS.not_given) " " (document.missing_fields.join(", ")) "." } }
        div class={ "verdict " (document.verdict.name) } {
            strong { (document.verdict.name.to_uppercase()) }
            (line(&document.verdict.text))
        }
        @for notice in &document.notices { (boxed(notice)) }
    }
}

/// Rows of two pairs: the first half on the left, the second on the right.
fn in_two_columns<T>(items: &[T]) -> impl Iterator<Item = &T> {
    let (left, right) = items.split_at(items.len().div_ceil(2));
    left.iter()
        .enumerate()
        .flat_map(|(row, item)| [Some(item), right.get(row)])
        .flatten()
}

fn boxed(notice: &Notice) -> Markup {
    html! {
        div.marks {
            @for words in &notice.words { span.mark { (words) } " " }
            span { (line(&notice.text)) }
        }
    }
}

/// The blocks of each section; blocks before the first heading are one section.
fn sections(body: &[Block]) -> impl Iterator<Item = &[Block]> {
    body.chunk_by(|_, next| !matches!(next, Block::Section { .. }))
}

fn render(block: &Block) -> Markup {
    html! {
        @match block {
            Block::Section { title } => { h2 { (line(title)) } }
            Block::Part { title } => { h3 { (line(title)) } }
            Block::Paragraph { text } => { p { (line(text)) } }
            Block::Note { text } => { p.note { (line(text)) } }
            Block::List { items } => { ul { @for item in items { li { (line(item)) } } } }
            Block::Pairs { rows } => { (pairs(rows)) }
            Block::Table(it) => { (table(it)) }
            Block::Figure(it) => { (figure(it)) }
            Block::Code { lines } => {
                pre { @for (index, line) in lines.iter().enumerate() { span.n { (index + 1) } (line) "\n" } }
            }
            Block::Signatures { names } => { div.signatures { @for name in names { div { (line(name)) } } } }
        }
    }
}

fn pairs(rows: &[(Text, Text)]) -> Markup {
    html! {
        table.pairs { tbody { @for (name, value) in rows { tr { th scope="row" { (line(name)) } td { (line(value)) } } } } }
    }
}

fn table(it: &Table) -> Markup {
    let shares: u32 = it
        .columns
        .iter()
        .map(|column| u32::from(column.share))
        .sum();
    let class = |numeric: bool, short: bool| match (numeric, short) {
        (true, _) => "number",
        (false, true) => "short",
        (false, false) => "words",
    };
    html! {
        div.scroll { table.data {
            thead {
                tr {
                    @for column in &it.columns {
                        // CSS has no fraction of the remaining width: 70 % are distributed.
                        @let width = if column.share == 0 { String::new() } else { format!("width: {}%", 70 * u32::from(column.share) / shares.max(1)) };
                        th class=(class(column.numeric, column.share == 0)) style=[(!width.is_empty()).then_some(width)] { (line(&column.title)) }
                    }
                }
            }
            tbody {
                @for row in &it.rows {
                    tr {
                        @for (cell, column) in row.iter().zip(&it.columns) {
                            td class=(class(column.numeric, column.share == 0)) { (line(cell)) }
                        }
                    }
                }
            }
        } }
    }
}

/// The figure as an image: nothing in it can act on the page.
fn figure(it: &Figure) -> Markup {
    html! {
        figure {
            div.scroll { img alt=(plain(&it.caption)) src={ "data:image/svg+xml;base64," (STANDARD.encode(&it.svg)) }; }
            figcaption { b { (LABELS.figure) " " (it.number) ". " } (line(&it.caption)) }
        }
    }
}

fn line(text: &Text) -> Markup {
    html! { @for piece in &text.0 { (render_piece(piece)) } }
}

fn render_piece(piece: &Piece) -> Markup {
    let text = piece.text.as_str();
    html! {
        @match piece.style {
            Style::Plain => (text),
            Style::Soft => span.soft { (text) },
            Style::Code => code.soft { (text) },
            Style::Id => span.id { (text) },
            Style::Missing => span.missing { (text) },
            Style::Pass => span.pass { (text) },
            Style::Inconclusive => span.doubt { (text) },
            Style::Fail => span.fail { (text) },
            Style::Break => br;,
        }
    }
}

/// The text without its styles.
fn plain(text: &Text) -> String {
    text.0.iter().map(|piece| piece.text.as_str()).collect()
}
