//! Floor 8: scenes of supersurfaces, looked at by a simulated depth camera.
