//! The score's arithmetic on reports made by hand.

use std::collections::BTreeMap;

use gimbal_forge::Draw;
use gimbal_forge::corpus::{Answer, AnswerEffect, Drift, Kind, SignalGap};
use gimbal_forge::effects::{Parameter, block_of};
use gimbal_forge::excitation::Excitation;
use gimbal_forge::score::Score;
use gimbal_forge::score::calibration::calibration;
use gimbal_forge::score::compare::{File, compare};
use gimbal_forge::score::judge::{Judged, judge};
use gimbal_forge::score::page::{Head, date, html, markdown};
use gimbal_forge::score::rate::Rate;
use gimbal_forge::score::report::Report;
use gimbal_forge::sensors::Noise;

fn effect(name: &str, multiple: f64, equivalents: &[&str]) -> AnswerEffect {
    AnswerEffect {
        name: name.to_owned(),
        block: block_of(name).to_owned(),
        parameters: vec![Parameter { name: "size".to_owned(), value: 2.0, unit: "1".to_owned() }],
        size: 2.0,
        detectable_size: 2.0 / multiple,
        multiple,
        d: 5.0 * multiple,
        d_beside_others: 5.0 * multiple,
        d_beyond_library: 5.0 * multiple,
        equivalents: equivalents.iter().map(|name| (*name).to_owned()).collect(),
    }
}

fn answer(kind: Kind, effects: Vec<AnswerEffect>) -> Answer {
    Answer {
        log: "00001".to_owned(),
        kind,
        excitation: Excitation::Boost,
        length_s: 20.0,
        mid_run: false,
        preset: "consistent".to_owned(),
        columns: Vec::new(),
        noise: Noise::draw(&mut Draw::new(&Draw::seed_of(1), 0)),
        drift: Drift { relative: BTreeMap::new(), misalignment_rad: [0.0; 3] },
        effects,
        signals: vec![SignalGap { name: "gyro_angle_rad".to_owned(), before: 10.0, best: 1.0 }],
    }
}

fn report(text: &str) -> Report {
    Report::parse(format!("{{\"schema\":\"gimbal-gap/1\",{text}}}").as_bytes()).expect("a report")
}

fn found(verdict: &str, names: &[(&str, f64)], unknown: f64) -> Report {
    let effects: Vec<String> = names
        .iter()
        .map(|(name, p)| {
            format!(
                "{{\"name\":\"{name}\",\"block\":\"x\",\"probability\":{p},\"parameters\":[{{\"name\":\"s\",\
                 \"value\":2.1,\"std\":0.1,\"unit\":\"1\"}}],\"removes\":0.9}}"
            )
        })
        .collect();
    report(&format!("\"verdict\":\"{verdict}\",\"effects\":[{}],\"unknown_probability\":{unknown}", effects.join(",")))
}

fn one(kind: Kind, effects: Vec<AnswerEffect>, report: Report) -> Judged {
    judge(answer(kind, effects), Some(report), 3.0)
}

#[test]
fn closed_form_wilson_intervals() {
    // Wilson 1927; the figures are those of any statistics package
    let (low, high) = Rate { hits: 8, of: 10 }.wilson();
    assert!((low - 0.490_16).abs() < 1e-5 && (high - 0.943_32).abs() < 1e-5, "{low} {high}");
    let (low, high) = Rate { hits: 0, of: 300 }.wilson();
    assert!(low.abs() < 1e-12 && (high - 0.012_643).abs() < 1e-6, "{high}");
    assert_eq!(Rate::default().share(), None);
}

#[test]
fn closed_form_a_single_effect_named_rightly_wrongly_and_by_its_class() {
    let right = one(Kind::One, vec![effect("stribeck", 4.0, &[])], found("explained", &[("stribeck", 0.9)], 0.05));
    assert!(right.top1 && right.top3 && right.exact && right.right && right.detected && right.in_gates());
    assert!((right.on_truth - 0.9).abs() < 1e-12 && (right.confidence - 0.95).abs() < 1e-12);
    let wrong = one(Kind::One, vec![effect("stribeck", 4.0, &[])], found("explained", &[("presliding", 0.9)], 0.05));
    assert!(wrong.detected && !wrong.top1 && !wrong.top3 && !wrong.exact && !wrong.right);
    let class = vec![effect("stribeck", 4.0, &["presliding"])];
    let named = one(Kind::One, class, found("explained", &[("presliding", 0.9)], 0.05));
    assert!(named.top1 && named.exact && named.right);
    // a second effect that is not there spoils the set, not the first rank
    let more = found("explained", &[("stribeck", 0.9), ("torque_ripple", 0.6)], 0.0);
    let more = one(Kind::One, vec![effect("stribeck", 4.0, &[])], more);
    assert!(more.top1 && !more.exact && !more.right);
}

