//! The committed accuracy page is what the code does.

use host_tests::figures::{needs_recording, page};
use host_tests::rocket;

/// Text against text: the same bits everywhere, and figures rounded far above what a host's own `sin` may differ by.
#[test]
#[cfg_attr(debug_assertions, ignore = "an hour of plant: release only")]
fn regress_the_accuracy_page_is_fresh() {
    let committed = include_str!("../../docs/accuracy.md");
    let fresh = page();
    let recorded = rocket::path().exists();
    if !recorded {
        println!("skipped: the lines that need {}", rocket::path().display());
    }
    let lines = |text: &'static str| text.lines().filter(move |line| recorded || !needs_recording(line));
    let fresh = fresh.lines().filter(|line| recorded || !needs_recording(line));
    let mut count = 0;
    for (committed, fresh) in lines(committed).zip(fresh.clone()) {
        assert_eq!(committed, fresh, "see the page's first lines for how to make it anew");
        count += 1;
    }
    assert_eq!(count, fresh.count());
    assert_eq!(count, lines(committed).count());
}
