//! The difference of two texts, line by line, in the unified format. In: two texts with their names. Out: text. Lines that only one text has are
//! never compared: the effort does not grow with their square.

use std::collections::HashSet;
use std::fmt::Write as _;

use similar::udiff::UnifiedHunkHeader;
use similar::{Algorithm, DiffOp, capture_diff_slices, group_diff_ops};

/// Number of lines around a change.
const CONTEXT: usize = 3;

/// A text, and its name in the difference.
pub struct Named<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

/// The unified difference; empty if the texts are equal.
pub fn unified(before: &Named<'_>, after: &Named<'_>) -> String {
    let old: Vec<&str> = before.text.split_inclusive('\n').collect();
    let new: Vec<&str> = after.text.split_inclusive('\n').collect();
    let mut shown = String::new();
    for hunk in group_diff_ops(operations(&old, &new), CONTEXT) {
        if shown.is_empty() {
            let _ = writeln!(shown, "--- {}\n+++ {}", before.name, after.name);
        }
        let _ = writeln!(shown, "{}", UnifiedHunkHeader::new(&hunk));
        for operation in hunk {
            if let DiffOp::Equal { old_index, len, .. } = operation {
                put(&mut shown, ' ', &old[old_index..old_index + len]);
            } else {
                put(&mut shown, '-', &old[operation.old_range()]);
                put(&mut shown, '+', &new[operation.new_range()]);
            }
        }
    }
    shown
}

fn put(shown: &mut String, sign: char, lines: &[&str]) {
    for line in lines {
        shown.push(sign);
        shown.push_str(line);
        if !line.ends_with('\n') {
            shown.push_str("\n\\ No newline at end of file\n");
        }
    }
}

/// The lines that are equal in order, and the changes between them.
fn operations(old: &[&str], new: &[&str]) -> Vec<DiffOp> {
    let (in_old, in_new) = (common(old, new), common(new, old));
    let lines = |of: &[&'_ str], at: &[usize]| -> Vec<String> {
        at.iter().map(|index| of[*index].to_owned()).collect()
    };
    let (shared_old, shared_new) = (lines(old, &in_old), lines(new, &in_new));
    let (mut operations, mut at) = (Vec::new(), (0, 0));
    for operation in capture_diff_slices(Algorithm::Myers, &shared_old, &shared_new) {
        let DiffOp::Equal {
            old_index,
            new_index,
            len,
        } = operation
        else {
            continue;
        };
        for (old, new) in in_old[old_index..]
            .iter()
            .zip(&in_new[new_index..])
            .take(len)
        {
            change(&mut operations, at, (*old, *new));
            match operations.last_mut() {
                Some(DiffOp::Equal { len, .. }) if at == (*old, *new) => *len += 1,
                _ => operations.push(DiffOp::Equal {
                    old_index: *old,
                    new_index: *new,
                    len: 1,
                }),
            }
            at = (old + 1, new + 1);
        }
    }
    change(&mut operations, at, (old.len(), new.len()));
    operations
}

/// The indices of the lines that the other text has too.
fn common(lines: &[&str], other: &[&str]) -> Vec<usize> {
    let other: HashSet<&str> = other.iter().copied().collect();
    let is_common = |index: &usize| other.contains(lines[*index]);
    (0..lines.len()).filter(is_common).collect()
}

/// The lines up to the next equal ones are replaced.
fn change(operations: &mut Vec<DiffOp>, from: (usize, usize), to: (usize, usize)) {
    if from != to {
        operations.push(DiffOp::Replace {
            old_index: from.0,
            old_len: to.0 - from.0,
            new_index: from.1,
            new_len: to.1 - from.1,
        });
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::{Named, unified};

    fn shown(old: &str, new: &str) -> String {
        let named = |name, text| Named { name, text };
        unified(&named("a", old), &named("b", new))
    }

    #[test]
    fn it_is_the_unified_format() {
        let old = "1\n2\n3\n4\n5\n6\n7\n8\n";
        let new = "1\n2\n3\n4\nfive\n6\n7\n8\n9";
        let expected = "--- a\n+++ b\n@@ -2,7 +2,8 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n+9\n\\ No newline at end of file\n";
        assert_eq!(shown(old, new), expected);
        assert_eq!(shown(old, old), "");
        assert_eq!(shown("", "x\n"), "--- a\n+++ b\n@@ -0,0 +1 @@\n+x\n");
    }

    /// Both texts are in it again, whatever the order of their lines.
    #[test]
    fn it_has_each_line_of_both_texts_once() {
        let line = |index: usize| format!("{}\n", index * 7 % 11 % 5);
        for length in 0..40 {
            let old: String = (0..length).map(line).collect();
            let new: String = (3..length + 5).map(|index| line(index * index)).collect();
            let shown = super::operations(
                &old.split_inclusive('\n').collect::<Vec<_>>(),
                &new.split_inclusive('\n').collect::<Vec<_>>(),
            );
            let (mut at, mut equal) = ((0, 0), 0);
            for operation in shown {
                assert_eq!(
                    (operation.old_range().start, operation.new_range().start),
                    at
                );
                at = (operation.old_range().end, operation.new_range().end);
                if matches!(operation, similar::DiffOp::Equal { .. }) {
                    equal += 1;
                    let lines = |text: &str, range: std::ops::Range<usize>| {
                        text.lines().map(str::to_owned).collect::<Vec<_>>()[range].to_vec()
                    };
                    assert_eq!(
                        lines(&old, operation.old_range()),
                        lines(&new, operation.new_range())
                    );
                }
            }
            assert_eq!(at, (old.lines().count(), new.lines().count()));
            assert!(equal > 0 || length < 8, "{length}");
        }
    }

    /// A hundred thousand lines that all differ need no comparison of any two: their square would take an hour.
    #[test]
    fn lines_of_one_text_alone_cost_no_comparison() {
        let text = |before: &str| {
            (0..100_000).fold(String::new(), |mut text, index| {
                let _ = writeln!(text, "{before}{index}");
                text
            })
        };
        let shown = shown(&text(" "), &text(""));
        assert_eq!(shown.lines().count(), 200_003);
    }
}
