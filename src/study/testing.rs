//! Studies made by hand, for tests of this folder.

use std::path::Path;

use crate::check::{Options, ParsedPlan, no_files};
use crate::study::definition::Definition;
use psd_physics::study::Confidence;
use psd_physics::study::correlation::Pair;
use psd_physics::study::distribution::{Distribution, Spread};
use psd_physics::study::inputs::Source;
use psd_plan::Plan;
use psd_plan::study::{Input, Runs, Sampling, Study, Variation};
use psd_text::units::Dimension;

/// Impact speed and a mass, correlated.
pub fn variation() -> Variation {
    let input = |name: &str, dimension, nominal| Input {
        name: name.to_owned(),
        dimension,
        text: String::new(),
        nominal,
        is_record: false,
    };
    Variation {
        inputs: vec![
            input("speed", Dimension::VELOCITY, 1.0),
            input("weight", Dimension::MASS, 1.0),
        ],
        sources: vec![
            Source::Distribution(Distribution::normal(1.0, Spread::Sd(0.1)).unwrap()),
            Source::Distribution(Distribution::lognormal(1.0, Spread::Cv(0.1)).unwrap()),
        ],
        correlations: vec![Pair {
            inputs: [0, 1],
            correlation: 0.3,
        }],
        sampling: Sampling::Random,
        seed: 7,
        measured: Vec::new(),
    }
}

/// A plan, parsed and checked, with one study that varies impact speed and mass.
pub struct Studied {
    pub parsed: ParsedPlan,
    pub plan: Plan,
}

/// An impact of 25 steps at most, which meets `impact`, a block without its braces; and requirements.
pub fn plan(impact: &str, rest: &str) -> String {
    format!(
        "param speed = 1 m/s\nparam weight = 1 kg\n\
         specimen beam {{ mass = weight\nbehaviour = elastic(stiffness: 300 N/m) }}\n\
         striker hammer {{ mass = 10 kg\nvelocity = speed }}\n\
         impact hit {{ striker = hammer\nduration = 1 s\ntime_step = 10 ms\n{impact} }}\n{rest}\n"
    )
}

/// Bends too far in about a fifth of the runs.
pub fn usual() -> String {
    plan(
        "",
        "require \"stays in travel\" hit.max_displacement < 180 mm",
    )
}

/// The plan with these values of `--set`.
pub fn checked(text: &str, settings: &[(String, String)]) -> (ParsedPlan, Plan) {
    let options = Options {
        settings: settings.to_vec(),
        ..Options::default()
    };
    let mut parsed = ParsedPlan::parse("study.psd", text, &no_files, &options);
    let checked = parsed.check(&no_files);
    let plan = checked.plan;
    let plan = plan.unwrap_or_else(|| panic!("{text}: {:?}", checked.diagnostics));
    (parsed, plan)
}

impl Studied {
    /// The plan of a text, with a study of so many runs.
    pub fn of(text: &str, runs: u64) -> Self {
        Self::varied(text, runs, variation())
    }

    pub fn varied(text: &str, runs: u64, variation: Variation) -> Self {
        Self::until(text, Runs::Fixed(runs), variation)
    }

    pub fn until(text: &str, runs: Runs, variation: Variation) -> Self {
        let (parsed, mut plan) = checked(text, &[]);
        plan.studies.studies.push(Study {
            name: "scatter".to_owned(),
            variation,
            runs,
            confidence: Confidence::new(0.95).unwrap(),
            collect: Vec::new(),
        });
        Self { parsed, plan }
    }

    pub fn definition(&self) -> Definition {
        Definition::of(&self.plan.studies, None, None).unwrap()
    }
}

/// All bytes of a file.
pub fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}
