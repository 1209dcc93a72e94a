//! `psd rig jog`: moves the rig by hand, inside the plan's limits, through the guard and never without a yes. In: places as
//! the language writes them. Out: where the rig went.

use std::sync::mpsc::Receiver;

use crate::cli::exit::{Exit, Failure};
use crate::cli::output::{give, tell};
use crate::cli::settings::Settings;
use crate::cli::watch::{Signals, next_line, typed_lines};
use crate::plan::Plan;
use crate::quantity::Dimension;
use crate::quantity::display::{plain, readable};
use crate::quantity::unit;
use crate::rig::{Guard, Rig, RigFault, Wish};

/// How long the rig stays where it is between two looks at what is typed, s of rig time.
const BREATH: f64 = 0.01;

/// What the command line asks for.
pub struct Asked<'a> {
    /// Where to; none: places are typed, one a line.
    pub to: Option<&'a str>,
    pub speed: Option<&'a str>,
    pub yes: bool,
}

/// Moves, asking first on every move.
pub fn jog(rig: &mut dyn Rig, plan: &Plan, asked: &Asked<'_>, wish: &Wish, settings: Settings) -> Result<Exit, Failure> {
    let simulated = rig.identity().simulated;
    if !settings.can_ask && (!asked.yes || !simulated || asked.to.is_none()) {
        let message = if simulated {
            "a move needs a yes, and nobody can be asked"
        } else {
            "a real rig is not moved without a person at a terminal"
        };
        return Err(Failure::command_line(message).help(if simulated {
            "give `--to` and `--yes`"
        } else {
            "start it from a terminal"
        }));
    }
    let to = asked.to.map(|to| number(to, Dimension::LENGTH, "--to", "1 mm")).transpose()?;
    let speed = asked.speed.map(|speed| number(speed, Dimension::VELOCITY, "--speed", "0.5 mm/s")).transpose()?;
    let _signals = Signals::caught(wish).map_err(Failure::Signals)?;
    let mut guard = Guard::of_axes(rig, plan.limits, plan.rig.limits_of_axes(&plan.limits)).map_err(Failure::Rig)?;
    let mut person = Person { lines: None, wish, yes: asked.yes };
    if let Some(to) = to {
        return move_to(&mut guard, to, speed, &mut person);
    }
    loop {
        tell(&format!("  at {}; where to? [a place such as 1 mm, or q] ", here(&guard)));
        let Some(line) = person.line(&mut guard)? else { return Ok(if wish.wants_end() { Exit::Stopped } else { Exit::Met }) };
        match line.trim() {
            "" => {}
            "q" | "quit" => return Ok(Exit::Met),
            place => match number(place, Dimension::LENGTH, "the place", "1 mm") {
                Ok(to) => {
                    move_to(&mut guard, to, speed, &mut person)?;
                }
                Err(failure) => tell(&failure.report(settings)),
            },
        }
        if wish.wants_end() {
            return Ok(Exit::Stopped);
        }
    }
}

/// Who says yes.
struct Person<'a> {
    lines: Option<Receiver<String>>,
    wish: &'a Wish,
    yes: bool,
}

impl Person<'_> {
    /// None at the end of the input and on Ctrl-C. The rig stays where it is meanwhile, and is heard from.
    fn line(&mut self, guard: &mut Guard<'_>) -> Result<Option<String>, Failure> {
        let lines = self.lines.get_or_insert_with(typed_lines);
        next_line(lines, self.wish, || guard.pause(BREATH)).map_err(Failure::Rig)
    }

    /// Only a clear yes is one.
    fn agrees(&mut self, question: &str, guard: &mut Guard<'_>) -> Result<bool, Failure> {
        if self.yes {
            return Ok(true);
        }
        tell(question);
        let line = self.line(guard)?;
        Ok(line.is_some_and(|line| matches!(line.trim().to_ascii_lowercase().as_str(), "y" | "yes")))
    }
}

/// One move, in increments where the plan limits them; Ctrl-C ends it after the increment.
fn move_to(guard: &mut Guard<'_>, to: f64, speed: Option<f64>, person: &mut Person<'_>) -> Result<Exit, Failure> {
    let at = speed.map_or_else(String::new, |speed| format!(" at {}", plain(speed, Dimension::VELOCITY, 4)));
    let question = format!("  move from {} to {}{at}? [y or n] ", here(guard), plain(to, Dimension::LENGTH, 6));
    if !person.agrees(&question, guard)? {
        tell("  nothing moved\n");
        return Ok(Exit::Stopped);
    }
    for target in guard.way_to(&[to]) {
        if person.wish.wants_end() {
            guard.hold();
            tell("  held\n");
            return Ok(Exit::Stopped);
        }
        match guard.move_to(&target, speed) {
            Ok(()) => {}
            // Nothing beyond a limit moves: the person may name another place.
            Err(fault @ RigFault::LimitBreached { .. }) => {
                tell(&format!("  held: {fault}\n"));
                return Ok(Exit::Stopped);
            }
            Err(fault) => return Err(Failure::Rig(fault)),
        }
    }
    let reading = guard.read().map_err(Failure::Rig)?;
    let words = reading.displacement.iter().zip(&reading.force).map(|(displacement, force)| {
        format!("X {}   R {}\n", readable(*displacement, Dimension::LENGTH), readable(*force, Dimension::FORCE))
    });
    give(&words.collect::<String>())?;
    Ok(Exit::Met)
}

fn here(guard: &Guard<'_>) -> String {
    guard.commanded().iter().map(|place| plain(*place, Dimension::LENGTH, 6)).collect::<Vec<_>>().join(", ")
}

/// A number with its unit, as the language writes it: `1 mm`, `-2.5e-1 mm`. In SI.
fn number(text: &str, dimension: Dimension, what: &str, example: &str) -> Result<f64, Failure> {
    let wrong = || Failure::command_line(format!("{what} is not understood: {text}")).help(format!("write it as {example}"));
    let (digits, symbol) = text.trim().split_once(char::is_whitespace).ok_or_else(wrong)?;
    let digits_only = digits.chars().all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E'));
    let value: f64 = digits.parse().ok().filter(|_| digits_only).ok_or_else(wrong)?;
    let unit = unit::parse(symbol.trim()).ok().filter(|unit| unit.dimension == dimension).ok_or_else(wrong)?;
    Some(value * unit.factor).filter(|value| value.is_finite()).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_has_its_unit_and_is_a_number() {
        let place = |text| number(text, Dimension::LENGTH, "--to", "1 mm").ok();
        assert_eq!(place("1 mm"), Some(1e-3));
        assert_eq!(place(" -2.5e1  um "), Some(-2.5e1 * 1e-6));
        for wrong in ["1", "1 N", "mm", "nan mm", "inf mm", "1e400 m", "1 mm 2", "1,5 mm"] {
            assert_eq!(place(wrong), None, "{wrong}");
        }
    }
}
