//! Results of each procedure with unit and uncertainty, the reading of an impact's contact, its energy balance, and
//! the figures.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use super::super::figures::Drawn;
use super::super::{Run, number};
use super::{contact_log, cycles, pairs, words};
use crate::formula::ResultValue;
use crate::plan::{Contact, Impact, ProcedureKind};
use crate::quantity::{Dimension, display};
use crate::record::{History, ImpactHistory, NamedResult, ProcedureRecord};

/// Every procedure that was run, in order.
pub(super) fn procedures(run: &Run<'_>) -> Markup {
    html! {
        section {
            h2 { "Results" }
            @if run.record.procedures.is_empty() { p { "No procedure was run." } }
            @for (index, procedure) in run.record.procedures.iter().enumerate() {
                h3 { (procedure.name) " " span.soft { "· " (procedure.kind) @if !procedure.complete { " · not complete" } } }
                (inputs(procedure))
                @if !procedure.results.is_empty() { (table(procedure)) }
                @if let History::Cycle(history) = &procedure.history { (cycles::table(history)) }
                @if let History::Impact(history) = &procedure.history {
                    (force_note(run, index, procedure, history))
                    (contact_log::table(history))
                    (energy_balance(history))
                }
            }
        }
    }
}

fn inputs(procedure: &ProcedureRecord) -> Markup {
    let texts: Vec<String> = procedure
        .inputs
        .iter()
        .map(|(name, estimate, dimension)| {
            let value = match estimate.uncertainty {
                Some(_) => number::with_uncertainty(estimate.value, estimate.uncertainty, *dimension),
                None => number::stated(estimate.value, *dimension),
            };
            format!("{} {value}", words(name))
        })
        .collect();
    html! { @if !texts.is_empty() { p.note { "Run with: " (texts.join("; ")) "." } } }
}

/// Lists whose numbers stand in a table of their own are not printed twice.
fn table(procedure: &ProcedureRecord) -> Markup {
    let tabled = matches!(procedure.history, History::Cycle(_));
    let results =
        procedure.results.iter().filter(|result| !(tabled && matches!(result.value, ResultValue::List(_)))).collect::<Vec<_>>();
    html! {
        table.results {
            thead { tr { th { "Result" } th.number { "Value ± u" } th { "In the plan" } } }
            tbody {
                @for result in results {
                    tr {
                        td { (words(result.name)) }
                        td.number { (value(result)) }
                        td { code.soft { (result.name) } }
                    }
                }
            }
        }
    }
}

fn value(result: &NamedResult) -> Markup {
    match &result.value {
        ResultValue::Number { value: Some(value), uncertainty } => {
            // A goodness of fit is told by how many nines it has.
            let is_fit = result.name == "r_squared";
            let text =
                if is_fit { format!("{value:.6}") } else { number::with_uncertainty(*value, *uncertainty, result.dimension) };
            html! { (text) }
        }
        ResultValue::Number { value: None, .. } => html! { span.missing { "none in this run" } },
        ResultValue::List(values) => {
            let text = |value: &f64| if value.is_finite() { number::text(*value, result.dimension) } else { "none".to_owned() };
            let texts: Vec<String> = values.iter().map(text).collect();
            html! { (texts.join(", ")) }
        }
    }
}

/// What a reader of a peak contact force must know: the impulse, the step, and what the law makes of them.
fn force_note(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, history: &ImpactHistory) -> Markup {
    let Some(ProcedureKind::Impact(impact)) = run.plan.procedures.get(index).map(|planned| &planned.kind) else {
        return html! {};
    };
    let result = |name: &str| match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::Number { value, .. }) => *value,
        _ => None,
    };
    let step = number::text(history.time_step, Dimension::TIME);
    let critical = number::text(history.critical_time_step, Dimension::TIME);
    html! {
        p {
            "Contact law: " (contact_law(&impact.contact)) ". "
            @if let (Some(peak), Some(impulse)) = (result("max_contact_force"), result("impulse")) {
                "Peak contact force " (number::text(peak, Dimension::FORCE)) " with an impulse of "
                (number::text(impulse, Dimension::IMPULSE)) " at a time step of " (step) ". "
            } @else { "Time step " (step) ". " }
            "Critical time step (Melo et al. 2006, eq. 7) " (critical) ". " (pace(history))
            @if matches!(impact.contact, Contact::Rigid) {
                "Under the rigid law the contact force grows as the inverse of the time step: only the impulse is a property of the "
                "blow, the peak is not. " (implied_restitution(run, procedure, impact))
            }
            (damping_range(run, procedure, impact))
        }
    }
}

