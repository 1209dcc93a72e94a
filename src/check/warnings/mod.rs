//! Warnings: plans that can run but give poor results. In: the checked plan. Out: diagnostics with
//! the numbers. They change nothing in the plan.

pub mod dry_run;
pub(crate) mod left;
pub(crate) mod recorded_steps;
pub mod tracking;

use crate::codes::{W702, W704, W705, W706, W714, W720};
use crate::procedures::facts::{Leaves, Left, Motion};
use psd_language::check::checker::Checker;
use psd_plan::procedures::escalate::block::WHILE;
use psd_plan::schema::specimen::MASS_UNCERTAINTY;
use psd_plan::schema::{Kind, reproduces};
use psd_plan::uncertainty::Source;
use psd_plan::{Condition, Contact, Procedure, Reproduction, Requirement};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{FileId, Span, Spanned};

/// What a plan states about the numbers of its run.
#[derive(Clone, Copy)]
pub struct Stated<'a> {
    pub requirements: &'a [Requirement],
    pub reproductions: &'a [Reproduction],
}

#[derive(Violation)]
#[violation(W705, "the plan has no procedure")]
#[help(
    "add a procedure, such as\nstiffness ramp k0 {{ displacements = 0.1 mm .. 1 mm step 0.1 mm }}"
)]
struct NothingRuns {
    #[label("no procedure follows")]
    span: Span,
}

#[derive(Violation)]
#[violation(W704, "the plan has no requirement: its verdict is only `completed`")]
#[help("add a line such as `require \"stays in travel\" hit.max_displacement <= 8.5 mm`")]
struct NothingRequired {
    #[label("last procedure")]
    span: Span,
}

#[derive(Violation)]
#[violation(W706, "`{keyword}` `{name}` is never used")]
#[help("remove it, or use it")]
struct UnusedDeclaration<'a> {
    keyword: &'a str,
    name: &'a str,
    #[label("not used")]
    span: Span,
}

/// Warnings of the whole plan; called only if there is no error.
pub fn whole_plan(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    stated: Stated<'_>,
    left: Left<'_>,
    plan: Span,
) {
    peak_forces(checker, procedures, stated);
    impacts_on_moving_specimens(checker, procedures, left);
    unused_uncertainties(checker, procedures, stated.requirements);
    match procedures.last() {
        None => checker.report(NothingRuns { span: plan }),
        Some((block, _)) if stated.requirements.is_empty() && stated.reproductions.is_empty() => {
            let head = checker.scope.blocks[*block].block.head;
            checker.report(NothingRequired { span: head });
        }
        Some(_) => {}
    }
    unused_blocks(checker);
    for (index, value) in checker.scope.values.iter().enumerate() {
        if value.name.span.file == FileId(0) && !checker.used.contains(&index) {
            checker.report(UnusedDeclaration {
                keyword: value.keyword,
                name: &value.name.node,
                span: value.name.span,
            });
        }
    }
}

/// A striker, a ground motion, or one of several specimens that no procedure names. A rig is chosen by the command line.
fn unused_blocks(checker: &mut Checker) {
    let of_kind = |kind| checker.scope.of_kind(kind);
    let specimens = of_kind(Kind::Specimen).filter(|_| of_kind(Kind::Specimen).len() > 1);
    let declared = of_kind(Kind::Striker).chain(of_kind(Kind::Ground));
    let unused: Vec<_> = declared
        .chain(specimens)
        .filter(|(index, block)| {
            block.block.head.file == FileId(0) && !checker.used_blocks.contains(index)
        })
        .filter_map(|(_, block)| Some((block.kind.words(), block.name?)))
        .collect();
    for (keyword, name) in unused {
        checker.report(UnusedDeclaration {
            keyword: &keyword,
            name: &name.node,
            span: name.span,
        });
    }
}

/// `what` begins at the final state of `before`.
struct ImpactOnMovingSpecimen<'a> {
    what: Spanned<&'a str>,
    before: Spanned<&'a str>,
    ends: &'a str,
    help: &'a str,
}

impl Violation for ImpactOnMovingSpecimen<'_> {
    const CODE: Code = W720;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            what,
            before,
            ends,
            help,
        } = self;
        Diagnostic::new(
            Self::CODE,
            format!(
                "loaded start: this {} begins where `{}` ended, under load and at rest",
                what.node, before.node
            ),
        )
        .at(what.span, "begins under load")
        .at(before.span, ends.to_owned())
        .help(help)
    }
}

/// A run that integrates directly after another starts from the final state of that one, under load. A specimen does not stay in that
/// state without an actuator. A damped frame comes to rest without an actuator, if its run continues for long enough.
fn impacts_on_moving_specimens(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    left: Left<'_>,
) {
    let mut before: Option<(usize, &str, &str)> = None;
    for (block, procedure) in procedures {
        let left = procedure.as_ref().map_or(Leaves::AtRest, |procedure| {
            crate::procedures::leaves(&procedure.kind, left)
        });
        let Motion {
            what,
            ends,
            help,
            rests,
        } = match left {
            Leaves::Moving(motion) => motion,
            Leaves::AsFound => continue,
            Leaves::Unbalanced { ends, help } => {
                before = Some((*block, ends, help));
                continue;
            }
            Leaves::AtRest => {
                before = None;
                continue;
            }
        };
        if let Some((first, ended, remedy)) = before {
            let (first, this) = (&checker.scope.blocks[first], &checker.scope.blocks[*block]);
            let name = first.name.map_or("", |name| name.node.as_str());
            let diagnostic = ImpactOnMovingSpecimen {
                what: Spanned::new(what, this.block.head),
                before: Spanned::new(name, first.block.head),
                ends: ended,
                help: remedy,
            }
            .diagnostic();
            checker.diagnostics.push(diagnostic);
        }
        before = Some((*block, ends, help)).filter(|_| !rests);
    }
}

