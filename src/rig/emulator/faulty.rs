//! A controller with line faults. It is between a firmware and the line, and follows the script. In: bytes from the host, time.
//! Out: bytes for the host when they are due, and whether the line is still open. It knows no protocol.

use rand::RngExt as _;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng as _;

use super::script::{GarbagePosition, LineFault, ReplyFault, ScriptedFault, What, When};
use super::{EmulatedRig, Firmware};

/// Time between the parts of a split reply, and between a reply and the hang-up after it \[s\].
const GAP: f64 = 0.02;

/// A firmware with the faults of its line.
pub struct Faulty {
    firmware: Box<dyn Firmware>,
    faults: Vec<Armed>,
    generator: Pcg64,
    /// Replies of the firmware, including the lost ones.
    replies: u64,
    previous: Vec<u8>,
    outgoing: Vec<Outgoing>,
    /// Bytes received while the firmware was frozen.
    unheard: Vec<u8>,
    frozen_until: f64,
    deaf: bool,
    hung_up: bool,
}

/// A fault that is still active.
struct Armed {
    fault: ScriptedFault,
    /// Remaining number of replies that it affects; None: all.
    left: Option<u64>,
}

struct Outgoing {
    /// s
    due: f64,
    /// None: the line is closed at that time.
    bytes: Option<Vec<u8>>,
}

impl Faulty {
    /// A firmware with the faults of its line.
    #[must_use]
    pub fn new(firmware: Box<dyn Firmware>, faults: Vec<ScriptedFault>, seed: u64) -> Self {
        let arm = |fault: ScriptedFault| {
            let left = if let What::Replies(_, count) = &fault.what {
                *count
            } else {
                Some(1)
            };
            // A random fault never ends.
            let left = if matches!(fault.when, When::EachReply(_)) {
                None
            } else {
                left
            };
            Armed { fault, left }
        };
        Self {
            firmware,
            faults: faults.into_iter().map(arm).collect(),
            generator: Pcg64::seed_from_u64(seed ^ 0x11fe_11fe),
            replies: 0,
            previous: Vec::new(),
            outgoing: Vec::new(),
            unheard: Vec::new(),
            frozen_until: f64::NEG_INFINITY,
            deaf: false,
            hung_up: false,
        }
    }

