//! Builds the manual as a site, and checks that every link and picture of every page leads to something that exists.
//!
//! `book DOCS SITE`, with the folders of the manual and of the site.

mod site;

use std::path::{Path, PathBuf, absolute};
use std::process::ExitCode;
use std::{env, fs};

use mdbook_driver::MDBook;

fn main() -> ExitCode {
    // mdBook takes paths to be relative to the manual.
    let [docs, site] = [1, 2].map(|index| env::args_os().nth(index).and_then(|path| absolute(path).ok()));
    let (Some(docs), Some(site)) = (docs, site) else {
        eprintln!("book DOCS SITE: name the folder of the manual and the one for the site");
        return ExitCode::from(2);
    };
    match build_site(docs, &site) {
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

/// Builds the site; returns the number of its pages.
fn build_site(docs: PathBuf, site: &Path) -> Result<usize, String> {
    // Files of an earlier build would hide a missing page.
    if site.exists() {
        fs::remove_dir_all(site).map_err(|error| format!("{}: {error}", site.display()))?;
    }
    let mut book = MDBook::load(docs).map_err(|error| format!("{error:?}"))?;
    site.clone_into(&mut book.config.build.build_dir);
    book.build().map_err(|error| format!("{error:?}"))?;
    site::check_site(site)
}
