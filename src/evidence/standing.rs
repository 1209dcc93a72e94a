//! Whether a record stands by itself: what it says twice check_consistency, its id is the one of its plan and its circumstances, and it
//! says all that the program which it names writes. In: a record as it was read. Out: the first fault. It plays nothing back.

use crate::cli::files::provenance::{BUILD, recorded_id};
use crate::cli::files::record_file::{ReadRecord, plan_of};
use crate::plan::Plan;
use crate::record::journal::{EntryKind, OLDEST_FORMAT, Recovered};
use crate::run::replay::{Header, LoggedRun, check_consistency};

/// Holds a record against itself.
///
/// # Errors
/// What is wrong with it.
pub fn stands(read: &ReadRecord) -> Result<(), String> {
    check_consistency(&read.recovered, &read.played, &read.plan)
        .map_err(|fault| fault.to_string())?;
    match read
        .recovered
        .lines
        .iter()
        .position(|line| line.kind == EntryKind::Amend)
    {
        None => begins(&read.recovered, &read.played, &read.plan)?,
        Some(amended) => {
            let mut first = read.recovered.clone();
            first.lines.truncate(amended);
            let played = LoggedRun::of(&first).map_err(|fault| fault.to_string())?;
            let plan =
                plan_of(&played).map_err(|fault| format!("before it was amended: {fault}"))?;
            begins(&first, &played, &plan)?;
            if read.played.header.run_id != played.header.run_id {
                return Err("an amendment makes it another run".to_owned());
            }
        }
    }
    Ok(())
}

/// Of a record as its run began: its id, and what this program would have written too.
fn begins(recovered: &Recovered, played: &LoggedRun, plan: &Plan) -> Result<(), String> {
    let header = &played.header;
    let id = recorded_id(header, plan);
    if header.run_id != id {
        return Err(format!(
            "its run id is not {id}, which its plan and its circumstances give"
        ));
    }
    let own = header.build == BUILD;
    if own && recovered.format() == OLDEST_FORMAT {
        return Err("the program that it names writes no records of version 1".to_owned());
    }
    Ok(())
}

/// What is told of a record that stands, and makes it no worse.
pub fn remarks(recovered: &Recovered, header: &Header) -> String {
    let version = if header.equipment.is_none() {
        ", of version 1: it does not say what was measured with"
    } else {
        ""
    };
    let jumps = crate::cli::files::wall_clock::jumps(&recovered.lines).len();
    let jumped = match jumps {
        0 => String::new(),
        1 => ", its wall clock jumped once".to_owned(),
        _ => format!(", its wall clock jumped {jumps} times"),
    };
    format!("{version}{jumped}")
}
