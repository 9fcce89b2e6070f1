//! The vertices of meshes, read from STL files.

use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The problem of a mesh, and the remedy.
pub(crate) type Problem = (String, &'static str);

/// Length of the header of a binary STL file, and of each triangle after it, bytes.
const BINARY: [usize; 2] = [84, 50];

const EXPORT: &str = "export the mesh as STL again";

/// Returns the file of a mesh as a URDF names it: relative to `folder`, or for `package://` from
/// there upwards, with the name of the package and without. `None` if there is no such file.
pub(crate) fn sought(file: &str, folder: &Path) -> Option<PathBuf> {
    let folder = std::path::absolute(folder).ok()?;
    let Some(path) = file.strip_prefix("package://") else {
        let path = folder.join(file.strip_prefix("file://").unwrap_or(file));
        return path.is_file().then_some(path);
    };
    let within = path.split_once('/').map_or(path, |(_, within)| within);
    let places = folder.ancestors().flat_map(|above| [above.join(path), above.join(within)]);
    places.into_iter().find(|place| place.is_file())
}

/// Reads the vertices of an STL file, binary or text, in the file's unit.
pub(crate) fn vertices(path: &Path) -> Result<Vec<[f64; 3]>, Problem> {
    let extension = path.extension().map_or_else(String::new, |e| e.to_string_lossy().into());
    if !extension.eq_ignore_ascii_case("stl") {
        let problem = format!("is a file of the format `{extension}`, and only STL is read");
        return Err((problem, "export the mesh as STL"));
    }
    let unread = |e| (format!("cannot be read: {e}"), "give the path of an STL file");
    let bytes = std::fs::read(path).map_err(unread)?;
    let mut file = Cursor::new(recognised(bytes));
    let broken = |e: std::io::Error| (format!("is not a complete STL file: {e}"), EXPORT);
    let reader = stl_io::create_stl_reader(&mut file).map_err(broken)?;
    let mut all = Vec::new();
    for triangle in reader {
        let corners = triangle.map_err(broken)?.vertices;
        all.extend(corners.map(|corner| [0, 1, 2].map(|i| f64::from(corner[i]))));
    }
    if all.is_empty() {
        return Err(("has no triangle".into(), EXPORT));
    }
    if !all.iter().flatten().all(|x| x.is_finite()) {
        return Err(("has a vertex that is not finite".into(), EXPORT));
    }
    Ok(all)
}

/// Returns the bytes so that the reader tells binary files from texts: some binary files begin with
/// the word that a text begins with, and some texts have no name after it.
fn recognised(mut bytes: Vec<u8>) -> Vec<u8> {
    let [header, each] = BINARY;
    let count = bytes.get(header - 4..header).and_then(|count| count.try_into().ok());
    let count = count.map(|count| u32::from_le_bytes(count) as usize);
    if count.is_some_and(|count| bytes.len() == header + each * count) {
        bytes[..header - 4].fill(0);
    } else if bytes.starts_with(b"solid\n") || bytes.starts_with(b"solid\r") {
        bytes.insert(5, b' ');
    }
    bytes
}
