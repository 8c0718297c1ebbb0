//! Floor 9: cloud to table to objects to surfaces to grasps.
