//! The checked form of a real rig, and the choice of the rig of a run.

use super::{Options, check, files, no_files};
use psd_plan::record::equipment::{Device, Equipment};
use psd_plan::{
    DeviceLink, Dialect, Interval, Link, ModbusMap, ModbusNumber, Plan, PortPlan, PretestCheck,
    RealLink, SafeState,
};
use psd_rig::DeclaredNoise;

/// A specimen without a model, a rig with these lines, and limits of both.
fn text(rig: &str) -> String {
    format!(
        "specimen beam {{ mass = 1 kg }}\nlimits frame_limits {{ force = -2 kN .. 10 kN }}\n\
         limits {{ displacement = -2 mm .. 25 mm\n speed = 0.5 mm/s }}\nrig frame {{\n{rig}\n\
         settle = within(0.01 mm, 50 N/s, for: 0.3 s)\npretest_check = probe(0.02 mm, stiffness: 250 .. 350 kN/m, zero: 20 N)\n\
         limits = frame_limits\ncalibration = \"UKAS 4711\"\ncalibration_due = \"2027-03-01\"\n}}\n\
         move out {{ to = 1 mm }}\nrequire \"light\" beam.mass < 2 kg\n"
    )
}

fn plan(text: &str, rig: Option<&str>) -> Plan {
    let options = Options {
        rig: rig.map(str::to_owned),
        ..Options::default()
    };
    let checked = check("plan.psd", text, &no_files, &options);
    checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics))
}

fn real(text: &str) -> RealLink {
    match plan(text, Some("frame")).rig.link {
        Link::Real(link) => link,
        Link::Virtual(_) => panic!("a real rig was named"),
    }
}

#[test]
fn one_device_with_all_defaults() {
    let link = real(&text(
        "link = serial(\"/dev/ttyUSB0\", native)\nsafe_state = unload",
    ));
    let port = PortPlan::Serial {
        path: "/dev/ttyUSB0".to_owned(),
        baud: 115_200,
    };
    let device = DeviceLink {
        port,
        dialect: Dialect::Native,
        reply_timeout: 0.4,
        serial_number: None,
    };
    assert_eq!(
        (link.actuator, link.load_cell, link.safe_state),
        (device, None, SafeState::Unload)
    );
    assert_eq!(
        link.pretest_check,
        PretestCheck {
            zero: 20.0,
            probe: 2e-5,
            stiffness: Interval {
                low: 250e3,
                high: 350e3
            }
        }
    );
    let readings = link.readings;
    assert_eq!(
        (readings.samples, readings.rate, readings.frozen_after),
        (3, 20.0, 8)
    );
    assert_eq!(
        (readings.resolution, readings.noise, readings.force_range),
        (0.0, 0.0, Interval::ALL)
    );
    // A default speed does not exceed the limits.
    assert_eq!((link.watchdog, link.own_speed), (3.0, 0.5e-3));
}

#[test]
fn two_devices_with_everything_stated() {
    let rig = "actuator = serial(port: \"/dev/ttyUSB0\", dialect: grbl)\n\
        load_cell = serial(port: \"/dev/ttyUSB1\", baud: 9600, dialect: hx711, reply_timeout: 0.2 s, serial_number: \"A7\")\n\
        force_per_count = -0.0123 N\nzero_offset = -8123\npolarity = negative\nsafe_state = hold\nresolution = 1 um\nnoise = 2 N\n\
        rate = 10 Hz\nsamples = 5\nforce_range = -15 kN .. 10 kN\nfrozen_after = 20\nwatchdog = 4 s\nspeed = 0.2 mm/s";
    let plan = plan(&text(rig), Some("frame"));
    let link = plan.rig.link.as_real().expect("a real rig");
    let cell = link.load_cell.as_ref().expect("a load cell");
    assert_eq!(
        (&link.actuator.dialect, &cell.dialect),
        (&Dialect::Grbl, &Dialect::Hx711)
    );
    assert_eq!(
        (cell.port.to_string().as_str(), cell.reply_timeout),
        ("/dev/ttyUSB1", 0.2)
    );
    assert_eq!(cell.serial_number.as_deref(), Some("A7"));
    let calibration = &plan.rig.calibration;
    assert_eq!(
        (calibration.newtons_per_count, calibration.zero_offset),
        (Some(-0.0123), -8123.0)
    );
    assert_eq!(
        (calibration.reference.as_deref(), calibration.due.as_deref()),
        (Some("UKAS 4711"), Some("2027-03-01"))
    );
    assert_eq!(
        (
            plan.rig.polarity,
            plan.rig.settle.dwell,
            plan.rig.settle.timeout
        ),
        (-1.0, 0.3, 10.0)
    );
    assert_eq!(
        link.readings.force_range,
        Interval {
            low: -15e3,
            high: 10e3
        }
    );
    assert_eq!(
        (
            link.readings.samples,
            link.readings.rate,
            link.readings.resolution
        ),
        (5, 10.0, 1e-6)
    );
    assert_eq!(
        (link.watchdog, link.own_speed, link.safe_state),
        (4.0, 0.2e-3, SafeState::Hold)
    );
    // The limits are those of the plan and of the rig together; the specimen needs no model.
    assert_eq!(
        (plan.limits.force.high, plan.limits.displacement.high),
        (10e3, 25e-3)
    );
    assert!(plan.specimens[0].behaviour.is_none());
}

