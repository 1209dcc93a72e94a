//! How far down the list the wanted completion is: a hundred cursors as one types, with the word that is wanted there.

use serde_json::json;

use super::testing::{CURSOR, Editor, labels, position, uri};

/// A plan around the cursor, so that names and results exist.
const BEFORE: &str = "param speed = 1 m/s between 0.5 m/s .. 3 m/s\nlet span = 1.2 m\nlet stiff = 300 kN/m\nspecimen beam {\n  mass = 1 kg\n  behaviour = elastic(stiffness: stiff)\n}\nstriker hammer {\n  mass = 10 kg\n  velocity = speed\n}\nstiffness ramp k0 {\n  displacements = 0.1 mm .. 1 mm step 0.1 mm\n}\nimpact hit {\n  striker = hammer\n  duration = 1 s\n}\ncycle loops {\n  amplitudes = [1, 2] mm\n}\nrequire \"bends little\" hit.max_displacement < 0.2 m\nstudy scatter {\n  runs = 100\n}\n";

/// What is typed, with the cursor, and what is wanted.
#[rustfmt::skip]
const CURSORS: [(&str, &str); 100] = [
    // Items.
    ("s‸", "specimen"), ("st‸", "striker"), ("sti‸", "stiffness ramp"), ("im‸", "impact"), ("cy‸", "cycle"),
    ("sh‸", "shake"), ("es‸", "escalate"), ("un‸", "unload"), ("mo‸", "move"), ("ins‸", "inspect"),
    ("da‸", "damping sweep"), ("li‸", "limits"), ("ri‸", "rig"), ("gr‸", "ground"), ("req‸", "require"),
    ("pa‸", "param"), ("le‸", "let"), ("u‸", "use"), ("go‸", "golden"), ("fra‸", "fragility"),
    // Fields.
    ("specimen b {\n  ‸\n}", "mass"), ("specimen b {\n  mass = 1 kg\n  b‸\n}", "behaviour"), ("specimen b {\n  st‸\n}", "storeys"),
    ("striker s {\n  ‸\n}", "mass"), ("striker s {\n  mass = 1 kg\n  v‸\n}", "velocity"), ("striker s {\n  dr‸\n}", "drop_height"),
    ("striker s {\n  mass = 1 kg\n  ga‸\n}", "gap"), ("impact i {\n  ‸\n}", "striker"), ("impact i {\n  striker = hammer\n  ‸\n}", "duration"),
    ("impact i {\n  co‸\n}", "contact"), ("impact i {\n  ti‸\n}", "time_step"), ("impact i {\n  un‸\n}", "until"),
    ("impact i {\n  sti‸\n}", "stiffness"), ("impact i {\n  ma‸\n}", "mass"), ("impact i {\n  inte‸\n}", "integrator"),
    ("stiffness ramp r {\n  ‸\n}", "displacements"), ("cycle c {\n  a‸\n}", "amplitudes"), ("cycle c {\n  sp‸\n}", "speed"),
    ("limits {\n  d‸\n}", "displacement"), ("limits {\n  f‸\n}", "force"), ("report {\n  f‸\n}", "figures"),
    ("move m {\n  ‸\n}", "to"), ("shake q {\n  ‸\n}", "ground"), ("study s {\n  ‸\n}", "vary"), ("escalate e {\n  ‸\n}", "striker"),
    // Units.
    ("striker s {\n  mass = 10 ‸\n}", "kg"), ("striker s {\n  velocity = 1 ‸\n}", "m/s"), ("striker s {\n  gap = 3 m‸\n}", "mm"),
    ("striker s {\n  drop_height = 30 m‸\n}", "mm"), ("impact i {\n  duration = 50 m‸\n}", "ms"), ("impact i {\n  duration = 1 ‸\n}", "s"),
    ("impact i {\n  stiffness = 300 ‸\n}", "N/m"), ("impact i {\n  stiffness = 300 k‸\n}", "kN/m"), ("impact i {\n  damping = 3 ‸\n}", "N*s/m"),
    ("impact i {\n  time_step = 1 m‸\n}", "ms"), ("stiffness ramp r {\n  displacements = 0.1 .. 1 m‸\n}", "mm"), ("cycle c {\n  speed = 1 mm‸\n}", "mm/s"),
    ("limits {\n  force = 10 k‸\n}", "kN"), ("limits {\n  displacement = -40 .. 60 m‸\n}", "mm"), ("limits {\n  displacement = 40 ‸\n}", "m"),
    ("specimen b {\n  behaviour = beam(length: 1 ‸)\n}", "m"), ("specimen b {\n  behaviour = beam(youngs_modulus: 70 G‸)\n}", "GPa"),
    ("specimen b {\n  behaviour = beam(second_moment: 18000 m‸)\n}", "mm^4"), ("specimen b {\n  behaviour = elastic(stiffness: 3 ‸)\n}", "N/m"),
    ("impact i {\n  contact = hertz(stiffness: 2 ‸)\n}", "N/m^1.5"), ("require \"a\" hit.max_displacement < 45 m‸", "mm"),
    ("require \"a\" hit.max_contact_force < 4 k‸", "kN"), ("require \"a\" hit.stop_time < 4 m‸", "ms"), ("require \"a\" k0.stiffness < 4 k‸", "kN/m"),
    ("require \"a\" hit.energy_error < 1 ‸", "%"),
    // Values.
    ("impact i {\n  striker = ‸\n}", "hammer"), ("impact i {\n  specimen = ‸\n}", "beam"), ("impact i {\n  contact = ‸\n}", "rigid"),
    ("impact i {\n  contact = he‸\n}", "hertz"), ("impact i {\n  contact = re‸\n}", "restitution"), ("impact i {\n  until = re‸\n}", "rebound"),
    ("impact i {\n  stiffness = k‸\n}", "k0"), ("impact i {\n  stiffness = st‸\n}", "stiff"), ("impact i {\n  stiffness = k0.‸\n}", "stiffness"),
    ("impact i {\n  time_step = cr‸\n}", "critical"), ("striker s {\n  velocity = sp‸\n}", "speed"), ("striker s {\n  velocity = sq‸\n}", "sqrt"),
    ("specimen b {\n  behaviour = el‸\n}", "elastic"), ("specimen b {\n  behaviour = bi‸\n}", "bilinear"), ("specimen b {\n  behaviour = bo‸\n}", "bouc_wen"),
    ("specimen b {\n  behaviour = elastic(‸)\n}", "stiffness"), ("specimen b {\n  behaviour = beam(l‸)\n}", "length"), ("specimen b {\n  behaviour = beam(length: sp‸)\n}", "span"),
    ("impact i {\n  contact = hertz(‸)\n}", "stiffness"), ("require \"a\" h‸", "hit"), ("require \"a\" hit.max_d‸", "max_displacement"),
    ("require \"a\" hit.max_c‸", "max_contact_force"), ("require \"a\" k0.st‸", "stiffness"), ("require \"a\" hit.max_displacement.‸", "u"),
    ("require \"a\" hit.max_displacement w‸", "within"), ("require \"a\" scatter.‸", "probability"), ("report {\n  figures = [di‸]\n}", "displacement"),
    ("report {\n  figures = [displacement(h‸)]\n}", "hit"), ("let a = ma‸", "max"), ("let a = 2 * sp‸", "span"),
];

