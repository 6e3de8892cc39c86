//! Models with sparse Jacobians, and one without its plan of elimination.

use mbg_runtime::{Meta, Power, Real, System, Trouble, mbg};
use nalgebra::{SMatrix, SVector};

mbg! {
    /// A diode, without the limit that the library's sets to the exponential.
    component RingDiode(port branch) {
        branch -> R junction { flow: 40.67286402e-9 * (exp(17.7493332 * e) - 1.0) };
    }

    /// A coil with its loss.
    component Winding(port from, port to) {
        param inductance;
        param resistance;
        1 wire { I coil { inertia: inductance } R loss { resistance: resistance } }
        from -> wire;
        wire -> to;
    }

    /// The ring modulator: problem `ringmod` of the *Test Set for Initial Value Problem Solvers* (Mazzia and Magherini,
    /// University of Bari), with capacitors of 2 pF in the ring.
    pub model RingModulator {
        let signal = 0.5 * sin(6283.185307179586 * t);
        let carrier = 2.0 * sin(62831.85307179586 * t);
        0 ground { Se earth { effort: 0.0 } }
        0 source { Se input { effort: signal } }
        0 y1 { C c1 { compliance: 1.6e-8 } R r1 { resistance: 25000.0 } I l1 { inertia: 4.45 } }
        0 y2 { C c2 { compliance: 1.6e-8 } R r2 { resistance: 25000.0 } I l2 { inertia: 4.45 } }
        0 y3 { C c3 { compliance: 2e-12 } }
        0 y4 { C c4 { compliance: 2e-12 } }
        0 y5 { C c5 { compliance: 2e-12 } }
        0 y6 { C c6 { compliance: 2e-12 } }
        0 y7 { C c7 { compliance: 1e-8 } R r7 { resistance: 50.0 } }
        // Both halves of each transformer's winding, one of them turned round.
        0 half3; 0 half4; 0 half5; 0 half6;
        y1 -> TF turns3 { flow: 2.0 } -> half3;
        half4 -> TF turns4 { flow: 0.5 } -> y1;
        y2 -> TF turns5 { flow: 2.0 } -> half5;
        half6 -> TF turns6 { flow: 0.5 } -> y2;
        winding3: Winding { inductance: 5e-4, resistance: 17.3 } (half3, y3);
        winding4: Winding { inductance: 5e-4, resistance: 17.3 } (y4, half4);
        winding5: Winding { inductance: 5e-4, resistance: 17.3 } (half5, y5);
        winding6: Winding { inductance: 5e-4, resistance: 17.3 } (y6, half6);
        feed: Winding { inductance: 2e-3, resistance: 86.3 } (source, y1);
        drain: Winding { inductance: 2e-3, resistance: 636.3 } (ground, y2);
        // The ring.
        1 d1 { Se u1 { effort: -carrier } }
        y3 -> d1; d1 -> y5; d1 -> y7;
        1 d2 { Se u2 { effort: -carrier } }
        y6 -> d2; d2 -> y4; d2 -> y7;
        1 d3 { Se u3 { effort: carrier } }
        y4 -> d3; y5 -> d3; y7 -> d3;
        1 d4 { Se u4 { effort: carrier } }
        y7 -> d4; d4 -> y3; d4 -> y6;
        diode1: RingDiode {} (d1);
        diode2: RingDiode {} (d2);
        diode3: RingDiode {} (d3);
        diode4: RingDiode {} (d4);
    }

    /// A chain of sixteen rods on hinges, free at one end.
    #[derivative]
    pub model Chain {
        gravity [0.0, -9.81];
        let count = 16;
        ends: for k in 0..count + 1 { 1 end[3]; }
        Sf fixed[3] { flow: 0.0 } -> ends[0].end;
        rods: for k in 0..count {
            1 foot[3]; 1 middle[3];
            hinge: PlanarRevolute { initial: 0.3 } (ends[k].end, foot);
            half: PlanarOffset { x: 0.5 } (foot, middle);
            body: PlanarBody { mass: 1.0, inertia: 1.0 / 12 } (middle);
            rod: PlanarOffset { x: 1.0 } (foot, ends[k+1].end);
        }
    }

    /// Sixteen masses in a row between springs and dampers.
    pub model Row {
        let count = 16;
        masses: for k in 0..count { 1 mass { I body { inertia: 1.0 } } }
        springs: for k in 0..count - 1 {
            0 force; 1 stretch { C spring { stiffness: 1e4 } R damper { resistance: 1.0 } }
            masses[k].mass -> force; force -> masses[k+1].mass; force -> stretch;
        }
        Se push { effort: sin(t) } -> masses[0].mass;
    }
}

