//! The operator ends a run in every phase: INT, TERM, HUP and QUIT, and a closed terminal. In: a moment of a run, a jog, or a
//! serve session. Out: the rig in hold, exit code 4, and a valid run log of a run that can be resumed.

use std::process::Command;
use std::time::Duration;

use rustix::process::Signal;

use crate::needs;
use crate::served::Served;
use crate::stage::{Ended, PSD, Stage, code, finish, signal, start, until};
use crate::terminal::{GO_ON, LEAVE, MOVE, RELEASE, Terminal};

const SIGNALS: [Signal; 5] = [
    Signal::INT,
    Signal::TERM,
    Signal::HUP,
    Signal::QUIT,
    Signal::POWER,
];

/// Sends each signal at the same moment of a separate run. The run of the first one is resumed, if it is `quick`.
fn each(
    plan: impl Fn(&str) -> String + Sync,
    quick: bool,
    moment: impl Fn(&Stage) + Sync,
    then: impl Fn(&Stage) + Sync,
) {
    each_of(&SIGNALS, plan, quick, moment, then);
}

fn each_of(
    signals: &[Signal],
    plan: impl Fn(&str) -> String + Sync,
    quick: bool,
    moment: impl Fn(&Stage) + Sync,
    then: impl Fn(&Stage) + Sync,
) {
    let one = |sent| {
        // Of use where it does not stop: the rig waits a fifth of a step for a late target.
        let stage = Stage::of(&plan, "at 0 s: coast 2 s");
        let run = start(&mut stage.run_with(&["--yes"]));
        moment(&stage);
        signal(&run, sent);
        stage.held_and_sound(&finish(run));
        then(&stage);
        if quick && sent == SIGNALS[0] {
            stage.goes_on(&[]);
        }
    };
    std::thread::scope(|scope| {
        for sent in signals {
            scope.spawn(|| one(*sent));
        }
    });
}

fn as_it_is(plan: &str) -> String {
    plan.to_owned()
}

/// Slow, so that a signal arrives during motion: the probe takes 0.4 s, a step of the ramp 2 s.
fn slow(plan: &str) -> String {
    plan.replace(
        "speed      = 20 mm/s",
        "speed      = 0.05 mm/s\n  resolution = 1 um",
    )
    .replace("probe(0.1 mm", "probe(0.02 mm")
}

/// Too slow to wait for the end of a move: the probe takes 2 s, the first step of the ramp 400 s.
fn endless(plan: &str) -> String {
    let slower = plan.replace(
        "speed      = 20 mm/s",
        "speed      = 0.01 mm/s\n  resolution = 1 um",
    );
    slower
        .replace("probe(0.1 mm", "probe(0.02 mm")
        .replace("0.1 mm .. 0.8 mm step 0.1 mm", "[4, 5, 6] mm")
}

/// The number of readings requested from the rig.
fn readings(stage: &Stage) -> usize {
    stage
        .requests()
        .iter()
        .filter(|request| request.contains(">MEAS"))
        .count()
}

/// Waits until the line has been silent for a while.
fn quiet(stage: &Stage) {
    let mut asked = usize::MAX;
    until("nothing is asked", || {
        std::thread::sleep(Duration::from_millis(200));
        std::mem::replace(&mut asked, stage.requests().len()) == asked
    });
}

/// Settles slowly, so that a signal arrives before the probe: the two readings at rest take 2 s each, with a second between
/// them.
fn resting(plan: &str) -> String {
    plan.replace("for: 0.01 s", "for: 2 s")
        .replace("0.8 mm step 0.1 mm", "0.3 mm step 0.1 mm")
        .replace("duration  = 24 ms", "duration  = 2 ms")
}

/// Waits until the rig is released; the readings at rest are next.
fn released(stage: &Stage) {
    until("the release", || {
        std::fs::read_to_string(stage.journal())
            .is_ok_and(|record| record.contains("released with --yes, without a prompt"))
    });
}

#[test]
fn at_rest_before_the_probe_of_the_pretest_check() {
    each(resting, true, released, |stage| {
        assert!(stage.moves().is_empty());
    });
}

#[test]
fn in_the_probe_of_the_pretest_check() {
    let out_and_back = |stage: &Stage| assert_eq!(stage.moves().len(), 2, "and nothing after it");
    each_of(
        &SIGNALS[..1],
        endless,
        false,
        |stage| stage.after_moves(1),
        out_and_back,
    );
    each_of(
        &SIGNALS[1..],
        endless,
        false,
        |stage| stage.after_moves(1),
        |stage| assert_eq!(stage.moves().len(), 1),
    );
}

