//! The structure of a hybrid test, drawn: floors from the highest down, storeys that are tested or computed, axes, scales. In: a frame. Out:
//! rows of text.

use psd::report::wording::specimen::{DrawnStorey, drawn_storeys};
use psd_plan::{Element, Frame};

/// A row for each floor with its axis, and one for each storey below it: `║` is on the rig, `┆` is computed.
pub fn drawing(frame: &Frame) -> Vec<Vec<String>> {
    if frame.has_elements() {
        return elements(frame);
    }
    let storeys = drawn_storeys(frame).into_iter().map(|drawn| {
        let (column, mover) = match drawn.axis {
            None => ("┆", String::new()),
            Some(axis) => ("║", format!("◄─ axis {axis}")),
        };
        let (number, text) = (drawn.number, format!("{}, {}", drawn.part, drawn.stiffness));
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
    let elements = frame.elements.iter().zip(drawn_storeys(frame));
    let row = |(element, drawn): (&Element, DrawnStorey)| {
        let end = |end: Option<usize>| end.map_or("ground".to_owned(), |end| (end + 1).to_string());
        let [from, to] = element.ends.map(end);
        let (column, mover) = match drawn.axis {
            None => ("┄┄", String::new()),
            Some(axis) => ("══", format!("◄─ axis {axis}")),
        };
        vec![
            format!("element {}", drawn.number),
            format!("{from} {column} {to}"),
            mover,
            format!("{}, {}", drawn.part, drawn.stiffness),
        ]
    };
    elements.map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Behaviour, Part, Scale, Storey};

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
