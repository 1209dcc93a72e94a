//! The bytes on record, and the numbers beside them. In: RIG, INTENT, SAMPLE and HELD records, in order. Out: why the bytes do not
//! say what the record makes of them: every dialect is read back, bit for bit. A virtual rig has no bytes.

use super::entry::{HeldBody, IntentBody, RigBody, SampleBody, unescaped};
use super::replayed::body;
use crate::plan::{Datum, Dialect, Plan, RealLink};
use crate::record::journal::{EntryKind, Line};
use crate::rig::controllers::native;
use crate::rig::real::ReadBack;

/// What the bytes so far tell of those to come.
pub(super) struct Bytes<'a> {
    /// None: the rig is virtual.
    real: Option<(&'a RealLink, ReadBack<'a>)>,
    /// Readings are made while the rig moves.
    on_the_way: bool,
    /// Where the plan's zero lies by the first RIG record, m.
    datum: Option<Vec<f64>>,
}

impl<'a> Bytes<'a> {
    pub(super) fn of(plan: &'a Plan) -> Self {
        let real = plan
            .rig
            .link
            .as_real()
            .map(|link| (link, ReadBack::of(&plan.rig, link)));
        Self {
            real,
            on_the_way: false,
            datum: None,
        }
    }

    /// Whether the bytes of a record say its numbers.
    pub(super) fn agree(&mut self, line: &Line) -> Result<(), String> {
        let unread = |fault: super::Unplayable| fault.to_string();
        match line.kind {
            EntryKind::Rig => self.introduced(&body(line).map_err(unread)?),
            EntryKind::Intent => self.sent(&body(line).map_err(unread)?),
            EntryKind::Sample => self.heard(&body(line).map_err(unread)?),
            EntryKind::Held => self.stood(&body(line).map_err(unread)?),
            EntryKind::Stroke => {
                self.on_the_way = false;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn introduced(&mut self, rig: &RigBody) -> Result<(), String> {
        let Some((link, read_back)) = &mut self.real else {
            let silent = rig.said.is_empty();
            return if silent {
                Ok(())
            } else {
                Err("a virtual rig says nothing in bytes".to_owned())
            };
        };
        // Records of earlier builds do not say it: the rig's own zero was the plan's.
        let datum = rig.datum.clone().unwrap_or_else(|| vec![0.0; rig.axes]);
        let own = datum.iter().all(|place| *place == 0.0);
        if datum.len() != rig.axes || link.datum == Datum::Machine && !own {
            return Err(format!("a datum at {datum:?} m is not the plan's"));
        }
        if self.datum.get_or_insert_with(|| datum.clone()) != &datum {
            return Err(format!(
                "a datum at {datum:?} m is another than the run began with"
            ));
        }
        read_back.begin(&datum);
        let natively = link.actuator.dialect == Dialect::Native;
        // Records of earlier builds do not keep all of it, or none.
        if rig.said.is_empty() || rig.said.len() != read_back.introductions() && !natively {
            return Ok(());
        }
        let other = || "the bytes in which the rig said who it is do not say this".to_owned();
        let said: Vec<Vec<u8>> = rig
            .said
            .iter()
            .map(|reply| unescaped(reply))
            .collect::<Option<_>>()
            .ok_or_else(other)?;
        let same = read_back
            .introduced(&said)
            .is_some_and(|identity| identity == rig.identity);
        let remembers = || {
            let hello = said
                .first()
                .and_then(|line| native::codec::reply(line).ok())
                .and_then(|reply| native::codec::hello(&reply.words()));
            hello.map(|hello| (hello.bounds.axes.len(), hello.last.map(|last| last.id)))
        };
        let same = same
            && (!natively
                || remembers() == Some((rig.axes, rig.last_move.as_ref().map(|last| last.id))));
        if same { Ok(()) } else { Err(other()) }
    }

    fn sent(&mut self, intent: &IntentBody) -> Result<(), String> {
        self.on_the_way = intent.samples.is_some();
        let Some((_, read_back)) = &self.real else {
            let silent = intent.wire.is_none();
            return if silent {
                Ok(())
            } else {
                Err("nothing is sent to a virtual rig".to_owned())
            };
        };
        // Of a way that is read on the way its targets alone are on record.
        if self.on_the_way {
            return Ok(());
        }
        let places = intent.said.as_ref().unwrap_or(&intent.to);
        let wire = intent.wire.as_deref().and_then(unescaped);
        if wire.is_some_and(|wire| {
            read_back.sent(&wire, places, intent.own.as_deref(), intent.rate, intent.id)
        }) {
            return Ok(());
        }
        Err(format!(
            "the bytes that were sent do not say {:?} m at {} m/s",
            intent.to, intent.rate
        ))
    }

    fn heard(&mut self, sample: &SampleBody) -> Result<(), String> {
        let Some((link, read_back)) = &mut self.real else {
            return if sample.raw.is_empty() {
                Ok(())
            } else {
                Err("a virtual rig answers in no bytes".to_owned())
            };
        };
        let replies: Option<Vec<Vec<u8>>> = sample.raw.iter().map(|raw| unescaped(raw)).collect();
        let replies = replies
            .ok_or_else(|| "the bytes that came are not written as psd writes them".to_owned())?;
        let samples = usize::try_from(link.readings.samples.max(1)).unwrap_or(usize::MAX);
        read_back.says(&replies, samples, self.on_the_way, &sample.x, &sample.r)
    }
    /// Where it was held: one reading.
    fn stood(&mut self, held: &HeldBody) -> Result<(), String> {
        let Some((_, read_back)) = &mut self.real else {
            return Err("a virtual rig is not held".to_owned());
        };
        let Some((displacement, force)) = &held.found else {
            return Ok(());
        };
        let replies: Option<Vec<Vec<u8>>> = held.raw.iter().map(|raw| unescaped(raw)).collect();
        let replies = replies
            .ok_or_else(|| "the bytes that came are not written as psd writes them".to_owned())?;
        read_back.says(&replies, 1, true, displacement, force)
    }
}
