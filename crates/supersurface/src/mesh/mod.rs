//! Floor 6: meshes.
