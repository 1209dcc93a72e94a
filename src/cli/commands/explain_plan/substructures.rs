//! The structure of a hybrid test, drawn: floors from the highest down, storeys that are tested or computed, axes, scales. In: a frame. Out:
//! rows of text.

use psd_physics::structure::substructures::on_the_rig;
use psd_plan::scaled::at_scale;
use psd_plan::{Frame, Part};
use psd_text::units::Dimension;
use psd_text::units::display::stated;

/// A row for each floor with its axis, and one for each storey below it: `║` is on the rig, `┆` is computed.
pub fn drawing(frame: &Frame) -> Vec<Vec<String>> {
    if !frame.elements.is_empty() {
        return elements(frame);
    }
    let mut tested = on_the_rig(frame).map(|(_, stands)| stands).zip(1..);
    let storeys = frame.storeys.iter().zip(1..);
    let storeys = storeys.map(|(storey, number)| {
        let stiffness = |value| stated(value, Dimension::STIFFNESS);
        let own = stiffness(storey.stiffness);
        let (column, mover, text) = match storey.part {
            Part::Computed => ("┆", String::new(), format!("computed, {own}")),
            Part::Tested { scale, .. } => {
                let (stands, axis) = tested.next().unwrap_or((true, 0));
                let base = if stands { ", on the strong floor" } else { "" };
                let on_the_rig = stiffness(scale.stiffness_on_the_rig(storey.stiffness));
                let text = format!("tested{}{base}, {own}", at_scale(&scale));
                let text = if on_the_rig == own {
                    text
                } else {
                    format!("{text}; {on_the_rig} on the rig")
                };
                ("║", format!("◄─ axis {axis}"), text)
            }
        };
        let joint = if number == frame.storeys.len() {
            '┬'
        } else {
            '┼'
        };
        [
            vec![format!("floor {number}"), format!("──{joint}──"), mover],
            vec![String::new(), format!("  {column}"), text],
        ]
    });
    let mut rows: Vec<Vec<String>> = storeys
        .flat_map(|[floor, storey]| [storey, floor])
        .collect();
    rows.reverse();
    rows.push(vec!["ground".to_owned(), "──┴──".to_owned()]);
    rows
}

/// A row for each element of a frame of matrices.
fn elements(frame: &Frame) -> Vec<Vec<String>> {
    let mut axes = 1..;
    let elements = frame.elements.iter().zip(1..).map(|(element, number)| {
        let stiffness = |value| stated(value, Dimension::STIFFNESS);
        let end = |end: Option<usize>| end.map_or("ground".to_owned(), |end| (end + 1).to_string());
        let [from, to] = element.ends.map(end);
        let own = stiffness(element.stiffness);
        let (column, mover, text) = match element.part {
            Part::Computed => ("┄┄", String::new(), format!("computed, {own}")),
            Part::Tested { scale, .. } => {
                let on_the_rig = stiffness(scale.stiffness_on_the_rig(element.stiffness));
                let text = format!("tested{}, {own}", at_scale(&scale));
                let text = if on_the_rig == own {
                    text
                } else {
                    format!("{text}; {on_the_rig} on the rig")
                };
                let axis = axes.next().unwrap_or(0);
                ("══", format!("◄─ axis {axis}"), text)
            }
        };
        vec![
            format!("element {number}"),
            format!("{from} {column} {to}"),
            mover,
            text,
        ]
    });
    elements.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Behaviour, Scale, Storey};

    #[test]
    fn storeys_of_one_assembly_stand_on_the_strong_floor_together() {
        let half = Part::Tested {
            apart: true,
            scale: Scale {
                displacement: 0.5,
                force: 0.25,
                represents: 1.0,
            },
        };
        let parts = [Part::Computed, Part::TESTED, Part::TESTED, half];
        let storey = |part| Storey {
            part,
            ..Storey::new(1.0, 1e6, Behaviour::Elastic { stiffness: 1e6 })
        };
        let rows = drawing(&Frame::of_storeys(parts.map(storey).to_vec()));
        let lines: Vec<String> = rows.iter().map(|row| row.join("|")).collect();
        assert_eq!(
            lines,
            [
                "floor 4|──┬──|◄─ axis 3",
                "|  ║|tested at scale 0.5, on the strong floor, 1 MN/m; 500 kN/m on the rig",
                "floor 3|──┼──|◄─ axis 2",
                "|  ║|tested, 1 MN/m",
                "floor 2|──┼──|◄─ axis 1",
                "|  ║|tested, on the strong floor, 1 MN/m",
                "floor 1|──┼──|",
                "|  ┆|computed, 1 MN/m",
                "ground|──┴──",
            ]
        );
    }
}
