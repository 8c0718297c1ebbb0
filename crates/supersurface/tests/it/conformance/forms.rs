//! Fundamental forms and curvatures against differences of points and normals.

use supersurface::measure::implicit_curvature;
use supersurface::numeric::random::Stream;
use supersurface::shape::{FundamentalForms, Parametric, SecondOrder, Superellipsoid, Supertoroid};

use super::members::Make;
use super::samples::{difference, free_angles, scaled, shapes};

/// Members whose fundamental forms are closed.
pub(super) trait Forms: Parametric {
    fn forms(&self, eta: f64, omega: f64) -> Option<FundamentalForms>;
}

impl Forms for Superellipsoid {
    fn forms(&self, eta: f64, omega: f64) -> Option<FundamentalForms> {
        self.fundamental_forms(eta, omega)
    }
}

impl Forms for Supertoroid {
    fn forms(&self, eta: f64, omega: f64) -> Option<FundamentalForms> {
        self.fundamental_forms(eta, omega)
    }
}

/// The second form `[L, M, N]` by differences of the normal, positive where convex, with its error.
fn second_form(shape: &impl Parametric, [eta, omega]: [f64; 2]) -> Option<[(f64, f64); 3]> {
    let [along, around] = shape.tangents(eta, omega)?;
    let normal = |eta: f64, omega: f64| shape.normal(eta, omega).map(|n| n.into_inner());
    normal(eta, omega)?;
    let at = |eta, omega| normal(eta, omega).unwrap_or_default();
    let h = 1e-4;
    let by_eta = difference(|h| at(eta + h, omega), h);
    let by_omega = difference(|h| at(eta, omega + h), h);
    let part = |d: &super::samples::Difference, t: &supersurface::Vector| {
        (d.slope.dot(t), (2.0 * d.error + 1e-10 / h) * t.norm())
    };
    Some([part(&by_eta, &along), part(&by_eta, &around), part(&by_omega, &around)])
}

/// `E, F, G` are products of the tangents, `L, M, N` of the normal's differences; twice as large a shape has four and
/// two times as large ones.
pub(super) fn fundamental_forms<S: Forms>(make: Make<S>) {
    let (mut sharp, mut all) = (0, 0);
    for (case, shape) in shapes(make, 200) {
        let random = &mut Stream::new(41, case);
        let large = scaled(make, case, 2.0);
        for _ in 0..20 {
            let [eta, omega] = free_angles(&shape, random);
            let (Some(forms), Some([a, b])) = (shape.forms(eta, omega), shape.tangents(eta, omega))
            else {
                continue;
            };
            all += 1;
            let (aa, bb) = (a.norm_squared(), b.norm_squared());
            let products = [aa, a.dot(&b), bb];
            for ((found, truth), size) in
                forms.first.iter().zip(products).zip([aa, (aa * bb).sqrt(), bb])
            {
                assert!((found - truth).abs() <= 1e-10 * size, "{case}: {forms:?} {products:?}");
            }
            let differences = second_form(&shape, [eta, omega]).unwrap();
            let size = forms.second.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            for (found, (truth, error)) in forms.second.iter().zip(differences) {
                assert!(
                    (found - truth).abs() <= error + 1e-6 * size,
                    "{case} {eta} {omega}: {forms:?} {differences:?}"
                );
                sharp += usize::from(error < 1e-2 * size);
            }
            let other = large.forms(eta, omega).unwrap();
            for k in 0..3 {
                let (first, second) = (4.0 * forms.first[k], 2.0 * forms.second[k]);
                assert!((other.first[k] - first).abs() <= 1e-9 * first.abs());
                assert!((other.second[k] - second).abs() <= 1e-9 * second.abs());
            }
        }
    }
    assert!(sharp * 10 > all * 24 && all > 2000, "{sharp} of {all} differences say something");
}

/// Mean and Gaussian curvature of the gauge at surface points are those of the parametric form, by differences.
pub(super) fn curvature<S: SecondOrder + Parametric>(make: Make<S>) {
    let (mut sharp, mut all) = (0, 0);
    for (case, shape) in shapes(make, 200) {
        let random = &mut Stream::new(42, case);
        for _ in 0..20 {
            let [eta, omega] = free_angles(&shape, random);
            let p = shape.point(eta, omega);
            let (Some([a, b]), Some(forms)) =
                (shape.tangents(eta, omega), second_form(&shape, [eta, omega]))
            else {
                continue;
            };
            let Some(found) = implicit_curvature(&shape, &p) else { continue };
            all += 1;
            // the directions of the frame, in terms of the tangents: d = (a b) c
            let (e, f, g) = (a.norm_squared(), a.dot(&b), b.norm_squared());
            let area = e * g - f * f;
            if area <= 1e-6 * e * g {
                continue;
            }
            let [(l, dl), (m, dm), (n, dn)] = forms;
            let bend = |d: supersurface::Vector| {
                let (x, y) = (d.dot(&a), d.dot(&b));
                let (s, t) = ((g * x - f * y) / area, (e * y - f * x) / area);
                let error = s * s * dl + 2.0 * (s * t).abs() * dm + t * t * dn;
                (s * s * l + 2.0 * s * t * m + t * t * n, error)
            };
            let size = found.curvature.principal.iter().fold(0.0f64, |m, k| m.max(k.abs()));
            let mut fine = true;
            for (direction, k) in found.directions.iter().zip(found.curvature.principal) {
                let (truth, error) = bend(direction.into_inner());
                assert!(
                    (k - truth).abs() <= error + 1e-5 * size,
                    "{case} {eta} {omega}: {found:?} {truth} {error}"
                );
                // flat places have no curvature to compare with
                fine &= error < 1e-2 * size || size == 0.0;
            }
            sharp += usize::from(fine);
        }
    }
    assert!(sharp * 10 > all * 6 && all > 2000, "{sharp} of {all} differences say something");
}
