//! Irreducible blocks in order of computation (Tarjan 1972), with a stack of its own.

/// Equations of each block; every block needs only unknowns of earlier ones and its own. Equations in a block ascend.
#[must_use]
pub fn ordered(incidence: &[Vec<usize>], unknown_of: &[usize]) -> Vec<Vec<usize>> {
    let mut equation_of = vec![usize::MAX; unknown_of.len()];
    for (equation, unknown) in unknown_of.iter().enumerate() {
        equation_of[*unknown] = equation;
    }
    let mut search = Search {
        incidence,
        equation_of: &equation_of,
        index: vec![usize::MAX; incidence.len()],
        low: vec![0; incidence.len()],
        open: vec![false; incidence.len()],
        stack: Vec::new(),
        blocks: Vec::new(),
        next: 0,
    };
    for equation in 0..incidence.len() {
        if search.index[equation] == usize::MAX {
            search.from(equation);
        }
    }
    search.blocks
}

struct Search<'a> {
    incidence: &'a [Vec<usize>],
    equation_of: &'a [usize],
    index: Vec<usize>,
    low: Vec<usize>,
    open: Vec<bool>,
    stack: Vec<usize>,
    blocks: Vec<Vec<usize>>,
    next: usize,
}

impl Search<'_> {
    fn enter(&mut self, equation: usize) {
        self.index[equation] = self.next;
        self.low[equation] = self.next;
        self.next += 1;
        self.stack.push(equation);
        self.open[equation] = true;
    }

    fn from(&mut self, start: usize) {
        let mut path = vec![(start, 0)];
        self.enter(start);
        while let Some(&mut (equation, ref mut position)) = path.last_mut() {
            if let Some(&unknown) = self.incidence[equation].get(*position) {
                *position += 1;
                let next = self.equation_of[unknown];
                if self.index[next] == usize::MAX {
                    self.enter(next);
                    path.push((next, 0));
                } else if self.open[next] {
                    self.low[equation] = self.low[equation].min(self.index[next]);
                }
                continue;
            }
            path.pop();
            if let Some(&(parent, _)) = path.last() {
                self.low[parent] = self.low[parent].min(self.low[equation]);
            }
            if self.low[equation] == self.index[equation] {
                self.close(equation);
            }
        }
    }

    fn close(&mut self, equation: usize) {
        let mut block = Vec::new();
        while let Some(member) = self.stack.pop() {
            self.open[member] = false;
            block.push(member);
            if member == equation {
                break;
            }
        }
        block.sort_unstable();
        self.blocks.push(block);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_blocks_by_need() {
        // Equation 0 gives unknown 0 and needs 1; equations 1 and 2 form a loop of unknowns 1 and 2.
        let incidence = [vec![0, 1], vec![1, 2], vec![1, 2]];
        assert_eq!(ordered(&incidence, &[0, 1, 2]), vec![vec![1, 2], vec![0]]);
    }
}
