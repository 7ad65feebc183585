//! Text of the spec in C: words inside comments, and names that C does not reserve.

/// Keywords of C up to C23 and of C++, for headers that C++ includes, and macros that compilers and common headers define in lower
/// case. Words that Rust reserves too are listed as well: a parameter may have such a name.
const KEYWORDS: &str = "alignas alignof auto bool break case char const constexpr continue default do double else enum extern false \
    float for goto if inline int long nullptr register restrict return short signed sizeof static static_assert struct switch \
    thread_local true typedef typeof typeof_unqual union unsigned void volatile while \
    and and_eq asm bitand bitor catch char8_t char16_t char32_t class co_await co_return co_yield compl concept const_cast consteval \
    constinit decltype delete dynamic_cast explicit export friend mutable namespace new noexcept not not_eq operator or or_eq private \
    protected public reinterpret_cast requires static_cast template this throw try typeid typename using virtual wchar_t xor xor_eq \
    assert complex errno far fortran imaginary interface linux near noreturn offsetof pascal signbit small stderr stdin stdout unix \
    min max isnan isinf isfinite isnormal fpclassify interrupt";

/// Functions that the code calls, and arguments: variables have other names.
const CALLED: &str = "sin cos sqrt exp sinf cosf sqrtf expf smaller larger choose positions a w dx";

/// Words that a variable cannot have as its name.
pub fn not_for_variables() -> Vec<&'static str> {
    KEYWORDS.split_whitespace().chain(CALLED.split_whitespace()).collect()
}

/// The field for a parameter: its name, with one more underscore after a reserved word, so that different names stay different.
pub fn field(name: &str) -> String {
    let word = name.trim_end_matches('_');
    if KEYWORDS.split_whitespace().any(|reserved| reserved == word) { format!("{name}_") } else { name.to_owned() }
}

/// Words of the spec inside a comment: one line that neither ends the comment nor seems to begin another.
pub fn comment(words: &str) -> String {
    words.replace("*/", "* /").replace("/*", "/ *").replace(|c: char| c.is_control(), " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_names_stay_different() {
        let names = ["int", "int_", "int__", "payload", "payload_", "interval"];
        assert_eq!(names.map(field), ["int_", "int__", "int___", "payload", "payload_", "interval"]);
        assert!(not_for_variables().contains(&"restrict") && not_for_variables().contains(&"cos"));
    }

    #[test]
    fn a_comment_stays_a_comment() {
        for text in ["*/ int x; /*", "/*/", "*//", "/**/", "a\n*/", "*\\\n/"] {
            let inside = comment(text);
            assert!(!inside.contains("*/") && !inside.contains("/*") && !inside.contains('\n'), "{text:?}: {inside}");
        }
    }
}
