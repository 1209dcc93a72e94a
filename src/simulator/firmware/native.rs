//! A rig of psd's own line protocol. In: frames as `>MOVE 41 17 1.250000 0.500000*6858`. Out: one reply a frame, the same
//! one for the same sequence number. It never clamps: what it cannot do exactly, it refuses.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use crate::plan::Interval;
use crate::simulator::{Bench, Firmware};

/// Longest frame with its ending, bytes.
const LONGEST: usize = 96;
/// Most readings of one `MEAS`.
const MOST_READINGS: usize = 1000;
/// What stands for a limit there is none of: mm and mm/s, N.
const NO_LIMIT_MM: f64 = 999.0;
const NO_LIMIT_N: f64 = 99_999.0;

/// What a native rig is beside its bench.
#[derive(Clone, Debug)]
pub struct NativeSettings {
    pub serial_number: String,
    /// N
    pub force_limits: Interval,
    /// Silence after which it holds, s.
    pub watchdog: f64,
    /// Word of its first power-up; None: drawn.
    pub boot: Option<u16>,
}

impl Default for NativeSettings {
    fn default() -> Self {
        Self { serial_number: "0042".to_owned(), force_limits: Interval::ALL, watchdog: 3.0, boot: None }
    }
}

/// Limits in the units of the wire: mm, N, mm/s.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    displacement: (f64, f64),
    force: (f64, f64),
    top_speed: f64,
}

/// The firmware.
#[derive(Debug)]
pub struct Native {
    settings: NativeSettings,
    generator: Pcg64,
    boot: u16,
    /// What has come of the line; one that fills it is no frame.
    line: Vec<u8>,
    /// Sequence number of the last request, and what was answered.
    last: Option<(u32, Vec<u8>)>,
    own: Bounds,
    /// Those of the run, within its own.
    run: Bounds,
    /// Number and target (mm) of the last move it began.
    last_move: Option<(u64, f64)>,
    referenced: bool,
    held: bool,
    watchdog_tripped: bool,
    /// When a valid frame last came, s.
    heard: Option<f64>,
}

impl Native {
    #[must_use]
    pub fn new(settings: NativeSettings, bench: &Bench) -> Self {
        let mut generator = Pcg64::seed_from_u64(bench.settings().seed ^ 0xb007);
        let boot = settings.boot.unwrap_or_else(|| generator.random());
        let known = |value: f64, otherwise: f64, per: f64, decimals: i32| {
            let wire = if value.is_finite() { value * per } else { otherwise.copysign(value) };
            let scale = 10_f64.powi(decimals);
            (wire * scale).round() / scale
        };
        let bench = bench.settings();
        let own = Bounds {
            displacement: (known(bench.limits.low, NO_LIMIT_MM, 1e3, 6), known(bench.limits.high, NO_LIMIT_MM, 1e3, 6)),
            force: (known(settings.force_limits.low, NO_LIMIT_N, 1.0, 3), known(settings.force_limits.high, NO_LIMIT_N, 1.0, 3)),
            top_speed: known(bench.top_speed, NO_LIMIT_MM, 1e3, 6),
        };
        Self {
            settings,
            generator,
            boot,
            line: Vec::new(),
            last: None,
            own,
            run: own,
            last_move: None,
            referenced: true,
            held: false,
            watchdog_tripped: false,
            heard: None,
        }
    }

    fn hold(&mut self, bench: &mut Bench) {
        bench.hold();
        self.held = true;
    }

