//! Segmentations that are given: a cloud that is one object, or one whose points are labelled.

use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::{SegmentError, SegmentOptions, Segmentation, readings, table};

/// Most objects of a scene: more labels are colours, normals or another field taken by mistake.
const MOST_OBJECTS: usize = 1000;

/// All readings as one object, without a support.
pub fn segment_whole(cloud: &PointCloud) -> Result<Segmentation, SegmentError> {
    Ok(Segmentation { objects: vec![readings(cloud)?], ..Segmentation::default() })
}

/// The objects that `cloud.labels` names (0 is background), in the order of their labels, and the
/// support that the background shows; that there is none is no error here.
pub fn segment_masks(
    cloud: &PointCloud,
    options: &SegmentOptions,
) -> Result<Segmentation, SegmentError> {
    let seen = readings(cloud)?;
    let label = |i: &u32| cloud.labels.get(*i as usize).copied().unwrap_or(0);
    let mut background = seen.clone();
    background.retain(|i| label(i) == 0);
    let mut labelled = seen;
    labelled.retain(|i| label(i) != 0);
    if labelled.is_empty() {
        return Err(SegmentError::NoLabels);
    }
    labelled.sort_by_key(label);
    let objects: Vec<Vec<u32>> =
        labelled.chunk_by(|a, b| label(a) == label(b)).map(<[u32]>::to_vec).collect();
    if objects.len() > MOST_OBJECTS {
        return Err(SegmentError::TooManyLabels { found: objects.len(), most: MOST_OBJECTS });
    }
    let mut random = Stream::new(options.seed, 0);
    let support = table::find(cloud, &background, &mut random).ok().map(|(support, _)| support);
    Ok(Segmentation {
        stands_on: vec![0; support.iter().len() * objects.len()],
        supports: support.into_iter().collect(),
        objects,
        ..Segmentation::default()
    })
}
