//! What is known of a model at compile time.

/// Description of a generated model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meta {
    /// Name of the type.
    pub name: &'static str,
    /// Parameters in order of declaration.
    pub parameters: &'static [Variable],
    /// States in the order of `x`.
    pub states: &'static [Variable],
    /// Inputs in the order of `u`.
    pub inputs: &'static [Variable],
    /// Outputs in the order of `y`.
    pub outputs: &'static [Variable],
    /// Bonds with their strokes.
    pub bonds: &'static [Bond],
    /// Storages that the drawing puts into derivative causality, accepted by `#[derivative]`.
    pub dependent: &'static [&'static str],
    /// Names of the inverted blocks, in the order of `conditioning`.
    pub conditioning: &'static [&'static str],
    /// What the parameters must fulfil, one sentence each.
    pub assumptions: &'static [&'static str],
    /// Things worth knowing that are no mistakes, such as a mark that is not needed.
    pub notes: &'static [&'static str],
    /// Operations per call.
    pub operations: Operations,
    /// The graph as text, with strokes.
    pub diagram: &'static str,
}

/// A scalar with a name and a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Name, such as `hull.p.x`.
    pub name: &'static str,
    /// Unit as written, empty when none was.
    pub unit: &'static str,
}

/// A bond as the model draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bond {
    /// Where positive power comes from.
    pub from: &'static str,
    /// Where positive power goes to.
    pub to: &'static str,
    /// Number of components.
    pub dimension: usize,
    /// The end at which each component's causal stroke stands.
    pub strokes: &'static [Stroke],
}

/// The end of a bond that receives the effort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// At `from`.
    From,
    /// At `to`.
    To,
}

/// Arithmetic per call: an addition, subtraction, multiplication, division or elementary function counts one, sine
/// and cosine of one angle two, negations and whatever `new` has done once count nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operations {
    /// Of `derivative`.
    pub derivative: usize,
    /// Of `output`.
    pub output: usize,
    /// Of `jacobian_state`.
    pub jacobian_state: usize,
    /// Of `jacobian_input`.
    pub jacobian_input: usize,
    /// Of `energy`.
    pub energy: usize,
    /// Of `power`.
    pub power: usize,
    /// Angles of which `derivative` takes sine and cosine.
    pub angles: usize,
}
