//! Rows of `psd check --explain` for a frame: its modes, and the peaks of the dry run. In: modes, and the steps of a frame. Out: rows of
//! text.

use crate::procedures::common::predicted::{Predicted, row};
use psd_physics::structure::widen;
use psd_plan::record::{Floors, Modes};
use psd_text::units::Dimension;
use psd_text::units::display::{digits, join, readable, significant, unit};

/// The modes of the frame that a procedure tests, and their shapes.
pub(crate) fn of_modes(name: &str, of: Option<&Modes>, ratios: &[f64]) -> [Predicted; 2] {
    [
        Predicted::new(format!("{name}, modes"), modes(of, ratios)),
        Predicted::new(format!("{name}, shapes"), shapes(of)),
    ]
}

/// One row per mode: period, damping, effective modal mass, and its shape from the lowest floor up.
fn modes(modes: Option<&Modes>, ratios: &[f64]) -> Vec<Vec<String>> {
    let Some(modes) = modes else {
        return Vec::new();
    };
    let head = [
        "mode",
        "period",
        "damping",
        "effective mass",
        "shape, floor by floor",
    ]
    .map(str::to_owned)
    .to_vec();
    let percent = |fraction: f64| format!("{} %", significant(100.0 * fraction, 3));
    let rows = modes.periods.iter().enumerate().map(|(mode, period)| {
        let shape: Vec<String> = modes.shapes[mode]
            .iter()
            .map(|entry| digits(*entry, 1.0, Dimension::LENGTH))
            .collect();
        vec![
            (mode + 1).to_string(),
            readable(*period, Dimension::TIME),
            percent(ratios.get(mode).copied().unwrap_or(0.0)),
            percent(modes.effective_mass[mode]),
            shape.join("  "),
        ]
    });
    std::iter::once(head).chain(rows).collect()
}

/// The shapes of the first modes, drawn: one column per mode, the highest floor on top, the ground below. The largest entry of a shape
/// reaches an end of its column.
fn shapes(modes: Option<&Modes>) -> Vec<Vec<String>> {
    const SHOWN: usize = 4;
    /// Letters on either side of the middle.
    const HALF: usize = 8;
    const REACH: f64 = 8.0;
    let Some(modes) = modes else {
        return Vec::new();
    };
    let shown = modes.shapes.iter().take(SHOWN);
    let line = |entry: f64| {
        let mut letters = [' '; 2 * HALF + 1];
        letters[HALF] = '│';
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "an entry is between −1 and 1"
        )]
        let column = (REACH * (1.0 + entry.clamp(-1.0, 1.0))).round() as usize;
        letters[column] = '●';
        letters.iter().collect::<String>()
    };
    let head = shown
        .clone()
        .enumerate()
        .map(|(mode, _)| format!("mode {}", mode + 1));
    let mut rows = vec![
        std::iter::once("floor".to_owned())
            .chain(head)
            .collect::<Vec<_>>(),
    ];
    let floors = modes.shapes.first().map_or(0, Vec::len);
    rows.extend((0..floors).rev().map(|floor| {
        std::iter::once((floor + 1).to_string())
            .chain(shown.clone().map(|shape| line(shape[floor])))
            .collect()
    }));
    let ground = format!("{0}┴{0}", "─".repeat(HALF));
    rows.push(
        std::iter::once("ground".to_owned())
            .chain(shown.map(|_| ground.clone()))
            .collect(),
    );
    rows
}

/// The predicted peaks of all floors and storeys, or of all degrees of freedom and elements.
pub(crate) fn floor_peaks<F: Floors>(steps: &[F]) -> Vec<Vec<String>> {
    if steps.last().is_some_and(F::has_elements) {
        return vec![
            row(
                "largest displacement, row by row",
                peaks(steps, |step| step.computed().to_vec(), Dimension::LENGTH),
            ),
            row(
                "largest deformation, element by element",
                peaks(steps, Floors::drift, Dimension::LENGTH),
            ),
            row(
                "largest force, element by element",
                peaks(steps, Floors::shear, Dimension::FORCE),
            ),
        ];
    }
    vec![
        row(
            "largest displacement, floor by floor",
            peaks(steps, |step| step.computed().to_vec(), Dimension::LENGTH),
        ),
        row(
            "largest drift, storey by storey",
            peaks(steps, Floors::drift, Dimension::LENGTH),
        ),
        row(
            "largest shear, storey by storey",
            peaks(steps, Floors::shear, Dimension::FORCE),
        ),
    ]
}

/// Peak absolute values, all in one unit.
pub(crate) fn peaks<S>(steps: &[S], read: impl Fn(&S) -> Vec<f64>, dimension: Dimension) -> String {
    let mut largest: Vec<f64> = Vec::new();
    for step in steps {
        let values = read(step);
        largest.resize(values.len(), 0.0);
        widen(&mut largest, &values);
    }
    let (unit, factor) = unit(largest.iter().copied().fold(0.0, f64::max), dimension);
    let numbers: Vec<String> = largest
        .iter()
        .map(|value| digits(*value, factor, dimension))
        .collect();
    join(&numbers.join(", "), &unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_zero_at_the_ground_with_their_largest_entry_at_an_end() {
        let shapes = vec![vec![0.5, 1.0], vec![1.0, -0.7]];
        let rows = super::shapes(Some(&Modes {
            periods: vec![0.5, 0.2],
            shapes,
            participation: vec![1.2, 0.3],
            effective_mass: vec![0.9, 0.1],
        }));
        let drawn: Vec<String> = rows.iter().map(|row| row.join("|")).collect();
        assert_eq!(
            drawn,
            [
                "floor|mode 1|mode 2",
                "2|        │       ●|  ●     │        ",
                "1|        │   ●    |        │       ●",
                "ground|────────┴────────|────────┴────────",
            ]
        );
        assert!(super::shapes(None).is_empty());
    }
}
