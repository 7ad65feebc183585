//! Builds the manual as a site with the page as an instrument, and checks that every link and picture of every page leads to something that
//! exists.
//!
//! `book DOCS SITE SPECS INSTRUMENT REPORTS`, with the folders of the manual, of the site and of the shipped specs, the page as an instrument, and
//! a folder of reports of these cranes.

mod examples;
mod site;

use std::path::{Path, PathBuf, absolute};
use std::process::ExitCode;
use std::{env, fs};

use examples::{INSTRUMENT, REPORTS};
use mdbook_driver::{MDBook, book::BookItem};

fn main() -> ExitCode {
    // mdBook takes paths to be relative to the manual.
    let paths: Option<Vec<PathBuf>> = env::args_os().skip(1).map(|path| absolute(path).ok()).collect();
    let Some([docs, site, specs, instrument, reports]) = paths.as_deref() else {
        eprintln!("book DOCS SITE SPECS INSTRUMENT REPORTS: name these five folders and files");
        return ExitCode::from(2);
    };
    match build_site(docs, site, specs, [(instrument, INSTRUMENT), (reports, REPORTS)]) {
        Ok(pages) => {
            println!("{pages} pages, every link leads to something");
            ExitCode::SUCCESS
        }
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the site, with some files and folders beside its pages; returns the number of its pages.
fn build_site(docs: &Path, site: &Path, specs: &Path, beside: [(&PathBuf, &str); 2]) -> Result<usize, String> {
    // Files of an earlier build would hide a missing page.
    if site.exists() {
        fs::remove_dir_all(site).map_err(|error| format!("{}: {error}", site.display()))?;
    }
    let mut book = MDBook::load(docs).map_err(|error| format!("{error:?}"))?;
    site.clone_into(&mut book.config.build.build_dir);
    book.book.for_each_mut(|item| {
        if let BookItem::Chapter(chapter) = item
            && let Some(path) = &chapter.path
        {
            let root = "../".repeat(path.components().count() - 1);
            let shipped = |name: &str| fs::read_to_string(specs.join(name).with_extension("yaml")).ok();
            chapter.content = examples::link_examples(&chapter.content, &root, shipped);
        }
    });
    book.build().map_err(|error| format!("{error:?}"))?;
    let pages = site::read_pages(site)?;
    for (from, to) in beside {
        copy(from, &site.join(to)).map_err(|error| format!("{}: {error}", from.display()))?;
    }
    site::check_links(site, &pages)?;
    Ok(pages.len())
}

/// Copies a file, or a folder of files.
fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    if from.is_file() {
        return fs::copy(from, to).map(|_| ());
    }
    fs::create_dir_all(to)?;
    fs::read_dir(from)?.try_for_each(|entry| {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))
    })
}
