//! Broken files never panic: cut at every byte, and with bytes changed at random.

use supersurface::numeric::random::Stream;
use supersurface_io::{ReadOptions, parse};

use crate::formats::{camera, depth_png, pcd, ply};

fn samples() -> Vec<(&'static str, Vec<u8>, ReadOptions)> {
    let plain = ReadOptions::default;
    let mut all = vec![
        ("t.xyz", b"1 2 3\n4,5,6\nx y z\n7;8;9\n".to_vec(), plain()),
        ("d.png", depth_png(), camera()),
    ];
    for encoding in ["ascii", "binary", "binary_compressed"] {
        all.push(("p.pcd", pcd(encoding), plain()));
    }
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        all.push(("p.ply", ply(format), plain()));
    }
    all
}

#[test]
fn a_file_cut_anywhere_is_read_or_refused() {
    for (name, bytes, options) in samples() {
        for end in 0..bytes.len() {
            let _ = parse(name, &bytes[..end], &options);
        }
    }
}

#[test]
fn changed_bytes_are_read_or_refused() {
    for (k, (name, bytes, options)) in samples().into_iter().enumerate() {
        let mut random = Stream::new(17, k as u64);
        for _ in 0..4000 {
            let mut changed = bytes.clone();
            for _ in 0..1 + random.index(4) {
                let at = random.index(changed.len());
                changed[at] = random.bits() as u8;
            }
            let _ = parse(name, &changed, &options);
        }
    }
}

#[test]
fn promises_that_the_file_does_not_keep_are_refused_at_once() {
    for count in ["1000000000000", "18446744073709551615", "4611686018427387904"] {
        for data in ["ascii", "binary", "binary_compressed"] {
            let header = format!(
                "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {count}\n\
                 HEIGHT 1\nPOINTS {count}\nDATA {data}\n\x10\0\0\0\x10\0\0\0garbage"
            );
            let error = parse("h.pcd", header.as_bytes(), &Default::default()).unwrap_err();
            assert!(error.to_string().contains("h.pcd"), "{error}");
        }
        for format in ["ascii", "binary_little_endian"] {
            let header = format!(
                "ply\nformat {format} 1.0\nelement vertex {count}\nproperty float x\n\
                 property float y\nproperty float z\nend_header\n1 2 3\n"
            );
            assert!(parse("h.ply", header.as_bytes(), &Default::default()).is_err());
        }
    }
}

#[test]
fn elements_without_properties_cost_nothing() {
    for format in ["ascii", "binary_little_endian"] {
        let mut file = format!("ply\nformat {format} 1.0\n");
        file += &"element nothing 1048576\n".repeat(1990);
        file += "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3 \
                 and more";
        let began = std::time::Instant::now();
        let read = parse("many.ply", file.as_bytes(), &Default::default()).unwrap();
        assert_eq!(read.cloud.points.len(), 1, "{format}");
        assert!(began.elapsed().as_secs_f64() < 0.5, "{format}: {:?}", began.elapsed());
    }
}

#[test]
fn what_a_file_says_is_quoted_short_and_harmless() {
    let long = "a".repeat(100_000);
    let pcd = |fields: &str| {
        format!(
            "VERSION 0.7\nFIELDS {fields}\nSIZE 4\nTYPE F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1\n"
        )
    };
    let ply = |format: &str| format!("ply\nformat {format} 1.0\nend_header\n");
    for bad in ["\u{1b}[31mred\u{1b}]0;title\u{7}", "\u{202e}back", long.as_str()] {
        let named = ReadOptions { instances: Some("object".into()), ..Default::default() };
        for (name, file) in [
            ("t.xyz", format!("{bad} b c\n1 2 3\n")),
            ("t.csv", format!("x,y,z,{bad}\n1,2,3,4\n")),
            ("t.pcd", pcd(bad)),
            ("t.pcd", pcd("x").replace("DATA ascii", &format!("DATA {bad}"))),
            ("t.pcd", pcd("x").replace("WIDTH 1", &format!("WIDTH {bad}"))),
            ("t.ply", ply(bad)),
            ("t.ply", ply("ascii").replace("end", &format!("element {bad} x\nend"))),
        ] {
            let error = parse(name, file.as_bytes(), &named).unwrap_err().to_string();
            assert!(error.chars().count() < 1000, "{}", error.len());
            assert!(!error.contains(['\u{1b}', '\u{7}', '\u{202e}', '\n']), "{error:?}");
        }
    }
}

#[test]
fn a_long_header_line_is_read_whole_or_refused() {
    let wide = |names: usize| {
        let fields: String = (0..names).map(|k| format!(" field{k}")).collect();
        let all = |word: &str| format!(" {word}").repeat(names + 3);
        let (size, kind) = (all("4"), all("F"));
        let row = all("1");
        format!(
            "VERSION 0.7\nFIELDS x y z{fields}\nSIZE{size}\nTYPE{kind}\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n{row}\n"
        )
    };
    assert_eq!(
        parse("w.pcd", wide(2000).as_bytes(), &Default::default()).unwrap().cloud.points.len(),
        1
    );
    let error =
        parse("w.pcd", wide(100_000).as_bytes(), &Default::default()).unwrap_err().to_string();
    assert!(error.contains("w.pcd") && error.contains("line 2"), "{error}");
}

#[test]
fn a_viewpoint_that_is_no_pose_is_told() {
    let file = String::from_utf8(pcd("ascii")).unwrap();
    for bad in ["banana", "0 0 1", "0 0 0 1 0 0 zero", "0 0 0 1 0 0 0 0", ""] {
        let file = file.replace("VIEWPOINT 0 0 1 0 1 0 0", &format!("VIEWPOINT {bad}"));
        let error = parse("v.pcd", file.as_bytes(), &Default::default()).unwrap_err().to_string();
        for word in ["v.pcd", "line 9", "VIEWPOINT", "0 0 0 1 0 0 0"] {
            assert!(error.contains(word), "{error}");
        }
    }
    for (odd, warnings) in [("0 0 0 0 0 0 0", 1), ("nan 0 0 1 0 0 0", 1), ("0 0 0 1 0 0 0", 0)] {
        let file = file.replace("VIEWPOINT 0 0 1 0 1 0 0", &format!("VIEWPOINT {odd}"));
        let read = parse("v.pcd", file.as_bytes(), &Default::default()).unwrap();
        assert_eq!(
            (read.cloud.world, read.warnings.len()),
            (None, warnings),
            "{:?}",
            read.warnings
        );
    }
}
