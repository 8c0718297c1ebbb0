//! Floor 3: what generic mathematics answers from the traits of a shape.
