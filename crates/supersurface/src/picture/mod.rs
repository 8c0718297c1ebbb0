//! Floor 9: pixels on the CPU. Knows surfaces, points, lines and text; no files and no pipeline.
