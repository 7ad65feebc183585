//! Links of a site.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Pages by their paths within the site.
pub type Pages = BTreeMap<PathBuf, String>;

/// The pages of a site.
pub fn read_pages(site: &Path) -> Result<Pages, String> {
    let pages = files_of(site, Path::new(""))?.into_iter().filter(|file| file.extension().is_some_and(|ending| ending == "html"));
    let read = |page: PathBuf| {
        let text = fs::read_to_string(site.join(&page)).map_err(|error| format!("{}: {error}", page.display()))?;
        Ok((page, text))
    };
    pages.map(read).collect()
}

/// Returns all broken links of some pages of a site as an error.
pub fn check_links(site: &Path, pages: &Pages) -> Result<(), String> {
    let files = files_of(site, Path::new(""))?;
    let problems: Vec<String> = pages.iter().flat_map(|(page, text)| problems_of_page(page, text, pages, &files)).collect();
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n")) }
}

/// All files below a folder of a site.
fn files_of(site: &Path, folder: &Path) -> Result<BTreeSet<PathBuf>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", site.join(folder).display());
    let mut files = BTreeSet::new();
    for entry in fs::read_dir(site.join(folder)).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let path = folder.join(entry.file_name());
        if entry.path().is_dir() {
            files.append(&mut files_of(site, &path)?);
        } else {
            files.insert(path);
        }
    }
    Ok(files)
}

/// Broken links of a page.
fn problems_of_page(page: &Path, text: &str, pages: &Pages, files: &BTreeSet<PathBuf>) -> Vec<String> {
    // Its links are relative to the address of the site, which is not known here.
    if page.file_name().is_some_and(|name| name == "404.html") {
        return Vec::new();
    }
    let links = ["href", "src"].into_iter().flat_map(|attribute| attribute_values(text, attribute));
    let nowhere = links.filter(|link| !is_outside(link)).filter_map(|link| {
        let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
        let target = if path.is_empty() { page.to_owned() } else { resolve_link(page, path) };
        if !files.contains(&target) {
            return Some(format!("{}: `{link}`: the site has no {}", page.display(), target.display()));
        }
        let anchor = anchor.filter(|anchor| !anchor.is_empty())?;
        let known = pages.get(&target)?;
        let missing = !attribute_values(known, "id").any(|id| id == anchor);
        missing.then(|| format!("{}: `{link}`: {} has no such heading", page.display(), target.display()))
    });
    nowhere.collect()
}

/// Whether a link leads out of the site.
fn is_outside(link: &str) -> bool {
    link.contains("://") || link.starts_with("mailto:") || link.starts_with("data:")
}

/// The path within the site of a link on a page.
fn resolve_link(page: &Path, link: &str) -> PathBuf {
    let mut path = page.parent().unwrap_or(Path::new("")).to_owned();
    for component in Path::new(link).components() {
        match component {
            Component::ParentDir => drop(path.pop()),
            Component::Normal(name) => path.push(name),
            _ => {}
        }
    }
    path
}

/// Values of an attribute.
fn attribute_values<'a>(text: &'a str, attribute: &str) -> impl Iterator<Item = &'a str> {
    let pattern = format!(" {attribute}=\"");
    let starts: Vec<usize> = text.match_indices(&pattern).map(|(at, found)| at + found.len()).collect();
    starts.into_iter().filter_map(|start| text[start..].split('"').next())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_that_lead_nowhere_are_named() {
        let page = "<h1 id=\"one\"></h1><a href=\"../b.html#two\"></a><a href=\"#one\"></a><img src=\"c.svg\">";
        let pages: Pages = [("m/a.html", page), ("b.html", "<h2 id=\"three\">")]
            .map(|(path, text)| (PathBuf::from(path), text.to_owned()))
            .into();
        let files = pages.keys().cloned().collect();
        let found = problems_of_page(Path::new("m/a.html"), page, &pages, &files);
        let expected = ["`../b.html#two`: b.html has no such heading", "`c.svg`: the site has no m/c.svg"];
        assert_eq!(found, expected.map(|problem| format!("m/a.html: {problem}")));
        let outside = "<a href=\"https://example.org/x\"></a>";
        assert_eq!(problems_of_page(Path::new("m/a.html"), outside, &pages, &files), Vec::<String>::new());
    }
}
