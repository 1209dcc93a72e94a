//! A session of manual moves: question, moves, readings. In: the plan, the operator and a connected rig. Out: the exit, and messages to
//! the operator. It opens no folder.

use super::super::typed::positions;
use super::Wanted;
use crate::exit::{Exit, Failure};
use crate::operator::dialogue::by_lines::{self, next_line};
use crate::operator::question::{Question, QuestionKind};
use crate::output::{print_message, print_result};
use crate::settings::Settings;
use psd::run::remote_control::Specimen;
use psd::run::{Disconnect, Extent, Motion};
use psd_physics::tracking::trajectory::longest_travel;
use psd_plan::record::Outcome;
use psd_plan::{Interval, Plan};
use psd_rig::{Identity, LimitedQuantity, OWN_SPEED, RigFault, StopRequest};
use psd_text::units::Dimension;
use psd_text::units::display::{plain, readable};

/// One session of manual moves.
pub(super) struct JogSession<'a> {
    pub wanted: &'a Wanted,
    pub plan: &'a Plan,
    /// Identity that the rig reports.
    pub identity: Identity,
    /// Speed of the rig if none is commanded \[m/s\].
    pub own_speed: Option<f64>,
    pub person: Person<'a>,
    pub settings: Settings,
    pub ended: Option<Result<Exit, Failure>>,
}

impl JogSession<'_> {
    /// The moves, from the connection to the end of the session.
    pub fn drive(&mut self, specimen: &mut Specimen<'_, '_>) {
        let come = specimen
            .come(format!("{}, by hand", self.person.by))
            .map_err(Failure::Rig);
        let ended = come.and_then(|()| {
            if self.person.stop_request.release_allowed() {
                specimen.remark(format!(
                    "the hold was cleared, and the rig did not move ({})",
                    self.person.by
                ));
            }
            self.moves(specimen)
        });
        let (disconnect, reason) = match &ended {
            Ok(Exit::Met) => (Disconnect::Closed, "done".to_owned()),
            Ok(_) => (
                Disconnect::Stopped,
                "stopped by a limit or by the operator".to_owned(),
            ),
            Err(failure) if failure.exit() == Exit::Stopped => {
                (Disconnect::Stopped, failure.to_string())
            }
            Err(failure) => (Disconnect::Failed, failure.to_string()),
        };
        specimen.leave(disconnect, reason);
        specimen.close();
        self.ended = Some(ended);
    }

    /// The exit of the session; the reason of the rig if the session did not begin.
    pub fn end(self, outcome: &Outcome) -> Result<Exit, Failure> {
        self.ended.unwrap_or_else(|| {
            let (exit, reason) = match outcome {
                Outcome::Completed => (Exit::Met, ""),
                Outcome::Aborted { reason } | Outcome::NotReleased { reason } => {
                    (Exit::Stopped, reason.as_str())
                }
                Outcome::Blocked { reason } => (Exit::Missed, reason.as_str()),
                Outcome::Faulted { reason } => (Exit::Fault, reason.as_str()),
            };
            print_message(&format!("  nothing moved: {reason}\n"));
            Ok(exit)
        })
    }

    fn moves(&mut self, specimen: &mut Specimen<'_, '_>) -> Result<Exit, Failure> {
        if let Some(to) = &self.wanted.to {
            return self.move_to(to, specimen);
        }
        let mut refused = false;
        loop {
            print_message(&format!(
                "  at {}; target? [a position such as 1 mm, or q] ",
                positions_text(specimen.commanded())
            ));
            let Some(line) = self.person.line(specimen)? else {
                print_message("\n");
                return Ok(if refused || self.person.stop_request.end_requested() {
                    Exit::Stopped
                } else {
                    Exit::Met
                });
            };
            match line.trim() {
                "" => {}
                "q" | "quit" => return Ok(if refused { Exit::Stopped } else { Exit::Met }),
                typed => match positions(typed, specimen.degrees_of_freedom(), "the position") {
                    Ok(to) => refused |= self.move_to(&to, specimen)? != Exit::Met,
                    Err(failure) => print_message(&failure.report(self.settings)),
                },
            }
            if self.person.stop_request.end_requested() {
                return Ok(Exit::Stopped);
            }
        }
    }

    /// The expected motion, for the question to the operator.
    fn motion(&self, to: &[f64], specimen: &Specimen<'_, '_>) -> Motion {
        let from = specimen.commanded();
        let (low, high) = from.iter().chain(to).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), position| (low.min(*position), high.max(*position)),
        );
        let distance = longest_travel(from, to);
        let speed = self.wanted.speed.or(self.own_speed).unwrap_or(OWN_SPEED);
        let expected = Extent {
            travel: Some(Interval { low, high }),
            force: None,
            speed: Some(speed),
            duration: Some(Motion::duration(self.plan, distance, speed)),
        };
        let does = format!(
            "it MOVES from {} to {}",
            positions_text(from),
            positions_text(to)
        );
        Motion {
            expected,
            ..Motion::of(self.plan, self.identity.clone(), does)
        }
    }

    /// One move, in increments if the plan limits them; Ctrl-C puts the rig on hold during the move.
    fn move_to(&mut self, to: &[f64], specimen: &mut Specimen<'_, '_>) -> Result<Exit, Failure> {
        let speed = self.wanted.speed;
        let at_speed = speed.map_or_else(String::new, |speed| {
            format!(" at {}", plain(speed, Dimension::VELOCITY, 4))
        });
        let question = format!(
            "MOVE from {} to {}{at_speed}?",
            positions_text(specimen.commanded()),
            positions_text(to)
        );
        // A move beyond a limit is refused without a question, and no part of it is made.
        if let Some(fault) = beyond(self.plan, to, speed) {
            specimen.remark(format!("{question} refused: {fault}"));
            print_message(&format!("  refused: {fault}\n"));
            return Ok(Exit::Stopped);
        }
        let motion = self.motion(to, specimen);
        if !self.person.agrees(&question, &motion, specimen)? {
            specimen.hold();
            print_message("  nothing moved\n");
            return Ok(Exit::Stopped);
        }
        for target in specimen.increments_to(to) {
            if self.person.stop_request.end_requested() {
                specimen.hold();
                print_message("  held\n");
                return Ok(Exit::Stopped);
            }
            if let Err(fault) = specimen
                .propose_at(&target, speed)
                .and_then(|()| specimen.execute())
            {
                return refused(fault);
            }
            specimen.commit();
        }
        let stopped = self.person.stop_request.end_requested();
        let feedback = specimen.feedback();
        let rows =
            feedback
                .displacement
                .iter()
                .zip(&feedback.force)
                .map(|(displacement, force)| {
                    format!(
                        "X {}   R {}\n",
                        readable(*displacement, Dimension::LENGTH),
                        readable(*force, Dimension::FORCE)
                    )
                });
        print_result(&rows.collect::<String>())?;
        if stopped {
            specimen.hold();
            print_message("  stopped on request, at its end\n");
        }
        Ok(if stopped { Exit::Stopped } else { Exit::Met })
    }
}

