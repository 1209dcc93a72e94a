//! The protocols of devices, with the abilities of each: whether it moves, what it measures, how many axes. They are data: the bytes are
//! in `rig::controllers`.

/// The protocol of a device.
#[derive(Clone, Debug, PartialEq)]
pub enum Dialect {
    /// psd's own line protocol: moves, measures displacement and force.
    Native,
    /// Grbl 1.1, axis X: moves; its position is commanded steps, not a measurement.
    Grbl,
    /// Load cell: one raw count for each line.
    Hx711,
    /// Load cell: weighing indicator, `ST,GS,+0001234,kg`; the unit is in the line.
    Indicator,
    /// Load cells or transducers: SCPI `READ?`; newtons for each unit of the reading, one factor for each channel.
    Scpi { newtons_per_unit: Vec<f64> },
    /// Instron 8800-style console: moves, measures both.
    Instron,
    /// Mark-10 test frame with its gauge: moves, measures both.
    Mark10,
    /// Load cell: Mark-10 gauge alone.
    Mark10Gauge,
    /// Modbus RTU with its register map: moves, and measures the quantities in the map.
    Modbus(ModbusMap),
    /// NEES "LabVIEW plugin" ASCII, with psd as coordinator: moves, measures both.
    Nees {
        /// One for each axis, the lowest storey first.
        control_points: Vec<String>,
    },
}

impl Dialect {
    /// The protocols without arguments.
    const WITHOUT_ARGUMENTS: &[Self] = &[
        Self::Native,
        Self::Grbl,
        Self::Hx711,
        Self::Indicator,
        Self::Instron,
        Self::Mark10,
        Self::Mark10Gauge,
    ];

    /// The protocol without arguments that has this keyword in the language; None for all others.
    #[must_use]
    pub fn without_arguments(name: &str) -> Option<Self> {
        let mut listed = Self::WITHOUT_ARGUMENTS.iter();
        listed.find(|dialect| dialect.name() == name).cloned()
    }

    /// The keyword of the language.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.abilities().name
    }

    /// Why an axis in force control is refused. The controller itself must leave force control at the band of the axis, or without its load
    /// cell, and then hold the displacement: a softening specimen runs away before psd can act. Without its host it must keep the load.
    #[must_use]
    pub const fn no_force_control(&self) -> Option<&'static str> {
        match self {
            Self::Native => None,
            Self::Instron => {
                Some("psd switches its watchdog off, and only its position mode is on record")
            }
            _ => Some("its protocol has no message for a controlled force"),
        }
    }

    /// The row of this protocol.
    #[must_use]
    pub const fn abilities(&self) -> Abilities {
        match self {
            Self::Native => Abilities::of_frame("native", 6),
            Self::Grbl => Abilities {
                measures_position: false,
                measures_force: false,
                ..Abilities::of_frame("grbl", 1)
            },
            Self::Hx711 => Abilities {
                counts: true,
                ..Abilities::of_load_cell("hx711", 1)
            },
            Self::Indicator => Abilities::of_load_cell("indicator", 1),
            Self::Scpi { newtons_per_unit } => {
                Abilities::of_load_cell("scpi", newtons_per_unit.len())
            }
            Self::Instron => Abilities::of_frame("instron", 1),
            Self::Mark10 => Abilities::of_frame("mark10", 1),
            Self::Mark10Gauge => Abilities::of_load_cell("mark10_gauge", 1),
            Self::Modbus(map) => Abilities {
                moves: map.target.is_some(),
                measures_force: map.force.is_some(),
                ..Abilities::of_frame("modbus", 1)
            },
            Self::Nees { .. } => Abilities {
                proposes: true,
                ..Abilities::of_frame("nees", 6)
            },
        }
    }
}

/// What a device can do, by its protocol.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an ability of its own"
)]
pub struct Abilities {
    name: &'static str,
    /// Moves the specimen.
    pub moves: bool,
    /// A device that moves measures its position. Otherwise the position is the command.
    pub measures_position: bool,
    pub measures_force: bool,
    /// Gives the force as raw counts, which need a scale factor.
    pub counts: bool,
    /// A move is proposed to the device before it is commanded.
    pub proposes: bool,
    /// Largest number of axes that one device moves together.
    pub most_axes: usize,
    /// Largest number of axes whose force one device measures.
    pub most_channels: usize,
}

impl Abilities {
    /// A test frame: moves these axes and measures both quantities of each.
    const fn of_frame(name: &'static str, axes: usize) -> Self {
        Self {
            name,
            moves: true,
            measures_position: true,
            measures_force: true,
            counts: false,
            proposes: false,
            most_axes: axes,
            most_channels: axes,
        }
    }

    const fn of_load_cell(name: &'static str, channels: usize) -> Self {
        Self {
            moves: false,
            most_axes: 1,
            ..Self::of_frame(name, channels)
        }
    }
}

/// Registers of a Modbus RTU drive, transmitter or both. Addresses are those on the line, from 0.
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
    /// Metres per unit of position and target.
    pub length_unit: f64,
    /// Metres per second per unit of speed.
    pub speed_unit: f64,
    /// Newtons per unit of force.
    pub force_unit: f64,
}

/// The encoding of a number in registers. The word order of 32-bit numbers depends on the vendor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModbusNumber {
    Int16,
    Int32 { high_word_first: bool },
    Float32 { high_word_first: bool },
}
