//! `ground NAME { … }`: the motion of the ground, read from its file. In: the block. Out: a [`Ground`] in SI.

pub mod record;

use crate::check::checker::Checker;
use crate::codes::{E401, E620};
use psd_plan::Ground;
use psd_plan::schema::ground::{FILE, RECORD_NUMBER, SCALE, SCALE_UNCERTAINTY, UNIT};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

/// `files`: where the list is.
#[derive(Violation)]
#[violation(E401, "record {number} does not exist: the list has {count}")]
#[help("write a number from 1 to {count}")]
struct NoSuchRecord {
    number: usize,
    count: usize,
    #[label("number of the record")]
    span: Span,
    #[label("{count} in the list")]
    files: Span,
}

#[derive(Violation)]
#[violation(E620, "cannot read `{file}` as a ground motion: {reason}")]
#[help(
    "write the header `time_s,acceleration_m_per_s2` and times that increase from 0, or use a PEER file with NPTS and DT"
)]
struct BadGroundRecord<'a> {
    file: &'a str,
    reason: &'a str,
    #[label("invalid record")]
    span: Span,
}

#[derive(Violation)]
#[violation(
    E620,
    "unit given twice: the header of `{file}` states the unit of its accelerations"
)]
#[help("remove `unit`; write a factor as `scale = 1.5`")]
struct AccelerationUnitTwice<'a> {
    file: &'a str,
    #[label("given again")]
    span: Span,
}

#[derive(Violation)]
#[violation(E620, "`{file}` does not state the unit of its accelerations")]
#[help("add a line `unit = 1 m/s^2`, or `unit = 1 gn` for fractions of gravity")]
struct RecordWithoutUnit<'a> {
    file: &'a str,
    #[label("unit missing")]
    span: Span,
}

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
        return checker.fail(NoSuchRecord {
            number: chosen,
            count,
            span,
            files: at,
        });
    };
    let file = file?;
    let record = match file.ground() {
        Ok(record) => record,
        Err(reason) => {
            return checker.fail(BadGroundRecord {
                file: &file.name,
                reason,
                span: at,
            });
        }
    };
    let (scale, scale_uncertainty, unit) = (scale?, scale_uncertainty?, unit?);
    let unit = match (record.unit, unit, stated) {
        (Some(_), Some(_), Some(stated)) => {
            return checker.fail(AccelerationUnitTwice {
                file: &file.name,
                span: stated.span,
            });
        }
        (Some(unit), ..) | (None, Some(unit), _) => unit,
        (None, None, _) => {
            return checker.fail(RecordWithoutUnit {
                file: &file.name,
                span: at,
            });
        }
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
        return checker.fail(BadGroundRecord {
            file: &file.name,
            reason: &reason,
            span: at,
        });
    }
    Some(Ground {
        name: name?.node.clone(),
        file: file.name.clone(),
        unit,
        scale,
        scale_uncertainty,
        times: record.times.clone(),
        accelerations,
    })
}
