//! Every code that a diagnostic may carry, by stage.

use crate::diagnostics::Code;

macro_rules! codes {
    ($($name:ident = $text:literal, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $name: Code = Code { text: $text, meaning: $meaning };)*
        /// All codes in order.
        pub const ALL: &[Code] = &[$($name),*];
    };
}

codes! {
    SYNTAX = "MBG0101", "a token that the grammar does not expect here";
    UNIT = "MBG0102", "a unit that is not a product of powers";
    DIMENSION_LITERAL = "MBG0103", "a dimension that is not a positive integer";
    FIELD_REPEATED = "MBG0104", "a word given twice in one element";
    INCLUDE = "MBG0105", "a file that cannot be included";
    EMPTY_MODEL = "MBG0201", "a model without a storage, an integral or an attitude";
    DUPLICATE_NAME = "MBG0202", "a name declared twice";
    UNKNOWN_NAME = "MBG0203", "a name that is not declared";
    WRONG_DIMENSION = "MBG0204", "dimensions that do not agree";
    MISSING_LAW = "MBG0205", "an element without a law";
    TWO_LAWS = "MBG0206", "an element with two laws";
    UNKNOWN_FIELD = "MBG0207", "a word that the element does not know";
    UNCONNECTED = "MBG0208", "a port or a junction without a bond";
    TOO_MANY_BONDS = "MBG0209", "a port with more than one bond";
    EQUAL_ONE_PORTS = "MBG0210", "a bond between two one-ports that fix the same variable";
    LITERAL = "MBG0211", "a literal that is not a finite number";
    POWER_OPERATOR = "MBG0212", "`^`, which is not a power in Rust";
    EXPRESSION = "MBG0213", "an expression outside the subset for laws";
    MISSING_DEFAULT = "MBG0214", "a parameter without a value";
    RECURSION = "MBG0215", "a component that contains itself";
    NOT_FINITE = "MBG0216", "a law that divides by zero or whose literal breaks an assumption";
    WHOLE_NUMBER = "MBG0217", "a bound or an index that is no whole number known at compile time";
    CYCLE = "MBG0218", "a value that is defined by itself";
    WORD = "MBG0219", "a word that is none of those to choose from";
    CONDITION = "MBG0220", "a condition of statements that is not decided at compile time";
    NO_ROTATION = "MBG0221", "a matrix or quaternion that is no rotation";
    JUNCTION_KIND = "MBG0222", "a junction of the kind that a port does not take";
    UNREAD = "MBG0223", "a name that nothing reads";
    NO_EFFECT = "MBG0224", "an argument, an element, a component or a loop that has no effect, or a read of what was not given";
    LOOSE_END = "MBG0225", "a junction with one bond, which takes another out of the model";
    STORAGE_DERIVATIVE = "MBG0301", "a storage forced into derivative causality";
    SOURCES_CONFLICT = "MBG0302", "fixed causalities that contradict each other";
    NO_ASSIGNMENT = "MBG0303", "no assignment of strokes exists";
    GYROSCOPIC_INVERSE = "MBG0304", "a gyroscopic multiport that would need its inverse";
    RECTANGULAR_INVERSE = "MBG0305", "a rectangular transformer or gyrator that would need its inverse";
    ORDER_LOST = "MBG0306", "storages that depend on each other by the physics";
    FIXED_RESISTOR = "MBG0307", "a resistor law that fits one causality only, and not the one required";
    DISPLACEMENT = "MBG0309", "a displacement whose rate is not that of the flows";
    SINGULAR_JUNCTIONS = "MBG0401", "a junction structure that leaves variables undetermined";
    NONLINEAR_LOOP = "MBG0402", "a nonlinear algebraic loop that does not determine its variables";
    ORDER_LOST_UNSUPPORTED = "MBG0403", "a true loss of order, which is accepted but not supported yet";
    SINGULAR_START = "MBG0404", "a model that starts where something it divides by is zero";
    UNUSED_START = "MBG0405", "a value for the start that is not kept";
    OPEN_RING = "MBG0406", "joints of a ring that do not meet, or a loop that is open, at the start";
    MISSING_PORT = "MBG0407", "a storage that a motion changes, and which does no work on it";
    NO_BODY = "MBG0408", "an inertia that no body has";
    LOST_IMPULSE = "MBG0409", "a law of time that jumps, and which storages follow";
    UNKNOWN_MOTION = "MBG0410", "geometry that moves inertia, by a rate that no flow knows";
    GROUND_ABOVE = "MBG0411", "a ground that is above what it holds";
    TURNING_AXES = "MBG0412", "an inertia in axes that turn, whose momentum nothing turns";
    UNIT_MISMATCH = "MBG0501", "units that do not agree";
    UNIT_NAME = "MBG0502", "a name that is no unit of SI";
    UNIT_SCALE = "MBG0503", "a unit that would scale values";
    TOO_LARGE = "MBG0601", "a model over the size limit";
}
