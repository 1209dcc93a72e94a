//! Emulated controller for psd's own protocol, with one axis or several. In: frames such as `>MOVE
//! 41 17 1.250000 0.500000*6858`. Out: one reply per frame, the same reply for the same sequence
//! number. It never clamps: it refuses a command that it cannot carry out exactly.

mod bounds;
mod force_control;
mod frame;
mod glide;
mod readings;
#[cfg(test)]
mod tests;

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use crate::emulator::{EmulatedRig, Firmware};
use bounds::{AxisBounds, Bounds};
pub use frame::sealed;
use frame::{crc, decimal, of_axis};
use psd_plan::Interval;

/// Longest frame with its ending \[bytes\]: with one axis, with several.
const LONGEST: usize = 96;
const LONGEST_OF_SEVERAL: usize = 512;
/// Maximum number of readings of one `MEAS`.
const MOST_READINGS: usize = 1000;

/// Settings of a native rig in addition to its emulated rig.
#[derive(Clone, Debug)]
pub struct NativeSettings {
    pub serial_number: String,
    /// The indices of the actuators that are its axes; None: all of the emulated rig.
    pub actuators: Option<Vec<usize>>,
    /// One per axis \[N\]; an axis without an entry has no force limit.
    pub force_limits: Vec<Interval>,
    /// Communication time-out after which it holds \[s\].
    pub watchdog: f64,
    /// Boot identifier of its first power-up; None: random.
    pub boot: Option<u16>,
}

impl Default for NativeSettings {
    fn default() -> Self {
        Self {
            serial_number: "0042".to_owned(),
            actuators: None,
            force_limits: Vec::new(),
            watchdog: 3.0,
            boot: None,
        }
    }
}

/// The firmware.
#[derive(Debug)]
pub struct Native {
    settings: NativeSettings,
    /// The index of the actuator of each axis.
    actuators: Vec<usize>,
    generator: Pcg64,
    boot: u16,
    /// The received part of a line. A line that fills the buffer is not a frame.
    line: Vec<u8>,
    /// Sequence number of the last request, and the answer to it.
    last: Option<(u32, Vec<u8>)>,
    own: Bounds,
    /// The limits of the run, within those of the rig.
    run: Bounds,
    /// Rate \[N/s\] and tolerance \[N\] of each axis that `FORCE` put in force control.
    force: Vec<Option<(f64, f64)>>,
    /// Number and targets \[mm\], or \[N\] in force control, of the last started move.
    last_move: Option<(u64, Vec<f64>)>,
    referenced: bool,
    held: bool,
    watchdog_tripped: bool,
    /// Time of the last valid frame \[s\].
    last_contact: Option<f64>,
}

impl Native {
    #[must_use]
    pub fn new(settings: NativeSettings, rig: &EmulatedRig) -> Self {
        let mut generator = Pcg64::seed_from_u64(rig.settings().seed ^ 0xb007);
        let boot = settings.boot.unwrap_or_else(|| generator.random());
        let actuators = settings
            .actuators
            .clone()
            .unwrap_or_else(|| (0..rig.actuators()).collect());
        let own = Bounds::of_rig(&settings, &actuators, rig);
        Self {
            actuators,
            settings,
            generator,
            boot,
            line: Vec::new(),
            last: None,
            run: own.clone(),
            force: vec![None; own.axes.len()],
            own,
            last_move: None,
            referenced: true,
            held: false,
            watchdog_tripped: false,
            last_contact: None,
        }
    }

    fn hold(&mut self, rig: &mut EmulatedRig) {
        self.stand_still(rig);
        self.held = true;
    }

    fn stand_still(&self, rig: &mut EmulatedRig) {
        if self.has_all_of(rig) {
            rig.hold();
        } else {
            rig.hold_those(&self.actuators);
        }
    }

    /// Whether it controls the whole emulated rig. Otherwise another controller moves the rest, and it follows no smooth move.
    const fn has_all_of(&self, rig: &EmulatedRig) -> bool {
        self.actuators.len() == rig.actuators()
    }

    fn moves(&self, rig: &EmulatedRig) -> bool {
        rig.any_moving(&self.actuators)
    }