#[test]
fn closed_form_an_effect_that_cannot_be_seen_beside_another_need_not_be_named() {
    let faint = AnswerEffect { d_beside_others: 3.0, ..effect("time_skew", 1.0, &[]) };
    let pair = vec![effect("stribeck", 4.0, &[]), faint];
    let said = |names: &[(&str, f64)]| one(Kind::Two, pair.clone(), found("explained", names, 0.0));
    let first = said(&[("stribeck", 0.9)]);
    assert!(first.right && !first.exact && (first.on_truth - 1.0).abs() < 1e-12);
    assert!(said(&[("stribeck", 0.9), ("time_skew", 0.6)]).right);
    assert!(!said(&[("stribeck", 0.9), ("dead_zone", 0.6)]).right);
    assert!(!said(&[("time_skew", 0.6)]).right);
}

#[test]
fn closed_form_who_refuses_has_raised_no_alarm() {
    let refused = one(
        Kind::Nothing,
        Vec::new(),
        report("\"verdict\":\"cannot_tell\",\"effects\":[],\"unknown_probability\":0.0"),
    );
    assert!(refused.right && !refused.detected);
    let gap = vec![effect("stribeck", 4.0, &[])];
    assert!(
        !one(Kind::One, gap, report("\"verdict\":\"cannot_tell\",\"effects\":[],\"unknown_probability\":0.0")).right
    );
}

#[test]
fn closed_form_cannot_tell_is_right_when_its_class_holds_the_truth() {
    let text = "\"verdict\":\"cannot_tell\",\"effects\":[{\"name\":\"loop_delay\",\"probability\":0.6}],\
                \"unknown_probability\":0.1,\"alternatives\":[{\"effects\":[\"motor_lag\"],\"probability\":0.3}]";
    let held = one(Kind::One, vec![effect("motor_lag", 4.0, &[])], report(text));
    assert!(held.right && !held.exact && !held.top1 && held.top3);
    assert!((held.confidence - 0.9).abs() < 1e-12 && (held.on_truth - 0.3).abs() < 1e-12);
    let missed = one(Kind::One, vec![effect("dead_zone", 4.0, &[])], report(text));
    assert!(!missed.right && missed.on_truth.abs() < 1e-12);
}

#[test]
fn closed_form_pairs_below_detectable_and_beyond_the_table() {
    let pair = || vec![effect("stribeck", 4.0, &[]), effect("cable_spring", 4.0, &["constant_torque"])];
    let both = found("explained", &[("constant_torque", 0.8), ("stribeck", 0.9)], 0.1);
    let both = one(Kind::Two, pair(), both);
    assert!(both.exact && both.right && (both.on_truth - 0.9).abs() < 1e-12);
    let half = one(Kind::Two, pair(), found("explained", &[("stribeck", 0.9)], 0.1));
    assert!(half.top1 && !half.exact && half.on_truth.abs() < 1e-12);
    let faint = one(Kind::One, vec![effect("stribeck", 0.6, &[])], found("no_gap", &[], 0.0));
    assert!(faint.right && !faint.detected && !faint.in_gates());
    let loud = one(Kind::One, vec![effect("stribeck", 6.0, &[])], found("no_gap", &[], 0.0));
    assert!(!loud.right);
    let unknown = one(Kind::Beyond, vec![effect("torque_pulses", 4.0, &[])], found("unexplained", &[], 0.8));
    assert!(unknown.flagged_unknown && unknown.right && (unknown.on_truth - 0.8).abs() < 1e-12);
    let blamed = found("explained", &[("torque_ripple", 0.9)], 0.05);
    let blamed = one(Kind::Beyond, vec![effect("torque_pulses", 4.0, &[])], blamed);
    assert!(!blamed.flagged_unknown && !blamed.right);
    // where an effect of the table takes its place, that one may stand for it
    let like = one(
        Kind::Beyond,
        vec![effect("rate_squared_torque", 4.0, &["quadratic_drag"])],
        found("explained", &[("quadratic_drag", 0.9)], 0.05),
    );
    assert!(!like.flagged_unknown && like.right && (like.on_truth - 1.0).abs() < 1e-12);
}

