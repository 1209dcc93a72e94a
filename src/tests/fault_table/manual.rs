//! The rigs of the manual, each with its own emulator and the noise that it declares. Every rig passes its pre-test check for every seed.

use super::stage::{emulator, header, open};
use crate::check::{LoadError, Options, check};
use crate::run::{Unwatched, replay};
use psd_plan::Plan;
use psd_plan::record::Outcome;
use psd_rig::emulator::Log;
use psd_rig::journal::{Durability, Journal};
use psd_testing::journal::PowerLoss;

/// The plans of the manual use no file but a ground motion.
fn ground(path: &str) -> Result<String, LoadError> {
    let ground = "time_s,acceleration_m_per_s2\n0,0\n0.1,1\n0.2,0\n";
    if path == "ground.csv" {
        Ok(ground.to_owned())
    } else {
        Err(LoadError::NotFound)
    }
}

/// Every rig of the page in the surrounding plan, in which only the pre-test check remains.
fn rigs() -> Vec<Plan> {
    let page = include_str!("../../../docs/rigs.md");
    let plans: Vec<&str> = page
        .split("```psd\n")
        .skip(1)
        .filter_map(|after| after.split("```").next())
        .collect();
    let (around, rigs): (Vec<&str>, Vec<&str>) = plans
        .into_iter()
        .partition(|plan| !plan.starts_with("rig "));
    let plan = |rig: &&str| {
        let name = rig.split_whitespace().nth(1).unwrap().to_owned();
        let several = rig.contains("  axes ");
        let around = around
            .iter()
            .find(|plan| plan.contains("storey(") == several)
            .unwrap();
        let options = Options {
            rig: Some(name),
            ..Options::default()
        };
        let mut plan = check("rigs.psd", &format!("{around}\n{rig}"), &ground, &options)
            .plan
            .unwrap();
        plan.procedures.clear();
        plan.requirements.clear();
        plan.rig.zero_drift = None;
        plan
    };
    rigs.iter().map(plan).collect()
}

#[test]
fn every_rig_of_the_manual_passes_its_pretest_check() {
    let rigs = rigs();
    assert!(rigs.len() >= 13, "{}", rigs.len());
    for plan in rigs {
        for seed in 1..=5 {
            let name = &plan.rig.name;
            let emulator = emulator(&plan, "", Log::none(), seed);
            let mut rig = open(&plan, &emulator).unwrap_or_else(|fault| panic!("{name}: {fault}"));
            let mut journal =
                Journal::create(Box::new(PowerLoss::new()), Durability::EverySyncPoint);
            replay::begin(&mut journal, &header(&plan), &["text".to_owned()]).unwrap();
            let recorded =
                replay::record(&plan, &mut rig, &mut Unwatched, journal, Box::new(|| None));
            assert_eq!(
                recorded.record.outcome,
                Outcome::Completed,
                "{name}, dice {seed}"
            );
            let passed = recorded
                .record
                .events
                .iter()
                .filter(|event| event.text.starts_with("pre-test check passed"))
                .count();
            assert_eq!(
                passed,
                plan.rig.axes().unwrap_or(1),
                "{name}: {:#?}",
                recorded.record.events
            );
        }
    }
}
