//! The structure that a striker hits: the fields of one degree of freedom, or of one floor of a frame. In: a block. Out: the target, or
//! errors if a field belongs to the other one.

use std::rc::Rc;

use crate::codes::E640;
use crate::procedures::common::violations::NoUseOnAFrame;
use crate::procedures::shake;
use psd_language::check::checker::Checker;
use psd_language::check::declarations::specimen;
use psd_language::check::expressions::fields::whole;
use psd_language::codes::E641;
use psd_plan::formula::Formula;
use psd_plan::procedures::impact::block as impact;
use psd_plan::schema::frames;
use psd_plan::schema::procedures::STIFFNESS;
use psd_plan::{Frame, ImpactTarget, PointTarget, StoreyTarget};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::{Dimension, display};

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
    let damping = checker.quantity(block, impact::DAMPING.name);
    let coefficient = coefficient(checker, block, mass.as_ref(), stiffness.as_ref());
    no_frame(checker, block, tested, coefficient.as_deref())?;
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
    let damping = shake::check::damping(checker, block);
    let damping_uncertainty = shake::check::damping_uncertainty(checker, block, damping.as_ref());
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
        let has = if storeys == 1 {
            "one storey".to_owned()
        } else {
            format!("{storeys} storeys")
        };
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

/// What to write instead of a damping ratio ζ: the coefficient 2 ζ √(k m) of one degree of freedom, as far as mass \[kg\] and stiffness
/// \[N/m\] are known before the run. None without a ratio.
fn coefficient(
    checker: &mut Checker,
    block: usize,
    mass: Option<&Formula>,
    stiffness: Option<&Formula>,
) -> Option<String> {
    let (entry, written) = checker.field(block, frames::DAMPING_RATIO.name)?;
    let (text, span) = (checker.text(written.value.span), written.value.span);
    let ratio = checker.entry(block, entry, span)?;
    let known = |formula: Option<&Formula>| formula.and_then(Formula::constant);
    Some(match (ratio.constant(), known(mass), known(stiffness)) {
        (Some(ratio), Some(mass), Some(stiffness)) => {
            let damping = 2.0 * ratio * (stiffness * mass).sqrt();
            let damping = display::plain(damping, Dimension::DAMPING, 4);
            format!("write `damping = {damping}`, which is a damping ratio of {text}")
        }
        _ => format!(
            "write `damping = 2 * {text} * sqrt(k * m)`, with the stiffness k and the mass m"
        ),
    })
}

#[derive(Violation)]
#[violation(
    E641,
    "`{field}` requires a frame, but this impact strikes one degree of freedom"
)]
#[help("{}", help)]
struct OnlyOnAFrame<'a> {
    field: &'a str,
    #[label("no effect here")]
    at: Span,
    help: &'a str,
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

/// Refuses the fields of a frame in an impact on one degree of freedom. `coefficient`: what to write instead of a damping ratio.
fn no_frame(
    checker: &mut Checker,
    block: usize,
    specimen: Option<usize>,
    coefficient: Option<&str>,
) -> Option<()> {
    let mut sound = Some(());
    let hints = [
        (
            frames::DAMPING_RATIO.name,
            coefficient.unwrap_or("write `damping`, a coefficient"),
        ),
        (
            frames::DAMPING_UNCERTAINTY.name,
            "remove it: the modes of a frame have damping ratios",
        ),
    ];
    for (field, hint) in hints {
        if let Some((_, entry)) = checker.field(block, field) {
            let at = entry.key.span;
            sound = checker.fail(OnlyOnAFrame {
                field,
                at,
                help: hint,
            });
        }
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
