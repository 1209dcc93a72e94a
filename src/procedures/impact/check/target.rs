//! The structure that a striker hits: the fields of one degree of freedom, or of one floor of a frame. In: a block. Out: the target, or
//! errors if a field belongs to the other one.

use std::rc::Rc;

use crate::codes::E640;
use crate::procedures::common::violations::NoUseOnAFrame;
use crate::procedures::stepping::check::damping_check;
use psd_language::check::checker::{Checker, Shape};
use psd_language::check::declarations::specimen;
use psd_language::check::expressions::fields::whole;
use psd_language::check::violations::ListForNumber;
use psd_language::codes::{E208, E641};
use psd_plan::formula::{Formula, Function, Operator};
use psd_plan::procedures::impact::block as impact;
use psd_plan::schema::frames;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::{Frame, ImpactTarget, PointTarget, StoreyTarget};
use psd_text::count::counted_in_words;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

/// One degree of freedom, of the specimen at the block `tested`.
pub(crate) fn point(
    checker: &mut Checker,
    block: usize,
    tested: Option<usize>,
) -> Option<ImpactTarget> {
    let head = checker.scope.blocks[block].block.head;
    let mass = match checker.field(block, impact::MASS.name) {
        Some(_) => checker.quantity(block, impact::MASS.name),
        None => tested
            .and_then(|tested| specimen::export(checker, tested, impact::MASS.name, head))
            .map(Formula::Constant),
    };
    let mass_uncertainty = match checker.field(block, impact::MASS.name) {
        Some(_) => Some(0.0),
        None => tested.and_then(|tested| specimen::mass_uncertainty(checker, tested)),
    };
    let stiffness = checker.stiffness_or_specimens(block, tested);
    let damping = match checker.field(block, frames::DAMPING_RATIO.name) {
        Some((entry, _)) => coefficient(
            checker,
            block,
            tested,
            entry,
            mass.as_ref(),
            stiffness.as_ref(),
        ),
        None => checker.quantity(block, impact::DAMPING.name),
    };
    no_frame(checker, block, tested)?;
    Some(ImpactTarget::Point(PointTarget {
        mass: mass?,
        mass_uncertainty: mass_uncertainty?,
        stiffness: stiffness?,
        damping: damping?,
    }))
}

/// One floor of the frame that the block `tested` declares.
pub(crate) fn storey(
    checker: &mut Checker,
    block: usize,
    tested: usize,
    frame: Option<&Rc<Frame>>,
) -> Option<ImpactTarget> {
    let storey = struck_storey(checker, block, tested, frame);
    let own = [
        (
            impact::MASS.name,
            "remove it: the storeys of the frame have masses",
        ),
        (
            STIFFNESS.name,
            "remove it: the storeys of the frame have stiffnesses",
        ),
        (
            impact::DAMPING.name,
            "write `damping_ratio = 2 %`: modal damping of the frame",
        ),
    ];
    let mut foreign = false;
    for (field, help) in own {
        if let Some((_, entry)) = checker.field(block, field) {
            let at = entry.key.span;
            checker.report(NoUseOnAFrame {
                field,
                of: "an impact on a storey",
                at,
                help,
            });
            foreign = true;
        }
    }
    let damping = damping_check::damping(checker, block);
    let damping_uncertainty = damping_check::damping_uncertainty(checker, block, damping.as_ref());
    if foreign {
        return None;
    }
    Some(ImpactTarget::Storey(StoreyTarget {
        storey: storey?,
        damping: damping?,
        damping_uncertainty: damping_uncertainty?,
    }))
}

/// A frame without the floor that the striker hits.
#[derive(Violation)]
#[violation(
    E640,
    "struck storey missing: the frame `{specimen}` has {storeys} storeys"
)]
#[help("add a line `storey = {storeys}`; the lowest is 1")]
struct WhichStorey<'a> {
    specimen: &'a str,
    storeys: usize,
    #[label("storey missing")]
    at: Span,
    #[label("{storeys} storeys")]
    declared: Span,
}

struct NoSuchStorey<'a> {
    specimen: &'a str,
    storeys: usize,
    at: Span,
    declared: Span,
}

impl Violation for NoSuchStorey<'_> {
    const CODE: Code = E640;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            specimen,
            storeys,
            at,
            declared,
        } = self;
        let has = counted_in_words(storeys, "storey", "storeys");
        Diagnostic::new(
            Self::CODE,
            format!(
                "storey does not exist: frame `{specimen}` has {has}, counted from the ground up"
            ),
        )
        .at(at, "no such storey")
        .at(declared, has)
        .help(format!("write `storey = {storeys}` for the top one"))
    }
}

