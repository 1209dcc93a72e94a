//! Studies on the disk: grown, stopped, continued, divided and put together, always with the same bytes; and what is refused.

use super::folder::DataSetFiles;
use super::merge::{MergeFault, merge};
use super::same::Difference;
use super::status::status;
use super::{Collection, CollectionFault, Ended};
use crate::study::cluster::shard::Shard;
use crate::study::data_set::{Metadata, Reader, StudyRow};
use crate::study::definition::{Definition, DefinitionError};
use crate::study::metadata;
use crate::study::simulation::Simulation;
use crate::study::stopping::Looks;
use crate::study::testing::{Studied, bytes, plan, usual, variation};
use psd_physics::study::Confidence;
use psd_plan::Comparison;
use psd_plan::study::{Runs, Sampling, StudyEvent, StudyRequirement, Variation};
use psd_rig::transport::MonotonicClock;
use std::path::Path;

const RUNS: u64 = 200;

/// Adds runs until `rounds` rounds are done; all with `u32::MAX`.
fn add(
    studied: &Studied,
    runs: Option<u64>,
    folder: &Path,
    shard: Option<Shard>,
    rounds: u32,
) -> Result<(Ended, Looks), CollectionFault> {
    let definition = Definition::of(&studied.plan.studies, None, runs).unwrap();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let metadata =
        metadata::study_metadata("0.1.0 0", &studied.plan, &definition, simulation.readout());
    let collection = Collection {
        simulation: &simulation,
        metadata: &metadata,
        runs: definition.runs,
        folder,
        shard,
    };
    let mut left = rounds;
    collection.run(&MonotonicClock::start(), &mut |_| {
        left -= 1;
        left > 0
    })
}

fn finished(studied: &Studied, folder: &Path) -> Vec<u8> {
    let (ended, _) = add(studied, None, folder, None, u32::MAX).unwrap();
    match ended {
        Ended::Finished { path, .. } => bytes(&path),
        stopped @ Ended::Stopped { .. } => panic!("{stopped:?}"),
    }
}

