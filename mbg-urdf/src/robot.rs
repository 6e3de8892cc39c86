//! A robot as a URDF file gives it, checked to be a tree.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt;

use roxmltree::{Document, Error, Node, ParsingOptions};

use crate::geometry::{Body, Matrix, Pose, RIGHT, Vector, angles, measurable, rotation, squares};

/// Something about a line of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// The line, from one.
    pub line: u32,
    /// What is wrong there, or not converted.
    pub text: String,
}

impl fmt::Display for Remark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.line, self.text)
    }
}

impl std::error::Error for Remark {}

/// What a joint lets its links do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Fixed,
    Turn,
    Slide,
    Float,
    /// Along two axes, and about the third.
    Plane,
}

impl Motion {
    /// Whether it has one coordinate, which has a number or follows that of another joint.
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Self::Turn | Self::Slide)
    }

    fn is_several(self) -> bool {
        matches!(self, Self::Float | Self::Plane)
    }
}

pub(crate) struct Link {
    pub(crate) name: String,
    /// In its own frame; nothing without mass and inertia.
    pub(crate) body: Option<Body>,
}

/// A coordinate that follows that of another joint: it is `multiplier × other + offset`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mimic {
    /// The other joint, which moves and mimics none.
    pub(crate) leader: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

impl Mimic {
    /// Where the leader mimics, too: the same of its leader.
    fn through(&self, leader: &Self) -> Self {
        Self {
            leader: leader.leader.clone(),
            multiplier: self.multiplier * leader.multiplier,
            offset: self.multiplier * leader.offset + self.offset,
        }
    }
}

pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) motion: Motion,
    /// Links by number.
    pub(crate) parent: usize,
    pub(crate) child: usize,
    /// The frame of the joint, which is the child's when it has not moved, in that of the parent.
    pub(crate) origin: Pose,
    /// In axes of the joint.
    pub(crate) axis: Vector,
    pub(crate) mimic: Option<Mimic>,
    pub(crate) damping: f64,
    /// Dry friction.
    pub(crate) friction: f64,
    /// The lower and the upper end of its one coordinate, where stops are wanted.
    pub(crate) limit: Option<[f64; 2]>,
    pub(crate) line: u32,
}

impl Joint {
    /// Whether its one coordinate is a degree of freedom.
    pub(crate) fn is_free(&self) -> bool {
        self.motion.is_single() && self.mimic.is_none()
    }

    /// Makes it a fixed joint that stays where it is at a coordinate.
    fn fix(&mut self, coordinate: f64) {
        let moved = match self.motion {
            Motion::Turn => Pose::turned(&self.axis, coordinate),
            Motion::Slide => Pose::moved(&self.axis, coordinate),
            _ => Pose::NONE,
        };
        self.origin = self.origin.of(&moved);
        self.motion = Motion::Fixed;
        self.mimic = None;
    }

    /// Whether it mimics the joint of this name.
    fn follows(&self, leader: &str) -> bool {
        let mimic = self.mimic.as_ref();
        mimic.is_some_and(|it| it.leader == leader)
    }
}

pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    /// In the order of a walk from the root: a joint comes after the one that holds its parent.
    pub(crate) joints: Vec<Joint>,
    pub(crate) root: usize,
}

/// What a joint moves.
#[derive(Clone, Copy)]
struct Load {
    mass: bool,
    inertia: bool,
}

impl Load {
    fn of(link: &Link) -> Self {
        let body = link.body.as_ref();
        Self {
            mass: body.is_some_and(|it| it.mass != 0.0),
            inertia: body.is_some_and(|it| it.inertia != [[0.0; 3]; 3]),
        }
    }
}

type Checked<T> = Result<T, Remark>;

/// What is converted of tags of which the rest would be missed.
const ATTRIBUTES: &[(&str, &[&str])] = &[
    ("origin", &["xyz", "rpy", "quat_xyzw"]),
    ("mass", &["value"]),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]),
    ("axis", &["xyz"]),
    ("dynamics", &["damping", "friction"]),
    ("mimic", &["joint", "multiplier", "offset"]),
];

/// A file that is still to be expanded may lack links without a word.
const UNEXPANDED: &str =
    "this is for xacro, which prints the URDF file to convert: `xacro FILE > robot.urdf`";

