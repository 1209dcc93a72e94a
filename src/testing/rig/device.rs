//! A device that moves uniformly on a virtual clock and loads a spring, with faults on demand. In: moves, and a script of
//! faults. Out: samples. Its bytes have no meaning.

use std::sync::{Arc, Mutex, MutexGuard};

use super::VirtualClock;
use psd_plan::Limits;
use psd_rig::controllers::{
    Channel, Device, DeviceFault, DeviceIdentity, DeviceMove, Force, Sample,
};
use psd_rig::transport::Clock as _;
use psd_rig::{LastMove, LineStatistics};

/// Alteration of the n-th sample, counted from 0, before it is returned.
pub type Alteration = Box<dyn FnMut(u64, &mut Sample) -> Result<(), DeviceFault> + Send>;

/// The state and the history of the device; a test can read and set it at any time.
pub struct Inside {
    pub identity: DeviceIdentity,
    /// \[m\]
    pub position: f64,
    pub target: f64,
    /// \[m/s\]
    pub speed: f64,
    /// \[N/m\]
    pub stiffness: f64,
    /// Force as raw counts: scale factor \[N per count\].
    pub newtons_per_count: Option<f64>,
    /// Fraction of a target that the device reaches: 1 arrives.
    pub reaches: f64,
    /// Added to a target when it is encoded \[m\].
    pub misspoken: f64,
    /// Whether the device reports that it moves.
    pub reports_motion: bool,
    /// Duration of every reply \[s\].
    pub answer_time: f64,
    pub alter: Option<Alteration>,
    pub samples: u64,
    /// Targets of the moves that were started \[m\].
    pub started: Vec<f64>,
    pub holds: u32,
    /// The device ignores the hold command.
    pub deaf: bool,
    pub narrowed: Option<Limits>,
    pub last_move: Option<LastMove>,
    /// \[s\]
    time: f64,
}

/// All clones share one state.
#[derive(Clone)]
pub struct FakeDevice {
    clock: VirtualClock,
    inside: Arc<Mutex<Inside>>,
}

impl FakeDevice {
    /// At zero on a spring of 1e5 N/m, without faults.
    #[must_use]
    pub fn new(clock: &VirtualClock) -> Self {
        let identity = DeviceIdentity {
            model: "fake".to_owned(),
            serial: "F-1".to_owned(),
            ..DeviceIdentity::default()
        };
        let inside = Inside {
            identity,
            position: 0.0,
            target: 0.0,
            speed: 0.0,
            stiffness: 1e5,
            newtons_per_count: None,
            reaches: 1.0,
            misspoken: 0.0,
            reports_motion: true,
            answer_time: 0.01,
            alter: None,
            samples: 0,
            started: Vec::new(),
            holds: 0,
            deaf: false,
            narrowed: None,
            last_move: None,
            time: clock.now(),
        };
        Self {
            clock: clock.clone(),
            inside: Arc::new(Mutex::new(inside)),
        }
    }

    /// The present state of the device.
    pub fn inside(&self) -> MutexGuard<'_, Inside> {
        let mut inside = self.inside.lock().unwrap();
        let travel = inside.speed * (self.clock.now() - inside.time);
        let left = inside.target - inside.position;
        inside.position = if left.abs() <= travel {
            inside.target
        } else {
            inside.position + travel.copysign(left)
        };
        inside.time = self.clock.now();
        inside
    }

    /// Alters the samples from now on, counted from 0.
    pub fn alter(
        &self,
        alter: impl FnMut(u64, &mut Sample) -> Result<(), DeviceFault> + Send + 'static,
    ) {
        let mut inside = self.inside();
        inside.samples = 0;
        inside.alter = Some(Box::new(alter));
    }
}

impl Device for FakeDevice {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        Ok(self.inside().identity.clone())
    }

    fn encode(&mut self, targets: &[f64], speed: f64) -> Result<DeviceMove, DeviceFault> {
        let target = targets[0] + self.inside().misspoken;
        Ok(DeviceMove {
            frames: vec![format!("{target} {speed}").into_bytes()],
            targets: vec![target],
            speed,
            id: None,
        })
    }

    fn start(&mut self, going: &DeviceMove) -> Result<(), DeviceFault> {
        let mut inside = self.inside();
        inside.started.push(going.targets[0]);
        inside.target = going.targets[0] * inside.reaches;
        inside.speed = going.speed;
        Ok(())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        let answer_time = self.inside().answer_time;
        self.clock.advance(answer_time);
        let mut inside = self.inside();
        let force = inside.stiffness * inside.position;
        let force = inside
            .newtons_per_count
            .map_or(Force::Newtons(force), |factor| {
                #[expect(clippy::cast_possible_truncation, reason = "a test's force")]
                let count = (force / factor).round() as i64;
                Force::Counts {
                    count,
                    low: -8_388_608,
                    high: 8_388_607,
                }
            });
        let axis = Channel {
            displacement: Some(inside.position),
            force: Some(force),
            ..Channel::default()
        };
        let mut sample = Sample {
            time: Some(inside.time),
            channels: vec![axis],
            moving: inside
                .reports_motion
                .then(|| inside.position != inside.target),
            raw: vec![format!("sample {}", inside.samples).into_bytes()],
        };
        let number = inside.samples;
        inside.samples += 1;
        // The script may read the state.
        let Some(mut alter) = inside.alter.take() else {
            return Ok(sample);
        };
        drop(inside);
        let altered = alter(number, &mut sample);
        self.inside().alter.get_or_insert(alter);
        altered.map(|()| sample)
    }

    fn hold(&mut self) -> Result<(), DeviceFault> {
        let mut inside = self.inside();
        inside.holds += 1;
        if inside.deaf {
            return Err(DeviceFault::Silent {
                seconds: 2.805_577_968_000_001_5,
            });
        }
        inside.target = inside.position;
        Ok(())
    }

    fn emergency(&self) -> Vec<u8> {
        b"!".to_vec()
    }

    fn narrow_limits(&mut self, limits: &[Limits]) -> Result<(), DeviceFault> {
        self.inside().narrowed = Some(limits[0]);
        Ok(())
    }

    fn last_move(&self) -> Option<LastMove> {
        self.inside().last_move.clone()
    }

    fn line_statistics(&self) -> LineStatistics {
        LineStatistics::default()
    }
}
