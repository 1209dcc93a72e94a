//! `psd rig simulate`: an emulator of the rig of a plan, at the port of the plan, until it is stopped. In: a plan, a script of faults.
//! Out: a serial line that answers, a log, and whether every target was within the limits.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;

use crate::args::PlanSettings;
use crate::exit::{Exit, Failure};
use crate::files::plan_file;
use crate::output::print_message;
use crate::settings::Settings;
use psd_plan::{DeviceLink, Plan, PortPlan, RealLink};
use psd_rig::emulator::lines::real_time::{Carrier, Until, serve};
use psd_rig::emulator::{Log, PseudoTerminal, RigEmulator, Script, TcpLine, of_plan};
use psd_rig::transport::MonotonicClock;
use psd_text::diagnostic::excerpt::escape;

#[derive(Debug, Args)]
#[command(
    after_help = "The script has one fault per line, as TIME: FAULT. Times are `at 4.5 s`, `after 12 moves`, `after 20 readings`, `after 3 replies`, \
    `each reply with 0.01`. Faults are, among others, `drop replies 3`, `delay reply 0.4 s`, `flip a bit`, `hang up`, `reboot`, \
    `freeze force`, `scale force by -1`. See docs/reference/emulator-faults.md.\n\n\
    Exit codes:\n\
    \x20 0  all targets within the limits\n\
    \x20 2  error in the plan, the script or on the command line\n\
    \x20 3  fault of a port or a file\n\
    \x20 4  a target outside the limits"
)]
pub struct SimulateArguments {
    /// The plan, a `.psd` file or a Markdown document
    #[arg(value_name = "PLAN")]
    pub plan: PathBuf,
    #[command(flatten)]
    pub plan_settings: PlanSettings,
    /// Script of faults, such as `after 12 moves: drop replies 3`
    #[arg(long, value_name = "FILE")]
    pub script: Option<PathBuf>,
    /// New log file of all bytes and moves, with their times
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Seed of random noise and faults
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// End when the last host has disconnected
    #[arg(long)]
    pub once: bool,
}

/// Emulates the rig of a plan.
pub fn simulate(arguments: &SimulateArguments, settings: Settings) -> Result<Exit, Failure> {
    let checked = plan_file::open(&arguments.plan, &arguments.plan_settings)?;
    plan_file::show(&checked, &arguments.plan, settings);
    let Some(plan) = &checked.plan else {
        return Ok(Exit::Wrong);
    };
    let script = arguments
        .script
        .as_deref()
        .map_or_else(|| Ok(Script::default()), script)?;
    let stopped = stopped_by_signals().map_err(Failure::Signals)?;
    let unfit =
        |reason: String| Failure::command_line(format!("{}: {reason}", arguments.plan.display()));
    // No file is created if there is no rig to emulate.
    of_plan(plan, &script, Log::none(), arguments.seed, None).map_err(|error| {
        unfit(error.to_string())
            .help("name the real rig with --rig NAME, and give its specimen a behaviour")
    })?;
    let mut carriers = devices(plan)
        .map(|(_, device)| carrier(device))
        .collect::<Result<Vec<_>, _>>()?;
    let log = arguments
        .log
        .as_deref()
        .map_or_else(|| Ok(Log::none()), log)?;
    let mut emulator = of_plan(plan, &script, log, arguments.seed, Some(power_up()))
        .map_err(|error| unfit(error.to_string()))?;

    for (name, device) in devices(plan) {
        print_message(&escape(&format!(
            "  {name} of `{}`: {} at {}\n",
            plan.rig.name,
            device.dialect.name(),
            device.port
        )));
    }
    print_message("  emulates the rig until Ctrl-C\n");
    let until = Until {
        last_host_left: arguments.once,
        stopped: &|| stopped.load(Ordering::Relaxed),
    };
    let served = serve(
        &mut emulator,
        &mut carriers,
        &MonotonicClock::start(),
        until,
    );
    // The links are removed before anything else can fail.
    drop(carriers);
    end(&mut emulator, arguments.log.as_deref(), served)
}

/// The devices of the plan's rig, each with its line.
fn devices(plan: &Plan) -> impl Iterator<Item = (String, &DeviceLink)> {
    plan.rig
        .link
        .as_real()
        .map(RealLink::devices)
        .into_iter()
        .flatten()
}

fn carrier(device: &DeviceLink) -> Result<Box<dyn Carrier>, Failure> {
    match &device.port {
        PortPlan::Serial { path, .. } => match PseudoTerminal::linked(Path::new(path)) {
            Ok(line) => Ok(Box::new(line)),
            Err(error) => Err(Failure::file(path.as_str(), error.to_string()).help(
                "the rig emulator uses the plan's own port: name a free path, such as /tmp/rig",
            )),
        },
        PortPlan::Tcp { address } => match TcpLine::at(address) {
            Ok(line) => Ok(Box::new(line)),
            Err(error) => Err(Failure::command_line(format!("{address}: {error}"))),
        },
    }
}

fn script(path: &Path) -> Result<Script, Failure> {
    let text = fs::read_to_string(path).map_err(|error| Failure::file(path, error.to_string()))?;
    Script::parse(&text)
        .map_err(|error| Failure::command_line(format!("{}: {error}", path.display())))
}

/// A new file: a log is never overwritten.
fn log(path: &Path) -> Result<Log, Failure> {
    let file = OpenOptions::new().write(true).create_new(true).open(path);
    file.map(|file| Log::to(Box::new(file)))
        .map_err(|error| Failure::file(path, error.to_string()))
}

fn stopped_by_signals() -> std::io::Result<Arc<AtomicBool>> {
    let stopped = Arc::new(AtomicBool::new(false));
    for signal in [
        signal_hook::consts::SIGINT,
        signal_hook::consts::SIGTERM,
        signal_hook::consts::SIGHUP,
    ] {
        signal_hook::flag::register(signal, Arc::clone(&stopped))?;
    }
    Ok(stopped)
}

/// A boot identifier that differs at every start. A restarted emulator has lost its position, and must not appear to be the previous one.
fn power_up() -> u16 {
    let now = std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .unwrap_or_default();
    let mixed = u64::from(now.subsec_nanos()) ^ now.as_secs() ^ u64::from(std::process::id());
    let bytes = mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15).to_be_bytes();
    u16::from_be_bytes([bytes[0], bytes[1]])
}

/// Prints the result.
fn end(
    emulator: &mut RigEmulator,
    log: Option<&Path>,
    served: std::io::Result<()>,
) -> Result<Exit, Failure> {
    let sound = emulator.end();
    let (moves, violations) = (emulator.rig().moves().len(), emulator.rig().violations());
    print_message(&format!(
        "  {moves} moves, {} targets outside the limits\n",
        violations.len()
    ));
    for target in violations.iter().take(20) {
        print_message(&format!("  outside: {} mm\n", target * 1e3));
    }
    if let Some(error) = emulator.log_failure() {
        return Err(Failure::file(
            log.map_or_else(PathBuf::new, Path::to_owned),
            error.to_string(),
        ));
    }
    served.map_err(|error| Failure::file("line", error.to_string()))?;
    Ok(if sound { Exit::Met } else { Exit::Stopped })
}
