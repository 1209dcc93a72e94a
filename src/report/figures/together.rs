//! Several procedures of one kind on one chart, one curve each, on the same axes. In: their curves, the kind of figure. Out: a
//! [`Chart`] in SI and its caption. Limits of requirements are drawn only on the figures of a single procedure.

use super::chart::{
    Chart, Colour, DASH_DOT, DOTTED, LONG, SOLID, SPARSE, Series, SharedCurve, Style, palette,
};
use psd_plan::{FigureKind, MOST_TOGETHER};

/// Curves that coincide remain visible: a narrow dashed line on a broad one shows both.
const STYLES: [(Colour, f64, &[f64]); MOST_TOGETHER] = [
    (palette::BLUE, 2.0, SOLID),
    (palette::VERMILION, 2.6, SOLID),
    (palette::BLACK, 1.3, SPARSE),
    (palette::GREEN, 1.8, LONG),
    (palette::PURPLE, 1.6, DASH_DOT),
    (palette::SKY, 1.8, DOTTED),
];

const LOOP: f64 = 1.2;

/// The chart and its caption; None if no procedure has steps, or none has this figure.
pub(super) fn chart(
    kind: FigureKind,
    procedures: Vec<(&str, Option<SharedCurve>)>,
) -> Option<(Chart, String)> {
    let (mut series, mut first) = (Vec::new(), None);
    // Many loops need a fine line.
    let loops = matches!(kind, FigureKind::ForceDisplacement | FigureKind::Hysteresis);
    for ((name, curve), (colour, width, dash)) in procedures.into_iter().zip(STYLES) {
        let Some(SharedCurve {
            x,
            y,
            caption,
            points,
        }) = curve
        else {
            continue;
        };
        first.get_or_insert((x, y, caption));
        if !points.is_empty() {
            let width = if loops { LOOP } else { width };
            series.push(Series {
                label: name.to_owned(),
                points,
                style: Style::line(colour, width, dash),
            });
        }
    }
    let (x, y, caption) = first?;
    if series.is_empty() {
        return None;
    }
    let names: Vec<&str> = series.iter().map(|series| series.label.as_str()).collect();
    let names = match names.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => names.concat(),
    };
    let caption = format!("{names} on one chart: {caption}.");
    Some((Chart::of(x, y, series), caption))
}