/// Of an attribute that is something else.
fn unread(name: &str, wanted: &str, text: &str) -> String {
    match text.contains("${") {
        true => UNEXPANDED.to_owned(),
        false => format!("`{name}` is {wanted}, found `{text}`"),
    }
}

/// Reads a file, and lists what of it means nothing to the equations of motion.
pub(crate) fn read(
    text: &str,
    (right_angles, stops): (f64, bool),
) -> Checked<(Robot, Vec<Remark>)> {
    // A line `<!DOCTYPE robot>` says nothing more, and is no mistake.
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).map_err(|error| Remark {
        line: error.pos().row,
        text: match &error {
            Error::UnknownNamespace(prefix, _) if prefix == "xacro" => UNEXPANDED.to_owned(),
            _ => format!("this is no XML: {error}"),
        },
    })?;
    let mut reader = Reader {
        document: &document,
        right_angles,
        stops,
        remarks: Vec::new(),
    };
    let is_for_xacro = |it: &Node<'_, '_>| {
        let namespace = it.tag_name().namespace();
        namespace.is_some_and(|it| it.ends_with("xacro"))
    };
    if let Some(node) = document.descendants().find(is_for_xacro) {
        return reader.fail(node, UNEXPANDED);
    }
    let robot = reader.robot(document.root_element())?;
    reader.remarks.sort_by_key(|remark| remark.line);
    Ok((robot, reader.remarks))
}

struct Reader<'a> {
    document: &'a Document<'a>,
    /// How near to a multiple of a right angle an angle is taken for it.
    right_angles: f64,
    /// Whether limits of joints are stops.
    stops: bool,
    remarks: Vec<Remark>,
}

impl<'a> Reader<'a> {
    fn line(&self, node: Node<'_, '_>) -> u32 {
        self.document.text_pos_at(node.range().start).row
    }

    fn fail<T>(&self, node: Node<'_, '_>, text: impl Into<String>) -> Checked<T> {
        Err(self.remark(node, text))
    }

    fn remark(&self, node: Node<'_, '_>, text: impl Into<String>) -> Remark {
        Remark {
            line: self.line(node),
            text: text.into(),
        }
    }

    fn note(&mut self, node: Node<'_, '_>, text: impl Into<String>) {
        let remark = self.remark(node, text);
        self.remarks.push(remark);
    }

    /// Names the tags inside `node` that are neither `known` nor without a bearing on the motion, and what else those that
    /// are known tell.
    fn note_others(&mut self, node: Node<'_, '_>, known: &[&str]) {
        let mut seen = BTreeSet::new();
        for child in node.children().filter(Node::is_element) {
            let tag = child.tag_name().name();
            let is_first = seen.insert(tag) || node.has_tag_name("robot");
            if !known.contains(&tag) && !["visual", "collision", "material"].contains(&tag) {
                self.note(child, format!("`{tag}` is not converted"));
            } else if known.contains(&tag) && !is_first {
                self.note(child, format!("another `{tag}` is not converted"));
            } else if let Some((_, told)) = ATTRIBUTES.iter().find(|(of, _)| *of == tag) {
                let names = child.attributes().map(|it| it.name());
                for name in names.filter(|name| !told.contains(name)) {
                    self.note(child, format!("`{name}` of `{tag}` is not converted"));
                }
            }
        }
    }

