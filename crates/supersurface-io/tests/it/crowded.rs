//! Crowded real scenes, every point labelled: how many objects are found as they are.

use std::collections::BTreeMap;

use supersurface::fit::FitOptions;
use supersurface::segment::{SegmentOptions, segment};
use supersurface::separate::separate;
use supersurface_io::{ReadOptions, read};

/// Labels from here on are parts of objects, ten an object; lesser ones are the table and the background.
const FIRST: u32 = 20;
/// Share in common from which an object is found.
const FOUND: f64 = 0.75;

/// Objects found, found in a piece that is mostly another's, and all.
fn counted(file: &std::path::Path) -> [usize; 3] {
    let given = ReadOptions { instances: Some("label".into()), ..ReadOptions::default() };
    let mut cloud = read(file, &given).unwrap().cloud;
    let labels = std::mem::take(&mut cloud.labels);
    let mut segmentation = segment(&cloud, &SegmentOptions::default()).unwrap();
    let objects = separate(&cloud, &mut segmentation, &FitOptions::UNDEFORMED.quick());
    let mut sizes = BTreeMap::<u32, usize>::new();
    for (label, _) in
        labels.iter().zip(&cloud.points).filter(|(l, p)| **l >= FIRST && p.z.is_finite())
    {
        *sizes.entry(label / 10).or_default() += 1;
    }
    let mut out = [0, 0, sizes.len()];
    for (object, size) in sizes {
        let common =
            |points: &[u32]| points.iter().filter(|i| labels[**i as usize] / 10 == object).count();
        let most = objects.iter().max_by_key(|o| common(&o.points)).unwrap();
        let both = common(&most.points);
        let share = both as f64 / (size + most.points.len() - both) as f64;
        let foreign = most.points.iter().filter(|i| labels[**i as usize] >= FIRST).count() - both;
        out[0] += usize::from(share >= FOUND);
        out[1] += usize::from(share < FOUND && 4 * foreign > both && 4 * both > size);
    }
    out
}

#[test]
fn objects_that_touch_are_found() {
    let Some(shared) = crate::shared() else { return };
    let (mut sum, mut scenes) = ([0; 3], 0);
    for folder in ["data/touching", "data/real"] {
        let entries = std::fs::read_dir(shared.join(folder)).unwrap().map(|e| e.unwrap().path());
        let named = |p: &std::path::PathBuf| {
            let name = p.file_name().unwrap().to_string_lossy().into_owned();
            name.starts_with("mosd_") && name.ends_with(".pcd")
        };
        for file in entries.filter(named) {
            let counts = counted(&file);
            sum = [0, 1, 2].map(|k| sum[k] + counts[k]);
            scenes += 1;
        }
    }
    assert_eq!((scenes, sum[2]), (18, 84));
    assert!(sum[0] >= 81 && sum[1] == 0, "{} found, {} merged", sum[0], sum[1]);
}