    /// Parses one line without its ending and returns the answer, if the line was a frame.
    fn frame(&mut self, line: &[u8], rig: &mut EmulatedRig) -> Option<Vec<u8>> {
        let text = std::str::from_utf8(line.strip_prefix(b">")?).ok()?;
        let (body, stated) = text.rsplit_once('*')?;
        if stated != format!("{:04X}", crc(body.as_bytes())) {
            return None;
        }
        self.last_contact = Some(rig.time());
        let mut words = body.split(' ');
        let verb = words.next()?;
        let sequence: u32 = words
            .next()
            .filter(|word| word.bytes().all(|byte| byte.is_ascii_digit()))?
            .parse()
            .ok()?;
        let arguments: Vec<&str> = words.collect();
        if verb != "HELLO" {
            match &self.last {
                Some((last, reply)) if *last == sequence => return Some(reply.clone()),
                Some((last, _)) if last.wrapping_add(1) == sequence => {}
                _ => return Some(self.reply("ERR", sequence, "SEQ")),
            }
        }
        let reply = match self.carry_out(verb, &arguments, rig) {
            Ok((kind, words)) => self.reply(kind, sequence, &words),
            Err(code) => self.reply("ERR", sequence, &code),
        };
        self.last = Some((sequence, reply.clone()));
        Some(reply)
    }

    fn reply(&self, kind: &str, sequence: u32, words: &str) -> Vec<u8> {
        let body = format!("{kind} {sequence} {:04X} {words}", self.boot);
        format!("<{body}*{:04X}\n", crc(body.as_bytes())).into_bytes()
    }

    fn carry_out(
        &mut self,
        verb: &str,
        arguments: &[&str],
        rig: &mut EmulatedRig,
    ) -> Result<(&'static str, String), String> {
        let axes = self.actuators.len();
        match (verb, arguments) {
            ("HELLO", []) => {
                self.forget_limits(rig);
                return Ok(("ACK", self.hello()));
            }
            ("LIM", [limits @ .., speed]) if limits.len() == 4 * axes => {
                let given: Option<Vec<AxisBounds>> =
                    limits.chunks(4).map(AxisBounds::parse).collect();
                let (given, top_speed) = given.zip(decimal(speed)).ok_or("ARG")?;
                let wider = given
                    .iter()
                    .zip(&self.own.axes)
                    .position(|(given, own)| !given.narrower_than(own));
                if let Some(axis) = wider {
                    return Err(of_axis("LIMIT", axis, axes));
                }
                if !(0.0..=self.own.top_speed).contains(&top_speed) {
                    return Err("LIMIT".to_owned());
                }
                self.run = Bounds {
                    axes: given,
                    top_speed,
                };
            }
            ("FORCE", words) if words.len() == 2 * axes => self.control_force(words, rig)?,
            ("MOVE", [id, targets @ .., rate]) if targets.len() == axes => {
                self.move_to(id, targets, rate, rig)?;
            }
            ("GLIDE", _) if !self.has_all_of(rig) || self.has_force_axis() => {
                return Err("VERB".to_owned());
            }
            ("GLIDE", [id, ends @ .., time]) if ends.len() == 2 * axes => {
                let left = self.glide(id, ends, time, rig)?;
                return Ok(("ACK", format!("{} {:.3}", self.state(rig), left * 1e3)));
            }
            ("MEAS", [count]) => {
                let count = count
                    .parse()
                    .ok()
                    .filter(|count| (1..=MOST_READINGS).contains(count))
                    .ok_or("ARG")?;
                return Ok(("DATA", self.measure(count, rig)));
            }
            ("STAT", []) => {
                return Ok((
                    "ACK",
                    format!("{} 0x{:04X}", self.state(rig), self.all_flags(rig)),
                ));
            }
            ("STOP", []) => self.hold(rig),
            ("CLR", []) => {
                (self.held, self.watchdog_tripped) = (false, false);
                for actuator in &self.actuators {
                    rig.clear_left_force_control(*actuator);
                }
            }
            ("REF", [_]) => self.referenced = true,
            (
                "HELLO" | "LIM" | "FORCE" | "MOVE" | "GLIDE" | "MEAS" | "STAT" | "STOP" | "CLR"
                | "REF",
                _,
            ) => {
                return Err("ARG".to_owned());
            }
            _ => return Err("VERB".to_owned()),
        }
        Ok(("ACK", self.state(rig).to_owned()))
    }

