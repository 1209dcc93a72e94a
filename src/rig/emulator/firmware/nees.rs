//! A rig with the NEES "LabVIEW plugin" protocol: it listens; a coordinator proposes, executes and requests readings. In: lines
//! that end with LF or CR LF. Out: one answer per line, with the line end of the client. The answer to `execute` comes when the
//! motion is done.
//!
//! Choices where the published commands are not specific: nothing is answered `OK` before `open-session`, and a second
//! `open-session` is refused; a control point can have a `:name` after it; the axis is x; `cancel` during a motion holds the
//! rig, and its `execute` is then answered `NOT OK`; a reading can be requested during a motion. A control point that is absent
//! from a proposal keeps its last target.

use super::line_buffer::LineBuffer;
use crate::emulator::{EmulatedRig, Firmware};
use crate::protocols::nees_message;
use crate::protocols::nees_message::{Point, Refusal, Request, Why};

const AXIS: &str = "x";

#[derive(Debug)]
pub struct Nees {
    /// One for each of its actuators.
    control_points: Vec<String>,
    /// The indices of its own actuators on the emulated rig.
    actuators: Vec<usize>,
    /// m/s
    speed: f64,
    lines: LineBuffer,
    session: Session,
}

/// The state that is lost at power-off.
#[derive(Debug, Default)]
struct Session {
    open: bool,
    /// The client's line end is CR LF.
    carriage_return: bool,
    /// Transaction and targets (one per actuator \[m\]; None: no motion).
    proposed: Option<(String, Option<Vec<f64>>)>,
    /// The transaction in progress.
    executing: Option<String>,
}

impl Nees {
    /// A rig with a control point for each actuator. The actuator with the longest move has the speed `speed` \[m/s\]. It
    /// refuses targets outside the emulated rig's limits.
    #[must_use]
    pub fn new(control_points: Vec<String>, actuators: Vec<usize>, speed: f64) -> Self {
        Self {
            control_points,
            actuators,
            speed,
            lines: LineBuffer::default(),
            session: Session::default(),
        }
    }

    /// The answers to one line.
    fn answer(&mut self, line: &str, rig: &mut EmulatedRig) -> Vec<String> {
        let answered = nees_message::parse(line).and_then(|request| self.request(&request, rig));
        answered.unwrap_or_else(|refusal| vec![refusal.line()])
    }

