//! The table of effects in `docs/plant.md` is the program's.

use gimbal_plant::{Bound, Effect};

/// Lines of the table, one a parameter.
fn lines() -> Vec<String> {
    let meaning = |bound| match bound {
        Bound::Any => "any",
        Bound::NotNegative => "0 and above",
        Bound::Positive => "above 0",
    };
    let of = |effect: Effect| {
        let line = move |parameter: &gimbal_plant::Parameter| {
            let [low, typical, high] =
                [parameter.low, parameter.typical, parameter.high].map(|value| format!("{value:e}"));
            let (name, unit, bound) = (parameter.name, parameter.unit, meaning(parameter.bound));
            format!("| `{}` | `{name}` | {unit} | {low} | {typical} | {high} | {bound} |", effect.name())
        };
        effect.parameters().iter().map(line)
    };
    Effect::all().flat_map(of).collect()
}

#[test]
fn every_parameter_stands_on_the_page() {
    let page = include_str!("../../docs/plant.md");
    let table = lines().join("\n");
    assert!(page.contains(&table), "docs/plant.md should hold\n{table}");
}
