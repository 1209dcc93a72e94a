//! Binding of parameters: the plan is the one that a check of the edited text gives, and nothing is read again.

use std::cell::Cell;
use std::collections::BTreeMap;

use crate::check::binding::{Binder, BoundInputs};
use crate::check::{LoadError, Options, ParsedPlan};
use psd_language::codes::{E214, E301, E401, E406, E407};
use psd_plan::Plan;
use psd_text::diagnostic::Code;
use psd_text::units::{Dimension, Quantity};

use super::{checked, files};

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

const FILES: &[(&str, &str)] = &[("quake.csv", GROUND)];

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
    let mut parsed = ParsedPlan::parse("plan.psd", &text, &files(FILES), &options);
    let checked = parsed.check(&files(FILES));
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
    let edited = checked(&text("5.5 kg", "2.25 m/s", "0.75"), &files(FILES), &[]).0;
    assert_eq!(as_run(plan), as_run(edited.plan.unwrap()));
}

#[test]
fn a_bound_plan_is_the_plan_of_the_same_settings() {
    let written = [("mass", "5.5 kg"), ("velocity", "2.25 m/s")];
    let set = checked(&text("4 kg", "1 m/s", "1"), &files(FILES), &written).0;
    let values = bound(&[
        ("mass", 5.5, Dimension::MASS),
        ("velocity", 2.25, Dimension::VELOCITY),
    ]);
    let plan = parsed(&[]).bind(&values).unwrap();
    assert_eq!(format!("{:#?}", set.plan.unwrap()), format!("{plan:#?}"));
}

#[test]
fn a_binding_replaces_a_setting_and_leaves_the_others() {
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
        ("mas", 5.0, Dimension::MASS, E214),
        ("mass", 5.0, Dimension::LENGTH, E301),
        ("mass", 0.5, Dimension::MASS, E406),
        ("mass", f64::NAN, Dimension::MASS, E407),
        ("scale", f64::INFINITY, Dimension::NUMBER, E407),
        // The bounds of the parameter allow it, but a field does not.
        ("velocity", -1.0, Dimension::VELOCITY, E401),
    ] {
        let errors = parsed
            .bind(&bound(&[(name, value, dimension)]))
            .unwrap_err();
        let codes: Vec<Code> = errors.iter().map(|error| error.code).collect();
        assert_eq!(codes, [code], "{name} = {value}: {errors:?}");
    }
}

#[test]
fn files_are_read_once_however_often_parameters_are_bound() {
    let count = Cell::new(0);
    let loader = |path: &str| {
        count.set(count.get() + 1);
        files(FILES)(path)
    };
    let text = text("4 kg", "1 m/s", "1");
    let mut parsed = ParsedPlan::parse("plan.psd", &text, &loader, &Options::default());
    parsed.check(&loader);
    for velocity in [1.0, 2.0, 3.0] {
        let values = bound(&[("velocity", velocity, Dimension::VELOCITY)]);
        let plan = parsed.bind(&values).unwrap();
        assert_eq!(plan.files.len(), 2);
    }
    assert_eq!(count.get(), 1);
}

/// Binds rows of numbers one after the other, and each alone: the plans and the errors are the same. Gives the number of valid plans.
fn bound_in_turn(parsed: &ParsedPlan, inputs: &[(&str, Dimension)], rows: &[&[f64]]) -> usize {
    let known = BoundInputs::new(parsed, inputs.iter().copied());
    let mut binder = Binder::new(parsed, &known);
    let mut valid = 0;
    for row in rows {
        let named = inputs.iter().zip(*row);
        let values = named.map(|((name, dimension), value)| (*name, *value, *dimension));
        let alone = parsed.bind(&bound(&values.collect::<Vec<_>>()));
        let alone = alone.map(|mut plan| {
            plan.settings = parsed.bind(&BTreeMap::new()).unwrap().settings;
            format!("{plan:#?}")
        });
        let in_turn = binder.bind(row).map(|plan| format!("{plan:#?}"));
        valid += usize::from(in_turn.is_ok());
        assert_eq!(in_turn, alone, "{inputs:?}: {row:?}");
    }
    valid
}

