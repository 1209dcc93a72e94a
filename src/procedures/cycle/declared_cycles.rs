//! Checks of the cycles that the plan declares: the entries that are read from them, and their ends against the limits. In: procedures.
//! Out: E401 if an entry past the last cycle is read; an error if a cycle exceeds the limits.

use psd_language::check::checker::Checker;
use psd_language::check::declarations::limits::CheckedLimits;
use psd_language::check::violations::{BeyondLimits, NoSuchEntry};
use psd_plan::procedures::cycle::block as schema;
use psd_plan::{Procedure, ProcedureKind};
use psd_text::units::Dimension;

/// Lists of a `cycle` with one entry for each of its cycles.
const BY_CYCLE: [&str; 4] = [
    schema::AMPLITUDES.name,
    schema::ENERGIES.name,
    schema::DAMPING_RATIOS.name,
    schema::STIFFNESSES.name,
];

/// An entry past the last cycle, which can never exist; called only if there is no error.
pub fn check_entries(checker: &mut Checker, procedures: &[(usize, Option<Procedure>)]) {
    for (reference, entry, span) in std::mem::take(&mut checker.list_entries_read) {
        let Some((_, Some(procedure))) = procedures.get(reference.procedure.0) else {
            continue;
        };
        let ProcedureKind::Cycle(cycle) = &procedure.kind else {
            continue;
        };
        let cycles = cycle.levels.iter().map(|level| level.cycles as usize).sum();
        if BY_CYCLE.contains(&reference.name) && entry >= cycles {
            checker.report(NoSuchEntry {
                span,
                entry,
                length: cycles,
            });
        }
    }
}

/// Compares the ends of cycles \[m\] that are known before the run with the limits.
pub fn check_cycles(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    limits: &CheckedLimits,
) {
    let (Some(at), interval) = (limits.displacement_at, limits.limits.displacement) else {
        return;
    };
    for (block, procedure) in procedures {
        let Some(Procedure {
            kind: ProcedureKind::Cycle(cycle),
            ..
        }) = procedure
        else {
            continue;
        };
        let Some(about) = cycle.about.constant() else {
            continue;
        };
        let amplitudes = cycle
            .levels
            .iter()
            .filter_map(|level| level.amplitude.constant());
        let mut ends = amplitudes.flat_map(|amplitude| {
            cycle
                .sides
                .ends()
                .iter()
                .map(move |end| about + end * amplitude)
        });
        let Some(beyond) = ends.find(|end| !interval.contains(*end)) else {
            continue;
        };
        let given = checker
            .field(*block, schema::GIVEN_AMPLITUDES.name)
            .or_else(|| checker.field(*block, schema::PROTOCOL.name));
        let Some((_, entry)) = given else { continue };
        let (field, span) = (entry.key.node.as_str(), entry.value.span);
        checker.report(BeyondLimits {
            field,
            value: beyond,
            dimension: Dimension::LENGTH,
            span,
            limit: interval,
            limit_at: at,
        });
    }
}
