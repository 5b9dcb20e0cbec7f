//! The forge shares no code with the diagnosis or with the reference plant: read from Cargo's own metadata.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Members of the workspace with the members that each depends on, directly or not, for its library.
fn reach() -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo metadata runs");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("metadata is JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let name = |value: &serde_json::Value| value["name"].as_str().unwrap_or_default().to_owned();
    let members: BTreeSet<String> = packages.iter().map(name).collect();
    let direct: BTreeMap<String, BTreeSet<String>> = packages
        .iter()
        .map(|package| {
            let needs = package["dependencies"].as_array().into_iter().flatten();
            // tests may compare; what counts is what the library is made of
            let of_library = needs.filter(|need| need["kind"].as_str() != Some("dev")).map(name);
            (name(package), of_library.filter(|need| members.contains(need)).collect())
        })
        .collect();
    members
        .iter()
        .map(|member| {
            let mut all = direct[member].clone();
            loop {
                let more: BTreeSet<String> = all.iter().flat_map(|need| direct[need].clone()).collect();
                if more.is_subset(&all) {
                    return (member.clone(), all);
                }
                all.extend(more);
            }
        })
        .collect()
}

#[test]
fn contract_the_forge_uses_parameter_types_alone() {
    let reach = reach();
    let forge: Vec<&str> = reach["gimbal-forge"].iter().map(String::as_str).collect();
    assert_eq!(forge, ["gimbal-servo"]);
}

#[test]
fn contract_neither_plant_nor_diagnosis_uses_the_forge() {
    for (member, needs) in reach() {
        if member != "gimbal-cli" && member != "xtask" && !member.contains("test") {
            assert!(!needs.contains("gimbal-forge"), "{member} uses the forge");
        }
    }
}

#[test]
fn contract_the_source_takes_parameters_alone_from_the_root_library() {
    fn visit(folder: &std::path::Path, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).expect("source folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                visit(&path, found);
            } else {
                let text = std::fs::read_to_string(&path).expect("source");
                found.extend(text.split("gimbal_servo").skip(1).map(|rest| rest.chars().take(24).collect::<String>()));
            }
        }
    }
    let mut found = Vec::new();
    visit(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")), &mut found);
    assert!(!found.is_empty());
    for rest in found {
        let part = rest.trim_start_matches("::");
        let allowed = ["Config", "servo", "gyro", "bearing", "unbalance", "paper"];
        assert!(allowed.iter().any(|name| part.starts_with(name)), "gimbal_servo{rest}");
    }
}
