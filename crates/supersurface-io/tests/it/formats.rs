//! Each format by small files that are written here.

use supersurface_io::{DepthCamera, ReadOptions, parse, read_camera};

/// A PCD of three points in each encoding, the second without a reading.
pub(crate) fn pcd(encoding: &str) -> Vec<u8> {
    let mut file = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 4\nTYPE F F F F U\n\
         COUNT 1 1 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 1 0 1 0 0\nPOINTS 3\nDATA {encoding}\n"
    )
    .into_bytes();
    let rows: [([f32; 3], u32, u32); 3] = [
        ([0.25, -0.5, 1.0], 0x0011_2233, 0),
        ([f32::NAN; 3], 0, 1),
        ([1.5, 2.5, -3.5], 0x00FF_8000, 2),
    ];
    match encoding {
        "ascii" => {
            for (p, colour, label) in rows {
                let colour = f32::from_bits(colour);
                let line = format!("{} {} {} {colour:e} {label}\n", p[0], p[1], p[2]);
                file.extend(line.bytes());
            }
        }
        "binary" => {
            for (p, colour, label) in rows {
                file.extend(p.iter().flat_map(|v| v.to_le_bytes()));
                file.extend(colour.to_le_bytes());
                file.extend(label.to_le_bytes());
            }
        }
        _ => {
            let mut columns = Vec::new();
            for k in 0..3 {
                columns.extend(rows.iter().flat_map(|r| r.0[k].to_le_bytes()));
            }
            columns.extend(rows.iter().flat_map(|r| r.1.to_le_bytes()));
            columns.extend(rows.iter().flat_map(|r| r.2.to_le_bytes()));
            // literal runs of at most 32 bytes
            let mut packed = Vec::new();
            for run in columns.chunks(32) {
                packed.push(run.len() as u8 - 1);
                packed.extend(run);
            }
            file.extend((packed.len() as u32).to_le_bytes());
            file.extend((columns.len() as u32).to_le_bytes());
            file.extend(packed);
        }
    }
    file
}

/// A PLY of two points with a list before and in the vertices.
pub(crate) fn ply(format: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {format} 1.0\ncomment made here\nelement face 1\nproperty list uchar int vertex_indices\n\
         element vertex 2\nproperty double x\nproperty float y\nproperty float z\nproperty list uchar short extra\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    )
    .into_bytes();
    if format == "ascii" {
        file.extend(b"3 0 1 0\n0.5 -1 2 2 7 8 10 20 30\n4 5 6 0 40 50 60\n");
        return file;
    }
    let big = format == "binary_big_endian";
    let mut put = |bytes: &[u8]| {
        if big {
            file.extend(bytes.iter().rev());
        } else {
            file.extend(bytes);
        }
    };
    put(&[3]);
    for i in [0i32, 1, 0] {
        put(&i.to_le_bytes());
    }
    for (p, extra, colour) in
        [([0.5, -1.0, 2.0], vec![7i16, 8], [10u8, 20, 30]), ([4.0, 5.0, 6.0], vec![], [40, 50, 60])]
    {
        put(&f64::to_le_bytes(p[0]));
        put(&(p[1] as f32).to_le_bytes());
        put(&(p[2] as f32).to_le_bytes());
        put(&[extra.len() as u8]);
        for e in extra {
            put(&e.to_le_bytes());
        }
        for c in colour {
            put(&[c]);
        }
    }
    file
}

/// A 3 x 2 depth image of 16 bits: 1000, 2000, 0, ...
pub(crate) fn depth_png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let values: [u16; 6] = [1000, 2000, 0, 500, 65535, 1];
    let raw: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    encoder.write_header().unwrap().write_image_data(&raw).unwrap();
    bytes
}

pub(crate) fn camera() -> ReadOptions {
    let camera = DepthCamera {
        size: Some([3, 2]),
        focal: [2.0, 2.0],
        centre: [1.0, 0.5],
        distortion: [0.0; 8],
        depth_scale: 1000.0,
    };
    ReadOptions { camera: Some(camera), ..Default::default() }
}

