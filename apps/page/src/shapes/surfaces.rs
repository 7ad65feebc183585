//! Triangles in files that a spec names, STL and OBJ.

use std::{collections::BTreeMap, io, path::Path, sync::Arc};

use crane_codegen::chain::{Chain, Form, Surface};
use mesh_loader::Loader;

/// Most triangles of a file: a page with more becomes slow.
const MOST_TRIANGLES: usize = 300_000;
/// Most bytes of a file: as many triangles as text.
const MOST_BYTES: usize = 128 << 20;

/// Reads the surfaces that the crane of a spec names, from the folder of the spec, so that they are drawn. `read` gives the bytes of a file that has at most as
/// many. Returns in words which could not be read, and why: what their links look like is guessed.
pub fn read_surfaces(
    chain: &mut Chain,
    spec: &Path,
    mut read: impl FnMut(&Path, usize) -> io::Result<Vec<u8>>,
) -> Option<String> {
    let folder = spec.parent().unwrap_or(Path::new(""));
    let mut known: BTreeMap<String, Result<Arc<Surface>, String>> = BTreeMap::new();
    for shape in &mut chain.shapes {
        let Form::Mesh { file, surface, .. } = &mut shape.form else { continue };
        let found = known.entry(file.clone()).or_insert_with(|| {
            let bytes = read(&folder.join(&*file), MOST_BYTES).map_err(|error| error.to_string())?;
            parse(file, &bytes).map(Arc::new)
        });
        *surface = found.clone().ok();
    }
    let told: Vec<String> =
        known.into_iter().filter_map(|(file, found)| Some(format!("`{file}`: {}", found.err()?))).collect();
    (!told.is_empty()).then(|| format!("not drawn, but named in exported files: {}", told.join("; ")))
}

/// The triangles of a file of this name.
fn parse(file: &str, bytes: &[u8]) -> Result<Surface, String> {
    // Files of colours, which an OBJ file may name, are left alone.
    let alone = |_: &Path| Err::<Vec<u8>, _>(io::ErrorKind::NotFound.into());
    let loader = Loader::default().merge_meshes(true);
    let found = loader.load_from_slice_with_reader(bytes, file, alone).map_err(|error| error.to_string())?;
    let meshes = || found.meshes.iter();
    let corners: Vec<[f64; 3]> = meshes().flat_map(|mesh| &mesh.vertices).map(|at| at.map(f64::from)).collect();
    let triangles: Vec<[usize; 3]> =
        meshes().flat_map(|mesh| &mesh.faces).map(|face| face.map(|corner| corner as usize)).collect();
    let whole = triangles.iter().flatten().all(|corner| *corner < corners.len());
    if !whole || corners.iter().flatten().any(|number| !number.is_finite()) {
        return Err("it has corners that are no places".to_owned());
    }
    match triangles.len() {
        0 => Err("it has no triangles".to_owned()),
        count if count > MOST_TRIANGLES => {
            Err(format!("it has {count} triangles, more than {MOST_TRIANGLES}: simplify it"))
        }
        _ => Ok(Surface { corners, triangles }),
    }
}