/// The limit of an axis that a target or the speed exceeds.
fn beyond(plan: &Plan, to: &[f64], speed: Option<f64>) -> Option<RigFault> {
    let found = to.iter().enumerate().flat_map(|(axis, target)| {
        let limits = plan.rig.limits_of(axis, &plan.limits);
        let position = Some((
            axis,
            LimitedQuantity::TargetDisplacement,
            limits.displacement,
            *target,
        ));
        [
            position,
            speed.map(|speed| (axis, LimitedQuantity::Speed, limits.speed, speed)),
        ]
    });
    let (axis, quantity, Interval { low, high }, value) = found
        .flatten()
        .find(|(_, _, limit, value)| !limit.contains(*value))?;
    let axis = (to.len() > 1).then_some(axis + 1);
    Some(RigFault::LimitBreached {
        quantity,
        value,
        low,
        high,
        axis,
    })
}

/// After a refusal at a limit the operator may give another position; every other fault ends the session.
fn refused(fault: RigFault) -> Result<Exit, Failure> {
    match fault {
        RigFault::LimitBreached { .. } => {
            print_message(&format!("  held: {fault}\n"));
            Ok(Exit::Stopped)
        }
        fault => Err(Failure::Rig(fault)),
    }
}

/// The operator and the answers.
pub(super) struct Person<'a> {
    pub lines: by_lines::Person,
    pub stop_request: &'a StopRequest,
    /// Whether `--yes` consents to every move.
    pub yes: bool,
    /// Name of the operator.
    pub by: String,
}

impl Person<'_> {
    /// A line of the operator; None at the end of the input and on Ctrl-C. The rig is polled meanwhile.
    fn line(&mut self, specimen: &mut Specimen<'_, '_>) -> Result<Option<String>, Failure> {
        let typed = self.lines.typed();
        next_line(typed, self.stop_request, || specimen.listen()).map_err(Failure::Rig)
    }

    /// Whether the operator consents to a move. Question and answer are recorded.
    fn agrees(
        &mut self,
        question: &str,
        motion: &Motion,
        specimen: &mut Specimen<'_, '_>,
    ) -> Result<bool, Failure> {
        let (agreed, how) = if self.yes {
            (true, "answered by --yes")
        } else {
            let asked = Question::of(QuestionKind::Jog, motion);
            let yes = self
                .lines
                .agrees(&asked, self.stop_request, || specimen.listen())
                .map_err(Failure::Rig)?;
            (yes, if yes { "yes" } else { "no" })
        };
        specimen.remark(format!("{question} {how} ({})", self.by));
        Ok(agreed)
    }
}

/// Positions of all axes.
fn positions_text(positions: &[f64]) -> String {
    positions
        .iter()
        .map(|position| plain(*position, Dimension::LENGTH, 6))
        .collect::<Vec<_>>()
        .join(", ")
}