#[test]
fn closed_form_calibration_of_known_probabilities() {
    // 0.7 given a thousand times, right 700 times: no error; right 500 times: 0.2
    let pairs = |right: usize| (0..1000).map(|index| (0.7, index * 617 % 1000 < right)).collect::<Vec<_>>();
    assert!(calibration(pairs(700)).error < 0.02);
    let off = calibration(pairs(500));
    assert!((off.error - 0.2).abs() < 0.02, "{}", off.error);
    assert!(off.interval.0 < off.error && off.error < off.interval.1);
    assert_eq!(off.bins.iter().map(|bin| bin.count).sum::<usize>(), 1000);
    // perfect probabilities of all sizes, 20,000 of them: the variance in a bin of 1333 is 1/6/1333 = 1.25e-4, so the
    // debiased square scatters by 1.25e-4 sqrt(2/15) = 4.6e-5 about 0 and its root stays below sqrt(3 * 4.6e-5) = 0.012;
    // with 600 of them it would be 0.07
    let mut draw = Draw::new(&Draw::seed_of(3), 0);
    let given: Vec<f64> = (0..20_000).map(|_| draw.unit()).collect();
    let perfect = given.into_iter().map(|p| (p, draw.unit() < p)).collect();
    assert!(calibration(perfect).error < 0.012);
    assert_eq!(calibration(Vec::new()).count, 0);
}

#[test]
fn closed_form_a_small_corpus_adds_up() {
    let shrunk = "\"verdict\":\"explained\",\"effects\":[{\"name\":\"stribeck\",\"probability\":0.9,\"parameters\":\
                  [{\"name\":\"a\",\"value\":2.1,\"std\":0.1}]}],\"unknown_probability\":0.1,\"shrink\":{\"signals\":\
                  [{\"name\":\"gyro_angle_rad\",\"before\":10.0,\"after\":2.0,\"noise_floor\":1.0,\
                  \"reduction_percent\":97.0,\"ci95_percent\":[95.0,101.0]}]}";
    let nothing = || Vec::new();
    let judged = vec![
        one(Kind::Nothing, nothing(), found("no_gap", &[], 0.0)),
        one(Kind::Nothing, nothing(), found("explained", &[("stribeck", 0.6)], 0.0)),
        one(Kind::One, vec![effect("stribeck", 4.0, &[])], report(shrunk)),
        one(Kind::One, vec![effect("stribeck", 1.5, &[])], found("explained", &[("dead_zone", 0.7)], 0.0)),
        one(Kind::Beyond, vec![effect("torque_pulses", 4.0, &[])], found("unexplained", &[], 0.9)),
        judge(answer(Kind::One, vec![effect("dead_zone", 4.0, &[])]), None, 9.0),
    ];
    let score = Score::of(&judged);
    assert_eq!((score.logs, score.failed), (6, 1));
    assert_eq!(score.false_alarms, Rate { hits: 1, of: 2 });
    // the gates count singles from twice the detectable size on, a failed diagnosis among them
    let top1 = &score.gates[0];
    assert_eq!((top1.value, top1.of, top1.kept()), (Some(0.5), 2, Some(false)));
    assert!((top1.limits.0 - 0.95).abs() < 1e-12);
    assert_eq!(score.unknown_flagged, Rate { hits: 1, of: 1 });
    assert_eq!(score.unknown_at_5_percent, Rate { hits: 1, of: 1 });
    assert_eq!(score.unknown_auroc, Some(1.0));
    // 2.1 +- 1.96 * 0.1 holds 2.0
    assert_eq!(score.parameter_coverage, Rate { hits: 1, of: 1 });
    // best possible: 100 (100 - 1)/(100 - 1) = 100 %, inside 95 to 101
    assert_eq!(score.shrink_coverage, Rate { hits: 1, of: 1 });
    // (100 - 4)/(100 - 1)
    assert!((score.median_closed.expect("one") - 96.0 / 99.0).abs() < 1e-12);
    assert_eq!(score.seconds, (4.0, 9.0));
    // mixtures: nothing 1/2, one 1/3 right, beyond 1/1
    let (percent, right, _) = score.mixtures[0];
    assert_eq!(percent, [50, 25, 10, 5, 10]);
    assert!((right - (50.0 / 2.0 + 25.0 / 3.0 + 10.0) / 85.0).abs() < 1e-12, "{right}");
    // ln(1e-4) for a miss; the floor keeps it finite
    assert!(score.log_score.is_finite() && score.log_score > 0.0);
    let head = Head { corpus: "a<b".to_owned(), ..Head::default() };
    let page = html(&head, &score);
    assert!(page.contains("a&lt;b") && page.contains("<svg") && !page.contains("<script"));
    assert!(markdown(&head, &score).contains("| top-1, one effect"));
    // an unknown effect whose place one of the table takes cannot be told: it does not count
    let like = vec![effect("rate_squared_torque", 4.0, &["quadratic_drag"])];
    let mut more = judged;
    more.push(one(Kind::Beyond, like, found("explained", &[("quadratic_drag", 0.9)], 0.05)));
    assert_eq!(Score::of(&more).unknown_at_5_percent, Rate { hits: 1, of: 1 });
}

