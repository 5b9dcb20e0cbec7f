//! The same inputs give the same bits in debug, in release and with `target-cpu=native`.

use gimbal_servo::effects::Config as Effects;
use host_tests::axis::System;
use host_tests::digests::{all_effects, cases};

/// Frozen by `cargo run --release -p host-tests --example digest`; whoever changes them on purpose says why.
#[test]
fn regress_every_run_has_its_committed_digest() {
    let expected = include_str!("../golden/digests.txt");
    for (line, expected) in host_tests::digests::lines().lines().zip(expected.lines()) {
        assert_eq!(line, expected);
    }
    assert_eq!(host_tests::digests::lines().lines().count(), expected.lines().count());
}

/// Without any one of its effects the case of all of them has other bits, in either number system.
#[test]
fn regress_every_effect_is_in_the_digest_of_all() {
    let all = all_effects();
    let less: [(&str, Effects); 11] = [
        ("constant_torque", Effects { constant_torque_nm: 0.0, ..all }),
        ("cable_spring", Effects { cable_spring_nm_per_rad: 0.0, ..all }),
        ("viscous_friction", Effects { viscous_friction_nm_s_per_rad: 0.0, ..all }),
        ("quadratic_drag", Effects { quadratic_drag_nm_s2_per_rad2: 0.0, ..all }),
        ("anisoelasticity", Effects { anisoelasticity_nm_s4_per_m2: 0.0, ..all }),
        ("stribeck", Effects { stribeck_excess_nm: 0.0, ..all }),
        ("loop_delay", Effects { loop_delay_s: 0.0, ..all }),
        ("torque_scale", Effects { torque_scale: 0.0, ..all }),
        ("torque_bias", Effects { torque_bias_nm: 0.0, ..all }),
        ("pickoff_scale", Effects { pickoff_scale: 0.0, ..all }),
        ("pickoff_bias", Effects { pickoff_bias_rad: 0.0, ..all }),
    ];
    let case = cases().into_iter().find(|case| case.name == "noise-all-effects").expect("a case of all effects");
    for system in System::BOTH {
        let digest = case.digest(system);
        for (name, effects) in less {
            let without = host_tests::digests::Case { effects: Some(effects), ..case.clone() };
            assert_ne!(without.digest(system), digest, "{name} in {}", system.name());
        }
    }
}