#[test]
fn dialects_with_arguments() {
    let rig = "safe_state = hold\nlink = tcp(\"rig.example:502\", modbus(unit: 7, number: int32(low_word_first), target: 10,\n\
        position: 12, length_unit: 1 um, force: 65535, force_unit: -0.5 N, status: 20, moving_mask: 4,\n\
        command: 30, start_word: 1, stop_word: 2))";
    let link = real(&text(rig));
    let map = ModbusMap {
        unit: 7,
        number: ModbusNumber::Int32 {
            high_word_first: false,
        },
        target: Some(10),
        speed: None,
        position: Some(12),
        force: Some(65_535),
        status: Some(20),
        moving_mask: 4,
        command: Some(30),
        start_word: 1,
        stop_word: 2,
        length_unit: 1e-6,
        speed_unit: 1.0,
        force_unit: -0.5,
    };
    assert_eq!(link.actuator.dialect, Dialect::Modbus(map));
    assert_eq!(
        link.actuator.port,
        PortPlan::Tcp {
            address: "rig.example:502".to_owned()
        }
    );
    let scpi = "safe_state = hold\nactuator = tcp(\"127.0.0.1:44000\", nees(\"MDL-00-01\"))\n\
        load_cell = serial(\"/dev/ttyUSB1\", scpi(newtons_per_unit: 2 kN))";
    let link = real(&text(scpi));
    assert_eq!(
        link.actuator.dialect,
        Dialect::Nees {
            control_points: vec!["MDL-00-01".to_owned()]
        }
    );
    assert_eq!(
        link.load_cell.map(|cell| cell.dialect),
        Some(Dialect::Scpi {
            newtons_per_unit: vec![2000.0]
        })
    );
}

#[test]
fn a_real_rig_moves_only_when_named() {
    let frame = "rig frame {\n link = serial(\"/dev/ttyUSB0\", native)\n safe_state = hold\n\
        settle = within(0.01 mm, 50 N/s)\n pretest_check = probe(0.02 mm, stiffness: 250 .. 350 kN/m, zero: 20 N)\n}\n";
    let rest = "specimen beam { mass = 1 kg\n behaviour = elastic(300 kN/m) }\n\
        limits { displacement = 25 mm\n force = 12 kN\n speed = 10 mm/s }\nmove out { to = 1 mm }\n";
    let simulated = "rig simulated { link = virtual(noise: 1 N) }\n";
    let both = format!("{frame}{simulated}{rest}");
    assert_eq!(plan(&both, None).rig.name, "simulated");
    assert_eq!(plan(&both, Some("frame")).rig.name, "frame");
    let alone = format!("{frame}{rest}");
    assert_eq!(plan(&alone, None).rig.name, "ideal");
    assert!(plan(&alone, None).rig.link.as_virtual().is_some());
    assert!(plan(&alone, Some("frame")).rig.link.as_real().is_some());
}

