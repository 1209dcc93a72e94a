//! A Mark-10 gauge alone on its port. In: nothing. Out: a force, as often as it is asked. It moves nothing: what moves it is
//! `mark10`'s, or another device's.

use super::driver::newtons;
use crate::rig::Tally;
use crate::rig::controllers::mark10;
use crate::rig::controllers::unsequenced::ask_line;
use crate::rig::controllers::{DeviceFault, DeviceIdentity, Gauge, Sample, Talk};

/// The gauge at the other end of a line.
pub struct Mark10Gauge {
    talk: Talk,
}

impl Mark10Gauge {
    #[must_use]
    pub const fn new(talk: Talk) -> Self {
        Self { talk }
    }
}

impl Gauge for Mark10Gauge {
    fn identify(&mut self) -> Result<DeviceIdentity, DeviceFault> {
        self.sample()?;
        Ok(introduced())
    }

    fn sample(&mut self) -> Result<Sample, DeviceFault> {
        weighed(ask_line(
            &mut self.talk,
            mark10::codec::ASK_FORCE,
            mark10::codec::ENDING,
        )?)
    }

    fn tally(&self) -> Tally {
        self.talk.tally()
    }
}

/// Who answers as a gauge.
pub(crate) fn introduced() -> DeviceIdentity {
    DeviceIdentity {
        model: "Mark-10 gauge".to_owned(),
        ..DeviceIdentity::default()
    }
}

/// The force of its answer.
pub(crate) fn weighed(said: Vec<u8>) -> Result<Sample, DeviceFault> {
    let force = newtons(&said)?;
    Ok(Sample {
        force: Some(force),
        raw: vec![said],
        ..Sample::default()
    })
}
