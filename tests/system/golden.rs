//! The reports of `psd test`, read by their standard programs: JUnit by an XML parser, TAP by `prove`.

use std::path::Path;
use std::process::{Command, Output};

use super::needs;

const PLAN: &str = "specimen beam {\n  mass = 1 kg\n  behaviour = elastic(stiffness: 300 N/m)\n}\n\n\
    stiffness ramp k0 {\n  displacements = 1 mm .. 5 mm step 1 mm\n}\n\n\
    require \"stiff <&> \\\"sound\\\"\" k0.stiffness > 1 N/m\n\nreport {\n  figures = []\n  formats = [csv]\n}\n";

/// Plans `as` and `moved`, both with accepted results. The second one then gives a different number.
fn two_plans() -> tempfile::TempDir {
    let folder = crate::stage::folder();
    std::fs::create_dir(folder.path().join("plans")).unwrap();
    for name in ["as", "moved"] {
        std::fs::write(folder.path().join(format!("plans/{name}.psd")), PLAN).unwrap();
    }
    assert!(psd(folder.path(), &["test", "--accept"]).status.success());
    let summary = folder.path().join("reports/moved/summary.json");
    let text = std::fs::read_to_string(&summary)
        .unwrap()
        .replace("\"stiff <&>", "\"stout <&>");
    std::fs::write(summary, text).unwrap();
    folder
}

fn psd(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_psd"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn junit_is_read_by_a_parser_of_xml() {
    if !needs::python() {
        return;
    }
    let folder = two_plans();
    assert_eq!(
        psd(folder.path(), &["test", "--junit", "golden.xml"])
            .status
            .code(),
        Some(5)
    );
    let reader = "import xml.etree.ElementTree as e\nr = e.parse('golden.xml').getroot()\n\
        print(r.tag, r.get('tests'), r.get('failures'), r.get('errors'))\n\
        for c in r.iter('testcase'):\n    f = c.find('failure')\n    \
        print(c.get('classname'), c.get('name'), '-' if f is None else f.get('message') + '|' + f.text)\n";
    let read = Command::new("python3")
        .args(["-c", reader])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(read.status.success(), "{}", text(&read.stderr));
    let output = text(&read.stdout);
    let lines: Vec<&str> = output.lines().collect();
    assert_eq!(lines[..2], ["testsuites 2 1 0", "plans as -"], "{output}");
    assert!(
        lines[2].starts_with(
            "plans moved 2 differences from the accepted results|require \"stout <&> \"sound\"\""
        ),
        "{output}"
    );
}

#[test]
fn tap_is_read_by_prove() {
    if !needs::prove() {
        return;
    }
    let folder = two_plans();
    let proven = |name: &str, arguments: &[&str]| {
        std::fs::write(
            folder.path().join(name),
            psd(folder.path(), arguments).stdout,
        )
        .unwrap();
        let output = Command::new("prove")
            .args(["--exec", "cat", name])
            .current_dir(folder.path())
            .output()
            .unwrap();
        (output.status.success(), text(&output.stdout))
    };
    let (good, output) = proven("good.t", &["test", "--tap", "--filter", "plans/as"]);
    assert!(
        good && output.contains("Result: PASS") && output.contains("Tests=1"),
        "{output}"
    );
    let (good, output) = proven("bad.t", &["test", "--tap"]);
    assert!(
        !good && output.contains("Failed 1/2 subtests") && output.contains("Failed test:  2"),
        "{output}"
    );
    // Parsed without an error: the TAP plan and its lines agree.
    assert!(!output.contains("Parse errors"), "{output}");
}
