//! Results of each procedure with unit and uncertainty, the line an identification fitted, the reading of an impact's
//! contact and its energy balance. In: a run. Out: blocks, a procedure at a time.

use super::super::document::{Block, Column, Table, Text};
use super::super::{Run, expansion, number};
use super::{blows, budget, contact_log, curve, cycles, frames, method, storey, words};
use crate::formula::{Part, ProcedureId, ResultReference, ResultValue};
use crate::plan::{Contact, Impact, ProcedureKind, RelaxationLaw, RelaxationModel};
use crate::quantity::Dimension;
use crate::record::{History, Hold, ImpactHistory, LineFit, NamedResult, ProcedureRecord, ReachedFit, RelaxationFit};
use crate::uncertainty::{Known, known};

/// Every procedure that was run, in order.
pub(super) fn procedures(run: &Run<'_>, body: &mut Vec<Block>) {
    body.push(Block::section("Results"));
    if run.record.procedures.is_empty() {
        body.push(Block::paragraph("No procedure was run."));
    }
    for (index, procedure) in run.record.procedures.iter().enumerate() {
        let state = if procedure.complete { "" } else { " · not complete" };
        body.push(Block::part(Text::from(procedure.name.as_str()).soft(format!(" · {}{state}", procedure.kind))));
        inputs(procedure, body);
        results(run, index, procedure, body);
        match &procedure.history {
            History::Ramp(history) => {
                if let Some(fit) = &history.multilinear {
                    let reach = history.steps.iter().map(|step| step.displacement);
                    curve::table(fit, reach.fold(0.0, |most, x| if fit.way * x > fit.way * most { x } else { most }), body);
                }
                if let Some(fit) = &history.relaxation {
                    body.push(relaxed(fit, &history.holds));
                }
                if let Some(fit) = &history.reached {
                    body.push(relaxed_by_a_law(fit, &history.holds));
                }
                if let Some(fit) = history.fit {
                    body.push(fitted("R = K·X + R₀", ("K", Dimension::STIFFNESS), ("R₀", Dimension::FORCE), fit));
                }
            }
            History::Sweep(history) => {
                if let Some(fit) = history.fit {
                    body.push(fitted("F = c·v + F₀·sign v", ("c", Dimension::DAMPING), ("F₀", Dimension::FORCE), fit));
                }
            }
            History::Impact(history) => {
                force_note(run, index, procedure, history, body);
                method::note(run, index, history, body);
                energy_balance(contact_work(run, index), history, body);
                contact_log::table(history, body);
            }
            History::StoreyImpact(history) => storey::struck(run, index, procedure, history, body),
            History::Cycle(history) => cycles::table(history, body),
            History::Shake(history) => frames::shaken(run, index, procedure, history, body),
            History::Escalate(history) => blows::table(run, index, procedure, history, body),
            History::FrameUnload(steps) => frames::unloaded(run, index, procedure, steps, body),
            History::Move(_) | History::Inspect => {}
        }
        budget::table(run, index, procedure, body);
    }
}

fn inputs(procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let text = |(name, estimate, dimension): &(&'static str, crate::formula::Estimate, Dimension)| {
        let value = match estimate.uncertainty {
            Some(_) => number::with_uncertainty(estimate.value, estimate.uncertainty, *dimension),
            None => number::stated(estimate.value, *dimension),
        };
        format!("{} {value}", words(name))
    };
    let texts: Vec<String> = procedure.inputs.iter().map(text).collect();
    if !texts.is_empty() {
        let kind = if procedure.inputs.iter().any(|(_, estimate, _)| estimate.uncertainty.is_some()) { " (± u)" } else { "" };
        body.push(Block::note(format!("Run with{kind}: {}.", texts.join("; "))));
    }
}

/// Lists whose numbers stand in a table of their own are not printed twice, and what the run did not give is named below.
fn results(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, body: &mut Vec<Block>) {
    let tabled = match &procedure.history {
        History::Ramp(history) => history.multilinear.is_some(),
        History::Cycle(_) | History::Escalate(_) | History::Shake(_) | History::StoreyImpact(_) | History::FrameUnload(_) => true,
        _ => false,
    };
    let printed = procedure.results.iter().filter(|result| !(tabled && matches!(result.value, ResultValue::List(_))));
    let (found, none): (Vec<&NamedResult>, Vec<&NamedResult>) = printed.partition(|result| match &result.value {
        ResultValue::Number { value, .. } => value.is_some(),
        ResultValue::List(values) => !values.is_empty(),
    });
    if !found.is_empty() {
        body.push(table(run, index, &found));
    }
    if !none.is_empty() {
        let named = none.iter().enumerate().fold(Text::from("None in this run: "), |text, (index, result)| {
            if index == 0 { text.code(result.name) } else { text.and(", ").code(result.name) }
        });
        body.push(Block::note(named.and(".")));
    }
    body.extend(budget::marked(procedure));
}

