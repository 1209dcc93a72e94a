//! One device of a real rig: `serial(…)` or `tcp(…)`, its port and its time-out. In: a field that names one. Out: a
//! [`Device`]. It opens nothing: whether the port exists is known when the run opens it.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::choice::Chosen;
use crate::check::expressions::fields::whole;
use crate::codes::E610;
use psd_plan::schema::devices as schema;
use psd_plan::{DeviceLink, PortPlan};
use psd_text::diagnostic::Violation;
use psd_text::source::Span;

use super::dialect;
use super::line_text::line_text;

/// A device, with the spans of its parts.
pub struct Device {
    pub link: DeviceLink,
    pub port_at: Span,
    pub dialect_at: Span,
    /// The whole `serial(…)` or `tcp(…)`.
    pub at: Span,
}

/// The device that a variant `serial` or `tcp` describes.
pub fn device<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    at: Span,
    context: Context,
) -> Option<Device> {
    let serial = chosen.variant.name == "serial";
    let port = if serial {
        serial_port(checker, chosen, context)
    } else {
        tcp_address(checker, chosen)
    };
    let dialect = checker
        .chosen_argument(chosen, schema::DIALECT.name)
        .and_then(|chosen| dialect::dialect(checker, &chosen, context));
    let reply_timeout = checker.constant_argument(chosen, schema::REPLY_TIMEOUT.name, context);
    let serial_number = line_text(checker, chosen, schema::SERIAL_NUMBER.name);
    let (port_at, dialect_at) = (
        chosen.span(if serial {
            schema::PORT.name
        } else {
            schema::ADDRESS.name
        })?,
        chosen.span(schema::DIALECT.name)?,
    );
    let link = DeviceLink {
        port: port?,
        dialect: dialect?,
        reply_timeout: reply_timeout?,
        serial_number: serial_number?,
    };
    Some(Device {
        link,
        port_at,
        dialect_at,
        at,
    })
}

#[derive(Violation)]
#[violation(E610, "invalid port name: {why}")]
#[help("write the name that the system uses, such as `\"/dev/ttyUSB0\"`")]
struct BadPortName<'a> {
    #[label("invalid port name")]
    span: Span,
    why: &'a str,
}

fn serial_port<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<PortPlan> {
    let path = checker.text_argument(chosen, schema::PORT.name).flatten();
    let baud = checker
        .constant_argument(chosen, schema::BAUD.name, context)
        .and_then(whole);
    let (path, span) = path?;
    match error_of_port(&path) {
        Some(why) => checker.fail(BadPortName { span, why }),
        None => Some(PortPlan::Serial { path, baud: baud? }),
    }
}

/// The error of the name of a port, if any.
fn error_of_port(path: &str) -> Option<&'static str> {
    if path.is_empty() {
        Some("it is empty")
    } else if path.starts_with('-') {
        Some("it begins like an option")
    } else if path.chars().any(|c| c.is_whitespace() || c.is_control()) {
        Some("it contains spaces or control characters")
    } else {
        None
    }
}

#[derive(Violation)]
#[violation(
    E610,
    "invalid address `{}`: a host, a colon and a port from 1 to 65535 are required",
    address.escape_debug()
)]
#[help("write it as in `\"127.0.0.1:44000\"`")]
struct BadAddress<'a> {
    address: &'a str,
    #[label("not `host:port`")]
    span: Span,
}

fn tcp_address<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>) -> Option<PortPlan> {
    let (address, span) = checker
        .text_argument(chosen, schema::ADDRESS.name)
        .flatten()?;
    if is_host_and_port(&address) {
        return Some(PortPlan::Tcp { address });
    }
    checker.fail(BadAddress {
        address: &address,
        span,
    })
}

/// `host:port`, or `[::1]:port`; the port is 1 to 65535.
fn is_host_and_port(address: &str) -> bool {
    let Some((host, port)) = address.rsplit_once(':') else {
        return false;
    };
    let number = port.bytes().all(|byte| byte.is_ascii_digit())
        && port.parse::<u16>().is_ok_and(|port| port > 0);
    let name = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    let numeric = |c: char| c.is_ascii_hexdigit() || matches!(c, ':' | '.' | '%');
    let host = match host
        .strip_prefix('[')
        .and_then(|inner| inner.strip_suffix(']'))
    {
        Some(inner) => inner.contains(':') && inner.chars().all(numeric),
        None => !host.is_empty() && !host.starts_with('-') && host.chars().all(name),
    };
    host && number
}

#[cfg(test)]
mod tests {
    use super::{error_of_port, is_host_and_port};

    #[test]
    fn a_port_is_one_word_that_is_no_option() {
        for good in [
            "/dev/ttyUSB0",
            "/tmp/psd-bench",
            "COM3",
            "/dev/serial/by-id/usb-1a86_USB2.0-Serial-if00-port0",
        ] {
            assert_eq!(error_of_port(good), None, "{good}");
        }
        for bad in [
            "",
            " ",
            "/dev/tty USB0",
            "-x",
            "--port",
            "a\tb",
            "a\0b",
            "a\u{1b}[2J",
        ] {
            assert!(error_of_port(bad).is_some(), "{bad:?}");
        }
    }

    #[test]
    fn an_address_is_a_host_and_a_port() {
        for good in [
            "127.0.0.1:44000",
            "localhost:1",
            "rig-2.lab.example:65535",
            "[::1]:44000",
        ] {
            assert!(is_host_and_port(good), "{good}");
        }
        for bad in [
            "",
            ":",
            "localhost",
            "localhost:",
            ":44000",
            "localhost:0",
            "localhost:65536",
            "localhost:+1",
            "host name:1",
            "::1:44000",
            "[]:1",
            "[localhost]:1",
            "-x:1",
            "http://rig:1",
            "rig:1:2",
            "rig:1 ",
        ] {
            assert!(!is_host_and_port(bad), "{bad}");
        }
    }
}
