//! Plans to start from, words of the language, units, completions and manual pages.

use super::workspace::Workspace;

/// A plan to start from has no error, no warning and the layout of the formatter, and its run meets every requirement.
#[test]
fn a_plan_to_start_from_is_right() {
    let workspace = Workspace::new(&[]);
    for kind in ["impact", "frame", "cycle", "ramp", "study"] {
        let file = format!("{kind}.psd");
        let created = workspace.psd(&["new", kind]).with(0);
        assert_eq!(created.stdout, format!("{file}\n"));
        let text = workspace.read(&file);
        assert!(
            text.contains(&format!("psd check {file}")) && !text.contains("FILE"),
            "{text}"
        );
        assert_eq!(workspace.psd(&["new", kind, "-"]).with(0).stdout, text);
        workspace.psd(&["check", "--deny-warnings", &file]).with(0);
        workspace.psd(&["fmt", "--check", &file]).with(0);
        let predicted = workspace.psd(&["check", "--explain", "--format", "json", &file]);
        let predicted = predicted.with(0).json();
        let requirements = &predicted["predictions"][0]["prediction"]["requirements"];
        let requirements = requirements.as_array().expect("a list");
        assert!(!requirements.is_empty());
        for requirement in requirements {
            let of_study = kind == "study" && requirement["name"] == "rarely too far";
            assert!(
                of_study || requirement["verdict"] == "pass",
                "{requirement}"
            );
        }
    }
    workspace.psd(&["study", "run", "study.psd"]).with(0);
    workspace.write("ramp.psd", "mine");
    let kept = workspace.psd(&["new", "ramp"]).with(2).stderr;
    assert!(kept.contains("ramp.psd exists already") && workspace.read("ramp.psd") == "mine");
}

#[test]
fn explain_knows_codes_words_and_units() {
    let workspace = Workspace::new(&[]);
    let explained = |word: &str| workspace.psd(&["explain", word]).with(0).stdout;
    assert!(explained("hit.max_displacement").contains("largest displacement of the structure"));
    assert!(explained("302").starts_with("E302: ") && explained("kN").contains("1000 N"));
    let near = workspace
        .psd(&["explain", "max_displacment"])
        .with(2)
        .stderr;
    assert!(near.contains("did you mean `max_displacement`?"), "{near}");
}

#[test]
fn units_converts_and_lists() {
    let workspace = Workspace::new(&[]);
    let converted = |words: &[&str]| workspace.psd(&[&["units"], words].concat()).with(0).stdout;
    assert_eq!(converted(&["3 kip/in to N/mm"]), "525.3805057 N/mm\n");
    assert_eq!(
        converted(&["3", "kip/in", "to", "N/mm"]),
        "525.3805057 N/mm\n"
    );
    assert!(converted(&["2 mm"]).contains("  0.2            cm\n"));
    assert!(converted(&[]).contains("thousand pound-force"));
    let wrong = |text: &str| workspace.psd(&["units", text]).with(2).stderr;
    assert!(wrong("5 kN to mm").contains("has the dimension force, and `mm` the dimension length"));
    assert!(wrong("5 kNm").contains("did you mean `kN*m`?"));
}

/// Both come from the definition of the command line.
#[test]
fn shells_and_man_know_every_command() {
    let workspace = Workspace::new(&[]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = workspace.psd(&["completions", shell]).with(0).stdout;
        assert!(
            script.contains("verify") && script.contains("deny-warnings"),
            "{shell}"
        );
    }
    assert!(workspace.psd(&["man"]).with(0).stdout.contains(".TH psd 1"));
    workspace.psd(&["man", "--out", "man"]).with(0);
    let page = workspace.read("man/psd-rig-jog.1");
    assert!(page.contains("psd\\-rig\\-jog"), "{page}");
}