    /// One line without its ending → the answer, if it was a frame.
    fn frame(&mut self, line: &[u8], bench: &mut Bench) -> Option<Vec<u8>> {
        let text = std::str::from_utf8(line.strip_prefix(b">")?).ok()?;
        let (body, stated) = text.rsplit_once('*')?;
        if stated != format!("{:04X}", crc(body.as_bytes())) {
            return None;
        }
        self.heard = Some(bench.time());
        let mut words = body.split(' ');
        let verb = words.next()?;
        let sequence: u32 = words.next().filter(|word| word.bytes().all(|byte| byte.is_ascii_digit()))?.parse().ok()?;
        let arguments: Vec<&str> = words.collect();
        if verb != "HELLO" {
            match &self.last {
                Some((last, reply)) if *last == sequence => return Some(reply.clone()),
                Some((last, _)) if last.wrapping_add(1) == sequence => {}
                _ => return Some(self.reply("ERR", sequence, "SEQ")),
            }
        }
        let reply = match self.carry_out(verb, &arguments, bench) {
            Ok((kind, words)) => self.reply(kind, sequence, &words),
            Err(code) => self.reply("ERR", sequence, code),
        };
        self.last = Some((sequence, reply.clone()));
        Some(reply)
    }

    fn reply(&self, kind: &str, sequence: u32, words: &str) -> Vec<u8> {
        let body = format!("{kind} {sequence} {:04X} {words}", self.boot);
        format!("<{body}*{:04X}\n", crc(body.as_bytes())).into_bytes()
    }

    fn carry_out(&mut self, verb: &str, arguments: &[&str], bench: &mut Bench) -> Result<(&'static str, String), &'static str> {
        match (verb, arguments) {
            ("HELLO", []) => {
                self.run = self.own;
                return Ok(("ACK", self.hello()));
            }
            ("LIM", [low, high, least, most, speed]) => {
                let given = [low, high, least, most, speed].map(|word| decimal(word));
                let [Some(low), Some(high), Some(least), Some(most), Some(speed)] = given else { return Err("ARG") };
                let own = self.own;
                let narrower = own.displacement.0 <= low
                    && low <= high
                    && high <= own.displacement.1
                    && own.force.0 <= least
                    && least <= most
                    && most <= own.force.1
                    && 0.0 <= speed
                    && speed <= own.top_speed;
                if !narrower {
                    return Err("LIMIT");
                }
                self.run = Bounds { displacement: (low, high), force: (least, most), top_speed: speed };
            }
            ("MOVE", [id, target, rate]) => self.move_to(id, target, rate, bench)?,
            ("MEAS", [count]) => {
                let count = count.parse().ok().filter(|count| (1..=MOST_READINGS).contains(count)).ok_or("ARG")?;
                return Ok(("DATA", self.measure(count, bench)));
            }
            ("STAT", []) => return Ok(("ACK", format!("{} 0x{:04X}", self.state(bench), self.flags(false, bench)))),
            ("STOP", []) => self.hold(bench),
            ("CLR", []) => (self.held, self.watchdog_tripped) = (false, false),
            ("REF", [_]) => self.referenced = true,
            ("HELLO" | "LIM" | "MOVE" | "MEAS" | "STAT" | "STOP" | "CLR" | "REF", _) => return Err("ARG"),
            _ => return Err("VERB"),
        }
        Ok(("ACK", self.state(bench).to_owned()))
    }

    fn hello(&self) -> String {
        let Bounds { displacement, force, top_speed } = self.own;
        let (id, target) = self.last_move.unwrap_or((0, 0.0));
        format!(
            "PSD-SIM {} 1.3 {:.6} {:.6} {:.3} {:.3} {top_speed:.6} {id} {target:.6}",
            self.settings.serial_number, displacement.0, displacement.1, force.0, force.1
        )
    }

    fn move_to(&mut self, id: &str, target: &str, rate: &str, bench: &mut Bench) -> Result<(), &'static str> {
        let id: u64 = id.parse().ok().filter(|id| *id > 0).ok_or("ARG")?;
        let (target, rate) = (decimal(target).ok_or("ARG")?, decimal(rate).ok_or("ARG")?);
        if let Some((last, where_to)) = self.last_move {
            if id == last && target == where_to {
                return Ok(());
            }
            if id <= last {
                return Err("ID");
            }
        }
        let (low, high) = self.run.displacement;
        if !(low <= target && target <= high) {
            bench.refuse(target / 1e3);
            return Err("LIMIT");
        }
        if !(0.0 < rate && rate <= self.run.top_speed) {
            return Err("RATE");
        }
        if !self.referenced {
            return Err("REF");
        }
        if self.held {
            return Err("HELD");
        }
        if bench.moving() {
            return Err("BUSY");
        }
        self.last_move = Some((id, target));
        bench.go_as(Some(id), target / 1e3, rate / 1e3);
        Ok(())
    }

