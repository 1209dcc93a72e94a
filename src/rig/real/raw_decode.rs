//! The bytes on the record of a real rig, read back: what its devices were told, what they said, and what a reading is made of. In:
//! bytes as they were sent and heard. Out: the numbers that the rig made of them, by the same steps. It asks nothing, and knows
//! no record.

use super::coordinate::Coordinate;
use super::open::identity_of;
use super::poll::{REREADS, newtons, representative};
use crate::plan::{Calibration, RealLink, RigPlan};
use crate::rig::Identity;
use crate::rig::controllers::{Channel, DeviceIdentity, Heard, Teller};
use crate::rig::safety::failpoint::{Guarding, on};

/// Lines that tell one of several sites of a move: what is proposed to it, and that it is to be executed.
const LINES_OF_A_SITE: usize = 2;

/// The devices of a rig, as far as the bytes so far tell.
pub struct ReadBack<'a> {
    plan: &'a RigPlan,
    link: &'a RealLink,
    calibrations: Vec<Calibration>,
    coordinates: Vec<Coordinate>,
    actuators: Vec<Source<'a>>,
    cells: Vec<Source<'a>>,
    /// Of each device its own clock at its last reading, s.
    clocks: Vec<Option<f64>>,
}

/// A device, and the axes behind it by place.
struct Source<'a> {
    teller: Teller<'a>,
    axes: Vec<usize>,
}

/// One usable reading, in the plan's sign: m and N, one an axis; of each device its own clock, s.
#[derive(Clone, Debug, PartialEq)]
struct Poll {
    displacement: Vec<f64>,
    force: Vec<f64>,
    clocks: Vec<Option<f64>>,
}

/// A way in which replies can be readings: so many of them are taken.
#[derive(Clone, Debug, PartialEq)]
struct Way {
    taken: usize,
    /// Times in a row that all was asked again.
    again: u32,
    polls: Vec<Poll>,
}

/// What every device of a role says at once, one after the other; None: one of them says nothing that can be used.
type Said = (usize, Option<Vec<(Channel, Option<f64>)>>);

impl<'a> ReadBack<'a> {
    #[must_use]
    pub fn of(plan: &'a RigPlan, link: &'a RealLink) -> Self {
        let of_role = |behind: Vec<crate::plan::Behind<'a>>| -> Vec<Source<'a>> {
            behind
                .into_iter()
                .map(|b| Source {
                    teller: Teller::new(&b.link.dialect, b.axes.len()),
                    axes: b.axes,
                })
                .collect()
        };
        let (actuators, cells) = (of_role(link.actuators()), of_role(link.load_cells()));
        let calibrations = (0..plan.axes().unwrap_or(1))
            .map(|axis| plan.calibration_of(axis))
            .collect();
        let coordinates = coordinates(plan, &[]);
        let clocks = vec![None; actuators.len() + cells.len()];
        Self {
            plan,
            link,
            calibrations,
            coordinates,
            actuators,
            cells,
            clocks,
        }
    }

    /// Replies in which its devices say who they are.
    #[must_use]
    pub fn introductions(&self) -> usize {
        self.sources()
            .map(|source| source.teller.introductions())
            .sum()
    }

    /// Who the rig is whose devices say this of themselves; None: they say nothing of the kind.
    pub fn introduced(&mut self, mut replies: &[Vec<u8>]) -> Option<Identity> {
        let (mut moves, mut weighs) = (Vec::new(), Vec::new());
        for (sources, said) in [
            (&mut self.actuators, &mut moves),
            (&mut self.cells, &mut weighs),
        ] {
            for source in sources {
                let (own, rest) = replies.split_at_checked(source.teller.introductions())?;
                said.push(source.teller.introduced(own)?);
                replies = rest;
            }
        }
        let said: Vec<DeviceIdentity> = moves.into_iter().chain(weighs).collect();
        replies
            .is_empty()
            .then(|| identity_of(&self.plan.name, self.link, &said))
    }

    /// The devices are asked anew from here on: their clocks are others. The plan's zero lies at these places of theirs, m, one an
    /// axis; none: at their own.
    pub fn begin(&mut self, datum: &[f64]) {
        self.clocks.fill(None);
        self.coordinates = coordinates(self.plan, datum);
    }

