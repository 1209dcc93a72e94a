//! A frame and its ground motion, as a report describes them. In: the plan. Out: blocks.

use super::described;
use crate::report::document::{Block, Column, Figure, Table, Text};
use crate::report::figures::structure;
use crate::report::number::{self, percent};
use crate::report::wording::{conditions as wording, specimen as specimen_text};
use psd_plan::scaled::{at_scale, numbers_on_the_rig};
use psd_plan::{Element, Frame, Ground, Part, Plan};
use psd_text::units::Dimension;

/// Storeys from the ground up, or the files of the matrices.
pub(crate) fn structure(plan: &Plan, frame: &Frame, body: &mut Vec<Block>) {
    let mut rows = vec![
        ("degrees of freedom", frame.degrees_of_freedom().to_string()),
        (
            "mass of all floors",
            number::stated(frame.total_mass(), Dimension::MASS),
        ),
    ];
    if let Some([mass, stiffness]) = &frame.files {
        rows.push(("mass matrix", mass.clone()));
        rows.push(("stiffness matrix", stiffness.clone()));
        let behaviour = if frame.has_elements() {
            ("stiffness matrix", "computed, beside the elements")
        } else {
            ("virtual behaviour", "elastic, R = K·X")
        };
        rows.push((behaviour.0, behaviour.1.to_owned()));
    }
    let substructures = specimen_text::substructures(frame);
    rows.extend(substructures.clone().map(|text| ("substructures", text)));
    let numbers = specimen_text::numbers(plan, frame);
    let is_scaled = numbers.is_some();
    rows.extend(numbers.map(|text| ("numbers", text)));
    body.push(described(rows));
    let is_hybrid = substructures.is_some();
    if is_hybrid {
        body.push(Block::Figure(Figure {
            number: 0,
            caption: if frame.has_elements() {
                wording::STRUCTURE_OF_ELEMENTS.into()
            } else {
                wording::STRUCTURE.into()
            },
            description: structure::description(frame).into(),
            svg: structure::svg(frame),
        }));
    }
    if frame.storeys.is_empty() {
        if frame.has_elements() {
            body.push(elements(frame));
            body.push(Block::note(specimen_text::assumed(frame)));
        }
        return;
    }
    let behaviour = if is_scaled {
        "Behaviour, on the rig if tested"
    } else if is_hybrid {
        "Behaviour"
    } else {
        "Virtual behaviour"
    };
    let mut columns = vec![
        Column::numbers("Storey"),
        Column::numbers("Mass"),
        Column::numbers("Stiffness"),
        Column::numbers("Height"),
    ];
    let loads = frame.axial_loads();
    if !loads.is_empty() {
        columns.extend(["Weight", "P/(K h)"].map(Column::numbers));
    }
    columns.extend(is_hybrid.then(|| Column::words("Part", 1)));
    columns.push(Column::words(behaviour, 1));
    // A column that is 0 for every storey is omitted.
    let damping = frame.storeys.iter().any(|storey| storey.damping != 0.0);
    let friction = frame.storeys.iter().any(|storey| storey.coulomb != 0.0);
    columns.extend(damping.then(|| Column::numbers("Virtual damping")));
    columns.extend(friction.then(|| Column::numbers("Virtual friction")));
    let row = |(index, storey): (usize, &psd_plan::Storey)| -> Vec<Text> {
        let mut cells: Vec<Text> = vec![
            (index + 1).to_string().into(),
            number::stated(storey.mass, Dimension::MASS).into(),
            number::stated(storey.stiffness, Dimension::STIFFNESS).into(),
            storey
                .height
                .map_or_else(
                    || "—".to_owned(),
                    |height| number::stated(height, Dimension::LENGTH),
                )
                .into(),
        ];
        if let Some((load, height)) = loads.get(index).zip(storey.height) {
            cells.push(number::stated(storey.gravity, Dimension::FORCE).into());
            cells.push(percent(load / (storey.stiffness * height)).into());
        } else if !loads.is_empty() {
            cells.extend(["—", "—"].map(Text::from));
        }
        cells.extend(is_hybrid.then(|| part(&storey.part).into()));
        cells.push(specimen_text::words(&storey.behaviour, &number::stated).into());
        cells.extend(damping.then(|| number::stated(storey.damping, Dimension::DAMPING).into()));
        cells.extend(friction.then(|| number::stated(storey.coulomb, Dimension::FORCE).into()));
        cells
    };
    body.push(Block::Table(Table {
        columns,
        rows: frame.storeys.iter().enumerate().map(row).collect(),
    }));
    if is_hybrid {
        body.push(Block::note(specimen_text::assumed(frame)));
    }
}

/// The elements of a frame of matrices.
fn elements(frame: &Frame) -> Block {
    let end = |end: Option<usize>| end.map_or(0, |end| end + 1);
    let row = |(index, element): (usize, &Element)| -> Vec<Text> {
        let [from, to] = element.ends.map(end);
        vec![
            (index + 1).to_string().into(),
            format!("{from} to {to}").into(),
            part(&element.part).into(),
            number::stated(element.stiffness, Dimension::STIFFNESS).into(),
            specimen_text::words(&element.behaviour, &number::stated).into(),
        ]
    };
    let is_scaled = numbers_on_the_rig(frame).is_some();
    let behaviour = if is_scaled {
        "Behaviour, on the rig if tested"
    } else {
        "Behaviour"
    };
    Block::Table(Table {
        columns: vec![
            Column::numbers("Element"),
            Column::words("From, to (0: ground)", 1),
            Column::words("Part", 1),
            Column::numbers("Stiffness"),
            Column::words(behaviour, 1),
        ],
        rows: frame.elements.iter().enumerate().map(row).collect(),
    })
}

fn part(part: &Part) -> String {
    match part {
        Part::Tested { scale, .. } => format!("tested{}", at_scale(scale)),
        Part::Computed => "computed".to_owned(),
    }
}

/// The ground-motion record as read.
pub(crate) fn ground(ground: &Ground) -> Block {
    let (shortest, longest) = ground.spacing();
    let spacing = if longest - shortest <= 1e-6 * longest {
        format!(
            "{} samples, one every {}",
            ground.times.len(),
            number::stated(rounded(longest), Dimension::TIME)
        )
    } else {
        format!(
            "{} samples, {} to {} apart",
            ground.times.len(),
            number::stated(rounded(shortest), Dimension::TIME),
            number::stated(rounded(longest), Dimension::TIME)
        )
    };
    described(vec![
        ("file", ground.file.clone()),
        ("record", spacing),
        (
            "duration",
            number::stated(ground.duration(), Dimension::TIME),
        ),
        (
            "unit of its numbers",
            number::stated(ground.unit, Dimension::ACCELERATION),
        ),
        ("scale", number::stated(ground.scale, Dimension::NUMBER)),
        (
            "largest acceleration, scaled",
            number::text(ground.peak(), Dimension::ACCELERATION),
        ),
    ])
}

/// A difference of two times has the rounding of both.
fn rounded(spacing: f64) -> f64 {
    format!("{spacing:.9e}").parse().unwrap_or(spacing)
}
