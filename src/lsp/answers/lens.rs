//! The lens above a plan: it runs the plan on a simulated rig, never on a real one. In: a document. Out: the command, and what the newest
//! simulation found.

use gen_lsp_types as lsp;
use psd_language::syntax::ast::ItemKind;
use psd_plan::schema;
use serde_json::json;

use super::View;
use crate::Simulation;
use crate::server::SIMULATE;

pub fn lenses(view: &View<'_>, _: &lsp::CodeLensParams) -> Vec<lsp::CodeLens> {
    // Only the file of the plan itself has procedures.
    let items = view
        .analysis
        .tree(view.file)
        .map_or(&[][..], |tree| &tree.items);
    let kind = |item: &psd_language::syntax::ast::Item| match &item.kind {
        ItemKind::Block(block) => {
            let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
            schema::block_of_words(&words)
        }
        _ => None,
    };
    let first = items
        .iter()
        .find(|item| kind(item).is_some_and(schema::BlockKind::is_procedure));
    let Some(first) = first.filter(|_| view.file.0 == 0) else {
        return Vec::new();
    };
    let head = items
        .iter()
        .find(|item| kind(item).is_some_and(|kind| kind.kind == schema::Kind::Plan));
    let start = head.unwrap_or(first).span.range().start;
    let title = view.simulation.map_or_else(
        || "simulate".to_owned(),
        |simulation| format!("simulate ({})", in_one_line(simulation)),
    );
    vec![lsp::CodeLens {
        range: view.range(start..start),
        command: Some(lsp::Command {
            title,
            tooltip: Some("run the plan on a simulated rig; nothing moves".to_owned()),
            command: SIMULATE.to_owned(),
            arguments: Some(vec![json!(view.documents.now.uri(view.key()))]),
        }),
        data: None,
    }]
}

/// The outcome of a simulation in one line.
pub fn in_one_line(simulation: &Simulation) -> String {
    if let Some(stopped) = &simulation.stopped {
        return format!("SIMULATION: {stopped}");
    }
    let total = simulation.requirements.len();
    let of = |verdict: &str| {
        let all = simulation.requirements.iter();
        all.filter(|one| one.verdict == verdict).count()
    };
    let words = match (of("fail"), of("inconclusive")) {
        _ if total == 0 => "completed".to_owned(),
        (0, 0) if total == 1 => "requirement met".to_owned(),
        (0, 0) => format!("all {total} requirements met"),
        (0, 1) if total == 1 => "inconclusive".to_owned(),
        (0, inconclusive) => format!("{inconclusive} of {total} requirements inconclusive"),
        (1, _) if total == 1 => "requirement not met".to_owned(),
        (failed, _) => format!("{failed} of {total} requirements not met"),
    };
    format!("SIMULATION: {words}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimulatedRequirement;

    #[test]
    fn the_worst_verdict_is_the_headline_as_in_a_report() {
        for (verdicts, wanted) in [
            (&[][..], "completed"),
            (&["pass"], "requirement met"),
            (&["fail"], "requirement not met"),
            (&["inconclusive"], "inconclusive"),
            (&["pass", "pass"], "all 2 requirements met"),
            (
                &["pass", "inconclusive"],
                "1 of 2 requirements inconclusive",
            ),
            (
                &["pass", "fail", "inconclusive"],
                "1 of 3 requirements not met",
            ),
        ] {
            let one = |verdict: &&'static str| SimulatedRequirement {
                label: String::new(),
                verdict,
                values: Vec::new(),
            };
            let simulation = Simulation {
                stopped: None,
                procedures: Vec::new(),
                requirements: verdicts.iter().map(one).collect(),
            };
            assert_eq!(
                in_one_line(&simulation),
                format!("SIMULATION: {wanted}"),
                "{verdicts:?}"
            );
        }
    }
}
