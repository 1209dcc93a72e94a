//! Names that are allowed in a plan from a run log but not in a new plan. The plan is read with the rules of the version that wrote the
//! run log.

use super::{check, no_files};
use crate::check::Options;

const OLDER: &str = r#"specimen bar {
  length    = 1.2 m
  area      = 400 mm^2
  density   = 7850 kg/m^3
  behaviour = beam(length: 1.2 m, youngs_modulus: 210 GPa, second_moment: 3333 mm^4, ends: cantilever)
}

striker hammer {
  mass  = 1 kg
  arm   = 1 m
  angle = 0.3
}

impact hit {
  striker  = hammer
  duration = 0.3 s
}

require "stays" hit.residual_displacement < 1 m
"#;

#[test]
fn a_recorded_plan_is_read_as_it_was_run() {
    let read = |recorded| {
        check(
            "plan.psd",
            OLDER,
            &no_files,
            &Options {
                recorded,
                ..Options::default()
            },
        )
    };
    let codes: Vec<&str> = read(false)
        .diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code.id())
        .collect();
    assert_eq!(codes, ["E209", "E302", "E206"]);
    let plan = read(true).plan.unwrap();
    assert!((plan.specimens[0].mass - 0.5 * 1.2 * 400e-6 * 7850.0).abs() < 1e-12);
    let height = 2.0 * 0.15_f64.sin().powi(2);
    assert!((plan.strikers[0].velocity - (2.0 * 9.806_65 * height).sqrt()).abs() < 1e-12);
    assert_eq!(
        plan.requirements[0].conditions[0]
            .value
            .as_result()
            .unwrap()
            .name,
        "final_displacement"
    );
}

/// A run that a limit stopped, or that met no requirement, has been recorded all the same.
#[test]
fn what_the_plan_alone_proves_is_no_error_of_a_recorded_plan() {
    let plan = r#"limits {
  displacement = 20 mm
  force        = 50 N
}

specimen bar {
  mass      = 1 kg
  behaviour = elastic(stiffness: 10 kN/m)
}

stiffness ramp k0 {
  displacements = 1 mm .. 10 mm step 1 mm
}

require "far" k0.max_displacement > 30 mm
"#;
    let without_force = plan.replace("50 N", "0 N");
    let codes = |text: &str, recorded| {
        let options = Options {
            recorded,
            ..Options::default()
        };
        let checked = check("plan.psd", text, &no_files, &options);
        let found = checked.diagnostics.iter();
        found.map(|one| one.code.id()).collect::<Vec<_>>()
    };
    assert_eq!(codes(plan, false), ["E602"]);
    let softer = plan.replace("10 kN/m", "1 kN/m");
    assert_eq!(codes(&softer, false), ["E667"]);
    assert_eq!(codes(&without_force, false), ["E401"]);
    for text in [plan, &softer, &without_force] {
        assert!(codes(text, true).is_empty(), "{:?}", codes(text, true));
    }
}