/// psd does not wait for the end of the move: at shutdown the system kills the remaining programs after some seconds.
#[test]
fn in_the_middle_of_a_move_all_but_one_ctrl_c_hold_at_once() {
    each_of(
        &SIGNALS[1..],
        endless,
        false,
        |stage| stage.after_moves(3),
        |stage| assert_eq!(stage.moves().len(), 3),
    );
    let stage = Stage::of(endless, "");
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    signal(&run, Signal::INT);
    // Two signals that the program receives as one would be one Ctrl-C.
    std::thread::sleep(Duration::from_millis(200));
    signal(&run, Signal::INT);
    stage.held_and_sound(&finish(run));
}

#[test]
fn signals_of_other_programs_do_nothing() {
    let stage = Stage::new();
    let run = start(&mut stage.run_with(&["--yes"]));
    let ignored = [
        Signal::USR1,
        Signal::USR2,
        Signal::ALARM,
        Signal::VTALARM,
        Signal::PROF,
        Signal::XCPU,
        Signal::IO,
        Signal::SYS,
        Signal::STKFLT,
    ];
    for (moves, sent) in (1..).zip(ignored) {
        stage.after_moves(2 * moves);
        signal(&run, sent);
    }
    let ended = finish(run);
    assert_eq!(ended.code, Some(0), "{}", ended.output);
    stage.proven();
}

#[test]
fn in_a_ramp() {
    each(as_it_is, true, |stage| stage.after_moves(10), |_| {});
}

#[test]
fn while_a_step_settles() {
    let settling = |stage: &Stage| {
        stage.after_moves(3);
        let before = readings(stage);
        until("it settles", || readings(stage) > before + 5);
    };
    each(
        |plan| plan.replace("for: 0.01 s", "for: 2 s"),
        false,
        settling,
        |stage| assert_eq!(stage.moves().len(), 3),
    );
}

#[test]
fn between_two_moves() {
    let pausing = |stage: &Stage| {
        stage.after_moves(3);
        quiet(stage);
    };
    each(
        |plan| plan.replace("pause         = 0 s", "pause         = 2 s"),
        false,
        pausing,
        |_| {},
    );
}

#[test]
fn in_a_stroke_of_a_sweep() {
    const SWEEP: &str = "damping sweep c {\n  velocities = [0.5, 1] mm/s\n  stroke     = 0.8 mm\n  stiffness  = k0.stiffness\n  \
                         rate       = 20 Hz\n}\n\ninspect look {";
    each(
        |plan| plan.replace("inspect look {", SWEEP),
        false,
        |stage| stage.after_moves(20),
        |_| {},
    );
}

#[test]
fn during_an_impact() {
    each(as_it_is, true, |stage| stage.after_moves(30), |_| {});
}

#[test]
fn while_it_does_not_stop() {
    // Targets and answers must arrive within a fifth of a step: a machine with many busy programs has 2 s for each.
    let moving = |plan: &str| {
        plan.replace(
            "  duration  = 24 ms\n  pause     = 0 s",
            "  duration  = 2 ms\n  mode      = continuous(time_scale: 10000)",
        )
    };
    each(moving, true, |stage| stage.after_moves(22), |_| {});
}

/// A run with an operator at the terminal: display, questions and keys.
#[test]
fn while_somebody_is_asked() {
    std::thread::scope(|scope| {
        for (sent, question) in SIGNALS
            .into_iter()
            .flat_map(|sent| [(sent, RELEASE), (sent, GO_ON)])
        {
            scope.spawn(move || {
                let stage = Stage::new();
                let mut terminal = Terminal::start(&mut stage.run_with(&[]));
                if question != RELEASE {
                    terminal.answer(RELEASE, "RELEASE\n");
                }
                terminal.answer(question, "");
                signal(&terminal.child, sent);
                // The operator at the keys still watches a rig that was released.
                if question == GO_ON && sent == Signal::INT {
                    terminal.answer(LEAVE, "x\n");
                }
                if question == GO_ON && sent == Signal::QUIT {
                    terminal.answer(LEAVE, "");
                    signal(&terminal.child, sent);
                }
                let code = terminal.code();
                stage.held_and_sound(&Ended {
                    code,
                    output: terminal.shown(),
                });
                assert_eq!(stage.moves().is_empty(), question == RELEASE);
            });
        }
    });
}

/// A run of half a minute: it is still active on a slow machine when the key is received.
#[test]
fn while_it_is_paused_by_a_key() {
    std::thread::scope(|scope| {
        for sent in SIGNALS {
            scope.spawn(move || {
                let stage = Stage::of(slow, "");
                let mut terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
                stage.after_moves(3);
                terminal.press("p");
                // The screen changes `PAUSING` to `PAUSED` by the different letters only.
                until("it pauses", || terminal.shown().contains("PAUS"));
                quiet(&stage);
                signal(&terminal.child, sent);
                let code = terminal.code();
                stage.held_and_sound(&Ended {
                    code,
                    output: terminal.shown(),
                });
            });
        }
    });
}

