//! Floor 6: point clouds, neighbours in them, and the unit mix-up.

mod normals;
mod point_cloud;
mod sets;
mod units;
mod voxels;

pub use normals::normals;
pub(crate) use normals::{Neighbourhood, Places, smallest_axis};
pub use point_cloud::PointCloud;
pub(crate) use sets::Sets;
pub use units::{UnitHint, unit_hint};
pub use voxels::VoxelGrid;
