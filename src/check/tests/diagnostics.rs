//! Each diagnostic of the check on the smallest plan that causes it, and nothing that only follows from it.

use super::{checked, files, no_files};

const BODY: &str = "specimen beam { mass = 1 kg\n behaviour = elastic(300 kN/m) }\nstriker ball { mass = 10 kg\n velocity = 1 m/s }\n";

/// The diagnostics of a specimen, a striker and `more`; warnings that nothing is required or run are omitted.
fn reported(more: &str) -> String {
    let (_, reported) = checked(
        &format!("{BODY}{more}"),
        &files(&[("a.psd", "use \"b.psd\""), ("b.psd", "use \"a.psd\"")]),
        &[],
    );
    reported
        .lines()
        .filter(|line| {
            !line.starts_with("W704") && !line.starts_with("W705") && !line.starts_with("W706")
        })
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn each_error_is_reported_once_at_its_span() {
    let cases = [
        ("stifness ramp k { }", "E201 stifness ramp"),
        (
            "striker b { mass = 1 kg\n velocty = 1 m/s }",
            "E202 velocty",
        ),
        ("let a = widht", "E203 widht"),
        ("let a = 3 kq", "E204 kq"),
        ("let a = 3 N/mq", "E204 mq"),
        (
            "impact h { striker = ball\n duration = 1 s\n contact = rigit }",
            "E205 rigit",
        ),
        (
            "stiffness ramp k { displacements = [1, 2] mm }\nlet a = k.stifness",
            "E206 stifness",
        ),
        ("let a = sqr(2)", "E207 sqr"),
        ("let a = 1\nlet a = 2", "E208 a"),
        ("move m { to = 1 mm\n to = 2 mm }", "E208 to"),
        ("striker b { velocity = 1 m/s }", "E209 striker b"),
        ("striker { mass = 1 kg\n velocity = 1 m/s }", "E212 striker"),
        (
            "impact h { striker = ball\n duration = 1 s\n contact = limit(1 N, 2 N) }",
            "E213 2 N",
        ),
        ("striker b { mass = 3 mm\n velocity = 1 m/s }", "E301 3 mm"),
        ("striker b { mass = 3\n velocity = 1 m/s }", "E302 3"),
        ("let a = 3 mm + 2 kg", "E303 3 mm"),
        ("let a = \"text\"", "E304 \"text\""),
        ("let a = (2 m)^0.37", "E305 0.37"),
        (
            "striker b { mass = -3 kg\n velocity = 1 m/s }",
            "E401 -3 kg",
        ),
        (
            "stiffness ramp k { displacements = 0 mm .. 1 mm step 0.3 mm }",
            "E402 0.3 mm",
        ),
        (
            "specimen s { mass = 1 kg\n behaviour = elastic(k.stiffness) }\nstiffness ramp k { specimen = s\n displacements = [1, 2] mm }",
            "E403 k.stiffness",
        ),
        ("let a = b\nlet b = a", "E404 a"),
        (
            "impact h { striker = ball\n duration = 1 s\n time_step = 1 us / 100 }",
            "E405 1 s",
        ),
        ("let a = 1 / 0", "E407 1 / 0"),
        ("plan \"p\" { edition = 2 }", "E408 2"),
        ("use \"none.psd\"\nlet a = lost", "E501 none.psd"),
        ("use \"../x.psd\"", "E502 ../x.psd"),
        ("use \"a.psd\"", "E503 a.psd"),
        (
            "specimen s { mass = 1 kg\n behaviour = elastic(1 N/m) }\nstiffness ramp k { displacements = [1, 2] mm }",
            "E601 stiffness ramp k",
        ),
        (
            "limits { displacement = 1 mm }\nmove m { to = 2 mm }",
            "E602 2 mm",
        ),
        (
            "limits { force = 2 kN }\nlimits l { force = 1 kN }\nrig r { link = virtual\n limits = l }",
            "E604 2 kN",
        ),
        (
            "impact h { striker = ball\n duration = 1 s\n time_step = 5 ms }",
            "W701 5 ms",
        ),
        (
            "impact h { striker = ball\n duration = 1 s }\nrequire \"p\" h.max_contact_force < 1 kN",
            "W702 h.max_contact_force < 1 kN",
        ),
        (
            "impact h { striker = ball\n duration = 1 s\n contact = limit(1500 N)\n time_step = 0.9 ms }",
            "W703 0.9 ms",
        ),
    ];
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(plan, expected)| {
            let found = reported(plan);
            let quoted = expected.replace('"', "");
            (found != *expected && found.replace('"', "") != quoted)
                .then(|| format!("{plan}\n  expected {expected}\n  found    {found}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_plan_as_a_whole_and_the_command_line() {
    let only = |text: &str, settings: &[(&str, &str)]| checked(text, &no_files, settings).1;
    assert_eq!(
        only("stiffness ramp k { displacements = [1, 2] mm }", &[]),
        "E210 stiffness ramp k"
    );
    assert_eq!(only("param v = 1 m/s", &[("w", "1 m/s")]), "E214 ");
    assert_eq!(
        only("param v = 1 m/s between 0 m/s .. 2 m/s", &[("v", "9 m/s")]),
        "E406 9 m/s"
    );
    assert_eq!(only("param v = 1 m/s", &[("v", "9 kg")]), "E301 9 kg");
    assert_eq!(only(BODY, &[]), "W705 \nW706 ball");
    assert_eq!(
        only(&format!("{BODY}let a = 1\nmove m {{ to = 1 mm }}"), &[]),
        "W706 ball\nW706 a\nW704 move m"
    );
    let rig = crate::check::Options {
        rig: Some("x".to_owned()),
        ..Default::default()
    };
    let found = crate::check::check("p.psd", BODY, &no_files, &rig).diagnostics;
    assert_eq!(
        found
            .iter()
            .map(|diagnostic| diagnostic.code.id())
            .collect::<Vec<_>>(),
        ["E603"]
    );
}

#[test]
fn no_follow_on_error_is_reported() {
    assert_eq!(
        reported("let a = 3 kq\nlet b = a + 2 mm\nmove m { to = b }"),
        "E204 kq"
    );
    assert_eq!(reported("studdy g { runs = 1 }\nlet a = g"), "E201 studdy");
    let found = reported("let width 3 mm\nmove m { to = width }");
    assert!(
        found.starts_with("E101") && found.lines().count() == 1,
        "{found}"
    );
}
