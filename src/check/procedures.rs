//! The procedures in the order of the plan, and the specimen that they test.

use crate::codes::{E605, E625, E626, W737};
use crate::procedures;
use crate::procedures::facts::Tests;
use psd_language::check::checker::Checker;
use psd_language::check::rig::{CheckedRig, axes};
use psd_language::codes::E671;
use psd_plan::schema::Kind;
use psd_plan::schema::procedures::SPECIMEN;
use psd_plan::schema::rig::AXES;
use psd_plan::{Frame, Procedure, Specimen};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::suggest::with_article;

/// A procedure with its block; None if it has an error.
pub fn procedure(checker: &mut Checker, block: usize) -> (usize, Option<Procedure>) {
    let kind = procedures::check(checker, block);
    let name = checker.scope.blocks[block].name;
    let procedure = name.zip(kind).map(|(name, kind)| Procedure {
        name: name.node.clone(),
        kind,
    });
    (block, procedure)
}

#[derive(Violation)]
#[violation(
    E605,
    "specimen `{on_rig}` is on the rig, but this procedure tests `{name}`"
)]
#[help("write `specimen = {on_rig}`, or move `{name}` to a separate plan")]
struct AnotherSpecimen<'a> {
    name: &'a str,
    #[label("tests `{name}`")]
    span: Span,
    on_rig: &'a str,
    #[label("`{on_rig}` is on the rig from here")]
    first: Span,
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
            let diagnostic = AnotherSpecimen {
                name: name(specimen),
                span,
                on_rig: name(first),
                first: first_span,
            }
            .diagnostic();
            checker.diagnostics.push(diagnostic);
        }
    }
}

#[derive(Violation)]
#[violation(
    E626,
    "frame `{specimen}` requires {storeys} actuators and load cells, but rig `{rig}` has one"
)]
#[help(
    "list them in the rig, {order}: axes = [{}]; or leave `--rig` out for a virtual rig",
    vec!["axis"; storeys].join(", ")
)]
struct FrameOnOneAxis<'a> {
    specimen: &'a str,
    storeys: usize,
    rig: &'a str,
    order: &'a str,
    moved: &'a str,
    #[label("moves {moved}")]
    span: Span,
}

struct OneDegreeOfFreedom<'a> {
    keyword: &'a str,
    specimen: &'a str,
    /// Or degrees of freedom, with elements.
    storeys: usize,
    has_elements: bool,
    span: Span,
    declared: Option<Span>,
}

impl Violation for OneDegreeOfFreedom<'_> {
    const CODE: Code = E625;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            keyword,
            specimen,
            storeys,
            has_elements,
            span,
            declared,
        } = self;
        let [moves, counted, procedures] = if has_elements {
            [
                "moves one degree of freedom",
                "degrees of freedom",
                "`shake`, `impact` or `unload` for a frame with elements",
            ]
        } else {
            [
                "drives one actuator",
                "storeys",
                "`shake`, `impact`, `escalate` or `unload` for a frame",
            ]
        };
        let diagnostic = Diagnostic::new(
            Self::CODE,
            format!("`{keyword}` {moves}, but the frame `{specimen}` has {storeys}"),
        )
        .at(span, "one degree of freedom");
        let diagnostic = match declared {
            Some(declared) => diagnostic.at(declared, format!("{storeys} {counted}")),
            None => diagnostic,
        };
        diagnostic.help(format!(
            "use {procedures}, or test a single-degree-of-freedom specimen in a separate plan"
        ))
    }
}

#[derive(Violation)]
#[violation(
    E626,
    "rig `{rig}` moves nothing: every {word} of frame `{specimen}` is computed"
)]
#[help("write `part: tested` in {one}, or leave `--rig` out for a simulation")]
struct NothingOnTheRig<'a> {
    rig: &'a str,
    word: &'a str,
    one: &'a str,
    specimen: &'a str,
    #[label("no tested {word}")]
    declared: Span,
}

#[derive(Violation)]
#[violation(
    W737,
    "nothing is tested: every {word} of frame `{specimen}` is computed"
)]
#[help("write `part: tested` in the {word} on the rig; without one, the run is a simulation")]
struct Simulation<'a> {
    word: &'a str,
    specimen: &'a str,
    #[label("a simulation")]
    declared: Span,
}

#[derive(Violation)]
#[violation(
    E671,
    "`{keyword}` unloads storeys, but frame `{specimen}` has elements"
)]
#[help("use `shake` or `impact`, and `unload` after it")]
struct UnloadsElements<'a> {
    keyword: &'a str,
    specimen: &'a str,
    #[label("no storeys to unload")]
    span: Span,
}

/// A frame whose storeys are all computed.
fn nothing_tested(
    checker: &mut Checker,
    specimen: &Specimen,
    rig: Option<&CheckedRig>,
    on_rig: usize,
) {
    let Some(declared) = checker.scope.of_kind(Kind::Specimen).nth(on_rig) else {
        return;
    };
    let declared = declared.1.block.head;
    let frame = specimen.frame.as_ref();
    let word = frame.map_or("storey", Frame::word_for_a_member);
    let real = rig.filter(|rig| rig.plan.link.as_real().is_some());
    match real {
        Some(rig) => checker.report(NothingOnTheRig {
            rig: &rig.plan.name,
            word,
            one: &with_article(word),
            specimen: &specimen.name,
            declared,
        }),
        None => checker.report(Simulation {
            word,
            specimen: &specimen.name,
            declared,
        }),
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
    let frame = specimen.frame.as_ref();
    let has_elements = frame.is_some_and(Frame::has_elements);
    if has_elements {
        for (block, procedure) in procedures {
            let kind = procedure.as_ref().map(|procedure| &procedure.kind);
            if let Some(kind) = kind.filter(|kind| procedures::facts_of(kind).unloads_storeys) {
                checker.report(UnloadsElements {
                    keyword: kind.keyword(),
                    specimen: &specimen.name,
                    span: checker.scope.blocks[*block].block.head,
                });
            }
        }
    }
    let storeys = specimen.degrees_of_freedom();
    let floors = specimen.frame.as_ref().map_or(1, Frame::degrees_of_freedom);
    if floors == 1 && storeys == 1 {
        return;
    }
    if storeys == 0 {
        nothing_tested(checker, specimen, rig, on_rig);
    }
    // A rig that lists its axes is checked as a whole.
    let one_axis = rig.filter(|rig| {
        rig.block
            .is_some_and(|block| checker.field(block, AXES.name).is_none())
    });
    let one_axis = one_axis
        .filter(|rig| storeys > 1 && rig.plan.link.as_real().is_some())
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
            Tests::Frame => checker.diagnostics.extend(one_axis.iter().map(|rig| {
                FrameOnOneAxis {
                    specimen: &specimen.name,
                    storeys,
                    rig,
                    order: if has_elements {
                        "in the order of the elements"
                    } else {
                        "the lowest storey first"
                    },
                    moved: if has_elements {
                        "all tested elements"
                    } else {
                        "all storeys"
                    },
                    span: head,
                }
                .diagnostic()
            })),
            Tests::Nothing => {}
            Tests::OneDegreeOfFreedom => {
                let keyword = procedure.kind.keyword();
                checker.report(OneDegreeOfFreedom {
                    keyword,
                    specimen: &specimen.name,
                    storeys: floors,
                    has_elements,
                    span: head,
                    declared,
                });
            }
        }
    }
}