#[test]
fn a_binding_does_not_depend_on_the_one_before() {
    let mass = ("mass", Dimension::MASS);
    let velocity = ("velocity", Dimension::VELOCITY);
    let scale = ("scale", Dimension::NUMBER);
    let parsed = parsed(&[]);
    // A mass of 0.5 kg is outside its bounds, and a striker does not move backwards.
    let count =
        |inputs: &[(&str, Dimension)], rows: &[&[f64]]| bound_in_turn(&parsed, inputs, rows);
    assert_eq!(count(&[mass], &[&[5.0], &[6.0], &[0.5], &[5.0]]), 3);
    assert_eq!(count(&[velocity], &[&[-1.0], &[2.0], &[3.0]]), 2);
    assert_eq!(count(&[scale], &[&[0.5], &[2.0]]), 2);
    let rows: [&[f64]; 4] = [
        &[5.0, 2.0, 0.5],
        &[5.0, -1.0, 0.5],
        &[6.0, 1.0, 0.7],
        &[5.0, 2.0, 0.5],
    ];
    assert_eq!(count(&[mass, velocity, scale], &rows), 3);
    let (fields, _) = parsed_fields(&[]);
    let inputs = VALUES.map(|(name, _, dimension)| (name, dimension));
    let numbers = VALUES.map(|(_, value, _)| value);
    for (number, input) in inputs.iter().enumerate() {
        let rows: [&[f64]; 3] = [&[numbers[number]], &[-1.0], &[0.99 * numbers[number]]];
        assert!(bound_in_turn(&fields, &[*input], &rows) >= 2, "{input:?}");
    }
}

/// The axial load of the column of an example.
const AXIAL: (&str, Dimension, f64) = ("vertical.force", Dimension::FORCE, 262.5e3);

/// Each number that an example names, and an axial load, which the specimen contains afterwards.
#[test]
fn every_example_is_bound_in_turn_as_alone() {
    let loader = |path: &str| {
        std::fs::read_to_string(format!("../plans/{path}")).map_err(|_| LoadError::NotFound)
    };
    let mut valid = 0;
    for entry in std::fs::read_dir("../plans").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "psd") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut parsed = ParsedPlan::parse("plan.psd", &text, &loader, &Options::default());
        let Some(plan) = parsed.check(&loader).plan else {
            continue;
        };
        let of_parameter = plan.parameters.iter();
        let mut inputs: Vec<(&str, Dimension, f64)> = of_parameter
            .map(|it| (it.name.as_str(), it.dimension, it.value))
            .collect();
        if path.ends_with("column_axial_load.psd") {
            inputs.push(AXIAL);
        }
        for (name, dimension, value) in inputs {
            let rows: [&[f64]; 3] = [&[1.01 * value], &[f64::NAN], &[0.99 * value]];
            valid += bound_in_turn(&parsed, &[(name, dimension)], &rows);
        }
    }
    assert!(valid >= 16, "{valid}");
}

/// A plan whose numbers are in blocks and in options of them.
const FIELDS: &str = "specimen beam {\n  mass = 1 kg\n  mass_uncertainty = 5 g\n  behaviour = fracture(of: elastic(stiffness: 300 kN/m), displacement: 1 m)\n}\n\
     striker hammer {\n  mass = 4 kg\n  arm = 1 m\n  angle = 60 deg\n}\n\
     impact hit {\n  striker = hammer\n  duration = 1 s\n  time_step = 0.1 ms\n  contact = limit(1500 N)\n}\n\
     require \"small\" hit.max_displacement < 2 * beam.mass / 1 kg * 1 m\n";

/// Values that decimals do not write exactly.
const VALUES: [(&str, f64, Dimension); 6] = [
    ("beam.mass", 0.1 + 0.2, Dimension::MASS),
    (
        "beam.behaviour.of.stiffness",
        1e6 / 3.0,
        Dimension::STIFFNESS,
    ),
    (
        "beam.behaviour.displacement",
        1.000_000_000_000_000_2,
        Dimension::LENGTH,
    ),
    (
        "hammer.angle",
        std::f64::consts::FRAC_PI_3,
        Dimension::ANGLE,
    ),
    (
        "hit.contact.force",
        1_499.999_999_999_999_8,
        Dimension::FORCE,
    ),
    ("hit.time_step", 1.234_567_890_123_456_7e-4, Dimension::TIME),
];

fn parsed_fields(settings: &[(String, String)]) -> (ParsedPlan, Plan) {
    let options = Options {
        settings: settings.to_vec(),
        ..Options::default()
    };
    let mut parsed = ParsedPlan::parse("plan.psd", FIELDS, &files(FILES), &options);
    let checked = parsed.check(&files(FILES));
    let plan = checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    (parsed, plan)
}

