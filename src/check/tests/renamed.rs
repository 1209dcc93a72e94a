//! Names of version 0.1: each is an error that gives the present name, and the plan of a run log is read with them.

use super::{check, files};
use crate::check::{Checked, Options};
use crate::plan::{Condition, Plan};
use crate::schema::RENAMED;
use crate::text::diagnostic::{Code, Diagnostic};

/// The page of the error, with the same table.
const OLD_NAMES: &str = include_str!("../../text/diagnostic/explain/E215.md");

/// Every name of the table at a place where it was allowed, as `old → present`.
const PLAN: &str = r#"specimen bar {
  mass      = 2 kg
  behaviour = bilinear(stiffness: 400 kN/m, yield_force: 4 kN, hardening→post_yield_ratio: 8 %)
}

ground quake { record→file = "quake.csv" }

rig frame_rig {
  link       = virtual(noise: 1 N, drift→zero_drift: 0.001 N/s, seed: 7)
  drift→zero_drift      = within(5 N, over: 2 s)
  sign→polarity       = positive
}

rig real {
  actuator        = serial(port: "/dev/a", dialect: grbl)
  load_cell       = serial(port: "/dev/b", dialect: hx711)
  force_per_count = 0.01 N
  settle          = within(0.01 mm, 50 N/s, for: 0.3 s)
  safe_state      = hold
  gate→pretest_check       = probe(0.02 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 20 N)
  zero_count→zero_offset = 8123
}

rig axes {
  link       = tcp(address: "127.0.0.1:44000", dialect: native)
  settle     = within(0.01 mm, 50 N/s, for: 0.3 s)
  safe_state = hold
  axes       = [axis(sign→polarity: negative, gate→pretest_check: probe(0.02 mm, stiffness: 1 kN/m .. 9 MN/m, zero: 20 N))]
}

striker hammer {
  mass     = 5 kg
  velocity = 0.1 m/s
}

stiffness ramp k0 {
  displacements = 1 mm .. 21 mm step 0.5 mm
  fit           = multilinear(breaks: 1)
}

cycle loops {
  amplitudes = [5, 15, 21] mm
}

impact hit {
  striker   = hammer
  stiffness = k0.stiffness
  damping   = 0 N*s/m
  time_step = 1 ms
  duration  = 10 ms
  mode      = step_and_pause→ramp_and_hold
}

escalate rising {
  striker   = hammer
  energies  = [1, 2] J
  while     = max_displacement < 15 mm
  between   = unload
  stiffness = k0.stiffness
  damping   = 0 N*s/m
  duration  = 10 ms
}

require "a" k0.hardened_stiffness→post_yield_stiffness > 0 N/m and loops.hardening→post_yield_ratio < 1
require "b" max(k0.break_uncertainties→breaks.u) < 1 m and k0.break_force_uncertainties→break_forces.u[0] < 1 kN
require "c" max(loops.curve_stiffness_uncertainties→curve_stiffnesses.u) < 1 kN/m and k0.needed_pause→required_pause < 1 h
require "d" hit.max_displacement < 1 m and rising.blows→impacts == 2

report { figures = [blows→impacts(rising)] }

golden { results = [near→tolerance(k0.stiffness, 1 N/m)] }
"#;

const QUAKE: &str = "time_s,acceleration_m_per_s2\n0,0\n0.1,0.5\n0.2,-0.5\n0.3,0\n";

/// The plan with the old names, or with the present ones.
fn written(old: bool) -> String {
    let mut text = String::new();
    for (index, piece) in PLAN.split('→').enumerate() {
        let is_word = |char: char| char.is_alphanumeric() || char == '_' || char == '.';
        // The end of a piece is an old name, the start of the next one the present name.
        let piece = match (index > 0, old) {
            (true, true) => piece.trim_start_matches(is_word),
            _ => piece,
        };
        text.push_str(piece);
        if !old && PLAN.split('→').count() > index + 1 {
            let end = text.trim_end_matches(|char: char| char.is_alphanumeric() || char == '_');
            text.truncate(end.len());
        }
    }
    text
}

fn read(text: &str, recorded: bool) -> Checked {
    let options = Options {
        recorded,
        rig: Some("frame_rig".to_owned()),
        ..Options::default()
    };
    check("plan.psd", text, &files(&[("quake.csv", QUAKE)]), &options)
}

fn errors(checked: &Checked) -> Vec<&Diagnostic> {
    let found = checked.diagnostics.iter();
    found.filter(|found| found.is_error()).collect()
}

#[test]
fn every_old_name_is_an_error_that_gives_the_present_one() {
    let checked = read(&written(true), false);
    let found = errors(&checked);
    assert!(
        found.iter().all(|found| found.code == Code::OldName),
        "{found:?}"
    );
    for row in RENAMED {
        let named = found.iter().any(|found| {
            checked.sources.text(found.span().unwrap()) == row.old
                && found.help.as_deref() == Some(&format!("write `{}`", row.new))
        });
        assert_ne!(named, row.alias, "{}", row.old);
        let line = format!("| `{}` | `{}` |", row.old, row.new);
        assert!(OLD_NAMES.contains(&line), "{line}");
    }
}

#[test]
fn a_recorded_plan_with_old_names_is_the_plan_with_the_present_ones() {
    let (old, present) = (read(&written(true), true), read(&written(false), false));
    assert_eq!((errors(&old).len(), errors(&present).len()), (0, 0));
    let checked_plan = |plan: Plan| {
        let conditions = plan.requirements.iter().flat_map(|all| &all.conditions);
        let formulas: Vec<_> = conditions.flat_map(Condition::formulas).collect();
        let parts = (&plan.specimens, &plan.grounds, &plan.procedures);
        format!("{parts:?} {:?} {:?} {formulas:?}", plan.rig, plan.golden)
    };
    assert_eq!(
        checked_plan(old.plan.unwrap()),
        checked_plan(present.plan.unwrap())
    );
}
