//! Conditions of the test: the item, the striker, the rig with its limits, the parameters, and the particulars that a
//! laboratory gives. What was not given is said to be so.

use maud::{Markup, html};

use super::super::{Run, number};
use super::results::described;
use super::{equipment, given, pairs, words};
use crate::plan::{Behaviour, Ends, Interval, Limits, Settle, Specimen, Striker};
use crate::quantity::Dimension;

/// Particulars of a report after clause 7.8.2 that the `plan` block may give.
const PARTICULARS: &[(&str, &str)] = &[
    ("laboratory", "Laboratory"),
    ("place", "Place of the test"),
    ("customer", "Customer"),
    ("project", "Project"),
    ("operator", "Operator"),
    ("standard", "Method"),
    ("revision", "Revision of the plan"),
    ("specimen_id", "Item tested"),
    ("material", "Material"),
    ("receipt_date", "Item received"),
    ("equipment", "Equipment"),
    ("temperature", "Temperature"),
    ("humidity", "Humidity"),
];

/// Everything about how the test was set up.
pub(super) fn all(run: &Run<'_>) -> Markup {
    html! {
        section {
            h2 { "Particulars" }
            (particulars(run))
        }
        section {
            h2 { "Conditions of the test" }
            @for specimen in &run.plan.specimens { h3 { "Specimen " (specimen.name) } (specimen_table(specimen)) }
            @for striker in &run.plan.strikers { h3 { "Striker " (striker.name) } (striker_table(striker)) }
            h3 { "Rig " (run.record.rig.name) }
            @match run.plan.rig.link.as_real() {
                Some(link) => (equipment::table(run, link)),
                None => (rig(run)),
            }
            h3 { "Limits" }
            (limits(&run.plan.limits))
            @if !run.plan.parameters.is_empty() { h3 { "Parameters" } (parameters(run)) }
            p.note {
                "Masses, geometry and striker speed are as the plan states them; they were not measured in this run. A pseudo-dynamic "
                "test loads the specimen slowly: effects of strain rate and of the inertia of the specimen are not in the measured force."
            }
        }
    }
}

fn particulars(run: &Run<'_>) -> Markup {
    let stated = |field: &str| run.plan.particulars.iter().find(|(name, _)| *name == field).map(|(_, text)| text.as_str());
    // Who stood by is known from the record, whoever the plan names.
    let operator = run.provenance.operator();
    let text = |field: &str| if field == "operator" { operator.or_else(|| stated(field)) } else { stated(field) };
    let mut rows: Vec<(String, Markup)> =
        PARTICULARS.iter().map(|(field, name)| ((*name).to_owned(), given(text(field)))).collect();
    rows.push(("Date of the test".to_owned(), given(run.provenance.date.as_deref())));
    // The edition is the language's, the decision rule stands beside the requirements, deviations with the others.
    let known = |field: &str| {
        matches!(field, "date" | "edition" | "decision_rule" | "deviations") || PARTICULARS.iter().any(|(name, _)| *name == field)
    };
    for (field, text) in run.plan.particulars.iter().filter(|(field, _)| !known(field)) {
        rows.push((words(field), given(Some(text))));
    }
    pairs(&rows)
}

fn specimen_table(specimen: &Specimen) -> Markup {
    let mut rows = vec![("equivalent mass", number::stated(specimen.mass, Dimension::MASS))];
    match specimen.behaviour {
        None => {}
        Some(Behaviour::Elastic { stiffness }) => {
            rows.push(("virtual behaviour", format!("elastic, stiffness {}", number::stated(stiffness, Dimension::STIFFNESS))));
        }
        Some(Behaviour::Bilinear { stiffness, yield_force, hardening }) => rows.push((
            "virtual behaviour",
            format!(
                "bilinear, stiffness {}, yield force {}, hardening {}",
                number::stated(stiffness, Dimension::STIFFNESS),
                number::stated(yield_force, Dimension::FORCE),
                number::stated(hardening, Dimension::NUMBER)
            ),
        )),
        Some(Behaviour::Beam { stiffness, length, youngs_modulus, second_moment, ends }) => rows.push((
            "virtual behaviour",
            format!(
                "beam, {}, length {}, modulus {}, second moment {}: stiffness {}",
                held(ends),
                number::stated(length, Dimension::LENGTH),
                number::stated(youngs_modulus, Dimension::PRESSURE),
                number::stated(second_moment, Dimension::SECOND_MOMENT),
                number::stated(stiffness, Dimension::STIFFNESS)
            ),
        )),
    }
    if specimen.damping != 0.0 {
        rows.push(("damping on the load cell", number::stated(specimen.damping, Dimension::DAMPING)));
    }
    if specimen.coulomb != 0.0 {
        rows.push(("friction on the load cell", number::stated(specimen.coulomb, Dimension::FORCE)));
    }
    described(rows)
}

