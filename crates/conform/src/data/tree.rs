//! The Merkle tree over the entries of a manifest.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A SHA-256.
type Hash = [u8; 32];

/// The Merkle tree over the recordings of a manifest: a binary tree over their places. A part of
/// the recordings has the part of the tree that its places fill, and parts merge in any order.
/// Where no recording has a place below one of a node's children, the node's hash is the hash of
/// the other child.
///
/// `docs/fleet.md` defines the hashes byte by byte.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Tree {
    /// Subtrees in which every place is taken, none of which is a sibling of another, by their
    /// first place: level and hash.
    filled: BTreeMap<u64, (u8, Hash)>,
}

/// Content of the leaf of a recording besides its place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leaf<'a> {
    pub file: &'a str,
    pub suite: &'a str,
    /// SHA-256 of the recording, in hexadecimal; empty if it has defects.
    pub sha256: &'a str,
}

impl Tree {
    /// Adds the recording at a place; returns whether the place was free.
    pub(crate) fn insert(&mut self, place: u32, leaf: Leaf) -> bool {
        let mut digest = Sha256::new();
        digest.update([0]);
        digest.update(u64::from(place).to_le_bytes());
        for part in [leaf.file, leaf.suite, leaf.sha256] {
            digest.update((part.len() as u64).to_le_bytes());
            digest.update(part);
        }
        self.insert_subtree(u64::from(place), 0, digest.finalize().into())
    }

    /// Merges the tree of other recordings; returns whether all their places were free.
    pub(crate) fn merge(&mut self, other: Self) -> bool {
        let mut filled = other.filled.into_iter();
        filled.all(|(first, (level, hash))| self.insert_subtree(first, level, hash))
    }

    /// Returns the hash of the whole tree, in lower-case hexadecimal; the hash of no bytes if there
    /// is no recording.
    pub(crate) fn root(&self) -> String {
        let mut level = 0;
        let mut nodes: Vec<(u64, u8, Hash)> =
            self.filled.iter().map(|(first, (level, hash))| (*first, *level, *hash)).collect();
        while nodes.len() > 1 {
            let mut raised: Vec<(u64, u8, Hash)> = Vec::with_capacity(nodes.len());
            for (first, own, hash) in nodes {
                let parent = first >> (level + 1) << (level + 1);
                match raised.last_mut() {
                    _ if own > level => raised.push((first, own, hash)),
                    Some(last) if last.0 == parent && last.1 == level + 1 => {
                        last.2 = node(&last.2, &hash);
                    }
                    _ => raised.push((parent, level + 1, hash)),
                }
            }
            (nodes, level) = (raised, level + 1);
        }
        let root = nodes.first().map_or_else(|| Sha256::digest([]).into(), |(_, _, hash)| *hash);
        reachtube_files::hex(&root)
    }

    /// Returns whether its subtrees belong to places, none of them of two subtrees, and joined.
    pub(crate) fn is_valid(&self) -> bool {
        let is_place = |(first, (level, _)): (&u64, &(u8, Hash))| {
            *level <= 32 && first >> level << level == *first && *first < 1 << 32
        };
        self.filled.iter().all(is_place) && {
            let mut same = Self::default();
            same.merge(self.clone()) && same == *self
        }
    }

    /// Adds a subtree and joins siblings; returns whether its places were free.
    fn insert_subtree(&mut self, mut first: u64, mut level: u8, mut hash: Hash) -> bool {
        let end = first + (1 << level);
        let before = self.filled.range(..end).next_back();
        if before.is_some_and(|(start, (own, _))| start + (1 << own) > first) {
            return false;
        }
        loop {
            let sibling = first ^ 1 << level;
            let Some((_, other)) = self.filled.get(&sibling).filter(|(own, _)| *own == level)
            else {
                break;
            };
            hash = if sibling < first { node(other, &hash) } else { node(&hash, other) };
            self.filled.remove(&sibling);
            (first, level) = (first.min(sibling), level + 1);
        }
        self.filled.insert(first, (level, hash));
        true
    }
}

fn node(left: &Hash, right: &Hash) -> Hash {
    Sha256::new().chain_update([1]).chain_update(left).chain_update(right).finalize().into()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Hash, Leaf, Tree, node};
    use sha2::{Digest, Sha256};

    fn leaf(place: u32) -> Leaf<'static> {
        Leaf { file: ["a.csv", "b.csv"][place as usize % 2], suite: "A", sha256: "00ff" }
    }

    fn tree(places: impl IntoIterator<Item = u32>) -> Tree {
        let mut tree = Tree::default();
        places.into_iter().for_each(|place| assert!(tree.insert(place, leaf(place))));
        tree
    }

    /// The hash below one node by its definition, over the places that are sorted.
    fn by_definition(places: &[u32], level: u32) -> Option<Hash> {
        let &[first, ..] = places else { return None };
        if level == 0 {
            let text = |text: &str| [&(text.len() as u64).to_le_bytes(), text.as_bytes()].concat();
            let Leaf { file, suite, sha256 } = leaf(first);
            let place = u64::from(first).to_le_bytes().to_vec();
            let bytes = [vec![0], place, text(file), text(suite), text(sha256)].concat();
            return Some(Sha256::digest(bytes).into());
        }
        let middle = places.partition_point(|place| place >> (level - 1) & 1 == 0);
        let (left, right) = places.split_at(middle);
        match (by_definition(left, level - 1), by_definition(right, level - 1)) {
            (Some(left), Some(right)) => Some(node(&left, &right)),
            (left, right) => left.or(right),
        }
    }

    proptest! {
        #[test]
        fn parts_merge_to_the_tree_of_all_in_any_order(
            places in prop::collection::btree_set(0u32..200, 1..60),
            parts in prop::collection::vec(0usize..4, 60),
        ) {
            let whole = tree(places.iter().copied());
            let mut merged = Tree::default();
            for part in [2, 0, 3, 1] {
                let mine = places.iter().zip(&parts).filter(|(_, own)| **own == part);
                assert!(merged.merge(tree(mine.map(|(place, _)| *place).rev())));
            }
            prop_assert_eq!(&merged, &whole);
            let places: Vec<u32> = places.into_iter().collect();
            let expected = by_definition(&places, 32).unwrap();
            prop_assert_eq!(whole.root(), reachtube_files::hex(&expected));
        }
    }

    /// `tools/recheck` computes the same.
    #[test]
    fn three_leaves_have_the_root_of_the_other_program() {
        let expected = "06053100f0a52edfd68bf7e71262e0c32cb4960e373e313193b0613710f66f04";
        assert_eq!(tree([5, 0, 1]).root(), expected);
    }

    #[test]
    fn a_place_is_taken_once_and_every_leaf_decides_the_root() {
        let mut whole = tree(0..1000);
        assert!(whole.filled.len() < 10 && whole.is_valid());
        let (_, forged) = whole.filled.first_key_value().unwrap();
        for level in [forged.0 + 1, 200] {
            let filled = [(0, (9, forged.1)), (512, (level, forged.1))].into();
            assert!(!Tree { filled }.is_valid());
        }
        assert!(!whole.insert(7, leaf(7)) && !whole.clone().merge(tree(999..1001)));
        assert!(!tree(4..5).merge(tree(0..8)));
        let mut other = tree(0..999);
        assert!(other.insert(999, Leaf { suite: "B", ..leaf(999) }));
        assert_ne!(whole.root(), other.root());
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(Tree::default().root(), empty);
    }
}
