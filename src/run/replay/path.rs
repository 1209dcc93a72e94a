//! Ways that are read on the way, on record: strokes at one velocity, and smooth paths. INTENT is durable before either
//! begins; each reading is on record before it is used, and STROKE says that the way came to its end.

use std::rc::Rc;

use super::continuous_move::ContinuousMove;
use super::entry::{Call, Doubt, IntentBody, StrokeBody};
use super::rig::{TapedRig, append_sample, bits, finite, intent};
use super::state::ended;
use crate::physics::tracking::trajectory::Path;
use crate::record::journal::EntryKind;
use crate::rig::{CutOff, EachReading, Offer, Reading, Rig, RigFault};

impl ContinuousMove<'_> {
    fn intent(&self, samples: usize) -> IntentBody {
        let (targets, speed) = match self {
            Self::Stroke(targets, velocity) => (targets.to_vec(), *velocity),
            Self::Paths(paths) => (
                paths.iter().map(|path| path.to).collect(),
                paths.iter().map(Path::fastest).fold(0.0, f64::max),
            ),
        };
        let offer = Offer {
            targets: targets.clone(),
            speed,
            wire: Vec::new(),
            move_id: None,
            at_the_rig: None,
        };
        let path = match self {
            Self::Stroke(..) => None,
            Self::Paths(paths) => Some(paths.to_vec()),
        };
        IntentBody {
            path,
            ..intent(&targets, Some(speed), &offer, Some(samples))
        }
    }

    fn follow(
        &self,
        rig: &mut dyn Rig,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        match self {
            Self::Stroke(targets, velocity) => rig.traverse(targets, *velocity, samples, each),
            Self::Paths(paths) => rig.glide(paths, samples, each),
        }
    }

    /// What is left of it, where it began at `from` (m) and some readings are done.
    fn go_on(
        &self,
        rig: &mut dyn Rig,
        from: &[f64],
        (samples, done): (usize, usize),
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        match self {
            Self::Stroke(targets, velocity) => rig.traverse_on(
                &CutOff {
                    from,
                    to: targets,
                    samples,
                    done,
                },
                *velocity,
                each,
            ),
            Self::Paths(paths) => rig.glide_on(paths, samples, done, each),
        }
    }
}

/// How a rig goes a way, or what is left of it.
type Goes<'a> = &'a mut dyn FnMut(&mut dyn Rig, EachReading<'_>) -> Result<(), RigFault>;

/// Bit for bit.
fn same(one: &IntentBody, other: &IntentBody) -> bool {
    let numbers = |intent: &IntentBody| {
        let paths = intent.path.iter().flatten();
        let of = |path: &Path| {
            [
                path.from,
                path.to,
                path.start_velocity,
                path.end_velocity,
                path.seconds,
            ]
        };
        bits(
            &paths
                .flat_map(of)
                .chain(intent.to.iter().copied())
                .chain(intent.speed)
                .collect::<Vec<f64>>(),
        )
    };
    one.path.is_some() == other.path.is_some()
        && one.samples == other.samples
        && numbers(one) == numbers(other)
}

impl TapedRig<'_> {
    pub(super) fn take_way(
        &mut self,
        way: &ContinuousMove<'_>,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let mut intent = way.intent(samples);
        if self.playing() {
            let recorded: IntentBody = self
                .state
                .borrow_mut()
                .peek(EntryKind::Intent, "a target")?;
            if !same(&recorded, &intent) {
                return Err(self.state.borrow_mut().disagrees(format!(
                    "a way to {:?} m at {:?} m/s",
                    intent.to, intent.speed
                )));
            }
            self.state.borrow_mut().consume();
            let Some(done) = self.played_stroke(samples, each)? else {
                return Ok(());
            };
            let doubt = self.state.borrow_mut().take_doubt();
            let Some(Doubt::RestOfTheWay { from }) =
                doubt.filter(|_| self.state.borrow().goes_on())
            else {
                return Err(ended());
            };
            return self.go_way(done, each, &mut |rig, each| {
                way.go_on(rig, &from, (samples, done), each)
            });
        }
        self.rig()?;
        let doubt = self.state.borrow_mut().take_doubt();
        if let Some(Doubt::Stroke { back_to, others }) = doubt {
            let back: Vec<f64> = std::iter::once(back_to).chain(others).collect();
            self.send_again(&back, None)?;
        }
        self.record_intent(&mut intent)?;
        self.go_way(0, each, &mut |rig, each| way.follow(rig, samples, each))
    }

    /// Goes a way and records its readings, the first `done` of which are on record.
    fn go_way(
        &mut self,
        done: usize,
        each: EachReading<'_>,
        goes: Goes<'_>,
    ) -> Result<(), RigFault> {
        self.rig()?;
        let (offset, state) = (self.offset.unwrap_or(0.0), Rc::clone(&self.state));
        let Some(rig) = self.live() else {
            return Err(ended());
        };
        // A refusal of the guard, or of the record, is not the rig's fault, and comes out again when the record is played.
        let (mut refused, mut taken) = (false, done);
        let followed = goes(rig, &mut |reading| {
            let recorded = finite(Reading {
                time: reading.time + offset,
                ..reading
            })
            .and_then(|reading| {
                append_sample(&mut state.borrow_mut(), &reading, None)?;
                Ok(reading)
            });
            recorded.and_then(|reading| {
                (refused, taken) = (true, taken + 1);
                each(reading)?;
                refused = false;
                Ok(())
            })
        });
        match followed {
            Err(fault) if !refused => self.failed(Call::Traverse, fault),
            Err(refusal) => {
                self.state.borrow_mut().promise()?;
                Err(refusal)
            }
            Ok(()) => {
                self.count()?;
                let mut state = self.state.borrow_mut();
                let stroke = StrokeBody {
                    t: state.time,
                    samples: taken,
                };
                state.append(EntryKind::Stroke, &stroke)?;
                state.promise()
            }
        }
    }
}