    fn robot(&mut self, node: Node<'a, 'a>) -> Checked<Robot> {
        if node.tag_name().name() != "robot" {
            let found = node.tag_name().name();
            return self.fail(node, format!("expected a `robot`, found `{found}`"));
        }
        self.note_others(node, &["link", "joint"]);
        let elements = |tag: &'static str| node.children().filter(move |it| it.has_tag_name(tag));
        let mut links: Vec<Link> = Vec::new();
        for element in elements("link") {
            let link = self.link(element)?;
            if links.iter().any(|other| other.name == link.name) {
                return self.fail(element, format!("there is another link `{}`", link.name));
            }
            links.push(link);
        }
        let mut joints: Vec<Joint> = Vec::new();
        for element in elements("joint") {
            let joint = self.joint(element, &links)?;
            if joints.iter().any(|other| other.name == joint.name) {
                return self.fail(element, format!("there is another joint `{}`", joint.name));
            }
            if let Some(other) = joints.iter().find(|other| other.child == joint.child) {
                let link = &links[joint.child].name;
                let text = format!("`{link}` hangs on the joint `{}` already", other.name);
                return self.fail(element, text);
            }
            joints.push(joint);
        }
        resolve_mimics(&mut joints)?;
        let held: BTreeSet<usize> = joints.iter().map(|joint| joint.child).collect();
        let roots: Vec<usize> = (0..links.len()).filter(|it| !held.contains(it)).collect();
        let [root] = roots[..] else {
            let names: Vec<String> = roots
                .iter()
                .map(|it| format!("`{}`", links[*it].name))
                .collect();
            let text = match names.len() {
                0 if links.is_empty() => "a robot has a link".to_owned(),
                0 => "no link is without a joint that holds it".to_owned(),
                _ => format!("one link is the root, found {}", names.join(", ")),
            };
            return self.fail(node, text);
        };
        let count = joints.len();
        let joints = walked(root, joints);
        if joints.len() < count {
            let text = format!(
                "some joints hang on each other and not on `{}`",
                links[root].name
            );
            return self.fail(node, text);
        }
        let robot = Robot {
            name: shown(node.attribute("name").unwrap_or("robot")),
            links,
            joints,
            root,
        };
        self.note_massless(&robot);
        Ok(robot)
    }

    /// Names the joints that move nothing, nor any joint that mimics them: their equation is without a solution.
    fn note_massless(&mut self, robot: &Robot) {
        let mut loads: Vec<Load> = robot.links.iter().map(Load::of).collect();
        // What floats does not move with what is before it.
        let holding = |it: &&Joint| it.motion != Motion::Float;
        for joint in robot.joints.iter().rev().filter(holding) {
            let load = loads[joint.child];
            let below = &mut loads[joint.parent];
            below.mass |= load.mass;
            below.inertia |= load.inertia;
        }
        let resists = |joint: &Joint| {
            let load = loads[joint.child];
            load.mass || load.inertia && joint.motion == Motion::Turn
        };
        let moving = |it: &&Joint| it.motion != Motion::Fixed && it.mimic.is_none();
        for joint in robot.joints.iter().filter(moving) {
            let moved = |it: &Joint| it.name == joint.name || it.follows(&joint.name);
            if robot.joints.iter().any(|it| moved(it) && resists(it)) {
                continue;
            }
            let missing = match joint.motion {
                Motion::Turn => "a mass or an inertia",
                _ => "a mass",
            };
            let name = &joint.name;
            self.remarks.push(Remark {
                line: joint.line,
                text: format!(
                    "nothing that `{name}` moves has {missing}, which `mbg!` will refuse"
                ),
            });
        }
    }

    fn link(&mut self, node: Node<'a, 'a>) -> Checked<Link> {
        let name = shown(self.attribute(node, "name")?);
        self.note_others(node, &["inertial"]);
        let body = match child(node, "inertial") {
            Some(inertial) => self.body(inertial, &name)?,
            None => None,
        };
        Ok(Link { name, body })
    }

    fn body(&mut self, node: Node<'a, 'a>, link: &str) -> Checked<Option<Body>> {
        self.note_others(node, &["origin", "mass", "inertia"]);
        let Some(mass) = child(node, "mass") else {
            return self.fail(node, "expected a `mass` inside `inertial`");
        };
        let mass = self.number(mass, "value")?;
        let inertia = match child(node, "inertia") {
            Some(tensor) => self
                .inertia(tensor)?
                .map(|row| row.map(|it| measurable(it, mass))),
            None if mass == 0.0 => return Ok(None),
            None => return self.fail(node, "expected an `inertia` inside `inertial`"),
        };
        if mass == 0.0 && inertia == [[0.0; 3]; 3] {
            return Ok(None);
        }
        if mass < 0.0 || squares(&inertia).is_none() {
            let text = format!("mass or inertia of `{link}` is negative, as no body's can be");
            self.note(node, text);
        }
        let body = Body {
            mass,
            centre: [0.0; 3],
            inertia,
        };
        Ok(Some(body.seen(&self.origin(node)?)))
    }