fn table(run: &Run<'_>, index: usize, results: &[&NamedResult]) -> Block {
    let known = |result: &NamedResult| {
        let reference = ResultReference { procedure: ProcedureId(index), name: result.name, part: Part::Value };
        known(&result.contributions_of(reference), run.record)
    };
    let all: Vec<Option<Known>> = results.iter().map(|result| known(result)).collect();
    // A column of twos says nothing.
    let factors = all.iter().flatten().any(|known| expansion::is_more(*known));
    let mut columns = vec![
        Column::words("Result", 1),
        Column::numbers("Value"),
        Column::numbers("u"),
        Column::numbers(if factors { "U = k·u" } else { "U (k = 2)" }),
        Column::short("Unit"),
        Column::short("In the plan"),
    ];
    if factors {
        columns.insert(3, Column::numbers("k (ν)"));
    }
    let rows = results.iter().zip(&all).map(|(result, known)| {
        let mut row = row(result, *known);
        if factors {
            let text = known.filter(|known| known.standard > 0.0 && matches!(result.value, ResultValue::Number { .. }));
            let text = text.map(|known| format!("{} ({})", expansion::factor(known), expansion::degrees_text(known)));
            row.insert(3, text.map_or_else(|| "—".into(), Text::from));
        }
        row
    });
    Block::Table(Table { columns, rows: rows.collect() })
}

fn row(result: &NamedResult, known: Option<Known>) -> Vec<Text> {
    let dash = || Text::from("—");
    let [value, standard, expanded, unit] = match &result.value {
        // A goodness of fit is told by how many nines it has.
        ResultValue::Number { value: Some(value), .. } if result.name == "r_squared" => {
            [format!("{value:.6}").into(), dash(), dash(), dash()]
        }
        ResultValue::Number { value: Some(value), uncertainty } => {
            let known = uncertainty.map(|standard| Known { standard, ..known.unwrap_or(Known::surely(standard)) });
            let parts = number::parts(*value, known, result.dimension);
            let unit = if parts.unit.is_empty() { dash() } else { parts.unit.into() };
            [parts.value.into(), parts.standard.map_or_else(dash, Text::from), parts.expanded.map_or_else(dash, Text::from), unit]
        }
        ResultValue::Number { value: None, .. } => [Text::missing("none in this run"), dash(), dash(), dash()],
        ResultValue::List(values) if values.is_empty() => [Text::missing("none in this run"), dash(), dash(), dash()],
        ResultValue::List(values) => {
            let text = |value: &f64| if value.is_finite() { number::text(*value, result.dimension) } else { "none".to_owned() };
            let texts: Vec<String> = values.iter().map(text).collect();
            [texts.join(", ").into(), dash(), dash(), dash()]
        }
    };
    let sure = !matches!(result.value, ResultValue::Number { .. }) || budget::is_sure(result, 0);
    let name = Text::from(words(result.name)).and(if sure { "" } else { budget::MARK });
    vec![name, value, standard, expanded, unit, Text::new().code(result.name)]
}

/// The line of least squares with the standard error of both its numbers, and how far the readings lie from it.
fn fitted(line: &str, slope: (&str, Dimension), intercept: (&str, Dimension), fit: LineFit) -> Block {
    let number = |(name, dimension): (&str, Dimension), value, error| {
        format!("{name} = {}", number::with_uncertainty(value, Some(error), dimension))
    };
    Block::note(format!(
        "Least-squares line {line}: {}, {} (± standard error), R² = {:.6}.",
        number(slope, fit.slope, fit.slope_error),
        number(intercept, fit.intercept, fit.intercept_error),
        fit.r_squared
    ))
}