    /// Whether some bytes say a move to these places (m, of the plan) at this speed (m/s), by this number. `own` are the places in the
    /// rig's own coordinate, where that has another zero.
    #[must_use]
    pub fn sent(
        &self,
        wire: &[u8],
        places: &[f64],
        own: Option<&[f64]>,
        speed: f64,
        id: Option<u64>,
    ) -> bool {
        let elsewhere = self.coordinates.iter().any(|axis| axis.datum != 0.0);
        let meant = |own: &[f64]| -> Vec<u64> {
            self.coordinates
                .iter()
                .zip(own)
                .map(|(axis, own)| axis.in_plan(*own).to_bits())
                .collect()
        };
        if own.is_some() != elsewhere
            || own.is_some_and(|own| own.len() != places.len() || meant(own) != bits(places))
        {
            return false;
        }
        let turned = |source: &Source<'_>| -> Option<Vec<f64>> {
            let at_device = |axis: &usize| match own {
                Some(own) => own.get(*axis).copied(),
                None => Some(self.coordinates.get(*axis)?.at_device(*places.get(*axis)?)),
            };
            source.axes.iter().map(at_device).collect()
        };
        let says = |source: &Source<'_>, wire: &[u8]| {
            turned(source).is_some_and(|places| source.teller.sent(wire, &places, speed, id))
        };
        if places.len() != self.calibrations.len() {
            return false;
        }
        match self.actuators.as_slice() {
            [one] => says(one, wire),
            several => {
                let lines: Vec<&[u8]> = wire.split_inclusive(|byte| *byte == b'\n').collect();
                let told = lines.chunks(LINES_OF_A_SITE).map(<[&[u8]]>::concat);
                lines.len() == LINES_OF_A_SITE * several.len()
                    && several
                        .iter()
                        .zip(told)
                        .all(|(source, told)| says(source, &told))
            }
        }
    }

    /// Whether displacements (m) and forces (N) are what is made of these replies, which are those of so many readings, or of one
    /// `on_the_way`.
    ///
    /// # Errors
    /// What the replies do not say.
    pub fn says(
        &mut self,
        replies: &[Vec<u8>],
        samples: usize,
        on_the_way: bool,
        x: &[f64],
        r: &[f64],
    ) -> Result<(), String> {
        if !self.sources().all(|source| source.teller.is_known()) {
            return Ok(());
        }
        let wanted = |way: &Way| way.polls.len() == samples || on_the_way && way.polls.len() == 1;
        let ways: Vec<Way> = self.ways(replies).into_iter().filter(wanted).collect();
        let mut judged = Err("the bytes that came are not those of its readings".to_owned());
        for way in &ways {
            judged = made_of(&way.polls, x, r).and_then(|()| self.run_on(&way.polls));
            if judged.is_ok() {
                if let Some(last) = way.polls.last() {
                    self.clocks.clone_from(&last.clocks);
                }
                break;
            }
        }
        judged
    }

    fn sources(&self) -> impl Iterator<Item = &Source<'a>> {
        self.actuators.iter().chain(&self.cells)
    }

    /// A device's own clock goes forward only.
    fn run_on(&self, polls: &[Poll]) -> Result<(), String> {
        let mut before = self.clocks.clone();
        for poll in polls {
            for (before, now) in before.iter_mut().zip(&poll.clocks) {
                if now.zip(*before).is_some_and(|(now, before)| now < before) {
                    return Err(
                        "a reply is older than the one before it, by the rig's own clock"
                            .to_owned(),
                    );
                }
                *before = now.or(*before);
            }
        }
        Ok(())
    }

    /// Every way in which all of these replies are readings.
    fn ways(&self, replies: &[Vec<u8>]) -> Vec<Way> {
        let mut open = vec![Way {
            taken: 0,
            again: 0,
            polls: Vec::new(),
        }];
        let (mut seen, mut whole) = (open.clone(), Vec::new());
        while let Some(way) = open.pop() {
            if way.taken == replies.len() {
                if way.again == 0 && !way.polls.is_empty() {
                    whole.push(way);
                }
                continue;
            }
            for next in self.attempts(&way, replies) {
                if next.again <= REREADS && !seen.contains(&next) {
                    seen.push(next.clone());
                    open.push(next);
                }
            }
        }
        whole
    }

    /// What can become of the next time that all devices are asked.
    fn attempts(&self, way: &Way, replies: &[Vec<u8>]) -> Vec<Way> {
        let again = |taken| Way {
            taken,
            again: way.again + 1,
            polls: way.polls.clone(),
        };
        let mut found = Vec::new();
        for (after_moved, moved) in said_by(&self.actuators, replies, way.taken) {
            let Some(moved) = moved else {
                found.push(again(after_moved));
                continue;
            };
            for (taken, weighed) in said_by(&self.cells, replies, after_moved) {
                match weighed.map(|weighed| self.poll(&moved, &weighed)) {
                    None | Some(Some(None)) => found.push(again(taken)),
                    Some(Some(Some(poll))) => {
                        let polls = way.polls.iter().cloned().chain([poll]).collect();
                        found.push(Way {
                            taken,
                            again: 0,
                            polls,
                        });
                    }
                    Some(None) => {}
                }
            }
        }
        found
    }

    /// The reading that channels of all devices make, `Some(None)` where it is one to be asked for again; None: they make none.
    #[expect(
        clippy::option_option,
        reason = "no reading and one that is asked for again are different things here"
    )]
    fn poll(
        &self,
        moved: &[(Channel, Option<f64>)],
        weighed: &[(Channel, Option<f64>)],
    ) -> Option<Option<Poll>> {
        let channel_of = |sources: &[Source<'_>], said: &[(Channel, Option<f64>)], axis: usize| {
            let places = sources
                .iter()
                .flat_map(|source| source.axes.iter().copied());
            places
                .zip(said)
                .find(|(place, _)| *place == axis)
                .map(|(_, (channel, _))| *channel)
        };
        let clocks = |sources: &[Source<'_>], said: &[(Channel, Option<f64>)]| {
            let mut first = 0;
            let of = |source: &Source<'_>| {
                let clock = said.get(first).and_then(|(_, clock)| *clock);
                first += source.axes.len();
                clock
            };
            sources.iter().map(of).collect::<Vec<_>>()
        };
        let (mut displacement, mut force, mut usable) = (Vec::new(), Vec::new(), true);
        for (axis, calibration) in self.calibrations.iter().enumerate() {
            let (coordinate, moved) = (
                self.coordinates.get(axis)?,
                channel_of(&self.actuators, moved, axis)?,
            );
            let weighed = channel_of(&self.cells, weighed, axis).unwrap_or(moved);
            let (x, r) = (moved.displacement?, newtons(calibration, weighed.force?)?);
            usable &= !on(Guarding::Invalid)
                || x.is_finite() && r.is_finite() && !moved.flags.stale && !weighed.flags.stale;
            displacement.push(coordinate.in_plan(x));
            force.push(coordinate.turned(r));
        }
        let clocks = [clocks(&self.actuators, moved), clocks(&self.cells, weighed)].concat();
        Some(usable.then_some(Poll {
            displacement,
            force,
            clocks,
        }))
    }
}

