//! Canonical form: exact for chosen cases; idempotent and with the same meaning for many.

use proptest::prelude::*;

use super::format;
use crate::syntax::tests::corpus::soup;
use crate::syntax::tests::{IMPACT, QUAKE, outline, read, sound};

fn formatted(text: &str) -> String {
    let (ast, _) = sound(text);
    let once = format(&ast, text);
    let (again, errors, _) = read(&once);
    assert!(errors.is_empty(), "{once}\n{errors:#?}");
    assert_eq!(outline(&again), outline(&ast), "meaning\n{text}\n{once}");
    let comments = |ast: &crate::syntax::ast::Ast| -> Vec<String> {
        ast.comments
            .iter()
            .map(|comment| comment.node.trim_end().to_owned())
            .collect()
    };
    assert_eq!(comments(&again), comments(&ast), "comments");
    assert_eq!(format(&again, &once), once, "idempotent");
    once
}

/// A plan may contain a line of 4 kB; a comment at its end stays there, and no other comment is aligned with it.
#[test]
fn a_long_row_pushes_no_comment_out_of_sight() {
    let name = "x".repeat(200);
    let text = formatted(&format!(
        "plan \"P\" {{\n  customer = \"{name}\" # long\n  operator = \"A\" # short\n  revision = \"12\" # too\n}}\n"
    ));
    let line = format!(
        "  customer = \"{name}\"  # long\n  operator = \"A\"   # short\n  revision = \"12\"  # too\n"
    );
    assert!(text.contains(&line), "{text}");
}

/// `in` is a unit after a number alone.
#[test]
fn a_list_below_in_belongs_to_its_line() {
    let text = formatted(
        "fragility f {\n  intensity = speed in\n  [1, 2] m/s\n  a = 3 in\n  b = hit.speed in\n 1 .. 2\n}\n",
    );
    assert!(
        text.contains("intensity = speed in\n    [1, 2] m/s\n"),
        "{text}"
    );
    assert!(text.contains("= 3 in\n"), "{text}");
    assert!(text.contains("= hit.speed in\n    1 .. 2\n"), "{text}");
}

