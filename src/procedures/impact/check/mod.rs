//! `impact NAME { … }`: the fields that an impact and a series of impacts share. In: a block. Out: the impact, or errors.

pub(crate) mod arrival;
pub(crate) mod declared;
pub(crate) mod target;
pub(crate) mod time_step;
pub(crate) mod warnings;

use crate::procedures::impact::contact;
use crate::procedures::stepping;
use crate::procedures::stepping::check::integrator_check;
use psd_language::check::checker::Checker;
use psd_language::check::declarations::specimen::frame;
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::Kind;
use psd_plan::schema::methods;
use psd_plan::{Impact, ProcedureKind, Until};

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
    let until = until(checker, block);
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

fn until(checker: &mut Checker, block: usize) -> Option<Until> {
    Some(
        match checker.word(block, schema::UNTIL.name, "striker_stop")? {
            "duration" => Until::Duration,
            "rebound" => Until::Rebound,
            _ => Until::StrikerStop,
        },
    )
}
