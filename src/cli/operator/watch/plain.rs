//! Observation without the screen: a bar on a terminal, lines otherwise. In: reports of the run. Out: text on standard error, escaped.
//! Neither asks a question.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::operator::pace::clock;
use crate::operator::shown::Shown;
use crate::output::print_message;
use psd::run::{Observer, StepReport};
use psd_plan::record::IS_OUTSIDE;
use psd_plan::record::{Event, EventKind};
use psd_text::count::counted;
use psd_text::diagnostic::excerpt::escape;
use psd_text::units::Dimension;
use psd_text::units::display::readable;

/// A progress bar.
pub struct Bar {
    counted: ProgressStyle,
    endless: ProgressStyle,
    drawn: Option<ProgressBar>,
    shown: Shown,
    /// The time left of the run, if it is known.
    pub left: Option<Duration>,
}

impl Bar {
    pub fn new(unicode: bool, shown: Shown) -> Self {
        let template = |text| {
            ProgressStyle::with_template(text).unwrap_or_else(|_| ProgressStyle::default_bar())
        };
        let filled = if unicode { "━╸ " } else { "=> " };
        Self {
            // The style with a known number of steps, and without one.
            counted: template("  {prefix}  {bar:28} {percent:>3} %  {msg}").progress_chars(filled),
            endless: template("  {prefix}  step {pos}  {msg}"),
            drawn: None,
            shown,
            left: None,
        }
    }

