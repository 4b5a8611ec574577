//! A robot's body as an argument.

use eeruf_sim::{Body, Outline};
use pyo3::prelude::*;

use crate::{
    arguments::{number, shown, wrong},
    errors::EerufError,
};

/// A disc, a box or a convex polygon.
pub(crate) fn outline(value: &Bound<'_, PyAny>) -> PyResult<Body> {
    if let Ok(radius_m) = value.extract::<f64>() {
        return number("body", value, f64::MIN_POSITIVE..=100.0).map(|_| Body::Disc(radius_m));
    }
    if let Ok((length_m, width_m)) = value.extract::<(f64, f64)>() {
        let fits = |size: f64| size > 0.0 && size <= 100.0;
        if fits(length_m) && fits(width_m) {
            return Ok(Body::Box(length_m, width_m));
        }
    } else if let Ok(corners) = value.extract::<Vec<[f64; 2]>>() {
        let polygon = Outline::new(&corners).map(Body::Polygon);
        return polygon.map_err(|error| EerufError::new_err(format!("body has {error}")));
    }
    let expected = "a radius, (length, width), or corners (x, y), in metres above 0 and up to 100";
    Err(wrong("body", shown(value), expected))
}

/// The argument that gives this body.
pub(crate) fn shown_body<'py>(py: Python<'py>, body: Option<&Body>) -> PyResult<Option<Bound<'py, PyAny>>> {
    match body {
        None => Ok(None),
        Some(Body::Disc(radius_m)) => Ok(Some(radius_m.into_pyobject(py)?.into_any())),
        Some(Body::Box(length_m, width_m)) => Ok(Some((*length_m, *width_m).into_pyobject(py)?.into_any())),
        Some(Body::Polygon(polygon)) => {
            let corners: Vec<(f64, f64)> = polygon.corners().iter().map(|corner| (corner.x, corner.y)).collect();
            Ok(Some(corners.into_pyobject(py)?.into_any()))
        }
    }
}
