//! Progress of a study. In: how far it is. Out: on a terminal one line that is updated; in a pipe a line every half minute. It knows no
//! statistics.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::output::print_message;
use crate::settings::Settings;
use psd::study::collection::Progress;

/// Longest time without a line in a pipe.
const SILENT: Duration = Duration::from_secs(30);

/// The display of a study that runs.
pub struct StudyProgress {
    began: Instant,
    printed: Instant,
    bar: Option<ProgressBar>,
}

impl StudyProgress {
    pub fn new(name: &str, settings: Settings) -> Self {
        let bar = settings.stderr_terminal.then(|| {
            let style = ProgressStyle::with_template("  {prefix}  {bar:20} {percent:>3} %  {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            let filled = if settings.unicode { "━╸ " } else { "=> " };
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
                .with_style(style.progress_chars(filled));
            bar.set_prefix(name.to_owned());
            bar
        });
        let began = Instant::now();
        Self {
            began,
            printed: began,
            bar,
        }
    }

    /// Shows how far the study is.
    pub fn show(&mut self, progress: &Progress<'_>) {
        let text = line(progress, self.began.elapsed());
        if let Some(bar) = &self.bar {
            bar.set_length(progress.of);
            bar.set_position(progress.counts.runs);
            bar.set_message(text);
        } else if self.printed.elapsed() >= SILENT {
            self.printed = Instant::now();
            print_message(&format!("  {text}\n"));
        }
    }

    /// Removes the line from the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Runs, rate, failures so far, time left.
fn line(progress: &Progress<'_>, elapsed: Duration) -> String {
    let counts = progress.counts;
    #[expect(clippy::cast_precision_loss, reason = "a rate for display")]
    let [simulated, left] =
        [progress.simulated, progress.of.saturating_sub(counts.runs)].map(|runs| runs as f64);
    let rate = simulated / elapsed.as_secs_f64().max(1e-3);
    let mut text = format!(
        "{} of {} runs, {rate:.0}/s, {} not met",
        counts.runs, progress.of, counts.failed
    );
    if counts.no_result > 0 {
        let _ = write!(text, ", {} without a result", counts.no_result);
    }
    if rate > 0.0 && left > 0.0 {
        let _ = write!(text, ", {} left", duration(left / rate));
    }
    text
}

/// A time of some seconds or hours, with two digits.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 99.5 => format!("{s:.0} s"),
        s if s < 5970.0 => format!("{:.0} min", s / 60.0),
        s if s < 358_000.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} d", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd::study::counts::Counts;

    #[test]
    fn the_line_has_rate_failures_and_time_left() {
        let mut counts = Counts::new(0);
        (counts.runs, counts.failed, counts.no_result) = (3000, 12, 0);
        let mut progress = Progress {
            counts: &counts,
            of: 10_000,
            simulated: 2000,
        };
        let text = line(&progress, Duration::from_secs(4));
        assert_eq!(text, "3000 of 10000 runs, 500/s, 12 not met, 14 s left");
        let mut some = counts.clone();
        some.no_result = 2;
        progress.counts = &some;
        progress.of = 3000;
        let text = line(&progress, Duration::from_secs(4));
        assert_eq!(
            text,
            "3000 of 3000 runs, 500/s, 12 not met, 2 without a result"
        );
        assert_eq!(duration(7200.0), "2 h");
        assert_eq!(duration(1e6), "12 d");
    }
}
