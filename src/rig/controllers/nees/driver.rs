//! NEES "LabVIEW plugin" ASCII as the coordinator: one session over one TCP connection. In: \[m\] and \[m/s\]. Out: a proposal that the
//! rig may refuse, its execution, the reading of the control point. The rig answers an execution when its motion is done, and receives
//! nothing before: `start` waits that long. There is no separate stop channel: a hold is `cancel`, received when the rig next reads its
//! line. The protocol has no speed: the rig's own speed must be below the limit. Several axes are several control points of one session.
//! They are proposed, executed and refused together in one transaction, and read one after the other.

use crate::LineStatistics;
use crate::controllers::metres;
use crate::controllers::nees;
use crate::controllers::nees::codec::Reply;
use crate::controllers::{
    Answer, Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Flags, Force, LineClient,
    Sample,
};
use psd_physics::tracking::trajectory::longest_travel;

/// Name of the session.
const SESSION: &str = "psd";
/// Steps announced when a session opens: a coordinator must give a number, and rigs only display it.
const ANNOUNCED_STEPS: u32 = 1_000_000;

/// Longest wait for an execution that follows from a reading alone \[s\]: a single one may be wrong.
const LONGEST_BY_READING: f64 = 3600.0;

/// The site at the other end of a line.
pub struct Nees {
    client: LineClient,
    /// One an axis.
    control_points: Vec<String>,
    /// Longest time that the rig takes to settle after its motion \[s\].
    settling: f64,
    /// Start of every transaction of this session, so that none equals one of an earlier session.
    prefix: String,
    transactions: u64,
    /// The last measured positions of the axes \[m\]; empty before the first reading.
    last: Vec<f64>,
    /// The targets of the last execution \[m\]; empty before the first one.
    executed: Vec<f64>,
    /// The transaction that was sent to be executed and has not been answered.
    executing: Option<String>,
    open: bool,
}

impl Nees {
    /// A control point is `MDL-00-01` or `MDL-00-01:name`, one per axis; the longest wait for an execution is twice its
    /// travel time from the last target or the last reading, plus `settling` \[s\]. A wrong reading makes it an hour at most.
    #[must_use]
    pub const fn new(client: LineClient, control_points: Vec<String>, settling: f64) -> Self {
        let prefix = String::new();
        let last = Vec::new();
        let executed = Vec::new();
        Self {
            client,
            control_points,
            settling,
            prefix,
            transactions: 0,
            last,
            executed,
            executing: None,
            open: false,
        }
    }

    /// Displacement and force at a control point, and the reply with them.
    fn ask(&mut self, control_point: &str) -> Result<(f64, f64, Vec<u8>), DeviceFault> {
        let transaction = self.next_transaction();
        let wait = self.client.reply_timeout();
        let question = nees::codec::get_control_point(&transaction, control_point);
        let (fields, raw) = self.request(&question, Some(&transaction), wait)?;
        match measured(&fields, control_point) {
            Some((displacement, force)) => Ok((displacement, force, raw)),
            None => Err(DeviceFault::NoReading {
                raw,
                reason: "no displacement and force along x".to_owned(),
            }),
        }
    }

    fn next_transaction(&mut self) -> String {
        self.transactions += 1;
        format!("{SESSION}{}-{:06}", self.prefix, self.transactions)
    }

    /// Sends a request once and waits for the reply to it. A reply to another transaction is counted and left.
    fn request(
        &mut self,
        line: &[u8],
        transaction: Option<&str>,
        wait: f64,
    ) -> Result<(Vec<String>, Vec<u8>), DeviceFault> {
        self.client.send(line)?;
        self.answered(transaction, wait)
    }