    fn request<'a>(
        &mut self,
        request: &Request<'a>,
        rig: &mut EmulatedRig,
    ) -> Result<Vec<String>, Refusal<'a>> {
        let session = &mut self.session;
        if session.open == (*request == Request::OpenSession) {
            return Err(Refusal::new(
                Why::Order,
                "",
                if session.open {
                    "a session is open"
                } else {
                    "no session is open"
                },
            ));
        }
        match request {
            Request::OpenSession => {
                session.open = true;
                Ok(vec!["OK\t0\tsession opened".to_owned()])
            }
            Request::SetParameter => Ok(vec!["OK\t0\tparameter set".to_owned()]),
            Request::CloseSession => {
                rig.hold_those(&self.actuators);
                *session = Session {
                    carriage_return: session.carriage_return,
                    ..Session::default()
                };
                Ok(vec!["OK\t0\tsession closed".to_owned()])
            }
            Request::Propose {
                transaction,
                points,
            } => {
                if session.executing.is_some() {
                    return Err(Refusal::new(Why::Order, transaction, "still moving"));
                }
                session.proposed = None;
                let target = self
                    .targets(points, rig)
                    .map_err(|(why, reason)| Refusal::new(why, transaction, reason))?;
                self.session.proposed = Some(((*transaction).to_owned(), target));
                Ok(vec![nees_message::done(transaction)])
            }
            Request::Execute { transaction } => {
                let proposed = session
                    .proposed
                    .take_if(|(proposed, _)| proposed == transaction);
                let Some((_, target)) = proposed else {
                    return Err(Refusal::new(
                        Why::Order,
                        transaction,
                        "not the transaction that was proposed last",
                    ));
                };
                if let Some(targets) = target {
                    rig.go_those(None, &self.actuators, &targets, self.speed);
                }
                session.executing = Some((*transaction).to_owned());
                Ok(self.arrived(rig))
            }
            Request::GetControlPoint { transaction, point } => {
                let Some(actuator) = nees_message::control_point_index(&self.control_points, point)
                    .map(|axis| self.actuators[axis])
                else {
                    return Err(Refusal::new(
                        Why::Message,
                        transaction,
                        "no such control point",
                    ));
                };
                let (displacement, force) = (rig.displacement_of(actuator), rig.force_of(actuator));
                let line =
                    nees_message::control_point(transaction, point, AXIS, displacement, force);
                // The force is the last field.
                let (before, ordinary) = line.rsplit_once('\t').unwrap_or((&line, ""));
                Ok(vec![format!(
                    "{before}\t{}",
                    rig.shown_force(actuator, ordinary.to_owned())
                )])
            }
            Request::Cancel { transaction } => {
                session
                    .proposed
                    .take_if(|(proposed, _)| proposed == transaction);
                let stopped = session
                    .executing
                    .take_if(|executing| executing == transaction);
                let stopped = stopped.map(|_| {
                    rig.hold_those(&self.actuators);
                    Refusal::new(Why::Order, transaction, "cancelled").line()
                });
                Ok(stopped
                    .into_iter()
                    .chain([nees_message::done(transaction)])
                    .collect())
            }
        }
    }

    /// Returns the target of each actuator \[m\]; None: the proposal is for an auxiliary device.
    fn targets(
        &self,
        points: &[Point<'_>],
        rig: &mut EmulatedRig,
    ) -> Result<Option<Vec<f64>>, (Why, &'static str)> {
        let refused = |reason| (Why::Message, reason);
        let control_point_index =
            |name: &str| nees_message::control_point_index(&self.control_points, name);
        let demands = nees_message::demands(points, control_point_index).map_err(refused)?;
        if demands.iter().any(|(_, demand)| demand.axis != AXIS) {
            return Err(refused("this rig knows the direction x only"));
        }
        if demands.is_empty() {
            return Ok(None);
        }
        let mut targets: Vec<f64> = self
            .actuators
            .iter()
            .map(|actuator| rig.commanded_of(*actuator))
            .collect();
        for (actuator, demand) in &demands {
            targets[*actuator] = demand.value;
        }
        let own = || self.actuators.iter().zip(&targets);
        if own().all(|(actuator, target)| rig.limits_of(*actuator).contains(*target)) {
            return Ok(Some(targets));
        }
        for (actuator, target) in own() {
            rig.refuse_of(*actuator, *target);
        }
        Err((Why::Limit, "beyond the limits of this rig"))
    }

    /// The answer to `execute`, once the motion is done.
    fn arrived(&mut self, rig: &EmulatedRig) -> Vec<String> {
        let done = self
            .session
            .executing
            .take_if(|_| !rig.any_moving(&self.actuators));
        done.map(|transaction| nees_message::done(&transaction))
            .into_iter()
            .collect()
    }

    fn sent(&self, answers: Vec<String>) -> Vec<u8> {
        let end = if self.session.carriage_return {
            "\r\n"
        } else {
            "\n"
        };
        answers
            .into_iter()
            .flat_map(|answer| (answer + end).into_bytes())
            .collect()
    }
}

impl Firmware for Nees {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let lines = self.lines.take(bytes);
        self.session.carriage_return |= bytes.contains(&b'\r');
        let answers = lines
            .iter()
            .flat_map(|line| self.answer(line, rig))
            .collect();
        self.sent(answers)
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        let answers = self.arrived(rig);
        self.sent(answers)
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        rig.hold_those(&self.actuators);
        self.lines.clear();
        self.session = Session::default();
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::firmware::testing::spring;

    fn reply_to(rig: &mut Nees, emulated: &mut EmulatedRig, bytes: &str) -> String {
        String::from_utf8(rig.receive(bytes.as_bytes(), emulated)).unwrap()
    }

    fn opened() -> (Nees, EmulatedRig) {
        let (mut rig, mut emulated) = (
            Nees::new(vec!["MDL-00-01".to_owned()], vec![0], 0.01),
            spring(),
        );
        assert_eq!(
            reply_to(&mut rig, &mut emulated, "open-session\tpsd\n"),
            "OK\t0\tsession opened\n"
        );
        (rig, emulated)
    }

