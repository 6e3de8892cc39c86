//! Prints a robot's URDF file as a component in the language of `mbg!`, which a model includes.
//!
//! ```text
//! mbg-urdf robots/arm.urdf > robots/arm.mbg
//! ```
//! ```text
//! mbg! {
//!     include "robots/arm.mbg";
//!     pub model Bench {
//!         causality componentwise;
//!         gravity [0.0, 0.0, -9.81];
//!         input torque[7];
//!         1 base[6];
//!         Sf ground[6] { flow: 0.0 } -> base;
//!         arm: Arm { effort: torque } (base);
//!         output angles[7] = arm.coordinates;
//!     }
//! }
//! ```
//!
//! - Joints: `fixed`, `revolute`, `continuous`, `prismatic`, `planar` and `floating`, about any axis. Links that fixed
//!   joints hold together become one body. Where an axis is no coordinate axis, the printed frame of the link is turned so
//!   that it is one; where the next joint is neither aligned, so that one turn leads there, as in the frames of Denavit and
//!   Hartenberg (1955). Positions and orientations are those of the file's links all the same.
//! - Planar and floating joints are none of the numbered joints: each has parameters of its own for its start, such as
//!   `table_initial_travel`.
//! - A joint that mimics another one has the rate of that, by a transformer, and is none of the numbered joints; the angle
//!   of `finger` is `robot.finger.angle`. It is held where the other one does not move.
//! - A link without a mass keeps its inertia, as rotors are given; masses without an extent and rods without a width are
//!   bodies, too.
//! - Damping becomes that of the joint, dry friction a resistor `friction tanh(rate / slip)` beside it,
//!   with `slide_slip` on slides.
//! - Angles within 1e-9 rad of a multiple of a right angle are taken for it, or within as much as [`Options`] say; lengths
//!   below 1e-12 m and inertias that the mass would have 1e-8 m beside its centre for zero: what is zero costs nothing.
//! - What shows or collides is left out. Every other tag without an equation is named with its line.

mod assembly;
mod geometry;
mod names;
mod print;
mod robot;

pub use robot::Remark;

/// What a file was printed as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conversion {
    /// In the language.
    pub text: String,
    /// What of the file is not in it, in order of lines.
    pub remarks: Vec<Remark>,
}

/// How a file is printed.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// A model of this name follows the component, in which the base is at rest.
    pub model: Option<&'a str>,
    /// Angles this near to a multiple of a right angle, in rad, are taken for it: where a file says 1.5708, 1e-5 leaves
    /// fewer operations.
    pub right_angles: f64,
}

impl Default for Options<'_> {
    /// No model, and 1e-9 rad.
    fn default() -> Self {
        Self {
            model: None,
            right_angles: geometry::RIGHT,
        }
    }
}

/// Prints the text of a URDF file as a component that is named after the robot; `source` says in its documentation where
/// it is from.
///
/// ```
/// let text = r#"
///     <robot name="door">
///       <link name="frame"/>
///       <link name="leaf">
///         <inertial>
///           <origin xyz="0.4 0 0"/> <mass value="20"/> <inertia ixx="7" iyy="8" izz="1"/>
///         </inertial>
///       </link>
///       <joint name="hinge" type="continuous">
///         <parent link="frame"/> <child link="leaf"/> <axis xyz="0 0 1"/>
///       </joint>
///     </robot>"#;
/// let found = mbg_urdf::convert(text, "door.urdf", &Default::default()).unwrap();
/// assert!(found.text.contains("hinge: Revolute {"));
/// assert_eq!(found.remarks, []);
/// ```
///
/// # Errors
///
/// The first line that cannot be converted: no XML, no tree of links, a number that is none, a joint of no known type.
pub fn convert(text: &str, source: &str, options: &Options<'_>) -> Result<Conversion, Remark> {
    let (robot, remarks) = robot::read(text, options.right_angles)?;
    Ok(Conversion {
        text: print::print(&robot, source, options.model),
        remarks,
    })
}