fn held(ends: Ends) -> String {
    match ends {
        Ends::Cantilever => "cantilever".to_owned(),
        Ends::SimplySupported => "simply supported".to_owned(),
        Ends::BuiltIn => "built in".to_owned(),
        Ends::PartlyBuiltIn { rotational_stiffness } => {
            format!(
                "partly built in ({} per radian)",
                number::stated(rotational_stiffness, Dimension::ENERGY).replace('J', "N·m")
            )
        }
    }
}

fn striker_table(striker: &Striker) -> Markup {
    let mut rows = vec![
        ("mass", number::stated(striker.mass, Dimension::MASS)),
        ("velocity at the start", number::stated(striker.velocity, Dimension::VELOCITY)),
        ("energy", number::stated(0.5 * striker.mass * striker.velocity * striker.velocity, Dimension::ENERGY)),
        ("gap at the start", number::stated(striker.gap, Dimension::LENGTH)),
    ];
    if striker.gravity != 0.0 {
        rows.push(("acceleration along its way", number::stated(striker.gravity, Dimension::ACCELERATION)));
    }
    described(rows)
}

fn rig(run: &Run<'_>) -> Markup {
    let identity = &run.record.rig;
    let mut rows = vec![
        ("Kind".to_owned(), html! { @if identity.simulated { "simulated: nothing real moved" } @else { "real" } }),
        ("Model".to_owned(), given(Some(&identity.model))),
        ("Serial number".to_owned(), given(Some(&identity.serial))),
        ("Firmware".to_owned(), given(Some(&identity.firmware))),
        ("Calibration".to_owned(), given(run.plan.rig.calibration.reference.as_deref())),
    ];
    let link = run.plan.rig.link.as_virtual().copied().unwrap_or_default();
    if identity.simulated {
        let terms = [
            ("load-cell noise", link.noise, Dimension::FORCE),
            ("displacement quantum", link.resolution, Dimension::LENGTH),
            ("force quantum", link.force_resolution, Dimension::FORCE),
            ("actuator lag", link.lag, Dimension::TIME),
            ("increment not reached", link.tracking, Dimension::NUMBER),
            ("load-cell drift", link.drift, Dimension::FORCE_RATE),
        ];
        let stated: Vec<String> = terms
            .into_iter()
            .filter(|(_, value, _)| *value != 0.0)
            .map(|(name, value, dimension)| format!("{name} {}", number::stated(value, dimension)))
            .collect();
        let text = if stated.is_empty() { "none: an ideal rig".to_owned() } else { stated.join("; ") };
        rows.push(("Simulated errors".to_owned(), html! { (text) }));
    }
    rows.push(("Settling".to_owned(), html! { (settling(run.plan.rig.settle)) }));
    pairs(&rows)
}

pub(super) fn settling(settle: Settle) -> String {
    if settle.band == 0.0 {
        return "a reading counts at once".to_owned();
    }
    format!(
        "within {} of the target and under {} for {}, at most {}",
        number::stated(settle.band, Dimension::LENGTH),
        number::stated(settle.force_rate, Dimension::FORCE_RATE),
        number::stated(settle.dwell, Dimension::TIME),
        number::stated(settle.timeout, Dimension::TIME)
    )
}

fn limits(limits: &Limits) -> Markup {
    let rows: Vec<(&str, String)> = [
        ("displacement", limits.displacement, Dimension::LENGTH),
        ("force", limits.force, Dimension::FORCE),
        ("speed", limits.speed, Dimension::VELOCITY),
        ("increment", limits.increment, Dimension::LENGTH),
        ("tracking error", limits.tracking_error, Dimension::LENGTH),
        ("energy error", limits.energy_error, Dimension::NUMBER),
        ("tracking energy error", limits.tracking_energy_error, Dimension::NUMBER),
        ("NRMS tracking error", limits.nrms_error, Dimension::NUMBER),
    ]
    .into_iter()
    .filter(|(_, interval, _)| interval.is_bounded())
    .map(|(name, interval, dimension)| (name, range(interval, dimension)))
    .collect();
    html! { @if rows.is_empty() { p { "The plan sets no limit." } } @else { (described(rows)) } }
}

pub(super) fn range(interval: Interval, dimension: Dimension) -> String {
    let largest = [interval.low, interval.high].into_iter().filter(|end| end.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()));
    let text = |value: f64| number::stated_beside(value, largest, dimension);
    match (interval.low.is_finite(), interval.high.is_finite()) {
        (true, true) => format!("{} to {}", text(interval.low), text(interval.high)),
        (true, false) => format!("≥ {}", text(interval.low)),
        (false, _) => format!("≤ {}", text(interval.high)),
    }
}

fn parameters(run: &Run<'_>) -> Markup {
    let rows: Vec<(String, Markup)> = run
        .plan
        .parameters
        .iter()
        .map(|parameter| {
            let origin = if parameter.set { "set for this run" } else { "as the plan states" };
            (
                parameter.name.clone(),
                html! { (number::stated(parameter.value, parameter.dimension)) " " span.soft { "(" (origin) ")" } },
            )
        })
        .collect();
    pairs(&rows)
}
