//! The codes that this crate raises, and every code of the program.

use psd_text::diagnostic::Code;

psd_text::codes! {
    // 6: the test as a whole
    E605 E617 E618 E624 E625 E626 E627 E629 E638 E639 E640 E642 E643 E644 E645 E646 E647 E648
    E650 E651 E653 E654 E655 E666 E678
    // 7: plans that run but are not advisable
    W701 W702 W703 W704 W705 W706 W710 W712 W713 W714 W716 W718 W719 W720 W721 W722 W724 W726
    W730 W737 W740 W741 W743
}

/// Every code of the program, in order.
#[must_use]
pub fn all() -> Vec<Code> {
    let mut all = [psd_language::codes::ALL, ALL].concat();
    all.sort_unstable();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_lists_have_the_same_code() {
        let listed = all();
        let mut codes = listed.clone();
        codes.dedup();
        assert_eq!(codes, listed);
    }
}
