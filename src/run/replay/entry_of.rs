//! Entries of the run log from the answers of a rig: its identity, a target, a reading.

use super::entry::{IntentBody, RigBody, SampleBody, escaped};
use super::state::State;
use psd_rig::controllers::metres;
use psd_rig::journal::EntryKind;
use psd_rig::{DeclaredNoise, EncodedMove, Identity, Reading, Rig, RigFault};

impl RigBody {
    /// The RIG entry of a rig.
    #[must_use]
    pub fn of(rig: &dyn Rig) -> Self {
        Self {
            t: rig.time(),
            identity: rig.identity(),
            axes: rig.degrees_of_freedom(),
            noise: rig.declared_noise(),
            own_speed: rig.own_speed(),
            last_move: rig.last_move(),
            datum: rig.datum(),
            replies: rig
                .introduction()
                .iter()
                .map(|reply| escaped(reply))
                .collect(),
        }
    }
}

/// For a run log that ended before its rig answered.
pub(super) fn unknown_rig() -> RigBody {
    let unknown = String::new;
    let identity = Identity {
        name: unknown(),
        model: unknown(),
        serial: unknown(),
        firmware: unknown(),
        boot: None,
        simulated: true,
    };
    RigBody {
        t: 0.0,
        identity,
        axes: 1,
        noise: DeclaredNoise::NONE,
        own_speed: None,
        last_move: None,
        datum: None,
        replies: Vec::new(),
    }
}

pub(super) fn intent(
    targets: &[f64],
    speed: Option<f64>,
    encoded: &EncodedMove,
    samples: Option<usize>,
) -> IntentBody {
    IntentBody {
        n: 0,
        t: 0.0,
        to: targets.to_vec(),
        speed,
        encoded: (!same_bits(&encoded.targets, targets)).then(|| encoded.targets.clone()),
        rate: encoded.speed,
        wire: (!encoded.wire.is_empty()).then(|| escaped(&encoded.wire)),
        id: encoded.move_id,
        own: encoded.at_the_rig.clone(),
        path: None,
        samples,
        wall: None,
    }
}

impl SampleBody {
    pub(super) fn of(reading: &Reading) -> Self {
        Self {
            t: reading.time,
            x: reading.displacement.clone(),
            r: reading.force.clone(),
            raw: reading.raw.iter().map(|raw| escaped(raw)).collect(),
            moved: None,
            wall: None,
        }
    }

    /// The reading without its bytes, which a replay does not need.
    pub(super) fn into_reading(self) -> Reading {
        Reading {
            time: self.t,
            displacement: self.x,
            force: self.r,
            raw: Vec::new(),
        }
    }
}

pub(super) fn append_sample(
    state: &mut State,
    reading: &Reading,
    moved: Option<[f64; 2]>,
) -> Result<(), RigFault> {
    state.time = reading.time;
    if state.digests() {
        return state.add_to_digest("a reading", |digest| digest.reading(reading, moved));
    }
    let sample = SampleBody {
        moved,
        wall: state.wall(),
        ..SampleBody::of(reading)
    };
    state.append(EntryKind::Sample, &sample)
}

/// A reading that is not a number is a fault of the rig, with the values as received.
fn finite(reading: &Reading) -> Result<(), RigFault> {
    if reading.is_finite() {
        return Ok(());
    }
    let numbers = reading.displacement.iter().chain(&reading.force);
    let numbers: Vec<String> = numbers.map(f64::to_string).collect();
    Err(RigFault::Device(format!(
        "a reading is not a number: {}",
        numbers.join(", ")
    )))
}

/// The same reading, by the clock of the run log.
pub(super) fn in_log_time(mut reading: Reading, offset: f64) -> Result<Reading, RigFault> {
    to_log_time(&mut reading, offset)?;
    Ok(reading)
}

/// A reading becomes that by the clock of the run log.
pub(super) fn to_log_time(reading: &mut Reading, offset: f64) -> Result<(), RigFault> {
    reading.time += offset;
    finite(reading)
}

pub(super) fn same_bits(one: &[f64], other: &[f64]) -> bool {
    one.iter()
        .map(|value| value.to_bits())
        .eq(other.iter().map(|value| value.to_bits()))
}

pub(super) fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// The end of a motion \[m\] and its speed \[m/s\], for a sentence.
pub(super) fn target_text(targets: &[f64], speed: Option<f64>) -> String {
    let speed = speed.map_or_else(String::new, |speed| format!(" at {speed} m/s"));
    format!("to {}{speed}", metres(targets))
}
