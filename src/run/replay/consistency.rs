//! The internal consistency of a run log. Each entry is exactly one that psd writes, times increase, and targets are numbered without
//! gaps. The datum is that of the plan. The replies of a real rig give its readings, and a virtual rig has none. In: the lines of a run log, those that count, the plan. Out:
//! the first entry that contradicts another. Replay finds the other differences.

use serde::{Deserialize, Serialize};

use super::entry::{
    AmendBody, DigestBody, EndBody, FaultBody, Header, HeldBody, IntentBody, OperatorEntry,
    PlanBody, RecoverBody, ResumeBody, RigBody, SampleBody, StepBody, StrokeBody, unescaped,
};
use super::logged_run::{LoggedRun, body};
use super::plain_body::Body;
use psd_plan::record::Event;
use psd_plan::{Datum, Plan};
use psd_rig::LineStatistics;
use psd_rig::controllers::metres;
use psd_rig::journal::{EntryKind, Line, Plain, Recovered, is_written_as};
use psd_rig::real::{LoggedReading, check_replies};

/// In a resumed run the time is a sum of two clocks.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An entry that contradicts another.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("entry {seq} contradicts itself: {reason}")]
pub struct Contradiction {
    pub seq: u64,
    pub reason: String,
}

/// Checks a run log for internal consistency.
///
/// # Errors
/// The first line that contradicts itself or an earlier line.
pub fn check_consistency(
    recovered: &Recovered,
    logged: &LoggedRun,
    plan: &Plan,
) -> Result<(), Contradiction> {
    let mut rig = PlansRig {
        plan,
        first_datum: None,
        in_motion: false,
        contradiction: None,
    };
    recovered
        .lines
        .iter()
        .try_for_each(|line| is_ours(line, &mut rig))?;
    let parts = recovered.lines.split(|line| line.kind == EntryKind::Resume);
    parts
        .into_iter()
        .try_for_each(|part| runs_on(part.iter()))?;
    counts_on(logged)?;
    rig.contradiction.map_or(Ok(()), Err)
}

/// The plan's rig, as far as the entries before one show it.
struct PlansRig<'a> {
    plan: &'a Plan,
    /// The datum of the first RIG entry \[m\], one per axis.
    first_datum: Option<Vec<f64>>,
    /// Each reading is a single one, made during a motion.
    in_motion: bool,
    /// The first entry that does not belong to it.
    contradiction: Option<Contradiction>,
}

impl PlansRig<'_> {
    /// Whether an entry can belong to it, by its `check`: one datum throughout, which is zero if the plan specifies this, and readings that
    /// their replies give. A virtual rig has no raw bytes.
    fn take(&mut self, line: &Line, check: impl FnOnce(&mut Self) -> Result<(), String>) {
        if self.contradiction.is_none() {
            self.contradiction = check(self).err().map(|reason| at(line, reason));
        }
    }

    const fn is_real(&self) -> bool {
        self.plan.rig.link.as_real().is_some()
    }

    fn sent(&mut self, intent: &IntentBody) -> Result<(), String> {
        self.in_motion = intent.samples.is_some();
        without_bytes(
            self.is_real() || intent.wire.is_none(),
            "nothing is sent to a virtual rig",
        )
    }

    /// A motion ends here, and its last reading was a single one.
    fn failed(&mut self, fault: &FaultBody) -> Result<(), String> {
        self.in_motion = true;
        let reading = fault.reading.as_ref();
        let read = reading.map_or(Ok(()), |reading| self.read(reading));
        self.in_motion = false;
        read
    }

    fn answered(&mut self, rig: RigBody) -> Result<(), String> {
        let Some(link) = self.plan.rig.link.as_real() else {
            return without_bytes(rig.replies.is_empty(), "a virtual rig sends no bytes");
        };
        let datum = rig.datum.ok_or("a real rig states its datum")?;
        let at_zero = datum.iter().all(|position| *position == 0.0);
        if datum.len() != rig.axes || link.datum == Datum::Machine && !at_zero {
            return Err(format!("a datum at {} is not the plan's", metres(&datum)));
        }
        if self.first_datum.get_or_insert_with(|| datum.clone()) != &datum {
            return Err(format!(
                "a datum at {} differs from the datum at the start of the run",
                metres(&datum)
            ));
        }
        Ok(())
    }

    fn read(&self, sample: &SampleBody) -> Result<(), String> {
        let Some(link) = self.plan.rig.link.as_real() else {
            return without_bytes(sample.raw.is_empty(), "a virtual rig answers without bytes");
        };
        let replies: Option<Vec<Vec<u8>>> = sample.raw.iter().map(|raw| unescaped(raw)).collect();
        let replies = replies.ok_or_else(|| "psd never writes this `raw`".to_owned())?;
        let median_of = if self.in_motion {
            1
        } else {
            link.readings.samples.max(1) as usize
        };
        let logged = LoggedReading {
            displacement: &sample.x,
            force: &sample.r,
            replies: &replies,
            median_of,
        };
        let datum = self.first_datum.as_deref().unwrap_or_default();
        check_replies(&self.plan.rig, datum, &logged)
    }
}

