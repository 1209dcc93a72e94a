//! `psd rig list`: the serial ports of this machine, one a line, with what the system knows of each.

use serialport::{SerialPortInfo, SerialPortType};

use crate::cli::exit::{Exit, Failure};
use crate::cli::output::{give, tell};
use crate::diagnostic::excerpt::escape;

/// Prints the ports; none is not a fault.
pub fn list() -> Result<Exit, Failure> {
    let mut ports = serialport::available_ports().map_err(|error| Failure::file("serial ports", error.to_string()))?;
    ports.sort_by(|one, other| one.port_name.cmp(&other.port_name));
    if ports.is_empty() {
        tell("no serial port was found\n");
    }
    give(&ports.iter().map(line).collect::<String>())?;
    Ok(Exit::Met)
}

fn line(port: &SerialPortInfo) -> String {
    let what = match &port.port_type {
        SerialPortType::UsbPort(usb) => {
            let known = [usb.manufacturer.as_deref(), usb.product.as_deref(), usb.serial_number.as_deref()];
            let said: Vec<&str> = known.into_iter().flatten().collect();
            format!("USB {:04x}:{:04x} {}", usb.vid, usb.pid, said.join(", "))
        }
        SerialPortType::PciPort => "built in".to_owned(),
        SerialPortType::BluetoothPort => "Bluetooth".to_owned(),
        SerialPortType::Unknown => String::new(),
    };
    format!("{}\n", escape(format!("{}  {what}", port.port_name).trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_one_line_whatever_its_maker_calls_it() {
        let usb = serialport::UsbPortInfo {
            vid: 0x2341,
            pid: 0x43,
            serial_number: Some("A\u{1b}[2J".to_owned()),
            manufacturer: Some("Maker".to_owned()),
            product: None,
        };
        let port = SerialPortInfo { port_name: "/dev/ttyACM0".to_owned(), port_type: SerialPortType::UsbPort(usb) };
        assert_eq!(line(&port), "/dev/ttyACM0  USB 2341:0043 Maker, A\\u{1b}[2J\n");
        let bare = SerialPortInfo { port_name: "/dev/ttyS0".to_owned(), port_type: SerialPortType::Unknown };
        assert_eq!(line(&bare), "/dev/ttyS0\n");
    }
}
