//! The rig of a checked plan: connection, declared uncertainties, limits, reading rules. It is
//! data: no port is opened here.

pub mod axis;
pub mod axis_names;
pub mod devices;
mod dialect;
pub mod limits;

use super::{AxisPlan, Interval};
pub use dialect::{Abilities, Dialect, ModbusMap, ModbusNumber};
pub use psd_physics::reintegration::perturbation::{BelowRange, ReadingErrors};

/// The rig of a run, as the plan specifies it.
#[derive(Clone, Debug, PartialEq)]
pub struct RigPlan {
    /// `ideal` if the plan declares no rig.
    pub name: String,
    pub link: Link,
    pub settle: Settle,
    /// Polarity, the factor on displacement and force: +1 or −1.
    pub polarity: f64,
    pub calibration: Calibration,
    /// Allowed zero drift in a run; None: it is not checked.
    pub zero_drift: Option<DriftCheck>,
    /// The axes that a virtual rig lists: their limits, and the axial axes after all others. Empty for a real rig, whose link has its axes.
    pub simulated_axes: Vec<AxisPlan>,
}

impl RigPlan {
    /// Actuators with their load cells; a virtual rig has as many as its specimen has degrees of freedom.
    #[must_use]
    pub fn axes(&self) -> Option<usize> {
        self.link.as_real().map(|link| link.axes.len().max(1))
    }

    /// Resolution of a force reading \[N\]; 0 if none is known.
    #[must_use]
    pub fn force_resolution(&self) -> f64 {
        match &self.link {
            Link::Virtual(link) => link.force_resolution,
            Link::Real(_) => self.calibration.newtons_per_count.unwrap_or(0.0).abs(),
        }
    }
}

impl RigPlan {
    /// The same rig, with the zero of the plan's displacements from the log of an earlier session \[m\], one for each axis. None: the
    /// zero of the plan.
    #[must_use]
    pub fn with_recorded_datum(&self, positions: Option<&[f64]>) -> Self {
        let mut rig = self.clone();
        if let (Link::Real(link), Some(positions)) = (&mut rig.link, positions) {
            link.datum = Datum::At(positions.to_vec());
        }
        rig
    }
}

/// How the program is connected to the rig.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a plan has one")]
pub enum Link {
    Virtual(VirtualLink),
    Real(RealLink),
}

impl Link {
    /// The virtual link, if no real actuator moves.
    #[must_use]
    pub const fn as_virtual(&self) -> Option<&VirtualLink> {
        match self {
            Self::Virtual(link) => Some(link),
            Self::Real(_) => None,
        }
    }

    /// The real link.
    #[must_use]
    pub const fn as_real(&self) -> Option<&RealLink> {
        match self {
            Self::Real(link) => Some(link),
            Self::Virtual(_) => None,
        }
    }
}

/// Errors that a virtual rig adds to its specimen. All zero: an ideal rig.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct VirtualLink {
    /// Standard deviation of the load cell \[N\].
    pub noise: f64,
    /// Resolution of the displacement reading \[m\].
    pub resolution: f64,
    /// Resolution of the force reading \[N\].
    pub force_resolution: f64,
    /// First-order time constant of the actuator \[s\].
    pub lag: f64,
    /// Fraction of each increment not reached.
    pub tracking: f64,
    /// Zero drift of the load cell \[N/s\] in laboratory time.
    pub drift: f64,
    pub seed: u64,
    /// For a simulation on an ideal rig: the reading errors that another rig declares. The simulated readings contain none of them; the
    /// predicted uncertainty contains all.
    pub predicted: Option<ReadingErrors>,
}