/// The relaxation of the holds: its model, how far the readings lie from it, and what the pauses left.
fn relaxed(fit: &RelaxationFit, holds: &[Hold]) -> Block {
    let with = |(value, error): (f64, f64), dimension| number::with_uncertainty(value, Some(error), dimension);
    let model = match fit.model {
        RelaxationModel::Exponential => "R = R∞ + A e^(−t/τ) in every pause".to_owned(),
        RelaxationModel::StandardLinearSolid => {
            let solid = fit.branch_stiffness.map(|stiffness| format!(", K₁ = {}", with(stiffness, Dimension::STIFFNESS)));
            format!("R = R₀ + K∞X + q, q' = K₁X' − q/τ through all moves and pauses{}", solid.unwrap_or_default())
        }
    };
    let readings: usize = holds.iter().map(|hold| hold.readings.len()).sum();
    Block::note(format!(
        "Relaxation by least squares over {readings} readings in {} pauses: {model}, τ = {} (± standard error); the readings scatter \
         by {} about it. The pauses left {} to relax, at most.",
        holds.len(),
        with(fit.time_constant, Dimension::TIME),
        number::text(fit.scatter, Dimension::FORCE),
        with(fit.remaining, Dimension::FORCE),
    ))
}

/// The law by which the reached force relaxes, why that one, and how fast the pauses were still losing.
fn relaxed_by_a_law(fit: &ReachedFit, holds: &[Hold]) -> Block {
    let with = |(value, error): (f64, f64), dimension| number::with_uncertainty(value, Some(error), dimension);
    let best = fit.best();
    let (law, share) = match best.law {
        RelaxationLaw::Exponential => ("R̂ − R grows by g (1 − e^(−t/τ))", "g"),
        RelaxationLaw::Logarithmic => ("R̂ − R grows by a ln(1 + t/t₀)", "a"),
    };
    let chosen = fit.margin().map_or_else(String::new, |margin| {
        let other = if margin > 0.0 { "an exponential" } else { "the logarithm of time" };
        format!(" BIC, corrected for few readings, prefers it to {other} by {:.1}.", margin.abs())
    });
    let readings: usize = holds.iter().map(|hold| hold.readings.len()).sum();
    Block::note(format!(
        "Relaxation by least squares over {readings} readings in {} pauses, each step by its own time: {law} of each increment of the \
         reached force R̂, {share} = {}, {} = {} (± standard error); the readings scatter by {} about it.{chosen} The worst pause ended \
         while the force fell by {}.",
        holds.len(),
        with(best.share, Dimension::NUMBER),
        best.law.time_name(),
        with(best.time, Dimension::TIME),
        number::text(best.scatter, Dimension::FORCE),
        with(best.rate, Dimension::FORCE_RATE),
    ))
}

/// What a reader of a peak contact force must know: the impulse, the step, and what the law makes of them.
fn force_note(run: &Run<'_>, index: usize, procedure: &ProcedureRecord, history: &ImpactHistory, body: &mut Vec<Block>) {
    let Some(ProcedureKind::Impact(impact)) = run.plan.procedures.get(index).map(|planned| &planned.kind) else { return };
    let step = number::text(history.time_step, Dimension::TIME);
    let critical = number::text(history.critical_time_step, Dimension::TIME);
    let forces = match (scalar(procedure, "max_contact_force"), scalar(procedure, "impulse")) {
        (Some(peak), Some(impulse)) => format!(
            "Peak contact force {} with an impulse of {} at a time step of {step}.",
            number::text(peak, Dimension::FORCE),
            number::text(impulse, Dimension::IMPULSE)
        ),
        _ => format!("Time step {step}."),
    };
    let mut sentences = vec![
        format!("Contact law: {}.", contact_law(&impact.contact)),
        forces,
        format!("Critical time step (Melo et al. 2006, eq. 7) {critical}."),
    ];
    if matches!(impact.contact, Contact::Rigid) {
        sentences.push(
            "Under the rigid law the contact force grows as the inverse of the time step: only the impulse is a property of the \
             blow, the peak is not."
                .to_owned(),
        );
        sentences.extend(implied_restitution(run, procedure, impact));
    }
    sentences.extend(damping_range(run, procedure, impact));
    body.push(Block::paragraph(sentences.join(" ")));
}

pub(super) fn scalar(procedure: &ProcedureRecord, name: &str) -> Option<f64> {
    match procedure.result(name).map(|result| &result.value) {
        Some(ResultValue::Number { value, .. }) => *value,
        _ => None,
    }
}

