//! Stage 4a, network: the junction structure in the form that is cheapest to compute.
//!
//! Input: the [`BondGraph`]. Output: a [`Network`] with the same relation between the ports. A transformer by a
//! product becomes transformers in a row, the gimbals' Jacobian becomes its three frames, equal junctions that touch
//! become one, and **a rotation that two branches of a junction share slides through the junction**: what is summed
//! before the rotation is summed after it, in the turned frame, and one rotation is saved. That rule is the theorem
//! of Tod et al. (2013), eq. (5) = eq. (11): it turns the joint of their Fig. 6 into the three revolutes of Fig. 7.
//! No error is reported here.

use std::ops::Range;

use crate::graph::{BondGraph, ElementId, End, JunctionKind, Law};
use crate::symbolic::{Expression, Factor, Matrix, Pool};

/// A vector of efforts and flows. Positive power goes from its tail to its head.
#[derive(Clone, Debug)]
pub struct Wire {
    /// Number of components.
    pub dimension: usize,
}

/// A wire at a junction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// Which wire.
    pub wire: usize,
    /// Components of the junction that it takes part in.
    pub range: Range<usize>,
    /// Whether positive power goes into the junction.
    pub inward: bool,
}

/// An array of scalar junctions.
#[derive(Clone, Debug)]
pub struct Junction {
    /// Zero or one.
    pub kind: JunctionKind,
    /// Number of scalar junctions.
    pub dimension: usize,
    /// What is bonded to it.
    pub branches: Vec<Branch>,
}

/// A two-port with one matrix.
#[derive(Clone, Debug)]
pub struct TwoPort {
    /// `f_out = M f_in`, or `e_out = M f_in` for a gyrator.
    pub factor: Factor,
    /// Whether it is a gyrator.
    pub gyrator: bool,
    /// Wire whose head it is.
    pub input: usize,
    /// Wire whose tail it is.
    pub output: usize,
}

/// A one-port.
#[derive(Clone, Debug)]
pub struct OnePort {
    /// The element.
    pub element: ElementId,
    /// Its wire.
    pub wire: usize,
    /// Whether positive power goes into it.
    pub inward: bool,
}

/// A junction structure with its ports.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Wires.
    pub wires: Vec<Wire>,
    /// Junctions; the first ones are those of the graph, and one that was merged has no branches.
    pub junctions: Vec<Junction>,
    /// Where the graph's junctions went, by number.
    pub place: Vec<usize>,
    /// Two-ports.
    pub two_ports: Vec<TwoPort>,
    /// One-ports by element.
    pub one_ports: Vec<Option<OnePort>>,
    /// For each closure the wire that leaves one end and the wire that arrives at the other.
    pub closures: Vec<[usize; 2]>,
}

impl Network {
    /// Builds and simplifies.
    #[must_use]
    pub fn of(graph: &BondGraph, pool: &mut Pool) -> Self {
        let mut network = Self::drawn(graph);
        network.expand_jacobians();
        while network.merge_once() || network.slide_once(pool) {}
        network
    }

    /// As drawn, with products split.
    fn drawn(graph: &BondGraph) -> Self {
        let junction = |junction: &crate::graph::Junction| Junction {
            kind: junction.kind,
            dimension: junction.dimension,
            branches: Vec::new(),
        };
        let mut network = Self {
            wires: graph
                .bonds
                .iter()
                .map(|bond| Wire {
                    dimension: bond.dimension,
                })
                .collect(),
            junctions: graph.junctions.iter().map(junction).collect(),
            place: (0..graph.junctions.len()).collect(),
            two_ports: Vec::new(),
            one_ports: vec![None; graph.elements.len()],
            closures: graph
                .closures
                .iter()
                .map(|closure| closure.bonds.map(|bond| bond.0))
                .collect(),
        };
        let mut sides = vec![[0usize; 2]; graph.elements.len()];
        for (wire, bond) in graph.bonds.iter().enumerate() {
            for (end, inward) in [(&bond.from, false), (&bond.to, true)] {
                match end {
                    End::Junction(id, range) => {
                        network.junctions[id.0].branches.push(Branch {
                            wire,
                            range: range.clone(),
                            inward,
                        });
                    }
                    End::OnePort(id) => {
                        network.one_ports[id.0] = Some(OnePort {
                            element: *id,
                            wire,
                            inward,
                        })
                    }
                    End::In(id) => sides[id.0][0] = wire,
                    End::Out(id) => sides[id.0][1] = wire,
                    End::Border => {}
                }
            }
        }
        for (element, [input, output]) in graph.elements.iter().zip(sides) {
            network.split(&element.law, input, output);
        }
        network
    }

