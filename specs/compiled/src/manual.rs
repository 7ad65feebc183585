//! Rust code of the manual, `docs/manual`, run as tests.

macro_rules! chapters {
    ($($name:ident: $file:literal,)+) => {
        $(
            #[doc = include_str!(concat!("../../../docs/manual/", $file))]
            mod $name {}
        )+
    };
}

chapters! {
    statics: "statics.md",
    integrators: "integrators.md",
    own_program: "own-program.md",
}
