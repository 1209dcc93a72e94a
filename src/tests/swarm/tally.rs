//! What lives have met: faults, changes, laws, paths, simulated time. In: counts. Out: their sum, as text.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::fault::{Change, Fault};
use super::laws::Law;

#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) lives: u64,
    /// Simulated \[s\].
    pub(super) seconds: f64,
    pub(super) amendments: u64,
    met: BTreeMap<&'static str, u64>,
    paths: BTreeMap<String, u64>,
    laws: BTreeMap<Law, u64>,
}

impl Tally {
    /// A fault or a change has occurred.
    pub(super) fn add(&mut self, name: &'static str) {
        *self.met.entry(name).or_default() += 1;
    }

    pub(super) fn count(&self, name: &str) -> u64 {
        self.met.get(name).copied().unwrap_or_default()
    }

    /// A session has ended so.
    pub(super) fn path(&mut self, path: String) {
        *self.paths.entry(path).or_default() += 1;
    }

    pub(super) fn decided(&mut self, law: Law, count: u64) {
        *self.laws.entry(law).or_default() += count;
    }

    pub(super) fn plus(&mut self, other: Self) {
        self.lives += other.lives;
        self.seconds += other.seconds;
        self.amendments += other.amendments;
        other
            .met
            .into_iter()
            .for_each(|(name, count)| *self.met.entry(name).or_default() += count);
        other
            .paths
            .into_iter()
            .for_each(|(path, count)| *self.paths.entry(path).or_default() += count);
        other
            .laws
            .into_iter()
            .for_each(|(law, count)| *self.laws.entry(law).or_default() += count);
    }

    /// Every fault, change and law that was never met.
    pub(super) fn unmet(&self) -> Vec<&'static str> {
        let names = Fault::NAMES.into_iter().chain(Change::NAMES);
        let unmet = names.filter(|name| self.count(name) == 0);
        let laws = Law::ALL
            .into_iter()
            .filter(|law| self.laws.get(law).is_none_or(|count| *count == 0));
        unmet.chain(laws.map(Law::text)).collect()
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = format!(
            "{} lives, {:.1} simulated rig hours, {} amendments\n",
            self.lives,
            self.seconds / 3600.0,
            self.amendments
        );
        let mut row = |name: &str, count: u64| writeln!(text, "  {count:>9}  {name}");
        for (name, count) in &self.met {
            row(name, *count)?;
        }
        for (path, count) in &self.paths {
            row(path, *count)?;
        }
        for (law, count) in &self.laws {
            row(law.text(), *count)?;
        }
        f.write_str(&text)
    }
}
