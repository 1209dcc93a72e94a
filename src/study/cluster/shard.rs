//! Shards: a study in pieces, each a process of its own. In: `3/8`, `env` or `env/8`, and the environment of a batch system. Out: the runs
//! of the shard and the name of its file.

use std::ops::Range;

use thiserror::Error;

/// Most shards of a study.
pub const MOST_SHARDS: u32 = 100_000;

/// One of several processes that share a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    pub number: u32,
    pub of: u32,
}

/// A shard as the command line names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedShard {
    Given(Shard),
    /// The index variable of the batch system; its number of tasks, unless it is given.
    Environment {
        of: Option<u32>,
    },
}

/// Why there is no such shard.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ShardError {
    #[error("write it as 3/8, `env` or `env/8`")]
    Form,
    #[error("shards are counted from 1 to their number, at most {MOST_SHARDS}")]
    OutOfRange,
    #[error("no batch system has set an index: none of {0} is in the environment")]
    NoIndex(String),
    #[error("`{name}={text}` is not an index")]
    NoNumber { name: &'static str, text: String },
    #[error("`{0}` does not come with the number of tasks: write `--shard env/N`")]
    NoCount(&'static str),
}

/// Where a batch system states the index of a task.
struct System {
    index: &'static str,
    /// The first index: a number, or the variable that has it.
    first: First,
    /// The number of tasks.
    count: Option<Counted>,
}

enum First {
    Is(u32),
    In(&'static str),
}

enum Counted {
    In(&'static str),
    /// The last index.
    UpTo(&'static str),
}

const SYSTEMS: [System; 7] = [
    System {
        index: "SLURM_ARRAY_TASK_ID",
        first: First::In("SLURM_ARRAY_TASK_MIN"),
        count: Some(Counted::In("SLURM_ARRAY_TASK_COUNT")),
    },
    System {
        index: "JOB_COMPLETION_INDEX",
        first: First::Is(0),
        count: None,
    },
    System {
        index: "PBS_ARRAY_INDEX",
        first: First::Is(1),
        count: None,
    },
    System {
        index: "AWS_BATCH_JOB_ARRAY_INDEX",
        first: First::Is(0),
        count: Some(Counted::In("AWS_BATCH_JOB_ARRAY_SIZE")),
    },
    System {
        index: "SGE_TASK_ID",
        first: First::In("SGE_TASK_FIRST"),
        count: Some(Counted::UpTo("SGE_TASK_LAST")),
    },
    System {
        index: "LSB_JOBINDEX",
        first: First::Is(1),
        count: None,
    },
    System {
        index: "HQ_TASK_ID",
        first: First::Is(1),
        count: None,
    },
];

/// Reads `3/8`, `env` or `env/8`.
///
/// # Errors
/// It has another form, or the shard is beyond the number of shards.
pub fn parse(text: &str) -> Result<NamedShard, ShardError> {
    let number = |text: &str| text.parse::<u32>().map_err(|_| ShardError::Form);
    match text.split_once('/') {
        None if text == "env" => Ok(NamedShard::Environment { of: None }),
        None => Err(ShardError::Form),
        Some(("env", of)) => {
            let of = number(of)?;
            Shard { number: 1, of }.in_range()?;
            Ok(NamedShard::Environment { of: Some(of) })
        }
        Some((shard, of)) => {
            let shard = Shard {
                number: number(shard)?,
                of: number(of)?,
            };
            shard.in_range().map(NamedShard::Given)
        }
    }
}

impl NamedShard {
    /// The shard; `variable` reads the environment.
    ///
    /// With a given number of shards, the index of a task is the number of its shard, also where only some tasks of an array are submitted
    /// again. Without it, the array is the study: its first task is the first shard.
    ///
    /// # Errors
    /// The environment has no index, or no number of tasks.
    pub fn resolve(
        self,
        variable: impl Fn(&'static str) -> Option<String>,
    ) -> Result<Shard, ShardError> {
        let of = match self {
            Self::Given(shard) => return Ok(shard),
            Self::Environment { of } => of,
        };
        // Without a job array, SGE sets its index to this word.
        let set = |name: &'static str| {
            variable(name).filter(|text| !text.is_empty() && text != "undefined")
        };
        let system = SYSTEMS
            .iter()
            .find(|system| set(system.index).is_some())
            .ok_or_else(|| {
                let names: Vec<&str> = SYSTEMS.iter().map(|system| system.index).collect();
                ShardError::NoIndex(names.join(", "))
            })?;
        let number = |name: &'static str| {
            let text = set(name).ok_or(ShardError::NoCount(system.index))?;
            let parsed = text.parse::<u32>();
            parsed.map_err(|_| ShardError::NoNumber { name, text })
        };
        let index = number(system.index)?;
        if let Some(of) = of {
            let zero_based = matches!(system.first, First::Is(0));
            let number = index.saturating_add(u32::from(zero_based));
            return Shard { number, of }.in_range();
        }
        let first = match system.first {
            First::Is(first) => first,
            First::In(name) => number(name)?,
        };
        let of = match system.count {
            None => return Err(ShardError::NoCount(system.index)),
            Some(Counted::In(name)) => number(name)?,
            Some(Counted::UpTo(name)) => number(name)?.saturating_sub(first).saturating_add(1),
        };
        let shard = Shard {
            number: index.wrapping_sub(first).wrapping_add(1),
            of,
        };
        shard.in_range()
    }
}

impl Shard {
    fn in_range(self) -> Result<Self, ShardError> {
        let fits = (1..=self.of).contains(&self.number) && self.of <= MOST_SHARDS;
        fits.then_some(self).ok_or(ShardError::OutOfRange)
    }

    /// Its runs of a study of `runs` runs: all shards have as many, or one fewer.
    ///
    /// # Panics
    /// Never: both ends are at most `runs`.
    #[must_use]
    pub fn runs(self, runs: u64) -> Range<u64> {
        let edge = |shard: u32| {
            let share = u128::from(runs) * u128::from(shard) / u128::from(self.of);
            u64::try_from(share).expect("at most the number of runs")
        };
        edge(self.number - 1)..edge(self.number)
    }

    /// The name of its file without the extension: `shard-003-of-008`.
    #[must_use]
    pub fn stem(self) -> String {
        let digits = self.of.to_string().len().max(3);
        format!("shard-{:0digits$}-of-{:0digits$}", self.number, self.of)
    }

    /// The shard of a file with this name without the extension.
    #[must_use]
    pub fn of_stem(stem: &str) -> Option<Self> {
        let (number, of) = stem.strip_prefix("shard-")?.split_once("-of-")?;
        let shard = Self {
            number: number.parse().ok()?,
            of: of.parse().ok()?,
        };
        let shard = shard.in_range().ok()?;
        (shard.stem() == stem).then_some(shard)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(text: &str, variables: &[(&str, &str)]) -> Result<[u32; 2], ShardError> {
        let variable = |name: &'static str| {
            let found = variables.iter().find(|(known, _)| *known == name);
            found.map(|(_, text)| (*text).to_owned())
        };
        let shard = parse(text)?.resolve(variable)?;
        Ok([shard.number, shard.of])
    }

    #[test]
    fn shards_are_named_by_hand_or_by_the_batch_system() {
        assert_eq!(resolved("3/8", &[]), Ok([3, 8]));
        let slurm = [
            ("SLURM_ARRAY_TASK_ID", "7"),
            ("SLURM_ARRAY_TASK_MIN", "5"),
            ("SLURM_ARRAY_TASK_COUNT", "8"),
        ];
        assert_eq!(resolved("env", &slurm), Ok([3, 8]));
        // Two tasks of 64 that are submitted again: their minimum and number say nothing of the study.
        let again = [
            ("SLURM_ARRAY_TASK_ID", "17"),
            ("SLURM_ARRAY_TASK_MIN", "3"),
            ("SLURM_ARRAY_TASK_COUNT", "2"),
        ];
        assert_eq!(resolved("env/64", &again), Ok([17, 64]));
        assert_eq!(resolved("env", &again), Err(ShardError::OutOfRange));
        assert_eq!(
            resolved("env/8", &[("JOB_COMPLETION_INDEX", "0")]),
            Ok([1, 8])
        );
        assert_eq!(resolved("env/8", &[("PBS_ARRAY_INDEX", "8")]), Ok([8, 8]));
        let aws = [
            ("AWS_BATCH_JOB_ARRAY_INDEX", "7"),
            ("AWS_BATCH_JOB_ARRAY_SIZE", "8"),
        ];
        assert_eq!(resolved("env", &aws), Ok([8, 8]));
        let sge = [
            ("SGE_TASK_ID", "3"),
            ("SGE_TASK_FIRST", "2"),
            ("SGE_TASK_LAST", "9"),
        ];
        assert_eq!(resolved("env", &sge), Ok([2, 8]));
        assert_eq!(resolved("env/8", &[("LSB_JOBINDEX", "2")]), Ok([2, 8]));
        assert_eq!(resolved("env/8", &[("HQ_TASK_ID", "2")]), Ok([2, 8]));
    }

    #[test]
    fn a_shard_that_is_not_there_is_refused() {
        for text in ["", "3", "a/8", "3/b", "-1/8", "env/x"] {
            assert_eq!(parse(text), Err(ShardError::Form), "{text}");
        }
        for text in ["0/8", "9/8", "1/0", "1/100001", "env/0"] {
            assert_eq!(parse(text), Err(ShardError::OutOfRange), "{text}");
        }
        assert!(matches!(resolved("env", &[]), Err(ShardError::NoIndex(_))));
        assert!(matches!(
            resolved("env", &[("SGE_TASK_ID", "undefined")]),
            Err(ShardError::NoIndex(_))
        ));
        assert_eq!(
            resolved("env", &[("PBS_ARRAY_INDEX", "1")]),
            Err(ShardError::NoCount("PBS_ARRAY_INDEX"))
        );
        assert!(matches!(
            resolved("env/8", &[("LSB_JOBINDEX", "one")]),
            Err(ShardError::NoNumber { .. })
        ));
        assert_eq!(
            resolved("env/8", &[("JOB_COMPLETION_INDEX", "8")]),
            Err(ShardError::OutOfRange)
        );
    }

    #[test]
    fn shards_together_are_the_study_and_their_names_identify_them() {
        for (runs, of) in [(0, 3), (7, 8), (1000, 7), (10_000_000_000, 1024)] {
            let mut next = 0;
            for number in 1..=of {
                let shard = Shard { number, of };
                let own = shard.runs(runs);
                assert_eq!(own.start, next);
                let share = runs / u64::from(of);
                assert!((share..=share + 1).contains(&(own.end - own.start)));
                next = own.end;
                assert_eq!(Shard::of_stem(&shard.stem()), Some(shard));
            }
            assert_eq!(next, runs);
        }
        assert_eq!(Shard { number: 3, of: 8 }.stem(), "shard-003-of-008");
        for stem in ["study", "shard-3-of-8", "shard-009-of-008"] {
            assert_eq!(Shard::of_stem(stem), None, "{stem}");
        }
    }
}