    fn wire(&mut self, dimension: usize) -> usize {
        self.wires.push(Wire { dimension });
        self.wires.len() - 1
    }

    /// `A B` is B followed by A. In a gyrator only the last factor gyrates.
    fn split(&mut self, law: &Law, input: usize, output: usize) {
        let (product, gyrator) = match law {
            Law::Transformer(product) => (product, false),
            Law::Gyrator(product) => (product, true),
            _ => return,
        };
        let mut input = input;
        for (position, factor) in product.factors.iter().enumerate().rev() {
            let last = position == 0;
            let next = if last {
                output
            } else {
                self.wire(rows(factor))
            };
            self.two_ports.push(TwoPort {
                factor: factor.clone(),
                gyrator: gyrator && last,
                input,
                output: next,
            });
            input = next;
        }
    }

    /// `J a = e_i a₀ + R_i (e_j a₁ + R_j e_k a₂)`, as a network of 0-junctions, one per frame.
    fn expand_jacobians(&mut self) {
        for index in 0..self.two_ports.len() {
            let two_port = self.two_ports[index].clone();
            let Factor::GimbalJacobian {
                axes,
                angles,
                transposed: false,
            } = two_port.factor
            else {
                continue;
            };
            if two_port.gyrator {
                continue;
            }
            let branch = |wire, range, inward| Branch {
                wire,
                range,
                inward,
            };
            let rates: [usize; 3] = [0, 1, 2].map(|_| self.wire(1));
            let mut split = vec![branch(two_port.input, 0..3, true)];
            split.extend((0..3).map(|gimbal| branch(rates[gimbal], gimbal..gimbal + 1, false)));
            self.junctions.push(Junction {
                kind: JunctionKind::One,
                dimension: 3,
                branches: split,
            });
            let into_middle = [self.wire(3), self.wire(3)];
            let into_outer = [self.wire(3), self.wire(3)];
            let outgoing = [two_port.output, into_outer[0], into_middle[0]];
            let arriving = [Some(into_outer[1]), Some(into_middle[1]), None];
            for (gimbal, axis) in axes.into_iter().enumerate() {
                let mut branches = vec![
                    branch(rates[gimbal], axis..axis + 1, true),
                    branch(outgoing[gimbal], 0..3, false),
                ];
                branches.extend(arriving[gimbal].map(|wire| branch(wire, 0..3, true)));
                self.junctions.push(Junction {
                    kind: JunctionKind::Zero,
                    dimension: 3,
                    branches,
                });
            }
            let turn = |gimbal: usize, [input, output]: [usize; 2]| TwoPort {
                factor: Factor::Rotation {
                    axis: axes[gimbal],
                    angle: angles[gimbal],
                },
                gyrator: false,
                input,
                output,
            };
            self.two_ports[index] = turn(0, into_outer);
            self.two_ports.push(turn(1, into_middle));
        }
    }

