//! How long the log of a run becomes: the length of its lines, by type. In: how many lines of each type, and the rig. Out: an upper bound in
//! bytes. The lines of a procedure are counted elsewhere.

use super::{Dialect, Mode, Plan, RealLink};

/// A float as the log writes it, with the separator before the next: sign, 17 digits, point, exponent, comma.
const NUMBER: f64 = 25.0;
/// Number, type, chain and checksum of a line, its spaces and its end.
const LINE: f64 = 96.0;
/// The wall-clock time of a log line.
pub const WALL: f64 = 34.0;
/// The bytes of a target: frames are no longer than 96 bytes.
const WIRE: f64 = 200.0;
/// Bytes that another axis adds to a request or a reply: its target, its position and its force.
const AXIS: f64 = 60.0;
/// A reading that was unusable and was read again, and its TALLY line: one in ten readings.
const MENDED: f64 = 1.1;

/// The header without the plan texts, the pre-test check, events, notes and rig faults.
pub const FRAME: f64 = 131_072.0;
/// The longest log that is read back, in bytes: a log that is never read back verifies nothing.
pub const MOST_RECORD_BYTES: u64 = 4 << 30;

/// Lines of each type.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// INTENT, with those of strokes that are read during the motion.
    pub targets: f64,
    /// INTENT with a path, and STROKE.
    pub ways: f64,
    /// SAMPLE
    pub readings: f64,
    /// STEP, and a row of a table.
    pub steps: f64,
}

impl Counts {
    #[must_use]
    pub fn times(self, count: f64) -> Self {
        Self {
            targets: self.targets * count,
            ways: self.ways * count,
            readings: self.readings * count,
            steps: self.steps * count,
        }
    }

    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            targets: self.targets + other.targets,
            ways: self.ways + other.ways,
            readings: self.readings + other.readings,
            steps: self.steps + other.steps,
        }
    }

    /// Steps of a procedure that integrates, the reading before the first step and the braking after the last.
    #[must_use]
    pub fn stepped(mode: Mode, steps: f64) -> Self {
        let each = match mode {
            Mode::StepAndPause => Self {
                targets: 1.0,
                readings: 1.0,
                steps: 1.0,
                ways: 0.0,
            },
            Mode::Continuous { .. } => Self {
                targets: 2.0,
                ways: 2.0,
                readings: 5.0,
                steps: 1.0,
            },
        };
        each.times(steps).plus(Self {
            targets: 1.0,
            ways: 1.0,
            readings: 5.0,
            steps: 1.0,
        })
    }

    /// Upper bound of the bytes that the lines take.
    #[must_use]
    pub fn bytes(self, plan: &Plan) -> f64 {
        let axes = f64::from(u32::try_from(plan.degrees_of_freedom()).unwrap_or(u32::MAX));
        let (raw, wire) = plan.rig.link.as_real().map_or((0.0, 0.0), |link| {
            (raw(link, axes), WIRE + AXIS * (axes - 1.0) + WALL)
        });
        let target = LINE + wire + 90.0 + NUMBER * (4.0 + 2.0 * axes);
        let path = LINE + 20.0 + 2.0 * NUMBER + 5.0 * axes * (NUMBER + 18.0);
        let reading =
            LINE + 20.0 + NUMBER * (1.0 + 2.0 * axes) + raw + if raw > 0.0 { WALL } else { 0.0 };
        let step = LINE + 8.0 * (NUMBER + 5.0) + (axes - 1.0) * 5.0 * (NUMBER + 5.0);
        self.targets * target
            + self.ways * path
            + MENDED * self.readings * reading
            + self.steps * step
    }
}

/// Bytes of the replies of one reading. The log escapes them twice: a byte that is not a letter takes five.
fn raw(link: &RealLink, axes: f64) -> f64 {
    let reply = |dialect: &Dialect| match dialect {
        Dialect::Modbus(_) => 4.0 * 5.0 * 20.0,
        Dialect::Native => 180.0 + AXIS * (axes - 1.0),
        Dialect::Grbl | Dialect::Nees { .. } => 180.0,
        Dialect::Instron | Dialect::Mark10 => 120.0,
        Dialect::Scpi { newtons_per_unit } => newtons_per_unit.iter().map(|_| 60.0).sum(),
        Dialect::Hx711 | Dialect::Indicator | Dialect::Mark10Gauge => 60.0,
    };
    let devices = link
        .devices()
        .into_iter()
        .map(|(_, device)| reply(&device.dialect));
    f64::from(link.readings.samples.max(1)) * devices.sum::<f64>()
}
