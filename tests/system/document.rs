//! A run of a procedure document on a real port: stopped, resumed, verified. In: the declarations of a stage in Markdown. Out: a run
//! that is continued from its run log alone, although the document was changed meanwhile.

use std::cell::RefCell;
use std::fs;
use std::path::PathBuf;

use rustix::process::Signal;

use crate::stage::{Stage, finish, signal, start};

#[test]
fn a_run_of_a_document_is_resumed_from_its_log() {
    let folder = RefCell::new(PathBuf::new());
    let write = |plan: &str| {
        let (title, rest) = plan.split_once("limits {").unwrap();
        let (declarations, procedures) = rest.split_once("stiffness ramp").unwrap();
        let document =
            format!("# Procedure\n\nThe rig:\n\n```psd\nlimits {{{declarations}```\n\nEnd.\n");
        fs::write(folder.borrow().join("procedure.md"), document).unwrap();
        format!("{title}use \"procedure.md\"\n\nstiffness ramp{procedures}")
    };
    let stage = Stage::laid_out(write, "", |path| *folder.borrow_mut() = path.to_owned());
    let document = fs::read_to_string(stage.path("procedure.md")).unwrap();
    let run = start(&mut stage.run_with(&["--yes"]));
    stage.after_moves(6);
    signal(&run, Signal::INT);
    let ran = finish(run);
    assert_eq!(ran.code, Some(4), "{}", ran.output);
    fs::write(stage.path("procedure.md"), "# Procedure\n").unwrap();
    stage.goes_on(&[]);
    assert_eq!(
        fs::read_to_string(stage.path("run/plan/procedure.md")).unwrap(),
        document
    );
}