fn rows(path: &Path) -> Vec<StudyRow> {
    let reader = Reader::open(path).unwrap();
    reader.rows().map(Result::unwrap).collect()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Stopped after every round, as by TERM, and continued each time.
#[test]
fn a_study_that_is_stopped_again_and_again_has_the_same_bytes() {
    let studied = Studied::of(&usual(), RUNS);
    let [whole, pieces] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let expected = finished(&studied, whole.path());
    let mut stops = Vec::new();
    loop {
        let (ended, looks) = add(&studied, None, pieces.path(), None, 1).unwrap();
        match ended {
            Ended::Stopped { runs, of } => {
                assert_eq!((runs, of), (looks.counts.runs, RUNS));
                assert!(!DataSetFiles::of(pieces.path(), None).path().exists());
                let status = status(pieces.path()).unwrap();
                assert_eq!(
                    (status.parts[0].runs, status.parts[0].finished),
                    (runs, false)
                );
                stops.push(runs);
            }
            Ended::Finished { path, .. } => {
                assert_eq!(bytes(&path), expected);
                break;
            }
        }
    }
    assert!(stops.len() >= 3 && stops.is_sorted(), "{stops:?}");
    assert_eq!(names(pieces.path()), ["study.parquet"]);
    let (ended, looks) = add(&studied, None, pieces.path(), None, u32::MAX).unwrap();
    assert!(matches!(ended, Ended::Finished { simulated: 0, .. }));
    assert_eq!(looks.counts.runs, RUNS);
}

/// A process that is killed leaves a part without a footer, or pieces that are already in the data set, or a gap.
#[test]
fn what_a_killed_process_leaves_behind_does_no_harm() {
    let studied = Studied::of(&usual(), RUNS);
    let [whole, killed] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let expected = finished(&studied, whole.path());
    let folder = killed.path();
    for _ in 0..3 {
        add(&studied, None, folder, None, 1).unwrap();
    }
    let files = DataSetFiles::of(folder, None);
    let pieces = files.pieces().unwrap();
    assert_eq!(pieces.len(), 3);
    std::fs::write(
        folder.join("study.piece-000000000192.parquet.part"),
        b"PAR1 half",
    )
    .unwrap();
    let kept = bytes(&pieces[2]);
    std::fs::remove_file(&pieces[1]).unwrap();
    assert_eq!(finished(&studied, folder), expected, "a gap");
    std::fs::write(&pieces[2], kept).unwrap();
    assert_eq!(
        finished(&studied, folder),
        expected,
        "a piece that is in the data set"
    );
    assert!(files.pieces().unwrap().is_empty());
}

/// The smaller study is the beginning of the larger one, which has the bytes of a study that was run at once.
#[test]
fn a_study_grows_by_runs_at_its_end() {
    for sampling in [Sampling::Random, Sampling::Sobol] {
        let variation = Variation {
            sampling,
            ..variation()
        };
        let studied = Studied::varied(&usual(), RUNS, variation);
        let [whole, grown] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let expected = finished(&studied, whole.path());
        let path = DataSetFiles::of(grown.path(), None).path();
        for runs in [60, 61, 150, RUNS] {
            let (ended, _) = add(&studied, Some(runs), grown.path(), None, u32::MAX).unwrap();
            assert!(matches!(ended, Ended::Finished { .. }));
            assert_eq!(
                rows(&path),
                rows(&DataSetFiles::of(whole.path(), None).path())
                    [..usize::try_from(runs).unwrap()]
            );
        }
        assert_eq!(bytes(&path), expected);
        // Fewer runs than are there: all are kept.
        add(&studied, Some(60), grown.path(), None, u32::MAX).unwrap();
        assert_eq!(bytes(&path), expected);
    }
}

#[test]
fn a_latin_hypercube_does_not_grow() {
    let variation = Variation {
        sampling: Sampling::LatinHypercube,
        ..variation()
    };
    let studied = Studied::varied(&usual(), 100, variation);
    let folder = tempfile::tempdir().unwrap();
    finished(&studied, folder.path());
    let refused = add(&studied, Some(200), folder.path(), None, u32::MAX);
    let difference = match refused {
        Err(CollectionFault::Other { difference, .. }) => difference,
        other => panic!("{other:?}"),
    };
    assert_eq!(difference, Difference::LatinHypercube);
}

/// One, three and eight shards, run by one thread or by four, in any order: the bytes of one process.
#[test]
fn shards_put_together_have_the_bytes_of_one_process() {
    let studied = Studied::of(&usual(), RUNS);
    let whole = tempfile::tempdir().unwrap();
    let expected = finished(&studied, whole.path());
    for of in [1, 3, 8] {
        for threads in [1, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let folder = tempfile::tempdir().unwrap();
            pool.unwrap().install(|| {
                for number in (1..=of).rev() {
                    let shard = Some(Shard { number, of });
                    add(&studied, None, folder.path(), shard, u32::MAX).unwrap();
                }
            });
            let (path, metadata) = merge(folder.path()).unwrap();
            assert_eq!(metadata.runs(), RUNS);
            assert_eq!(bytes(&path), expected, "{of} shards, {threads} threads");
            assert_eq!(bytes(&merge(folder.path()).unwrap().0), expected, "again");
        }
    }
}

#[test]
fn a_shard_is_run_once_and_missing_ones_are_named() {
    let studied = Studied::of(&usual(), 400);
    let folder = tempfile::tempdir().unwrap();
    let of = |number| Some(Shard { number, of: 4 });
    for number in [1, 4] {
        add(&studied, None, folder.path(), of(number), u32::MAX).unwrap();
    }
    let (again, _) = add(&studied, None, folder.path(), of(4), u32::MAX).unwrap();
    assert!(matches!(again, Ended::Finished { simulated: 0, .. }));
    add(&studied, None, folder.path(), of(2), 1).unwrap();
    let status = status(folder.path()).unwrap();
    assert_eq!(status.unfinished(), [2, 3]);
    assert_eq!((status.parts[1].runs, status.parts[1].of), (64, 100));
    let fault = merge(folder.path()).unwrap_err();
    assert!(matches!(&fault, MergeFault::Missing { missing, of: 4, .. } if *missing == [2, 3]));
    assert_eq!(fault.help().unwrap(), "submit them again: --array=2-3");

    let other = Some(Shard { number: 1, of: 8 });
    let refused = add(&studied, None, folder.path(), other, u32::MAX);
    assert!(matches!(
        refused,
        Err(CollectionFault::OtherShards { found: 4, .. })
    ));
}

#[test]
fn shards_of_another_study_are_refused() {
    let studied = Studied::of(&usual(), RUNS);
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = [1, 2].map(|number| Some(Shard { number, of: 2 }));
    add(&studied, None, folder.path(), first, u32::MAX).unwrap();
    let changed = Studied::of(&usual().replace("180 mm", "181 mm"), RUNS);
    let seeded = Studied::varied(
        &usual(),
        RUNS,
        Variation {
            seed: 8,
            ..variation()
        },
    );
    let longer = Studied::of(&usual(), RUNS + 1);
    for (other, expected) in [
        (&changed, Difference::Plan),
        (&seeded, Difference::Seed),
        (&longer, Difference::Runs),
    ] {
        let elsewhere = tempfile::tempdir().unwrap();
        add(other, None, elsewhere.path(), second, u32::MAX).unwrap();
        let name = "shard-002-of-002.parquet";
        std::fs::copy(elsewhere.path().join(name), folder.path().join(name)).unwrap();
        match merge(folder.path()) {
            Err(MergeFault::Other { difference, .. }) => assert_eq!(difference, expected),
            other => panic!("{other:?}"),
        }
        let refused = add(&studied, None, folder.path(), second, u32::MAX);
        assert!(
            matches!(
                refused,
                Err(CollectionFault::Other { .. } | CollectionFault::OtherRuns { .. })
            ),
            "{expected:?}"
        );
    }
    // A copy of the first shard under the name of the second.
    let paths =
        [1, 2].map(|number| DataSetFiles::of(folder.path(), Some(Shard { number, of: 2 })).path());
    std::fs::copy(&paths[0], &paths[1]).unwrap();
    assert!(matches!(
        merge(folder.path()),
        Err(MergeFault::OtherRuns { .. })
    ));
}

#[test]
fn a_data_set_of_another_build_is_refused() {
    let studied = Studied::of(&usual(), 10);
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let own = metadata::study_metadata("0.1.0 0", &studied.plan, &definition, simulation.readout());
    let other = Metadata {
        version: "0.0.1".to_owned(),
        ..own.clone()
    };
    assert_eq!(super::same::same(&other, &own), Err(Difference::Version));
    assert_eq!(super::same::same(&own, &own), Ok(()));
}

#[test]
fn two_processes_do_not_add_to_one_study() {
    let studied = Studied::of(&usual(), RUNS);
    let folder = tempfile::tempdir().unwrap();
    let definition = studied.definition();
    let simulation = Simulation::new(&studied.parsed, &studied.plan, &definition);
    let metadata =
        metadata::study_metadata("0.1.0 0", &studied.plan, &definition, simulation.readout());
    let collection = Collection {
        simulation: &simulation,
        metadata: &metadata,
        runs: definition.runs,
        folder: folder.path(),
        shard: None,
    };
    let mut refused = None;
    collection
        .run(&MonotonicClock::start(), &mut |_| {
            refused = Some(add(&studied, None, folder.path(), None, u32::MAX));
            false
        })
        .unwrap();
    assert!(matches!(refused, Some(Err(CollectionFault::Locked { .. }))));
    add(&studied, None, folder.path(), None, 1).unwrap();
}

#[test]
fn a_study_without_runs_is_an_error() {
    let studied = Studied::of(&usual(), RUNS);
    let studies = &studied.plan.studies;
    let refused = |name, runs| Definition::of(studies, name, runs).err();
    assert_eq!(refused(None, Some(0)), Some(DefinitionError::NoRuns));
    assert_eq!(
        refused(None, Some(u64::MAX)),
        Some(DefinitionError::TooManyRuns)
    );
    assert!(matches!(
        refused(Some("scater"), None),
        Some(DefinitionError::Unknown { .. })
    ));
    assert_eq!(
        Definition::of(&psd_plan::Studies::default(), None, None).err(),
        Some(DefinitionError::NoStudy)
    );
}

/// A study that decides: stopped at every round and continued, it ends at the same look as in one go, and has no shards.
#[test]
fn a_study_with_a_stopping_rule_ends_at_a_look() {
    let runs = Runs::Decided {
        confidence: Confidence::new(0.95).unwrap(),
        at_most: 100_000,
    };
    let mut studied = Studied::until(&usual(), runs, variation());
    studied.plan.studies.requirements.push(StudyRequirement {
        label: "rarely too far".to_owned(),
        text: "scatter.probability(fails: \"stays in travel\") < 2 %".to_owned(),
        study: 0,
        event: StudyEvent::Fails { requirement: 0 },
        comparison: Comparison::Less,
        limit: 0.02,
    });
    let [whole, stopped] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let expected = finished(&studied, whole.path());
    let end = Reader::open(&DataSetFiles::of(whole.path(), None).path())
        .unwrap()
        .metadata()
        .end;
    assert!([128, 256, 512, 1024].contains(&end), "{end}");
    while matches!(
        add(&studied, None, stopped.path(), None, 1).unwrap().0,
        Ended::Stopped { .. }
    ) {}
    assert_eq!(
        bytes(&DataSetFiles::of(stopped.path(), None).path()),
        expected
    );
    let shard = Some(Shard { number: 1, of: 2 });
    let refused = add(&studied, None, whole.path(), shard, 1);
    assert!(matches!(refused, Err(CollectionFault::UntilInShards)));
}

/// Runs that are invalid are kept, and count in the bounds of the probability.
#[test]
fn runs_without_a_result_are_counted_and_widen_the_interval() {
    let text = plan(
        "",
        "limits { displacement = -1 mm .. 185 mm }\nrequire \"stays in travel\" hit.max_displacement < 180 mm",
    );
    let studied = Studied::of(&text, RUNS);
    let folder = tempfile::tempdir().unwrap();
    let (_, looks) = add(&studied, None, folder.path(), None, u32::MAX).unwrap();
    let outcomes = looks.counts.of(0, crate::study::data_set::Event::Fails);
    assert_eq!(outcomes.runs(), RUNS);
    assert!(
        outcomes.no_result > 5 && outcomes.failed > 0,
        "{outcomes:?}"
    );
    let unlimited = Studied::of(&usual(), RUNS);
    let other = tempfile::tempdir().unwrap();
    let (_, looks) = add(&unlimited, None, other.path(), None, u32::MAX).unwrap();
    let all = looks.counts.of(0, crate::study::data_set::Event::Fails);
    assert_eq!(all.failed, outcomes.failed + outcomes.no_result);
    let [low, high] = outcomes.estimates().unwrap();
    let truth = all.estimates().unwrap()[0];
    assert!(low < truth && truth <= high);
}
