//! `impact NAME { storey = 2 … }`: a striker on one floor of a frame. In: a block whose specimen is a frame. Out: the impact,
//! and what its time step must be held against.

use std::rc::Rc;

use crate::language::check::checker::Checker;
use crate::language::check::declarations::specimen::frame;
use crate::language::check::expressions::fields::whole;
use crate::language::check::messages::frames as fault;
use crate::physics::structure::frame_properties::FrameProperties;
use crate::plan::formula::Formula;
use crate::plan::{Contact, Frame, StoreyImpact, Striker};
use crate::procedures::impact::warnings;
use crate::procedures::stepping::check::FrameSteps;
use crate::procedures::stepping::integrator_check;
use crate::procedures::{base_excitation, impact, stepping};
use crate::schema::Kind;

/// The frame that a block strikes one storey of; None where it strikes one degree of freedom, or nothing that is known.
pub fn struck_frame(checker: &mut Checker, block: usize) -> Option<(usize, Option<Rc<Frame>>)> {
    let specimen = checker
        .tested(block)
        .filter(|specimen| frame::is_frame(checker, *specimen))?;
    let frame = frame::frame(checker, specimen);
    let several = frame
        .as_ref()
        .is_none_or(|frame| frame.degrees_of_freedom() > 1);
    (several || checker.field(block, "storey").is_some()).then_some((specimen, frame))
}

pub fn storey_impact(
    checker: &mut Checker,
    block: usize,
    specimen: usize,
    frame: Option<&Rc<Frame>>,
) -> Option<StoreyImpact> {
    let striker = checker.reference(block, "striker", Kind::Striker);
    // Named or the only one: what is wrong with the name was not said before.
    let named = checker.specimen_block(block);
    let struck = storey(checker, block, specimen, frame);
    let own = [
        (
            "mass",
            "remove it: the storeys of the frame have masses of their own",
        ),
        (
            "stiffness",
            "remove it: the storeys of the frame have stiffnesses of their own",
        ),
        (
            "damping",
            "write `damping_ratio = 2 %`: damping of the frame's modes",
        ),
    ];
    let mut foreign = false;
    for (field, help) in own {
        if let Some((_, entry)) = checker.field(block, field) {
            let at = entry.key.span;
            checker.diagnostics.push(fault::no_use_on_a_frame(
                field,
                "an impact on a storey",
                at,
                help,
            ));
            foreign = true;
        }
    }
    let damping = base_excitation::check::damping(checker, block);
    let damping_uncertainty =
        base_excitation::check::damping_uncertainty(checker, block, damping.as_ref());
    let contact = impact::check::contact(checker, block);
    let stepping =
        stepping::check::stepping(checker, block, contact.as_ref(), impact::check::FINER);
    let duration = checker.quantity(block, "duration");
    let until = impact::check::until(checker, block);
    if foreign {
        return None;
    }
    let impact = StoreyImpact {
        specimen: checker.scope.index_in_kind(named?),
        striker: checker.scope.index_in_kind(striker?),
        struck: struck?,
        damping: damping?,
        damping_uncertainty: damping_uncertainty?,
        contact: contact?,
        stepping: stepping?,
        duration: duration?,
        until: until?,
    };
    integrator_check::meets_the_contact(
        checker,
        block,
        impact.stepping.integrator,
        &impact.contact,
    )?;
    Some(impact)
}

/// The struck floor, from 0.
fn storey(
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
    let Some((_, entry)) = checker.field(block, "storey") else {
        return checker.fail(fault::which_storey(name, storeys?, head, declared));
    };
    let at = entry.value.span;
    let storey = whole(checker.constant(block, "storey")?)?;
    let storey = usize::try_from(storey).ok()?;
    if storey > storeys? {
        return checker.fail(fault::no_such_storey(name, storeys?, at, declared));
    }
    storey.checked_sub(1)
}

/// What the time step must be held against, as far as it is known before the run: what that of any frame must be, and what a
/// limit force needs.
pub fn judge(
    checker: &mut Checker,
    block: usize,
    impact: &StoreyImpact,
    frame: &Frame,
    striker: &Striker,
) {
    let StoreyImpact {
        specimen,
        damping,
        stepping,
        ..
    } = impact;
    impact::check::returns(checker, block, impact.until, striker);
    let steps = FrameSteps {
        specimen: *specimen,
        frame,
        damping,
        stepping,
        duration: impact.duration.constant(),
    };
    let critical = |properties: &FrameProperties| {
        let approach = impact.contact.approach(striker, Formula::constant);
        approach.map(|approach| properties.critical_on_impact(impact.struck, &approach))
    };
    let Some((properties, step)) = stepping::check::judge(checker, block, &steps, critical) else {
        return;
    };
    if let Contact::Limit { force } = &impact.contact
        && let Some(force) = force.constant()
    {
        let head = checker.scope.blocks[block].block.head;
        let at = checker
            .field(block, "time_step")
            .map_or(head, |(_, entry)| entry.value.span);
        warnings::limit_force(
            checker,
            at,
            step,
            (properties.struck_mass(impact.struck), force),
            striker,
        );
    }
}

/// In an impact on one degree of freedom: what only a frame has.
pub fn no_frame(checker: &mut Checker, block: usize, specimen: Option<usize>) -> Option<()> {
    let mut sound = Some(());
    let hints = [
        ("damping_ratio", "write `damping = 50 N*s/m`"),
        (
            "damping_ratio_uncertainty",
            "remove it: the modes of a frame have damping ratios",
        ),
    ];
    for (field, hint) in hints {
        if let Some((_, entry)) = checker.field(block, field) {
            let at = entry.key.span;
            sound = checker.fail(fault::of_a_frame_only(field, at, hint));
        }
    }
    if let (Some((_, entry)), Some(specimen)) = (checker.field(block, "storey"), specimen) {
        let (at, tested) = (entry.key.span, &checker.scope.blocks[specimen]);
        let (name, declared) = (
            tested.name.map_or("", |name| name.node.as_str()),
            tested.block.head,
        );
        sound = checker.fail(fault::storey_of_none(name, at, declared));
    }
    sound
}
