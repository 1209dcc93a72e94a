//! `ground NAME { … }`: the motion of the ground, read from its file. In: the block. Out: a [`Ground`] in SI.

pub mod record;

use crate::check::checker::Checker;
use crate::check::messages::frames as message;
use psd_plan::Ground;
use psd_plan::schema::ground::{FILE, RECORD_NUMBER, SCALE, SCALE_UNCERTAINTY, UNIT};

/// A ground motion with a valid record; None if an error was reported.
pub fn ground(checker: &mut Checker, block: usize) -> Option<Ground> {
    let name = checker.scope.blocks[block].name;
    let scale = checker.constant(block, SCALE.name);
    let scale_uncertainty = checker.constant(block, SCALE_UNCERTAINTY.name);
    let stated = checker.field(block, UNIT.name).map(|(_, entry)| entry);
    let unit = match stated {
        Some(_) => checker.constant(block, UNIT.name).map(Some),
        None => Some(None),
    };
    let (_, written) = checker.field(block, FILE.name)?;
    let at = written.value.span;
    let records = checker.texts(block, FILE.name)?;
    // Every file belongs to the plan: another run of a study reads it.
    let files: Vec<_> = records
        .iter()
        .map(|record| checker.data_file(record, at))
        .collect();
    let number = checker.constant(block, RECORD_NUMBER.name)?;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "its range was checked"
    )]
    let chosen = number as usize;
    let count = files.len();
    let Some(file) = files.into_iter().nth(chosen - 1) else {
        let entry = checker.field(block, RECORD_NUMBER.name);
        let span = entry.map_or(at, |(_, entry)| entry.value.span);
        return checker.fail(message::no_such_record(chosen, count, span, at));
    };
    let file = file?;
    let record = match record::read(&file.name, &file.text) {
        Ok(record) => record,
        Err(reason) => return checker.fail(message::bad_record(&file.name, &reason, at)),
    };
    let (scale, scale_uncertainty, unit) = (scale?, scale_uncertainty?, unit?);
    let unit = match (record.unit, unit, stated) {
        (Some(_), Some(_), Some(stated)) => {
            return checker.fail(message::unit_twice(&file.name, stated.span));
        }
        (Some(unit), ..) | (None, Some(unit), _) => unit,
        (None, None, _) => return checker.fail(message::record_without_unit(&file.name, at)),
    };
    let accelerations: Vec<f64> = record
        .values
        .iter()
        .map(|value| value * unit * scale)
        .collect();
    if let Some(sample) = accelerations
        .iter()
        .position(|acceleration| !acceleration.is_finite())
    {
        let reason = format!(
            "sample {} is not finite after unit and scale are applied",
            sample + 1
        );
        return checker.fail(message::bad_record(&file.name, &reason, at));
    }
    Some(Ground {
        name: name?.node.clone(),
        file: file.name,
        unit,
        scale,
        scale_uncertainty,
        times: record.times,
        accelerations,
    })
}