    /// Waits for the reply to the last request.
    fn answered(
        &mut self,
        transaction: Option<&str>,
        wait: f64,
    ) -> Result<(Vec<String>, Vec<u8>), DeviceFault> {
        let deadline = self.client.now() + wait;
        let executing = self.executing.clone();
        let mut ended = false;
        let mut accept = |line: &[u8]| match (nees::codec::reply(line), transaction) {
            (Reply::Done(fields), Some(ours))
                if fields.first().map(String::as_str) != Some(ours) =>
            {
                ended |= fields.first() == executing.as_ref();
                Answer::Ignore
            }
            (Reply::Done(fields), _) => Answer::Take((fields, line.to_vec())),
            (
                Reply::Refused {
                    transaction: Some(other),
                    ..
                },
                Some(ours),
            ) if other != ours && other.starts_with(SESSION) => {
                ended |= Some(&other) == executing.as_ref();
                Answer::Ignore
            }
            (Reply::Refused { reason, .. }, _) => Answer::Fault(DeviceFault::Refused { reason }),
        };
        let answer = self
            .client
            .answer(nees::codec::ENDING, deadline, &mut accept);
        if ended {
            // The late answer to an execution: whatever its text, the motion has ended.
            self.executing = None;
        }
        answer?.ok_or(DeviceFault::Silent { seconds: wait })
    }

    /// A cancelled execution may first be answered itself, with the same transaction and a `NOT OK`.
    fn cancel(&mut self) -> Result<(), DeviceFault> {
        let Some(transaction) = self.executing.clone() else {
            return Ok(());
        };
        self.client.send(&nees::codec::cancel(&transaction))?;
        let wait = self.client.reply_timeout();
        let deadline = self.client.now() + wait;
        let mut refusal = None;
        let mut accept = |line: &[u8]| match nees::codec::reply(line) {
            Reply::Done(fields) if fields.first() == Some(&transaction) => Answer::Take(()),
            Reply::Done(_) => Answer::Ignore,
            Reply::Refused { reason, .. } => {
                refusal = Some(reason);
                Answer::Ignore
            }
        };
        if self
            .client
            .answer(nees::codec::ENDING, deadline, &mut accept)?
            .is_none()
        {
            return Err(
                refusal.map_or(DeviceFault::Silent { seconds: wait }, |reason| {
                    DeviceFault::Refused { reason }
                }),
            );
        }
        self.executing = None;
        Ok(())
    }
}

impl Device for Nees {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        if !self
            .control_points
            .iter()
            .all(|name| nees::codec::is_field(name))
        {
            return Err(DeviceFault::Unfit(
                "the name of a control point must not contain spaces or control characters"
                    .to_owned(),
            ));
        }
        self.prefix = self
            .client
            .clock()
            .wall()
            .unwrap_or_default()
            .chars()
            .filter(char::is_ascii_digit)
            .collect();
        let wait = self.client.reply_timeout();
        self.client.drain()?;
        let (_, welcome) = self.request(&nees::codec::open_session(SESSION), None, wait)?;
        self.open = true;
        let transaction = self.next_transaction();
        self.request(
            &nees::codec::steps(&transaction, ANNOUNCED_STEPS),
            None,
            wait,
        )?;
        self.sample()?;
        let strange =
            || DeviceFault::Unfit("it does not confirm that the session is open".to_owned());
        introduced(&self.control_points, &welcome).ok_or_else(strange)
    }

    fn axes(&self) -> usize {
        self.control_points.len()
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        if targets.len() != self.control_points.len() {
            let (points, targets) = (self.control_points.len(), targets.len());
            return Err(DeviceFault::Unfit(format!(
                "{targets} targets for {points} control points"
            )));
        }
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(DeviceFault::Unfit(format!("invalid speed: {speed} m/s")));
        }
        let transaction = self.next_transaction();
        let points: Vec<(&str, f64)> = self
            .control_points
            .iter()
            .map(String::as_str)
            .zip(targets.iter().copied())
            .collect();
        let (proposal, targets) = nees::codec::propose(&transaction, &points)
            .ok_or_else(|| DeviceFault::Unfit(format!("invalid targets: {}", metres(targets))))?;
        Ok(DeviceMove {
            frames: vec![proposal, nees::codec::execute(&transaction)],
            targets,
            speed,
            id: None,
        })
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        self.propose(going)?;
        self.begin(going)?;
        self.finish(going)
    }

    fn propose(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let (proposal, _, transaction) = proposed(going)?;
        let wait = self.client.reply_timeout();
        self.request(proposal, Some(&transaction), wait).map(drop)
    }

    fn cancel(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let (.., transaction) = proposed(going)?;
        let wait = self.client.reply_timeout();
        self.request(&nees::codec::cancel(&transaction), Some(&transaction), wait)
            .map(drop)
    }

    fn begin(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let (_, execution, transaction) = proposed(going)?;
        self.executing = Some(transaction);
        self.client.send(execution)
    }

    fn finish(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let (.., transaction) = proposed(going)?;
        let wait = self.client.reply_timeout();
        let twice = |from: &[f64]| 2.0 * longest_travel(from, &going.targets) / going.speed;
        let travel = twice(&self.executed).max(twice(&self.last).min(LONGEST_BY_READING));
        let motion = travel + self.settling.max(wait);
        self.executed.clone_from(&going.targets);
        self.answered(Some(&transaction), motion)?;
        self.executing = None;
        Ok(())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let (mut points, mut raw) = (Vec::new(), Vec::new());
        for control_point in self.control_points.clone() {
            let (displacement, force, reply) = self.ask(&control_point)?;
            points.push((displacement, force));
            raw.push(reply);
        }
        self.last = points
            .iter()
            .map(|(displacement, _)| *displacement)
            .collect();
        Ok(Sample {
            moving: Some(self.executing.is_some()),
            ..sample_of(&points, raw)
        })
    }

    /// Cancels the present execution; at rest there is nothing to send.
    fn hold(&mut self) -> Result<(), DeviceFault> {
        self.cancel()
    }

    fn emergency(&self) -> Vec<u8> {
        self.executing
            .as_deref()
            .map(nees::codec::cancel)
            .unwrap_or_default()
    }

    fn line_statistics(&self) -> LineStatistics {
        self.client.line_statistics()
    }
}

