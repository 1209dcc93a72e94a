//! The procedures in the order of the plan, and the specimen that they test.

use crate::language::check::checker::Checker;
use crate::language::check::messages::{axes as axis_faults, frames, whole as message};
use crate::language::check::rig::CheckedRig;
use crate::language::check::rig::axes;
use crate::plan::{Procedure, Specimen};
use crate::procedures;
use crate::procedures::facts::Tests;
use crate::schema::Kind;
use crate::schema::procedures::SPECIMEN;
use crate::schema::rig::AXES;
use crate::text::source::Span;

/// Every procedure; None for those with an error.
pub fn procedures(checker: &mut Checker) -> Vec<(usize, Option<Procedure>)> {
    let blocks: Vec<usize> = checker.scope.procedures().map(|(index, _)| index).collect();
    blocks
        .into_iter()
        .map(|block| (block, procedure(checker, block)))
        .collect()
}

fn procedure(checker: &mut Checker, block: usize) -> Option<Procedure> {
    let kind = procedures::check(checker, block);
    let declared = &checker.scope.blocks[block];
    Some(Procedure {
        name: declared.name?.node.clone(),
        kind: kind?,
    })
}

/// One rig holds one specimen: every procedure must test the same one as the first.
pub fn check_specimen(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) {
    let mut on_rig: Option<(usize, Span)> = None;
    for (block, procedure) in procedures {
        // Without the specimen of the first, nothing is known about the others.
        let Some(procedure) = procedure else { return };
        let Some(specimen) = procedure.kind.specimen() else {
            continue;
        };
        let span = checker.value_or_head(*block, SPECIMEN.name);
        let (first, first_span) = *on_rig.get_or_insert((specimen, span));
        if specimen != first {
            let name = |index| {
                let named = checker
                    .scope
                    .of_kind(Kind::Specimen)
                    .nth(index)
                    .and_then(|(_, block)| block.name);
                named.map_or("", |name| name.node.as_str())
            };
            let diagnostic =
                message::another_specimen(name(specimen), span, name(first), first_span);
            checker.diagnostics.push(diagnostic);
        }
    }
}

/// A procedure for one actuator cannot move the several actuators of a frame. A real rig has as many actuators as it declares.
pub fn check_axes(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    specimens: &[Option<Specimen>],
    rig: Option<&CheckedRig>,
) {
    let on_rig = procedures
        .iter()
        .find_map(|(_, procedure)| procedure.as_ref()?.kind.specimen())
        .unwrap_or(0);
    let Some(Some(specimen)) = specimens.get(on_rig) else {
        return;
    };
    axes::check_specimen(checker, rig, specimen);
    let storeys = specimen.degrees_of_freedom();
    if storeys == 1 {
        return;
    }
    // A rig that lists its axes is checked as a whole.
    let one_axis = rig.filter(|rig| {
        rig.block
            .is_some_and(|block| checker.field(block, AXES.name).is_none())
    });
    let one_axis = one_axis
        .filter(|rig| rig.plan.link.as_real().is_some())
        .map(|rig| rig.plan.name.clone());
    let declared = checker
        .scope
        .of_kind(Kind::Specimen)
        .nth(on_rig)
        .map(|(_, block)| block.block.head);
    for (block, procedure) in procedures {
        let Some(procedure) = procedure else { continue };
        let head = checker.scope.blocks[*block].block.head;
        match procedures::facts_of(&procedure.kind).tests {
            Tests::Frame => checker.diagnostics.extend(
                one_axis
                    .iter()
                    .map(|rig| axis_faults::frame_on_one_axis(&specimen.name, storeys, rig, head)),
            ),
            Tests::Nothing => {}
            Tests::OneDegreeOfFreedom => {
                let keyword = procedure.kind.keyword();
                checker.diagnostics.push(frames::one_degree_of_freedom(
                    keyword,
                    &specimen.name,
                    storeys,
                    head,
                    declared,
                ));
            }
        }
    }
}
