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

    /// Largest number of axes that one device of this protocol moves together.
    #[must_use]
    pub const fn most_axes(&self) -> usize {
        match self {
            Self::Native | Self::Nees { .. } => 6,
            Self::Grbl
            | Self::Hx711
            | Self::Indicator
            | Self::Scpi { .. }
            | Self::Instron
            | Self::Mark10
            | Self::Mark10Gauge
            | Self::Modbus(_) => 1,
        }
    }

    /// Largest number of axes whose force one device of this protocol measures.
    #[must_use]
    pub const fn most_channels(&self) -> usize {
        match self {
            Self::Scpi { newtons_per_unit } => newtons_per_unit.len(),
            _ => self.most_axes(),
        }
    }

    /// Whether a move is proposed to the device before it is commanded.
    #[must_use]
    pub const fn proposes(&self) -> bool {
        matches!(self, Self::Nees { .. })
    }

    /// Whether the device can move the specimen.
    #[must_use]
    pub const fn moves(&self) -> bool {
        match self {
            Self::Native | Self::Grbl | Self::Instron | Self::Mark10 | Self::Nees { .. } => true,
            Self::Modbus(map) => map.target.is_some(),
            Self::Hx711 | Self::Indicator | Self::Scpi { .. } | Self::Mark10Gauge => false,
        }
    }

    /// Whether a device that moves measures its position. Otherwise the position is the command.
    #[must_use]
    pub const fn measures_position(&self) -> bool {
        match self {
            Self::Grbl => false,
            Self::Native
            | Self::Hx711
            | Self::Indicator
            | Self::Scpi { .. }
            | Self::Instron
            | Self::Mark10
            | Self::Mark10Gauge
            | Self::Modbus(_)
            | Self::Nees { .. } => true,
        }
    }

    /// Whether the device measures the force.
    #[must_use]
    pub const fn measures_force(&self) -> bool {
        match self {
            Self::Grbl => false,
            Self::Modbus(map) => map.force.is_some(),
            Self::Native
            | Self::Hx711
            | Self::Indicator
            | Self::Scpi { .. }
            | Self::Instron
            | Self::Mark10
            | Self::Mark10Gauge
            | Self::Nees { .. } => true,
        }
    }

    /// Whether the device returns the force as raw counts, which need a scale factor.
    #[must_use]
    pub const fn counts(&self) -> bool {
        matches!(self, Self::Hx711)
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
