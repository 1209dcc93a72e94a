//! A report as one self-contained HTML page. In: a [`Document`]. Out: HTML without scripts and without external files. The template
//! escapes every text, and a figure is an image that runs no script.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::text::Piece;
use super::{Block, Document, Figure, Notice, Photo, Style, Table, Text};
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
                main {
                    (top(document))
                    @for (index, blocks) in sections(&document.body).enumerate() { (section(index, blocks)) }
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
                @if let Some(logo) = &document.logo { p.logo { (photo(logo)) } }
                p.kind { (document.kind) }
                @if let Some(replaced) = &document.replaces { p.kind { b { (LABELS.amendment_to) " " (replaced) } } }
                h1 { (line(&document.title)) }
            }
            div.run {
                (LABELS.report) " " span.id { (document.id) }
                @if let Some(dated) = &document.dated { br; (dated) }
            }
        }
        dl.front {
            @for (name, value) in &document.front { div { dt { (line(name)) } dd { (line(value)) } } }
        }
        @if !document.missing_fields.is_empty() { p.note.lacking { (LABELS.not_given) " " (document.missing_fields.join(", ")) "." } }
        div class={ "verdict " (document.verdict.tone.name()) } {
            strong { (document.verdict.heading) }
            (line(&document.verdict.text))
        }
        @for notice in &document.notices { (boxed(notice)) }
    }
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

/// Blocks with the heading that names their tables.
fn section(index: usize, blocks: &[Block]) -> Markup {
    let mut heading = String::new();
    let rendered: Vec<Markup> = blocks
        .iter()
        .enumerate()
        .map(|(at, block)| {
            if matches!(block, Block::Section { .. } | Block::Part { .. }) {
                heading = format!("h{index}-{at}");
            }
            render(block, &heading)
        })
        .collect();
    html! { section { @for block in rendered { (block) } } }
}

/// A block; `heading` is the id of the heading before it, or its own.
fn render(block: &Block, heading: &str) -> Markup {
    html! {
        @match block {
            Block::Section { title } => { h2 id=(heading) { (line(title)) } }
            Block::Part { title } => { h3 id=(heading) { (line(title)) } }
            Block::NewPage => { div.new-page {} }
            Block::Paragraph { text } => { p { (line(text)) } }
            Block::Note { text } => { p.note { (line(text)) } }
            Block::List { items } => { ul { @for item in items { li { (line(item)) } } } }
            Block::Pairs { rows } => { (pairs(rows, heading)) }
            Block::Table(it) => { (table(it, heading)) }
            Block::Figure(it) => { (figure(it)) }
            Block::Photos { photos } => { div.photos { @for it in photos { figure { (photo(it)) figcaption { (line(&it.caption)) } } } } }
            Block::Code { first, lines } => {
                pre { @for (number, line) in (*first..).zip(lines) { span.n { (number) } (line) "\n" } }
            }
            Block::Signatures { names } => { div.signatures { @for name in names { div { (line(name)) } } } }
        }
    }
}

fn pairs(rows: &[(Text, Text)], heading: &str) -> Markup {
    html! {
        table.pairs aria-labelledby=[labelled(heading)] { tbody { @for (name, value) in rows { tr { th scope="row" { (line(name)) } td { (line(value)) } } } } }
    }
}

/// The id of the heading that names a table; none before the first heading.
fn labelled(heading: &str) -> Option<&str> {
    (!heading.is_empty()).then_some(heading)
}

/// The first cell of a row names it. On a narrow screen the cells stand below each other, each after the title of its column.
fn table(it: &Table, heading: &str) -> Markup {
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
        div.scroll { table.data aria-labelledby=[labelled(heading)] {
            thead {
                tr {
                    @for column in &it.columns {
                        // CSS has no fraction of the remaining width: 70 % are distributed.
                        @let width = if column.share == 0 { String::new() } else { format!("width: {}%", 70 * u32::from(column.share) / shares.max(1)) };
                        th scope="col" class=(class(column.numeric, column.share == 0)) style=[(!width.is_empty()).then_some(width)] { (line(&column.title)) }
                    }
                }
            }
            tbody {
                @for row in &it.rows {
                    tr {
                        @for (index, (cell, column)) in row.iter().zip(&it.columns).enumerate() {
                            @let class = class(column.numeric, column.share == 0);
                            @if index == 0 { th scope="row" class=(class) { (line(cell)) } }
                            @else { td class=(class) data-title=(plain(&column.title)) { (line(cell)) } }
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
            div.scroll { img alt=(plain(&it.description)) src={ "data:image/svg+xml;base64," (STANDARD.encode(&it.svg)) }; }
            figcaption { b { (LABELS.figure) " " (it.number) ". " } (line(&it.caption)) }
        }
    }
}

fn photo(it: &Photo) -> Markup {
    let data = STANDARD.encode(&it.picture.bytes);
    html! { img alt=(plain(&it.caption)) src={ "data:" (it.picture.kind.media_type()) ";base64," (data) }; }
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
            Style::Strong => strong { (text) },
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
