//! Where a run's numbers come from. In: the plan as it was checked. Out: [`Provenance`]. A function of the plan and
//! this program's version alone, so that the same plan gives the same id everywhere.

use sha2::{Digest as _, Sha256};

use super::record_file::Circumstances;
use crate::digest::{hex, sha256};
use crate::output::{Build, Provenance, RealRun};
use crate::plan::Plan;
use crate::run::rehearsal;

/// The sources that this program was built from, and what with.
pub const BUILD: &str = env!("PSD_BUILD");
pub const TOOLCHAIN: &str = env!("PSD_TOOLCHAIN");

/// This program.
pub fn this_build() -> Build {
    Build { sources: BUILD.to_owned(), toolchain: TOOLCHAIN.to_owned() }
}

/// The provenance of a run of `plan` by this version of the program.
pub fn of(plan: &Plan) -> Provenance {
    let version = env!("CARGO_PKG_VERSION");
    let date = plan.particulars.iter().find(|(field, _)| *field == "date").map(|(_, date)| date.clone());
    let text = plan.files.first().map_or("", |file| file.text.as_str());
    Provenance {
        run_id: run_id(plan, version),
        psd_version: version.to_owned(),
        build: this_build(),
        plan_sha256: sha256(text.as_bytes()),
        date,
        real: None,
        equipment: None,
        prediction: None,
        amends: None,
    }
}

/// The provenance of a run on a real rig: no two are the same, so that who, where and when are part of its id.
pub fn of_real_run(plan: &Plan, circumstances: &Circumstances) -> Provenance {
    let provenance = of(plan);
    let Circumstances { operator, host, began, .. } = circumstances;
    let told = [Some(provenance.run_id.clone()), operator.clone(), host.clone(), began.clone()];
    let text: Vec<String> =
        told.into_iter().map(|part| part.map_or("-".to_owned(), |part| format!("{}:{part}", part.len()))).collect();
    let real = RealRun { operator: operator.clone(), host: host.clone(), began: began.clone(), ..RealRun::default() };
    let run_id = sha256(text.join(" ").as_bytes())[..16].to_owned();
    Provenance { run_id, date: date_of_real_run(plan, began.as_deref()), real: Some(real), ..provenance }
}

/// As the plan or the command line says, else the day it began.
pub fn date_of_real_run(plan: &Plan, began: Option<&str>) -> Option<String> {
    let stated = plan.particulars.iter().find(|(field, _)| *field == "date").map(|(_, date)| date.clone());
    stated.or_else(|| began.and_then(|began| began.get(..10)).map(str::to_owned))
}

/// The first 16 hex digits of SHA-256 over the plan and every file it used, the settings, the rig with its seed, and
/// the version. Every part is preceded by its length, so that no two lists of parts read the same.
fn run_id(plan: &Plan, version: &str) -> String {
    let mut digest = Sha256::new();
    let mut part = |text: &str| {
        digest.update((text.len() as u64).to_le_bytes());
        digest.update(text.as_bytes());
    };
    part("psd run 1");
    part(version);
    part(&plan.files.len().to_string());
    for file in &plan.files {
        part(&file.name);
        part(&file.text);
    }
    part(&plan.settings.len().to_string());
    for (name, value) in &plan.settings {
        part(name);
        part(value);
    }
    part(&plan.rig.name);
    part(&plan.rig.link.as_virtual().map_or(0, |link| link.seed).to_string());
    // A rehearsal is not the run that it rehearses.
    if rehearsal::told(plan).is_some() {
        digest.update(rehearsal::REHEARSAL);
    }
    hex(&digest.finalize())[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Calibration, DecisionRule, Limits, Link, PlanFile, Report, RigPlan, Settle, VirtualLink};

    fn plan(files: &[(&str, &str)], settings: &[(&str, &str)], seed: u64) -> Plan {
        let own = |(name, text): &(&str, &str)| (String::from(*name), String::from(*text));
        let settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 1.0 };
        let link = Link::Virtual(VirtualLink { seed, ..VirtualLink::default() });
        Plan {
            title: String::new(),
            particulars: vec![("date", "2026-05-31".to_owned())],
            parameters: Vec::new(),
            specimens: Vec::new(),
            strikers: Vec::new(),
            grounds: Vec::new(),
            rig: RigPlan { name: "ideal".to_owned(), link, settle, sign: 1.0, calibration: Calibration::default(), drift: None },
            limits: Limits::NONE,
            procedures: Vec::new(),
            requirements: Vec::new(),
            decision_rule: DecisionRule::Simple,
            report: Report { title: None, figures: Vec::new(), formats: Vec::new(), sign: Vec::new() },
            golden: crate::plan::Golden::default(),
            rehearses: None,
            files: files.iter().map(own).map(|(name, text)| PlanFile { name, text }).collect(),
            settings: settings.iter().map(own).collect(),
        }
    }

    #[test]
    fn the_id_changes_with_every_part_and_with_nothing_else() {
        let id = |files: &[(&str, &str)], settings: &[(&str, &str)], seed| run_id(&plan(files, settings, seed), "1");
        let base = id(&[("a", "bc")], &[], 7);
        assert_eq!(base, id(&[("a", "bc")], &[], 7));
        assert_eq!(base.len(), 16);
        let others = [
            id(&[("ab", "c")], &[], 7),
            id(&[("a", "bc"), ("", "")], &[], 7),
            id(&[("a", "bc")], &[("v", "1")], 7),
            id(&[("a", "bc")], &[], 8),
            run_id(&plan(&[("a", "bc")], &[], 7), "2"),
        ];
        assert!(others.iter().all(|other| *other != base), "{others:?} against {base}");
    }

    #[test]
    fn the_plans_digest_is_the_one_sha256sum_prints() {
        let provenance = of(&plan(&[("a.psd", "abc")], &[], 0));
        assert_eq!(provenance.plan_sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert_eq!(provenance.date.as_deref(), Some("2026-05-31"));
    }
}
