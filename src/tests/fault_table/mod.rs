//! The faults that a run on a real rig must survive, each in whole runs. The real drivers run on an emulated rig with a script of faults,
//! in one thread and in simulated time. In: a plan, a script. Out: the record, the run log, the log of the emulator. Each guard is also
//! switched off once, to show that its fault then gets through.
//!
//! | Row | Fault | Shown by |
//! |---|---|---|
//! | 1 | killed at every command to the rig | `words::killed_at_every_word_it_goes_on_to_the_same_end_and_no_target_is_carried_out_twice` |
//! | 6 | a disk with too little free space | `src/cli/files/disk_space.rs`, `tests/system/disk.rs` |
//! | 5, 6 | a disk that fails at any write or flush | `interrupted::disk` |
//! | 10 | no reply | `line::a_reply_that_never_comes_is_asked_for_at_t_2t_and_4t_and_then_the_rig_is_held` |
//! | 11 | partial replies, two replies in one read | `line::a_reply_in_any_two_pieces_or_byte_by_byte_is_the_same_reply`, `line::a_reply_cut_anywhere_is_never_a_shorter_number` |
//! | 12 | garbage, a megabyte without a line end | `line::garbage_of_any_kind_is_counted_and_none_of_it_is_used` |
//! | 13 | every bit of a reply flipped | `line::every_flipped_bit_of_a_reply_is_seen` |
//! | 14 | replies doubled, late, out of order | `line::a_doubled_a_late_and_an_old_reply_are_ignored`, `unnumbered::*` |
//! | 16 | reboot | `device::a_rig_that_restarts_is_held_and_not_moved_any_more`, `unnumbered::a_start_of_grbl_is_seen` |
//! | 18 | lag, stuck | `motion::an_actuator_that_sticks_or_lags_is_a_following_error` |
//! | 19 | polarity, unit, scale, offset | `pretest_check::*` |
//! | 19 | a rig at another position, invalid numbers at rest | `start::*` |
//! | 20 | values that are not numbers | `device::what_is_no_number_is_never_integrated` |
//! | 21 | saturation | `device::a_clipped_force_holds_the_rig` |
//! | 22 | frozen sensor | `device::a_frozen_sensor_holds_the_rig` |
//! | 23 | zero drift, of force and displacement | `drift::*`, `pretest_check::the_drift_at_rest_is_reported` |
//! | 24 | spike | `device::a_spike_does_not_move_the_median` |
//! | 25 | force beyond its limit, fracture | `motion::a_force_beyond_its_limit_holds_the_rig`, `motion::a_break_is_an_event_and_no_error` |
//! | 25 | the same during a move: its reading in the table, the unloading after it | `limits::*` |
//! | 26 | targets beyond limits or not finite | `targets::nothing_beyond_a_limit_is_ever_on_the_wire` |
//! | 27 | energy error, tracking-error energy | `motion::an_energy_error_beyond_its_limit_holds_the_rig`, `motion::tracking_that_changes_the_energy_holds_the_rig` |
//! | 18–22 | the same on one axis of two | `axes::*` |
//! | 10, 14, 18, 25, 26 | the same in continuous mode | `continuous::*` |
//! | 10, 12, 16, 20–22 | the same with one device per axis, a meter with several channels, several sites | `several::*` |
//! | 28 | signals, a closed terminal | `tests/system/by_signal.rs`, in separate processes |
//! | 29 | panic, abort | `tests/system/ended.rs`, in separate processes |
//! | 30 | a run log that contradicts itself | `forged::*`, `axes::forged_replies::*` |
//! | 31 | the wall clock jumps | `long::a_wall_clock_that_jumps_changes_no_duration`, `tests/system/clock.rs` |
//! | 32 | very many steps, random faults | `long::very_many_steps_with_faults_by_chance_lose_no_sample_and_hold_on_to_nothing` |

mod axes;
mod beam;
mod device;
mod drift;
mod forged;
mod interrupted;
mod limits;
mod line;
mod manual;
mod motion;
mod pretest_check;
pub(crate) mod stage;
mod start;
mod targets;
