//! Valid text: exact structure, exact spans.

use super::{IMPACT, QUAKE, block, expression, outline, shape, sound};
use crate::syntax::ast::{Expr, ExprKind};
use psd_text::source::Sources;

#[test]
fn the_whole_sample_plan_has_its_exact_structure() {
    let (ast, sources) = sound(IMPACT);
    assert_eq!(
        outline(&ast),
        r#"plan "Pultruded GFRP beam, midspan impact"
  edition = 1
  standard = "In-house procedure 12, after Melo et al. 2006"
  specimen_id = "GFRP-0147"
use "lib/instron_frame.psd"
param impact_speed = 1 m/s between (0.5 m/s .. 3 m/s)
let section = 564 mm^2
specimen beam
  length = 1.4 m
  density = 1850 kg/m^3
  mass = (((density * section) * length) / 2)
  behaviour = elastic(stiffness: 300 kN/m)
rig simulated
  link = virtual(noise: 2 N, resolution: 1 um, lag: 2 ms, seed: 7)
  settle = within(0.01 mm, 5 N/s, for: 0.3 s, timeout: 10 s)
striker pendulum
  mass = 20 kg
  velocity = impact_speed
limits
  displacement = ((- 2 mm) .. 25 mm)
  force = ((- 2 kN) .. 12 kN)
  speed = 10 mm/s
stiffness ramp k0
  displacements = (0.1 mm .. 1 mm step 0.1 mm)
  pause = 2 s
damping sweep c
  velocities = [0.5, 1, 2, 5, 10] mm/s
  stroke = 1 mm
  stiffness = (k0 . stiffness)
impact hit
  striker = pendulum
  stiffness = (k0 . stiffness)
  damping = (c . damping)
  contact = rigid
  time_step = (critical / 20)
  duration = 50 ms
  pause = 0.5 s
  inspect = [every(20), force_drop(10 %)]
require "stays in travel" ((hit . max_displacement) <= 8.5 mm)
require "absorbs the blow" ((hit . absorbed_energy) within 15 % of (pendulum . energy))
require "energy closes" (abs((hit . energy_error)) < 1 %)
report
  figures = [force_displacement(k0), displacement(hit), striker_velocity(hit), energy(hit)]
  formats = [html, pdf, parquet, csv]
  sign = ["Test engineer", "Quality"]
"#
    );
    let hit = block(&ast, 10);
    assert_eq!(sources.text(hit.head), "impact hit");
    assert!(
        sources.text(ast.items[10].span).starts_with("impact hit {")
            && sources.text(ast.items[10].span).ends_with('}')
    );
    assert_eq!(
        sources.text(ast.items[2].span),
        "param impact_speed = 1 m/s between 0.5 m/s .. 3 m/s"
    );
    assert_eq!(ast.comments.len(), IMPACT.matches('#').count());
    assert_eq!(ast.comments[0].node, "# rig `frame` and its limits");
}

#[test]
fn lists_may_span_lines_and_end_with_a_comma() {
    let (ast, _) = sound(QUAKE);
    assert_eq!(
        outline(&ast),
        r#"specimen frame
  storeys = [storey(mass: 2 t, stiffness: 3 MN/m, height: 3 m), storey(mass: 1.5 t, stiffness: 2 MN/m, height: 3 m)]
ground sine
  file = "ground.csv"
shake quake
  specimen = frame
  ground = sine
  damping_ratio = 2 %
  time_step = 1 ms
  integrator = explicit
require "drift" (max((quake . max_drift)) < 30 mm)
"#
    );
}

