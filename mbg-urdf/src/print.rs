//! A robot as text in the language.

use crate::assembly::{Assembly, Seat};
use crate::geometry::{
    Body, IDENTITY, Matrix, Pose, Vector, about, is_near, is_permutation, squares,
};
use crate::names::{Names, component};
use crate::robot::{Joint, Motion, Robot, shown};
use crate::{Options, Remark};

/// A frame.
#[derive(Clone)]
struct Frame {
    /// The 1-junction of its flow.
    junction: String,
    /// What leads to it; nothing to the base.
    joint: Option<String>,
}

impl Frame {
    /// What holds in the frame, such as its `position` in the world.
    fn told(&self, quantity: &str) -> String {
        match &self.joint {
            Some(joint) => format!("{joint}.{quantity}_b"),
            None => format!("{quantity}_base"),
        }
    }

    /// An argument for what holds in the frame at a port: only what holds at the base is not handed on by itself.
    fn given(&self, quantity: &str, port: &str) -> String {
        match &self.joint {
            Some(_) => String::new(),
            None => format!(", {quantity}_{port}: {}", self.told(quantity)),
        }
    }

    /// Arguments for all that holds in the frame at port `a`.
    fn all_given(&self) -> String {
        ["gravity", "orientation", "position"]
            .map(|it| self.given(it, "a"))
            .concat()
    }
}

/// What has been printed, and what later text needs of it.
struct Printer<'a> {
    robot: &'a Robot,
    names: Names,
    /// The joints that have numbers: those that are degrees of freedom.
    free: Vec<&'a str>,
    /// The joints of one coordinate, with their names in the language.
    single: Vec<(&'a Joint, String)>,
    assembly: Assembly<'a>,
    /// The frames of rigid bodies, as far as joints have been printed.
    frames: Vec<Frame>,
    /// How joints of several coordinates start.
    parameters: String,
    text: String,
}

/// The component, and a model of it with its base at rest where that is given a name.
pub(crate) fn print(robot: &Robot, source: &str, options: &Options<'_>) -> Result<String, Remark> {
    let free = robot.joints.iter().filter(|it| it.is_free());
    let mut names = Names::new();
    if options.stops {
        for (_, prefix, ..) in STOPS {
            for ending in ["stiffness", "dissipation"] {
                names.take(&format!("{prefix}_{ending}"));
            }
        }
    }
    let mut printer = Printer {
        robot,
        names,
        free: free.map(|it| it.name.as_str()).collect(),
        single: Vec::new(),
        parameters: String::new(),
        assembly: Assembly::new(robot),
        frames: vec![Frame {
            junction: "base".to_owned(),
            joint: None,
        }],
        text: String::new(),
    };
    for seat in 0..printer.assembly.seats.len() {
        printer.joint(seat);
    }
    printer.mimics();
    printer.bodies();
    for link in options.frames {
        printer.frame(link)?;
    }
    printer.poses();
    let name = component(&robot.name);
    let mut text = head(robot, &shown(source), &name, &printer.free);
    text += &printer.parameters;
    text += &printer.text;
    text += "}\n";
    if let Some(model) = options.model {
        text += &at_rest(&robot.name, &name, model, printer.free.len());
    }
    Ok(text)
}

