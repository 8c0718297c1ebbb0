//! Which things belong together: disjoint sets (union by smaller root, paths halved).

/// A partition of the numbers 0..n.
#[derive(Clone, Debug)]
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// `n` sets of one member each.
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    /// The smallest member of the set of `i`.
    #[inline]
    pub(crate) fn root(&mut self, i: usize) -> usize {
        let mut i = i;
        while self.parent[i] as usize != i {
            self.parent[i] = self.parent[self.parent[i] as usize];
            i = self.parent[i] as usize;
        }
        i
    }

    /// True of many that are in one set, and of none that are not.
    #[inline]
    pub(crate) fn seem_one(&self, a: usize, b: usize) -> bool {
        self.parent[a] == self.parent[b]
    }

    /// Makes the sets of `a` and `b` one.
    #[inline]
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }
}