    /// About the centre of mass, by rows.
    fn inertia(&self, node: Node<'a, 'a>) -> Checked<Matrix> {
        let number = |name: &str| match node.attribute(name) {
            Some(_) => self.number(node, name),
            None if name[1..2] != name[2..3] => Ok(0.0),
            None => self.fail(node, format!("`inertia` needs `{name}`")),
        };
        let [xx, xy, xz] = [number("ixx")?, number("ixy")?, number("ixz")?];
        let [yy, yz, zz] = [number("iyy")?, number("iyz")?, number("izz")?];
        Ok([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    }

    fn joint(&mut self, node: Node<'a, 'a>, links: &[Link]) -> Checked<Joint> {
        let name = shown(self.attribute(node, "name")?);
        let motion = match self.attribute(node, "type")? {
            "fixed" => Motion::Fixed,
            "revolute" | "continuous" => Motion::Turn,
            "prismatic" => Motion::Slide,
            "floating" => Motion::Float,
            "planar" => Motion::Plane,
            kind => {
                let text = format!(
                    "joint `{name}` is of the type `{kind}`, known are `fixed`, `revolute`, `continuous`, `prismatic`, `planar` and `floating`"
                );
                return self.fail(node, text);
            }
        };
        let ends = self.ends(node, motion)?;
        let mut known = vec!["origin", "parent", "child", "axis", "dynamics", "mimic"];
        known.extend(ends.map(|_| "limit"));
        self.note_others(node, &known);
        let limit = match ends {
            Some(element) => self.limit(node, element)?,
            None => None,
        };
        let [damping, friction] = self.losses(node, motion)?;
        Ok(Joint {
            motion,
            parent: self.linked(node, "parent", links)?,
            child: self.linked(node, "child", links)?,
            origin: self.origin(node)?,
            axis: self.axis(node, motion)?,
            mimic: self.mimic(node, motion)?,
            damping,
            friction,
            limit,
            line: self.line(node),
            name,
        })
    }

    /// The damping and the friction of a joint.
    fn losses(&mut self, node: Node<'a, 'a>, motion: Motion) -> Checked<[f64; 2]> {
        let Some(dynamics) = child(node, "dynamics") else {
            return Ok([0.0; 2]);
        };
        let names = ["damping", "friction"];
        let mut losses = [0.0; 2];
        for (loss, name) in losses.iter_mut().zip(names) {
            *loss = self.number_or(dynamics, name, 0.0)?;
        }
        if motion.is_several() && losses != [0.0; 2] {
            let kind = self.attribute(node, "type")?;
            let text = format!("`dynamics` of a {kind} joint is not converted");
            self.note(dynamics, text);
            return Ok([0.0; 2]);
        }
        for (loss, name) in losses.iter().zip(names).filter(|it| *it.0 < 0.0) {
            let joint = shown(self.attribute(node, "name")?);
            let text = format!("the `{name}` of `{joint}` drives it, as it is negative: {loss}");
            self.note(dynamics, text);
        }
        Ok(losses)
    }

    /// The tag that tells where the coordinate of a joint ends, which a limit of the effort and the velocity alone does not.
    fn ends(&self, node: Node<'a, 'a>, motion: Motion) -> Checked<Option<Node<'a, 'a>>> {
        let ends = motion.is_single() && self.attribute(node, "type")? != "continuous";
        let is_told =
            |it: &Node<'_, '_>| ["lower", "upper"].iter().any(|end| it.has_attribute(*end));
        Ok(child(node, "limit").filter(|limit| self.stops && ends && is_told(limit)))
    }

    /// Where the coordinate of a joint ends.
    fn limit(&mut self, node: Node<'a, 'a>, element: Node<'a, 'a>) -> Checked<Option<[f64; 2]>> {
        let [lower, upper] = [
            self.number_or(element, "lower", 0.0)?,
            self.number_or(element, "upper", 0.0)?,
        ];
        if lower > upper {
            return self.fail(
                element,
                format!("`lower` is above `upper`: {lower} and {upper}"),
            );
        }
        let name = shown(self.attribute(node, "name")?);
        // So many files have it that do not tell the limits.
        if lower == upper {
            self.note(
                element,
                format!("`{name}` gets no stop, as its limits are both {lower}"),
            );
            return Ok(None);
        }
        // What mimics starts where its leader tells it to.
        if child(node, "mimic").is_none() && !(lower..=upper).contains(&0.0) {
            let text = format!(
                "`{name}` starts beyond its stop, unless `initial` is from {lower} to {upper}"
            );
            self.note(element, text);
        }
        Ok(Some([lower, upper]))
    }

    /// The number of the link that a joint names.
    fn linked(&self, node: Node<'a, 'a>, tag: &str, links: &[Link]) -> Checked<usize> {
        let Some(element) = child(node, tag) else {
            return self.fail(node, format!("expected a `{tag}` inside `joint`"));
        };
        let name = shown(self.attribute(element, "link")?);
        match links.iter().position(|link| link.name == name) {
            Some(number) => Ok(number),
            None => self.fail(element, format!("there is no link `{name}`")),
        }
    }

    /// What a joint without one gives as its axis means nothing, and is often zero.
    fn axis(&self, node: Node<'a, 'a>, motion: Motion) -> Checked<Vector> {
        let element = match child(node, "axis") {
            Some(element) if !matches!(motion, Motion::Fixed | Motion::Float) => element,
            _ => return Ok([1.0, 0.0, 0.0]),
        };
        let axis = self.numbers(element, ("xyz", "three"))?;
        if axis == [0.0; 3] {
            return self.fail(element, "an axis has a direction");
        }
        let least = self.right_angles * axis.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
        Ok(axis.map(|it| if it.abs() <= least { 0.0 } else { it }))
    }

    fn mimic(&mut self, node: Node<'a, 'a>, motion: Motion) -> Checked<Option<Mimic>> {
        let Some(element) = child(node, "mimic") else {
            return Ok(None);
        };
        if !motion.is_single() {
            let kind = self.attribute(node, "type")?;
            self.note(element, format!("a {kind} joint mimics none"));
            return Ok(None);
        }
        let leader = shown(self.attribute(element, "joint")?);
        let mut joints = node.parent().into_iter().flat_map(|it| it.children());
        if !joints.any(|it| it.has_tag_name("joint") && self.is_named(it, &leader)) {
            return self.fail(element, format!("there is no joint `{leader}`"));
        }
        Ok(Some(Mimic {
            leader,
            multiplier: self.number_or(element, "multiplier", 1.0)?,
            offset: self.number_or(element, "offset", 0.0)?,
        }))
    }

    fn is_named(&self, node: Node<'a, 'a>, name: &str) -> bool {
        self.attribute(node, "name")
            .is_ok_and(|it| shown(it) == name)
    }

    fn origin(&mut self, node: Node<'a, 'a>) -> Checked<Pose> {
        let Some(element) = child(node, "origin") else {
            return Ok(Pose::NONE);
        };
        let given = |name: &str| match element.attribute(name) {
            Some(_) => self.numbers(element, (name, "three")),
            None => Ok([0.0; 3]),
        };
        let place = given("xyz")?;
        let angles = match element.attribute("quat_xyzw") {
            Some(_) => self.quaternion(element)?,
            None => given("rpy")?,
        };
        Ok(Pose {
            place,
            turn: rotation(angles.map(|angle| self.angle(element, angle))),
        })
    }

    /// The same as roll, pitch and yaw, so that right angles are told in one way.
    fn quaternion(&self, node: Node<'a, 'a>) -> Checked<Vector> {
        if node.attribute("rpy").is_some() {
            return self.fail(node, "an `origin` has `rpy` or `quat_xyzw`, not both");
        }
        let quaternion = self.numbers(node, ("quat_xyzw", "four"))?;
        match quaternion == [0.0; 4] {
            true => self.fail(node, "no orientation has the quaternion zero"),
            false => Ok(angles(quaternion)),
        }
    }

    /// An angle, or the multiple of a right angle that it is near.
    fn angle(&mut self, node: Node<'a, 'a>, angle: f64) -> f64 {
        if angle.abs() > TAU + RIGHT {
            self.note(
                node,
                format!("{angle} is more than a turn: `rpy` is in rad"),
            );
        }
        let right = FRAC_PI_2 * (angle / FRAC_PI_2).round();
        let off = (angle - right).abs();
        if off <= self.right_angles {
            return right;
        }
        if off > RIGHT && off < 1e-4 {
            let next = 10.0_f64.powf(off.log10().ceil());
            self.note(
                node,
                format!("{angle} is {off:.1e} rad beside a right angle; with `--right-angles {next:e}` fewer operations are left"),
            );
        }
        angle
    }

    fn attribute(&self, node: Node<'a, 'a>, name: &str) -> Checked<&'a str> {
        match node.attribute(name) {
            Some(value) => Ok(value.trim()),
            None => {
                let tag = node.tag_name().name();
                self.fail(node, format!("`{tag}` needs `{name}`"))
            }
        }
    }

    fn number(&self, node: Node<'a, 'a>, name: &str) -> Checked<f64> {
        let text = self.attribute(node, name)?;
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => self.fail(node, unread(name, "a number", text)),
        }
    }

