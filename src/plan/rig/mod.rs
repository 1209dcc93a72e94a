//! The rig of a checked plan: connection, declared uncertainties, limits, reading rules. It is
//! data: no port is opened here.

pub(crate) mod axis;
pub(crate) mod axis_names;
pub(crate) mod declared_noise;
pub(crate) mod devices;
pub(crate) mod limits;

use super::{AxisPlan, Interval};
pub use crate::physics::perturbation::ReadingErrors;

/// The rig of a run, and what the plan says of it.
#[derive(Clone, Debug, PartialEq)]
pub struct RigPlan {
    /// `ideal` where the plan declares none.
    pub name: String,
    pub link: Link,
    pub settle: Settle,
    /// Factor on displacement and force signs: +1 or −1.
    pub sign: f64,
    pub calibration: Calibration,
    /// How far its zeros may drift in a run; None: nobody asks.
    pub drift: Option<DriftCheck>,
}

impl RigPlan {
    /// Actuators with their load cells; a virtual rig has as many as its specimen has degrees of freedom.
    #[must_use]
    pub fn axes(&self) -> Option<usize> {
        self.link.as_real().map(|link| link.axes.len().max(1))
    }
}

impl RigPlan {
    /// The same rig with the plan's zero where an earlier opening of it has put it on record, m, one an axis; None: as the plan says.
    #[must_use]
    pub fn with_recorded_datum(&self, places: Option<&[f64]>) -> Self {
        let mut rig = self.clone();
        if let (Link::Real(link), Some(places)) = (&mut rig.link, places) {
            link.datum = Datum::At(places.to_vec());
        }
        rig
    }
}

/// What stands behind the rig.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a plan has one")]
pub enum Link {
    Virtual(VirtualLink),
    Real(RealLink),
}

impl Link {
    /// The virtual link, where nothing real moves.
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

/// What a virtual rig adds to its specimen. All zero: an ideal rig.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct VirtualLink {
    /// Standard deviation of the load cell, N.
    pub noise: f64,
    /// Quantum of the displacement reading, m.
    pub resolution: f64,
    /// Quantum of the force reading, N.
    pub force_resolution: f64,
    /// First-order time constant of the actuator, s.
    pub lag: f64,
    /// Fraction of each increment not reached.
    pub tracking: f64,
    /// Drift of the load cell, N/s of rig time.
    pub drift: f64,
    pub seed: u64,
    /// Of a dry run on an ideal rig: what another one declares of its readings. None of it is done to them, all of it is in the
    /// uncertainty that is foretold.
    pub foretold: Option<ReadingErrors>,
}

impl VirtualLink {
    /// An ideal rig in place of another: nothing is done to its readings, and uncertainties are foretold with their errors.
    #[must_use]
    pub fn ideal_of(rig: &RigPlan) -> Self {
        let (seed, foretold) = match &rig.link {
            Link::Virtual(link) => {
                let Self {
                    seed,
                    noise,
                    resolution,
                    force_resolution,
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
                let axes = || (0..link.axes.len().max(1)).map(|axis| link.readings_of(axis));
                let noise = axes().map(|rules| rules.noise).fold(0.0, f64::max);
                let resolution = axes().map(|rules| rules.resolution).fold(0.0, f64::max);
                let force_resolution = rig.calibration.newtons_per_count.unwrap_or(0.0).abs();
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
            foretold: Some(foretold),
            ..Self::default()
        }
    }
}

/// Speed at which a virtual rig moves where none is asked of it, m/s: that of a slow quasi-static test.
pub const VIRTUAL_SPEED: f64 = 1e-3;

/// When a reading counts. A zero band is "at once".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// Displacement stays within this of the target, m.
    pub band: f64,
    /// |dF/dt| stays under this, N/s.
    pub force_rate: f64,
    /// … for this long, s.
    pub dwell: f64,
    /// Longest wait, s; past it the rig holds and the run is aborted.
    pub timeout: f64,
}

/// How far the zeros of a rig may drift in a run, and how they are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftCheck {
    /// Change of the force at no load, by size, N.
    pub force: f64,
    /// Change of the displacement reading against its target, by size, m; None: it is told and not judged.
    pub displacement: Option<f64>,
    /// Time over which a zero is read; a hold as long tells a slope, s.
    pub over: f64,
    pub after: ZeroAfter,
}

