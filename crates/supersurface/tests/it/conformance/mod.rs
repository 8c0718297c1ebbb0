//! One suite for every shape of the family: do its forms agree with each other, with independent derivatives and
//! with brute force, at all exponents from 0.1 to 2.5, at axis ratios up to 100:1, on seams and at poles?
//!
//! A shape passes by one line: its name, how to make a random one of any size, and what it can answer. Each word is a
//! generic function over the trait that it tests, so that a word for what a shape cannot answer does not compile.
//! To test a new shape, write its maker in `members.rs` (all lengths times `scale`) and its line here.

mod body;
mod dual;
mod extremes;
mod forms;
mod gauge;
mod members;
mod queries;
mod samples;
mod surface;

/// The functions that the words of a line name.
mod checks {
    pub(super) use super::body::{bounds, mass, support, tight, touched};
    pub(super) use super::dual::{dual, dual_gradient};
    pub(super) use super::extremes::{
        hessian_extremes, point_extremes, point_extremes_of_combined, support_extremes,
        surface_extremes,
    };
    pub(super) use super::forms::{curvature, fundamental_forms};
    pub(super) use super::gauge::{gradient, hessian};
    pub(super) use super::queries::{nearest, nearest_of_endless, nearest_solid, ray};
    pub(super) use super::surface::{on_surface, parametric};
}

macro_rules! conforms {
    ($member:ident: $make:ident => $($check:ident)+) => {
        mod $member {
            $(
                #[test]
                fn $check() {
                    super::checks::$check(super::members::$make);
                }
            )+
        }
    };
}

#[rustfmt::skip]
mod lines {
    use super::{checks, members};
    conforms!(superellipsoid: superellipsoid => gradient hessian dual on_surface parametric fundamental_forms curvature bounds touched support tight mass ray nearest point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(supertoroid: supertoroid => gradient hessian dual on_surface parametric fundamental_forms curvature bounds touched support tight mass ray nearest point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(superhyperboloid_one_sheet: one_sheet => gradient hessian dual on_surface parametric curvature bounds ray nearest_of_endless point_extremes hessian_extremes surface_extremes);
    conforms!(superhyperboloid_two_sheets: two_sheets => gradient hessian dual on_surface parametric curvature bounds ray nearest_of_endless point_extremes hessian_extremes surface_extremes);
    conforms!(superparaboloid: superparaboloid => gradient hessian dual on_surface parametric curvature bounds ray nearest_of_endless point_extremes hessian_extremes surface_extremes);
    conforms!(supercylinder: supercylinder => gradient hessian on_surface parametric curvature bounds touched support tight mass ray nearest nearest_solid point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(supercone: supercone => gradient hessian on_surface parametric curvature bounds touched support tight mass ray nearest nearest_solid point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(separable_superquadric: separable => gradient hessian dual on_surface parametric curvature bounds touched support tight mass ray nearest point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(quadric: quadric => gradient hessian on_surface parametric curvature bounds support mass ray nearest point_extremes hessian_extremes surface_extremes support_extremes);
    conforms!(supershape: supershape => gradient hessian on_surface parametric curvature bounds mass ray nearest point_extremes hessian_extremes surface_extremes);
    conforms!(hyperquadric: hyperquadric => gradient hessian bounds mass ray nearest_solid point_extremes hessian_extremes);
    conforms!(extended: extended => parametric surface_extremes);
    conforms!(extended_radial: extended_radial => gradient hessian on_surface parametric curvature bounds touched mass ray nearest_solid point_extremes hessian_extremes surface_extremes);
    conforms!(tapered: tapered => gradient dual_gradient on_surface parametric bounds mass ray nearest point_extremes surface_extremes);
    conforms!(twisted: twisted => gradient dual_gradient on_surface parametric bounds mass ray nearest point_extremes surface_extremes);
    conforms!(bent: bent => gradient dual_gradient on_surface parametric bounds mass ray nearest point_extremes surface_extremes);
    conforms!(shear_bent: shear_bent => gradient dual_gradient on_surface parametric bounds mass ray nearest point_extremes surface_extremes);
    conforms!(hollowed: hollowed => gradient dual_gradient on_surface parametric bounds mass ray nearest point_extremes surface_extremes);
    conforms!(combined: combined => gradient bounds ray nearest_solid point_extremes_of_combined);
    conforms!(posed: posed => gradient hessian on_surface parametric curvature bounds support mass ray nearest point_extremes hessian_extremes surface_extremes support_extremes);
}
