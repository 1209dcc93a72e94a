//! The codes that the language raises. A code is never reused: the next one follows the highest number of every list.

psd_text::codes! {
    // 1: the text
    E101 E102 E103 E104 E105 E106 E107 E108
    // 2: names
    E201 E202 E203 E204 E205 E206 E207 E208 E209 E210 E212 E213 E214
    // 3: dimensions and types
    E301 E302 E303 E304 E305 E306
    // 4: values
    E401 E402 E403 E404 E405 E406 E407 E408 E409
    // 5: files
    E501 E502 E503 E504
    // 6: the test as a whole
    E601 E602 E603 E604 E606 E607 E608 E609 E610 E611 E612 E613 E614 E615 E616 E619 E620 E621
    E622 E623 E628 E630 E631 E632 E633 E634 E635 E636 E637 E641 E649 E652 E656 E657 E658 E659
    E660 E661 E662 E663 E664 E665 E667 E668 E670 E671 E675 E676 E677
    // 7: plans that run but are not advisable
    W707 W708 W709 W711 W715 W717 W727 W728 W729 W731 W732 W733 W734 W735 W736 W742
}