    /// Receives bytes from the host. The emulated rig is already at the present time.
    pub fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) {
        if rig.time() < self.frozen_until {
            self.unheard.extend_from_slice(bytes);
            return;
        }
        // One byte at a time: each answer is then one reply, and the time of a fault is exact.
        for byte in bytes {
            self.strike_what_is_due(rig);
            let reply = self.firmware.receive(std::slice::from_ref(byte), rig);
            self.strike_what_is_due(rig);
            self.send(reply, rig);
        }
    }

    /// Time has passed.
    pub fn tick(&mut self, rig: &mut EmulatedRig) {
        self.strike_what_is_due(rig);
        if rig.time() < self.frozen_until {
            return;
        }
        let unheard = std::mem::take(&mut self.unheard);
        self.receive(&unheard, rig);
        let reply = self.firmware.tick(rig);
        self.send(reply, rig);
    }

    /// Returns the next part of a reply that is due at `time` \[s\].
    pub fn take(&mut self, time: f64) -> Option<Vec<u8>> {
        let due = self
            .outgoing
            .iter()
            .enumerate()
            .filter(|(_, outgoing)| outgoing.due <= time);
        let at = due
            .min_by(|(_, one), (_, other)| one.due.total_cmp(&other.due))?
            .0;
        let bytes = self.outgoing.remove(at).bytes;
        if bytes.is_none() {
            self.hang_up();
        }
        bytes
    }

    /// Whether it reads bytes from the line.
    #[must_use]
    pub const fn reads(&self) -> bool {
        !self.deaf
    }

    /// Whether it has received bytes that it will obey later, because its firmware is frozen.
    #[must_use]
    pub const fn obeys_later(&self) -> bool {
        !self.unheard.is_empty()
    }

    /// Whether it closed the line.
    #[must_use]
    pub const fn hung_up(&self) -> bool {
        self.hung_up
    }

    /// A host connects again. Replies to the previous host are lost; the controller keeps its state.
    pub fn reconnect(&mut self) {
        self.outgoing.clear();
        self.hung_up = false;
    }

    fn hang_up(&mut self) {
        self.outgoing.clear();
        self.hung_up = true;
    }

    /// Whether a fault is due.
    fn due(when: When, replies: u64, rig: &EmulatedRig) -> bool {
        match when {
            When::At(time) => rig.time() >= time,
            When::AfterMoves(count) => rig.moves().len() as u64 >= count,
            When::AfterReadings(count) => rig.readings() >= count,
            When::AfterReplies(count) => replies >= count,
            When::EachReply(_) | When::EachReading(_) => true,
        }
    }

    /// Starts the mechanical faults and those of the line that are due. Faults of replies wait for a reply.
    fn strike_what_is_due(&mut self, rig: &mut EmulatedRig) {
        let replies = self.replies;
        let mut due = Vec::new();
        self.faults.retain(|armed| {
            let strikes = !matches!(armed.fault.what, What::Replies(..))
                && Self::due(armed.fault.when, replies, rig);
            if strikes {
                due.push(armed.fault.clone());
            }
            !strikes
        });
        for fault in due {
            let actuator = fault.actuator;
            match (fault.what, fault.when) {
                (What::Rig(fault), When::EachReading(probability)) => {
                    rig.strike_by_chance(actuator, fault, probability);
                }
                (What::Rig(fault), _) => rig.strike(actuator, fault),
                (What::Line(LineFault::HangUp), _) => self.hang_up(),
                (What::Line(LineFault::StopReading), _) => self.deaf = true,
                (What::Line(LineFault::FreezeFirmware(seconds)), _) => {
                    self.frozen_until = rig.time() + seconds;
                }
                (What::Line(LineFault::Reboot), _) => {
                    let reply = self.firmware.reboot(rig);
                    self.send(reply, rig);
                }
                (What::Replies(..), _) => {}
            }
        }
    }

    /// Returns the faults of the next reply.
    fn befalling(&mut self, rig: &EmulatedRig) -> Vec<ReplyFault> {
        let mut found = Vec::new();
        for armed in &mut self.faults {
            let What::Replies(fault, _) = armed.fault.what else {
                continue;
            };
            let chance = if let When::EachReply(probability) = armed.fault.when {
                probability
            } else {
                1.0
            };
            if Self::due(armed.fault.when, self.replies, rig)
                && (chance >= 1.0 || self.generator.random::<f64>() < chance)
            {
                armed.left = armed.left.map(|left| left.saturating_sub(1));
                found.push(fault);
            }
        }
        self.faults.retain(|armed| armed.left != Some(0));
        found
    }

    fn send(&mut self, reply: Vec<u8>, rig: &EmulatedRig) {
        if reply.is_empty() || self.hung_up {
            return;
        }
        let befalling = self.befalling(rig);
        self.replies += 1;
        let previous = std::mem::replace(&mut self.previous, reply.clone());
        let mut bytes = reply;
        let (mut due, mut copies, mut split, mut ends) = (rig.time(), 1, None, false);
        for fault in befalling {
            match fault {
                ReplyFault::Drop => copies = 0,
                ReplyFault::Repeat => copies = 2,
                ReplyFault::Replay => bytes.clone_from(&previous),
                ReplyFault::SplitAt(_) | ReplyFault::SplitEvery(_) => split = Some(fault),
                ReplyFault::CutAt(count) => bytes.truncate(count),
                ReplyFault::FlipBit(bit) => self.flip(&mut bytes, bit),
                ReplyFault::Garbage {
                    count,
                    byte,
                    position,
                } => {
                    self.soil(&mut bytes, count, byte, position);
                }
                ReplyFault::Delay(milliseconds) => {
                    due += std::time::Duration::from_millis(milliseconds).as_secs_f64();
                }
                ReplyFault::HangUpBefore => return self.hang_up(),
                ReplyFault::HangUpAfter => ends = true,
            }
        }
        let bytes = bytes.repeat(copies);
        let pieces: Vec<&[u8]> = match split {
            Some(ReplyFault::SplitAt(count)) => {
                let (one, other) = bytes.split_at(count.min(bytes.len()));
                vec![one, other]
            }
            Some(ReplyFault::SplitEvery(count)) => bytes.chunks(count.max(1)).collect(),
            _ => vec![&bytes],
        };
        for piece in pieces.into_iter().filter(|piece| !piece.is_empty()) {
            self.outgoing.push(Outgoing {
                due,
                bytes: Some(piece.to_vec()),
            });
            if split.is_some() {
                due += GAP;
            }
        }
        if ends {
            // A reply that is not yet sent when a terminal hangs up is lost.
            self.outgoing.push(Outgoing {
                due: due + GAP,
                bytes: None,
            });
        }
    }

    fn flip(&mut self, bytes: &mut [u8], bit: Option<usize>) {
        if !bytes.is_empty() {
            let bit = bit.unwrap_or_else(|| self.generator.random_range(0..bytes.len() * 8))
                % (bytes.len() * 8);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }

    fn soil(
        &mut self,
        bytes: &mut Vec<u8>,
        count: usize,
        byte: Option<u8>,
        position: GarbagePosition,
    ) {
        let dirt: Vec<u8> = (0..count)
            .map(|_| byte.unwrap_or_else(|| self.generator.random()))
            .collect();
        let at = match position {
            GarbagePosition::Before => 0,
            GarbagePosition::Inside => bytes.len() / 2,
            GarbagePosition::After => bytes.len(),
        };
        bytes.splice(at..at, dirt);
    }
}

#[cfg(test)]
mod tests {
    use super::super::script::Script;
    use super::*;
    use crate::testing::emulator::elastic_rig;

    /// Returns its input at every line feed, and moves 1 mm at every `m`.
    #[derive(Default)]
    struct Echo(Vec<u8>);