/// The text of `--set` that a study prints reproduces a bound run to the last bit.
#[test]
fn fields_are_bound_as_their_settings_write_them() {
    let bound_plan = parsed_fields(&[]).0.bind(&bound(&VALUES)).unwrap();
    let settings: Vec<(String, String)> = VALUES
        .iter()
        .map(|(name, value, dimension)| {
            let written = Quantity::new(*value, *dimension).in_plan_syntax();
            ((*name).to_owned(), written)
        })
        .collect();
    let set = parsed_fields(&settings).1;
    assert_eq!(as_run(set.clone()), as_run(bound_plan));
    assert_eq!(set.specimens[0].mass.to_bits(), (0.1_f64 + 0.2).to_bits());
    let unset = parsed_fields(&[]).1;
    assert_ne!(as_run(set), as_run(unset));
}

/// A number of any size is written so that it is read again to the last bit.
#[test]
fn a_setting_of_any_size_is_read_to_the_last_bit() {
    for value in [f64::MIN_POSITIVE, 1e-30 / 3.0, 1.0 / 3.0, 1e22 / 3.0] {
        let setting = Quantity::new(value, Dimension::MASS).in_plan_syntax();
        let set = [
            ("beam.mass".to_owned(), setting.replace(' ', "")),
            ("beam.mass_uncertainty".to_owned(), "0kg".to_owned()),
        ];
        let mass = parsed_fields(&set).1.specimens[0].mass;
        assert_eq!(mass.to_bits(), value.to_bits(), "{setting}");
    }
}

#[test]
fn a_name_of_no_number_is_an_error() {
    let (parsed, _) = parsed_fields(&[]);
    for (name, dimension, code) in [
        ("beam.mas", Dimension::MASS, E214),
        ("bean.mass", Dimension::MASS, E214),
        ("beam.stiffness", Dimension::STIFFNESS, E214),
        ("beam.behaviour", Dimension::STIFFNESS, E214),
        ("beam.mass.u", Dimension::MASS, E214),
        ("hammer.gap", Dimension::LENGTH, E214),
        ("hit.max_displacement", Dimension::LENGTH, E214),
        ("beam.mass", Dimension::LENGTH, E301),
    ] {
        let errors = parsed.bind(&bound(&[(name, 2.0, dimension)])).unwrap_err();
        let codes: Vec<Code> = errors.iter().map(|error| error.code).collect();
        assert_eq!(codes, [code], "{name}: {errors:?}");
    }
    for (value, code) in [(-1.0, E401), (f64::NAN, E407)] {
        let errors = parsed
            .bind(&bound(&[("beam.mass", value, Dimension::MASS)]))
            .unwrap_err();
        assert_eq!(errors[0].code, code, "{value}");
    }
}

const STOREYS: &str = "specimen frame {
  storeys = [
    storey(mass: 2 t, stiffness: 3 MN/m),
    storey(mass: 1.5 t, part: computed, behaviour: bilinear(stiffness: 2 MN/m, yield_force: 10 kN, post_yield_ratio: 5 %)),
  ]
}

ground quake { file = \"quake.csv\" }

shake test { ground = quake }

require \"drift\" max(test.max_drift) < 1 m
";

/// An entry of a list has its number, from 1.
#[test]
fn a_number_of_a_storey_is_set_by_the_number_of_the_storey() {
    let checked = |text: &str, settings: &[(&str, &str)]| {
        let settings = settings.iter();
        let options = Options {
            settings: settings
                .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
                .collect(),
            ..Options::default()
        };
        let mut parsed = ParsedPlan::parse("plan.psd", text, &files(FILES), &options);
        parsed.check(&files(FILES))
    };
    let set = checked(
        STOREYS,
        &[
            ("frame.storeys.1.mass", "2.5 t"),
            ("frame.storeys.2.behaviour.yield_force", "12 kN"),
        ],
    );
    let written = STOREYS.replace("2 t,", "2.5 t,").replace("10 kN", "12 kN");
    let written = checked(&written, &[]);
    assert_eq!(as_run(set.plan.unwrap()), as_run(written.plan.unwrap()));
    for name in [
        "frame.storeys",
        "frame.storeys.1",
        "frame.storeys.0.mass",
        "frame.storeys.3.mass",
        "frame.storeys.mass",
        "frame.storeys.1.stifness",
    ] {
        let codes: Vec<Code> = checked(STOREYS, &[(name, "1 kg")])
            .diagnostics
            .iter()
            .map(|error| error.code)
            .collect();
        assert_eq!(codes, [E214], "{name}");
    }
}