/// The identity of a site from its answer to the opening of a session.
pub fn introduced(control_points: &[String], welcome: &[u8]) -> Option<DeviceIdentity> {
    let Reply::Done(welcome_text) = nees::codec::reply(welcome) else {
        return None;
    };
    let model = welcome_text
        .first()
        .filter(|text| !text.is_empty())
        .map_or_else(String::new, |text| format!(": {text}"));
    let points = if control_points.len() == 1 {
        "control point"
    } else {
        "control points"
    };
    let model = format!("NEES {points} {}{model}", control_points.join(", "));
    Some(DeviceIdentity {
        model,
        raw: vec![welcome.to_vec()],
        ..DeviceIdentity::default()
    })
}

/// The reading of one reply for each control point.
pub fn decoded(control_points: &[String], replies: &[Vec<u8>]) -> Option<Sample> {
    let point = |(reply, control_point): (&Vec<u8>, &String)| match nees::codec::reply(reply) {
        Reply::Done(fields) => measured(&fields, control_point),
        Reply::Refused { .. } => None,
    };
    let points: Vec<(f64, f64)> = replies
        .iter()
        .zip(control_points)
        .map(point)
        .collect::<Option<_>>()?;
    Some(sample_of(&points, Vec::new()))
}

/// Displacement \[m\] and force \[N\] of a control point, from the fields of a reply.
fn measured(fields: &[String], control_point: &str) -> Option<(f64, f64)> {
    let at = nees::codec::measured(fields.get(1..)?, control_point)?;
    at.displacement.zip(at.force)
}

/// The reading of all control points, from displacement \[m\] and force \[N\] of each.
fn sample_of(points: &[(f64, f64)], raw: Vec<Vec<u8>>) -> Sample {
    let channels = points.iter().map(|(displacement, force)| Channel {
        displacement: Some(*displacement),
        force: Some(Force::Newtons(*force)),
        flags: Flags::default(),
    });
    Sample {
        channels: channels.collect(),
        raw,
        ..Sample::default()
    }
}

/// Proposal, execution and name of a transaction.
fn proposed(going: &DeviceMove) -> Result<(&[u8], &[u8], String), DeviceFault> {
    let ours = |frame: &[u8]| nees::codec::transaction(frame).map(str::to_owned);
    match (
        going.frames.as_slice(),
        going.frames.first().and_then(|frame| ours(frame)),
    ) {
        ([proposal, execution], Some(transaction)) => Ok((proposal, execution, transaction)),
        _ => Err(DeviceFault::Unfit("this is not a proposal".to_owned())),
    }
}

impl Drop for Nees {
    /// The line is closed after it, whether the rig receives it or not.
    fn drop(&mut self) {
        if self.open {
            self.client.send(&nees::codec::close_session(SESSION)).ok();
        }
    }
}

#[cfg(test)]
mod tests;
