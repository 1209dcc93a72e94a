//! The NEES "LabVIEW plugin" protocol, psd as the rig. In: a coordinator's connection. Out: motion through the guard, one
//! answer per line. A target outside a limit is refused when it is proposed, before anything moves.
//!
//! Every axis is a control point with a name, of the form `MDL-00-01` or `MDL-00-01:floor`; a rig of one axis accepts any
//! name. One proposal can name several: they are proposed, refused, moved and settled together. An axis that it does not name
//! keeps its last target. Control points of auxiliary devices such as cameras (`MDL-AUX`) move nothing. Names and directions
//! are echoed as they were written; answers have the line ending of the client.

use super::Ended;
use super::connection::Connection;
use crate::run::remote_control::Specimen;
use psd_rig::RigFault;
use psd_rig::protocols::nees_message::{self, Refusal, Request, Why};

/// Longest line accepted, bytes.
const LONGEST: usize = 4096;

/// Serves a coordinator until one of the two ends the session. `names` are the control points, one per axis; none: any name
/// is accepted for the single axis.
pub fn session(
    connection: &mut Connection<'_>,
    specimen: &mut Specimen<'_, '_>,
    names: &[String],
) -> Ended {
    converse(connection, specimen, names).unwrap_or_else(|ended| ended)
}

/// Default names of the control points: none for one axis.
#[must_use]
pub fn usual_names(axes: usize) -> Vec<String> {
    if axes == 1 {
        Vec::new()
    } else {
        (1..=axes).map(|axis| format!("MDL-00-{axis:02}")).collect()
    }
}

/// The state that coordinator and rig share.
struct SharedState<'a> {
    open: bool,
    names: &'a [String],
    /// The direction in which the client moved each control point, as written by the client.
    directions: Vec<String>,
    proposed: Option<Proposed>,
}

struct Proposed {
    transaction: String,
    moves: bool,
}

/// The client, and the bytes after this line that have been read already.
struct Client<'a> {
    connection: &'a Connection<'a>,
    ahead: &'a [u8],
}

impl Client<'_> {
    fn execute(&self, specimen: &mut Specimen<'_, '_>) -> Result<(), Ended> {
        let begun = self.ahead.to_vec();
        self.connection.execute(specimen, move |ahead| {
            takes_leave(&[&begun, ahead].concat())
        })
    }
}

/// Whether one of the lines that were sent ahead is the last.
fn takes_leave(ahead: &[u8]) -> bool {
    let mut lines = ahead
        .split_inclusive(|byte| *byte == b'\n')
        .filter(|line| line.ends_with(b"\n"));
    let is_leave = |line: &[u8]| {
        let text = String::from_utf8_lossy(line);
        matches!(
            nees_message::parse(text.trim_end_matches(['\r', '\n'])),
            Ok(Request::CloseSession)
        )
    };
    lines.any(is_leave)
}

/// An answer, and whether it is the last.
struct Answer {
    line: String,
    ended: Option<Ended>,
}

impl From<String> for Answer {
    fn from(line: String) -> Self {
        Self { line, ended: None }
    }
}

fn converse(
    connection: &mut Connection<'_>,
    specimen: &mut Specimen<'_, '_>,
    names: &[String],
) -> Result<Ended, Ended> {
    let directions = vec!["x".to_owned(); specimen.degrees_of_freedom()];
    let mut state = SharedState {
        open: false,
        names,
        directions,
        proposed: None,
    };
    let mut begun: Vec<u8> = Vec::new();
    let mut buffer = [0; 1024];
    // It owes the rest of a line, and first of all a session.
    let mut owed_since = Some(specimen.now());
    loop {
        let count = connection.read(&mut buffer, specimen, owed_since)?;
        let mut answered = false;
        begun.extend_from_slice(&buffer[..count]);
        while let Some(end) = begun.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = begun.drain(..=end).collect();
            let text = String::from_utf8_lossy(&line);
            let client = Client {
                connection,
                ahead: &begun,
            };
            let answer = state.answer(text.trim_end_matches(['\r', '\n']), &client, specimen);
            let end = if line.ends_with(b"\r\n") {
                "\r\n"
            } else {
                "\n"
            };
            connection.write(format!("{}{end}", answer.line).as_bytes(), specimen)?;
            if let Some(ended) = answer.ended {
                return Ok(ended);
            }
            answered = true;
        }
        let owes = !begun.is_empty() || !state.open;
        owed_since = owed_since
            .filter(|_| !answered || !state.open)
            .or_else(|| Some(specimen.now()))
            .filter(|_| owes);
        if begun.len() > LONGEST {
            return Err(Ended::Misspoken(format!(
                "a line of more than {LONGEST} bytes"
            )));
        }
    }
}