#[test]
fn precedence_is_that_of_the_language() {
    for (text, expected) in [
        ("a + b * c - d", "((a + (b * c)) - d)"),
        ("a / b / c", "((a / b) / c)"),
        ("-a ^ 2", "(- (a ^ 2))"),
        ("2 ^ -1", "(2 ^ (- 1))"),
        ("a ^ b ^ c", "(a ^ (b ^ c))"),
        ("-a * b", "((- a) * b)"),
        ("2 - -1", "(2 - (- 1))"),
        ("a.b.c[0]", "(((a . b) . c) @ 0)"),
        ("a.b ^ 2", "((a . b) ^ 2)"),
        (
            "a + 1 .. b * 2 step c - 1",
            "((a + 1) .. (b * 2) step (c - 1))",
        ),
        (
            "a < b and c >= d and e != f",
            "(((a < b) and (c >= d)) and (e != f))",
        ),
        (
            "a + b within 1 mm + c of d - e",
            "((a + b) within (1 mm + c) of (d - e))",
        ),
        ("2 ^ -1 * 3", "((2 ^ (- 1)) * 3)"),
        ("2 ^ -a ^ b", "(2 ^ (- (a ^ b)))"),
        ("3 within (1 mm) of 2", "(3 within <1 mm> of 2)"),
        (
            "a.b in 1 .. 2 and c < 3",
            "(((a . b) in (1 .. 2)) and (c < 3))",
        ),
        ("2 m^2", "2 m^2"),
        ("(2 m)^2", "(<2 m> ^ 2)"),
        ("N/m * 2", "((N / m) * 2)"),
        ("2kg", "2 kg"),
        ("5 1/s", "5 1/s"),
        ("1 N/m*s", "1 N/m*s"),
        ("1 N/m^1.5", "1 N/m^1.5"),
        ("3 µm", "3 µm"),
        ("1.5e-3 m", "1.5e-3 m"),
        ("0.1 .. 1 step 0.1 mm", "(0.1 .. 1 step 0.1 mm)"),
        ("0..1 mm", "(0 .. 1 mm)"),
        ("[0.5, 1] mm/s", "[0.5, 1] mm/s"),
        ("[[1, 2], []]", "[[1, 2], []]"),
        ("f()", "f()"),
        ("f(1, a: 2,)", "f(1, a: 2)"),
        ("max(k0.stiffness.u, 2)", "max(((k0 . stiffness) . u), 2)"),
        ("1 +\n  # why\n  2", "(1 + 2)"),
        (
            "s.probability(fails: \"a\") < 2 %",
            "((s . probability(fails: \"a\")) < 2 %)",
        ),
        ("a.b ~ normal(sd: 1)", "((a . b) ~ normal(sd: 1))"),
        ("a.b in 1 .. 3 step 1 m", "((a . b) in (1 .. 3 step 1 m))"),
        ("a in [1, 2] in", "(a in [1, 2] in)"),
        ("in in 3 in .. 5 in", "(in in (3 in .. 5 in))"),
        ("f(\n 1 # one\n , # two\n 2\n)", "f(1, 2)"),
        (r#""a \"b\" \\ \n\t µ""#, r#""a \"b\" \\ \n\t µ""#),
    ] {
        assert_eq!(shape(&expression(text).0), expected, "{text}");
    }
}

fn assert_spans(expr: &Expr, sources: &Sources) {
    let text = sources.text(expr.span);
    assert_eq!(text, text.trim(), "a span takes in blanks");
    assert!(!text.is_empty());
    let inner: Vec<&Expr> = match &expr.kind {
        ExprKind::List { items, .. } => items.iter().collect(),
        ExprKind::Range { start, end, step } => [start, end]
            .into_iter()
            .chain(step)
            .map(|part| &**part)
            .collect(),
        ExprKind::Call { arguments, .. } => {
            arguments.iter().map(|argument| &argument.value).collect()
        }
        ExprKind::Field { base, .. } => vec![base],
        ExprKind::Member {
            base, arguments, ..
        } => std::iter::once(&**base)
            .chain(arguments.iter().map(|argument| &argument.value))
            .collect(),
        ExprKind::Index { base, index } => vec![base, index],
        ExprKind::Stepped { input, values } => vec![input, values],
        ExprKind::Negate(value) | ExprKind::Parenthesised(value) => vec![value],
        ExprKind::Binary { left, right, .. } => vec![left, right],
        ExprKind::Within {
            value,
            tolerance,
            target,
        } => vec![value, tolerance, target],
        _ => vec![],
    };
    for part in inner {
        assert!(expr.span.start <= part.span.start && part.span.end <= expr.span.end);
        assert_spans(part, sources);
    }
}

#[test]
fn spans_cover_the_whole_expression_and_no_blank() {
    for text in [
        "[ 1 , 2 ] mm",
        "f( 1 , a : 2 )",
        "a . b [ 0 ]",
        "- 2 mm .. 25 mm",
        "0 .. 1 step 0.1 mm",
        "( a + b ) * c",
        "a within 15 % of b.c",
        "a < 1 and b > 2",
        "2 kg",
        "\"x\"",
        "a + f(2 kN/m , [1] m)",
        "a . p( x : 1 ) < 2 %",
        "a . b ~ f( 1 )",
        "a . b in [ 1 , 2 ] m",
    ] {
        for after in ["", "  ", "   # note"] {
            let (value, sources) = expression(&format!("{text}{after}"));
            assert_eq!(sources.text(value.span), text);
            assert_spans(&value, &sources);
        }
    }
}

#[test]
fn a_block_can_be_on_one_line_and_lines_can_end_in_cr_lf() {
    let (ast, _) = sound(
        "a { }\r\nb {}\r\nlimits { force = 1 N .. 2 N } # why\r\nc {\r\n  x = 1\r\n  y = 2 }\r\n\r\n# end",
    );
    assert_eq!(
        outline(&ast),
        "a\nb\nlimits\n  force = (1 N .. 2 N)\nc\n  x = 1\n  y = 2\n"
    );
    assert_eq!(
        ast.comments
            .iter()
            .map(|comment| comment.node.as_str())
            .collect::<Vec<_>>(),
        ["# why", "# end"]
    );
}
