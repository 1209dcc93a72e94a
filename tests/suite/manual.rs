//! Checks of the book's pages on controllers, native protocol and run log. Rig blocks pass their check, frames equal those of the driver,
//! entries equal those of the run log.

use std::fs;
use std::path::Path;

use psd::check::{LoadError, Options, check};
use psd_language::syntax::{format, parse};
use psd_plan::{AxialAxis, Interval};
use psd_rig::controllers::native;
use psd_rig::controllers::native::codec::{
    AxisBounds, Bounds, End, LONGEST_FRAME, ReplyKind, Request,
};
use psd_rig::journal::EntryKind;
use psd_text::diagnostic::render::{Appearance, render_all};
use psd_text::source::Sources;

/// The plans of the manual use no file but a ground motion.
fn ground(path: &str) -> Result<String, LoadError> {
    let ground = "time_s,acceleration_m_per_s2\n0,0\n0.1,1\n0.2,0\n";
    if path == "ground.csv" {
        Ok(ground.to_owned())
    } else {
        Err(LoadError::NotFound)
    }
}

fn page(name: &str) -> String {
    fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("docs")
            .join(name),
    )
    .expect("the page is there")
}

/// The fenced blocks of a language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(&fence)
        .skip(1)
        .map(|after| after.split("```").next().unwrap_or_default().to_owned())
        .collect()
}

#[test]
fn every_rig_block_checks_in_the_plan_around_it() {
    let plans = blocks(&page("rigs.md"), "psd");
    let (around, rigs): (Vec<&String>, Vec<&String>) =
        plans.iter().partition(|plan| !plan.starts_with("rig "));
    assert_eq!(
        around.len(),
        2,
        "a plan is around every rig of one axis, and another around those of several"
    );
    assert!(rigs.len() >= 8, "each kind of rig has its block");
    for rig in &rigs {
        let name = rig
            .split_whitespace()
            .nth(1)
            .expect("a rig has a name")
            .to_owned();
        let several = rig.contains("  axes ");
        let plan = around
            .iter()
            .find(|plan| plan.contains("storey(") == several)
            .expect("the plan around it");
        let plan = format!("{plan}\n{rig}");
        let mut sources = Sources::default();
        let file = sources.add("rigs.psd", &plan);
        assert_eq!(
            format(&parse(&sources, file).0, &plan),
            plan,
            "psd fmt would change `{name}`"
        );
        let checked = check(
            "rigs.psd",
            &plan,
            &ground,
            &Options {
                rig: Some(name),
                ..Options::default()
            },
        );
        let diagnostics = render_all(&checked.diagnostics, &checked.sources, &Appearance::plain());
        assert!(
            checked.plan.is_some() && checked.diagnostics.is_empty(),
            "{plan}\n{diagnostics}"
        );
    }
    for dialect in [
        "native",
        "grbl",
        "hx711",
        "indicator",
        "scpi(",
        "instron",
        "mark10",
        "modbus(",
        "nees(",
    ] {
        assert!(
            rigs.iter().any(|rig| rig.contains(dialect)),
            "{dialect} has no block"
        );
    }
}

/// The frames of the protocol's conversations, for a rig of one axis, for one of two, and in force control, without their endings.
fn frames() -> Vec<String> {
    let page = page("reference/native-protocol.md");
    let talks: Vec<_> = blocks(&page, "text")
        .into_iter()
        .filter(|block| block.starts_with(">HELLO"))
        .collect();
    assert_eq!(talks.len(), 3, "three conversations are shown");
    talks
        .iter()
        .flat_map(|talk| talk.lines())
        .map(str::to_owned)
        .collect()
}

fn metres(word: &str) -> f64 {
    word.parse::<f64>().expect("a number in mm") / 1e3
}

fn newtons(word: &str) -> f64 {
    word.parse().expect("a number in N")
}

