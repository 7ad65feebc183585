//! The spec of a crane with other numbers of sections.

use crane_codegen::{
    SourceFile,
    diagnostic::Span,
    read,
    spec::{Analysis, Sections},
};

/// Name of a crane with some number of sections of each flexible link.
pub fn name(crane: &str, sections: usize) -> String {
    format!("{crane}_sections_{sections}")
}

/// Spec of that crane, by exchanging values in the text of the spec; `None` for a crane without flexible links.
///
/// What a run of one crane does not need is left out: eight cranes a call take rustc as long as all the rest.
pub fn spec(crane: &str, text: &str, sections: usize) -> Option<String> {
    let spec = read(&SourceFile::new(crane, text)).ok()?;
    let spec = &spec.crane;
    let beams = spec.links.value.iter().flatten().filter_map(|link| link.value.as_ref()?.beam.as_ref()?.value.as_ref());
    let counts = beams.filter_map(|beam| beam.sections.as_ref());
    let counts = counts.filter(|count| matches!(count.value, Some(Sections::Count(_))));
    let mut values: Vec<_> = counts.map(|count| (count.span, sections.to_string())).collect();
    if values.is_empty() {
        return None;
    }
    values.push((spec.name.span, name(crane, sections)));
    let analyses = spec.analyses.as_ref().and_then(|given| given.value.as_deref()).unwrap_or_default();
    if let Some(index) = analyses.iter().position(|analysis| analysis.value == Some(Analysis::Ensemble)) {
        // With the comma that sets it apart from its neighbour.
        let start = index.checked_sub(1).map_or(analyses[index].span.start, |before| analyses[before].span.end);
        let end = if index > 0 { analyses[index].span.end } else { analyses.get(1)?.span.start };
        values.push((Span { start, end }, String::new()));
    }
    // From the last on: places before it stay.
    values.sort_unstable_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, value) in values {
        text.replace_range(span.start..span.end, &value);
    }
    Some(text)
}
