//! The devices of a real rig: their ports and protocols. Fields of `rig` name them.

use crate::schema::types::{Field, Variant};
use crate::units::Dimension;

/// Longest time-out or wait \[s\].
pub(crate) const LONGEST_WAIT: f64 = 3600.0;

const WORD_ORDER: Field = Field::choice(
    "order",
    &[
        Variant::word("high_word_first", "the word with the sign comes first"),
        Variant::word("low_word_first", "the word with the sign comes last"),
    ],
    "which of its two words comes first; makers differ",
)
.required("order: high_word_first");

const NUMBERS: &[Variant] = &[
    Variant::word("int16", "one word, a whole number with a sign"),
    Variant::with(
        "int32",
        &[WORD_ORDER],
        "two words, a whole number with a sign",
    ),
    Variant::with("float32", &[WORD_ORDER], "two words, a number with a point"),
];

const fn register(name: &'static str, doc: &'static str) -> Field {
    Field::count(name, 0.0, 65_535.0, doc)
}

const MODBUS: &[Field] = &[
    Field::count("unit", 1.0, 247.0, "address of the device").required("unit: 1"),
    Field::choice("number", NUMBERS, "how numbers lie in the registers")
        .required("number: float32(high_word_first)"),
    register("force", "register of the measured force"),
    Field::quantity("force_unit", Dimension::FORCE, "force of one count or unit"),
    register("position", "register of the measured displacement"),
    register(
        "target",
        "register of the absolute target: with it the device moves",
    ),
    Field::quantity(
        "length_unit",
        Dimension::LENGTH,
        "length of one count or unit",
    )
    .above_zero(),
    register("speed", "register of the speed"),
    Field::quantity(
        "speed_unit",
        Dimension::VELOCITY,
        "speed of one count or unit",
    )
    .above_zero(),
    register("status", "register of the status word"),
    Field::count(
        "moving_mask",
        1.0,
        65_535.0,
        "bits of the status word that are set while it moves",
    ),
    register("command", "register of commands"),
    register("start_word", "command that begins the move to the target"),
    register("stop_word", "command that stops and holds"),
];

const DIALECTS: &[Variant] = &[
    Variant::word("native", "psd's own line protocol: moves, reads displacement and force"),
    Variant::word("grbl", "Grbl 1.1, axis X: moves; its displacement is commanded steps, not a measurement"),
    Variant::word("hx711", "load cell: one raw count a line"),
    Variant::word("indicator", "load cell: weighing indicator, `ST,GS,+0001234,kg`"),
    Variant::with(
        "scpi",
        &[Field::quantities(
            "newtons_per_unit",
            Dimension::FORCE,
            "force of one unit of its reading, not 0; of a meter of several channels a list, one an axis",
        )
        .required("1 N")],
        "load cell: a meter that answers `READ?`, of several channels with numbers between commas",
    ),
    Variant::word("instron", "Instron 8800-style console: moves, reads both"),
    Variant::word("mark10", "Mark-10 stand with its gauge: moves, reads both"),
    Variant::word("mark10_gauge", "load cell: a Mark-10 gauge alone"),
    Variant::with("modbus", MODBUS, "Modbus RTU: moves and reads what has a register"),
    Variant::with(
        "nees",
        &[Field::text("control_point", "what moves; of several axes one each, the lowest storey first, with commas between")
            .required("\"MDL-00-01\"")],
        "NEES `LabVIEW plugin` text, psd as coordinator: moves, reads both",
    ),
];

const DIALECT: Field =
    Field::choice("dialect", DIALECTS, "what the device speaks").required("dialect: native");

const REPLY_TIMEOUT: Field = Field::quantity(
    "reply_timeout",
    Dimension::TIME,
    "a request is sent again after this, twice and four times this",
)
.or(0.4, "s")
.above_zero_up_to(LONGEST_WAIT);

const SERIAL_NUMBER: Field = Field::text(
    "serial_number",
    "the serial number that the device must give",
);

/// A device on a serial port.
pub(crate) const SERIAL: Variant = Variant::with(
    "serial",
    &[
        Field::text("port", "the port").required("port: \"/dev/ttyUSB0\""),
        DIALECT,
        Field::count("baud", 50.0, 4e6, "bits a second").or(115_200.0, ""),
        REPLY_TIMEOUT,
        SERIAL_NUMBER,
    ],
    "a device on a serial port",
);

/// A device on the network.
pub(crate) const TCP: Variant = Variant::with(
    "tcp",
    &[
        Field::text("address", "host and port").required("address: \"127.0.0.1:44000\""),
        DIALECT,
        REPLY_TIMEOUT,
        SERIAL_NUMBER,
    ],
    "a device on the network; such a connection proves nobody: keep it on this machine or in a tunnel",
);
