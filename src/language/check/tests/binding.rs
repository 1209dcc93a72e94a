//! Binding of parameters: the plan is the one that a check of the edited text gives, and nothing is read again.

use std::cell::Cell;
use std::collections::BTreeMap;

use super::{Files, checked};
use crate::language::check::{LoadError, Loader, Options, ParsedPlan};
use crate::plan::Plan;
use crate::text::diagnostic::Code;
use crate::units::{Dimension, Quantity};

const GROUND: &str = "time_s,acceleration_m_per_s2\n0,0\n0.01,1.5\n0.02,-0.5\n";

/// A plan whose parameters reach a specimen, a striker, a ground motion, a procedure and a requirement.
fn text(mass: &str, velocity: &str, scale: &str) -> String {
    format!(
        "param mass = {mass} between 1 kg .. 10 kg\n\
         param velocity = {velocity}\n\
         param scale = {scale}\n\
         let energy = mass * velocity^2 / 2\n\
         specimen beam {{\n  mass = 2 * mass\n  behaviour = elastic(stiffness: 300 kN/m * scale)\n}}\n\
         striker hammer {{\n  mass = mass\n  velocity = velocity\n}}\n\
         ground quake {{\n  file = \"quake.csv\"\n  scale = scale\n}}\n\
         impact hit {{\n  striker = hammer\n  duration = 1 s\n  time_step = 1 ms\n}}\n\
         require \"absorbs\" hit.max_displacement * 1 N < energy\n"
    )
}

const FILES: Files = Files(&[("quake.csv", GROUND)]);

/// All of a plan that a run reads, without the origin of its values.
fn as_run(mut plan: Plan) -> String {
    plan.files.clear();
    plan.settings.clear();
    for parameter in &mut plan.parameters {
        parameter.set = false;
    }
    format!("{plan:#?}")
}

fn bound(values: &[(&str, f64, Dimension)]) -> BTreeMap<String, Quantity> {
    let quantity = |(name, value, dimension): &(&str, f64, Dimension)| {
        ((*name).to_owned(), Quantity::new(*value, *dimension))
    };
    values.iter().map(quantity).collect()
}

fn parsed(settings: &[(&str, &str)]) -> ParsedPlan {
    let options = Options {
        settings: settings
            .iter()
            .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
            .collect(),
        ..Options::default()
    };
    let text = text("4 kg", "1 m/s", "1");
    let mut parsed = ParsedPlan::parse("plan.psd", &text, &FILES, &options);
    let checked = parsed.check(&FILES);
    assert!(checked.plan.is_some(), "{:?}", checked.diagnostics);
    parsed
}

#[test]
fn a_bound_plan_is_the_plan_of_the_edited_text() {
    let values = bound(&[
        ("mass", 5.5, Dimension::MASS),
        ("velocity", 2.25, Dimension::VELOCITY),
        ("scale", 0.75, Dimension::NUMBER),
    ]);
    let plan = parsed(&[]).bind(&values).unwrap();
    assert!(plan.parameters.iter().all(|parameter| parameter.set));
    let edited = checked(&text("5.5 kg", "2.25 m/s", "0.75"), &FILES, &[]).0;
    assert_eq!(as_run(plan), as_run(edited.plan.unwrap()));
}

#[test]
fn a_bound_plan_is_the_plan_of_the_same_settings() {
    let written = [("mass", "5.5 kg"), ("velocity", "2.25 m/s")];
    let set = checked(&text("4 kg", "1 m/s", "1"), &FILES, &written).0;
    let values = bound(&[
        ("mass", 5.5, Dimension::MASS),
        ("velocity", 2.25, Dimension::VELOCITY),
    ]);
    let plan = parsed(&[]).bind(&values).unwrap();
    assert_eq!(format!("{:#?}", set.plan.unwrap()), format!("{plan:#?}"));
}

#[test]
fn a_binding_takes_the_place_of_a_setting_and_leaves_the_others() {
    let plan = parsed(&[("mass", "6 kg"), ("scale", "2")])
        .bind(&bound(&[("mass", 7.0, Dimension::MASS)]))
        .unwrap();
    let settings: Vec<_> = plan
        .settings
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()))
        .collect();
    assert_eq!(settings, [("mass", "7 kg"), ("scale", "2")]);
    assert_eq!(plan.strikers[0].mass, 7.0);
    assert_eq!(plan.grounds[0].scale, 2.0);
}

#[test]
fn a_value_that_does_not_fit_is_an_error() {
    let parsed = parsed(&[]);
    for (name, value, dimension, code) in [
        ("mas", 5.0, Dimension::MASS, Code::UnknownParameter),
        ("mass", 5.0, Dimension::LENGTH, Code::WrongDimension),
        ("mass", 0.5, Dimension::MASS, Code::SettingOutOfRange),
        ("mass", f64::NAN, Dimension::MASS, Code::NotFinite),
        ("scale", f64::INFINITY, Dimension::NUMBER, Code::NotFinite),
        // The bounds of the parameter allow it, but a field does not.
        ("velocity", -1.0, Dimension::VELOCITY, Code::OutOfRange),
    ] {
        let errors = parsed
            .bind(&bound(&[(name, value, dimension)]))
            .unwrap_err();
        let codes: Vec<Code> = errors.iter().map(|error| error.code).collect();
        assert_eq!(codes, [code], "{name} = {value}: {errors:?}");
    }
}

/// Counts how often a file is read.
struct Counting(Cell<usize>);

impl Loader for Counting {
    fn load(&self, path: &str) -> Result<String, LoadError> {
        self.0.set(self.0.get() + 1);
        FILES.load(path)
    }
}

#[test]
fn files_are_read_once_however_often_parameters_are_bound() {
    let loader = Counting(Cell::new(0));
    let text = text("4 kg", "1 m/s", "1");
    let mut parsed = ParsedPlan::parse("plan.psd", &text, &loader, &Options::default());
    parsed.check(&loader);
    for velocity in [1.0, 2.0, 3.0] {
        let values = bound(&[("velocity", velocity, Dimension::VELOCITY)]);
        let plan = parsed.bind(&values).unwrap();
        assert_eq!(plan.files.len(), 2);
    }
    assert_eq!(loader.0.get(), 1);
}
