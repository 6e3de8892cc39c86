//! Mechanisms in the language.

use std::fmt::{self, Write};

use nalgebra::{Matrix3, Vector3};

use super::parts::{Closed, Closing, Drive, Family, Load, Mass, Mechanism, Part};

/// The model.
pub(crate) fn text(mechanism: &Mechanism) -> String {
    let mut writer = Writer {
        mechanism,
        text: String::new(),
    };
    writer.model();
    writer.text
}

impl fmt::Debug for Mechanism {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&text(self))
    }
}

struct Writer<'a> {
    mechanism: &'a Mechanism,
    text: String,
}

fn vector(of: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", of.x, of.y, of.z)
}

fn matrix(of: &Matrix3<f64>) -> String {
    let rows = [0, 1, 2].map(|row| vector(&of.row(row).transpose()));
    format!("[{}]", rows.join(", "))
}

/// A number, or several.
fn numbers(of: &[f64]) -> String {
    match of {
        [one] => format!("{one:?}"),
        _ => format!("{of:?}"),
    }
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        writeln!(self.text, "    {line}").expect("a string grows");
    }

    /// Six components, or three.
    fn size(&self) -> usize {
        if self.mechanism.is_planar { 3 } else { 6 }
    }

    /// What derivative causality of an instance is accepted by.
    fn accepted(&self) -> &'static str {
        if self.mechanism.style.is_by_instance {
            "#[derivative] "
        } else {
            ""
        }
    }

    fn model(&mut self) {
        let style = self.mechanism.style;
        if !style.is_by_instance {
            self.text += "#[derivative]\n";
        }
        self.text += "model Mechanism {\n";
        if style.is_componentwise {
            self.line("causality componentwise;");
        }
        if let Some(gravity) = self.mechanism.gravity {
            let gravity = match self.mechanism.is_planar {
                true => format!("{:?}", &gravity.as_slice()[..2]),
                false => vector(&gravity),
            };
            self.line(&format!("gravity {gravity};"));
        }
        let size = self.size();
        self.line(&format!("1 ground[{size}] {{ Sf fixed {{ flow: 0.0 }} }}"));
        let mut closings: Vec<(usize, &Closing)> =
            self.mechanism.closings.iter().enumerate().collect();
        for (k, part) in self.mechanism.parts.iter().enumerate() {
            let is_last = |it: &(usize, &Closing)| it.1.word == Closed::Ring && it.1.from == k;
            let frame = match closings.iter().position(is_last) {
                Some(place) => {
                    let (number, closing) = closings.remove(place);
                    self.eye(
                        &format!("eye{number}"),
                        closing.to,
                        &closing.offset,
                        &closing.tilt,
                    );
                    format!("eye{number}")
                }
                None => {
                    self.line(&format!("1 frame{k}[{size}];"));
                    format!("frame{k}")
                }
            };
            self.part(k, part, &frame);
        }
        for (number, closing) in closings {
            self.cut(number, closing);
        }
        self.between();
        self.text += "}\n";
    }

    fn frame(part: Option<usize>) -> String {
        part.map_or_else(|| "ground".to_owned(), |part| format!("frame{part}"))
    }

    /// A frame that is fixed to a part.
    fn eye(&mut self, name: &str, to: Option<usize>, offset: &Vector3<f64>, tilt: &Matrix3<f64>) {
        let (size, to) = (self.size(), Self::frame(to));
        self.line(&format!("1 {name}[{size}];"));
        let line = if self.mechanism.is_planar {
            let (x, y) = (offset.x, offset.y);
            format!("mount_{name}: PlanarOffset {{ x: {x:?}, y: {y:?} }} ({to}, {name});")
        } else if *tilt == Matrix3::identity() {
            format!(
                "mount_{name}: Offset {{ by: {} }} ({to}, {name});",
                vector(offset)
            )
        } else {
            let (offset, tilt) = (vector(offset), matrix(tilt));
            format!("mount_{name}: Mount {{ offset: {offset}, tilt: {tilt} }} ({to}, {name});")
        };
        self.line(&line);
    }

    fn part(&mut self, k: usize, part: &Part, frame: &str) {
        let mut base = Self::frame(part.parent);
        let mut arguments = vec![part.joint.arguments.clone()];
        arguments.extend(part.joint.families.iter().map(family));
        if self.mechanism.is_planar {
            self.eye(&format!("base{k}"), part.parent, &part.offset, &part.tilt);
            base = format!("base{k}");
        } else {
            if part.offset != Vector3::zeros() {
                arguments.push(format!("offset: {}", vector(&part.offset)));
            }
            if part.tilt != Matrix3::identity() {
                arguments.push(format!("tilt: {}", matrix(&part.tilt)));
            }
        }
        arguments.retain(|it| !it.is_empty());
        let (word, arguments) = (part.joint.word, arguments.join(", "));
        self.line(&format!(
            "joint{k}: {word} {{ {arguments} }} ({base}, {frame});"
        ));
        self.mass(k, &part.mass, frame);
        self.load(k, part.load.as_ref(), frame);
        let rate = format!(
            "joint{k}.{}",
            part.joint.families[0].words.rate.trim_end_matches(".f")
        );
        match part.drive {
            Drive::None => {}
            Drive::Servo(change) => {
                let flow = part.first_rate();
                self.line(&format!(
                    "Sf servo{k} {{ flow: {flow:?} + {change:?} * t }} -> {rate};"
                ));
            }
            Drive::Wheel(inertia) => {
                let accepted = self.accepted();
                self.line(&format!(
                    "{accepted}I wheel{k} {{ inertia: {inertia:?} }} -> {rate};"
                ));
            }
        }
    }

    fn mass(&mut self, k: usize, mass: &Mass, frame: &str) {
        let accepted = self.accepted();
        let planar = if self.mechanism.is_planar {
            "Planar"
        } else {
            ""
        };
        match mass {
            Mass::None => {}
            Mass::Point(mass) => {
                self.line(&format!(
                    "{accepted}point{k}: {planar}PointMass {{ mass: {mass:?} }} ({frame});"
                ));
            }
            Mass::Body {
                mass,
                inertia,
                centre,
            } if self.mechanism.is_planar => {
                let inertia = inertia[(2, 2)];
                self.eye(&format!("centre{k}"), Some(k), centre, &Matrix3::identity());
                self.line(&format!(
                    "{accepted}body{k}: PlanarBody {{ mass: {mass:?}, inertia: {inertia:?} }} (centre{k});"
                ));
            }
            Mass::Body {
                mass,
                inertia,
                centre,
            } => {
                let (inertia, centre) = (matrix(inertia), vector(centre));
                self.line(&format!(
                    "{accepted}body{k}: Body {{ mass: {mass:?}, inertia: {inertia}, centre: {centre} }} ({frame});"
                ));
            }
        }
    }

    fn load(&mut self, k: usize, load: Option<&Load>, frame: &str) {
        let Some(Load {
            is_of_world,
            force,
            moment,
        }) = load
        else {
            return;
        };
        let axes = if *is_of_world { "world" } else { "body" };
        let (word, force, moment) = match self.mechanism.is_planar {
            true => {
                let force = format!("{:?}", &force.as_slice()[..2]);
                ("PlanarLoad", force, format!("{:?}", moment.z))
            }
            false => ("Load", vector(force), vector(moment)),
        };
        self.line(&format!(
            "load{k}: {word} {{ axes: {axes}, force: {force}, moment: {moment} }} ({frame});"
        ));
    }

    fn cut(&mut self, number: usize, closing: &Closing) {
        let eye = format!("eye{number}");
        let tilt = match closing.word {
            Closed::Spherical => Matrix3::identity(),
            _ => closing.tilt,
        };
        self.eye(&eye, closing.to, &closing.offset, &tilt);
        let word = match closing.word {
            Closed::Spherical => "spherical",
            Closed::Universal => "universal",
            Closed::Revolute | Closed::Ring => "revolute",
            Closed::Fixed => "fixed",
            Closed::Prismatic => "prismatic",
            Closed::Slot => "slot",
        };
        let frame = Self::frame(Some(closing.from));
        let line = if self.mechanism.is_planar {
            let (direction, zero) = (closing.direction, closing.zero);
            format!(
                "cut{number}: PlanarCut {{ joint: {word}, direction: {direction:?}, zero: {zero:?} }} ({frame}, {eye});"
            )
        } else {
            format!("cut{number}: Cut {{ joint: {word} }} ({frame}, {eye});")
        };
        self.line(&line);
    }

    fn between(&mut self) {
        if let Some(line) = &self.mechanism.line {
            self.eye("far", line.to, &line.offset, &Matrix3::identity());
            let planar = if self.mechanism.is_planar {
                "Planar"
            } else {
                ""
            };
            let frame = Self::frame(Some(line.from));
            self.line(&format!(
                "line: {planar}LineForce {{ stiffness: {:?}, rest: {:?}, damping: {:?}, force: {:?} }} ({frame}, far);",
                line.stiffness, line.rest, line.damping, line.force
            ));
        }
        if let Some(ratio) = &self.mechanism.ratio {
            let rate = |part: usize| {
                let words = self.mechanism.parts[part].joint.families[0].words;
                format!("joint{part}.{}", words.rate.trim_end_matches(".f"))
            };
            let (from, to) = (rate(ratio.from), rate(ratio.to));
            self.line(&format!(
                "{from} -> TF gear {{ flow: {:?} }} -> {to};",
                ratio.ratio
            ));
        }
    }
}

/// Arguments of a family.
fn family(family: &Family) -> String {
    let words = family.words;
    let mut text = format!("{}: {}", words.initial, numbers(&family.initial));
    let even = |of: &[f64]| match words.is_even {
        true => numbers(&of[..1]),
        false => numbers(of),
    };
    if let (Some((stiffness, rest)), false) = (&family.spring, words.stiffness.is_empty()) {
        let (stiffness, rest) = (even(stiffness), numbers(rest));
        let (word, rest_word) = (words.stiffness, words.rest);
        write!(text, ", {word}: {stiffness}, {rest_word}: {rest}").expect("a string grows");
    }
    for (word, values) in [
        (words.damping, even(&family.damping)),
        (words.motor, numbers(&family.motor)),
    ] {
        if !word.is_empty() {
            write!(text, ", {word}: {values}").expect("a string grows");
        }
    }
    text
}
