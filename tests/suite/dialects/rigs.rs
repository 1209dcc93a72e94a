//! The rigs of the driver test. In: nothing. Out: the text of each in a plan, and the resolution of its readings. It starts no process.

use std::path::Path;

/// A rig that deforms the paper's beam.
pub struct Case {
    pub name: &'static str,
    /// `link`, or `actuator` and `load_cell`, with the lines that only they need; FOLDER and ADDRESS are replaced by ports.
    pub devices: &'static str,
    /// `resolution` in the plan \[m\]; half of it is the error of a target and of a displacement reading.
    pub resolution: f64,
    /// Half the resolution of its force readings \[N\].
    pub force_error: f64,
    /// \[mm/s\]
    pub speed: f64,
    /// Simulated time of the impact \[ms\]: a slow protocol gets few steps.
    pub duration: f64,
    /// It streams readings during a move.
    pub sweep: bool,
}

/// Every actuator and every load cell at least once. The force resolutions are those of the protocol's text.
pub const CASES: &[Case] = &[
    // Six decimals of a millimetre, three of a newton.
    Case {
        sweep: true,
        resolution: 1e-9,
        force_error: 5e-4,
        ..serial(
            "native",
            "link = serial(port: \"FOLDER/a\", dialect: native)",
        )
    },
    // Counts of 0.01 N.
    Case {
        force_error: 5e-3,
        ..serial(
            "grbl with hx711",
            "actuator = serial(port: \"FOLDER/a\", dialect: grbl)\n  load_cell = serial(port: \"FOLDER/b\", dialect: hx711)\n  \
             force_per_count = 0.01 N\n  zero_offset = 8123\n  polarity = negative\n  datum = here",
        )
    },
    // Hundredths of a kilogram, ten a second.
    Case {
        force_error: 0.05,
        duration: 4.0,
        ..serial(
            "grbl with indicator",
            "actuator = serial(port: \"FOLDER/a\", dialect: grbl)\n  load_cell = serial(port: \"FOLDER/b\", dialect: indicator)\n  polarity = negative\n  datum = here",
        )
    },
    Case {
        force_error: 0.05,
        ..serial(
            "grbl with scpi",
            "actuator = serial(port: \"FOLDER/a\", dialect: grbl)\n  load_cell = serial(port: \"FOLDER/b\", dialect: scpi(1 N))\n  polarity = negative\n  datum = here",
        )
    },
    // Eight decimals of 1 m and of 15 kN; it accepts ten polls a second.
    Case {
        force_error: 1e-4,
        duration: 4.0,
        ..serial(
            "instron",
            "link = serial(port: \"FOLDER/a\", dialect: instron)\n  force_range = 15 kN",
        )
    },
    // Hundredths of a millimetre; 0.1 N.
    Case {
        resolution: 1e-5,
        force_error: 0.05,
        speed: 150.0,
        ..serial(
            "mark10",
            "link = serial(port: \"FOLDER/a\", dialect: mark10)",
        )
    },
    Case {
        force_error: 0.05,
        ..serial(
            "modbus with mark10 gauge",
            "actuator = serial(port: \"FOLDER/a\", dialect: modbus(unit: 1, number: float32(low_word_first), target: 100, \
             position: 102, length_unit: 1 mm, speed: 106, speed_unit: 1 mm/s, status: 108, moving_mask: 1, command: 109, \
             start_word: 1, stop_word: 2))\n  load_cell = serial(port: \"FOLDER/b\", dialect: mark10_gauge)",
        )
    },
    // Seven digits of at most 3 kN.
    Case {
        force_error: 1e-3,
        ..serial(
            "modbus",
            "link = serial(port: \"FOLDER/a\", dialect: modbus(unit: 1, number: float32(high_word_first), target: 100, \
             position: 102, length_unit: 1 mm, force: 104, force_unit: 1 kN, speed: 106, speed_unit: 1 mm/s, status: 108, \
             moving_mask: 1, command: 109, start_word: 1, stop_word: 2))",
        )
    },
    Case {
        force_error: 1e-3,
        ..serial(
            "nees",
            "link = tcp(address: \"ADDRESS\", dialect: nees(\"MDL-00-01\"))",
        )
    },
];

/// The case of this name.
pub fn by_name(name: &str) -> &'static Case {
    CASES
        .iter()
        .find(|case| case.name == name)
        .unwrap_or_else(|| panic!("no rig is called {name}"))
}

/// A rig with a resolution of a micrometre, as fast as the limits allow.
const fn serial(name: &'static str, devices: &'static str) -> Case {
    Case {
        name,
        devices,
        resolution: 1e-6,
        force_error: 0.05,
        speed: 400.0,
        duration: 50.0,
        sweep: false,
    }
}

impl Case {
    /// The beam of the paper's section 5, in a plan that runs on this rig and on an ideal virtual one. Its velocities are low and its
    /// readings far apart, so that a loaded machine can follow. `reply_timeout` is in seconds.
    pub fn plan(&self, folder: &Path, address: &str, reply_timeout: f64) -> String {
        let devices = self
            .devices
            .replace("FOLDER", &folder.display().to_string())
            .replace("ADDRESS", address);
        let devices = devices.replace(
            "dialect:",
            &format!("reply_timeout: {reply_timeout} s, dialect:"),
        );
        let watchdog = 10.0 * reply_timeout;
        let (speed, resolution, duration) = (self.speed, self.resolution * 1e6, self.duration);
        // Half the resolution for the target and half for the reading, and a small margin for the last bit.
        let band = resolution.max(1.0) * 1.5;
        let (sweep, damping) = if self.sweep {
            (SWEEP, "c.damping")
        } else {
            ("", "6 N*s/m")
        };
        format!(
            r#"use "gfrp_beam.psd"

limits {{
  displacement = -1 mm .. 12 mm
  force        = 5 kN
  speed        = {speed} mm/s
}}

rig ideal {{
  link = virtual()
}}

rig real {{
  {devices}
  settle      = within({band} um, 50 kN/s, timeout: 10 min)
  safe_state  = hold
  pretest_check        = probe(0.1 mm, stiffness: 250 kN/m .. 350 kN/m, zero: 2 N)
  speed       = {speed} mm/s
  watchdog    = {watchdog} s
  rate        = 200 Hz
  samples     = 1
  resolution  = {resolution} um
  calibration = "of a stand-in"
}}

striker pendulum {{
  mass     = 20 kg
  velocity = 1 m/s
}}

stiffness ramp k0 {{
  displacements = 0.25 mm .. 1 mm step 0.25 mm
  pause         = 0 s
  samples       = 1
}}
{sweep}
impact hit {{
  striker   = pendulum
  stiffness = k0.stiffness
  damping   = {damping}
  contact   = rigid
  time_step = 0.5 ms
  duration  = {duration} ms
}}

require "is struck" hit.contacts >= 1

report {{
  figures = []
  formats = [html, csv]
}}
"#
        )
    }
}

/// The difference of the two velocities of the sweep \[m/s\].
pub const VELOCITY_DIFFERENCE: f64 = 0.5e-3;

/// The faster pass takes 8 s: it has its two readings on a machine of any speed.
const SWEEP: &str = "
damping sweep c {
  velocities = [0.5, 1] mm/s
  stroke     = 8 mm
  stiffness  = k0.stiffness
  rate       = 20 Hz
}
";