/// Where the force is known again when a run is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZeroAfter {
    /// Back where the run began, of a specimen that is as it was there.
    Start,
    /// A person has taken the specimen off the load cell.
    Free,
    /// Nowhere: only what no load and no relaxation can do is judged.
    Nowhere,
}

impl ZeroAfter {
    /// As a plan writes it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Free => "free",
            Self::Nowhere => "nowhere",
        }
    }
}

/// Where the numbers of a rig are traced to.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Calibration {
    /// Text of the calibration reference, if given; of the force alone where `displacement` has one of its own.
    pub reference: Option<String>,
    /// Day until which it holds, `YYYY-MM-DD`, if given.
    pub due: Option<String>,
    /// Class of the force measurement, as stated.
    pub force_class: Option<String>,
    /// Forces, by size, over which the calibration holds, N.
    pub force_calibrated: Option<Interval>,
    /// Of the displacement: its own reference and the day until which that holds, where it has one.
    pub displacement: Option<(String, Option<String>)>,
    /// Class of the displacement measurement, as stated.
    pub displacement_class: Option<String>,
    /// Displacements, by size, over which the calibration holds, m.
    pub displacement_calibrated: Option<Interval>,
    /// Of a cell that gives raw counts: N per count, its sign the cell's.
    pub newtons_per_count: Option<f64>,
    /// Count at no force.
    pub zero_count: f64,
    /// Standard uncertainty of the factor between its newtons and newtons; 0 where none is stated.
    pub force_uncertainty: f64,
    /// Of the factor between its metres and metres.
    pub displacement_uncertainty: f64,
    /// Of its reading of no force, N.
    pub zero_uncertainty: f64,
    /// Of what that reading may drift in a run that decides anything: the bound over √3, N.
    pub zero_drift: f64,
}

impl Calibration {
    /// Standard uncertainty of a reading of no force at any time of a run, N.
    #[must_use]
    pub fn zero(&self) -> f64 {
        self.zero_uncertainty.hypot(self.zero_drift)
    }
}

/// A rig that moves a real specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct RealLink {
    /// What moves, and what reads the force too where there is no cell of its own.
    pub actuator: DeviceLink,
    pub load_cell: Option<DeviceLink>,
    pub safe_state: SafeState,
    pub datum: Datum,
    pub gate: Gate,
    pub readings: ReadingRules,
    /// Longest time without a sign of life between program and rig, s: past it the rig is to hold by itself, and the
    /// program does not go on.
    pub watchdog: f64,
    /// Speed of a move for which none is asked and the plan limits none, m/s.
    pub own_speed: f64,
    /// What each axis says of itself, lowest floor first; empty: one axis, all of which is said above.
    pub axes: Vec<AxisPlan>,
}

/// One device on one port.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceLink {
    pub port: PortPlan,
    pub dialect: Dialect,
    /// A frame is sent again after T, 2T and 4T of silence; then the rig holds, s.
    pub reply_timeout: f64,
    /// The device must give this serial number.
    pub serial_number: Option<String>,
}

/// Where a device is reached.
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

/// What a device speaks.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialect {
    /// psd's own line protocol: moves, reads displacement and force.
    Native,
    /// Grbl 1.1, axis X: moves; its position is commanded steps, not a measurement.
    Grbl,
    /// Load cell: one raw count a line.
    Hx711,
    /// Load cell: weighing indicator, `ST,GS,+0001234,kg`; the unit is in the line.
    Indicator,
    /// Load cells or transducers: SCPI `READ?`; N per reading unit, one a channel.
    Scpi { newtons_per_unit: Vec<f64> },
    /// Instron 8800-style console: moves, reads both.
    Instron,
    /// Mark-10 stand with its gauge: moves, reads both.
    Mark10,
    /// Load cell: Mark-10 gauge alone.
    Mark10Gauge,
    /// Modbus RTU with its register map: moves, reads what the map has.
    Modbus(ModbusMap),
    /// NEES "LabVIEW plugin" ASCII, psd as coordinator: moves, reads both.
    Nees {
        /// One an axis, the lowest storey first.
        control_points: Vec<String>,
    },
}