impl VirtualLink {
    /// Whether every reading at rest is the target and the force there: the sensors have no errors, and the actuators reach their targets
    /// without lag.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        let errors = [
            self.noise,
            self.resolution,
            self.force_resolution,
            self.lag,
            self.tracking,
            self.drift,
        ];
        errors.iter().all(|error| *error == 0.0)
    }

    /// An ideal rig instead of another: its readings have no errors, and the predicted uncertainty includes the errors that the other
    /// declares.
    #[must_use]
    pub fn ideal_of(rig: &RigPlan) -> Self {
        let force_resolution = rig.force_resolution();
        let (seed, predicted) = match &rig.link {
            Link::Virtual(link) => {
                let Self {
                    seed,
                    noise,
                    resolution,
                    ..
                } = *link;
                (
                    seed,
                    ReadingErrors {
                        noise,
                        resolution,
                        force_resolution,
                    },
                )
            }
            Link::Real(link) => {
                let axes = || (0..link.lateral_axes()).map(|axis| link.readings_of(axis));
                let noise = axes().map(|rules| rules.noise).fold(0.0, f64::max);
                let resolution = axes().map(|rules| rules.resolution).fold(0.0, f64::max);
                (
                    0,
                    ReadingErrors {
                        noise,
                        resolution,
                        force_resolution,
                    },
                )
            }
        };
        Self {
            seed,
            predicted: Some(predicted),
            ..Self::default()
        }
    }
}

/// Speed of a virtual rig if none is specified \[m/s\]: the speed of a slow quasi-static test.
pub const VIRTUAL_SPEED: f64 = 1e-3;

/// The conditions for a settled reading. A zero band means that a reading is valid immediately.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Largest deviation of the displacement from the target \[m\].
    pub band: f64,
    /// abs(dF/dt) stays below this \[N/s\].
    pub force_rate: f64,
    /// Time for which both conditions must be satisfied \[s\].
    pub dwell: f64,
    /// Longest wait \[s\]; after it the rig holds and the run is aborted.
    pub timeout: f64,
}

/// Allowed zero drift of a rig in a run, and how the zero is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftCheck {
    /// Change of the force at zero load, absolute value \[N\].
    pub force: f64,
    /// Change of the displacement reading against its target, absolute value \[m\]; None: it is reported and not assessed.
    pub displacement: Option<f64>,
    /// Time over which a zero is read \[s\]; a dwell of this length shows a slope.
    pub over: f64,
    pub after: ZeroAfter,
}

/// The condition at the end of a run under which the force is known again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZeroAfter {
    /// At the position where the run began, with the specimen unchanged there.
    Start,
    /// With the specimen removed from the load cell by the operator.
    Free,
    /// None: only changes that neither load nor relaxation can cause are assessed.
    Nowhere,
}

impl ZeroAfter {
    /// The keyword of the language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Free => "free",
            Self::Nowhere => "nowhere",
        }
    }
}

/// The calibrations of a rig.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Calibration {
    /// Calibration reference, if given; only of the force if `displacement` has a separate one.
    pub reference: Option<String>,
    /// Calibration due date, `YYYY-MM-DD`, if given.
    pub due: Option<String>,
    /// Class of the force measurement, as stated.
    pub force_class: Option<String>,
    /// Forces for which the calibration is valid, absolute value \[N\].
    pub force_calibrated: Option<Interval>,
    /// Calibration reference and due date of the displacement, if they are separate.
    pub displacement: Option<(String, Option<String>)>,
    /// Class of the displacement measurement, as stated.
    pub displacement_class: Option<String>,
    /// Displacements for which the calibration is valid, absolute value \[m\].
    pub displacement_calibrated: Option<Interval>,
    /// For a load cell that returns raw counts: the scale factor \[N per count\], with the polarity of the cell.
    pub newtons_per_count: Option<f64>,
    /// Zero offset: the count at zero force.
    pub zero_offset: f64,
    /// Standard uncertainty of the scale factor of the force, relative; 0 if none is stated.
    pub force_uncertainty: f64,
    /// Standard uncertainty of the scale factor of the displacement, relative.
    pub displacement_uncertainty: f64,
    /// Standard uncertainty of the zero reading of the force \[N\].
    pub zero_uncertainty: f64,
    /// Standard uncertainty of the zero drift in a run for which conformity is stated: the bound over √3 \[N\].
    pub zero_drift: f64,
}

