//! Blocks of block diagrams, and what is written here instead.

/// What keeps values from sample to sample.
const CLOCKED: &str = "what has a clock runs outside: give what it puts out by an `input`, which stays over each step of `Rk4::step` \
                       or is a `Constant` of one run a period";

/// What is remembered between events.
const REMEMBERED: &str = "what remembers where it came from is an `input` that stays between two events: `Integrator::until` finds where \
                          it changes";

/// What blocks are called, without regard to capitals and underscores, and what is written here, with `@` for their names.
const BLOCKS: &[(&[&str], &str)] = &[
    (
        &["pid", "pi", "pd", "pidcontroller", "limpid", "controller"],
        "`integral @_sum = u; integral @_late = (u - @_late) / 1e-3; let @ = kp * u + ki * @_sum + kd * (u - @_late) / 1e-3;`",
    ),
    (&["gain", "proportional", "amplifier"], "`let @ = 2.0 * u;`"),
    (
        &["sum", "add", "subtract", "feedback", "summer", "adder"],
        "`let @ = u - v;`",
    ),
    (&["product", "multiply"], "`let @ = u * v;`"),
    (&["integrator"], "`integral @ = u, initial: 0.0;`"),
    (
        &["differentiator", "derivativeblock"],
        "`integral @_late = (u - @_late) / 1e-3; let @ = (u - @_late) / 1e-3;`",
    ),
    (
        &["transferfunction", "transferfcn", "tf", "zeropole", "zpk"],
        "`integral @_x[2] = [@_x[1], u - a0 * @_x[0] - a1 * @_x[1]]; let @ = b0 * @_x[0] + b1 * @_x[1];` for (b1 s + b0) / (s² + a1 s + a0)",
    ),
    (
        &["statespace", "ss"],
        "`integral @_x[2] = [[a, b], [c, d]] * @_x + [e, f] * u; let @ = transpose([g, h]) * @_x;`",
    ),
    (
        &["lowpass", "firstorder", "pt1", "lag", "lowpassfilter"],
        "`integral @ = (u - @) / 0.1;`",
    ),
    (
        &["saturation", "limiter", "clamp"],
        "`let @ = min(max(u, -1.0), 1.0);`",
    ),
    (
        &["deadzone", "deadband"],
        "`let @ = max(u - 0.1, 0.0) + min(u + 0.1, 0.0);`",
    ),
    (
        &["ratelimiter", "slewratelimiter"],
        "`integral @ = min(max((u - @) / 1e-3, -1.0), 1.0);`",
    ),
    (
        &["quantizer", "quantiser", "quantize", "quantise"],
        "`let @ = 0.1 * floor(u / 0.1 + 0.5);`",
    ),
    (&["relay", "hysteresis", "schmitttrigger"], REMEMBERED),
    (
        &[
            "unitdelay",
            "memory",
            "previous",
            "prev",
            "pre",
            "zeroorderhold",
            "zoh",
            "sampler",
            "discretetransferfcn",
            "discretetransferfunction",
            "discretestatespace",
            "discretepid",
        ],
        CLOCKED,
    ),
    (
        &["delay", "transportdelay", "fixeddelay", "timedelay"],
        "`integral @ = (u - @) / 0.1;`, a lag of first order, since nothing keeps values of the past, or delay the value outside and \
         give it by an `input`",
    ),
    (
        &["scope", "display", "toworkspace", "outport"],
        "`output @ = u;`",
    ),
    (
        &[
            "speedsensor",
            "currentsensor",
            "voltagesensor",
            "forcesensor",
            "torquesensor",
            "pressuresensor",
            "anglesensor",
            "positionsensor",
            "effortsensor",
            "flowsensor",
            "sensor",
            "de",
            "df",
        ],
        "`output @ = ….f;`, or `….e`: what a junction or an element has is read without a sensor",
    ),
    (&["inport", "fromworkspace", "signalbuilder"], "`input @;`"),
    (
        &["pwm", "pulse", "pulsegenerator", "squarewave"],
        "`let @ = if mod(t, 1e-3) < 0.5 * 1e-3 { 1.0 } else { 0.0 };`",
    ),
    (&["constant", "constantblock"], "`let @ = 1.0;`"),
    (&["sine", "sinewave"], "`let @ = 2.0 * sin(3.0 * t);`"),
    (&["ramp"], "`let @ = max(t - 1.0, 0.0);`"),
    (
        &["lookuptable", "combitable1d", "combitable1ds"],
        "`let @ = interpolate(u, [0.0, 1.0], [0.0, 2.0]);`",
    ),
];

/// What to type for a block, whose value has this name.
pub(crate) fn block(block: &str, name: &str) -> Option<String> {
    let block = block.to_lowercase().replace('_', "");
    let mut blocks = BLOCKS.iter();
    let (_, text) = blocks.find(|(names, _)| names.contains(&block.as_str()))?;
    if !text.starts_with('`') {
        return Some((*text).to_owned());
    }
    let goes_in = match text.contains(" u") {
        true => ", with what goes in as `u`",
        false => "",
    };
    let text = text.replace('@', name);
    Some(format!("signals are values: write {text}{goes_in}"))
}
