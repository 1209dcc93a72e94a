//! What runs but is unwise. In: what was checked. Out: warnings, with the numbers.

use super::checker::Checker;
use super::faults::{cyclic, specimens, values, whole as fault};
use super::impact::{critical_foreseen, time_step_before_the_run};
use crate::formula::{Formula, NoResults};
use crate::mechanics::frame::Damping;
use crate::mechanics::portal_limit::mechanism_limit;
use crate::plan::{
    Behaviour, Between, BlowOn, Condition, Contact, Escalate, Ground, Impact, Procedure, ProcedureKind, Requirement, Shake,
    Specimen, StoreyImpact, Striker, Until,
};
use crate::schema::Kind;
use crate::source::{FileId, Span};
use crate::uncertainty::Source;

/// Warnings of one impact: its step against eq. 7, unless more was said of it, and against what the limit force needs.
pub fn impact(
    checker: &mut Checker,
    block: usize,
    impact: &Impact,
    striker: &Striker,
    specimen: Option<&Specimen>,
    allowed_beyond_stability: bool,
) {
    let head = checker.scope.blocks[block].block.head;
    let at = checker.given(block, "time_step").map_or(head, |(_, entry)| entry.value.span);
    let critical = critical_foreseen(checker, impact, striker, specimen);
    if let Some((critical, foreseen)) = critical
        && let Ok(step) = impact.stepping.time_step.evaluate(&NoResults, Some(critical))
        && step.value > critical
        && !allowed_beyond_stability
    {
        let fault = if foreseen { fault::step_above_foreseen } else { fault::step_above_critical };
        checker.faults.push(fault(at, step.value, critical));
    }
    let Some(step) = time_step_before_the_run(impact, striker) else { return };
    if let (Contact::Limit { force }, Some(mass)) = (&impact.contact, impact.mass.constant())
        && let Some(force) = force.constant()
    {
        limit_force(checker, at, step, (mass, force), striker);
    }
}

/// A contact force that may grow beyond what the mechanism of a portal follows.
pub fn mechanism(checker: &mut Checker, block: usize, impact: &Impact, specimen: Option<&Specimen>) {
    let bound = match &impact.contact {
        Contact::Limit { force } | Contact::Hertz { force_limit: Some(force), .. } => force.constant(),
        _ => None,
    };
    let portal = specimen.and_then(|specimen| specimen.behaviour.as_ref()).and_then(Behaviour::portal);
    if let (Some(force), Some(portal), Some((_, entry))) = (bound, portal, checker.given(block, "contact"))
        && let Some(most) = mechanism_limit(portal).filter(|most| force > *most)
    {
        checker.faults.push(specimens::beyond_mechanism(portal.mechanism(), (force, most), entry.value.span));
    }
}

/// What a limit force (N) needs of the time step, on a structure of `mass` (kg): Δt < 2M·Ms·V0/((2M + Ms)·F_lim), and
/// Δt ≤ μV0/(5F_lim) with μ = M·Ms/(M + Ms).
pub fn limit_force(checker: &mut Checker, at: Span, step: f64, (mass, force): (f64, f64), striker: &Striker) {
    let first = 2.0 * mass * striker.mass * striker.velocity / ((2.0 * mass + striker.mass) * force);
    let resolved = mass * striker.mass / (mass + striker.mass) * striker.velocity / (5.0 * force);
    if step > resolved {
        checker.faults.push(fault::limit_force_not_resolved(at, step, first, resolved));
    }
}

/// Warnings of the whole plan; asked for only where no error stands.
pub fn whole_plan(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
    grounds: &[Option<Ground>],
    plan: Span,
) {
    peak_forces(checker, procedures, requirements);
    blows_on_blows(checker, procedures, grounds);
    unused_uncertainties(checker, procedures, requirements);
    match procedures.last() {
        None => checker.faults.push(fault::nothing_runs(plan)),
        Some((block, _)) if requirements.is_empty() => {
            let head = checker.scope.blocks[*block].block.head;
            checker.faults.push(fault::nothing_required(head));
        }
        Some(_) => {}
    }
    for (index, value) in checker.scope.values.iter().enumerate() {
        if value.name.span.file == FileId(0) && !checker.used.contains(&index) {
            checker.faults.push(fault::unused(value.keyword, &value.name.node, value.name.span));
        }
    }
}

