//! Floor 6: point clouds.

mod point_cloud;

pub use point_cloud::PointCloud;