#[test]
fn a_watchdog_as_long_as_a_request_is_long_enough() {
    let rig = |watchdog: &str| {
        text(&format!(
            "link = serial(\"/dev/ttyUSB0\", native)\nsafe_state = hold\nwatchdog = {watchdog}"
        ))
    };
    assert_eq!(real(&rig("2.8 s")).watchdog, 2.8);
    let options = Options {
        rig: Some("frame".to_owned()),
        ..Options::default()
    };
    assert!(
        check("plan.psd", &rig("2.799 s"), &no_files, &options)
            .plan
            .is_none()
    );
}

#[test]
fn a_file_that_is_no_device_is_found_when_it_is_opened_not_here() {
    let link = real(&text(
        "link = serial(\"Cargo.toml\", native)\nsafe_state = hold",
    ));
    assert_eq!(link.actuator.port.to_string(), "Cargo.toml");
}

#[test]
fn an_axis_states_its_own_certificates_and_uncertainties_and_leaves_the_rest_to_the_rig() {
    let rig = "link = serial(\"/dev/ttyUSB0\", native)\nsafe_state = hold\nforce_uncertainty = 0.5 %\nforce_class = \"0.5\"\n\
        axes = [axis, axis(calibration: \"UKAS 4712\", displacement_calibration: \"UKAS 4800\",\n\
        displacement_calibration_due: \"2027-04-01\", force_uncertainty: 1 %, displacement_uncertainty: 0.2 %,\n\
        zero_uncertainty: 3 N, force_class: \"1\", displacement_class: \"0.5\")]";
    let frame = "specimen frame { storeys = [storey(mass: 2 t, stiffness: 300 kN/m), storey(mass: 1 t, stiffness: 200 kN/m)] }";
    let text = text(rig)
        .replace("specimen beam { mass = 1 kg }", frame)
        .replace("rig frame {", "rig press {")
        .replace(
            "move out { to = 1 mm }",
            "ground motion { file = \"g.csv\" }\nshake quake { ground = motion\n time_step = 10 ms }",
        )
        .replace("\"light\" beam.mass < 2 kg", "\"drift\" max(quake.max_drift) < 30 mm");
    let ground = [("g.csv", "time_s,acceleration_m_per_s2\n0,0\n0.1,1\n")];
    let options = Options {
        rig: Some("press".to_owned()),
        ..Options::default()
    };
    let checked = check("plan.psd", &text, &files(&ground), &options);
    let plan = checked
        .plan
        .unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    let [lower, upper] = [0, 1].map(|axis| plan.rig.calibration_of(axis));
    assert_eq!(lower, plan.rig.calibration);
    assert_eq!(
        (
            lower.reference.as_deref(),
            lower.force_uncertainty,
            lower.zero_uncertainty
        ),
        (Some("UKAS 4711"), 0.005, 0.0)
    );
    assert_eq!(
        (upper.reference.as_deref(), upper.due.as_deref()),
        (Some("UKAS 4712"), Some("2027-03-01"))
    );
    assert_eq!(
        upper.displacement,
        Some(("UKAS 4800".to_owned(), Some("2027-04-01".to_owned())))
    );
    assert_eq!(
        (
            upper.force_uncertainty,
            upper.displacement_uncertainty,
            upper.zero_uncertainty
        ),
        (0.01, 0.002, 3.0)
    );
    assert_eq!(
        (
            upper.force_class.as_deref(),
            upper.displacement_class.as_deref()
        ),
        (Some("1"), Some("0.5"))
    );
    let identity = psd_rig::virtual_rig(&plan).identity();
    let equipment = Equipment::of(&plan, Device::of(&identity, DeclaredNoise::NONE));
    let rows = equipment.channels.iter().map(|channel| {
        (
            channel.axis,
            channel.uncertainty,
            channel.certificate.as_deref(),
        )
    });
    let wanted = [
        (1, 0.0, "UKAS 4711"),
        (1, 0.005, "UKAS 4711"),
        (2, 0.002, "UKAS 4800"),
        (2, 0.01, "UKAS 4712"),
    ];
    assert!(
        rows.eq(wanted.map(|(axis, uncertainty, text)| (axis, uncertainty, Some(text)))),
        "{:?}",
        equipment.channels
    );
}