/// A run that integrates straight after another starts from where that one ended, under load, which no specimen stays at. A frame that
/// is damped comes to rest by itself, where its run goes on for long enough.
fn blows_on_blows(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)], grounds: &[Option<Ground>]) {
    const UNLOAD: &str = "take the load off in between: `unload rest { }`";
    const OR_REST: &str = "take the load off in between: `unload rest { }`, or let the first run on until the frame rests: \
                           `until = duration`, with a `damping_ratio`";
    const OR_STILL: &str = "take the load off in between: `unload rest { }`, or let the ground rest until the frame does: a longer \
                            `duration`, with a `damping_ratio`";
    const PEAK: &str = "ends near its largest displacement";
    let mut before: Option<(usize, &str, &str)> = None;
    for (block, procedure) in procedures {
        let (what, ends, help, rests) = match procedure.as_ref().map(|procedure| &procedure.kind) {
            Some(ProcedureKind::Impact(_)) => ("blow", PEAK, UNLOAD, false),
            Some(ProcedureKind::StoreyImpact(impact)) => ("blow", PEAK, OR_REST, impact.until == Until::Duration),
            Some(ProcedureKind::Shake(shake)) => {
                ("shake", "ends wherever its last step is", OR_STILL, comes_to_rest(shake, grounds))
            }
            Some(ProcedureKind::Escalate(escalate)) => (
                "row of blows",
                PEAK,
                "write `between = unload`, or `unload rest { }` in between",
                escalate.between != Between::Stay,
            ),
            // A look moves nothing.
            Some(ProcedureKind::Inspect { .. }) => continue,
            _ => {
                before = None;
                continue;
            }
        };
        if let Some((first, ended, way_out)) = before {
            let (first, this) = (&checker.scope.blocks[first], &checker.scope.blocks[*block]);
            let name = first.name.map_or("", |name| name.node.as_str());
            let fault = cyclic::blow_on_blow((what, this.block.head), (name, first.block.head, ended), way_out);
            checker.faults.push(fault);
        }
        before = Some((*block, ends, help)).filter(|_| !rests);
    }
}

/// Whether the ground rests before a damped frame's run ends.
fn comes_to_rest(shake: &Shake, grounds: &[Option<Ground>]) -> bool {
    let still = grounds.get(shake.ground).and_then(Option::as_ref).map(Ground::duration);
    let longer = shake.duration.as_ref().and_then(Formula::constant).zip(still).is_some_and(|(all, moving)| all > moving);
    longer && shake.damping.known() != Some(Damping::None)
}

/// A mass is uncertain for whom takes it: a blow on the specimen that has no mass of its own, and the damping ratio of a sweep.
fn unused_uncertainties(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)], requirements: &[Requirement]) {
    let mut read = Vec::new();
    for condition in requirements.iter().flat_map(|requirement| &requirement.conditions) {
        condition.collect_stated(&mut read);
    }
    let mut used = Vec::new();
    for (_, procedure) in procedures {
        if let Some(ProcedureKind::DampingSweep(sweep)) = procedure.as_ref().map(|procedure| &procedure.kind) {
            used.push(sweep.specimen);
        }
        if let Some(ProcedureKind::Impact(blow) | ProcedureKind::Escalate(Escalate { blow: BlowOn::Specimen(blow), .. })) =
            procedure.as_ref().map(|procedure| &procedure.kind)
        {
            blow.mass.collect_stated(&mut read);
            used.extend((blow.mass_uncertainty > 0.0).then_some(blow.specimen));
        }
    }
    used.extend(read.into_iter().filter_map(|source| match source {
        Source::SpecimenMass(specimen) => Some(specimen),
        _ => None,
    }));
    let specimens: Vec<usize> = checker.scope.of_kind(Kind::Specimen).map(|(block, _)| block).collect();
    for block in specimens.into_iter().enumerate().filter(|(place, _)| !used.contains(place)).map(|(_, block)| block) {
        let stated = checker.given(block, "mass_uncertainty").map(|(_, entry)| entry.value.span);
        let some = stated.is_some() && checker.constant(block, "mass_uncertainty").is_some_and(|stated| stated > 0.0);
        if let (true, Some(span)) = (some, stated) {
            let name = checker.scope.blocks[block].name.map_or("", |name| name.node.as_str());
            checker.faults.push(values::uncertainty_unused(name, span));
        }
    }
}

fn peak_forces(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)], requirements: &[Requirement]) {
    let law = |procedure: &Procedure| match &procedure.kind {
        ProcedureKind::Impact(Impact { contact, .. })
        | ProcedureKind::StoreyImpact(StoreyImpact { contact, .. })
        | ProcedureKind::Escalate(Escalate {
            blow: BlowOn::Specimen(Impact { contact, .. }) | BlowOn::Storey(StoreyImpact { contact, .. }),
            ..
        }) => match contact {
            Contact::Rigid => Some("rigid"),
            Contact::Restitution { .. } => Some("restitution"),
            Contact::Limit { .. } | Contact::Hertz { .. } => None,
        },
        _ => None,
    };
    let read = |checker: &mut Checker, conditions: &[Condition], span: Span| {
        let mut references = Vec::new();
        for condition in conditions {
            condition.collect_references(&mut references);
        }
        for reference in
            references.iter().filter(|reference| matches!(reference.name, "max_contact_force" | "max_contact_forces"))
        {
            if let Some((block, Some(procedure))) = procedures.get(reference.procedure.0)
                && let Some(law) = law(procedure)
            {
                let head = checker.scope.blocks[*block].block.head;
                checker.faults.push(fault::peak_force_follows_the_step(span, head, law));
            }
        }
    };
    for (index, requirement) in requirements.iter().enumerate() {
        let span = checker.scope.requirements[index].condition.span;
        read(checker, &requirement.conditions, span);
    }
    for (block, procedure) in procedures {
        if let Some(ProcedureKind::Escalate(escalate)) = procedure.as_ref().map(|procedure| &procedure.kind) {
            let head = checker.scope.blocks[*block].block.head;
            let span = checker.given(*block, "while").map_or(head, |(_, entry)| entry.value.span);
            read(checker, &escalate.condition, span);
        }
    }
}