#[test]
fn the_sample_plans_are_aligned_in_columns() {
    let text = formatted(IMPACT);
    for line in [
        "  edition     = 1\n",
        "param impact_speed = 1 m/s between 0.5 m/s .. 3 m/s  # psd run",
        "let   section      = 564 mm^2\n",
        "  mass      = density * section * length / 2  # equivalent",
        "  behaviour = elastic(stiffness: 300 kN/m)    # what a",
        "limits {  # nothing may drive the rig past these\n",
        "require \"stays in travel\"   hit.max_displacement <= 8.5 mm\n",
        "require \"energy closes\"     abs(hit.energy_error) < 1 %\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let quake = formatted(QUAKE);
    assert!(quake.starts_with(
        "specimen frame {\n  storeys = [  # from the ground up\n    storey(mass: 2 t, stiffness: 3 MN/m, height: 3 m),\n"
    ));
    assert!(quake.contains("\n  ]\n}\nground sine { file = \"ground.csv\" }  # header"));
}

#[test]
fn spacing_is_canonical() {
    for (text, expected) in [
        (
            "b{x=1kg\ny  =  -2 mm..25mm}",
            "b {\n  x = 1 kg\n  y = -2 mm .. 25 mm\n}\n",
        ),
        ("let x=a*-b+f( 1,c : 2 ,)", "let x = a * -b + f(1, c: 2)\n"),
        (
            "let x=[ 1 ,2 ,]mm\nparam yy = 1",
            "let   x  = [1, 2] mm\nparam yy = 1\n",
        ),
        ("let x = ( 2 m )^2", "let x = (2 m) ^ 2\n"),
        ("let x = a . b [ 0 ] . c", "let x = a.b[0].c\n"),
        (
            "let x = a within (1 mm) of b",
            "let x = a within (1 mm) of b\n",
        ),
        ("let x = within (1 mm)", "let x = within(1 mm)\n"),
        (
            "b{x=[a . b~f( sd:1 m ,between:1 m..2 m),c]}",
            "b { x = [a.b ~ f(sd: 1 m, between: 1 m .. 2 m), c] }\n",
        ),
        (
            "b{x=a in  1..3  step 1 m}",
            "b { x = a in 1 .. 3 step 1 m }\n",
        ),
        ("b{x=a in[1,2]in}", "b { x = a in [1, 2] in }\n"),
        (
            "require \"a\" s . p (fails :\"b\")<2 %",
            "require \"a\" s.p(fails: \"b\") < 2 %\n",
        ),
        ("limits{force=1 N..2 N}", "limits { force = 1 N .. 2 N }\n"),
        (
            "a { }\nb {}\n\n\n\nc{\n\n x=1\n\n\n y=2\n\n}\n\n\n",
            "a { }\nb { }\n\nc {\n  x = 1\n\n  y = 2\n}\n",
        ),
        ("plan   \"T\"  {\r\n}\r\n", "plan \"T\" {\n}\n"),
        ("require \"a\"  1 < 2", "require \"a\" 1 < 2\n"),
        ("", ""),
        ("\n\n# c  \n\n\n# d", "# c\n\n# d\n"),
    ] {
        assert_eq!(formatted(text), expected);
    }
}

#[test]
fn comments_stay_where_they_were() {
    let text = "# top\nb { # open\n# first\nx = 1 # one\n # between\nlonger = [ # in\n 1 # a\n , # b\n # own\n 2, # c\n # last\n] # after\n\n# end of block\n} # closed\n# end";
    assert_eq!(
        formatted(text),
        "# top\nb {  # open\n  # first\n  x      = 1  # one\n  # between\n  longer = [  # in\n    1,  # a\n    # b\n    # own\n    2,  # c\n    # last\n  ]  # after\n\n  # end of block\n}  # closed\n# end\n"
    );
    let text = "let x = 1 + # why\n  # own\n 2 +\n\n f(\n 3 # three\n)\nlet yy = (1 +\n2)\nlet z = f([1, # one\n2], a: # name\n 3)\n";
    formatted(text);
    assert_eq!(
        formatted("let x = [\"a  # b\", # c\n 2]"),
        "let x = [\n  \"a  # b\",  # c\n  2,\n]\n"
    );
    assert!(formatted("let x = 1 +\n2").contains("let x = 1 +\n  2\n"));
}

#[test]
fn long_values_are_broken() {
    let names: Vec<String> = (0..12)
        .map(|index| format!("name_number_{index}"))
        .collect();
    let list = formatted(&format!("a {{ x = [{}] }}\n", names.join(", ")));
    assert_eq!(list.lines().count(), 16);
    assert!(
        list.contains("\n    name_number_0,\n") && list.contains("\n    name_number_11,\n  ]\n")
    );
    let sum = formatted(&format!("let x = {}\n", names.join(" + ")));
    assert!(
        sum.lines().count() == 2 && sum.lines().all(|line| line.len() <= 112),
        "{sum}"
    );
    formatted(&format!("let x = f({})\n", "[1, 2], ".repeat(300)));
    formatted(&format!("let x = 1{}\n", "+1".repeat(900)));
}

/// Valid plans with comments and line ends wherever they are allowed.
fn plan() -> impl Strategy<Value = String> {
    let gap = || {
        prop::sample::select(vec![
            "",
            " ",
            "\n",
            " # note\n",
            "\n\n  # own\n",
            "\n# a\n# b\n",
        ])
    };
    let leaf = prop::sample::select(vec![
        "1",
        "2.5 kN/m",
        "a",
        "k0.stiffness",
        "\"t # x\"",
        "10%",
        "x[0]",
        "-3kg",
    ])
    .prop_map(String::from);
    let value = leaf.prop_recursive(4, 24, 4, move |inner| {
        let operator = prop::sample::select(vec![" + ", " * ", "-", " / ", " ^ "]);
        prop_oneof![
            (
                prop::collection::vec((inner.clone(), gap(), gap()), 0..4),
                any::<bool>()
            )
                .prop_map(|(items, list)| {
                    let items: Vec<String> = items
                        .into_iter()
                        .map(|(item, before, after)| format!("{before}{item}{after}"))
                        .collect();
                    if list {
                        format!("[{}]", items.join(","))
                    } else {
                        format!("f({})", items.join(","))
                    }
                }),
            (inner.clone(), operator, gap(), inner.clone()).prop_map(
                |(left, operator, gap, right)| format!("({left} {operator} {gap} {right})")
            ),
            (inner.clone(), gap(), inner)
                .prop_map(|(left, gap, right)| format!("g({gap}{left}, name: {right},)")),
        ]
    });
    let after = prop::sample::select(vec!["\n", " # c\n", "\n\n\n", "\n# own\n"]);
    prop::collection::vec(
        (prop::sample::select(vec!["x", "longer_key"]), value, after),
        0..6,
    )
    .prop_map(|fields| {
        let lines: String = fields
            .iter()
            .map(|(key, value, after)| [" ", *key, " = ", value, after].concat())
            .collect();
        let items: String = fields
            .iter()
            .map(|(key, value, after)| ["let ", *key, " = ", value, " < 2", after].concat())
            .collect();
        format!("b {{\n{lines}}}\n{items}")
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn formatting_is_idempotent_and_keeps_the_meaning(text in plan()) {
        formatted(&text);
    }

    #[test]
    fn whatever_reads_without_fault_is_formatted(text in soup()) {
        if read(&text).1.is_empty() {
            formatted(&text);
        }
    }
}