/// What stands before the joints.
fn head(robot: &Robot, source: &str, name: &str, joints: &[&str]) -> String {
    let root = &robot.links[robot.root].name;
    let mut text = format!(
        "/// The robot `{}`, printed by `mbg-urdf` from `{source}`.\n///\n/// `base` is the frame of the link `{root}`.\n",
        robot.name
    );
    if !joints.is_empty() {
        text += "///\n/// Joints in order:\n";
        for (number, joint) in joints.iter().enumerate() {
            text += &format!("/// {number}. `{joint}`\n");
        }
    }
    text += &mimics(robot);
    text += &format!("#[derivative]\ncomponent {name}(port base[6]) {{\n");
    let count = joints.len();
    if count > 0 {
        text += &format!(
            "    /// Torques and forces that drive the joints.\n    param effort[{count}] = 0.0;\n    \
             /// Angles and travels of the joints at the start.\n    param initial[{count}] = 0.0;\n    \
             /// Their rates at the start.\n    param initial_rate[{count}] = 0.0;\n"
        );
    }
    for (motion, slip, unit, joints) in SLIPS {
        let rubs = |it: &Joint| it.motion == *motion && has_friction(it);
        if robot.joints.iter().any(rubs) {
            text += &format!(
                "    /// The rate at which dry friction of {joints} has three quarters of its value.\n    param {slip}: {unit} = 1e-3;\n"
            );
        }
    }
    for (motion, prefix, joints, [_, stiffness, dissipation]) in STOPS {
        let stops = |it: &Joint| it.motion == *motion && it.limit.is_some();
        if robot.joints.iter().any(stops) {
            text += &format!(
                "    /// Of the stops of {joints}, as of `Stop`.\n    param {prefix}_stiffness: {stiffness};\n    \
                 param {prefix}_dissipation: {dissipation} = 1.0;\n"
            );
        }
    }
    text += "    /// The acceleration of free fall in axes of the base.\n    param gravity_base[3]: m/s^2 = gravity;\n    \
             /// From axes of the base to those of the world.\n    param orientation_base = 1.0;\n    \
             /// Of the base in the world.\n    param position_base[3]: m = 0.0;\n";
    text
}

/// What the documentation says about joints that mimic others.
fn mimics(robot: &Robot) -> String {
    let line = |joint: &Joint| {
        let mimic = joint.mimic.as_ref()?;
        let (leader, times, offset) = (&mimic.leader, mimic.multiplier, added(mimic.offset));
        let name = &joint.name;
        Some(format!("/// - `{name}` = {times:?} `{leader}`{offset}\n"))
    };
    let lines: String = robot.joints.iter().filter_map(line).collect();
    match lines.as_str() {
        "" => lines,
        _ => format!("///\n/// Joints that mimic others:\n{lines}"),
    }
}

/// A term of a sum, nothing where it is zero.
fn added(term: f64) -> String {
    match term {
        0.0 => String::new(),
        _ if term < 0.0 => format!(" - {:?}", -term),
        _ => format!(" + {term:?}"),
    }
}

/// A model in which the base does not move.
fn at_rest(robot: &str, component: &str, model: &str, count: usize) -> String {
    let mut text = format!(
        "\n/// The robot `{robot}` with its base at rest.\npub model {model} {{\n    causality componentwise;\n    \
         gravity [0.0, 0.0, -9.81];\n"
    );
    if count > 0 {
        text += &format!("    input effort[{count}];\n");
    }
    text += "    1 base[6];\n    Sf ground[6] { flow: 0.0 } -> base;\n";
    let arguments = if count > 0 { " { effort: effort }" } else { "" };
    text += &format!("    robot: {component}{arguments} (base);\n");
    if count > 0 {
        text += &format!("    output coordinates[{count}] = robot.coordinates;\n");
    }
    text + "}\n"
}

impl<'a> Printer<'a> {
    fn joint(&mut self, seat: usize) {
        let Seat {
            joint,
            above,
            pose,
            axis,
            zero,
        } = self.assembly.seats[seat];
        let name = self.names.take(&joint.name);
        let [from, to] = [joint.parent, joint.child].map(|link| &self.robot.links[link].name);
        self.text += &format!("\n    // {}: from {from} to {to}.\n", joint.name);
        let foot = self.moved(&name, above, &pose);
        let junction = self.names.take(to);
        self.text += &format!("    1 {junction}[6];\n");
        match joint.motion {
            Motion::Float | Motion::Plane => self.several(joint, &name, (&foot, &junction), axis),
            _ => self.single(joint, &name, (&foot, &junction), (axis, zero)),
        }
        if has_friction(joint) {
            let friction = self.names.take(&format!("{name}_friction"));
            self.text += &format!(
                "    {name}.rate -> R {friction} {{ effort: {:?} * tanh(f / {}) }};\n",
                joint.friction,
                slip(joint.motion)
            );
        }
        self.stop(joint, &name);
        if joint.motion.is_single() {
            self.single.push((joint, name.clone()));
        }
        self.frames.push(Frame {
            junction,
            joint: Some(name),
        });
    }