/// How far the damping of a sweep is carried beyond the velocities it was measured at: an extrapolation.
fn damping_range(run: &Run<'_>, procedure: &ProcedureRecord, impact: &Impact) -> Markup {
    let mut references = Vec::new();
    impact.damping.collect_references(&mut references);
    let swept = references.iter().filter_map(|reference| run.record.procedures.get(reference.procedure.0));
    let number = |procedure: &ProcedureRecord| match procedure.result("max_velocity").map(|result| &result.value) {
        Some(ResultValue::Number { value, .. }) => *value,
        _ => None,
    };
    let ranges = swept.filter_map(|sweep| Some((&sweep.name, number(sweep)?, number(procedure)?)));
    html! {
        @for (name, measured, used) in ranges.filter(|(_, _, used)| *used > 0.0) {
            " The damping of " code { (name) } " was measured up to " (number::text(measured, Dimension::VELOCITY)) ", "
            (number::text(100.0 * measured / used, Dimension::NUMBER)) " % of the largest velocity of the structure here ("
            (number::text(used, Dimension::VELOCITY)) ")" @if used > measured { ": it is an extrapolation." } @else { "." }
        }
    }
}

/// Virtual time beside the time the rig took for it.
fn pace(history: &ImpactHistory) -> Markup {
    let (Some(first), Some(last)) = (history.steps.first(), history.steps.last()) else { return html! {} };
    let (virtual_time, rig_time) = (last.time - first.time, last.wall_time - first.wall_time);
    html! {
        @if virtual_time > 0.0 && rig_time > 0.0 {
            (number::text(virtual_time, Dimension::TIME)) " of virtual time took " (number::text(rig_time, Dimension::TIME))
            " on the rig, " (format!("{:.0}", rig_time / virtual_time)) " times as long. "
        }
    }
}

/// The law of contact as the plan chose it, in words.
fn contact_law(contact: &Contact) -> &'static str {
    match contact {
        Contact::Rigid => "rigid",
        Contact::Limit { .. } => "rigid up to a limit force",
        Contact::Restitution { .. } => "restitution",
        Contact::Hertz { .. } => "Hertz",
    }
}

/// e = Ms/(Ms + 2M): what the rigid law is as the time step goes to zero.
fn implied_restitution(run: &Run<'_>, procedure: &ProcedureRecord, impact: &Impact) -> Markup {
    let mass = procedure.inputs.iter().find(|(name, ..)| *name == "mass").map(|(_, estimate, _)| estimate.value);
    let striker = run.plan.strikers.get(impact.striker).map(|striker| striker.mass);
    let (Some(mass), Some(striker)) = (mass.or_else(|| impact.mass.constant()), striker) else { return html! {} };
    let restitution = striker / (striker + 2.0 * mass);
    html! {
        "It implies a coefficient of restitution e = Ms/(Ms + 2M) = " (number::text(restitution, Dimension::NUMBER))
        " (Ms striker mass, M equivalent mass of the structure)."
    }
}

/// Where the striker's energy was at the end of the run.
fn energy_balance(history: &ImpactHistory) -> Markup {
    let (Some(first), Some(last)) = (history.steps.first(), history.steps.last()) else { return html! {} };
    let input = first.energies.striker;
    let e = last.energies;
    let parts = [
        ("striker, kinetic", e.striker),
        ("structure, kinetic", e.structure),
        ("restoring force, ∫R dX", e.restoring),
        ("damping, ∫CẊ dX", e.damping),
        ("contact loss", e.contact_loss),
        ("integration error", e.error),
    ];
    html! {
        table.results {
            thead { tr { th { "Energy balance at the end of the run" } th.number { "Energy" } th.number { "Of the input" } } }
            tbody {
                tr { td { "input, ½MsV₀²" } td.number { (number::text(input, Dimension::ENERGY)) } td.number { "100 %" } }
                @for (name, energy) in parts {
                    tr {
                        td { (name) }
                        td.number { (number::text_beside(energy, input, Dimension::ENERGY)) }
                        td.number { @if input > 0.0 { (percent(energy / input)) } @else { "—" } }
                    }
                }
            }
        }
        @if e.indentation > 0.0 {
            p.note {
                "Indentation energy F·Δδp, an indicator and no part of the balance: " (number::text(e.indentation, Dimension::ENERGY))
                ". It equals the contact loss only as the time step goes to zero."
            }
        }
    }
}

fn percent(share: f64) -> String {
    let text =
        if share != 0.0 && share.abs() < 1e-4 { format!("{:.1e}", 100.0 * share) } else { format!("{:.2}", 100.0 * share) };
    display::minus(&text) + " %"
}

/// Every figure, numbered, its picture inside the page.
pub(super) fn figures(figures: &[Drawn]) -> Markup {
    html! {
        @if !figures.is_empty() {
            section {
                h2 { "Figures" }
                @for (index, figure) in figures.iter().enumerate() {
                    figure {
                        img alt=(figure.caption) src={ "data:image/png;base64," (STANDARD.encode(&figure.png)) };
                        figcaption { b { "Figure " (index + 1) ". " } (figure.caption) }
                    }
                }
            }
        }
    }
}

/// A table of plain pairs for the sections that follow.
pub(super) fn described(rows: Vec<(&str, String)>) -> Markup {
    let rows: Vec<(String, Markup)> = rows.into_iter().map(|(name, text)| (name.to_owned(), html! { (text) })).collect();
    pairs(&rows)
}
