//! `gimbal figures`: the files, the facts, and the tables of docs/misprints.md.

mod program;

use program::Bench;

#[test]
fn paper_every_figure_is_drawn_and_the_flight_code_lies_on_the_plant() {
    let bench = Bench::new();
    let object = bench.json(&["figures", "--out", "figures", "--json"]);
    let figures = object["figures"].as_array().expect("figures");
    let numbers: Vec<&str> = figures.iter().map(|figure| figure["figure"].as_str().expect("a number")).collect();
    assert_eq!(numbers, ["2-1", "2-2", "3", "3-close", "4", "6", "7", "8", "9", "10"]);
    let page = bench.read("figures/figures.html");
    for number in numbers {
        let svg = bench.read(&format!("figures/figure-{number}.svg"));
        assert!(svg.starts_with("<svg") && page.contains(&svg), "{number}");
        let png = std::fs::read(bench.path(&format!("figures/figure-{number}.png"))).expect("a picture");
        assert!(png.starts_with(b"\x89PNG"), "{number}");
        assert!(bench.read(&format!("figures/figure-{number}.csv")).lines().count() > 10, "{number}");
    }
    assert!(!page.contains("http://") || page.matches("http://").count() == page.matches("http://www.w3.org/").count());
    // 0.1 % is what is marked; the step's tables are good to 0.01 % of the largest friction.
    for figure in figures {
        for difference in figure["flight_against_plant"].as_array().expect("differences") {
            assert!(difference["of_peak"].as_f64().expect("a number") < 1e-3, "{figure}");
        }
    }
    let open: Vec<_> = object["facts"].as_array().expect("facts").iter().filter(|f| f["verdict"] == "OPEN").collect();
    assert!(open.len() == 1 && open[0]["difference"] == "-17.5 %", "{open:?}");
}

#[test]
fn regress_the_tables_on_misprints_are_those_of_the_command() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/misprints.md");
    let page = std::fs::read_to_string(page).expect("docs/misprints.md");
    let tables = Bench::new().succeed(&["figures", "--misprints"]);
    for table in tables.split("### ").filter(|table| !table.trim().is_empty()) {
        assert!(
            page.contains(table.trim()),
            "docs/misprints.md lacks what `gimbal figures --misprints` prints:\n{table}"
        );
    }
}

#[test]
fn contract_a_folder_that_cannot_be_made_is_told() {
    let bench = Bench::new();
    bench.write("file", "");
    let told = bench.fail(2, &["figures", "--out", "file/figures"]);
    assert!(told.contains("file/figures"), "{told}");
}
