//! Examples of the manual that open in the page as an instrument, and shipped cranes that move.

use std::fmt::Write as _;

use base64::{Engine as _, prelude::BASE64_URL_SAFE_NO_PAD};
use miniz_oxide::deflate::compress_to_vec;

/// The page as an instrument, within the site.
pub const INSTRUMENT: &str = "instrument.html";
/// The folder of the reports of shipped cranes, within the site.
pub const REPORTS: &str = "cranes";
/// How a whole spec begins.
const SPEC: &str = "format: 1\n";
/// How the line of a shipped crane in the gallery begins.
const SHIPPED: &str = "`crane run ";
/// Level of compression: the best that takes no time.
const LEVEL: u8 = 9;

/// A page with a link to the instrument below every whole spec, and with report and link of every shipped crane in the gallery. `root` leads from
/// the page to the site, `shipped` from the name of a shipped crane to its spec.
pub fn link_examples(page: &str, root: &str, shipped: impl Fn(&str) -> Option<String>) -> String {
    let (mut out, mut block) = (String::new(), None::<String>);
    for line in page.lines() {
        out.push_str(line);
        out.push('\n');
        match &mut block {
            Some(spec) if line == "```" => {
                if spec.starts_with(SPEC) {
                    let _ = write!(out, "\n{}\n", link(root, spec));
                }
                block = None;
            }
            Some(spec) => {
                spec.push_str(line);
                spec.push('\n');
            }
            None if line == "```yaml" => block = Some(String::new()),
            None => {
                let name = line.strip_prefix(SHIPPED).and_then(|rest| rest.split('`').next());
                if let Some((name, spec)) = name.and_then(|name| Some((name, shipped(name)?))) {
                    let report = format!("{root}{REPORTS}/{name}.html");
                    let _ = write!(
                        out,
                        "\n{} · [Report]({report})\n\n<iframe src=\"{report}#stage\" title=\"{name} in motion\" loading=\"lazy\" \
                         style=\"width: 100%; height: 34rem; border: 0\"></iframe>\n",
                        link(root, &spec)
                    );
                }
            }
        }
    }
    out
}

/// The link that opens a spec: compressed, in the fragment of the instrument's address, as `instrument/src/link.js` reads it.
fn link(root: &str, spec: &str) -> String {
    let letters = BASE64_URL_SAFE_NO_PAD.encode(compress_to_vec(spec.as_bytes(), LEVEL));
    format!("[Open in the instrument]({root}{INSTRUMENT}#spec={letters})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec;

    #[test]
    fn whole_specs_and_shipped_cranes_have_links() {
        let spec = "format: 1\nname: rod\n";
        let page = format!("# A\n```yaml\n{spec}```\n```yaml\nlinks: []\n```\n`crane run boom`: 2 coordinates\n");
        let linked = link_examples(&page, "../", |name| (name == "boom").then(|| "format: 1\nname: boom\n".to_owned()));
        let texts: Vec<String> = linked
            .split("](../instrument.html#spec=")
            .skip(1)
            .map(|rest| BASE64_URL_SAFE_NO_PAD.decode(rest.split(')').next().unwrap()).unwrap())
            .map(|bytes| String::from_utf8(decompress_to_vec(&bytes).unwrap()).unwrap())
            .collect();
        assert_eq!(texts, [spec, "format: 1\nname: boom\n"]);
        assert!(linked.contains("<iframe src=\"../cranes/boom.html#stage\""));
        // Nothing is lost.
        assert!(page.lines().all(|line| linked.lines().any(|kept| kept == line)));
    }
}
