//! The bytes on record, and the numbers beside them. In: RIG, INTENT and SAMPLE records, in order. Out: why the bytes do not
//! say what the record makes of them. psd's own protocol is read back; what other dialects said is kept, and not read again
//! here. A virtual rig has no bytes.

use super::entry::{IntentBody, RigBody, SampleBody, unescaped};
use super::played::body;
use crate::plan::{Dialect, Plan, RealLink, RigPlan};
use crate::record::journal::{EntryKind, Line};
use crate::rig::device::native_identity;
use crate::rig::dialect::native::{self, Data, Kind};
use crate::rig::dialect::native_sent::SentMove;
use crate::rig::real::representative;

/// What the bytes so far tell of those to come.
pub(super) struct Bytes<'a> {
    rig: &'a RigPlan,
    link: Option<&'a RealLink>,
    /// Word of the power-up, as the last RIG says.
    boot: Option<String>,
    /// The device's own clock at its last reading, s.
    clock: f64,
}

impl<'a> Bytes<'a> {
    pub(super) fn of(plan: &'a Plan) -> Self {
        Self { rig: &plan.rig, link: plan.rig.link.as_real(), boot: None, clock: 0.0 }
    }

    /// Whether the bytes of a record say its numbers.
    pub(super) fn agree(&mut self, line: &Line) -> Result<(), String> {
        let unread = |fault: super::Unplayable| fault.to_string();
        match line.kind {
            EntryKind::Rig => self.introduced(&body(line).map_err(unread)?),
            EntryKind::Intent => self.sent(&body(line).map_err(unread)?),
            EntryKind::Sample => self.heard(&body(line).map_err(unread)?),
            _ => Ok(()),
        }
    }

    /// Whether psd's own protocol moves the rig.
    fn moved_natively(&self) -> bool {
        self.link.is_some_and(|link| link.actuator.dialect == Dialect::Native)
    }

    fn introduced(&mut self, rig: &RigBody) -> Result<(), String> {
        (self.boot, self.clock) = (rig.identity.boot.clone(), 0.0);
        if self.link.is_none() && !rig.said.is_empty() {
            return Err("a virtual rig says nothing in bytes".to_owned());
        }
        // Records of earlier builds do not keep it.
        let Some(said) = rig.said.first().filter(|_| self.moved_natively()) else { return Ok(()) };
        let other = || "the bytes in which the rig said who it is do not say this".to_owned();
        let reply = unescaped(said).and_then(|line| native::reply(&line).ok()).ok_or_else(other)?;
        let hello = native::hello(&reply.words()).ok_or_else(other)?;
        let device = native_identity(&hello, Some(reply.boot().to_owned()));
        let alone = self.link.is_some_and(|link| link.load_cells().is_empty());
        let names = |whole: &str, part: &str| if alone { whole == part } else { whole.starts_with(part) };
        let told = &rig.identity;
        let same = names(&told.model, &device.model)
            && names(&told.serial, &device.serial)
            && names(&told.firmware, &device.firmware)
            && told.boot == device.boot
            && if alone { told.simulated == device.simulated } else { told.simulated || !device.simulated }
            && rig.axes == hello.bounds.axes.len()
            && rig.last_move.as_ref().map(|last| last.id) == hello.last.map(|last| last.id);
        if same { Ok(()) } else { Err(other()) }
    }

    fn sent(&self, intent: &IntentBody) -> Result<(), String> {
        if self.link.is_none() && intent.wire.is_some() {
            return Err("nothing is sent to a virtual rig".to_owned());
        }
        // Of a way that is read on the way its targets alone are on record.
        if !self.moved_natively() || intent.samples.is_some() {
            return Ok(());
        }
        let other = || format!("the bytes that were sent do not say {:?} m at {} m/s", intent.to, intent.rate);
        let sent = intent.wire.as_deref().and_then(unescaped).and_then(|wire| SentMove::of(&wire)).ok_or_else(other)?;
        let places = intent.said.as_ref().unwrap_or(&intent.to);
        let turned: Vec<f64> = places.iter().enumerate().map(|(axis, place)| self.rig.sign_of(axis) * place).collect();
        let same = sent.says(&turned, intent.rate) && intent.id == Some(sent.id);
        if same { Ok(()) } else { Err(other()) }
    }

    fn heard(&mut self, sample: &SampleBody) -> Result<(), String> {
        let Some(link) = self.link else {
            return if sample.raw.is_empty() { Ok(()) } else { Err("a virtual rig answers in no bytes".to_owned()) };
        };
        let cells = link.load_cells();
        // Two devices that speak the same are not told apart by their bytes.
        if !self.moved_natively() || cells.iter().any(|cell| cell.link.dialect == Dialect::Native) {
            return Ok(());
        }
        let mut readings = Vec::new();
        for raw in &sample.raw {
            let Some(reply) = unescaped(raw).and_then(|line| native::reply(&line).ok()) else { continue };
            let Some(data) = native::data(&reply.words()).filter(|_| reply.kind == Kind::Data) else { continue };
            if self.boot.as_ref().is_some_and(|boot| *boot != reply.boot()) {
                return Err("a reply is of another power-up of the rig".to_owned());
            }
            if data.time < self.clock {
                return Err("a reply is older than the one before it, by the rig's own clock".to_owned());
            }
            self.clock = data.time;
            // An old reading was asked for again.
            if data.axes.len() == sample.x.len() && data.axes.iter().all(|axis| !axis.flags.stale) {
                readings.push(data);
            }
        }
        let of_axis = |axis: usize, of: fn(&Data, usize) -> f64| -> Vec<f64> {
            readings.iter().map(|data| self.rig.sign_of(axis) * of(data, axis)).collect()
        };
        // What weighs by itself says the force in a dialect of its own.
        let alone = cells.is_empty();
        let weighs = |axis: usize| cells.iter().all(|cell| !cell.axes.contains(&axis));
        for (axis, x) in sample.x.iter().enumerate() {
            if !is_of(&of_axis(axis, |data, axis| data.axes[axis].displacement), *x, alone) {
                return Err(format!("the bytes that came do not say {x} m"));
            }
        }
        for (axis, force) in sample.r.iter().enumerate().filter(|(axis, _)| weighs(*axis)) {
            if !is_of(&of_axis(axis, |data, axis| data.axes[axis].force), *force, alone) {
                return Err(format!("the bytes that came do not say {force} N"));
            }
        }
        Ok(())
    }
}

/// Whether a number is what is made of these readings. Beside a load cell of its own one may have been taken again for want of
/// the other's: then it lies among them.
fn is_of(readings: &[f64], number: f64, alone: bool) -> bool {
    let bounds = || readings.iter().any(|reading| *reading <= number) && readings.iter().any(|reading| *reading >= number);
    !readings.is_empty() && if alone { representative(readings.to_vec()) == number } else { bounds() }
}