impl Dialect {
    /// The word of the language.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Native => "native",
            Self::Grbl => "grbl",
            Self::Hx711 => "hx711",
            Self::Indicator => "indicator",
            Self::Scpi { .. } => "scpi",
            Self::Instron => "instron",
            Self::Mark10 => "mark10",
            Self::Mark10Gauge => "mark10_gauge",
            Self::Modbus(_) => "modbus",
            Self::Nees { .. } => "nees",
        }
    }

    /// Axes that one device of this dialect drives together, at most.
    #[must_use]
    pub const fn most_axes(&self) -> usize {
        match self {
            Self::Native | Self::Nees { .. } => 6,
            _ => 1,
        }
    }

    /// Axes that one device of this dialect weighs, at most.
    #[must_use]
    pub const fn most_channels(&self) -> usize {
        match self {
            Self::Scpi { newtons_per_unit } => newtons_per_unit.len(),
            _ => self.most_axes(),
        }
    }

    /// Whether it is asked if it would move before it is told to.
    #[must_use]
    pub const fn proposes(&self) -> bool {
        matches!(self, Self::Nees { .. })
    }

    /// Whether it follows smooth paths without a stop.
    #[must_use]
    pub const fn glides(&self) -> bool {
        matches!(self, Self::Native)
    }

    /// Whether it can move the specimen.
    #[must_use]
    pub const fn moves(&self) -> bool {
        match self {
            Self::Native | Self::Grbl | Self::Instron | Self::Mark10 | Self::Nees { .. } => true,
            Self::Modbus(map) => map.target.is_some(),
            Self::Hx711 | Self::Indicator | Self::Scpi { .. } | Self::Mark10Gauge => false,
        }
    }

    /// Whether it reads the force.
    #[must_use]
    pub const fn weighs(&self) -> bool {
        match self {
            Self::Grbl => false,
            Self::Modbus(map) => map.force.is_some(),
            _ => true,
        }
    }

    /// Whether its force comes as raw counts, which need a calibration.
    #[must_use]
    pub const fn counts(&self) -> bool {
        matches!(self, Self::Hx711)
    }
}

/// Registers of a Modbus RTU drive, transmitter or both. Addresses are as on the wire, from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModbusMap {
    /// 1 … 247
    pub unit: u8,
    pub number: ModbusNumber,
    /// Holding register of the absolute target.
    pub target: Option<u16>,
    /// Holding register of the speed.
    pub speed: Option<u16>,
    /// Register of the measured position.
    pub position: Option<u16>,
    /// Register of the measured force.
    pub force: Option<u16>,
    /// Register of the status word, and the bits that are set while it moves.
    pub status: Option<u16>,
    pub moving_mask: u16,
    /// Holding register of commands; `start_word` begins the move to the target, `stop_word` stops and holds.
    pub command: Option<u16>,
    pub start_word: u16,
    pub stop_word: u16,
    /// m per unit of position and target.
    pub length_unit: f64,
    /// m/s per unit of speed.
    pub speed_unit: f64,
    /// N per unit of force.
    pub force_unit: f64,
}

/// How a number lies in registers. The word order of 32-bit numbers is the vendor's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModbusNumber {
    Int16,
    Int32 { high_word_first: bool },
    Float32 { high_word_first: bool },
}

/// What a real rig does when a run ends early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeState {
    /// Stops and keeps the load.
    Hold,
    /// Holds, then goes back to where the run began, if rig and readings are still trusted.
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

/// Where the zero of the plan's displacements lies. Targets, readings and limits count from it.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// At the rig's own zero: the rig must stand there when a run begins.
    Machine,
    /// Where the rig stands when it is opened for a run.
    Here,
    /// At these places of the rig's own coordinate, m, one an axis: on record, of a run that goes on.
    At(Vec<f64>),
}

/// What must be so before the first step: the readings at rest, and the stiffness that a tiny move shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// |force| at rest before anything moves, N.
    pub zero: f64,
    /// The tiny move, m.
    pub probe: f64,
    /// What it must show, N/m.
    pub stiffness: Interval,
}

/// What the rig declares of its readings, and how many make one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadingRules {
    /// Settled readings of which the median counts, odd, at least 1.
    pub samples: u32,
    /// Readings a second while settling.
    pub rate: f64,
    /// Quantum of the displacement reading, m.
    pub resolution: f64,
    /// Standard deviation of one force reading, N.
    pub noise: f64,
    /// What the cell can read, N; a reading within 0.1 % of an end is saturated.
    pub force_range: Interval,
    /// Identical force readings in a row while the displacement changes: the sensor is taken for frozen.
    pub frozen_after: u32,
}
