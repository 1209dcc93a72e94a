//! `impact NAME { … }`: the fields that an impact and a series of impacts share. In: a block. Out: the impact, or errors.

pub(crate) mod arrival;
pub(crate) mod declared;
pub(crate) mod target;
pub(crate) mod time_step;
pub(crate) mod warnings;

use crate::codes::E624;
use crate::procedures::impact::contact;
use crate::procedures::stepping;
use crate::procedures::stepping::check::integrator_check;
use psd_language::check::checker::Checker;
use psd_language::check::declarations::specimen::frame;
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::Kind;
use psd_plan::schema::methods;
use psd_plan::{Impact, ProcedureKind, Until};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

/// The time step of an impact that names none: the critical one over this.
const FINER: f64 = 20.0;

pub(crate) fn impact(checker: &mut Checker, block: usize) -> Option<ProcedureKind> {
    fields(checker, block).map(ProcedureKind::Impact)
}

/// The impact that the fields of a block specify.
pub(crate) fn fields(checker: &mut Checker, block: usize) -> Option<Impact> {
    let struck_frame = frame::struck_frame(checker, block);
    let striker = checker.reference(block, schema::STRIKER.name, Kind::Striker);
    let specimen = checker.specimen_block(block);
    let target = match &struck_frame {
        Some((frame_block, frame)) => target::storey(checker, block, *frame_block, frame.as_ref()),
        None => target::point(checker, block, specimen),
    };
    let contact = contact::check(checker, block);
    let stepping = stepping::check::stepping(checker, block, contact.as_ref(), FINER);
    let duration = checker.quantity(block, methods::DURATION.name);
    let until = until(checker, block, struck_frame.is_some());
    let impact = Impact {
        specimen: checker.scope.index_in_kind(specimen?),
        striker: checker.scope.index_in_kind(striker?),
        target: target?,
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

#[derive(Violation)]
#[violation(E624, "`until = drift(…)` requires a frame of storeys")]
#[help("write `until = striker_stop`, or give the specimen `storeys`")]
struct DriftOfOneDegree {
    #[label("no storeys")]
    span: Span,
}

fn until(checker: &mut Checker, block: usize, of_frame: bool) -> Option<Until> {
    let Some((entry, written)) = checker.field(block, schema::UNTIL.name) else {
        return Some(Until::StrikerStop);
    };
    let (context, span) = (checker.context_of(block, entry), written.value.span);
    let chosen = checker.choice(block, schema::UNTIL.name)?;
    Some(match chosen.variant.name {
        "duration" => Until::Duration,
        "rebound" => Until::Rebound,
        "drift" if !of_frame => return checker.fail(DriftOfOneDegree { span }),
        "drift" => {
            Until::Drift(checker.constant_argument(&chosen, methods::REACHED.name, context)?)
        }
        _ => Until::StrikerStop,
    })
}
