//! Changes of a spec as values: the crane is that of the file that they are saved as.

use std::path::Path;

use crane_codegen::spec::entries;
use crane_codegen::{Change, Checked, Diagnostics, SourceFile, build, check, compile};

/// All that a chain is, or the codes of all mistakes. `Debug` writes the shortest decimal that is a double, so the same text is the same bits.
fn all(found: &Result<Checked, Diagnostics>) -> String {
    match found {
        Ok(checked) => format!("{:?}", checked.chain),
        Err(mistakes) => format!("{:?}", mistakes.mistakes().iter().map(|mistake| mistake.code).collect::<Vec<_>>()),
    }
}

#[test]
fn a_changed_crane_is_that_of_the_saved_file() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs");
    let (mut cranes, mut sound) = (0, 0);
    for folder in [folder.clone(), folder.join("examples")] {
        let files = std::fs::read_dir(folder).expect("specs").map(|entry| entry.expect("an entry").path());
        for file in files.filter(|file| file.extension().is_some_and(|extension| extension == "yaml")) {
            let source = build::open(&file).expect("a spec");
            let checked = compile::check(&source).expect("a crane");
            let crane = &checked.spec.crane;
            let held = |(index, drive): (usize, &crane_codegen::spec::Drive)| {
                let motion =
                    Change::keys([("hold", if index == 0 { "held_".into() } else { (0.1 * index as f64).into() })]);
                let coordinate = drive.coordinate.value.as_deref()?;
                Some(Change::keys([("coordinate", coordinate.into()), ("motion", motion)]))
            };
            let drives = Change::list(entries(crane.drives.as_ref()).enumerate().filter_map(held));
            let flexible = entries(Some(&crane.links)).filter(|link| link.beam.is_some());
            let rigid = |link: &crane_codegen::spec::Link| {
                let beam = Change::keys([("sections", "rigid".into())]);
                Some(Change::keys([("name", link.name.value.as_deref()?.into()), ("beam", beam)]))
            };
            let links = Change::list(flexible.filter_map(rigid));
            let held = Change::keys([("value", (-0.3).into()), ("about", "what's held, \"on\"".into())]);
            let parameters = Change::keys([("held_", held)]);
            for change in [
                Change::keys([("parameters", parameters), ("drives", drives.clone())]),
                Change::keys([("name", "on".into()), ("links", links)]),
                Change::keys([("drives", drives), ("gravity", Change::list([0.0.into(), 0.0.into(), (-1e-7).into()]))]),
                Change::keys([("run", Change::removed())]),
                Change::keys([("run", Change::keys([("step", "fast".into())]))]),
            ] {
                let saved = source.changed(&change.text());
                let read = compile::check(&saved);
                let changed = checked.spec.changed(&change);
                let found = changed.and_then(|changed| {
                    assert_eq!(*changed.saved(), saved);
                    check(changed)
                });
                assert_eq!(all(&found), all(&read), "{}: {}", file.display(), change.text());
                sound += usize::from(found.is_ok());
            }
            cranes += 1;
        }
    }
    assert!(cranes >= 13 && sound > 2 * cranes, "{sound} of {cranes} cranes");
}

/// Mistakes of a change are where what it replaces is, in the file of the user.
#[test]
fn mistakes_of_changes_are_in_the_file() {
    let text = "format: 1\nname: rod\nlinks:\n  - name: rod\n    joint: revolute\n    mass: 3\n    com: [0, -1, 0]\n";
    let source = SourceFile::new("rod.yaml", text);
    let checked = compile::check(&source).expect("a crane");
    let lines = |keys: Change| {
        let change = Change::keys([("links", Change::list([keys]))]);
        let diagnostics = checked.spec.changed(&change).and_then(check).expect_err("a mistake");
        diagnostics.lines().collect::<Vec<_>>()
    };
    let found = lines(Change::keys([("name", "rod".into()), ("mass", (-3.0).into())]));
    assert!(found.len() == 1 && found[0].starts_with("rod.yaml:6:11: "), "{found:?}");
    // What was not there is where the link is.
    let found = lines(Change::keys([("name", "rod".into()), ("colour", 3.0.into())]));
    assert!(found.len() == 1 && found[0].starts_with("rod.yaml:4:5: ") && found[0].contains("colour"), "{found:?}");
}