/// The struck floor, from 0.
fn struck_storey(
    checker: &mut Checker,
    block: usize,
    specimen: usize,
    frame: Option<&Rc<Frame>>,
) -> Option<usize> {
    let (head, tested) = (
        checker.scope.blocks[block].block.head,
        &checker.scope.blocks[specimen],
    );
    let (name, declared) = (
        tested.name.map_or("", |name| name.node.as_str()),
        tested.block.head,
    );
    let storeys = frame.map(|frame| frame.degrees_of_freedom());
    let Some((_, entry)) = checker.field(block, impact::STOREY.name) else {
        return checker.fail(WhichStorey {
            specimen: name,
            storeys: storeys?,
            at: head,
            declared,
        });
    };
    let at = entry.value.span;
    let storey = whole(checker.constant(block, impact::STOREY.name)?)?;
    let storey = usize::try_from(storey).ok()?;
    if storey > storeys? {
        return checker.fail(NoSuchStorey {
            specimen: name,
            storeys: storeys?,
            at,
            declared,
        });
    }
    storey.checked_sub(1)
}

/// Both, where one gives the other.
#[derive(Violation)]
#[violation(E208, "damping given twice: by `damping` and by `damping_ratio`")]
#[help("remove one of them")]
struct DampingTwice {
    #[label("given again")]
    again: Span,
    #[label("first given here")]
    first: Span,
}

/// The coefficient C = 2 ζ √(K M) \[N·s/m\] of one degree of freedom with the damping ratio ζ of a field, from the mass M and the stiffness K
/// of the impact.
fn coefficient(
    checker: &mut Checker,
    block: usize,
    tested: Option<usize>,
    entry: usize,
    mass: Option<&Formula>,
    stiffness: Option<&Formula>,
) -> Option<Formula> {
    let ratio = &checker.scope.blocks[block].block.fields[entry];
    let (again, span) = (ratio.key.span, ratio.value.span);
    if let Some((_, first)) = checker.field(block, impact::DAMPING.name) {
        let first = first.key.span;
        return checker.fail(DampingTwice { again, first });
    }
    let ratio = checker.entry(block, entry, span)?;
    if ratio.shape == Shape::List {
        return checker.fail(ListForNumber { span });
    }
    // The mass of the specimen keeps its uncertainty.
    let written = mass?;
    let mass = if checker.field(block, impact::MASS.name).is_some() {
        written.clone()
    } else {
        let head = checker.scope.blocks[block].block.head;
        specimen::exported(checker, tested?, impact::MASS.name, head)?
    };
    let product =
        |first, second| Formula::Binary(Operator::Multiply, Box::new(first), Box::new(second));
    let root = Formula::Call(Function::Sqrt, vec![product(stiffness?.clone(), mass)]);
    Some(product(
        product(Formula::Constant(2.0), ratio.formula),
        root,
    ))
}

#[derive(Violation)]
#[violation(
    E641,
    "`{field}` requires a frame, but this impact strikes one degree of freedom"
)]
#[help("remove it: the modes of a frame have uncertain damping ratios")]
struct OnlyOnAFrame<'a> {
    field: &'a str,
    #[label("no effect here")]
    at: Span,
}

#[derive(Violation)]
#[violation(
    E640,
    "specimen `{specimen}` has no storeys, but the impact has `storey`"
)]
#[help(
    "remove `storey`, or write `storeys = [storey(mass: 2 t, stiffness: 3 MN/m)]` in the specimen"
)]
struct StoreyOfNone<'a> {
    specimen: &'a str,
    #[label("no storeys to strike")]
    at: Span,
    #[label("no storeys")]
    declared: Span,
}

/// Refuses the fields of a frame in an impact on one degree of freedom.
fn no_frame(checker: &mut Checker, block: usize, specimen: Option<usize>) -> Option<()> {
    let mut sound = Some(());
    let field = frames::DAMPING_UNCERTAINTY.name;
    if let Some((_, entry)) = checker.field(block, field) {
        let at = entry.key.span;
        sound = checker.fail(OnlyOnAFrame { field, at });
    }
    if let (Some((_, entry)), Some(specimen)) =
        (checker.field(block, impact::STOREY.name), specimen)
    {
        let (at, tested) = (entry.key.span, &checker.scope.blocks[specimen]);
        let (name, declared) = (
            tested.name.map_or("", |name| name.node.as_str()),
            tested.block.head,
        );
        sound = checker.fail(StoreyOfNone {
            specimen: name,
            at,
            declared,
        });
    }
    sound
}