    /// Removes the bar from the terminal.
    pub fn clear(&mut self) {
        if let Some(bar) = self.drawn.take() {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Bar {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        self.clear();
        let style = if steps.is_some() {
            self.counted.clone()
        } else {
            self.endless.clone()
        };
        let bar =
            ProgressBar::with_draw_target(steps, ProgressDrawTarget::stderr()).with_style(style);
        bar.set_prefix(format!("{name}, {keyword}"));
        self.drawn = Some(bar);
    }

    fn step_done(&mut self, report: &StepReport) {
        let step = report.step;
        let Some(bar) = &self.drawn else { return };
        bar.set_position(step);
        // Most steps are never drawn: the text is made for some only.
        if step.is_multiple_of(16) {
            let force = self.shown.force_of(report);
            let (time, displacement) = (
                readable(report.time, Dimension::TIME),
                readable(report.highest(), Dimension::LENGTH),
            );
            bar.set_message(format!(
                "{time}  {displacement}  {}{}{}",
                readable(force, Dimension::FORCE),
                self.shown.of_rig,
                time_left(self.left)
            ));
        }
    }

    fn studying(&mut self, done: usize, of: usize) {
        if let Some(bar) = &self.drawn {
            bar.set_message(format!("uncertainty: {done} of {of} runs re-integrated"));
        }
    }

    fn procedure_finished(&mut self, _: &str) {
        self.clear();
    }
}

/// `, about 1:05 left`
fn time_left(left: Option<Duration>) -> String {
    left.map_or_else(String::new, |left| {
        format!(", about {} left", clock(left.as_secs()))
    })
}

/// Time between two lines about the steps of one procedure.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// One line per procedure, with its result, one every ten seconds while it runs, and one per event that the operator should see when it
/// happens.
#[derive(Default)]
pub struct Lines {
    /// Only events.
    silent: bool,
    shown: Shown,
    name: String,
    keyword: String,
    steps: Option<u64>,
    /// Time of the last line.
    printed: Option<Instant>,
    /// The time left of the run, if it is known.
    pub left: Option<Duration>,
    /// The end of the last step.
    pub now: Option<Instant>,
    /// Number of the last step.
    last: Option<u64>,
    /// Largest |X| \[m\] and |R| \[N\] of the steps.
    largest: (f64, f64),
    /// The force of the axial axes at the last step \[N\].
    axial_force: Option<f64>,
    /// The reading that broke a limit: `force 1.003 kN`.
    stopped_by: Option<String>,
}

impl Lines {
    pub fn new(shown: Shown) -> Self {
        Self {
            shown,
            ..Self::default()
        }
    }

    /// Events only: no progress.
    pub fn silent() -> Self {
        Self {
            silent: true,
            ..Self::default()
        }
    }

    /// The line about a step of a procedure that runs.
    fn progress(&self, report: &StepReport) -> String {
        let of = self.steps.filter(|steps| *steps > 0);
        let of = of.map_or_else(String::new, |steps| {
            format!(" of {}", steps.max(report.step))
        });
        let names = self.shown.names(report.axes.len());
        format!(
            "  {}: step {}{of}, {} {}, {} {}{}{}\n",
            escape(&self.name),
            report.step,
            names.displacement,
            readable(report.highest(), Dimension::LENGTH),
            names.force,
            readable(self.shown.force_of(report), Dimension::FORCE),
            self.shown.of_rig,
            time_left(self.left)
        )
    }

    fn line(&self, name: &str) -> String {
        let mut text = format!("  {}: {}", escape(name), self.keyword);
        if let Some(step) = self.last {
            let steps = counted(step, "step", "steps");
            let (displacement, force) = self.largest;
            let (displacement, force) = (
                readable(displacement, Dimension::LENGTH),
                readable(force, Dimension::FORCE),
            );
            let _ = write!(
                text,
                ", {steps}, largest X {displacement}, largest R {force}{}",
                self.shown.of_rig
            );
        }
        if let Some(force) = self.axial_force {
            let _ = write!(text, ", axial force {}", readable(force, Dimension::FORCE));
        }
        if let Some(reading) = &self.stopped_by {
            let _ = write!(text, "; stopped by {reading}");
        }
        text.push('\n');
        text
    }
}

impl Observer for Lines {
    fn procedure_started(&mut self, name: &str, keyword: &str, steps: Option<u64>) {
        *self = Self {
            silent: self.silent,
            shown: std::mem::take(&mut self.shown),
            name: name.to_owned(),
            keyword: keyword.to_owned(),
            steps,
            printed: Some(Instant::now()),
            left: self.left,
            ..Self::default()
        };
    }

    fn step_done(&mut self, report: &StepReport) {
        self.last = Some(report.step);
        self.axial_force = report.axial_force;
        for axis in &report.axes {
            self.largest = (
                self.largest.0.max(axis.displacement.abs()),
                self.largest.1.max(axis.force.abs()),
            );
        }
        let since = self.now.zip(self.printed);
        let due = since.is_some_and(|(now, at)| now.duration_since(at) >= BETWEEN_LINES);
        if due && !self.silent {
            self.printed = self.now;
            print_message(&self.progress(report));
        }
    }

    fn procedure_finished(&mut self, name: &str) {
        if !self.silent {
            print_message(&self.line(name));
        }
    }

    fn event(&mut self, event: &Event) {
        if event.kind == EventKind::LimitBreach {
            let reading = event.text.split(IS_OUTSIDE).next();
            self.stopped_by = reading.map(escape);
        }
        // Observations appear in the report only.
        if event.kind != EventKind::Remark {
            print_message(&format!("  {}\n", escape(&event.text).replace('\n', " ")));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::screen::model::tests::step;

    #[test]
    fn a_procedure_is_one_line_with_its_largest_values() {
        let mut lines = Lines::default();
        lines.procedure_started("k0", "stiffness ramp", Some(2));
        lines.step_done(&step(1, 0.1, 0.002_002, -600.0));
        lines.step_done(&step(2, 0.2, 0.001, 10.0));
        assert_eq!(
            lines.line("k0"),
            "  k0: stiffness ramp, 2 steps, largest X 2.000 mm, largest R 600.0 N\n"
        );
        lines.procedure_started("down", "preload", Some(1));
        lines.step_done(&StepReport {
            axial_force: Some(262_500.0),
            ..step(1, 0.1, 0.0, 40.0)
        });
        assert_eq!(
            lines.line("down"),
            "  down: preload, 1 step, largest X 2.000 µm, largest R 40.00 N, axial force 262.5 kN\n"
        );
        lines.procedure_started("look", "inspect", Some(0));
        lines.event(&Event {
            time: 0.3,
            procedure: None,
            step: None,
            kind: EventKind::LimitBreach,
            text: "force 1.003 kN is outside its limit -1 kN .. 1 kN".to_owned(),
        });
        assert_eq!(
            lines.line("hit"),
            "  hit: inspect; stopped by force 1.003 kN\n"
        );
        lines.procedure_started("hit", "impact", Some(500));
        lines.left = Some(Duration::from_secs(65));
        assert_eq!(
            lines.progress(&step(120, 0.2, 0.002_002, 10.0)),
            "  hit: step 120 of 500, X 2.000 mm, R 10.00 N, about 1:05 left\n"
        );
        lines.procedure_started("look", "inspect", Some(0));
        assert_eq!(lines.line("lo\u{1b}ok"), "  lo\\u{1b}ok: inspect\n");
    }
}