#[test]
fn every_request_on_the_page_is_the_frame_the_driver_sends() {
    let mut verbs = Vec::new();
    for shown in frames().iter().filter(|line| line.starts_with('>')) {
        let (body, _) = shown[1..]
            .rsplit_once('*')
            .expect("a frame has its checksum");
        let words: Vec<&str> = body.split(' ').collect();
        let sequence: u32 = words[1].parse().expect("a sequence number");
        let (bounds, targets, rate, control, ends);
        let request = match (words[0], &words[2..]) {
            ("HELLO", []) => Request::Hello,
            ("LIM", [axes @ .., speed]) => {
                let axis = |words: &[&str]| {
                    let [low, high, least, most] = words else {
                        panic!("four limits for each axis: {shown}")
                    };
                    AxisBounds {
                        displacement: Interval {
                            low: metres(low),
                            high: metres(high),
                        },
                        force: Interval {
                            low: newtons(least),
                            high: newtons(most),
                        },
                    }
                };
                bounds = Bounds {
                    axes: axes.chunks(4).map(axis).collect(),
                    top_speed: metres(speed),
                };
                Request::Limits(&bounds)
            }
            ("MOVE", [id, positions @ .., speed]) => {
                // A force has three decimals.
                let written = |word: &&str| match word.split_once('.') {
                    Some((_, decimals)) if decimals.len() == 3 => {
                        native::codec::force(newtons(word))
                    }
                    _ => native::codec::length(metres(word)),
                };
                let each: Option<Vec<String>> = positions.iter().map(written).collect();
                targets = each.expect("they can be said").join(" ");
                rate = native::codec::length(metres(speed)).expect("it can be said");
                Request::Move {
                    id: id.parse().expect("a number"),
                    targets: &targets,
                    speed: &rate,
                }
            }
            ("FORCE", words) => {
                let axis = |pair: &[&str]| {
                    let rate = newtons(pair[0]);
                    (rate > 0.0).then(|| AxialAxis {
                        storey: 0,
                        rate,
                        tolerance: newtons(pair[1]),
                        p_delta: 1.0,
                    })
                };
                control = words.chunks(2).map(axis).collect::<Vec<_>>();
                Request::Force(&control)
            }
            ("GLIDE", [id, words @ .., time]) => {
                let end = |pair: &[&str]| End {
                    position: metres(pair[0]),
                    velocity: metres(pair[1]),
                };
                ends = words.chunks(2).map(end).collect::<Vec<End>>();
                Request::Glide {
                    id: id.parse().expect("a number"),
                    ends: &ends,
                    seconds: metres(time),
                }
            }
            ("MEAS", [readings]) => Request::Measure {
                readings: readings.parse().expect("a number"),
            },
            ("STAT", []) => Request::Status,
            ("STOP", []) => Request::Stop,
            ("CLR", []) => Request::Clear,
            ("REF", [token]) => Request::Reference { token },
            _ => panic!("the driver asks nothing like `{shown}`"),
        };
        let frame = native::codec::frame(sequence, &request).expect("it can be said");
        assert_eq!(String::from_utf8_lossy(&frame), format!("{shown}\n"));
        assert!(frame.len() <= LONGEST_FRAME || words.len() > 8);
        verbs.push(words[0].to_owned());
    }
    for verb in [
        "HELLO", "LIM", "FORCE", "MOVE", "GLIDE", "MEAS", "STAT", "STOP", "CLR", "REF",
    ] {
        assert!(
            verbs.iter().any(|shown| shown == verb),
            "{verb} is not shown"
        );
    }
}

#[test]
fn every_reply_on_the_page_is_valid_and_has_the_meaning_on_the_page() {
    let frames = frames();
    let replies: Vec<_> = frames
        .iter()
        .filter(|line| line.starts_with('<'))
        .map(|line| (line, native::codec::reply(line.as_bytes())))
        .collect();
    assert_eq!(
        replies.len() * 2,
        frames.len(),
        "each request has its reply"
    );
    for (line, reply) in replies {
        let reply = reply.unwrap_or_else(|broken| panic!("{line}: {broken:?}"));
        assert_eq!(reply.boot(), "7F3A");
        let parts = reply.words();
        match (reply.kind, parts.len()) {
            (ReplyKind::Data, words) => {
                let data =
                    native::codec::data(&parts).unwrap_or_else(|| panic!("{line} is no reading"));
                assert_eq!(data.axes.len(), (words - 2) / 4);
            }
            (ReplyKind::Ack, 10 | 15) => {
                let hello = native::codec::hello(&parts).expect("who the rig is");
                let highs: Vec<(f64, f64)> = hello
                    .bounds
                    .axes
                    .iter()
                    .map(|axis| (axis.displacement.high, axis.force.high))
                    .collect();
                assert_eq!(hello.bounds.top_speed, 0.12);
                let last = hello.last;
                if parts.len() == 10 {
                    assert_eq!((highs, last), (vec![(0.025, 12e3)], Some((16, vec![1.0]))));
                } else {
                    let of_two = (vec![(0.03, 8e3), (0.06, 5e3)], Some((21, vec![1.25, -2.5])));
                    let axial = (vec![(0.03, 8e4), (0.004, 3e5)], Some((21, vec![0.0, 0.0])));
                    assert!([of_two, axial].contains(&(highs, last)), "{line}");
                }
            }
            (ReplyKind::Ack, 2) if native::codec::left(&parts).is_some() => {
                assert!(line.contains("MOVING"), "{line}");
            }
            (ReplyKind::Ack, _) => assert!(native::codec::state(parts[0]).is_some(), "{line}"),
            (ReplyKind::Err, _) => assert!(
                !native::codec::refusal(&parts).contains("does not know"),
                "{line}"
            ),
        }
    }
}

#[test]
fn every_refusal_on_the_page_is_one_the_driver_knows() {
    let page = page("reference/native-protocol.md");
    let codes: Vec<String> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `ERR "))
        .filter_map(|rest| rest.split('`').next())
        .map(str::to_owned)
        .collect();
    assert_eq!(codes.len(), 12);
    for code in codes {
        let line = native::codec::refusal(&[code.as_str()]);
        assert!(
            !line.contains("for a reason unknown to psd"),
            "{code}: {line}"
        );
    }
    assert!(
        page.contains("`123456789` gives 29B1") && native::codec::checksum(b"123456789") == 0x29b1
    );
}

#[test]
fn every_record_type_is_on_the_page_and_no_other() {
    let page = page("record.md");
    let listed: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("### `"))
        .filter_map(|rest| rest.split('`').next())
        .collect();
    assert_eq!(
        listed,
        EntryKind::ALL.map(EntryKind::word),
        "a heading for each record type, in order"
    );
}
