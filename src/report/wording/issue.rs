//! English wording of the status of a report, of its issue and of its amendments. In: values, already formatted. Out: sentences.

wording! {
    mod status {
        SIMULATION = "SIMULATION";
        CHECK_RUN = "CHECK RUN";
        NOT_ISSUABLE = "NOT ISSUABLE";
        INCOMPLETE = "INCOMPLETE";
        DRAFT = "DRAFT";
        fn lacks(missing) = "Not issuable as a test report. Missing, and not to be added after the test: {missing}.";
        fn lacks_particulars(missing) = "Not issued: `psd issue` adds the particulars of ISO/IEC 17025:2017, 7.8.2.1. \
            Missing: {missing}.";
        RELEASED_MOTION = "a test: the motion was not released";
        OPERATOR = "the operator's name";
        CERTIFICATE = "the reference of the calibration";
        DAY_OF_THE_TEST = "the day of the test";
        PASSING_PROGRAM = "a program that passes its self-test";
        CALIBRATION = "calibration";
        fn calibration_of(channel) = "calibration of the {channel}";
        fn calibrated_range(channel) = "the calibrated range of the {channel}";
        fn due_date(calibration) = "the due date of the {calibration}";
        fn overdue(calibration, due, day) = "a valid {calibration} (due {due}, test ended {day})";
        fn overdue_before(calibration, due) = "the {calibration} was due on {due}";
    }

    mod amendment {
        TITLE = "Amendment";
        SAME_RECORD = "The run log and every measured and computed number are unchanged. The report named above is \
            kept, but no longer valid.";
        NOTHING = "nothing";
        NOTHING_ELSE = "nothing else";
        fn amendment(replaced, by, date, reason, changes) = "Amendment to report {replaced} by {by} on {date}: {reason}. \
            Changed: {changes}.";
        fn first_issue(date, by, replaced, stated) = "on {date} by {by}, from the report {replaced}; stated after \
            the test: {stated}";
        fn quoted(text) = "“{text}”";
        fn change(field, was, is) = "{field} (was {was}, is {is})";
    }
}
