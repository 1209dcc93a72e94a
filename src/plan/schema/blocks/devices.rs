//! The devices of a real rig: their ports and protocols. Fields of `rig` name them.

use crate::schema::types::{Field, Variant};
use psd_text::units::Dimension;

/// Shortest time-out of a reply \[s\]: a serial line at the default rate carries about ten characters meanwhile.
const SHORTEST_REPLY: f64 = 1e-3;

/// Longest time-out or wait \[s\].
pub const LONGEST_WAIT: f64 = 3600.0;

pub const WORD_ORDER: Field = Field::choice(
    "order",
    &[
        Variant::word("high_word_first", "most significant word first"),
        Variant::word("low_word_first", "least significant word first"),
    ],
    "order of the two words; depends on the manufacturer",
)
.required("order: high_word_first");

const NUMBERS: &[Variant] = &[
    Variant::word("int16", "one word, signed integer"),
    Variant::with("int32", &[WORD_ORDER], "two words, signed integer"),
    Variant::with("float32", &[WORD_ORDER], "two words, floating point"),
];

const fn register(name: &'static str, doc: &'static str) -> Field {
    Field::count(name, 0.0, 65_535.0, doc)
}

pub const UNIT: Field =
    Field::count("unit", 1.0, 247.0, "address of the device").required("unit: 1");

pub const NUMBER: Field = Field::choice("number", NUMBERS, "number format of the registers")
    .required("number: float32(high_word_first)");

pub const FORCE: Field = register("force", "register of the measured force");

pub const FORCE_UNIT: Field =
    Field::quantity("force_unit", Dimension::FORCE, "force of one count or unit");

pub const POSITION: Field = register("position", "register of the measured displacement");

pub const TARGET: Field = register(
    "target",
    "register of the absolute target; required for a device that moves",
);

pub const LENGTH_UNIT: Field = Field::quantity(
    "length_unit",
    Dimension::LENGTH,
    "length of one count or unit",
)
.above_zero();

pub const SPEED: Field = register("speed", "register of the speed");

pub const SPEED_UNIT: Field = Field::quantity(
    "speed_unit",
    Dimension::VELOCITY,
    "speed of one count or unit",
)
.above_zero();

pub const STATUS: Field = register("status", "register of the status word");

pub const MOVING_MASK: Field = Field::count(
    "moving_mask",
    1.0,
    65_535.0,
    "bits of the status word that are set during motion",
);

pub const COMMAND: Field = register("command", "command register");

pub const START_WORD: Field = register("start_word", "command that starts the move to the target");

pub const STOP_WORD: Field = register("stop_word", "command that stops and holds");

const MODBUS: &[Field] = &[
    UNIT,
    NUMBER,
    FORCE,
    FORCE_UNIT,
    POSITION,
    TARGET,
    LENGTH_UNIT,
    SPEED,
    SPEED_UNIT,
    STATUS,
    MOVING_MASK,
    COMMAND,
    START_WORD,
    STOP_WORD,
];

pub const NEWTONS_PER_UNIT: Field = Field::quantities(
    "newtons_per_unit",
    Dimension::FORCE,
    "force per unit of its reading, not 0; one entry per axis for a meter of several channels",
)
.required("1 N");

pub const CONTROL_POINT: Field = Field::text(
    "control_point",
    "control point; one per axis, the lowest storey first, comma-separated",
)
.required("\"MDL-00-01\"");

const DIALECTS: &[Variant] = &[
    Variant::word(
        "native",
        "line protocol of psd: moves, reads displacement and force",
    ),
    Variant::word(
        "grbl",
        "Grbl 1.1, axis X: moves; its displacement is the commanded one, not measured",
    ),
    Variant::word("hx711", "load cell: one raw count per line"),
    Variant::word(
        "indicator",
        "load cell: weighing indicator, `ST,GS,+0001234,kg`",
    ),
    Variant::with(
        "scpi",
        &[NEWTONS_PER_UNIT],
        "load cell: meter that answers `READ?`; channels comma-separated",
    ),
    Variant::word("instron", "Instron 8800-style console: moves, reads both"),
    Variant::word("mark10", "Mark-10 stand with its gauge: moves, reads both"),
    Variant::word("mark10_gauge", "load cell: a Mark-10 gauge alone"),
    Variant::with(
        "modbus",
        MODBUS,
        "Modbus RTU: moves and reads the quantities that have a register",
    ),
    Variant::with(
        "nees",
        &[CONTROL_POINT],
        "NEES `LabVIEW plugin` text, psd as coordinator: moves, reads both",
    ),
];

pub const DIALECT: Field =
    Field::choice("dialect", DIALECTS, "protocol of the device").required("dialect: native");

pub const REPLY_TIMEOUT: Field = Field::quantity(
    "reply_timeout",
    Dimension::TIME,
    "time-out of the first attempt; later attempts wait twice and four times as long",
)
.or(0.4, "s")
.within(SHORTEST_REPLY, LONGEST_WAIT)
.advanced();

pub const SERIAL_NUMBER: Field =
    Field::text("serial_number", "serial number that the device must report");

pub const PORT: Field = Field::text("port", "the port").required("port: \"/dev/ttyUSB0\"");

pub const ADDRESS: Field =
    Field::text("address", "host and port").required("address: \"127.0.0.1:44000\"");

pub const BAUD: Field = Field::count("baud", 50.0, 4e6, "bits per second").or(115_200.0, "");

/// A device on a serial port.
pub const SERIAL: Variant = Variant::with(
    "serial",
    &[PORT, DIALECT, BAUD, REPLY_TIMEOUT, SERIAL_NUMBER],
    "a device on a serial port",
);

/// A device on the network.
pub const TCP: Variant = Variant::with(
    "tcp",
    &[ADDRESS, DIALECT, REPLY_TIMEOUT, SERIAL_NUMBER],
    "device on the network; unauthenticated: keep it on this machine or in a tunnel",
);