/// How far the damping of a sweep is carried beyond the velocities it was measured at: an extrapolation.
fn damping_range(run: &Run<'_>, procedure: &ProcedureRecord, impact: &Impact) -> Vec<String> {
    let mut references = Vec::new();
    impact.damping.collect_references(&mut references);
    let swept = references.iter().filter_map(|reference| run.record.procedures.get(reference.procedure.0));
    let ranges =
        swept.filter_map(|sweep| Some((&sweep.name, scalar(sweep, "max_velocity")?, scalar(procedure, "max_velocity")?)));
    let told = ranges.filter(|(_, _, used)| *used > 0.0).map(|(name, measured, used)| {
        format!(
            "The damping of {name} was measured up to {}, {}\u{a0}% of the largest velocity of the structure here ({}){}",
            number::text(measured, Dimension::VELOCITY),
            number::text(100.0 * measured / used, Dimension::NUMBER),
            number::text(used, Dimension::VELOCITY),
            if used > measured { ": it is an extrapolation." } else { "." }
        )
    });
    told.collect()
}

/// The law of contact as the plan chose it, in words.
pub(super) fn contact_law(contact: &Contact) -> &'static str {
    match contact {
        Contact::Rigid => "rigid",
        Contact::Limit { .. } => "rigid up to a limit force",
        Contact::Restitution { .. } => "restitution",
        Contact::Hertz { .. } => "Hertz",
    }
}

/// e = Ms/(Ms + 2M): what the rigid law is as the time step goes to zero.
fn implied_restitution(run: &Run<'_>, procedure: &ProcedureRecord, impact: &Impact) -> Option<String> {
    let mass = procedure.inputs.iter().find(|(name, ..)| *name == "mass").map(|(_, estimate, _)| estimate.value);
    let striker = run.plan.strikers.get(impact.striker).map(|striker| striker.mass);
    let (mass, striker) = (mass.or_else(|| impact.mass.constant())?, striker?);
    let restitution = striker / (striker + 2.0 * mass);
    Some(format!(
        "It implies a coefficient of restitution e = Ms/(Ms + 2M) = {} (Ms striker mass, M equivalent mass of the structure).",
        number::text(restitution, Dimension::NUMBER)
    ))
}

/// What the contact took, as it is summed over the steps: from the forces at their ends, or within them.
pub(super) fn contact_work(run: &Run<'_>, index: usize) -> &'static str {
    let contact = match run.plan.procedures.get(index).map(|planned| &planned.kind) {
        Some(ProcedureKind::Impact(impact)) => Some(&impact.contact),
        Some(ProcedureKind::StoreyImpact(impact)) => Some(&impact.contact),
        _ => None,
    };
    match contact {
        Some(Contact::Rigid | Contact::Limit { .. }) => "contact, Σ F₁ΔXs − ½(F₀ + F₁)ΔX of each step",
        _ => "contact, ∫F d(Xs − X) within each step",
    }
}

/// Where the striker's energy was at the end of the run.
pub(super) fn energy_balance(contact_work: &'static str, history: &ImpactHistory, body: &mut Vec<Block>) {
    let (Some(first), Some(last)) = (history.steps.first(), history.steps.last()) else { return };
    let e = last.energies;
    let input = first.energies.striker + e.weight;
    let parts = [
        ("striker, kinetic", e.striker),
        ("structure, kinetic", e.structure),
        ("restoring force, ∫R dX", e.restoring),
        ("damping, ∫CẊ dX", e.damping),
        (contact_work, e.contact_loss),
        ("integration error", e.error),
    ];
    let row = |(name, energy): (&str, f64)| -> Vec<Text> {
        let share = if input > 0.0 { percent(energy / input) } else { "—".to_owned() };
        vec![name.into(), number::part_of(energy, input, 5, Dimension::ENERGY).into(), share.into()]
    };
    let given = if e.weight == 0.0 { "input, ½MsV₀²" } else { "input, ½MsV₀² and the work of the weight" };
    let input_row = vec![given.into(), number::part_of(input, input, 5, Dimension::ENERGY).into(), "100\u{a0}%".into()];
    let columns = vec![
        Column::words("Energy balance at the end of the run", 1),
        Column::numbers("Energy"),
        Column::numbers("Of the input"),
    ];
    body.push(Block::Table(Table { columns, rows: std::iter::once(input_row).chain(parts.map(row)).collect() }));
    if e.indentation > 0.0 {
        body.push(Block::note(format!(
            "Indentation energy F·Δδp, an indicator and no part of the balance: {}. It equals the work lost in the contact only as the time \
             step goes to zero.",
            number::text(e.indentation, Dimension::ENERGY)
        )));
    }
}

pub(super) fn percent(share: f64) -> String {
    number::part_of(100.0 * share, 100.0, 5, Dimension::NUMBER) + "\u{a0}%"
}