    /// The stop of a joint that has limits, and has not been fixed.
    fn stop(&mut self, joint: &Joint, name: &str) {
        let own = STOPS.iter().find(|(of, ..)| *of == joint.motion);
        if let (Some([lower, upper]), Some((_, prefix, _, [coordinate, ..]))) = (joint.limit, own) {
            let stop = self.names.take(&format!("{name}_stop"));
            self.text += &format!(
                "    {stop}: Stop {{\n        displacement: {name}.{coordinate}, lower: {lower:?}, upper: {upper:?},\n        \
                 stiffness: {prefix}_stiffness, dissipation: {prefix}_dissipation\n    }} ({name}.rate);\n"
            );
        }
    }

    /// The frame of a rigid body moved to a pose in it, before the joint `name`.
    fn moved(&mut self, name: &str, rigid: usize, pose: &Pose) -> Frame {
        let mut frame = self.frames[rigid].clone();
        if pose.place != [0.0; 3] {
            let by = column(&pose.place);
            frame = self.step(
                &frame,
                "Offset",
                &by,
                [&format!("{name}_place"), &format!("{name}_foot")],
            );
        }
        if pose.turn != IDENTITY {
            let by = rotation(&pose.turn);
            frame = self.step(
                &frame,
                "Turn",
                &by,
                [&format!("{name}_axes"), &format!("{name}_seat")],
            );
        }
        frame
    }

    /// A part of the library from a frame to another one of the same body.
    fn step(&mut self, from: &Frame, kind: &str, by: &str, names: [&str; 2]) -> Frame {
        let [step, junction] = names.map(|it| self.names.take(it));
        self.text += &format!(
            "    1 {junction}[6];\n    {step}: {kind} {{ by: {by}{} }} ({}, {junction});\n",
            from.all_given(),
            from.junction
        );
        Frame {
            junction,
            joint: Some(step),
        }
    }

    /// A joint of one coordinate.
    fn single(
        &mut self,
        joint: &Joint,
        name: &str,
        (foot, junction): (&Frame, &str),
        (axis, zero): (usize, f64),
    ) {
        let (kind, effort) = match joint.motion {
            Motion::Slide => ("Prismatic", "force"),
            _ => ("Revolute", "torque"),
        };
        self.text += &format!(
            "    {name}: {kind} {{ axis: {axis}, {}{}{}{} }} ({}, {junction});\n",
            self.start(joint, effort),
            begin(zero),
            damping(joint),
            foot.all_given(),
            foot.junction
        );
    }

    /// A joint of several coordinates, with parameters of its own for how it starts.
    fn several(
        &mut self,
        joint: &Joint,
        name: &str,
        (foot, junction): (&Frame, &str),
        axis: usize,
    ) {
        let (kind, choice, starts) = match joint.motion {
            Motion::Float => ("Free", "orientation: quaternion".to_owned(), FLOATING),
            _ => ("Planar", format!("axis: {axis}"), PLANAR),
        };
        self.text += &format!("    {name}: {kind} {{\n        {choice}");
        for (argument, ending, size, meaning) in starts {
            let parameter = self.names.take(&format!("{name}_{ending}"));
            self.text += &format!(",\n        {argument}: {parameter}");
            self.parameters += &format!(
                "    /// {meaning}, of `{}` at the start.\n    param {parameter}{size} = 0.0;\n",
                joint.name
            );
        }
        self.text += &format!(
            "{}\n    }} ({}, {junction});\n",
            foot.all_given(),
            foot.junction
        );
    }