    /// The two junctions that a wire joins, whole to whole.
    fn direct(&self) -> Option<(usize, usize, usize)> {
        let mut ends: Vec<Vec<usize>> = vec![Vec::new(); self.wires.len()];
        for (index, junction) in self.junctions.iter().enumerate() {
            for branch in &junction.branches {
                if branch.range == (0..junction.dimension) {
                    ends[branch.wire].push(index);
                }
            }
        }
        ends.iter()
            .enumerate()
            .find_map(|(wire, ends)| match ends[..] {
                [a, b] if a != b && self.junctions[a].kind == self.junctions[b].kind => {
                    Some((wire, a.min(b), a.max(b)))
                }
                _ => None,
            })
    }

    /// Two junctions of one kind joined by a wire are one junction.
    fn merge_once(&mut self) -> bool {
        let Some((wire, keep, gone)) = self.direct() else {
            return false;
        };
        let moved = std::mem::take(&mut self.junctions[gone].branches);
        self.junctions[keep].branches.extend(moved);
        self.junctions[keep]
            .branches
            .retain(|branch| branch.wire != wire);
        for place in &mut self.place {
            if *place == gone {
                *place = keep;
            }
        }
        true
    }

    /// Moves one rotation that two branches share to the other side of their junction.
    fn slide_once(&mut self, pool: &Pool) -> bool {
        for index in 0..self.junctions.len() {
            let turns: Vec<(usize, usize, (usize, Expression))> = self.outward_turns(index);
            for (position, first) in turns.iter().enumerate() {
                let second = turns[position + 1..].iter().find(|turn| {
                    turn.2.0 == first.2.0 && pool.image(turn.2.1) == pool.image(first.2.1)
                });
                if let Some(second) = second {
                    self.slide(index, first, second);
                    return true;
                }
            }
        }
        false
    }

    /// Branches of a junction that lead to a rotation: branch, two-port, and the rotation seen outwards.
    fn outward_turns(&self, junction: usize) -> Vec<(usize, usize, (usize, Expression))> {
        let whole = 0..self.junctions[junction].dimension;
        let mut turns = Vec::new();
        for (position, branch) in self.junctions[junction].branches.iter().enumerate() {
            if branch.range != whole {
                continue;
            }
            for (index, two_port) in self.two_ports.iter().enumerate() {
                let Factor::Rotation { axis, angle } = two_port.factor else {
                    continue;
                };
                if two_port.gyrator {
                    continue;
                }
                if !branch.inward && two_port.input == branch.wire {
                    turns.push((position, index, (axis, angle)));
                } else if branch.inward && two_port.output == branch.wire {
                    turns.push((position, index, (axis, angle.negated())));
                }
            }
        }
        turns
    }

    fn slide(
        &mut self,
        junction: usize,
        first: &(usize, usize, (usize, Expression)),
        second: &(usize, usize, (usize, Expression)),
    ) {
        let mut beyond = Vec::new();
        for (position, two_port, _) in [first, second] {
            let inward = self.junctions[junction].branches[*position].inward;
            let two_port = &self.two_ports[*two_port];
            let wire = if inward {
                two_port.input
            } else {
                two_port.output
            };
            beyond.push(Branch {
                wire,
                range: 0..3,
                inward,
            });
        }
        let (before, after) = (self.wire(3), self.wire(3));
        let (axis, angle) = first.2;
        self.two_ports[first.1] = TwoPort {
            factor: Factor::Rotation { axis, angle },
            gyrator: false,
            input: before,
            output: after,
        };
        self.two_ports.remove(second.1);
        let branches = &mut self.junctions[junction].branches;
        branches[first.0] = Branch {
            wire: before,
            range: 0..3,
            inward: false,
        };
        branches.remove(second.0);
        let kind = self.junctions[junction].kind;
        beyond.insert(
            0,
            Branch {
                wire: after,
                range: 0..3,
                inward: true,
            },
        );
        self.junctions.push(Junction {
            kind,
            dimension: 3,
            branches: beyond,
        });
    }
}

fn rows(factor: &Factor) -> usize {
    match factor {
        Factor::Dense(Matrix { rows, .. }) => *rows,
        _ => 3,
    }
}
