//! The models of the repository as lists of tokens.

use std::path::{Path, PathBuf};
use std::{fmt, fs};

use mbg_compiler::diagnostics::Diagnostics;
use mbg_compiler::inclusion::Inclusion;

use crate::tokens::flat;

/// Texts for the grammar alone: their models mean nothing.
const MEANINGLESS: [&str; 2] = ["everything.mbg", "mistakes.mbg"];

/// The most tokens of a file. Above are robots of many links and closed loops of many joints, which take seconds each where
/// the compiler is not optimised.
const LONGEST: usize = 1100;

/// Joints between the ground and a body.
const JOINTS: [&str; 15] = [
    "joint: Revolute { axis: 1, initial: 0.3, friction: 0.1 } (ground, tip);",
    "joint: Prismatic { axis: 0, tilt: rot_y(0.4), stiffness: 20.0, damping: 0.3 } (ground, tip);",
    "joint: Cylindrical { axis: 2, initial_turning: 0.5, turn_stiffness: 2.0 } (ground, tip);",
    "joint: Universal { initial: [0.2, 0.4], initial_rates: [0.5, 0.1] } (ground, tip);",
    "joint: Spherical { orientation: quaternion, initial_rate: [0.1, 0.2, 3.0] } (ground, tip);",
    "joint: Free { initial_rate: [0.1, 0.2, 0.3], damping: 0.1 } (ground, tip);",
    "joint: Fixed { blocked: compliant, blocked_stiffness: 100.0, blocked_damping: 1.0 } (ground, tip);",
    "1 foot[6]; joint: Free { orientation: matrix } (ground, foot);
     arm: Mount { offset: [0.1, 0.2, 0.0] } (foot, tip);",
    "1 foot[6]; joint: Free { initial: [0.1, 0.2, 0.3] } (ground, foot);
     arm: Offset { by: [0.1, 0.2, 0.0] } (foot, tip);",
    "1 foot[6]; joint: Free { initial_rate: [0.1, 0.2, 0.3] } (ground, foot);
     arm: Turn { by: rot_x(0.5) } (foot, tip);",
    "joint: Free { } (ground, tip); load: Load { force: [1.0, 2.0, 3.0] } (tip);
     point: PointMass { mass: 0.5 } (tip);",
    "joint: Free { } (ground, tip); #[derivative]
     water: AddedMass { mass: diag(0.3, 0.6, 0.7), inertia: 0.2, centre: [0.1, 0.0, 0.0] } (tip);",
    "joint: Free { } (ground, tip);
     cut: Cut {} (ground, tip);",
    "joint: Prismatic { axis: 2, initial: 0.1 } (ground, tip);
     end: Stop { displacement: joint.travel, upper: 0.2, stiffness: 50.0 } (joint.rate);
     floor: Contact {
        stiffness: 50.0, dissipation: 0.3, friction: 0.5, friction_speed: 0.1, rolling_resistance: 0.1, radius: 0.2
     } (tip);",
    "joint: Free { } (ground, tip); 1 deck[6]; heave: Prismatic { axis: 2 } (ground, deck);
     hull: PointMass { mass: 9.0 } (deck);
     skid: BodyContact { stiffness: 50.0, dissipation: 0.3, friction: 0.5, friction_speed: 0.1, radius: 0.2 } (tip, deck);
     knob: BodyContact { stiffness: 50.0, radius: 0.1, sphere: 0.2 } (tip, deck);",
];

/// Joints between angular velocities.
const ROTATIONS: [&str; 4] = [
    "FreeRotation { orientation: quaternion, initial_rate: [0.1, 2.0, 0.3] }",
    "Gimbal { initial_rate: [0.1, 2.0, 0.3], stiffness: 2.0 }",
    "GimbalSeries { initial_rate: [0.1, 2.0, 0.3], damping: [0.2, 0.1, 0.3], friction: [0.1, 0.2, 0.3] }",
    "GimbalAxis { axis: 1, friction: 0.3 }",
];