    /// How a joint starts and what drives it. One that mimics another starts as that does, whichever rate is the state.
    fn start(&self, joint: &Joint, effort: &str) -> String {
        let number = |name: &str| self.free.iter().position(|it| *it == name).unwrap_or(0);
        match &joint.mimic {
            None => {
                let number = number(&joint.name);
                format!(
                    "initial: initial[{number}], initial_rate: initial_rate[{number}], {effort}: effort[{number}]"
                )
            }
            Some(mimic) => {
                let (number, times) = (number(&mimic.leader), mimic.multiplier);
                let offset = added(mimic.offset);
                format!(
                    "initial: {times:?} * initial[{number}]{offset}, initial_rate: {times:?} * initial_rate[{number}]"
                )
            }
        }
    }

    /// The joints whose rates are those of others.
    fn mimics(&mut self) {
        if self.single.iter().all(|(joint, _)| joint.is_free()) {
            return;
        }
        self.text += "\n    // Joints that mimic others.\n";
        for (joint, name) in &self.single {
            let Some(mimic) = &joint.mimic else { continue };
            let mut leaders = self.single.iter().filter(|(it, _)| it.name == mimic.leader);
            let Some((_, leader)) = leaders.next() else {
                continue;
            };
            let mimicry = self.names.take(&format!("{name}_mimic"));
            self.text += &format!(
                "    {leader}.rate -> TF {mimicry} {{ flow: {:?} }} -> {name}.rate;\n",
                mimic.multiplier
            );
        }
    }

    fn bodies(&mut self) {
        self.text += "\n    // Links that fixed joints hold together are one body.\n";
        for number in 0..self.frames.len() {
            let Some(body) = self.assembly.bodies[number] else {
                continue;
            };
            match squares(&body.inertia) {
                Some(parts) if body.mass == 0.0 || parts.len() < 3 => {
                    self.point_mass(number, &body);
                    self.inertia(number, &body.inertia, &parts);
                }
                _ => self.body(number, &body),
            }
        }
    }

    fn body(&mut self, rigid: usize, body: &Body) {
        let frame = &self.frames[rigid];
        let name = self.names.take(&format!("{}_body", frame.junction));
        self.text += &format!(
            "    {name}: Body {{\n        mass: {:?},\n        centre: {},\n        inertia: {}{}\n    }} ({});\n",
            body.mass,
            column(&body.centre),
            matrix(&body.inertia),
            frame.given("gravity", "at"),
            frame.junction
        );
    }

    /// The mass of a body at its centre, where there is any.
    fn point_mass(&mut self, rigid: usize, body: &Body) {
        if body.mass == 0.0 {
            return;
        }
        let mut frame = self.frames[rigid].clone();
        let [arm, centre, mass] =
            ["arm", "centre", "mass"].map(|ending| format!("{}_{ending}", frame.junction));
        if body.centre != [0.0; 3] {
            frame = self.step(&frame, "Offset", &column(&body.centre), [&arm, &centre]);
        }
        let mass = self.names.take(&mass);
        self.text += &format!(
            "    {mass}: PointMass {{ mass: {:?}{} }} ({});\n",
            body.mass,
            frame.given("gravity", "at"),
            frame.junction
        );
    }

    /// An inertia beside a point mass or alone.
    fn inertia(&mut self, rigid: usize, inertia: &Matrix, parts: &[(f64, Vector)]) {
        let junction = self.frames[rigid].junction.clone();
        match parts.len() {
            0 => {}
            3 => {
                let spin = self.names.take(&format!("{junction}_spin"));
                let inertia = matrix(inertia);
                self.text += &format!(
                    "    {junction}[0..3] -> I {spin} {{ inertia: {inertia}, gyroscopic }};\n"
                );
            }
            _ => self.singular(&junction, parts),
        }
    }

