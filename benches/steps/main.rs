//! The cost of a step, beside the least that the same formula can cost ([`kernel`]): `cargo bench -p psd-physics`. Times are of the
//! processor. All cases take turns in one loop; other work on the machine makes a turn longer, so that the fastest one counts beside the median.

mod cases;
mod kernel;

fn main() {
    let only = std::env::args().nth(1).filter(|word| word != "--bench");
    let mut cases = cases::all();
    if let Some(only) = &only {
        cases.retain(|case| case.name.contains(only.as_str()));
    }
    let mut times = vec![Vec::new(); cases.len()];
    for turn in 0..200 {
        for (case, times) in cases.iter_mut().zip(&mut times) {
            // A turn of a study is as long as ten thousand turns of an impact.
            if case.steps > 1e6 && turn % 20 != 0 {
                continue;
            }
            times.push(case.turn() / case.steps * 1e9);
        }
    }
    println!("| a step of | fastest, ns | median, ns |\n|---|---|---|");
    for (case, times) in cases.iter().zip(&mut times) {
        times.sort_by(f64::total_cmp);
        let [fastest, median] = [times[0], times[times.len() / 2]];
        println!("| {} | {fastest:.2} | {median:.2} |", case.name);
    }
}
