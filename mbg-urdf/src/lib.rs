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
//!   that it is one; where the next joint is not aligned with it either, it is turned so that a single rotation leads there,
//!   as in the frames of Denavit and Hartenberg (1955). Positions and orientations are those of the file's links all the same.
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
//! - With `--stops`, `lower` and `upper` of a `limit` become a `Stop` at the rate of the joint. The component has parameters for
//!   its `stop_stiffness` and `stop_dissipation`, on slides `slide_stop_stiffness` and `slide_stop_dissipation`, whose defaults
//!   know nothing of the robot. What a `limit` says of efforts and velocities is left out, and all of it without the option.
//! - An `origin` may have a `quat_xyzw` instead of `rpy`.
//! - Visual and collision geometry is left out. Every other tag that is not converted is named with its line, and so is what else
//!   the tags of poses, inertias and joints tell. A file for `xacro` is refused, since links may be missing in it.
//!
//! # Links, forces and Jacobians
//!
//! `robot.hand_position` and `robot.hand_orientation` tell where the link `hand` is, whatever joint it hangs on. A junction
//! `robot.hand` is the frame of a printed body, which may lie elsewhere along its axis. `--frame hand` adds a junction
//! `robot.hand_frame` at the place of the link: forces, contacts, sensors and further joints are put there, as
//! `push: Load { axes: world, force: push } (robot.hand_frame);`, and its flow is the link's angular velocity and velocity in axes
//! of the link. What is put inside of a robot stands behind it in the model.
//!
//! With `output place[3] = robot.hand_position;` and `output twist[6] = robot.hand_frame.f;` rows of `Linearised::output` are
//! Jacobians of the frame: of the place by angles, of the twist by rates. `jacobian_input` has the inverse of the inertia matrix
//! in its rows of rates, so that the torques for an acceleration are the inverse of that times the acceleration less that of
//! `derivative` without torques; `Trim` with the angles fixed gives those that hold against gravity. An angle that nothing
//! reads is no state: the output of `coordinates` keeps all.
//!
//! Rotors behind a gear, elastic drives and stops stand at the `rate` of a joint:
//!
//! ```text
//! robot.elbow.rate -> TF gear { flow: 100.0 } -> rotor;
//! rotor -> I inertia { inertia: 2e-5 };
//! stop: Stop { displacement: robot.elbow.angle, lower: -2.0, upper: 2.0, stiffness: 1e4 } (robot.elbow.rate);
//! ```
//!
//! A foot on the ground is `sole: Contact { stiffness: 1e5, dissipation: 0.5, friction: 0.8 } (robot.foot_frame);`.
//!
//! A base that flies hangs on a `Free`, `float: Free { orientation: quaternion } (world, base);` with
//! `Sf held[6] { flow: 0.0 } -> world;`. Gains for all joints at once are `diag(…)` where some of them slide.

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
    /// Links whose frames are junctions `LINK_frame`, with the place and the axes that the file gives them.
    pub frames: &'a [&'a str],
    /// Whether `lower` and `upper` of the limits of joints become stops.
    pub stops: bool,
}

impl Default for Options<'_> {
    /// No model, 1e-9 rad, no frames and no stops.
    fn default() -> Self {
        Self {
            model: None,
            right_angles: geometry::RIGHT,
            frames: &[],
            stops: false,
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
/// The first line that cannot be converted: no XML, no tree of links, a number that is none, a joint of no known type; a link of
/// [`Options::frames`] that the robot has not.
pub fn convert(text: &str, source: &str, options: &Options<'_>) -> Result<Conversion, Remark> {
    let (robot, remarks) = robot::read(text, (options.right_angles, options.stops))?;
    Ok(Conversion {
        text: print::print(&robot, source, options)?,
        remarks,
    })
}
