//! The plans of this folder's tests of several axes: a two-storey frame under ground motion on a rig of two axes. The upper axis has the
//! opposite polarity. In: text. Out: checked plans, and the same plans on an ideal virtual rig.

use crate::check::{Checked, LoadError, Options, check};
use crate::run::{Unwatched, run};
use psd_plan::formula::ResultValue;
use psd_plan::record::Record;
use psd_plan::{AxisPlan, Plan, RealLink};
use psd_rig::virtual_rig;

/// Elastic storeys of 300 and 200 kN/m: K = [500, −200; −200, 200] kN/m.
const PLAN: &str = r#"
specimen frame {
  storeys = [
    storey(mass: 2 t, stiffness: 300 kN/m),
    storey(mass: 1.5 t, stiffness: 200 kN/m),
  ]
}

ground motion { file = "ground.csv" }

limits {
  displacement = -60 mm .. 60 mm
  force        = -20 kN .. 20 kN
  speed        = 500 mm/s
}

rig frame_rig {
  link        = serial(port: "/dev/ttyUSB0", dialect: native, reply_timeout: 0.1 s)
  settle      = within(0.005 mm, 5 kN/s, for: 0.05 s, timeout: 0.5 s)
  safe_state  = hold
  speed       = 100 mm/s
  rate        = 50 Hz
  resolution  = 1 nm
  force_range = 25 kN
  axes        = [
    axis(pretest_check: probe(0.05 mm, stiffness: 400 kN/m .. 600 kN/m, zero: 5 N), displacement: -40 mm .. 40 mm),
    axis(polarity: negative, pretest_check: probe(0.05 mm, stiffness: 150 kN/m .. 250 kN/m, zero: 5 N)),
  ]
}

shake quake {
  ground    = motion
  time_step = 10 ms
  duration  = DURATION
}

require "drift" max(quake.max_drift) < 60 mm
"#;

/// 3 m/s² for a tenth of a second, then the opposite.
const GROUND: &str = "time_s,acceleration_m_per_s2\n0,0\n0.05,3\n0.1,3\n0.2,-3\n0.3,0\n1,0\n";

fn folder(path: &str) -> Result<String, LoadError> {
    let known = [
        ("ground.csv", GROUND),
        ("mass.csv", "2000, 0, 0\n0, 1500, 0\n0, 0, 1000\n"),
        (
            "stiffness.csv",
            "3e5, -2e5, 0\n-2e5, 4e5, -2e5\n0, -2e5, 2e5\n",
        ),
        (
            "lib/two_actuator_frame.psd",
            include_str!("../../../../plans/lib/two_actuator_frame.psd"),
        ),
        (
            "ground/sine.csv",
            include_str!("../../../../plans/ground/sine.csv"),
        ),
        (
            "ground/three_sines.csv",
            include_str!("../../../../plans/ground/three_sines.csv"),
        ),
    ];
    known
        .iter()
        .find(|(name, _)| *name == path)
        .map(|(_, text)| (*text).to_owned())
        .ok_or(LoadError::NotFound)
}

/// A plan by its text, on this rig.
pub(crate) fn checked(text: &str, rig: &str) -> Plan {
    let checked = check_on(text, rig);
    checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics))
}

/// The messages of this code about the plan on this rig.
pub(crate) fn messages(text: &str, rig: &str, code: &str) -> Vec<String> {
    let diagnostics = check_on(text, rig).diagnostics;
    let of_code = diagnostics
        .into_iter()
        .filter(|diagnostic| diagnostic.code.to_string() == code);
    of_code.map(|diagnostic| diagnostic.message).collect()
}

fn check_on(text: &str, rig: &str) -> Checked {
    let options = Options {
        rig: Some(rig.to_owned()),
        ..Options::default()
    };
    check("plan.psd", text, &folder, &options)
}

/// The ground-motion test above for this duration.
pub(crate) fn base_excited_plan(duration: &str) -> Plan {
    checked(&PLAN.replace("DURATION", duration), "frame_rig")
}

/// The same in continuous mode; a step takes two seconds.
pub(crate) fn continuous_text(duration: &str) -> String {
    let mode = "  time_step = 10 ms\n  mode      = continuous(time_scale: 200)";
    PLAN.replace("DURATION", duration)
        .replace("  time_step = 10 ms", mode)
}

/// The ground-motion test above with these lines of its rig replaced.
pub(crate) fn with_devices(duration: &str, lines: &[(&str, &str)]) -> String {
    lines
        .iter()
        .fold(PLAN.replace("DURATION", duration), |text, (line, other)| {
            assert!(text.contains(line), "{line}");
            text.replace(line, other)
        })
}

/// Port of its single device.
pub(crate) const LINK: &str =
    "link        = serial(port: \"/dev/ttyUSB0\", dialect: native, reply_timeout: 0.1 s)";

/// Declaration of the upper axis.
pub(crate) fn upper(plan: &mut Plan) -> &mut AxisPlan {
    let link: &mut RealLink = crate::tests::fault_table::stage::link(plan);
    &mut link.axes[1]
}

/// The results of the first procedure: all numbers, in order, each with its name.
pub(crate) fn results(record: &Record) -> Vec<(&'static str, f64)> {
    let results = record
        .procedures
        .first()
        .map_or(&[][..], |procedure| &procedure.results);
    let numbers = |value: &ResultValue| match value {
        ResultValue::Number { value, .. } => value.iter().copied().collect::<Vec<f64>>(),
        ResultValue::List(values) => values.clone(),
    };
    results
        .iter()
        .flat_map(|result| {
            numbers(&result.value)
                .into_iter()
                .map(|value| (result.name, value))
        })
        .collect()
}

/// The same plan on a rig without errors.
pub(crate) fn ideal(text: &str) -> Vec<(&'static str, f64)> {
    let plan = checked(text, "ideal");
    results(&run(&plan, virtual_rig(&plan).as_mut(), &mut Unwatched))
}

/// All results equal those of the other run within `far` of each, which depends on its name and size.
pub(crate) fn same(real: &[(&str, f64)], ideal: &[(&str, f64)], far: impl Fn(&str, f64) -> f64) {
    assert!(real.len() == ideal.len() && real.len() > 8);
    for ((name, real), (_, ideal)) in real.iter().zip(ideal) {
        assert!(
            (real - ideal).abs() <= far(name, ideal.abs()),
            "{name}: {real} is not {ideal}"
        );
    }
}