/// Mean reciprocal rank below which the order of the list is wrong.
const LEAST: f64 = 0.9;

#[test]
fn the_wanted_word_is_near_the_top() {
    let mut editor = Editor::with(&[]);
    let mut sum = 0.0;
    let mut low = Vec::new();
    for (typed, wanted) in CURSORS {
        let marked = format!("{BEFORE}{typed}\n");
        let at = marked.find(CURSOR).unwrap();
        editor.open("a.psd", &marked.replacen(CURSOR, "", 1));
        let answer = editor.ask("textDocument/completion", json!({
            "textDocument": { "uri": uri("a.psd") }, "position": position(&marked[..at], "utf-16"),
        }));
        // An editor shows the items that begin with what is typed.
        let word = marked[..at]
            .rsplit(|c: char| !(c.is_alphanumeric() || "_/*^%".contains(c)))
            .next()
            .unwrap();
        let shown = labels(&answer)
            .into_iter()
            .filter(|label| label.starts_with(word));
        let rank = shown.clone().position(|label| label == wanted);
        let reciprocal = rank.map_or(0.0, |rank| {
            1.0 / f64::from(u32::try_from(rank + 1).unwrap())
        });
        sum += reciprocal;
        if reciprocal < 1.0 {
            low.push(format!(
                "{typed:?} {wanted}: {:?}",
                shown.take(4).collect::<Vec<_>>()
            ));
        }
    }
    let mean = sum / f64::from(u32::try_from(CURSORS.len()).unwrap());
    assert!(
        mean >= LEAST,
        "mean reciprocal rank {mean:.3}\n{}",
        low.join("\n")
    );
}