/// What hangs on the ground in a plane.
const PLANAR: [&str; 7] = [
    "hinge: PlanarRevolute { initial: 0.3 } (ground, tip);
     mass: PlanarPointMass { mass: 0.5 } (tip); body: PlanarBody { mass: 1.0, inertia: 0.1 } (tip);",
    "slide: PlanarPrismatic { direction: 0.3, stiffness: 20.0, friction: 0.2 } (ground, tip);
     body: PlanarBody { mass: 1.0, inertia: 0.1 } (tip); load: PlanarLoad { force: [1.0, 2.0], moment: 0.3 } (tip);",
    "1 foot[3]; hinge: PlanarRevolute { initial: 0.3 } (ground, foot);
     rod: PlanarOffset { x: 0.5 } (foot, tip); body: PlanarBody { mass: 1.0, inertia: 0.1 } (tip);",
    "left: PlanarLink { mass: 1.0, inertia: 0.1, centre: [0.5, 0.0], end: [1.0, 0.0] } (ground, tip);
     cut: PlanarCut { position_b: [1.0, 0.0] } (tip, ground);",
    "free: PlanarFree { initial_position: [0.0, 1.0], initial_rate: 0.3, force: [0.2, 0.0] } (ground, tip);
     body: PlanarBody { mass: 1.0, inertia: 0.1 } (tip);",
    "slide: PlanarPrismatic { direction: 0.3, initial: 0.1 } (ground, tip);
     mass: PlanarPointMass { mass: 0.5 } (tip);
     floor: PlanarContact {
        stiffness: 50.0, friction: 0.5, friction_speed: 0.1, rolling_resistance: 0.1, radius: 0.2
     } (tip);",
    "slide: PlanarPrismatic { direction: 0.3, initial: 0.1 } (ground, tip); mass: PlanarPointMass { mass: 0.5 } (tip);
     1 cart[3]; road: PlanarPrismatic (ground, cart); wagon: PlanarPointMass { mass: 2.0 } (cart);
     skid: PlanarBodyContact { stiffness: 50.0, friction: 0.5, at_rest: holds, radius: 0.2 } (tip, cart);
     knob: PlanarBodyContact { stiffness: 50.0, radius: 0.1, circle: 0.2 } (tip, cart);",
];