    fn number_or(&self, node: Node<'a, 'a>, name: &str, otherwise: f64) -> Checked<f64> {
        match node.attribute(name) {
            Some(_) => self.number(node, name),
            None => Ok(otherwise),
        }
    }

    /// Numbers in a row, of which a name tells how many.
    fn numbers<const N: usize>(
        &self,
        node: Node<'a, 'a>,
        (name, count): (&str, &str),
    ) -> Checked<[f64; N]> {
        let text = self.attribute(node, name)?;
        let numbers = text.split_whitespace().map(str::parse::<f64>);
        let numbers: Option<Vec<f64>> = numbers.map(Result::ok).collect();
        let numbers = numbers.and_then(|it| <[f64; N]>::try_from(it).ok());
        match numbers.filter(|it| it.iter().all(|it| it.is_finite())) {
            Some(numbers) => Ok(numbers),
            None => self.fail(node, unread(name, &format!("{count} numbers"), text)),
        }
    }
}

/// A name on one line, as comments need it.
pub(crate) fn shown(name: &str) -> String {
    name.replace(char::is_control, " ")
}

/// The first element with this tag.
fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|it| it.has_tag_name(tag))
}

/// Makes every mimic one of a joint that is free. What mimics a joint that does not move is fixed.
fn resolve_mimics(joints: &mut [Joint]) -> Checked<()> {
    follow_chains(joints)?;
    refuse_several(joints)?;
    fix_held(joints);
    Ok(())
}