/// A mass whose uncertainty is not used.
#[derive(Violation)]
#[violation(
    W714,
    "the uncertainty of the mass of `{specimen}` has no effect on any result"
)]
#[help(
    "remove `mass` from the impact, so that the specimen's mass is used; or remove `mass_uncertainty`"
)]
struct UncertaintyUnused<'a> {
    specimen: &'a str,
    #[label("mass not used by any impact")]
    span: Span,
}

/// The uncertainty of a mass is used by an impact that uses the mass of the specimen, and by the damping ratio of a sweep.
fn unused_uncertainties(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    requirements: &[Requirement],
) {
    let mut read = Vec::new();
    for condition in requirements
        .iter()
        .flat_map(|requirement| &requirement.conditions)
    {
        condition.collect_stated(&mut read);
    }
    let mut used = Vec::new();
    for (_, procedure) in procedures {
        if let Some(procedure) = procedure {
            used.extend(crate::procedures::uses_mass(&procedure.kind, &mut read));
        }
    }
    used.extend(read.into_iter().filter_map(|source| match source {
        Source::SpecimenMass(specimen) => Some(specimen),
        _ => None,
    }));
    let specimens: Vec<usize> = checker
        .scope
        .of_kind(Kind::Specimen)
        .map(|(block, _)| block)
        .collect();
    for block in specimens
        .into_iter()
        .enumerate()
        .filter(|(index, _)| !used.contains(index))
        .map(|(_, block)| block)
    {
        let stated = checker
            .field(block, MASS_UNCERTAINTY.name)
            .map(|(_, entry)| entry.value.span);
        let some = stated.is_some()
            && checker
                .constant(block, MASS_UNCERTAINTY.name)
                .is_some_and(|stated| stated > 0.0);
        if let (true, Some(span)) = (some, stated) {
            let name = checker.scope.blocks[block]
                .name
                .map_or("", |name| name.node.as_str());
            checker.report(UncertaintyUnused {
                specimen: name,
                span,
            });
        }
    }
}

/// `law`: a law without a duration, whose force is an impulse over one step.
struct PeakForceFollowsTheStep<'a> {
    span: Span,
    impact: Span,
    law: &'a Contact,
}

impl Violation for PeakForceFollowsTheStep<'_> {
    const CODE: Code = W702;

    fn diagnostic(self) -> Diagnostic {
        let Self { span, impact, law } = self;
        let word = law.name();
        let (of, holds) = if law.numbers().is_empty() {
            (format!("the {word} law"), format!("`contact = {word}`"))
        } else {
            (format!("`{word}`"), format!("`contact = {word}(…)`"))
        };
        let message = format!("peak contact force depends on the time step under {of}, as 1/Δt");
        Diagnostic::new(Self::CODE, message)
            .at(span, "depends on the time step")
            .at(impact, format!("{holds} applies here"))
            .help("require the `impulse`, or use a law that converges: `contact = hertz(…)`")
    }
}

fn peak_forces(
    checker: &mut Checker,
    procedures: &[(usize, Option<Procedure>)],
    stated: Stated<'_>,
) {
    let read = |checker: &mut Checker, conditions: &[Condition], span: Span| {
        let mut references = Vec::new();
        for condition in conditions {
            condition.collect_references(&mut references);
        }
        for reference in references {
            if let Some((block, Some(procedure))) = procedures.get(reference.procedure.0)
                && let Some(result) = checker.result_of_impact(*block, reference.name)
                && result.grows_as_inverse_step
                && let Some(law) = crate::procedures::facts_of(&procedure.kind).contact
                && law.is_impulsive()
            {
                let head = checker.scope.blocks[*block].block.head;
                checker.report(PeakForceFollowsTheStep {
                    span,
                    impact: head,
                    law,
                });
            }
        }
    };
    for (index, requirement) in stated.requirements.iter().enumerate() {
        let span = checker.scope.requirements[index].condition.span;
        read(checker, &requirement.conditions, span);
    }
    let blocks = checker.scope.of_kind(Kind::Reproduces);
    let blocks: Vec<usize> = blocks.map(|(block, _)| block).collect();
    for (block, reproduction) in blocks.into_iter().zip(stated.reproductions) {
        let span = checker.value_or_head(block, reproduces::VALUE.name);
        read(checker, std::slice::from_ref(&reproduction.condition), span);
    }
    for (block, procedure) in procedures {
        let kind = procedure.as_ref().map(|procedure| &procedure.kind);
        if let Some(conditions) = kind.and_then(|kind| crate::procedures::facts_of(kind).conditions)
        {
            let span = checker.value_or_head(*block, WHILE.name);
            read(checker, conditions, span);
        }
    }
}