/// Models of other domains, laws of every function, and a component in a file.
const OTHERS: [&str; 8] = [
    "model Circuit {
        0 plus; 0 middle; 0 tapped; 0 ground; Se earth { effort: 0.0 } -> ground; Se supply { effort: 12.0 } -> plus;
        wire: Resistor { resistance: 6.0 } (plus, middle); coil: Inductor { inductance: 0.1 } (middle, ground);
        iron: Transformer { ratio: 2.0 } (middle, ground, tapped, ground);
        store: Capacitor { capacitance: 1e-3 } (tapped, ground);
        load: Diode { } (tapped, ground);
    }",
    "model Drive {
        0 plus; 0 ground; Se earth { effort: 0.0 } -> ground; Se supply { effort: 12.0 } -> plus;
        1 shaft; 1 wheel { R air { resistance: 0.1 } } 1 bar { I rod { inertia: 3.0 } }
        motor: DcMotor { resistance: 2.0, inductance: 0.1, constant: 0.3, inertia: 0.02 } (plus, ground, shaft);
        teeth: Gear { radius_a: 0.1, radius_b: 0.2, blocked: compliant } (shaft, wheel);
        flat: Rack { radius: 0.1, blocked: compliant } (wheel, bar);
        rub: Friction { sliding: 0.2, breakaway: 0.3 } (bar); seat: Bearing { stiffness: 10.0, damping: 1.0 } (bar);
    }",
    "#[derivative] model Car {
        param torque: N*m = 90.0; input pedal;
        1 engine { I wheel { inertia: 0.2 } Se gas { effort: torque } } 1 inlet { I gears { inertia: 0.01 } } 1 shaft; 1 pinion;
        1 left { I front { inertia: 9.0 } } 1 right { I back { inertia: 8.0 } } 1 sun { I rotor { inertia: 0.1 } } 1 ring;
        plates: Clutch { capacity: 200.0, engagement: pedal, speed: 0.1 } (engine, inlet); inlet -> TF gear { flow: 0.3 } -> shaft;
        bar: ElasticShaft { stiffness: 2e3, damping: 1.0, initial: 0.01 } (shaft, pinion);
        axle: Differential { ratio: 4.0 } (pinion, left, right); lash: Backlash { gap: 0.01, stiffness: 1e4 } (left, sun);
        hub: Planetary { ratio: 3.0 } (sun, right, ring); shoe: Brake { capacity: 50.0, speed: 0.1 } (ring);
        1 drum { I barrel { inertia: 2.0 } } sprags: Freewheel { capacity: 90.0, speed: 0.1 } (right, drum);
    }",
    "model Lift {
        0 tank; Se open { effort: 1e5 } -> tank; 0 line; 0 ring; 1 shaft { I rotor { inertia: 0.1 } } 1 rod { I load { inertia: 5.0 } }
        pump: Pump { displacement: 1e-5 } (tank, line, shaft); leak: Orifice { area: 1e-5 } (line, tank);
        gas: Accumulator { volume: 1e-3, precharge: 2e5, initial: 1e-4 } (line);
        oil: Accumulator { volume: 1e-3, precharge: 1e5, initial: 2e-4 } (ring);
        piston: Cylinder { area_a: 1e-3, area_b: 5e-4 } (line, ring, rod); back: Orifice { area: 1e-5 } (ring, tank);
    }",
    "model Oven {
        0 core pseudo; 0 air pseudo; Se weather { effort: 293.0 } -> air; glow: HeatSource { power: 50.0 } (core);
        iron: HeatCapacity { capacity: 500.0 } (core); wall: Conduction { conductance: 2.0 } (core, air);
    }",
    "component Slope(port a) { a -> R r { flow: abs(e) * e }; }
    model Small {
        causality componentwise; param k = 2.0; param gains[2] = [1.0, 2.0]; input u[2];
        1 a[2] { C c { stiffness: [[k, 0.0], [0.0, 1.0]] } R l { resistance: k } }
        Se push { effort: u } -> a;
        a.x -> GY g { effort: k } -> b;
        0 b { C d { effort: tanh(q) } I m { energy: if p < 0.0 { p * p } else { powi(p, 4) } } }
        s: Slope (b);
        integral x = m.f, initial: gains.y;
        output y = x * c.q.y;
    }",
    "model Laws {
        input push; Se drive { effort: push } -> a;
        1 a {
            I mass { flow: p + tanh(p) } R air { effort: abs(f) * f + atan2(f, 2.0) + sign(f) }
            C sine { effort: sin(2.0 * q) } C tangent { effort: tan(q), initial: 0.2 } C arc { effort: atan2(q, 2.0) + atan(q) }
            C rise { effort: exp(q) - 1.0 } C logarithm { effort: ln(q + 1.5) } C root { effort: sqrt(q + 2.0) }
            C cube { effort: powi(q + 1.0, 3) } C pole { effort: 3.0 / (q + 2.0) } C size { effort: abs(q - 0.1) }
            C play { effort: if q < 0.2 { q } else { 3.0 * q - 0.4 } } C edge { effort: max(q, 0.1) }
            C curve { effort: interpolate(q, [-1.0, 0.3, 2.0], [-1.0, 0.1, 0.4]) }
            C odd { effort: q * interpolate(abs(q), [0.0, 0.5, 1.0], [0.3, 1.0, 4.0]) }
            C table { stiffness: interpolate(q, [-1.0, 0.3, 2.0], [1.0, 2.0, 3.0]) }
            C gas { effort: exp(1.4 * ln(1.0 / (2.0 - q))) } C bowl { energy: powi(q, 4) + cos(q) }
        }
    }",
    "include \"examples/gallery/rods.mbg\";
     #[derivative] model Chain { gravity [0.0, -9.81]; 1 ground[3] { Sf fixed { flow: 0.0 } } rods: Rods { count: 2, bend: 0.1 } (ground); }",
];

/// Models that are no files, each with what it calls in few words.
fn written() -> impl Iterator<Item = String> {
    let joints = JOINTS.map(|joint| {
        format!(
            "#[derivative] model Hung {{
                gravity [0.0, 1.0, -9.81]; 1 ground[6] {{ Sf fixed {{ flow: 0.0 }} }} 1 tip[6]; {joint}
                body: Body {{ mass: 2.0, inertia: diag(1.0, 2.0, 3.0), centre: [0.1, 0.2, 0.3] }} (tip);
            }}"
        )
    });
    let rotations = ROTATIONS.map(|joint| {
        format!(
            "#[derivative] model Turning {{
                1 ground[3] {{ Sf fixed {{ flow: 0.0 }} }} joint: {joint} (ground, tip);
                1 tip[3] {{ I body {{ inertia: diag(1.0, 2.0, 3.0), gyroscopic }} }}
            }}"
        )
    });
    let planar = PLANAR.map(|statements| {
        format!(
            "#[derivative] model Flat {{
                gravity [0.0, -9.81]; 1 ground[3] {{ Sf fixed {{ flow: 0.0 }} }} 1 tip[3]; {statements}
            }}"
        )
    });
    let others = OTHERS.map(str::to_owned);
    joints
        .into_iter()
        .chain(rotations)
        .chain(planar)
        .chain(others)
}

