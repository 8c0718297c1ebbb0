//! Files for supersurface.
