//! The start of a run on a real rig in `psd check --explain`. In: the plan. Out: rows: the zero of the plan, the required start position
//! of the rig, the first move. It opens no rig.

use psd::run::start;
use psd_plan::{Datum, Plan};
use psd_text::units::Dimension;
use psd_text::units::display::{plain, stated};

/// No rows for a simulated rig, which starts at 0.
pub fn rows(plan: &Plan) -> Vec<Vec<String>> {
    let Some(link) = plan.rig.link.as_real() else {
        return Vec::new();
    };
    let axes = 0..plan.degrees_of_freedom();
    let each = |of: &dyn Fn(usize) -> f64| {
        let mut datums: Vec<String> = axes
            .clone()
            .map(|axis| stated(of(axis), Dimension::LENGTH))
            .collect();
        datums.dedup();
        datums.join(", ")
    };
    let band = each(&|axis| start::band(plan, link, axis));
    let (zero, position) = match link.datum {
        Datum::Machine => (
            "the rig's own zero",
            format!(
                "within {band} of the rig's own zero; otherwise the run is refused before any motion"
            ),
        ),
        Datum::Here | Datum::At(_) => (
            "the position of the rig at the start of the run; it is shown and logged",
            format!("anywhere, at rest within {band}, its specimen without load"),
        ),
    };
    let probe = each(&|axis| link.pretest_check_of(axis).probe);
    let speed = plain(link.own_speed, Dimension::VELOCITY, 4);
    let row = |name: &str, text: String| vec![name.to_owned(), text];
    vec![
        row("zero of the displacements", zero.to_owned()),
        row("required position of the rig", position),
        row(
            "first move",
            format!("MOVES {probe} at {speed}, and back (pre-test check)"),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd::check::{Options, check, no_files};

    /// The rows of a real rig with this line in its block.
    fn start_text(line: &str) -> String {
        let text = format!(
            "specimen beam {{
              mass      = 1 kg
              behaviour = elastic(stiffness: 300 kN/m)
            }}
            limits {{
              displacement = 2 mm
              force        = 2 kN
              speed        = 2 mm/s
            }}
            rig frame {{
              link       = serial(port: \"/dev/none\", dialect: native)
              settle     = within(0.005 mm, 50 N/s, for: 0.3 s)
              safe_state = hold
              pretest_check       = probe(0.02 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)
              resolution = 1 um
              {line}
            }}
            move out {{ to = 1 mm }}"
        );
        let options = Options {
            rig: Some("frame".to_owned()),
            ..Options::default()
        };
        let checked = check("plan.psd", &text, &no_files, &options);
        let plan = checked
            .plan
            .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
        rows(&plan)
            .into_iter()
            .map(|row| row.join(": "))
            .collect::<Vec<_>>()
            .join("\n")
    }

    #[test]
    fn the_required_start_position_and_the_first_motion_are_reported() {
        let machine = start_text("");
        assert!(
            machine.contains("within 5 µm of the rig's own zero; otherwise the run is refused"),
            "{machine}"
        );
        assert!(
            machine.contains("first move: MOVES 20 µm at 1 mm/s, and back"),
            "{machine}"
        );
        assert_eq!(start_text("datum = machine"), machine);
        let here = start_text("datum = here");
        assert!(
            here.contains("the position of the rig at the start of the run")
                && here.contains("without load"),
            "{here}"
        );
    }
}