fn without_bytes(silent: bool, reason: &str) -> Result<(), String> {
    if silent {
        Ok(())
    } else {
        Err(reason.to_owned())
    }
}

fn at(line: &Line, reason: impl Into<String>) -> Contradiction {
    Contradiction {
        seq: line.seq,
        reason: reason.into(),
    }
}

/// Whether psd would write exactly the same object, with the same fields. The rig takes it.
fn is_ours(line: &Line, rig: &mut PlansRig<'_>) -> Result<(), Contradiction> {
    match line.kind {
        EntryKind::Header => _ = written::<Header>(line, &["format"])?,
        EntryKind::Plan => _ = written::<PlanBody>(line, &[])?,
        EntryKind::Rig => {
            let body: RigBody = written(line, &[])?;
            rig.take(line, |rig| rig.answered(body));
        }
        EntryKind::Intent => {
            let body: IntentBody = written(line, &[])?;
            rig.take(line, |rig| rig.sent(&body));
        }
        EntryKind::Sample => {
            let body: SampleBody = written(line, &[])?;
            rig.take(line, |rig| rig.read(&body));
        }
        EntryKind::Stroke => {
            rig.in_motion = false;
            written::<StrokeBody>(line, &[])?;
        }
        EntryKind::Step => _ = written::<StepBody>(line, &[])?,
        EntryKind::Digest => _ = written::<DigestBody>(line, &[])?,
        EntryKind::Operator => _ = written::<OperatorEntry>(line, &[])?,
        EntryKind::Event => _ = written::<Event>(line, &[])?,
        EntryKind::Fault => {
            let body: FaultBody = written(line, &[])?;
            rig.take(line, |rig| rig.failed(&body));
        }
        EntryKind::Held => {
            let is_real = rig.is_real();
            rig.take(line, |_| {
                without_bytes(is_real, "a virtual rig has no final hold")
            });
            written::<HeldBody>(line, &[])?;
        }
        EntryKind::LineStatistics => _ = written::<LineStatistics>(line, &[])?,
        EntryKind::Recover => _ = written::<RecoverBody>(line, &[])?,
        EntryKind::Amend => _ = written::<AmendBody>(line, &[])?,
        EntryKind::Resume => _ = written::<ResumeBody>(line, &[])?,
        EntryKind::End => _ = written::<EndBody>(line, &["count", "head"])?,
    }
    Ok(())
}

/// The body of an entry; `own` are the fields of the run log itself.
fn written<T: Body + Serialize>(line: &Line, own: &[&str]) -> Result<T, Contradiction> {
    let read: T = body(line).map_err(|fault| at(line, fault.to_string()))?;
    // This is true of nearly all, and found much faster than the fields of both.
    if is_written_as(line, &read) {
        return Ok(read);
    }
    let again = serde_json::to_value(&read).unwrap_or_default();
    let logged = line.body();
    let (Some(again), Some(logged)) = (again.as_object(), logged.as_object()) else {
        return Ok(read);
    };
    let mut names = logged.keys().filter(|name| !own.contains(&name.as_str()));
    if let Some(foreign) = names.find(|name| again.get(*name) != logged.get(*name)) {
        return Err(at(
            line,
            format!("psd never writes this `{}`", foreign.escape_debug()),
        ));
    }
    let missing = again.keys().find(|name| !logged.contains_key(*name));
    match missing {
        Some(missing) => Err(at(line, format!("it has no `{missing}`"))),
        None => Ok(read),
    }
}

/// The first field of a target, which is read once more.
#[derive(Deserialize)]
struct TargetNumber {
    n: u64,
}

impl Body for TargetNumber {
    fn of_plain(mut json: Plain<'_>) -> Option<Self> {
        json.expect("{\"n\":")?;
        json.whole().map(|n| Self { n })
    }
}

/// Rig time only increases.
fn runs_on<'a>(lines: impl Iterator<Item = &'a Line>) -> Result<(), Contradiction> {
    let mut before = f64::NEG_INFINITY;
    for line in lines {
        let Some(time) = line.time() else { continue };
        if time < before - ROUNDING * before.abs() {
            return Err(at(
                line,
                format!("its time is {time} s, but the entry before has {before} s"),
            ));
        }
        before = time;
    }
    Ok(())
}

/// For the entries that count: a target has the next number, and the time of the entry before it.
fn counts_on(logged: &LoggedRun) -> Result<(), Contradiction> {
    let mut targets = 0;
    let mut time = logged.rigs.first().map_or(0.0, |rig| rig.t);
    for line in &logged.lines {
        if line.kind == EntryKind::Intent {
            let TargetNumber { n } = body(line).map_err(|fault| at(line, fault.to_string()))?;
            targets += 1;
            if n != targets {
                return Err(at(line, format!("it is target {targets}, but states {n}")));
            }
            let own = line.time().unwrap_or(f64::NAN);
            if own.to_bits() != time.to_bits() {
                return Err(at(
                    line,
                    format!("its time is {own} s, but the entry before has {time} s"),
                ));
            }
        }
        time = line.time().unwrap_or(time);
    }
    runs_on(logged.lines.iter())
}