/// Of each axis, with the plan's zero at these places of the devices, m; none: at their own.
fn coordinates(plan: &RigPlan, datum: &[f64]) -> Vec<Coordinate> {
    let of = |axis| Coordinate {
        datum: datum.get(axis).copied().unwrap_or(0.0),
        ..Coordinate::of_sign(plan.sign_of(axis))
    };
    (0..plan.axes().unwrap_or(1)).map(of).collect()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// What the devices of a role can have said from this reply on: where what follows begins, and the channel of each axis behind them
/// in their order, with its device's clock.
fn said_by(sources: &[Source<'_>], replies: &[Vec<u8>], from: usize) -> Vec<Said> {
    let mut said: Vec<Said> = vec![(from, Some(Vec::new()))];
    let mut missed = false;
    for source in sources {
        // The one that says nothing usable is alone on record: what others had said before it is not kept.
        missed |= source
            .teller
            .hears(&replies[from..])
            .contains(&Heard::NoReading);
        let further = |(at, channels): &Said| {
            let (at, channels) = (*at, channels.clone().unwrap_or_default());
            let heard = source
                .teller
                .hears(replies.get(at..).unwrap_or_default())
                .into_iter();
            heard.filter_map(move |heard| match heard {
                Heard::Reading { replies, sample } => {
                    let own: Vec<(Channel, Option<f64>)> = sample
                        .axes()
                        .map(|channel| (channel, sample.time))
                        .collect();
                    Some((at + replies, Some([channels.clone(), own].concat())))
                }
                Heard::NoReading => None,
            })
        };
        said = said.iter().flat_map(further).collect();
    }
    said.extend(missed.then_some((from + 1, None)));
    said
}

/// Whether the numbers are what readings make, bit for bit.
fn made_of(polls: &[Poll], x: &[f64], r: &[f64]) -> Result<(), String> {
    let of = |axis: usize, of: fn(&Poll) -> &[f64]| -> Option<f64> {
        let values: Option<Vec<f64>> = polls
            .iter()
            .map(|poll| of(poll).get(axis).copied())
            .collect();
        values.map(representative)
    };
    let axes = polls.first().map_or(0, |poll| poll.displacement.len());
    if [x.len(), r.len()] != [axes; 2] {
        return Err(format!("the bytes that came are of {axes} axes"));
    }
    for (axis, (x, r)) in x.iter().zip(r).enumerate() {
        if of(axis, |poll| &poll.displacement).map(f64::to_bits) != Some(x.to_bits()) {
            return Err(format!("the bytes that came do not say {x} m"));
        }
        if of(axis, |poll| &poll.force).map(f64::to_bits) != Some(r.to_bits()) {
            return Err(format!("the bytes that came do not say {r} N"));
        }
    }
    Ok(())
}
