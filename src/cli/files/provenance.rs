//! The provenance of a run. In: the checked plan. Out: [`Provenance`], a function of the plan and the version of this
//! program only: the same plan has the same id everywhere.

use psd_plan::schema::plan_block::DATE;
use sha2::{Digest as _, Sha256};

use super::circumstances::Circumstances;
use psd::report::{Build, Provenance, RealRun};
use psd::run::check_run;
use psd::run::replay::{Header, LogForm};
use psd_plan::Plan;
use psd_text::digest::{hex, sha256};

/// Digest of the sources of this program, and its toolchain.
pub const BUILD: &str = env!("PSD_BUILD");
pub const TOOLCHAIN: &str = env!("PSD_TOOLCHAIN");

/// The build of this program.
pub fn this_build() -> Build {
    Build {
        sources: BUILD.to_owned(),
        toolchain: TOOLCHAIN.to_owned(),
    }
}

/// Version and build of this program, for the data set of a study.
pub fn version() -> String {
    format!("{} {BUILD}", env!("CARGO_PKG_VERSION"))
}

/// The other build of psd that made a run; None if it was this one. The steps of a simulation also depend on the toolchain.
pub fn other_build(header: &Header) -> Option<String> {
    let Header {
        psd,
        build,
        toolchain,
        log,
        ..
    } = header;
    if build != BUILD {
        Some(format!("psd {psd} build {build}"))
    } else if *log == LogForm::Compact && toolchain != TOOLCHAIN {
        Some(format!("psd {psd} built by {toolchain}"))
    } else {
        None
    }
}

/// The provenance of a run of `plan` by this version of the program; `date` is that of the command line, which the plan
/// states too.
pub fn of_this_run(plan: &Plan, date: Option<&str>) -> Provenance {
    let version = env!("CARGO_PKG_VERSION");
    let run_id = run_id(plan, version, date);
    let date = stated_date(plan);
    let text = plan.files.first().map_or("", |file| &*file.text);
    Provenance {
        run_id,
        number: None,
        psd_version: version.to_owned(),
        build: this_build(),
        plan_sha256: sha256(text.as_bytes()),
        date,
        real: None,
        equipment: None,
        prediction: None,
        issues: None,
    }
}

/// The provenance of a run on a simulated rig. Its date is that of plan or command line, else the day on which it began. The start
/// is not part of its id: the same plan gives the same results on every day.
pub fn of_simulated_run(plan: &Plan, date: Option<&str>, began: Option<&str>) -> Provenance {
    let provenance = of_this_run(plan, date);
    let day = || began.and_then(|began| began.get(..10)).map(str::to_owned);
    Provenance {
        date: provenance.date.or_else(day),
        ..provenance
    }
}

/// The number of a report. Run logs of real rigs and of incomplete runs differ from each other, so that the run id is not enough. The
/// number is then the run id with the head hash of the run log.
pub fn report_number(run_id: &str, plan: &Plan, ended: bool, head: Option<&str>) -> Option<String> {
    let follows_from_the_plan = plan.rig.link.as_real().is_none() && ended;
    let head = head
        .and_then(|head| head.get(..8))
        .filter(|_| !follows_from_the_plan)?;
    Some(format!("{run_id}-{head}"))
}

/// The provenance of a run on a real rig. Operator, machine and time are part of its id.
pub fn of_real_run(plan: &Plan, date: Option<&str>, circumstances: &Circumstances) -> Provenance {
    let provenance = of_this_run(plan, date);
    let Circumstances {
        operator,
        host,
        began,
        ..
    } = circumstances.clone();
    let run_id = real_id(&provenance.run_id, &circumstances.identifying());
    let date = date_of_real_run(plan, began.as_deref());
    let real = RealRun {
        operator,
        host,
        began,
        ..RealRun::default()
    };
    Provenance {
        run_id,
        date,
        real: Some(real),
        ..provenance
    }
}

/// The run id of a run log, from its header and its plan.
pub fn recorded_id(header: &Header, plan: &Plan) -> String {
    let planned = run_id(plan, &header.psd, header.date.as_deref());
    let is_real = plan.rig.link.as_real().is_some() && header.began.is_some();
    if is_real {
        real_id(&planned, &[&header.operator, &header.host, &header.began])
    } else {
        planned
    }
}

fn real_id(planned: &str, identifying: &[&Option<String>; 3]) -> String {
    let parts =
        std::iter::once(Some(planned)).chain(identifying.iter().map(|part| part.as_deref()));
    let text: Vec<String> = parts
        .map(|part| part.map_or("-".to_owned(), |part| format!("{}:{part}", part.len())))
        .collect();
    sha256(text.join(" ").as_bytes())[..16].to_owned()
}

/// The day on which the run began, from the run log. The day of the plan or the command line is used if it can be the same day in another
/// time zone.
pub fn date_of_real_run(plan: &Plan, began: Option<&str>) -> Option<String> {
    let stated = stated_date(plan);
    let began = began.and_then(|began| began.get(..10)).map(str::to_owned);
    if stated.is_some() && same_day(stated.as_deref(), began.as_deref()) {
        stated
    } else {
        began.or(stated)
    }
}

/// The day of the command line, or else of the plan.
pub fn stated_date(plan: &Plan) -> Option<String> {
    plan.particulars
        .iter()
        .find(|(field, _)| *field == DATE.name)
        .map(|(_, date)| date.clone())
}