    /// The median of some readings.
    fn measure(&self, count: usize, bench: &mut Bench) -> String {
        let mut forces: Vec<f64> = (0..count).map(|_| bench.force()).collect();
        forces.sort_by(f64::total_cmp);
        let force = f64::midpoint(forces[(count - 1) / 2], forces[count / 2]);
        let raw = bench.counts_of(force);
        let displacement = bench.displacement() * 1e3;
        let shown = bench.shown_force(format!("{force:.3}"));
        let flags = self.flags(!(-8_388_607..8_388_607).contains(&raw), bench);
        format!("{:.0} {displacement:.6} {shown} {raw} 0x{flags:04X} {}", (bench.time() * 1e3).floor(), self.state(bench))
    }

    fn state(&self, bench: &Bench) -> &'static str {
        match (self.held, bench.moving()) {
            (true, _) => "HELD",
            (false, true) => "MOVING",
            (false, false) => "IDLE",
        }
    }

    fn flags(&self, saturated: bool, bench: &Bench) -> u16 {
        let position = bench.commanded() * 1e3;
        // Standing on a limit is within it, also for the last bits of a turn to mm.
        let beyond = |excess: f64| excess > 1e-6;
        let bits = [
            saturated,
            false,
            beyond(position - self.run.displacement.1),
            beyond(self.run.displacement.0 - position),
            false,
            !self.referenced,
            bench.moving(),
            self.watchdog_tripped,
        ];
        bits.iter().rev().fold(0, |word, bit| word << 1 | u16::from(*bit))
    }
}

impl Firmware for Native {
    fn receive(&mut self, bytes: &[u8], bench: &mut Bench) -> Vec<u8> {
        let mut said = self.tick(bench);
        for byte in bytes {
            match byte {
                b'!' => self.hold(bench),
                b'\n' => {
                    let line = std::mem::take(&mut self.line);
                    if line.len() < LONGEST {
                        said.extend(self.frame(&line, bench).unwrap_or_default());
                    }
                }
                _ if self.line.len() < LONGEST => self.line.push(*byte),
                _ => {}
            }
        }
        said
    }

    fn tick(&mut self, bench: &mut Bench) -> Vec<u8> {
        if self.heard.is_some_and(|heard| bench.time() - heard > self.settings.watchdog) && !self.watchdog_tripped {
            self.watchdog_tripped = true;
            self.hold(bench);
        }
        Vec::new()
    }

    fn reboot(&mut self, bench: &mut Bench) -> Vec<u8> {
        bench.hold();
        let was = self.boot;
        *self = Self::new(NativeSettings { boot: None, ..self.settings.clone() }, bench);
        while self.boot == was {
            self.boot = self.generator.random();
        }
        self.referenced = false;
        Vec::new()
    }
}

/// A number as the wire has it: digits, at most one point with digits on both sides, no exponent.
fn decimal(word: &str) -> Option<f64> {
    let digits = word.strip_prefix('-').unwrap_or(word);
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, "0"));
    let all_digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    if all_digits(whole) && all_digits(fraction) { word.parse().ok() } else { None }
}

/// CRC-16/CCITT-FALSE by table-free byte steps.
fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0xffff_u16;
    for byte in bytes {
        // The classical byte-wise form, other than the driver's shift register.
        let mut mixed = crc >> 8 ^ u16::from(*byte);
        mixed ^= mixed >> 4;
        crc = crc << 8 ^ mixed << 12 ^ mixed << 5 ^ mixed;
    }
    crc
}

/// A request with its checksum, for tests that stand in for a host.
#[cfg(test)]
pub fn sealed(body: &str) -> Vec<u8> {
    format!(">{body}*{:04X}\n", crc(body.as_bytes())).into_bytes()
}

#[cfg(test)]
#[path = "native_tests.rs"]
mod tests;
