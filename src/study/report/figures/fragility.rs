//! The figures of a fragility. In: stripes and fitted curves. Out: charts. A curve beyond its stripes is dashed.

use super::{FigureKind, StudyFigure, axis, cloud, plain, references, series, whole_range};
use crate::report::figures::chart::{Chart, DASHED, End, Marker, Quantity, SOLID, Style, palette};
use crate::report::wording::study as wording;
use crate::study::answers::{Answers, FitAnswer, FragilityAnswer};
use crate::study::data_set::{Metadata, StudyKind};

/// Band, curve, stripes. Beyond the stripes the curve is dashed.
pub(super) fn curve(metadata: &Metadata, fragility: &FragilityAnswer) -> Option<StudyFigure> {
    let StudyKind::Fragility(stripes) = &metadata.kind else {
        return None;
    };
    let column = &metadata.inputs[stripes.intensity];
    let mut drawn = Vec::new();
    let with_curve: Vec<&FitAnswer> = fragility
        .fits
        .iter()
        .filter(|fit| !fit.curve.is_empty())
        .collect();
    let styles = [(palette::BLUE, 2.2), (palette::PURPLE, 1.4)];
    if let [first, ..] = &with_curve[..] {
        let lower = first
            .curve
            .iter()
            .zip(with_curve.last().into_iter().flat_map(|fit| &fit.curve));
        let band: Vec<(f64, [f64; 2])> = lower
            .map(|(a, b)| {
                let [low, high] = [
                    a.interval[0].min(b.interval[0]),
                    a.interval[1].max(b.interval[1]),
                ];
                (a.intensity, [low, high])
            })
            .collect();
        let corners = band
            .iter()
            .map(|(x, [low, _])| (*x, *low))
            .chain(band.iter().rev().map(|(x, [_, high])| (*x, *high)));
        let label = wording::band(super::percent(metadata.confidence));
        drawn.push(series(label, corners.collect(), Style::area(palette::FILL)));
    }
    for (fit, (colour, width)) in with_curve.iter().zip(styles) {
        for part in fit
            .curve
            .chunk_by(|a, b| a.is_extrapolated == b.is_extrapolated)
        {
            let dashed = part[0].is_extrapolated;
            let label = if dashed {
                ""
            } else {
                wording::curve_label(fit.no_result_as)
            };
            let style = Style::line(colour, width, if dashed { DASHED } else { SOLID });
            let points = part
                .iter()
                .map(|point| (point.intensity, point.probability));
            drawn.push(series(label, points.collect(), style));
        }
    }
    for (at, stripe) in fragility.stripes.iter().enumerate() {
        let [low, high] = stripe.interval;
        let x = stripe.intensity;
        let label = if at == 0 { wording::STRIPES } else { "" };
        let style = Style::line(palette::BLACK, 1.0, SOLID);
        drawn.push(series("", vec![(x, low), (x, high)], style));
        let marker = Style::marker(palette::BLACK, Marker::Disc(3.6));
        drawn.push(series(label, vec![(x, stripe.bounds[0])], marker));
        if stripe.no_result > 0 {
            let marker = Style::marker(palette::BLACK, Marker::Ring(3.6));
            drawn.push(series("", vec![(x, stripe.bounds[1])], marker));
        }
    }
    drawn.push(whole_range(fragility.stripes.first()?.intensity));
    let curve = fragility.fits.iter().any(|fit| fit.no_fit.is_none());
    let extrapolated = if curve { wording::EXTRAPOLATED } else { "" };
    Some(StudyFigure {
        name: format!("{}_fragility", metadata.study),
        chart: Chart {
            x: Quantity {
                from_zero: true,
                ..axis(column, End::Margin)
            },
            y: plain(wording::PROBABILITY_AXIS, End::Data),
            bands: Vec::new(),
            series: drawn,
            references: Vec::new(),
        },
        caption: wording::fragility(&fragility.exceeds, &column.name) + extrapolated,
        result: None,
        kind: FigureKind::Fragility,
    })
}

/// The result that the limit of a fragility compares, at every intensity.
pub(super) fn scatter(metadata: &Metadata, answers: &Answers) -> Option<StudyFigure> {
    let StudyKind::Fragility(stripes) = &metadata.kind else {
        return None;
    };
    let limit = metadata.requirements.first()?.limit?;
    let (x, y) = (
        &metadata.inputs[stripes.intensity],
        &metadata.results[limit.result],
    );
    let drawn = cloud(answers, stripes.intensity, limit.result);
    if drawn.points.len() < 2 {
        return None;
    }
    Some(StudyFigure {
        name: format!("{}_against_{}", y.name, x.name),
        chart: Chart {
            x: axis(x, End::Margin),
            y: axis(y, End::Margin),
            bands: Vec::new(),
            series: vec![drawn],
            references: references(metadata, limit.result),
        },
        caption: wording::scatter(&y.name, &x.name),
        result: None,
        kind: FigureKind::Scatter,
    })
}