/// The screen detects that its terminal is closed: a program outside the terminal's session receives no signal.
fn in_the_middle_of_a_move() {
    let stage = Stage::of(endless, "");
    let terminal = Terminal::with_screen(&mut stage.run_with(&["--yes"]));
    stage.after_moves(3);
    let (mut child, shown) = terminal.dies();
    let code = code(&mut child);
    stage.held_and_sound(&Ended {
        code,
        output: shown,
    });
}

/// A closed window: its programs get HUP, and can neither read nor write any more.
#[test]
fn of_a_terminal_that_dies() {
    if !needs::setsid() {
        return;
    }
    let one = |screen: bool, yes: &[&str], moment: &(dyn Fn(&Stage, &mut Terminal) + Sync)| {
        let stage = Stage::new();
        // The program has its own terminal, as from a shell.
        let mut command = Command::new("setsid");
        command.args(["--ctty", PSD]);
        stage.run_arguments(&mut command, yes);
        let mut terminal = if screen {
            Terminal::with_screen(&mut command)
        } else {
            Terminal::start(&mut command)
        };
        moment(&stage, &mut terminal);
        let (mut child, shown) = terminal.dies();
        let code = code(&mut child);
        stage.held_and_sound(&Ended {
            code,
            output: shown,
        });
        stage.goes_on(&[]);
    };
    let in_the_ramp = |stage: &Stage, _: &mut Terminal| stage.after_moves(10);
    let at_a_question = |_: &Stage, terminal: &mut Terminal| {
        terminal.answer(RELEASE, "RELEASE\n");
        terminal.answer(GO_ON, "");
    };
    let at_the_release = |_: &Stage, terminal: &mut Terminal| terminal.answer("RELEASE:", "");
    std::thread::scope(|scope| {
        scope.spawn(in_the_middle_of_a_move);
        scope.spawn(|| one(false, &["--yes"], &in_the_ramp));
        scope.spawn(|| one(true, &["--yes"], &in_the_ramp));
        scope.spawn(|| one(false, &[], &at_a_question));
        scope.spawn(|| one(true, &[], &at_the_release));
    });
}

#[test]
fn during_a_jog_and_while_it_asks() {
    std::thread::scope(|scope| {
        for sent in SIGNALS {
            scope.spawn(move || {
                let stage = Stage::of(
                    |plan| plan.replace("samples    = 1", "samples    = 1\n  resolution = 1 um"),
                    "",
                );
                let jog = start(
                    &mut stage
                        .recorded_tool("jog", &["--to", "1 mm", "--speed", "0.05 mm/s", "--yes"]),
                );
                stage.after_moves(1);
                signal(&jog, sent);
                let ended = finish(jog);
                assert!(
                    ended.code == Some(4) && ended.output.contains("on request"),
                    "{}",
                    ended.output
                );
                assert!(stage.is_held());
                stage.proven();
            });
            scope.spawn(move || {
                for (arguments, question) in [(&[][..], "target?"), (&["--to", "1 mm"][..], MOVE)] {
                    let stage = Stage::new();
                    let mut terminal = Terminal::start(&mut stage.recorded_tool("jog", arguments));
                    terminal.answer(question, "");
                    signal(&terminal.child, sent);
                    assert_eq!(terminal.code(), Some(4), "{}", terminal.shown());
                    assert!(stage.moves().is_empty() && stage.is_held());
                    stage.proven();
                }
            });
        }
    });
}

#[test]
fn of_a_serving_in_its_pretest_check_and_while_a_client_is_waited_for() {
    std::thread::scope(|scope| {
        for sent in SIGNALS {
            scope.spawn(move || {
                let arguments = ["--protocol", "nees", "--listen", "127.0.0.1:0", "--yes"];
                let stage = Stage::of(resting, "");
                let serving = start(&mut stage.recorded_tool("serve", &arguments));
                released(&stage);
                signal(&serving, sent);
                let ended = finish(serving);
                assert_eq!(ended.code, Some(4), "{}", ended.output);
                assert!(!ended.output.contains("ready: nees"), "{}", ended.output);
                assert!(stage.moves().is_empty() && stage.is_held());
                stage.proven();
            });
            scope.spawn(move || {
                let mut served = Served::start_on(Stage::new(), "nees", &[]);
                // No client connected, and all requested actions were done.
                assert_eq!(served.stop(sent), (Some(0), String::new()));
                assert_eq!(served.stage.moves().len(), 2);
                assert!(served.stage.is_held());
            });
        }
    });
}