/// A message if the test starts on a different day from the plan's; otherwise empty.
pub fn reported_another_day(plan: &Plan, began: Option<&str>) -> String {
    match (stated_date(plan), began.and_then(|began| began.get(..10))) {
        (Some(stated), Some(today)) if !same_day(Some(&stated), Some(today)) => {
            format!(
                "  the date {stated} differs from the day of this test: its report and its run log state {today}\n"
            )
        }
        _ => String::new(),
    }
}

/// Whether two days can be the same day in two time zones; false if one is not a day.
pub fn same_day(one: Option<&str>, other: Option<&str>) -> bool {
    let day = |text: Option<&str>| text?.parse::<jiff::civil::Date>().ok();
    let apart = day(one)
        .zip(day(other))
        .and_then(|(one, other)| one.until(other).ok());
    apart.is_some_and(|apart| apart.get_days().abs() <= 1)
}

/// The first 16 hex digits of a SHA-256 digest. It covers the plan, every file it used, the settings, the rig with its seed, and the
/// version. The date of the command line is included if there is one. Every part is preceded by its length, so that two different lists
/// of parts never give the same bytes.
fn run_id(plan: &Plan, version: &str, date: Option<&str>) -> String {
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
    part(
        &plan
            .rig
            .link
            .as_virtual()
            .map_or(0, |link| link.seed)
            .to_string(),
    );
    if let Some(date) = date {
        part("date");
        part(date);
    }
    // A low-level check run has an id different from that of its run.
    if plan.performed_part().is_some() {
        digest.update(check_run::RUN_ID_MARK);
    }
    hex(&digest.finalize())[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Link, PlanFile, VirtualLink};
    use psd_testing::plans::empty_plan;

    fn plan(files: &[(&str, &str)], settings: &[(&str, &str)], seed: u64) -> Plan {
        let own = |(name, text): &(&str, &str)| (String::from(*name), String::from(*text));
        let mut plan = Plan {
            particulars: vec![("date", "2026-05-31".to_owned())],
            files: files
                .iter()
                .map(own)
                .map(|(name, text)| PlanFile {
                    name,
                    text: text.into(),
                })
                .collect(),
            settings: settings.iter().map(own).collect(),
            ..empty_plan()
        };
        plan.rig.link = Link::Virtual(VirtualLink {
            seed,
            ..VirtualLink::default()
        });
        plan
    }

    #[test]
    fn the_id_changes_with_every_part_and_with_nothing_else() {
        let id = |files: &[(&str, &str)], settings: &[(&str, &str)], seed| {
            run_id(&plan(files, settings, seed), "1", None)
        };
        let base = id(&[("a", "bc")], &[], 7);
        assert_eq!(base, id(&[("a", "bc")], &[], 7));
        assert_eq!(base.len(), 16);
        let others = [
            id(&[("ab", "c")], &[], 7),
            id(&[("a", "bc"), ("", "")], &[], 7),
            id(&[("a", "bc")], &[("v", "1")], 7),
            id(&[("a", "bc")], &[], 8),
            run_id(&plan(&[("a", "bc")], &[], 7), "2", None),
            run_id(&plan(&[("a", "bc")], &[], 7), "1", Some("2026-05-31")),
            run_id(&plan(&[("a", "bc")], &[], 7), "1", Some("9999-12-31")),
        ];
        assert!(
            others.iter().all(|other| *other != base),
            "{others:?} against {base}"
        );
        assert_ne!(others[5], others[6]);
    }

    #[test]
    fn the_plans_digest_is_the_one_sha256sum_prints() {
        let provenance = of_this_run(&plan(&[("a.psd", "abc")], &[], 0), None);
        assert_eq!(
            provenance.plan_sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        assert_eq!(provenance.date.as_deref(), Some("2026-05-31"));
    }

    #[test]
    fn a_simulation_has_the_day_of_its_start_and_the_id_of_its_plan() {
        let began = Some("2026-11-21T23:00:00.000Z");
        let stated = plan(&[], &[], 0);
        let unstated = Plan {
            particulars: Vec::new(),
            ..stated.clone()
        };
        let run = of_simulated_run(&unstated, None, began);
        assert_eq!(run.date.as_deref(), Some("2026-11-21"));
        assert_eq!(run.run_id, of_this_run(&unstated, None).run_id);
        let run = of_simulated_run(&stated, None, began);
        assert_eq!(run.date.as_deref(), Some("2026-05-31"), "of the plan");
    }

    #[test]
    fn the_day_of_the_record_wins_over_another_that_is_stated() {
        let stated = plan(&[], &[], 0);
        let date = |began| date_of_real_run(&stated, began);
        assert_eq!(
            date(Some("2026-11-21T23:00:00.000Z")).as_deref(),
            Some("2026-11-21"),
            "the plan says 2026-05-31"
        );
        // Noon in Auckland is the day before in UTC.
        assert_eq!(
            date(Some("2026-05-30T23:50:00.000Z")).as_deref(),
            Some("2026-05-31")
        );
        assert_eq!(date(None).as_deref(), Some("2026-05-31"));
        assert!(
            !same_day(Some("2026-05-31"), Some("2026-06-02"))
                && !same_day(Some("soon"), Some("soon"))
        );
    }
}
