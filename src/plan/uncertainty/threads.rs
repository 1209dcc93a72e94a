//! Independent jobs in threads. In: jobs. Out: their results in the order of the jobs, so that the output does not depend on the number
//! of threads.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// How long to wait for the next result before `progress` is called again.
const MOMENT: Duration = Duration::from_millis(20);

/// The result of each job, in the order of the jobs, by as many threads as the machine has cores. `progress` receives how many of how many
/// are done.
pub(super) fn in_threads<J: Sync, T: Send, E>(
    jobs: &[J],
    work: &(dyn Fn(&J) -> T + Sync),
    progress: &mut dyn FnMut(usize, usize) -> Result<(), E>,
) -> Result<Vec<T>, E> {
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let (next, given_up) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (send, receive) = channel();
    let mut found: Vec<Option<T>> = jobs.iter().map(|_| None).collect();
    let ended = std::thread::scope(|scope| {
        let mut threads = 0;
        for _ in 0..cores.min(jobs.len()) {
            let (send, next, given_up) = (send.clone(), &next, &given_up);
            let run = move || {
                while !given_up.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(index) else { break };
                    if send.send((index, work(job))).is_err() {
                        break;
                    }
                }
            };
            threads += usize::from(std::thread::Builder::new().spawn_scoped(scope, run).is_ok());
        }
        drop(send);
        let mut done = 0;
        // The rig has moved and the run log is open: a machine that starts no thread costs time, not the run.
        if threads == 0 {
            for (job, found) in jobs.iter().zip(&mut found) {
                *found = Some(work(job));
                done += 1;
                progress(done, jobs.len())?;
            }
        }
        while done < jobs.len() {
            match receive.recv_timeout(MOMENT) {
                Ok((index, value)) => {
                    found[index] = Some(value);
                    done += 1;
                }
                Err(RecvTimeoutError::Timeout) => {}
                // A thread panicked: the scope reports it.
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if let Err(stop) = progress(done, jobs.len()) {
                given_up.store(true, Ordering::Relaxed);
                return Err(stop);
            }
        }
        Ok(())
    });
    ended.map(|()| found.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every job is done once, in any order, and its result has the index of the job; the observer sees all of them, and may stop.
    #[test]
    fn jobs_keep_their_order_in_threads() {
        let jobs: Vec<u64> = (0..500).collect();
        let mut most = 0;
        let slow_first =
            |job: &u64| (0..(500 - job) * 50).fold(*job, |sum, more| sum ^ more << 20 >> 60);
        let found = in_threads(&jobs, &slow_first, &mut |done, of| {
            most = most.max(done);
            assert_eq!(of, 500);
            Ok::<(), ()>(())
        });
        assert_eq!(found, Ok(jobs.clone()));
        assert_eq!(most, 500);
        let stop = in_threads(&jobs, &|job| *job, &mut |_, _| Err("enough"));
        assert_eq!(stop, Err("enough"));
    }
}