#[test]
fn pcd_in_every_encoding() {
    let options = ReadOptions { instances: Some("label".into()), ..Default::default() };
    for encoding in ["ascii", "binary", "binary_compressed"] {
        let cloud = parse("three.pcd", &pcd(encoding), &options).unwrap().cloud;
        assert_eq!(cloud.points.len(), 3, "{encoding}");
        assert_eq!(cloud.finite_count(), 2, "{encoding}");
        assert_eq!(cloud.points[2].y, 2.5, "{encoding}");
        assert_eq!(cloud.colours[2], [255, 128, 0], "{encoding}");
        assert_eq!(cloud.labels, [0, 1, 2], "{encoding}");
        assert_eq!(cloud.grid, None);
        assert_eq!(cloud.world.unwrap().translation.vector.z, 1.0);
    }
    let unasked = parse("three.pcd", &pcd("binary"), &Default::default()).unwrap().cloud;
    assert!(unasked.labels.is_empty(), "a label field is not used unasked");
    let options = ReadOptions { instances: Some("segment".into()), ..Default::default() };
    let error = parse("three.pcd", &pcd("binary"), &options).unwrap_err().to_string();
    assert!(error.contains("x, y, z, rgb, label"), "{error}");
}

#[test]
fn ply_in_every_encoding() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let cloud = parse("two.ply", &ply(format), &Default::default()).unwrap().cloud;
        assert_eq!(cloud.points.len(), 2, "{format}");
        assert_eq!(cloud.points[0].coords.as_slice(), [0.5, -1.0, 2.0], "{format}");
        assert_eq!(cloud.points[1].coords.as_slice(), [4.0, 5.0, 6.0], "{format}");
        assert_eq!(cloud.colours, [[10, 20, 30], [40, 50, 60]], "{format}");
    }
}

#[test]
fn depth_becomes_points() {
    let cloud = parse("depth.png", &depth_png(), &camera()).unwrap().cloud;
    assert_eq!(cloud.grid, Some([3, 2]));
    assert_eq!(cloud.finite_count(), 5);
    let p = cloud.points[0];
    assert!((p.x + 0.5).abs() < 1e-9 && (p.y + 0.25).abs() < 1e-9 && (p.z - 1.0).abs() < 1e-6);
    let error = parse("depth.png", &depth_png(), &Default::default()).unwrap_err().to_string();
    assert!(error.contains("--camera"), "{error}");
}

#[test]
fn a_distortion_that_cannot_be_undone_is_refused() {
    let with = |distortion| {
        let mut options = camera();
        options.camera.as_mut().unwrap().distortion = distortion;
        parse("depth.png", &depth_png(), &options)
    };
    with([-0.1, 0.02, 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
    // folds within the image; a pole of the denominator; numbers without end
    for k in [[-9.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 50.0], [1e300, 0.0, 0.0, 0.0]] {
        let error = with([k[0], k[3], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap_err().to_string();
        assert!(error.contains("depth.png") && error.contains("--distortion"), "{error}");
    }
}

#[test]
fn a_wrong_camera_file_is_named_itself() {
    let folder = std::env::temp_dir().join(format!("supersurface-camera-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("camera.json");
    let right =
        r#"{"width":3,"height":2,"fx":2,"fy":2,"cx":1,"cy":0.5,"depth_scale":1000,"D":[0.1]}"#;
    std::fs::write(&file, right).unwrap();
    read_camera(&file).unwrap();
    for (from, to, word) in [
        ("\"fx\":2", "\"fx\":0", "fx"),
        ("\"width\":3", "\"width\":0", "width"),
        ("\"depth_scale\":1000", "\"depth_scale\":-1", "depth_scale"),
        ("[0.1]", "[0,0,0,0,0,0,0,0,0]", "D"),
    ] {
        std::fs::write(&file, right.replace(from, to)).unwrap();
        let error = read_camera(&file).unwrap_err().to_string();
        assert!(error.contains("camera.json") && error.contains(word), "{error}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn text_with_names_commas_and_comments() {
    let csv = "# made here\nname,z,x,y\na,3,1,2\nb,6,4,5\n";
    let cloud = parse("two.csv", csv.as_bytes(), &Default::default()).unwrap().cloud;
    assert_eq!(cloud.points[1].coords.as_slice(), [4.0, 5.0, 6.0]);
    let error = parse("e.xyz", b"0,1 0,2 0,3\n", &Default::default()).unwrap_err().to_string();
    assert!(error.contains("e.xyz") && error.contains("line 1"), "{error}");
}