    /// A singular inertia `Σ d l lᵀ`, as that of a thin rod: it has the momentum `Σ l p` with `p = d lᵀ ω`.
    ///
    /// Each `p` is in two equal parts, so that no storage by itself can hold the state: that stays with the rates of the
    /// joints, whose initial values the component is given.
    fn singular(&mut self, junction: &str, parts: &[(f64, Vector)]) {
        let halves = || parts.iter().flat_map(|it| [it, it]);
        let weights: Vec<String> = halves().map(|(d, _)| format!("{:?}", d / 2.0)).collect();
        let directions: Vec<String> = halves().map(|(_, l)| column(l)).collect();
        let (weights, directions) = (weights.join(", "), directions.join(", "));
        let count = 2 * parts.len();
        let [felt, along, spin, whirl, axes] = ["felt", "along", "spin", "whirl", "axes"]
            .map(|it| self.names.take(&format!("{junction}_{it}")));
        self.text += &format!(
            "    let {axes} = [{directions}];\n    \
             1 {felt}[{count}];\n    \
             {junction}[0..3] -> TF {along} {{ flow: {axes} }} -> {felt};\n    \
             {felt} -> I {spin} {{ inertia: diag({weights}) }};\n    \
             {junction}[0..3] -> EJS {whirl} {{ momentum: transpose({axes}) * {spin}.p }};\n"
        );
    }

    /// A junction at the place of a link, with its axes.
    fn frame(&mut self, link: &str) -> Result<(), Remark> {
        let parts = self.robot.links.iter().zip(&self.assembly.parts);
        let found = parts.filter(|(it, _)| it.name == link);
        let Some(part) = found.filter_map(|(_, part)| part.as_ref()).next() else {
            return Err(Remark {
                line: 1,
                text: format!("there is no link `{link}`, of which a frame was asked for"),
            });
        };
        let (frame, pose) = (&self.frames[part.rigid], &part.pose);
        let [junction, mount] =
            ["frame", "frame_mount"].map(|it| self.names.take(&format!("{link}_{it}")));
        let mut arguments = Vec::new();
        if pose.place != [0.0; 3] {
            arguments.push(format!("offset: {}", column(&pose.place)));
        }
        if pose.turn != IDENTITY {
            arguments.push(format!("tilt: {}", rotation(&pose.turn)));
        }
        arguments.extend(frame.all_given().strip_prefix(", ").map(str::to_owned));
        self.text += &format!(
            "\n    // The frame of {link}.\n    1 {junction}[6];\n    {mount}: Mount {{ {} }} ({}, {junction});\n",
            arguments.join(", "),
            frame.junction
        );
        Ok(())
    }

    /// Where each link is, and the motion of the joints.
    fn poses(&mut self) {
        self.text += "\n    // Where the links are in the world, and how their axes lie.\n";
        for (link, part) in self.robot.links.iter().zip(&self.assembly.parts) {
            let Some(part) = part else { continue };
            let frame = &self.frames[part.rigid];
            let (mut position, mut orientation) =
                (frame.told("position"), frame.told("orientation"));
            if part.pose.place != [0.0; 3] {
                position += &format!(" + {orientation} * {}", column(&part.pose.place));
            }
            if part.pose.turn != IDENTITY {
                orientation += &format!(" * {}", rotation(&part.pose.turn));
            }
            let [at, axes] = ["position", "orientation"]
                .map(|it| self.names.take(&format!("{}_{it}", link.name)));
            self.text +=
                &format!("    let {at}[3] = {position};\n    let {axes} = {orientation};\n");
        }
        let free = || self.single.iter().filter(|(joint, _)| joint.is_free());
        let coordinate = |(joint, name): &(&Joint, String)| match joint.motion {
            Motion::Slide => format!("{name}.travel"),
            _ => format!("{name}.angle"),
        };
        let coordinates: Vec<String> = free().map(coordinate).collect();
        let rates: Vec<String> = free().map(|(_, name)| format!("{name}.rate.f")).collect();
        let count = coordinates.len();
        if count > 0 {
            self.text += "\n    // Angles and travels of the joints, and how fast they change.\n";
            let (coordinates, rates) = (coordinates.join(", "), rates.join(", "));
            self.text += &format!(
                "    let coordinates[{count}] = [{coordinates}];\n    let rates[{count}] = [{rates}];\n"
            );
        }
    }
}

