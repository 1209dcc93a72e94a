//! Effect of rounding on the loops of a `cycle`. It is compared with replays on rigs that differ in the zero of their quantization grid.

use crate::tests::noise::uniform;
use crate::tests::testing::{elastic_plan, number, run_unwatched};
use psd_plan::formula::Formula;
use psd_plan::uncertainty::Source;
use psd_plan::{Behaviour, Cycle, Level, Link, Plan, ProcedureKind, Sides, VirtualLink};

const NAMES: [&str; 6] = [
    "dissipated_energy",
    "max_force",
    "min_force",
    "equivalent_damping_ratio",
    "stiffness",
    "last_stiffness",
];

/// Two cycles to `amplitude` \[m\] about `about`, of a specimen that carries a load before the first move.
fn plan(behaviour: &Behaviour, amplitude: f64, about: f64, link: VirtualLink) -> Plan {
    let cycle = Cycle {
        specimen: 0,
        levels: vec![Level {
            amplitude: Formula::Constant(amplitude),
            cycles: 2,
        }],
        sides: Sides::Both,
        about: Formula::Constant(about),
        points: 7,
        samples: 2,
        pause: Formula::Constant(0.0),
        speed: None,
        rate: None,
        inspect: Vec::new(),
        fit: None,
    };
    let mut plan = elastic_plan(1000.0, vec![ProcedureKind::Cycle(cycle)]);
    plan.specimens[0].behaviour = Some(behaviour.clone());
    plan.rig.link = Link::Virtual(link);
    plan
}

/// For every result: root mean square of the errors of `runs`, root mean square of the reported u, and the fraction of errors within 2u.
fn replayed(
    runs: u32,
    behaviour: &dyn Fn(f64) -> Behaviour,
    link: VirtualLink,
) -> [(f64, f64, f64); NAMES.len()] {
    let mut state = 11;
    let mut sums = [(0.0, 0.0, 0.0); NAMES.len()];
    for _ in 0..runs {
        let behaviour = behaviour(0.9 + 0.2 * uniform(&mut state));
        let amplitude = 0.02 * (0.9 + 0.2 * uniform(&mut state));
        let about = 2e-3 * uniform(&mut state);
        let [found, exact] = [link, VirtualLink::default()]
            .map(|link| run_unwatched(&plan(&behaviour, amplitude, about, link)));
        for (name, sum) in NAMES.into_iter().zip(&mut sums) {
            let ((value, reported), (truth, _)) =
                (number(&found, 0, name), number(&exact, 0, name));
            // The resolution of the displacement transducer does not affect a force.
            let (error, reported) = (value.unwrap() - truth.unwrap(), reported.unwrap_or(0.0));
            sum.0 += error * error;
            sum.1 += reported * reported;
            sum.2 += f64::from(u8::from(error.abs() <= 2.0 * reported + 1e-9));
        }
    }
    let count = f64::from(runs);
    sums.map(|(error, reported, held)| {
        (
            (error / count).sqrt(),
            (reported / count).sqrt(),
            held / count,
        )
    })
}

/// An elastic specimen and a yielding one. The peak force is 40 and 100 quantization steps of the cell; one rig rounds its displacement.
#[test]
fn replays_on_coarse_rigs_are_held() {
    let elastic = |by: f64| Behaviour::Elastic {
        stiffness: 1000.0 * by,
    };
    let yielding = |by: f64| Behaviour::Bilinear {
        stiffness: 1000.0 * by,
        yield_force: 10.0,
        post_yield_ratio: 0.1,
    };
    let cell = |quantum| VirtualLink {
        force_resolution: quantum,
        ..VirtualLink::default()
    };
    let cases: [(&dyn Fn(f64) -> Behaviour, VirtualLink); 3] = [
        (&elastic, cell(0.5)),
        (&yielding, cell(0.1)),
        (
            &yielding,
            VirtualLink {
                resolution: 7e-4,
                ..VirtualLink::default()
            },
        ),
    ];
    for (behaviour, link) in cases {
        for (name, (error, reported, held)) in NAMES.into_iter().zip(replayed(240, behaviour, link))
        {
            let case = format!(
                "{name} by {} N and {} m: {error}, reported {reported}, held {held}",
                link.force_resolution, link.resolution
            );
            assert!(held >= 0.93 && reported > 0.85 * error - 1e-9, "{case}");
            assert!(
                name.contains("energy") || name.contains("ratio") || reported < 3.5 * error + 1e-9,
                "{case}"
            );
        }
    }
}

/// K = ΔF/w with q/√12 at either end: q/(√6·w); an error common to both ends cancels.
#[test]
fn a_secant_is_as_uncertain_as_its_two_readings() {
    let link = VirtualLink {
        force_resolution: 1.0,
        ..VirtualLink::default()
    };
    let record = run_unwatched(&plan(
        &Behaviour::Elastic { stiffness: 1003.0 },
        0.02,
        0.0,
        link,
    ));
    let reported = number(&record, 0, "last_stiffness").1.unwrap();
    let by_hand = 1.0 / 0.04 / 6.0_f64.sqrt();
    assert!(
        (reported / by_hand - 1.0).abs() < 3.0 / 128.0_f64.sqrt(),
        "{reported}"
    );
    let parts = &record.procedures[0]
        .result("last_stiffness")
        .unwrap()
        .contributions;
    assert!(
        parts
            .iter()
            .all(|part| matches!(part.source, Source::Readings { .. })),
        "{parts:?}"
    );
}
