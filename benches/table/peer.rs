//! The peers of a case: programs in Python, one process each (`peers.py`).

use std::process::{Command, Stdio};

use super::processes::time_of_children;

/// The same case in another tool.
pub struct Peer {
    pub name: &'static str,
    modules: &'static [&'static str],
    arguments: Vec<String>,
    /// It prints its time; else its process is timed.
    prints: bool,
}

/// A name with the modules that it stands for.
const NAMES: [(&str, &[&str]); 5] = [
    ("OpenSees", &["openseespy.opensees"]),
    ("Numba", &["numba", "numpy"]),
    ("NumPy", &["numpy"]),
    (
        "OpenSees, pandas and Matplotlib",
        &["openseespy.opensees", "pandas", "matplotlib"],
    ),
    ("OpenSees and Polars", &["openseespy.opensees", "polars"]),
];

impl Peer {
    fn new(name: &str, arguments: &[&str], prints: bool) -> Self {
        let known = NAMES.into_iter().find(|(other, _)| *other == name);
        let (name, modules) = known.unwrap_or_else(|| panic!("no peer is named {name}"));
        Self {
            name,
            modules,
            arguments: arguments.iter().map(ToString::to_string).collect(),
            prints,
        }
    }

    /// One that measures a step.
    pub fn steps(name: &str, arguments: &[&str]) -> Self {
        Self::new(name, arguments, true)
    }

    /// One that is measured as a whole process.
    pub fn process(name: &str, arguments: &[&str]) -> Self {
        Self::new(name, arguments, false)
    }
}

/// Python, with the modules that it has.
pub struct Peers {
    python: String,
    installed: Vec<String>,
}

impl Peers {
    pub fn installed() -> Self {
        let python = std::env::var("PSD_BENCH_PYTHON").unwrap_or_else(|_| "python3".to_owned());
        let mut peers = Self {
            python,
            installed: Vec::new(),
        };
        let found = peers.command(&["installed".to_owned()]).output();
        if let Ok(output) = found {
            let text = String::from_utf8_lossy(&output.stdout);
            peers.installed = text.lines().map(ToOwned::to_owned).collect();
        }
        peers
    }

    pub fn have(&self, peer: &Peer) -> bool {
        let has = |module: &&str| self.installed.iter().any(|installed| installed == module);
        peer.modules.iter().all(has)
    }

    /// Of a step, or of the whole process \[s\].
    pub fn time(&self, peer: &Peer) -> f64 {
        let before = time_of_children();
        let output = self
            .command(&peer.arguments)
            .stderr(Stdio::null())
            .output()
            .expect("Python starts");
        assert!(output.status.success(), "{:?}", peer.arguments);
        if !peer.prints {
            return time_of_children() - before;
        }
        let text = String::from_utf8_lossy(&output.stdout);
        text.trim().parse().expect("a time")
    }

    fn command(&self, arguments: &[String]) -> Command {
        let mut command = Command::new(&self.python);
        // One thread: times are of the processor, and those of threads that wait for each other would add up.
        command
            .arg(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/benches/table/peers.py"
            ))
            .args(arguments)
            .env("OMP_NUM_THREADS", "1")
            .env("POLARS_MAX_THREADS", "1");
        command
    }
}