/// How a joint starts: the parameter of the library, the ending of the component's, its size and unit, what it is.
type Start = (&'static str, &'static str, &'static str, &'static str);

const FLOATING: &[Start] = &[
    (
        "initial",
        "initial_angles",
        "[3]: rad",
        "Angles about x, then y, then z",
    ),
    (
        "initial_rate",
        "initial_turning",
        "[3]: rad/s",
        "Angular velocity in axes of its link",
    ),
    ("initial_position", "initial_position", "[3]: m", "Position"),
    (
        "initial_velocity",
        "initial_velocity",
        "[3]: m/s",
        "Rate of the position",
    ),
];

const PLANAR: &[Start] = &[
    ("initial_angle", "initial_angle", ": rad", "Angle"),
    (
        "initial_turning",
        "initial_turning",
        ": rad/s",
        "Rate of the angle",
    ),
    ("initial_travel", "initial_travel", "[2]: m", "Travels"),
    (
        "initial_sliding",
        "initial_sliding",
        "[2]: m/s",
        "Rates of the travels",
    ),
];

/// The parameters of dry friction, of one unit each.
const SLIPS: &[(Motion, &str, &str, &str)] = &[
    (Motion::Turn, "slip", "rad/s", "hinges"),
    (Motion::Slide, "slide_slip", "m/s", "slides"),
];

fn slip(motion: Motion) -> &'static str {
    let own = SLIPS.iter().find(|(of, ..)| *of == motion);
    own.map_or("slip", |(_, slip, ..)| slip)
}

/// The parameters of stops: what begins their names, what has them, the coordinate, and the unit and the default of the stiffness.
const STOPS: &[(Motion, &str, &str, [&str; 3])] = &[
    (
        Motion::Turn,
        "stop",
        "hinges",
        ["angle", "N*m/rad = 1e3", "s/rad"],
    ),
    (
        Motion::Slide,
        "slide_stop",
        "slides",
        ["travel", "N/m = 1e5", "s/m"],
    ),
];

fn has_friction(joint: &Joint) -> bool {
    joint.friction != 0.0 && joint.motion.is_single()
}

/// The argument for it, if there is any.
fn damping(joint: &Joint) -> String {
    match joint.damping {
        0.0 => String::new(),
        damping => format!(", damping: {damping:?}"),
    }
}

/// The argument for the angle at which the frames of a hinge coincide, if that is not zero.
fn begin(zero: f64) -> String {
    match zero {
        0.0 => String::new(),
        zero => format!(", zero: {zero:?}"),
    }
}

/// A column, each number with the digits that it needs.
fn column(vector: &Vector) -> String {
    let [x, y, z] = vector.map(|it| it + 0.0);
    format!("[{x:?}, {y:?}, {z:?}]")
}

/// A matrix by rows, or by its diagonal where that is all of it.
fn matrix(matrix: &Matrix) -> String {
    let off = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];
    if off.iter().all(|(i, j)| matrix[*i][*j] == 0.0) {
        let [x, y, z] = [0, 1, 2].map(|i| matrix[i][i]);
        return format!("diag({x:?}, {y:?}, {z:?})");
    }
    let rows: Vec<String> = matrix.iter().map(column).collect();
    format!("[{}]", rows.join(", "))
}

/// A rotation by its angle where it is about a coordinate axis, else by its matrix.
fn rotation(turn: &Matrix) -> String {
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let [p, q] = [1, 2].map(|it| (axis + it) % 3);
        let angle = turn[q][p].atan2(turn[p][p]);
        if !is_permutation(turn) && is_near(turn, &about(axis, angle)) {
            return format!("rot_{letter}({angle:?})");
        }
    }
    matrix(turn)
}
