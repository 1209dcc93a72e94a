//! `psd rig list`: the serial ports of this machine, one per line, with the system's data of each port. It also lists the persistent
//! names, which do not change when cables are exchanged. It opens no port.

use clap::Args;
use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};
use serialport::{SerialPortInfo, SerialPortType};

use crate::args::Format;
use crate::exit::{Exit, Failure};
use crate::output::{print_message, print_result};
use psd_text::diagnostic::excerpt::escape;

/// The folder of names made of manufacturer and serial number, each a link to its port.
const NAMES: &str = "/dev/serial/by-id";

#[derive(Debug, Args)]
pub struct ListArguments {
    /// Output format: one line per port, or JSON
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// Prints the ports; no port is not an error.
pub fn list(format: Format) -> Result<Exit, Failure> {
    let mut ports = serialport::available_ports()
        .map_err(|error| Failure::file("serial ports", error.to_string()))?;
    ports.sort_by(|one, other| one.port_name.cmp(&other.port_name));
    let names = persistent_names(Path::new(NAMES));
    match format {
        Format::Human => {
            if ports.is_empty() {
                print_message(
                    "no serial port was found: is the device plugged in and switched on?\n",
                );
            }
            print_result(
                &ports
                    .iter()
                    .map(|port| lines(port, &names))
                    .collect::<String>(),
            )?;
        }
        Format::Json => {
            let ports: Vec<Value> = ports.iter().map(|port| entry(port, &names)).collect();
            print_result(&format!("{:#}\n", Value::from(ports)))?;
        }
    }
    Ok(Exit::Met)
}

/// Persistent names with the port of each, sorted.
fn persistent_names(folder: &Path) -> Vec<(String, String)> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let name_and_port = |path: &Path| {
        Some((
            path.to_str()?.to_owned(),
            path.canonicalize().ok()?.to_str()?.to_owned(),
        ))
    };
    let mut names: Vec<(String, String)> = entries
        .filter_map(|entry| name_and_port(&entry.path()))
        .collect();
    names.sort();
    names
}

fn names_of<'a>(
    port: &'a SerialPortInfo,
    names: &'a [(String, String)],
) -> impl Iterator<Item = &'a str> {
    names
        .iter()
        .filter(|(_, target)| *target == port.port_name)
        .map(|(name, _)| name.as_str())
}

fn lines(port: &SerialPortInfo, names: &[(String, String)]) -> String {
    let description = match &port.port_type {
        SerialPortType::UsbPort(usb) => {
            let known = [
                usb.manufacturer.as_deref(),
                usb.product.as_deref(),
                usb.serial_number.as_deref(),
            ];
            let given: Vec<&str> = known.into_iter().flatten().collect();
            format!("USB {:04x}:{:04x} {}", usb.vid, usb.pid, given.join(", "))
        }
        other => kind(other).to_owned(),
    };
    let mut text = format!(
        "{}\n",
        escape(format!("{}  {description}", port.port_name).trim_end())
    );
    for name in names_of(port, names) {
        let _ = writeln!(text, "  {}", escape(name));
    }
    text
}

/// The port as JSON; unknown data are null.
fn entry(port: &SerialPortInfo, names: &[(String, String)]) -> Value {
    let usb = match &port.port_type {
        SerialPortType::UsbPort(usb) => json!({
            "vendor_id": format!("{:04x}", usb.vid),
            "product_id": format!("{:04x}", usb.pid),
            "manufacturer": usb.manufacturer,
            "product": usb.product,
            "serial_number": usb.serial_number,
        }),
        _ => Value::Null,
    };
    let names: Vec<&str> = names_of(port, names).collect();
    json!({ "port": port.port_name, "kind": kind(&port.port_type), "usb": usb, "names_that_stay": names })
}

const fn kind(port: &SerialPortType) -> &'static str {
    match port {
        SerialPortType::UsbPort(_) => "USB",
        SerialPortType::PciPort => "built in",
        SerialPortType::BluetoothPort => "Bluetooth",
        SerialPortType::Unknown => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn usb() -> SerialPortInfo {
        let usb = serialport::UsbPortInfo {
            vid: 0x2341,
            pid: 0x43,
            serial_number: Some("A\u{1b}[2J".to_owned()),
            manufacturer: Some("Maker".to_owned()),
            product: None,
        };
        SerialPortInfo {
            port_name: "/dev/ttyACM0".to_owned(),
            port_type: SerialPortType::UsbPort(usb),
        }
    }

    #[test]
    fn a_port_is_one_line_whatever_its_maker_calls_it() {
        assert_eq!(
            lines(&usb(), &[]),
            "/dev/ttyACM0  USB 2341:0043 Maker, A\\u{1b}[2J\n"
        );
        let bare = SerialPortInfo {
            port_name: "/dev/ttyS0".to_owned(),
            port_type: SerialPortType::Unknown,
        };
        assert_eq!(lines(&bare, &[]), "/dev/ttyS0\n");
    }

    #[test]
    fn a_program_gets_every_field() {
        let stays = [(
            "/dev/serial/by-id/usb-Maker".to_owned(),
            "/dev/ttyACM0".to_owned(),
        )];
        let expected = json!({
            "port": "/dev/ttyACM0",
            "kind": "USB",
            "usb": {
                "vendor_id": "2341", "product_id": "0043", "manufacturer": "Maker", "product": null,
                "serial_number": "A\u{1b}[2J",
            },
            "names_that_stay": ["/dev/serial/by-id/usb-Maker"],
        });
        assert_eq!(entry(&usb(), &stays), expected);
    }

    /// A pseudo-terminal acts as a port, a link to it as a persistent name.
    #[test]
    fn a_persistent_name_is_listed_below_its_port() {
        let folder = tempfile::tempdir().unwrap();
        assert!(persistent_names(&folder.path().join("none")).is_empty());
        let line =
            psd_rig::emulator::PseudoTerminal::linked(&folder.path().join("usb-Maker_A7")).unwrap();
        let names = persistent_names(folder.path());
        let [(name, port)] = names.as_slice() else {
            panic!("{names:?}")
        };
        let port = SerialPortInfo {
            port_name: port.clone(),
            port_type: SerialPortType::Unknown,
        };
        assert_eq!(
            lines(&port, &names),
            format!("{}\n  {name}\n", port.port_name)
        );
        drop(line);
    }
}
