//! The whole plan of the language reference.

use super::{checked, files};
use psd_plan::formula::Formula;
use psd_plan::{Contact, InspectTrigger, Interval, ProcedureKind};

const FRAME: &str = "rig frame { link = virtual(noise: 1 N)\n limits = frame_limits }\nlimits frame_limits { force = 20 kN }\n";
const WHOLE: &str = r#"plan "Pultruded GFRP beam, midspan impact" {
  edition     = 1
  standard    = "In-house procedure 12, after Melo et al. 2006"
  specimen_id = "GFRP-0147"
}
use "lib/instron_frame.psd"
param impact_speed = 1 m/s between 0.5 m/s .. 3 m/s
let   section      = 564 mm^2
specimen beam {
  length    = 1.4 m
  density   = 1850 kg/m^3
  mass      = density * section * length / 2
  behaviour = elastic(stiffness: 300 kN/m)
}
rig simulated {
  link   = virtual(noise: 2 N, resolution: 1 um, lag: 2 ms, seed: 7)
  settle = within(0.01 mm, 5 N/s, for: 0.3 s, timeout: 10 s)
}
striker pendulum {
  mass     = 20 kg
  velocity = impact_speed
}
limits {
  displacement = -2 mm .. 25 mm
  force        = -2 kN .. 12 kN
  speed        = 10 mm/s
}
stiffness ramp k0 {
  displacements = 0.1 mm .. 1 mm step 0.1 mm
  pause         = 2 s
}
damping sweep c {
  velocities = [0.5, 1, 2, 5, 10] mm/s
  stroke     = 1 mm
  stiffness  = k0.stiffness
}
impact hit {
  striker   = pendulum
  stiffness = k0.stiffness
  damping   = c.damping
  contact   = rigid
  time_step = critical / 20
  duration  = 50 ms
  pause     = 0.5 s
  inspect   = [every(20), force_drop(10 %)]
}
require "stays in travel"   hit.max_displacement <= 8.5 mm
require "absorbs the blow"  hit.absorbed_energy within 15 % of pendulum.energy
require "energy closes"     abs(hit.energy_error) < 1 %
report {
  figures = [force_displacement(k0), displacement(hit), striker_velocity(hit), energy(hit)]
  formats = [html, parquet, csv]
  sign    = ["Test engineer", "Quality"]
}
"#;

#[test]
fn the_whole_plan_of_the_reference_checks_to_si() {
    let (checked, reported) = checked(WHOLE, &files(&[("lib/instron_frame.psd", FRAME)]), &[]);
    assert_eq!(reported, "");
    let plan = checked.plan.expect("no error");
    assert_eq!(plan.title, "Pultruded GFRP beam, midspan impact");
    assert!((plan.specimens[0].mass - 1850.0 * 564e-6 * 0.7).abs() < 1e-12);
    assert_eq!(plan.strikers[0].velocity, 1.0);
    assert_eq!(plan.rig.name, "simulated");
    assert_eq!(plan.rig.settle.dwell, 0.3);
    assert_eq!(
        plan.limits.displacement,
        Interval {
            low: -0.002,
            high: 0.025
        }
    );
    assert_eq!(
        plan.limits.speed,
        Interval {
            low: 0.0,
            high: 0.01
        }
    );
    let [ramp, sweep, hit] = plan.procedures.as_slice() else {
        panic!("three procedures")
    };
    let ProcedureKind::StiffnessRamp(ramp) = &ramp.kind else {
        panic!("a ramp")
    };
    assert_eq!(ramp.displacements.len(), 10);
    assert_eq!(ramp.displacements[9], Formula::Constant(0.001));
    let ProcedureKind::DampingSweep(sweep) = &sweep.kind else {
        panic!("a sweep")
    };
    assert_eq!(sweep.velocities[0], Formula::Constant(0.0005));
    let ProcedureKind::Impact(hit) = &hit.kind else {
        panic!("an impact")
    };
    assert!(
        matches!(hit.contact, Contact::Rigid) && hit.stepping.time_step.reads_critical_time_step()
    );
    assert_eq!(
        hit.point()
            .and_then(|point| point.stiffness.as_result())
            .map(|result| result.name),
        Some("stiffness")
    );
    assert!(matches!(
        hit.stepping.inspect[..],
        [InspectTrigger::Every(20), InspectTrigger::ForceDrop(0.1)]
    ));
    assert_eq!(plan.requirements.len(), 3);
    assert_eq!(
        plan.requirements[0].conditions[0].text,
        "hit.max_displacement <= 8.5 mm"
    );
    assert_eq!(
        (
            plan.report.figures.len(),
            plan.report.formats.len(),
            plan.files.len()
        ),
        (4, 3, 2)
    );
}

#[test]
fn a_setting_replaces_the_parameter() {
    let (checked, reported) = checked(
        WHOLE,
        &files(&[("lib/instron_frame.psd", FRAME)]),
        &[("impact_speed", "1500 mm/s")],
    );
    assert_eq!(reported, "");
    assert_eq!(checked.plan.expect("no error").strikers[0].velocity, 1.5);
}
