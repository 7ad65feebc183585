//! Specs of imported robots against their files, link by link.

use crane_codegen::SourceFile;
use crane_codegen::exchange::{ImportOptions, Imported, import};
use crane_live::LiveCrane;
use crane_live::imported::compare_with_file;

fn imported(file: &str) -> Imported {
    let path = format!("{}/../../codegen/tests/robots/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a robot");
    import(&SourceFile::new(file, text), &ImportOptions::default()).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

#[test]
fn a_number_of_the_spec_that_is_not_that_of_the_file_is_found() {
    for file in ["arm.xml", "branches.urdf", "rotor.urdf"] {
        let Imported { spec, reference, .. } = imported(file);
        let compare = |spec: &str| {
            let crane =
                LiveCrane::from_spec(&SourceFile::new(file, spec)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
            compare_with_file(&crane, reference.as_ref().expect("nothing is repaired"))
        };
        assert_eq!(compare(&spec), Ok(()), "{file}");
        // A hundred times the tolerance in a mass.
        let at = spec.find("mass: ").expect("a mass") + "mass: ".len();
        let end = at + spec[at..].find(['\n', ',']).expect("its end");
        let mass: f64 = spec[at..end].parse().expect("a number");
        let changed = format!("{}{}{}", &spec[..at], mass * (1.0 + 1e-6), &spec[end..]);
        assert!(compare(&changed).is_err(), "{file}");
    }
}