    fn hello(&self) -> String {
        let axis = |AxisBounds {
                        displacement,
                        force,
                    }: &AxisBounds| {
            format!(
                "{:.6} {:.6} {:.3} {:.3}",
                displacement.0, displacement.1, force.0, force.1
            )
        };
        let limits: Vec<String> = self.own.axes.iter().map(axis).collect();
        let (id, targets) = self
            .last_move
            .clone()
            .unwrap_or_else(|| (0, vec![0.0; limits.len()]));
        let written = targets.iter().zip(&self.force);
        let written = written.map(|(target, force)| match force {
            Some(_) => format!("{target:.3}"),
            None => format!("{target:.6}"),
        });
        let targets: Vec<String> = written.collect();
        let (serial_number, top_speed) = (&self.settings.serial_number, self.own.top_speed);
        format!(
            "PSD-SIM {serial_number} 1.3 {} {top_speed:.6} {id} {}",
            limits.join(" "),
            targets.join(" ")
        )
    }

    /// Moves all axes or none.
    fn move_to(
        &mut self,
        id: &str,
        targets: &[&str],
        rate: &str,
        rig: &mut EmulatedRig,
    ) -> Result<(), String> {
        let id: u64 = id.parse().ok().filter(|id| *id > 0).ok_or("ARG")?;
        let targets: Option<Vec<f64>> = targets.iter().map(|target| decimal(target)).collect();
        let (targets, rate) = targets.zip(decimal(rate)).ok_or("ARG")?;
        if let Some((last, where_to)) = &self.last_move {
            if id == *last && targets == *where_to {
                return Ok(());
            }
            if id <= *last {
                return Err("ID".to_owned());
            }
        }
        let (moving, metres) = self.displacements(&targets);
        if let Some(axis) = (0..targets.len()).find(|axis| !self.allows(*axis, targets[*axis], rig))
        {
            for (actuator, target) in moving.iter().zip(&metres) {
                rig.refuse_of(*actuator, *target);
            }
            return Err(of_axis("LIMIT", axis, targets.len()));
        }
        let refused = [
            (!(0.0 < rate && rate <= self.run.top_speed), "RATE"),
            (!self.referenced, "REF"),
            (self.held, "HELD"),
            (self.moves(rig), "BUSY"),
        ];
        if let Some((_, code)) = refused.into_iter().find(|(refused, _)| *refused) {
            return Err(code.to_owned());
        }
        self.load(&targets, rig);
        self.last_move = Some((id, targets));
        rig.go_those(Some(id), &moving, &metres, rate / 1e3);
        Ok(())
    }
}

impl Firmware for Native {
    fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
        let mut reply = self.tick(rig);
        let longest = if self.actuators.len() > 1 {
            LONGEST_OF_SEVERAL
        } else {
            LONGEST
        };
        for byte in bytes {
            match byte {
                b'!' => self.hold(rig),
                b'\n' => {
                    let line = std::mem::take(&mut self.line);
                    if line.len() < longest {
                        reply.extend(self.frame(&line, rig).unwrap_or_default());
                    }
                }
                _ if self.line.len() < longest => self.line.push(*byte),
                _ => {}
            }
        }
        reply
    }

    fn tick(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.coast(rig);
        self.hold_without_force(rig);
        if self
            .last_contact
            .is_some_and(|last_contact| rig.time() - last_contact > self.settings.watchdog)
            && !self.watchdog_tripped
        {
            self.watchdog_tripped = true;
            self.hold(rig);
        }
        Vec::new()
    }

    fn reboot(&mut self, rig: &mut EmulatedRig) -> Vec<u8> {
        self.stand_still(rig);
        for actuator in &self.actuators {
            rig.end_force_control(*actuator);
        }
        let was = self.boot;
        *self = Self::new(
            NativeSettings {
                boot: None,
                ..self.settings.clone()
            },
            rig,
        );
        while self.boot == was {
            self.boot = self.generator.random();
        }
        self.referenced = false;
        Vec::new()
    }
}
