//! The casters' edges, first as they were cut, and by clump once culling leaves out most of them.

/// An edge with two of its faces. An edge with more faces is repeated as often as needed.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    pub(super) sides: [FaceSide; 2],
}

/// The group of a face, and its direction along the edge in the lowest bit: 1 against it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceSide(u32);

impl FaceSide {
    pub(super) fn new(group: u32, against: bool) -> FaceSide {
        FaceSide(group << 1 | u32::from(against))
    }

    /// The index of its change under a sun.
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }

    pub(super) fn group(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(super) fn is_other_side_of(self, other: FaceSide) -> bool {
        self.0 ^ 1 == other.0
    }
}

/// Edges, and the clump of each. Edges between two clumps have the index after the last.
#[derive(Default)]
pub(super) struct ClumpEdges {
    pub(super) edges: Vec<Edge>,
    clumps: Vec<u32>,
}

impl ClumpEdges {
    pub(super) fn with_capacity(count: usize) -> ClumpEdges {
        ClumpEdges { edges: Vec::with_capacity(count), clumps: Vec::with_capacity(count) }
    }

    pub(super) fn push(&mut self, edge: Edge, clump: u32) {
        self.edges.push(edge);
        self.clumps.push(clump);
    }
}

/// All edges. Sorting them takes as long as projecting all for one sun, so it is not done before it pays.
pub(super) enum CasterEdges {
    /// In the mesh's order.
    AsCut(Vec<ClumpEdges>),
    /// By clump; last those between two clumps.
    Sorted {
        edges: Vec<Edge>,
        /// The first edge of each clump, and of those between two; one entry more.
        first: Vec<u32>,
    },
}

impl CasterEdges {
    /// Sorts the edges by clump.
    pub(super) fn sort(&mut self, clumps: usize) {
        let CasterEdges::AsCut(runs) = self else { return };
        let mut first = vec![0; clumps + 2];
        for clump in runs.iter().flat_map(|run| &run.clumps) {
            first[*clump as usize + 1] += 1;
        }
        for at in 1..first.len() {
            first[at] += first[at - 1];
        }
        let mut next = first.clone();
        let none = Edge { ends: [0; 2], sides: [FaceSide::new(0, false); 2] };
        let mut edges = vec![none; runs.iter().map(|run| run.edges.len()).sum()];
        for run in std::mem::take(runs) {
            for (edge, clump) in run.edges.into_iter().zip(run.clumps) {
                let slot = &mut next[clump as usize];
                edges[*slot as usize] = edge;
                *slot += 1;
            }
        }
        *self = CasterEdges::Sorted { edges, first };
    }

    /// The edges of some of the clumps, and those between two clumps. Before they are sorted, all of them: under a sun
    /// that the others do not reach from, these change nothing.
    pub(super) fn of(&self, reaching: &[u32], clumps: usize) -> Vec<&[Edge]> {
        let (edges, first) = match self {
            CasterEdges::AsCut(runs) => return runs.iter().map(|run| &run.edges[..]).collect(),
            CasterEdges::Sorted { edges, first } => (edges, first),
        };
        let of_clump = |clump: u32| first[clump as usize] as usize..first[clump as usize + 1] as usize;
        let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
        for range in reaching.iter().copied().chain([clumps as u32]).map(of_clump) {
            match ranges.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => ranges.push(range),
            }
        }
        ranges.into_iter().map(|range| &edges[range]).collect()
    }
}
