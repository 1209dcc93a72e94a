//! The wall clock of the machine changes by a year, forwards or back, during a run. Durations do not use that clock. Both time
//! stamps are in the run log, and page one reports the jump.

use std::fs;
use std::process::Command;

use crate::needs;
use crate::stage::{PSD, Stage, finish, start};

/// A run whose wall clock changes by this amount at its fifteenth move.
fn jumped(by: &str) -> Stage {
    let stage = Stage::new();
    let clock = stage.path("clock");
    fs::write(&clock, "+0").unwrap();
    let mut command = Command::new(PSD);
    command
        .env("LD_PRELOAD", needs::FAKETIME)
        .env("FAKETIME_TIMESTAMP_FILE", &clock);
    command
        .env("FAKETIME_NO_CACHE", "1")
        .env("FAKETIME_DONT_FAKE_MONOTONIC", "1")
        .env("DONT_FAKE_MONOTONIC", "1");
    stage.run_arguments(&mut command, &["--yes"]);
    let run = start(&mut command);
    stage.after_moves(15);
    fs::write(&clock, by).unwrap();
    let run = finish(run);
    assert_eq!(run.code, Some(0), "{}", run.output);
    stage
}

#[test]
fn it_is_set_by_a_year() {
    if !needs::faketime() {
        return;
    }
    for (by, sign) in [("+1y", '+'), ("-1y", '−')] {
        let stage = jumped(by);
        let journal = fs::read_to_string(stage.journal()).unwrap();
        let years: std::collections::BTreeSet<&str> = journal
            .split("\"wall\":\"")
            .skip(1)
            .map(|rest| &rest[..4])
            .collect();
        assert_eq!(years.len(), 2, "both clocks are kept: {years:?}");
        let times: Vec<f64> = journal
            .lines()
            .filter(|line| line.contains(" SAMPLE "))
            .map(|line| {
                line.split("\"t\":")
                    .nth(1)
                    .unwrap()
                    .split([',', '}'])
                    .next()
                    .unwrap()
                    .parse()
                    .unwrap()
            })
            .collect();
        assert!(
            times
                .windows(2)
                .all(|pair| 0.0 <= pair[1] - pair[0] && pair[1] - pair[0] < 30.0),
            "{times:?}"
        );
        let page = fs::read_to_string(stage.path("run").join("report.html")).unwrap();
        let expected = format!("The wall clock jumped by {sign}365");
        assert!(page.contains(&expected), "page one tells it");
        assert!(stage.proven().contains("ok"));
    }
}