/// A hundred logs with one effect each, of which the first `right` are named rightly with a probability of `p`.
fn named(right: usize, p: f64) -> Vec<Judged> {
    (0..100)
        .map(|index| {
            let name = if index < right { "stribeck" } else { "dead_zone" };
            one(Kind::One, vec![effect("stribeck", 4.0, &[])], found("explained", &[(name, p)], 1.0 - p))
        })
        .collect()
}

#[test]
fn closed_form_a_loss_is_what_lies_below_the_interval_it_had() {
    let written = |judged: &[Judged]| -> File {
        let text = serde_json::to_string(&serde_json::json!({ "score": Score::of(judged) })).expect("JSON");
        serde_json::from_str(&text).expect("a written score")
    };
    let before = written(&named(90, 0.9)).score;
    let lost = |judged: &[Judged]| -> Vec<String> {
        compare(&before, &Score::of(judged))
            .into_iter()
            .filter(|change| change.lost)
            .map(|change| change.what)
            .collect()
    };
    // Wilson's interval of 90 of 100 reaches from 82.6 to 94.5 %
    assert_eq!(lost(&named(90, 0.9)), Vec::<String>::new());
    assert!(lost(&named(83, 0.9)).iter().all(|what| !what.starts_with("top-1") && !what.starts_with("verdicts")));
    assert!(lost(&named(99, 0.9)).iter().all(|what| what.starts_with("calibration")), "{:?}", lost(&named(99, 0.9)));
    let worse = lost(&named(80, 0.9));
    assert!(worse.iter().any(|what| what.starts_with("top-1")), "{worse:?}");
    assert!(worse.iter().any(|what| what.starts_with("verdicts right, put in: one")), "{worse:?}");
    // of five logs, one alone that turns is chance, two are a loss
    let one_of_five = written(&named(1, 0.9)[..5]).score;
    let verdicts = |judged: &[Judged]| {
        compare(&one_of_five, &Score::of(judged))
            .iter()
            .any(|change| change.lost && change.what.starts_with("verdicts"))
    };
    assert!(!verdicts(&named(0, 0.9)[..5]));
    let four_of_five = written(&named(4, 0.9)[..5]).score;
    assert!(
        compare(&four_of_five, &Score::of(&named(1, 0.9)[..5]))
            .iter()
            .any(|change| change.lost && change.what.starts_with("verdicts"))
    );
}

#[test]
fn closed_form_a_family_left_out_costs_what_the_others_do_not_know() {
    // friction is right when it says 0.9, disturbances never: who has seen friction alone trusts them
    let mut judged = Vec::new();
    for index in 0..400 {
        let name = if index % 4 < 2 { "stribeck" } else { "cable_spring" };
        let said = if name == "stribeck" { "stribeck" } else { "dead_zone" };
        judged.push(one(Kind::One, vec![effect(name, 4.0, &[])], found("explained", &[(said, 0.9)], 0.1)));
    }
    let score = Score::of(&judged);
    let row = |name: &str| score.held_out.iter().find(|row| row.name == name).expect("a row").clone();
    let disturbance = row("effects: disturbance");
    assert_eq!(disturbance.logs, 200);
    // with both families weighed alike half of the verdicts are right: q = 0.5, -ln q = 0.693
    assert!((disturbance.with - 0.693).abs() < 0.02, "{disturbance:?}");
    assert!(disturbance.without > 3.0 && disturbance.reported > 2.2, "{disturbance:?}");
    // one motion alone: without it nothing is left, and the ridge keeps what was reported
    let boost = row("motion: boost");
    assert!((boost.without - boost.reported).abs() < 1e-9, "{boost:?}");
}

#[test]
fn closed_form_dates() {
    assert_eq!(date(0), "1970-01-01 00:00 UTC");
    assert_eq!(date(951_782_400), "2000-02-29 00:00 UTC");
    assert_eq!(date(1_795_262_399), "2026-11-21 11:59 UTC");
}
