//! Shipped cranes with their live parameters set, and with the same numbers written in their specs.

use std::fs;
use std::path::Path;

use crane_codegen::build;
use crane_combinations::observe::{Extent, differences, live, observe_live};
use crane_combinations::shown;
use crane_model::dyn_crane::DynCrane;

/// By how much each parameter is changed: enough to be seen, little enough for cranes to stand.
const FACTOR: f64 = 1.01;

/// Everything that is printed at rest, described, drawn and exported is equal, parameter by parameter.
#[test]
fn what_is_set_is_what_is_written() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs");
    let files = [folder.clone(), folder.join("examples")].into_iter().flat_map(|folder| {
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect::<Vec<_>>()
    });
    let (mut compared, mut wrong) = (0, Vec::new());
    for file in files.filter(|file| file.extension().is_some_and(|extension| extension == "yaml")) {
        let name = file.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let crane = live(&build::open(&file).expect("a spec")).expect("a crane");
        for (index, parameter) in crane.chain().parameters.iter().enumerate() {
            let value = FACTOR * parameter.default;
            let mut set = crane.clone();
            if set.set_parameter(index, value).is_err() {
                continue;
            }
            let text =
                format!("extends: {}\nparameters: {{{}: {{value: {value:e}}}}}\n", file.display(), parameter.name);
            let written = build::read_with("written.yaml", text.as_bytes(), &|_| None).expect("a spec");
            let written = live(&written).unwrap_or_else(|mistakes| panic!("{text}{mistakes}"));
            let of = |what: String| format!("{name}, {} = {value}: {what}", parameter.name);
            wrong.extend(shown::differences(&written, &set).into_iter().map(of));
            match (observe_live(&written, Extent::default()), observe_live(&set, Extent::default())) {
                (Ok(one), Ok(other)) => {
                    let found = differences([&one, &other], &|name| Some(name.to_owned()), &|_| 1.0);
                    wrong.extend(found.into_iter().map(of));
                    compared += 1;
                }
                (one, other) => assert_eq!(one.err(), other.err(), "{name}, {}", parameter.name),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared > 10, "{compared}");
}
