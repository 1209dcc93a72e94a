//! Logging and replay of motions with readings during the motion: strokes at constant velocity, and smooth paths. INTENT is durable
//! before either begins; each reading is logged before it is used, and STROKE marks the end of the motion.

use std::rc::Rc;

use super::entry::{Call, IntentBody, StrokeBody, TargetStatus};
use super::entry_of::{append_sample, bits, in_log_time, intent, target_text};
use super::recorded_rig::{ContinuousMove, RecordedRig};
use super::state::ended;
use psd_physics::tracking::trajectory::Path;
use psd_rig::journal::EntryKind;
use psd_rig::{CutOff, EachReading, EncodedMove, Rig, RigFault};

impl ContinuousMove<'_> {
    fn intent(&self, samples: usize) -> IntentBody {
        let (targets, speed) = match self {
            Self::Stroke(targets, velocity) => (targets.to_vec(), *velocity),
            Self::Paths(paths) => (
                paths.iter().map(|path| path.to).collect(),
                paths.iter().map(Path::fastest).fold(0.0, f64::max),
            ),
        };
        let encoded = EncodedMove {
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
            ..intent(&targets, Some(speed), &encoded, Some(samples))
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
            Self::Paths(paths) => rig.follow_paths(paths, samples, each),
        }
    }

    /// The rest of it, after it began at `from` \[m\] and some readings were made.
    fn follow_rest(
        &self,
        rig: &mut dyn Rig,
        from: &[f64],
        samples: usize,
        done: usize,
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
            Self::Paths(paths) => rig.resume_paths(paths, samples, done, each),
        }
    }
}

/// A function that moves a rig along a motion, or along the rest of it.
type Goes<'a> = &'a mut dyn FnMut(&mut dyn Rig, EachReading<'_>) -> Result<(), RigFault>;

/// Compares bit by bit.
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

impl RecordedRig<'_> {
    pub(super) fn replay_or_follow(
        &mut self,
        motion: &ContinuousMove<'_>,
        samples: usize,
        each: EachReading<'_>,
    ) -> Result<(), RigFault> {
        let mut intent = motion.intent(samples);
        if self.answers_from_the_log() {
            let recorded: IntentBody = self
                .state
                .borrow_mut()
                .peek(EntryKind::Intent, "a target")?;
            if !same(&recorded, &intent) {
                return Err(self
                    .state
                    .borrow_mut()
                    .report_mismatch(format!("a path {}", target_text(&intent.to, intent.speed))));
            }
            self.state.borrow_mut().consume();
            let Some(done) = self.logged_stroke(samples, each)? else {
                return Ok(());
            };
            let target_status = self.state.borrow_mut().take_target_status();
            let Some(TargetStatus::RemainingMotion { from }) =
                target_status.filter(|_| self.state.borrow().can_continue())
            else {
                return Err(ended());
            };
            return self.follow_recorded(done, each, &mut |rig, each| {
                motion.follow_rest(rig, &from, samples, done, each)
            });
        }
        self.rig()?;
        let target_status = self.state.borrow_mut().take_target_status();
        if let Some(TargetStatus::Stroke { back_to, others }) = target_status {
            let back: Vec<f64> = std::iter::once(back_to).chain(others).collect();
            self.move_back(&back)?;
        }
        self.record_intent(&mut intent)?;
        self.follow_recorded(0, each, &mut |rig, each| motion.follow(rig, samples, each))
    }

    /// Moves back to the start of a stroke that is repeated.
    fn move_back(&mut self, start: &[f64]) -> Result<(), RigFault> {
        let rig = self.rig()?;
        let sent = rig.propose(start, None).and_then(|_| rig.execute());
        sent.or_else(|fault| self.failed(Call::Execute, fault))
    }

    /// Executes a motion and logs its readings; the first `done` readings are in the run log already.
    fn follow_recorded(
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
        // A refusal by the guard or by the run log is not a fault of the rig, and occurs again in the replay.
        let (mut refused, mut readings_done) = (false, done);
        let followed = goes(rig, &mut |reading| {
            let recorded = in_log_time(reading, offset).and_then(|reading| {
                append_sample(&mut state.borrow_mut(), &reading, None)?;
                Ok(reading)
            });
            recorded.and_then(|reading| {
                (refused, readings_done) = (true, readings_done + 1);
                each(reading)?;
                refused = false;
                Ok(())
            })
        });
        match followed {
            Err(fault) if !refused => self.failed(Call::Traverse, fault),
            Err(refusal) => {
                self.state.borrow_mut().sync_point()?;
                Err(refusal)
            }
            Ok(()) => {
                self.count()?;
                let mut state = self.state.borrow_mut();
                let stroke = StrokeBody {
                    t: state.time,
                    samples: readings_done,
                };
                if state.digests() {
                    state.add_to_digest("the end of a stroke", |digest| {
                        digest.stroke(readings_done)
                    })?;
                } else {
                    state.append(EntryKind::Stroke, &stroke)?;
                }
                state.sync_point()
            }
        }
    }
}
