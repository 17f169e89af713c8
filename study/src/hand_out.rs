//! Which rank computes which block: what is known of it without messages.
//!
//! A rank says that it asks, that it has kept its block, or that it leaves. A block that a rank leaves without having kept it waits again, at
//! the end: what no rank can write must not keep the others from the rest. A rank is let go when no block waits and none is held elsewhere,
//! since one that is held may come back; until then it waits for its answer.

use std::collections::{BTreeMap, VecDeque};

/// What a rank says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Said {
    /// It is there, and holds nothing.
    Asks,
    /// It has kept the block that it was given.
    Kept,
    /// It computes nothing more, and has not kept what it holds.
    Leaves,
}

/// An answer: to which rank, and the block that it is given; none lets it go.
pub(crate) type Answer = (usize, Option<usize>);

/// Blocks that wait, and those that are held.
#[derive(Debug)]
pub(crate) struct HandOut {
    waiting: VecDeque<usize>,
    /// The block of each rank that computes.
    held: BTreeMap<usize, usize>,
    /// Ranks without an answer.
    idle: VecDeque<usize>,
    /// Ranks that are not let go.
    there: usize,
    stopped: bool,
}

impl HandOut {
    /// Of these blocks to so many ranks.
    pub(crate) fn new(blocks: Vec<usize>, ranks: usize) -> Self {
        Self {
            waiting: blocks.into(),
            held: BTreeMap::new(),
            idle: VecDeque::new(),
            there: ranks,
            stopped: false,
        }
    }

    /// Nothing more is handed out.
    pub(crate) fn stop(&mut self) {
        self.stopped = true;
    }

    /// The block that a rank holds.
    pub(crate) fn held(&self, rank: usize) -> Option<usize> {
        self.held.get(&rank).copied()
    }

    /// Hears a rank: the answers that can be given now, to this rank and to others that wait.
    pub(crate) fn hear(&mut self, rank: usize, said: Said) -> Vec<Answer> {
        let block = self.held.remove(&rank);
        let mut answers = Vec::new();
        match said {
            Said::Asks | Said::Kept => self.idle.push_back(rank),
            Said::Leaves => answers.push((rank, None)),
        }
        self.waiting.extend(block.filter(|_| said != Said::Kept));
        while !self.stopped
            && !self.idle.is_empty()
            && let Some(block) = self.waiting.pop_front()
            && let Some(rank) = self.idle.pop_front()
        {
            self.held.insert(rank, block);
            answers.push((rank, Some(block)));
        }
        if self.stopped || self.held.is_empty() {
            answers.extend(self.idle.drain(..).map(|rank| (rank, None)));
        }
        self.there -= answers.iter().filter(|(_, block)| block.is_none()).count();
        answers
    }

    /// Whether all ranks are let go.
    pub(crate) fn is_over(&self) -> bool {
        self.there == 0
    }

    /// Whether blocks are left that nobody has kept.
    pub(crate) fn is_left(&self) -> bool {
        !self.waiting.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chacha20::ChaCha8Rng;
    use rand::{Rng, SeedableRng};

    #[test]
    fn the_block_of_a_rank_that_fails_is_handed_out_again() {
        let mut out = HandOut::new(vec![4, 7], 3);
        assert_eq!(out.hear(1, Said::Asks), [(1, Some(4))]);
        assert_eq!(out.hear(2, Said::Asks), [(2, Some(7))]);
        // Nothing waits, and both blocks may come back.
        assert_eq!(out.hear(3, Said::Asks), []);
        assert_eq!(out.hear(1, Said::Leaves), [(1, None), (3, Some(4))]);
        assert_eq!(out.hear(2, Said::Kept), []);
        assert_eq!(out.held(3), Some(4));
        assert_eq!(out.hear(3, Said::Kept), [(2, None), (3, None)]);
        assert!(out.is_over() && !out.is_left());
    }

    #[test]
    fn ranks_without_a_folder_are_let_go_and_what_is_left_is_known() {
        let mut out = HandOut::new(vec![0], 2);
        assert_eq!(out.hear(2, Said::Leaves), [(2, None)]);
        assert_eq!(out.hear(1, Said::Asks), [(1, Some(0))]);
        assert_eq!(out.hear(1, Said::Leaves), [(1, None)]);
        assert!(out.is_over() && out.is_left());
        // Rank 0 has none itself: it hands out nothing.
        let mut out = HandOut::new(Vec::new(), 2);
        assert_eq!(out.hear(1, Said::Asks), [(1, None)]);
        assert_eq!(out.hear(2, Said::Leaves), [(2, None)]);
        assert!(out.is_over());
    }

    #[test]
    fn all_are_let_go_when_it_is_stopped() {
        let mut out = HandOut::new(vec![0, 1], 3);
        for (rank, block) in [(1, 0), (2, 1)] {
            assert_eq!(out.hear(rank, Said::Asks), [(rank, Some(block))]);
        }
        assert_eq!(out.hear(3, Said::Asks), []);
        out.stop();
        assert_eq!(out.hear(2, Said::Leaves), [(2, None), (3, None)]);
        assert_eq!(out.hear(1, Said::Kept), [(1, None)]);
        assert!(out.is_over() && out.is_left());
    }

    /// Ranks that speak in any order and fail at any time: every block is kept once while a rank is there, and no rank waits for ever.
    #[test]
    fn every_block_is_kept_by_somebody_whoever_fails() {
        for seed in 0..300 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let ranks = 1 + random.next_u32() as usize % 6;
            let count = random.next_u32() as usize % 20;
            let mut out = HandOut::new((0..count).collect(), ranks);
            let mut kept = vec![0; count];
            let mut speaks: Vec<(usize, Option<usize>)> =
                (1..=ranks).map(|rank| (rank, None)).collect();
            let mut survivors = ranks;
            while !speaks.is_empty() {
                let place = random.next_u32() as usize % speaks.len();
                let (rank, block) = speaks.swap_remove(place);
                let fails = random.next_u32().is_multiple_of(8) && survivors > 1;
                let said = match block {
                    _ if fails => Said::Leaves,
                    Some(_) => Said::Kept,
                    None => Said::Asks,
                };
                survivors -= usize::from(fails);
                assert_eq!(out.held(rank), block);
                if let (Said::Kept, Some(block)) = (said, block) {
                    kept[block] += 1;
                }
                let answers = out.hear(rank, said).into_iter();
                speaks.extend(answers.filter(|(_, block)| block.is_some()));
            }
            assert!(out.is_over() && !out.is_left(), "{seed}");
            assert!(kept.iter().all(|&times| times == 1), "{seed}: {kept:?}");
        }
    }
}
