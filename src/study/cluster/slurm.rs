//! Scripts of a job array for Slurm. In: the command of a shard, the number of shards. Out: the text of the scripts. It submits nothing.

use std::fmt::Write as _;

/// Seconds before the time limit at which Slurm sends a signal: more than a round of runs and the merge of its pieces.
const NOTICE: u32 = 120;
/// The script of the job array in the folder of a study.
pub const ARRAY_SCRIPT: &str = "array.sbatch";
/// The script that merges.
pub const MERGE_SCRIPT: &str = "merge.sbatch";

/// What is submitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The name of the jobs.
    pub name: String,
    /// The command of a shard without `--shard`: program and arguments.
    pub command: Vec<String>,
    /// The command that merges the shards.
    pub merge: Vec<String>,
    pub shards: u32,
    /// Most tasks at a time.
    pub throttle: Option<u32>,
    /// Processors of each task.
    pub processors: u32,
    /// Time limit of each task.
    pub time: String,
    /// More options of sbatch.
    pub options: Vec<String>,
    /// Folder of the study.
    pub folder: String,
}

impl Job {
    /// The job array: one task a shard, numbered as the shards.
    ///
    /// Slurm sends USR1 two minutes before the time limit, to the script alone. The script sends TERM to psd, which keeps its runs and ends
    /// with 75, and the task is put back into the queue. `scancel` sends TERM: the runs are kept as well, but the task stays cancelled. A task
    /// that is interrupted or runs twice does no harm: a finished shard is not run again.
    #[must_use]
    pub fn array(&self) -> String {
        let throttle = self
            .throttle
            .map_or_else(String::new, |most| format!("%{most}"));
        let mut text = self.head(&self.name, "%A_%a.log", self.processors);
        let _ = write!(
            text,
            "#SBATCH --array=1-{}{throttle}\n\
             #SBATCH --signal=B:USR1@{NOTICE}\n\
             #SBATCH --requeue\n\n\
             stop() {{ stopped=1; [ -z \"$study\" ] || kill -TERM \"$study\"; }}\n\
             trap stop TERM\n\
             # The time limit is near.\n\
             trap 'again=1; stop' USR1\n\
             {} --shard env/{} --jobs \"${{SLURM_CPUS_PER_TASK:-{}}}\" &\n\
             study=$!\n\
             # A signal that came before psd.\n\
             [ -z \"$stopped\" ] || kill -TERM \"$study\"\n\
             wait \"$study\"; code=$?\n\
             # A signal ends `wait`, not psd.\n\
             while kill -0 \"$study\" 2>/dev/null; do wait \"$study\"; code=$?; done\n\
             if [ -n \"$again\" ] && [ \"$code\" -eq 75 ]; then\n\
             \x20 scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\"\n\
             fi\n\
             exit \"$code\"\n",
            self.shards,
            line(&self.command),
            self.shards,
            self.processors,
        );
        text
    }

    /// The job that merges the shards. It is submitted with `afterany`: with `afterok`, one task that failed would leave it waiting for
    /// ever. It names the shards that are missing.
    #[must_use]
    pub fn merging(&self) -> String {
        let mut text = self.head(&format!("{}-merge", self.name), "%j.log", 1);
        let _ = write!(text, "\n{}\n", line(&self.merge));
        text
    }

    fn head(&self, name: &str, log: &str, processors: u32) -> String {
        let mut text = format!(
            "#!/bin/bash\n\
             #SBATCH --job-name={}\n\
             #SBATCH --time={}\n\
             #SBATCH --cpus-per-task={}\n\
             #SBATCH --output={}/{log}\n\
             #SBATCH --open-mode=append\n",
            quoted(name),
            self.time,
            processors,
            quoted(&self.folder),
        );
        for option in &self.options {
            let _ = writeln!(text, "#SBATCH {option}");
        }
        text
    }
}

/// A command as a shell reads it.
fn line(words: &[String]) -> String {
    let words: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    words.join(" ")
}

/// A word as a shell and `#SBATCH` read it: in single quotes, unless it is plain.
#[must_use]
pub fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=:,+@%".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job() -> Job {
        let words = |text: &str| text.split(' ').map(str::to_owned).collect();
        Job {
            name: "beam-scatter".to_owned(),
            command: words("psd study run plans/beam.psd --out studies/a"),
            merge: words("psd study merge studies/a"),
            shards: 64,
            throttle: Some(16),
            processors: 8,
            time: "00:30:00".to_owned(),
            options: vec!["--partition=short".to_owned()],
            folder: "studies/a".to_owned(),
        }
    }

    #[test]
    fn the_array_is_numbered_as_its_shards_and_can_be_stopped() {
        let text = job().array();
        for line in [
            "#SBATCH --array=1-64%16",
            "#SBATCH --open-mode=append",
            "#SBATCH --signal=B:USR1@120",
            "#SBATCH --requeue",
            "#SBATCH --cpus-per-task=8",
            "#SBATCH --partition=short",
            "psd study run plans/beam.psd --out studies/a --shard env/64 --jobs \"${SLURM_CPUS_PER_TASK:-8}\" &",
        ] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
        assert!(job().merging().ends_with("\npsd study merge studies/a\n"));
        assert!(!job().merging().contains("--array"));
    }

    #[test]
    fn words_with_spaces_and_quotes_stay_one_word() {
        assert_eq!(quoted("impact_speed=1.5m/s"), "impact_speed=1.5m/s");
        assert_eq!(quoted("my plan.psd"), "'my plan.psd'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("$(rm)"), "'$(rm)'");
    }

    /// Run by a shell, with programs in place of psd and scontrol. Returns the arguments of scontrol, if it is called.
    fn signalled(signal: rustix::process::Signal) -> Option<String> {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let program = |name: &str, text: &str| {
            use std::os::unix::fs::PermissionsExt as _;
            std::fs::write(path(name), format!("#!/bin/sh\n{text}\n")).unwrap();
            let mode = std::fs::Permissions::from_mode(0o755);
            std::fs::set_permissions(path(name), mode).unwrap();
        };
        program(
            "psd",
            "trap 'exit 75' TERM; touch started; for turn in $(seq 1200); do sleep 0.05; done",
        );
        program("scontrol", "echo \"$@\" > requeued");
        let script = path("array.sbatch");
        std::fs::write(&script, job().array()).unwrap();
        let search = format!(
            "{}:{}",
            folder.path().display(),
            std::env::var("PATH").unwrap()
        );
        let mut shell = std::process::Command::new("bash")
            .arg(&script)
            .current_dir(folder.path())
            .env("PATH", search)
            .env("SLURM_ARRAY_JOB_ID", "7")
            .env("SLURM_ARRAY_TASK_ID", "3")
            .spawn()
            .unwrap();
        while !path("started").exists() {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        let id = rustix::process::Pid::from_child(&shell);
        rustix::process::kill_process(id, signal).unwrap();
        let status = shell.wait().unwrap();
        assert_eq!(status.code(), Some(75));
        std::fs::read_to_string(path("requeued")).ok()
    }

    #[test]
    fn a_task_at_its_time_limit_is_put_back_and_a_cancelled_one_is_not() {
        use rustix::process::Signal;
        assert_eq!(signalled(Signal::USR1).as_deref(), Some("requeue 7_3\n"));
        assert_eq!(signalled(Signal::TERM), None);
    }
}
