//! The words of a fault in a script: `drop replies 3`, `freeze force`. In: words. Out: the fault, or the reason why it is none. It
//! knows no time.

use super::words::Words;
use super::{GarbagePosition, LineFault, ReplyFault, What};
use crate::emulator::emulated_rig::fault::MechanicalFault;

/// The fault that these words name.
pub(super) fn what(words: &mut Words<'_>) -> Result<What, String> {
    let verb = words.next()?;
    let reply = |words: &mut Words<'_>, fault| Ok(What::Replies(fault, words.replies()?));
    match verb {
        "drop" => reply(words, ReplyFault::Drop),
        "repeat" => reply(words, ReplyFault::Repeat),
        "replay" => reply(words, ReplyFault::Replay),
        "split" => {
            let replies = words.replies()?;
            let at = words.next()?;
            let bytes = words.bytes()?;
            match at {
                "at" => Ok(What::Replies(ReplyFault::SplitAt(bytes), replies)),
                "every" if bytes > 0 => Ok(What::Replies(ReplyFault::SplitEvery(bytes), replies)),
                _ => Err("write `at 5 bytes` or `every 5 bytes`".to_owned()),
            }
        }
        "cut" => {
            let replies = words.replies()?;
            words.expect("at")?;
            Ok(What::Replies(ReplyFault::CutAt(words.bytes()?), replies))
        }
        "delay" => {
            let replies = words.replies()?;
            let seconds = words.amount("s")?;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "bounded, and not negative"
            )]
            let milliseconds = (seconds.clamp(0.0, 1e6) * 1e3) as u64;
            Ok(What::Replies(ReplyFault::Delay(milliseconds), replies))
        }
        "flip" => {
            let bit = if words.take(&["a", "bit"]) {
                None
            } else {
                words.expect("bit")?;
                Some(words.size()?)
            };
            let replies = if words.take(&["of"]) {
                words.replies()?
            } else {
                Some(1)
            };
            Ok(What::Replies(ReplyFault::FlipBit(bit), replies))
        }
        "garbage" | "fill" => {
            let count = words.bytes()?;
            let byte = if verb == "fill" {
                words.expect("of")?;
                let word = words.next()?;
                Some(
                    u8::from_str_radix(word, 16)
                        .map_err(|_| format!("`{word}` is not a hexadecimal byte"))?,
                )
            } else {
                None
            };
            let position = match words.next()? {
                "before" => GarbagePosition::Before,
                "inside" => GarbagePosition::Inside,
                "after" => GarbagePosition::After,
                other => {
                    return Err(format!(
                        "`{other}` is invalid: write before, inside or after"
                    ));
                }
            };
            let replies = if words.ended() {
                Some(1)
            } else {
                words.replies()?
            };
            Ok(What::Replies(
                ReplyFault::Garbage {
                    count,
                    byte,
                    position,
                },
                replies,
            ))
        }
        "hang" => {
            words.expect("up")?;
            if words.take(&["before", "reply"]) {
                Ok(What::Replies(ReplyFault::HangUpBefore, Some(1)))
            } else if words.take(&["after", "reply"]) {
                Ok(What::Replies(ReplyFault::HangUpAfter, Some(1)))
            } else {
                Ok(What::Line(LineFault::HangUp))
            }
        }
        "reboot" => Ok(What::Line(LineFault::Reboot)),
        "stop" => {
            words.expect("reading")?;
            Ok(What::Line(LineFault::StopReading))
        }
        "freeze" if words.take(&["firmware"]) => {
            Ok(What::Line(LineFault::FreezeFirmware(words.amount("s")?)))
        }
        _ => mechanical_fault(verb, words).map(What::Rig),
    }
}

fn mechanical_fault(verb: &str, words: &mut Words<'_>) -> Result<MechanicalFault, String> {
    match verb {
        "freeze" => match words.next()? {
            "force" => Ok(MechanicalFault::FreezeForce),
            "displacement" => Ok(MechanicalFault::FreezeDisplacement),
            other => Err(format!(
                "`{other}` cannot freeze: write firmware, force or displacement"
            )),
        },
        "scale" => {
            let of = words.next()?;
            words.expect("by")?;
            let factor = words.number()?;
            match of {
                "force" => Ok(MechanicalFault::ScaleForce(factor)),
                "displacement" => Ok(MechanicalFault::ScaleDisplacement(factor)),
                other => Err(format!(
                    "`{other}` cannot be scaled: write force or displacement"
                )),
            }
        }
        "clip" => {
            words.expect("force")?;
            words.expect("at")?;
            Ok(MechanicalFault::ClipForce(words.amount("N")?))
        }
        "drift" => {
            let of = words.next()?;
            match of {
                "force" => Ok(MechanicalFault::Drift(words.amount("N/s")?)),
                "displacement" => Ok(MechanicalFault::DriftDisplacement(
                    words.amount("mm/s")? * 1e-3,
                )),
                other => Err(format!(
                    "`{other}` cannot drift: write force or displacement"
                )),
            }
        }
        "spike" => Ok(MechanicalFault::Spike(words.amount("N")?)),
        "number" => Ok(MechanicalFault::Number(
            words.next()?.trim_matches('"').to_owned(),
        )),
        "reach" => Ok(MechanicalFault::Reach(words.amount("%")? / 100.0)),
        "stick" => Ok(MechanicalFault::Reach(0.0)),
        "lag" => Ok(MechanicalFault::Lag(words.amount("s")?)),
        "coast" => Ok(MechanicalFault::Coast(words.amount("s")?)),
        "fracture" => {
            words.expect("at")?;
            let displacement = words.amount("mm")? * 1e-3;
            words.expect("to")?;
            Ok(MechanicalFault::Fracture {
                displacement,
                left: words.amount("%")? / 100.0,
            })
        }
        other => Err(format!("unknown fault `{other}`")),
    }
}