    #[test]
    fn a_session_from_open_to_close() {
        let (mut rig, mut emulated) = opened();
        assert_eq!(
            reply_to(&mut rig, &mut emulated, "set-parameter\tdummy\tnstep\t10\n"),
            "OK\t0\tparameter set\n"
        );
        assert_eq!(
            reply_to(
                &mut rig,
                &mut emulated,
                "propose\tt1\tMDL-00-01\tx\tdisplacement\t5.0000000000E-03\n"
            ),
            "OK\t0\tt1\n"
        );
        assert!(emulated.targets().is_empty(), "a proposal moves nothing");
        assert_eq!(reply_to(&mut rig, &mut emulated, "execute\tt1\n"), "");
        emulated.advance(0.4);
        assert!(rig.tick(&mut emulated).is_empty(), "still moving");
        emulated.advance(0.5);
        assert_eq!(rig.tick(&mut emulated), b"OK\t0\tt1\n");
        assert!(rig.tick(&mut emulated).is_empty(), "answered once");
        let reading =
            "OK\t0\tt1\tMDL-00-01\tx\tdisplacement\t5.0000000000E-03\tx\tforce\t5.0000000000E+02\n";
        assert_eq!(
            reply_to(
                &mut rig,
                &mut emulated,
                "get-control-point\tt1\tMDL-00-01\n"
            ),
            reading
        );
        assert_eq!(
            reply_to(&mut rig, &mut emulated, "execute\tt1\n")
                .split('\t')
                .next(),
            Some("NOT OK"),
            "not twice"
        );
        assert_eq!(
            reply_to(&mut rig, &mut emulated, "close-session\tpsd\n"),
            "OK\t0\tsession closed\n"
        );
        let refused = reply_to(
            &mut rig,
            &mut emulated,
            "propose\tt2\tMDL-00-01\tx\tdisplacement\t0\n",
        );
        assert_eq!(refused, "NOT OK\t3\t\tno session is open\n");
        assert_eq!(emulated.targets(), [0.005]);
    }

    #[test]
    fn what_it_cannot_do_it_refuses_and_does_not_move() {
        let (mut rig, mut emulated) = opened();
        for (demand, code) in [
            ("MDL-00-01\tx\tdisplacement\t0.0601", 1),
            ("MDL-00-01\tx\tdisplacement\tnan", 1),
            ("MDL-00-02\tx\tdisplacement\t0.001", 2),
            ("MDL-00-01\tx\tforce\t10", 2),
            ("MDL-00-01\ty\tdisplacement\t0.001", 2),
            (
                "MDL-00-01\tx\tdisplacement\t0.001\tx\tdisplacement\t0.001",
                2,
            ),
        ] {
            let answer = reply_to(&mut rig, &mut emulated, &format!("propose\tt1\t{demand}\n"));
            assert!(
                answer.starts_with(&format!("NOT OK\t{code}\tt1\t")),
                "{demand}: {answer}"
            );
            assert!(
                reply_to(&mut rig, &mut emulated, "execute\tt1\n").starts_with("NOT OK\t3\tt1\t")
            );
        }
        assert!(emulated.targets().is_empty());
        assert_eq!(
            emulated.violations().len(),
            2,
            "whoever asked for it is found out"
        );
    }

    #[test]
    fn ui_simcor_ends_its_lines_with_both_and_triggers_cameras() {
        let (mut rig, mut emulated) = opened();
        let trigger =
            "propose\ttrans1 0001\tMDL-AUX\tdisplacement\tz\t3500\r\nexecute\ttrans1 0001\r\n";
        assert_eq!(
            reply_to(&mut rig, &mut emulated, trigger),
            "OK\t0\ttrans1 0001\r\nOK\t0\ttrans1 0001\r\n"
        );
        let asked = reply_to(
            &mut rig,
            &mut emulated,
            "get-control-point\tdummy\tMDL-00-01:LBCB1\r\n",
        );
        assert!(
            asked.starts_with("OK\t0\tdummy\tMDL-00-01:LBCB1\tx\tdisplacement\t0.0000000000E+00\t")
                && asked.ends_with("\r\n")
        );
        assert!(emulated.targets().is_empty());
    }

    #[test]
    fn a_cancelled_motion_holds_where_it_is() {
        let (mut rig, mut emulated) = opened();
        reply_to(
            &mut rig,
            &mut emulated,
            "propose\tt1\tMDL-00-01\tx\tdisplacement\t0.005\nexecute\tt1\n",
        );
        emulated.advance(0.1);
        assert!(
            reply_to(
                &mut rig,
                &mut emulated,
                "propose\tt2\tMDL-00-01\tx\tdisplacement\t0\n"
            )
            .starts_with("NOT OK\t3\tt2")
        );
        assert_eq!(
            reply_to(&mut rig, &mut emulated, "cancel\tt1\n"),
            "NOT OK\t3\tt1\tcancelled\nOK\t0\tt1\n"
        );
        emulated.advance(5.0);
        assert!((emulated.displacement() - 0.001).abs() < 1e-12);
        reply_to(
            &mut rig,
            &mut emulated,
            "propose\tt3\tMDL-00-01\tx\tdisplacement\t0.005\nexecute\tt3\n",
        );
        rig.reboot(&mut emulated);
        emulated.advance(9.0);
        assert!((emulated.displacement() - 0.001).abs() < 1e-12);
        assert!(reply_to(&mut rig, &mut emulated, "execute\tt3\n").starts_with("NOT OK\t3"));
    }
}