/// A text without a mistake.
#[derive(Clone)]
pub(crate) struct Text {
    /// The file, or the files.
    pub(crate) name: String,
    /// Its tokens with their brackets flat.
    pub(crate) words: Vec<String>,
}

impl fmt::Debug for Text {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(&self.name)
    }
}

impl Text {
    /// A text with the files that it includes in place.
    fn of(root: &Path, name: String, text: &str) -> Self {
        let read = |path: &str| fs::read_to_string(root.join(path));
        let tokens = text.parse().expect("tokens");
        let mut diagnostics = Diagnostics::new();
        let inclusion = Inclusion::of(tokens, &read, &mut diagnostics);
        assert!(!diagnostics.any(), "{:?}", diagnostics.list());
        let mut words = Vec::new();
        flat(inclusion.tokens(), &mut words);
        Self { name, words }
    }

    /// A file below the root.
    fn file(root: &Path, path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("a readable file");
        let name = path.strip_prefix(root).unwrap_or(path);
        Self::of(root, name.display().to_string(), &text)
    }

    /// Names behind a word, such as those of the components that it declares.
    fn behind(&self, word: &str) -> impl Iterator<Item = &String> {
        let pairs = self.words.windows(2);
        pairs
            .filter(move |pair| pair[0] == word)
            .map(|pair| &pair[1])
    }

    fn has_model(&self) -> bool {
        self.behind("model").next().is_some()
    }

    fn declares(&self, name: &str) -> bool {
        self.behind("component").any(|it| it == name)
    }

    /// Whether it is a model that calls a component which is declared elsewhere.
    fn calls(&self, name: &str) -> bool {
        self.words.iter().any(|word| word == name) && !self.declares(name)
    }

    /// The components of this text and a model of another.
    fn called_by(&self, model: &Self) -> Self {
        Self {
            name: format!("{} with {}", self.name, model.name),
            words: [&self.words[..], &model.words[..]].concat(),
        }
    }
}

/// The texts in which there is a model, in order of names. A component comes with the shortest of them that calls it.
pub(crate) fn corpus() -> Vec<Text> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut paths = Vec::new();
    walk(&root, &mut paths);
    let files = paths.iter().map(|path| Text::file(&root, path));
    let written = written().map(|text| Text::of(&root, text.clone(), &text));
    let short = files
        .chain(written)
        .filter(|text| text.words.len() <= LONGEST);
    let (mut models, mut components): (Vec<Text>, Vec<Text>) = short.partition(Text::has_model);
    loop {
        models.sort_by(|a, b| (a.words.len(), &a.name).cmp(&(b.words.len(), &b.name)));
        let mut called = Vec::new();
        components.retain(|text| {
            let calls = |model: &&Text| text.behind("component").any(|name| model.calls(name));
            let caller = models.iter().find(calls);
            called.extend(caller.map(|model| text.called_by(model)));
            caller.is_none()
        });
        if called.is_empty() {
            break;
        }
        models.append(&mut called);
    }
    // A component of the library must be called; others may be called by models that are no files.
    let library = |text: &&Text| text.name.contains("library");
    let uncalled = components.iter().find(library).map(|text| &text.name);
    assert_eq!(uncalled, None, "no model calls it");
    models.sort_by(|a, b| a.name.cmp(&b.name));
    models
}

/// All files of models below a folder, but for those of the grammar's tests.
fn walk(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable folder").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if path.is_dir() {
            if name != "target" && !name.starts_with('.') {
                walk(&path, into);
            }
        } else if name.ends_with(".mbg") && !MEANINGLESS.contains(&name.as_str()) {
            into.push(path);
        }
    }
}
