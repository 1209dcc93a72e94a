//! The NEES "LabVIEW plugin" protocol, psd as the rig. In: a coordinator's connection. Out: motion through the guard, one
//! answer a line. What a limit stands in the way of is refused when it is proposed, before anything moves.
//!
//! A rig of several axes is none for this protocol here. Any control point is taken for the one degree of freedom and echoed as it was written; control points of cameras and
//! the like (`MDL-AUX`) move nothing. Answers end as the client ends its lines.

use super::Ended;
use super::connection::Connection;
use super::nees_message::{self, Point, Refusal, Request, Why};
use crate::rig::RigFault;
use crate::run::driven::Specimen;

/// Longest line taken, bytes.
const LONGEST: usize = 4096;

/// Serves a coordinator until one of the two has enough.
pub fn session(connection: &mut Connection<'_>, specimen: &mut Specimen<'_, '_>) -> Ended {
    let axes = specimen.degrees_of_freedom();
    if axes != 1 {
        return Ended::Misspoken(format!("psd drives one control point for NEES, and this rig has {axes} axes"));
    }
    talk(connection, specimen).unwrap_or_else(|ended| ended)
}

/// What the coordinator and the rig have agreed on.
#[derive(Default)]
struct State {
    open: bool,
    axis: String,
    proposed: Option<Proposed>,
}

struct Proposed {
    transaction: String,
    moves: bool,
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

fn talk(connection: &mut Connection<'_>, specimen: &mut Specimen<'_, '_>) -> Result<Ended, Ended> {
    let mut state = State { axis: "x".to_owned(), ..State::default() };
    let mut begun: Vec<u8> = Vec::new();
    let mut buffer = [0; 1024];
    loop {
        let count = connection.read(&mut buffer, specimen)?;
        begun.extend_from_slice(&buffer[..count]);
        while let Some(end) = begun.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = begun.drain(..=end).collect();
            let text = String::from_utf8_lossy(&line);
            let answer = state.answer(text.trim_end_matches(['\r', '\n']), specimen);
            let end = if line.ends_with(b"\r\n") { "\r\n" } else { "\n" };
            connection.write(format!("{}{end}", answer.line).as_bytes(), specimen)?;
            if let Some(ended) = answer.ended {
                return Ok(ended);
            }
        }
        if begun.len() > LONGEST {
            return Err(Ended::Misspoken(format!("a line of more than {LONGEST} bytes")));
        }
    }
}

impl State {
    fn answer(&mut self, line: &str, specimen: &mut Specimen<'_, '_>) -> Answer {
        let answered = nees_message::parse(line).and_then(|request| self.request(&request, specimen));
        answered.unwrap_or_else(|refusal| refusal.line().into())
    }

    fn request<'a>(&mut self, request: &Request<'a>, specimen: &mut Specimen<'_, '_>) -> Result<Answer, Refusal<'a>> {
        if self.open == (*request == Request::OpenSession) {
            return Err(Refusal::new(Why::Order, "", if self.open { "a session is open" } else { "no session is open" }));
        }
        match request {
            Request::OpenSession => {
                self.open = true;
                Ok("OK\t0\tsession opened".to_owned().into())
            }
            Request::SetParameter => Ok("OK\t0\tparameter set".to_owned().into()),
            Request::CloseSession => Ok(Answer { line: "OK\t0\tsession closed".to_owned(), ended: Some(Ended::Closed) }),
            Request::Propose { transaction, points } => {
                self.proposed = None;
                let refused = |reason: &str| Refusal::new(Why::Message, transaction, reason);
                let moving: Vec<&Point<'_>> = points.iter().filter(|point| !point.is_auxiliary()).collect();
                match *moving.as_slice() {
                    [] => {}
                    [point] => {
                        let [wish] = point.wishes.as_slice() else {
                            return Err(refused("psd drives one degree of freedom"));
                        };
                        if wish.kind != "displacement" {
                            return Err(refused("psd moves by displacement only"));
                        }
                        match specimen.propose(&[wish.value]) {
                            Ok(()) => wish.axis.clone_into(&mut self.axis),
                            Err(fault @ RigFault::LimitBreached { .. }) => {
                                return Err(Refusal::new(Why::Limit, transaction, fault.to_string()));
                            }
                            Err(fault) => return Ok(failed(transaction, fault)),
                        }
                    }
                    _ => return Err(refused("psd drives one control point")),
                }
                self.proposed = Some(Proposed { transaction: (*transaction).to_owned(), moves: !moving.is_empty() });
                Ok(nees_message::done(transaction).into())
            }
            Request::Execute { transaction } => {
                let proposed = self.proposed.take_if(|proposed| proposed.transaction == *transaction);
                let Some(proposed) = proposed else {
                    return Err(Refusal::new(Why::Order, transaction, "not the transaction that was proposed last"));
                };
                if proposed.moves {
                    if let Err(fault) = specimen.execute() {
                        return Ok(failed(transaction, fault));
                    }
                    specimen.commit();
                }
                Ok(nees_message::done(transaction).into())
            }
            Request::GetControlPoint { transaction, point } => {
                if let Err(fault) = specimen.read() {
                    return Ok(failed(transaction, fault));
                }
                let felt = specimen.felt();
                Ok(nees_message::control_point(transaction, point, &self.axis, felt.displacement[0], felt.force[0]).into())
            }
            Request::Cancel { transaction } => {
                if self.proposed.take_if(|proposed| proposed.transaction == *transaction).is_some() {
                    specimen.hold();
                }
                Ok(nees_message::done(transaction).into())
            }
        }
    }
}

/// The rig failed: the coordinator is told, and nothing more will move.
fn failed(transaction: &str, fault: RigFault) -> Answer {
    let why = if matches!(fault, RigFault::LimitBreached { .. }) { Why::Limit } else { Why::Rig };
    let line = Refusal::new(why, transaction, fault.to_string()).line();
    Answer { line, ended: Some(Ended::from(fault)) }
}
