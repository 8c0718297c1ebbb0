//! 16-bit depth images and instance masks, as PNG.

use std::io::Cursor;
use std::path::Path;

use supersurface::camera::{Camera, DepthImage};
use supersurface::cloud::PointCloud;

use crate::error::{Fault, ReadError};
use crate::read::{Read, ReadOptions, load};

/// Most bytes of a decoded image.
const LIMIT: usize = 256 << 20;

/// A grey image: size and values.
struct Grey {
    size: [usize; 2],
    values: Vec<u16>,
    bits: u8,
}

pub(crate) fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Read, Fault> {
    let Some(depth_camera) = &options.camera else {
        let mend = "a depth image needs intrinsics: pass --camera FILE.json, or --intrinsics and --depth-scale";
        return Err(Fault::new("camera", mend));
    };
    if let Some(field) = &options.instances {
        let problem = format!("a depth image has no field {field:?}: pass --mask IMAGE instead");
        return Err(Fault::new("instances", problem));
    }
    let grey = decode(bytes)?;
    if grey.bits != 16 {
        let problem = format!("{} bits a pixel: depth needs a 16-bit image", grey.bits);
        return Err(Fault::new("header", problem));
    }
    let camera = depth_camera.camera(grey.size)?;
    let metres = |v: &u16| match *v {
        0 => f32::NAN,
        v => (f64::from(v) / depth_camera.depth_scale) as f32,
    };
    let depth = grey.values.iter().map(metres).collect();
    let image = DepthImage::new(grey.size, depth)
        .ok_or_else(|| Fault::new("data", "the image has another size than its header says"))?;
    let cloud = PointCloud::from_depth(&image, &camera);
    if depth_camera.distortion != [0.0; 8] {
        leads_back(&cloud, &image, &camera)?;
    }
    Ok(Read { cloud, warnings: Vec::new() })
}

/// Pixels by which a point may miss the reading that it was made of.
const MISS: f64 = 0.1;

/// Whether the lens' distortion was undone at every reading: its map is not one to one where coefficients are
/// wrong, and the points there are too.
fn leads_back(cloud: &PointCloud, image: &DepthImage, camera: &Camera) -> Result<(), Fault> {
    let [width, _] = image.size();
    for (i, (point, depth)) in cloud.points.iter().zip(image.depth()).enumerate() {
        let (u, v) = ((i % width) as f64, (i / width) as f64);
        let z = f64::from(*depth);
        let back = camera.project(&(point / z)).map(|p| (p[0] - u).hypot(p[1] - v));
        let reading = z > 0.0 && z.is_finite();
        if reading && !back.is_some_and(|miss| miss <= MISS) {
            let problem = format!(
                "cannot be undone at pixel ({u}, {v}): check the coefficients (k1, k2, p1, p2, k3, k4, k5, k6, of \
                 this image size), or leave them out (--distortion, or D in the camera file)"
            );
            return Err(Fault::new("distortion", problem));
        }
    }
    Ok(())
}

/// The instances of an organised cloud from an 8- or 16-bit grey image of its size.
pub fn read_mask(file: &Path, grid: Option<[usize; 2]>) -> Result<Vec<u32>, ReadError> {
    let name = file.display().to_string();
    let fault = |f| ReadError::malformed(&name, "mask PNG", f);
    let grey = decode(&load(file)?).map_err(fault)?;
    let [w, h] = grey.size;
    match grid {
        Some([gw, gh]) if [gw, gh] == grey.size => {}
        Some([gw, gh]) => {
            let problem = format!("the mask is {w} x {h} but the cloud {gw} x {gh}");
            return Err(fault(Fault::new("size", problem)));
        }
        None => {
            let problem = "a mask needs an organised cloud; use --instances FIELD for this one";
            return Err(fault(Fault::new("cloud", problem)));
        }
    }
    Ok(grey.values.into_iter().map(u32::from).collect())
}

fn decode(bytes: &[u8]) -> Result<Grey, Fault> {
    let bad = |e: png::DecodingError| Fault::new("data", e.to_string());
    let mut decoder =
        png::Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: LIMIT });
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(bad)?;
    let info = reader.info();
    let (colour, depth) = (info.color_type, info.bit_depth);
    let size = [info.width as usize, info.height as usize];
    let indexed = colour == png::ColorType::Indexed && depth == png::BitDepth::Eight;
    if colour != png::ColorType::Grayscale && !indexed {
        let problem = format!("the image is {colour:?}: one grey channel is needed");
        return Err(Fault::new("header", problem));
    }
    let needed = reader.output_buffer_size().filter(|n| *n <= LIMIT);
    let too_large =
        || Fault::new("header", format!("{} x {} pixels are too many", size[0], size[1]));
    let needed = needed.ok_or_else(too_large)?;
    let mut raw = crate::bytes::room(needed).ok_or_else(too_large)?;
    raw.resize(needed, 0u8);
    reader.next_frame(&mut raw).map_err(bad)?;
    let (values, bits) = match depth {
        png::BitDepth::Sixteen => {
            let pairs = raw.as_chunks::<2>().0;
            (pairs.iter().map(|p| u16::from_be_bytes(*p)).collect(), 16)
        }
        png::BitDepth::Eight => (raw.iter().map(|v| u16::from(*v)).collect(), 8),
        other => {
            let problem = format!("{} bits a pixel: 8 or 16 are needed", other as u8);
            return Err(Fault::new("header", problem));
        }
    };
    Ok(Grey { size, values, bits })
}
