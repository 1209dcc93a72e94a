//! The protocol of the client that drives a rig. In: the flags, and the plan's specimen and axes. Out: a [`Protocol`] with the stiffness or
//! the names that the client may request. It opens no port.

use clap::{Args, ValueEnum};

use crate::exit::Failure;
use psd::remote;
use psd::remote::Protocol;
use psd_physics::structure::assemblies::stiffness_on_the_rig;
use psd_plan::Plan;
use psd_rig::VirtualRig;
use psd_text::units::{Dimension, unit};

/// The client, as the command line describes it.
#[derive(Debug, Args)]
pub struct ClientArguments {
    /// Protocol of the client
    #[arg(long, value_enum)]
    pub protocol: ServedProtocol,
    /// Stiffness for a generic client [default: initial stiffness]
    #[arg(long, value_name = "STIFFNESS")]
    pub stiffness: Option<String>,
    /// Comma-separated floor names for NEES, the lowest first [default: MDL-00-01, MDL-00-02, …]
    #[arg(long, value_name = "NAMES")]
    pub control_points: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ServedProtocol {
    /// NEES "LabVIEW plugin" ASCII of OpenFresco and UI-SimCor
    Nees,
    /// Socket of OpenSees `genericClient` and OpenFresco `GenericTCP`
    GenericClient,
}

impl ServedProtocol {
    /// The word of the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nees => "nees",
            Self::GenericClient => "generic-client",
        }
    }
}

/// The protocol of the client, with the stiffness that it may request.
pub fn protocol(arguments: &ClientArguments, plan: &Plan) -> Result<Protocol, Failure> {
    let given = arguments.stiffness.as_deref().map(stiffness).transpose()?;
    match arguments.protocol {
        ServedProtocol::Nees if given.is_some() => Err(Failure::command_line(
            "NEES has no request for a stiffness: `--stiffness` is for generic-client",
        )),
        ServedProtocol::Nees => Ok(Protocol::Nees {
            control_points: control_points(arguments, plan)?,
        }),
        ServedProtocol::GenericClient if arguments.control_points.is_some() => {
            Err(Failure::command_line(
                "a generic client numbers its axes: `--control-points` is for nees",
            ))
        }
        ServedProtocol::GenericClient => {
            let specimen = VirtualRig::specimen_of(plan);
            if let Some(frame) = specimen.and_then(|specimen| specimen.frame.as_ref()) {
                if given.is_some() {
                    return Err(Failure::command_line(
                        "a frame has its own stiffness matrix: remove `--stiffness`",
                    ));
                }
                return Ok(Protocol::GenericClient {
                    stiffness: stiffness_on_the_rig(frame).concat(),
                });
            }
            let behaviour = specimen.and_then(|specimen| specimen.behaviour.as_ref());
            let known = given.or_else(|| behaviour.map(psd_plan::Behaviour::initial_stiffness));
            let stiffness = known.ok_or_else(|| {
                Failure::command_line(
                    "the stiffness for the client is not known: the specimen has no behaviour",
                )
                .help("give it: --stiffness \"300 kN/m\"")
            })?;
            Ok(Protocol::GenericClient {
                stiffness: vec![stiffness],
            })
        }
    }
}

/// The names of the rig's axes, for a coordinator.
fn control_points(arguments: &ClientArguments, plan: &Plan) -> Result<Vec<String>, Failure> {
    let axes = plan.degrees_of_freedom();
    let Some(given) = &arguments.control_points else {
        return Ok(remote::usual_names(axes));
    };
    let names: Vec<String> = given
        .split(',')
        .map(|name| name.trim().to_owned())
        .collect();
    let is_name = |name: &String| {
        name.starts_with("MDL-") && name.bytes().all(|byte| byte.is_ascii_graphic())
    };
    let twice = names
        .iter()
        .enumerate()
        .any(|(at, name)| names[..at].contains(name));
    if names.len() != axes || twice || !names.iter().all(is_name) {
        let example: Vec<String> = (1..=axes).map(|axis| format!("MDL-00-{axis:02}")).collect();
        return Err(Failure::command_line(format!(
            "--control-points {given}: write {axes} different names that begin with MDL-"
        ))
        .help(format!(
            "write them as \"{}\", the lowest storey first",
            example.join(", ")
        )));
    }
    Ok(names)
}

/// `300 kN/m`, in N/m.
fn stiffness(text: &str) -> Result<f64, Failure> {
    let wrong = |reason: &str| {
        Failure::command_line(format!(
            "--stiffness {text}: {reason}; write it as \"300 kN/m\""
        ))
    };
    let (number, token) = text
        .split_once(' ')
        .ok_or_else(|| wrong("the number or its unit is missing"))?;
    let number: f64 = number.parse().map_err(|_| wrong("not a number"))?;
    let unit = unit::parse(token.trim()).map_err(|error| wrong(&error.to_string()))?;
    if Dimension::FORCE.over(Dimension::LENGTH) != Some(unit.dimension) {
        return Err(wrong("not a unit of stiffness"));
    }
    let stiffness = number * unit.factor;
    if stiffness >= 0.0 && stiffness.is_finite() {
        Ok(stiffness)
    } else {
        Err(wrong("a stiffness must be at least 0"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exit::Exit;

    #[test]
    fn a_stiffness_has_its_unit() {
        assert_eq!(stiffness("300 kN/m").unwrap(), 3e5);
        assert_eq!(stiffness("0.3 kN/mm").unwrap(), 3e5);
        for wrong in [
            "300",
            "300 kN",
            "x kN/m",
            "-1 N/m",
            "nan N/m",
            "1e400 N/m",
            "300 foo/m",
        ] {
            assert_eq!(stiffness(wrong).unwrap_err().exit(), Exit::Wrong, "{wrong}");
        }
    }
}