impl SharedState<'_> {
    fn control_point_index(&self, name: &str) -> Option<usize> {
        if self.names.is_empty() {
            Some(0)
        } else {
            nees_message::control_point_index(self.names, name)
        }
    }

    fn answer(
        &mut self,
        line: &str,
        client: &Client<'_>,
        specimen: &mut Specimen<'_, '_>,
    ) -> Answer {
        let answered =
            nees_message::parse(line).and_then(|request| self.request(&request, client, specimen));
        answered.unwrap_or_else(|refusal| refusal.line().into())
    }

    fn request<'a>(
        &mut self,
        request: &Request<'a>,
        client: &Client<'_>,
        specimen: &mut Specimen<'_, '_>,
    ) -> Result<Answer, Refusal<'a>> {
        if self.open == (*request == Request::OpenSession) {
            return Err(Refusal::new(
                Why::Order,
                "",
                if self.open {
                    "a session is open"
                } else {
                    "no session is open"
                },
            ));
        }
        match request {
            Request::OpenSession => {
                self.open = true;
                Ok("OK\t0\tsession opened".to_owned().into())
            }
            Request::SetParameter => Ok("OK\t0\tparameter set".to_owned().into()),
            Request::CloseSession => Ok(Answer {
                line: "OK\t0\tsession closed".to_owned(),
                ended: Some(Ended::Closed),
            }),
            Request::Propose {
                transaction,
                points,
            } => {
                self.proposed = None;
                let refused = |reason: &str| Refusal::new(Why::Message, transaction, reason);
                let demands = nees_message::demands(points, |name| self.control_point_index(name))
                    .map_err(refused)?;
                if !demands.is_empty() {
                    let mut targets = specimen.commanded().to_vec();
                    for (axis, stop_request) in &demands {
                        targets[*axis] = stop_request.value;
                    }
                    match specimen.propose(&targets) {
                        Ok(()) => {}
                        Err(fault @ RigFault::LimitBreached { .. }) => {
                            return Err(Refusal::new(Why::Limit, transaction, fault.to_string()));
                        }
                        Err(fault) => return Ok(failed(transaction, fault.into())),
                    }
                }
                for (axis, stop_request) in &demands {
                    stop_request.axis.clone_into(&mut self.directions[*axis]);
                }
                self.proposed = Some(Proposed {
                    transaction: (*transaction).to_owned(),
                    moves: !demands.is_empty(),
                });
                Ok(nees_message::done(transaction).into())
            }
            Request::Execute { transaction } => {
                let proposed = self
                    .proposed
                    .take_if(|proposed| proposed.transaction == *transaction);
                let Some(proposed) = proposed else {
                    return Err(Refusal::new(
                        Why::Order,
                        transaction,
                        "not the last proposed transaction",
                    ));
                };
                if proposed.moves {
                    if let Err(ended) = client.execute(specimen) {
                        return Ok(failed(transaction, ended));
                    }
                    specimen.commit();
                }
                Ok(nees_message::done(transaction).into())
            }
            Request::GetControlPoint { transaction, point } => {
                let no_such = || Refusal::new(Why::Message, transaction, "no such control point");
                let axis = self.control_point_index(point).ok_or_else(no_such)?;
                if let Err(fault) = specimen.read() {
                    return Ok(failed(transaction, fault.into()));
                }
                let feedback = specimen.feedback();
                let (displacement, force) = (feedback.displacement[axis], feedback.force[axis]);
                Ok(nees_message::control_point(
                    transaction,
                    point,
                    &self.directions[axis],
                    displacement,
                    force,
                )
                .into())
            }
            Request::Cancel { transaction } => {
                if self
                    .proposed
                    .take_if(|proposed| proposed.transaction == *transaction)
                    .is_some()
                {
                    specimen.hold();
                }
                Ok(nees_message::done(transaction).into())
            }
        }
    }
}

/// The rig failed: the coordinator is informed, and nothing more will move.
fn failed(transaction: &str, ended: Ended) -> Answer {
    let why = if matches!(ended, Ended::Limit(_)) {
        Why::Limit
    } else {
        Why::Rig
    };
    Answer {
        line: Refusal::new(why, transaction, ended.to_string()).line(),
        ended: Some(ended),
    }
}
