//! The stub of the Python package lists the methods that follow from the table of quantities.
//!
//! `UPDATE_GOLDEN=1 cargo test -p crane-tests --test python_stub` writes it.

use crane_codegen::program::FunctionId;
use crane_tests::workspace;

const BEGIN: &str = "    # The methods below follow from the table of quantities: UPDATE_GOLDEN=1 cargo test -p crane-tests --test python_stub\n";

#[test]
fn the_stub_lists_the_methods_of_the_table() {
    let path = workspace::root().join("apps/python/crane/_native.pyi");
    let text = std::fs::read_to_string(&path).expect("the stub is there");
    let (by_hand, listed) = text.split_once(BEGIN).expect("the stub marks where the table begins");
    let methods: String = FunctionId::ALL.iter().filter_map(|id| method(*id)).collect();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, format!("{by_hand}{BEGIN}{methods}")).expect("the stub can be written");
    } else {
        assert_eq!(listed, methods);
    }
}

/// A method with its documentation.
fn method(id: FunctionId) -> Option<String> {
    let python = id.python()?;
    let text = python.required.iter().map(|name| format!("{name}: ArrayLike, ")).collect::<Vec<_>>().concat();
    let optional = python.optional.map_or(String::new(), |name| format!("{name}: ArrayLike | None = None, "));
    let mut about = vec![format!("(...{}): {}", id.axes(), id.doc())];
    about.extend(id.remarks().iter().map(|remark| remark.trim().to_owned()));
    about.extend(python.optional.map(|name| format!("{name}: s, 0 unless given.")));
    let about = about.join("\n        ");
    let name = id.name();
    Some(format!(
        "    def {name}(self, {text}{optional}*, invalid: str = \"raise\") -> Array:\n        \"\"\"{about}\"\"\"\n"
    ))
}