/// Voltages of the ring modulator's nodes at 1 ms, published with the problem.
const RING_END: [f64; 7] = [
    -0.023_390_573_584_867_45,
    -0.007_367_485_485_540_825,
    0.258_295_670_929_116_9,
    -0.406_446_572_128_345,
    -0.403_945_566_514_979_4,
    0.260_796_676_542_294_3,
    0.110_676_186_126_997_5,
];

/// Capacitances of the ring modulator's nodes in F.
const RING_CAPACITANCES: [f64; 7] = [1.6e-8, 1.6e-8, 2e-12, 2e-12, 2e-12, 2e-12, 1e-8];

/// The state with the charge of a node of the ring modulator.
fn ring_charge(node: usize) -> Option<usize> {
    let name = format!("c{}.q", node + 1);
    let states = RingModulator::<f64>::META.states;
    states.iter().position(|state| state.name == name)
}

/// The usual sizes of the ring modulator's states: charges at 1 V, momenta at 1 µA in the large coils and 1 mA in the
/// small ones.
pub(crate) fn ring_nominal() -> [f64; 15] {
    let states = RingModulator::<f64>::META.states;
    let mut nominal = std::array::from_fn(|state| match states[state].name {
        "l1.p" | "l2.p" => 4.45e-6,
        _ => 5e-7,
    });
    for (node, capacitance) in RING_CAPACITANCES.into_iter().enumerate() {
        if let Some(state) = ring_charge(node) {
            nominal[state] = capacitance;
        }
    }
    nominal
}

/// Largest error in V of the ring modulator's voltages at 1 ms; infinite if one is not found.
pub(crate) fn ring_error(end: &SVector<f64, 15>) -> f64 {
    let nodes = RING_END.into_iter().zip(RING_CAPACITANCES).enumerate();
    nodes.fold(0.0, |largest: f64, (node, (expected, capacitance))| {
        let voltage = ring_charge(node).map(|state| end[state] / capacitance);
        largest.max(voltage.map_or(f64::INFINITY, |found| (found - expected).abs()))
    })
}

/// A system that is taken for dense.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dense<S>(pub S);

impl<T, S, const N: usize, const M: usize, const P: usize> System<T, N, M, P> for Dense<S>
where
    T: Real,
    S: System<T, N, M, P>,
{
    const META: &'static Meta = S::META;
    type Memory = S::Memory;
    type Conditioning = S::Conditioning;
    type Room = S::Room;

    fn initial_state(&self) -> SVector<T, N> {
        self.0.initial_state()
    }

    #[inline]
    fn derivative(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SVector<T, N> {
        self.0.derivative(t, x, u, memory)
    }

    fn output(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SVector<T, P> {
        self.0.output(t, x, u, memory)
    }

    #[inline]
    fn jacobian_state(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SMatrix<T, N, N> {
        self.0.jacobian_state(t, x, u, memory)
    }

    #[inline]
    fn derivative_and_jacobian(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> (SVector<T, N>, SMatrix<T, N, N>) {
        self.0.derivative_and_jacobian(t, x, u, memory)
    }

    fn jacobian_input(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> SMatrix<T, N, M> {
        self.0.jacobian_input(t, x, u, memory)
    }

    #[inline]
    fn derivative_time(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
        ahead: T,
    ) -> SVector<T, N> {
        self.0.derivative_time(t, x, u, memory, ahead)
    }

    fn energy(&self, t: T, x: &SVector<T, N>) -> T {
        self.0.energy(t, x)
    }

    fn power(
        &self,
        t: T,
        x: &SVector<T, N>,
        u: &SVector<T, M>,
        memory: &mut S::Memory,
    ) -> Power<T> {
        self.0.power(t, x, u, memory)
    }

    fn conditioning(&self, t: T, x: &SVector<T, N>, u: &SVector<T, M>) -> S::Conditioning {
        self.0.conditioning(t, x, u)
    }

    fn close(
        &self,
        t: T,
        x: SVector<T, N>,
        u: &SVector<T, M>,
        fixed: &[usize],
    ) -> Result<SVector<T, N>, Trouble> {
        self.0.close(t, x, u, fixed)
    }
}