fn follow_chains(joints: &mut [Joint]) -> Checked<()> {
    for at in 0..joints.len() {
        let mut left = joints.len();
        while let Some(further) = further(joints, &joints[at]) {
            if left == 0 {
                let text = format!("in the end joint `{}` mimics itself", joints[at].name);
                let line = joints[at].line;
                return Err(Remark { line, text });
            }
            left -= 1;
            joints[at].mimic = Some(further);
        }
    }
    Ok(())
}

fn refuse_several(joints: &[Joint]) -> Checked<()> {
    for joint in joints {
        let leader = leader(joints, joint);
        if let Some(leader) = leader.filter(|it| it.motion.is_several()) {
            let (name, leader) = (&joint.name, &leader.name);
            let text = format!("joint `{name}` mimics `{leader}`, which has several coordinates");
            let line = joint.line;
            return Err(Remark { line, text });
        }
    }
    Ok(())
}

fn fix_held(joints: &mut [Joint]) {
    let held = |joint: &Joint| {
        let still = leader(joints, joint)?.motion == Motion::Fixed;
        let mimic = joint.mimic.as_ref()?;
        (still || mimic.multiplier == 0.0).then_some(mimic.offset)
    };
    let held: Vec<Option<f64>> = joints.iter().map(held).collect();
    for (joint, held) in joints.iter_mut().zip(held) {
        if let Some(coordinate) = held {
            joint.fix(coordinate);
        }
    }
}

/// The mimic of a joint's leader's leader, where there is one.
fn further(joints: &[Joint], joint: &Joint) -> Option<Mimic> {
    let next = leader(joints, joint)?.mimic.as_ref()?;
    joint.mimic.as_ref().map(|it| it.through(next))
}

fn leader<'a>(joints: &'a [Joint], joint: &Joint) -> Option<&'a Joint> {
    let mimic = joint.mimic.as_ref()?;
    joints.iter().find(|it| it.name == mimic.leader)
}

/// The joints in the order of a walk from the root; each link hangs on one, so that all are met or a ring is left out.
fn walked(root: usize, joints: Vec<Joint>) -> Vec<Joint> {
    let mut left: Vec<Option<Joint>> = joints.into_iter().map(Some).collect();
    let (mut order, mut open) = (Vec::new(), vec![root]);
    while let Some(link) = open.pop() {
        let below = left
            .iter_mut()
            .filter(|it| it.as_ref().is_some_and(|joint| joint.parent == link));
        let below: Vec<Joint> = below.filter_map(Option::take).collect();
        open.extend(below.iter().rev().map(|joint| joint.child));
        order.extend(below);
    }
    order
}