    impl Firmware for Echo {
        fn receive(&mut self, bytes: &[u8], rig: &mut EmulatedRig) -> Vec<u8> {
            self.0.extend_from_slice(bytes);
            if bytes.contains(&b'm') {
                rig.go(0.001, 0.01);
            }
            if bytes.contains(&b'\n') {
                std::mem::take(&mut self.0)
            } else {
                Vec::new()
            }
        }

        fn tick(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
            Vec::new()
        }

        fn reboot(&mut self, _: &mut EmulatedRig) -> Vec<u8> {
            self.0.clear();
            b"up\n".to_vec()
        }
    }

    /// Returns the answer to each line, sent one per second, in the parts in which it came.
    fn converse(script: &str, lines: &[&str]) -> Vec<Vec<String>> {
        let mut faulty = Faulty::new(
            Box::new(Echo::default()),
            Script::parse(script).expect("a script").faults,
            1,
        );
        let mut rig = elastic_rig();
        let mut answers = Vec::new();
        let mut time = 0.0;
        for line in lines {
            rig.advance(time);
            faulty.receive(line.as_bytes(), &mut rig);
            let mut pieces = Vec::new();
            for slice in 0_u32..10 {
                rig.advance(time + f64::from(slice) * 0.1);
                faulty.tick(&mut rig);
                pieces.extend(
                    std::iter::from_fn(|| faulty.take(rig.time()))
                        .map(|piece| piece.escape_ascii().to_string()),
                );
            }
            if faulty.hung_up() {
                pieces.push("(hung up)".to_owned());
                faulty.reconnect();
            }
            answers.push(pieces);
            time += 1.0;
        }
        answers
    }

    #[test]
    fn each_fault_of_a_reply_has_its_stated_effect() {
        let lines = ["one\n", "two\n", "three\n"];
        let second = |fault: &str| converse(&format!("after 1 reply: {fault}"), &lines)[1].clone();
        assert_eq!(converse("", &lines), [["one\\n"], ["two\\n"], ["three\\n"]]);
        assert_eq!(
            converse("after 1 reply: drop reply", &lines),
            [vec!["one\\n"], vec![], vec!["three\\n"]]
        );
        assert_eq!(
            converse("at 0 s: drop replies for ever", &lines),
            [Vec::<String>::new(), vec![], vec![]]
        );
        assert_eq!(second("split reply at 2 bytes"), ["tw", "o\\n"]);
        assert_eq!(second("split reply every 1 bytes"), ["t", "w", "o", "\\n"]);
        assert_eq!(second("cut reply at 2 bytes"), ["tw"]);
        assert_eq!(second("flip bit 9"), ["tuo\\n"], "bit 1 of the second byte");
        assert_eq!(second("fill 2 bytes of 00 inside"), ["tw\\x00\\x00o\\n"]);
        assert_eq!(
            second("fill 1048576 bytes of 41 before")[0].len(),
            1_048_576 + "two\\n".len()
        );
        assert_eq!(second("repeat reply"), ["two\\ntwo\\n"]);
        assert_eq!(second("replay reply"), ["one\\n"]);
        assert_eq!(second("hang up before reply"), ["(hung up)"]);
        assert_eq!(second("hang up after reply"), ["two\\n", "(hung up)"]);
        assert_eq!(
            converse("after 1 reply: delay reply 1.5 s", &lines),
            [vec!["one\\n"], vec![], vec!["three\\n", "two\\n"]]
        );
    }

    #[test]
    fn what_comes_by_chance_is_the_same_for_the_same_seed() {
        let lines = ["0123456789\n"; 40];
        let flips = || converse("each reply: flip a bit with 0.25", &lines);
        let spoilt = flips()
            .iter()
            .filter(|pieces| pieces[0] != "0123456789\\n")
            .count();
        assert!((2..20).contains(&spoilt), "{spoilt} of 40, expected 10");
        assert_eq!(flips(), flips());
        assert!(converse("after 1 reply: garbage 4 bytes after", &["a\n", "b\n"])[1][0].len() > 6);
    }

    #[test]
    fn faults_of_the_line_strike_when_they_are_due() {
        let lines = ["one\n", "m\n", "three\n", "four\n"];
        assert_eq!(
            converse("after 1 move: drop reply", &lines)[1],
            Vec::<String>::new(),
            "the reply to the move itself"
        );
        assert_eq!(converse("after 1 move: hang up", &lines)[1], ["(hung up)"]);
        assert_eq!(converse("at 1.5 s: reboot", &lines)[1], ["m\\n", "up\\n"]);
        let frozen = converse("at 0.5 s: freeze firmware 2 s", &lines);
        assert_eq!(
            frozen,
            [
                vec!["one\\n"],
                vec![],
                vec!["m\\n", "three\\n"],
                vec!["four\\n"]
            ]
        );
        let mut faulty = Faulty::new(
            Box::new(Echo::default()),
            Script::parse("at 1 s: stop reading")
                .expect("a script")
                .faults,
            1,
        );
        let mut rig = elastic_rig();
        assert!(faulty.reads());
        rig.advance(1.0);
        faulty.tick(&mut rig);
        assert!(!faulty.reads());
    }
}
