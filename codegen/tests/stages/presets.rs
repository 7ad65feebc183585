//! Presets of combinations: the factors that they stand for.

use crane_codegen::{SourceFile, read, validate};

/// Weight, mass and load of a combination.
fn factors(combination: &str) -> [f64; 3] {
    let source = SourceFile::new(
        "presets.yaml",
        format!(
            "format: 1\nname: presets\nparameters: {{payload: {{value: 100, unit: kg}}}}\n\
             links: [{{name: arm, joint: {{revolute: {{axis: y}}}}, mass: payload, com: [1, 0, 0]}}]\n\
             loads: [{{name: gust, link: arm, force: [0, 9, 0]}}]\n\
             combinations: [{{name: some, {combination}}}]\n"
        ),
    );
    let chain = read(&source).and_then(|spec| validate(&spec));
    let chain = chain.unwrap_or_else(|mistakes| panic!("{combination}:\n{mistakes}"));
    let some = &chain.combinations[0];
    [
        some.weight,
        some.masses.first().map_or(f64::NAN, |mass| mass.1),
        some.loads.first().map_or(f64::NAN, |load| load.1),
    ]
}

/// φ₂ = φ₂min + β₂ v, times the partial factor; what is written itself is in place of both.
#[test]
fn presets_stand_for_factors() {
    let all = "hoisted: [payload], wind: [gust]";
    for (preset, expected) in [
        ("regular", [1.22, 1.34, 0.0]),
        ("with_wind", [1.16, 1.22, 1.22]),
        ("exceptional", [1.1, 1.1, 1.1]),
        ("test_load", [1.0, 1.25, 1.0]),
    ] {
        assert_eq!(factors(&format!("preset: {preset}, {all}")), expected, "{preset}");
        assert_eq!(
            factors(&format!("preset: {preset}, {all}, weight: 2, masses: {{payload: 3}}, loads: {{gust: 4}}")),
            [2.0, 3.0, 4.0]
        );
    }
    for (class, expected) in
        [("hc1", 1.05 + 0.17 * 0.4), ("hc2", 1.1 + 0.34 * 0.4), ("hc3", 1.15 + 0.51 * 0.4), ("hc4", 1.2 + 0.68 * 0.4)]
    {
        let hoisting = format!("hoisted: [payload], hoisting: {{class: {class}, speed: 400 mm/s}}");
        let [weight, hoisted, _] = factors(&hoisting);
        assert!(weight == 1.0 && (hoisted - expected).abs() < 1e-14, "{class}: {hoisted}, {expected}");
        let [_, hoisted, _] = factors(&format!("preset: with_wind, {hoisting}"));
        assert!((hoisted - 1.22 * expected).abs() < 1e-14, "{class}: {hoisted}");
    }
}
