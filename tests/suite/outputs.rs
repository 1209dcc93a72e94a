//! What a run leaves: the bytes of every output, read back as their readers would.

mod fixture;

use std::io::Cursor;

use fixture::{Finished, finished};
use polars::prelude::{ParquetReader, SerReader as _};
use psd::output::summary::Summary;
use psd::output::{OutputFile, console, everything};
use psd::record::{History, ImpactStep};

const IMPACT_COLUMNS: &str = "step,time_s,wall_time_s,state,command_m,displacement_m,velocity_m_per_s,acceleration_m_per_s2,\
restoring_force_n,contact_force_n,striker_displacement_m,striker_velocity_m_per_s,tangent_stiffness_n_per_m,indentation_m,\
striker_energy_j,structure_energy_j,restoring_energy_j,damping_energy_j,contact_loss_j,indentation_energy_j,energy_error_j";

fn files(finished: &Finished) -> Vec<OutputFile> {
    everything(&finished.run()).expect("every output can be made")
}

fn text<'a>(files: &'a [OutputFile], path: &str) -> &'a str {
    std::str::from_utf8(bytes(files, path)).expect("text is UTF-8")
}

fn bytes<'a>(files: &'a [OutputFile], path: &str) -> &'a [u8] {
    &files.iter().find(|file| file.path == path).unwrap_or_else(|| panic!("{path} is missing")).bytes
}

fn impact_steps(finished: &Finished) -> &[ImpactStep] {
    let History::Impact(history) = &finished.record.procedures[2].history else { panic!("an impact") };
    &history.steps
}

#[test]
fn the_same_run_gives_the_same_bytes_and_the_files_of_the_language() {
    let (first, second) = (files(&finished()), files(&finished()));
    assert_eq!(first, second);
    let mut paths: Vec<&str> = first.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths.last(), Some(&"manifest.sha256"));
    paths.sort_unstable();
    assert_eq!(
        paths,
        [
            "certificate.html",
            "figures/c_damping_fit.png",
            "figures/hit_contact_force.png",
            "figures/hit_displacement.png",
            "figures/hit_energy.png",
            "figures/hit_force_displacement.png",
            "figures/hit_striker_velocity.png",
            "figures/hit_velocity.png",
            "figures/k0_force_displacement.png",
            "manifest.sha256",
            "plan/beam.psd",
            "plan/lib/frame.psd",
            "summary.json",
            "tables/c.csv",
            "tables/c.parquet",
            "tables/hit.csv",
            "tables/hit.parquet",
            "tables/k0.csv",
            "tables/k0.parquet",
        ]
    );
    assert_eq!(text(&first, "manifest.sha256").lines().count(), paths.len() - 1);
    let destination = std::env::var_os("PSD_TEST_OUTPUTS");
    for file in destination.iter().flat_map(|_| &first) {
        let path = std::path::Path::new(destination.as_ref().unwrap()).join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.bytes).unwrap();
    }
}