impl Calibration {
    /// Standard uncertainty of the zero of the force at any time of a run \[N\].
    #[must_use]
    pub fn zero(&self) -> f64 {
        self.zero_uncertainty.hypot(self.zero_drift)
    }

    /// Standard uncertainty of the forces below their calibrated range.
    #[must_use]
    pub fn force_below(&self) -> BelowRange {
        below(self.force_calibrated, self.force_uncertainty)
    }

    /// Standard uncertainty of the displacements below their calibrated range.
    #[must_use]
    pub fn displacement_below(&self) -> BelowRange {
        below(self.displacement_calibrated, self.displacement_uncertainty)
    }
}

/// None without a range, or with one that begins at zero.
fn below(calibrated: Option<Interval>, error: f64) -> BelowRange {
    calibrated.map_or_else(BelowRange::default, |range| BelowRange {
        end: range.low,
        error,
        ..BelowRange::default()
    })
}

/// A rig that moves a real specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct RealLink {
    /// The actuator, which also measures the force if there is no separate cell.
    pub actuator: DeviceLink,
    pub load_cell: Option<DeviceLink>,
    pub safe_state: SafeState,
    pub datum: Datum,
    pub pretest_check: PretestCheck,
    pub readings: ReadingRules,
    /// Watchdog time of the communication between program and rig \[s\]. After it the rig must hold automatically, and the program stops.
    pub watchdog: f64,
    /// Speed of a move if none is specified and the plan has no speed limit \[m/s\].
    pub own_speed: f64,
    /// Entries of each axis, lowest floor first; empty: one axis, with the entries above.
    pub axes: Vec<AxisPlan>,
}

/// One device on one port.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceLink {
    pub port: PortPlan,
    pub dialect: Dialect,
    /// Reply time-out T: a request is repeated after T, 2T and 4T of silence; then the rig holds \[s\].
    pub reply_timeout: f64,
    /// The device must report this serial number.
    pub serial_number: Option<String>,
}

/// The port of a device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortPlan {
    Serial {
        path: String,
        baud: u32,
    },
    /// `host:port`
    Tcp {
        address: String,
    },
}

impl std::fmt::Display for PortPlan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Serial { path, .. } => f.write_str(path),
            Self::Tcp { address } => f.write_str(address),
        }
    }
}

/// The reaction of a real rig when a run ends early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeState {
    /// Stops and keeps the load.
    Hold,
    /// Holds, then returns to the start position of the run, if rig and readings are still trusted.
    Unload,
}

impl SafeState {
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::Unload => "unload",
        }
    }
}

/// The zero of the plan's displacements. Targets, readings and limits are relative to it.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// The zero of the rig itself: the rig must be there when a run begins.
    Machine,
    /// The position of the rig when it is opened for a run.
    Here,
    /// These positions in the rig's own coordinate \[m\], one for each axis, from the log of a run that is resumed.
    At(Vec<f64>),
}

/// The pre-test check: readings at rest, and the stiffness that a small move shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PretestCheck {
    /// abs(force) at rest before any move \[N\].
    pub zero: f64,
    /// Length of the small move \[m\].
    pub probe: f64,
    /// The stiffness that it must show \[N/m\].
    pub stiffness: Interval,
}

/// The declared properties of the readings, and how many make one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadingRules {
    /// Number of settled readings whose median is used; odd, at least 1.
    pub samples: u32,
    /// Readings per second while settling.
    pub rate: f64,
    /// Resolution of the displacement reading \[m\].
    pub resolution: f64,
    /// Standard deviation of one force reading \[N\].
    pub noise: f64,
    /// Measuring range of the load cell \[N\]; a reading within 0.1 % of an end is saturated.
    pub force_range: Interval,
    /// Number of identical consecutive force readings during a change of displacement after which the sensor counts as frozen.
    pub frozen_after: u32,
}
