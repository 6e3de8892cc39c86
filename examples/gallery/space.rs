//! Views of space from far away.

use plotters::style::RGBColor;

use crate::draw::{GREY, Panel, Point};

/// A point in space.
pub(crate) type Place = [f64; 3];

/// Where the eye is, z upwards.
#[derive(Clone, Copy)]
pub(crate) struct View {
    /// From x towards y in rad.
    pub(crate) azimuth: f64,
    /// Above the plane of x and y in rad.
    pub(crate) elevation: f64,
}

impl View {
    /// From a direction, in degrees.
    pub(crate) fn from(azimuth: f64, elevation: f64) -> Self {
        Self {
            azimuth: azimuth.to_radians(),
            elevation: elevation.to_radians(),
        }
    }

    /// To the right and upwards as the eye sees it.
    pub(crate) fn seen(self, [x, y, z]: Place) -> Point {
        let (sine, cosine) = self.azimuth.sin_cos();
        let (up, level) = self.elevation.sin_cos();
        (
            y * cosine - x * sine,
            z * level - up * (x * cosine + y * sine),
        )
    }

    /// Several points.
    pub(crate) fn path(self, places: &[Place]) -> Vec<Point> {
        places.iter().map(|place| self.seen(*place)).collect()
    }

    /// How far a point is towards the eye.
    pub(crate) fn depth(self, [x, y, z]: Place) -> f64 {
        let (sine, cosine) = self.azimuth.sin_cos();
        let (up, level) = self.elevation.sin_cos();
        level * (x * cosine + y * sine) + up * z
    }
}

/// A circle around z of a unit sphere, or with `upright` the meridian at an angle.
fn circle(angle: f64, upright: bool) -> Vec<Place> {
    (0..=90)
        .map(|k| {
            let (sine, cosine) = (f64::from(k) * 4.0).to_radians().sin_cos();
            let (high, wide) = angle.sin_cos();
            if upright {
                [wide * cosine, high * cosine, sine]
            } else {
                [wide * cosine, wide * sine, high]
            }
        })
        .collect()
}

/// Draws the unit sphere with a net of 30 degrees.
pub(crate) fn sphere(mut panel: Panel, view: View) -> Panel {
    for step in -2..=2 {
        panel = on_sphere(
            panel,
            view,
            GREY,
            1,
            0.35,
            &circle(f64::from(step) * 30_f64.to_radians(), false),
        );
    }
    for step in 0..6 {
        panel = on_sphere(
            panel,
            view,
            GREY,
            1,
            0.35,
            &circle(f64::from(step) * 30_f64.to_radians(), true),
        );
    }
    let outline = (0..=120).map(|k| {
        let (sine, cosine) = (f64::from(k) * 3.0).to_radians().sin_cos();
        (cosine, sine)
    });
    panel.stroke(GREY, 0.8, 1, outline.collect())
}

/// Draws a path on the unit sphere; what is behind is faint.
pub(crate) fn on_sphere(
    mut panel: Panel,
    view: View,
    color: RGBColor,
    width: u32,
    opacity: f64,
    places: &[Place],
) -> Panel {
    let front = |place: &Place| view.depth(*place) >= 0.0;
    let mut start = 0;
    for end in 1..=places.len() {
        let turns = end == places.len() || front(&places[end]) != front(&places[start]);
        if turns {
            // Up to the first point beyond the edge, so that no gap is left.
            let part = &places[start..places.len().min(end + 1)];
            let seen = if front(&places[start]) { 1.0 } else { 0.3 };
            panel = panel.stroke(color, opacity * seen, width, view.path(part));
            start = end;
        }
    }
    panel
}
