"""The Merkle tree over the entries of a manifest, as docs/fleet.md defines it."""

import hashlib

LEVELS = 32


def root(entries):
    """Returns the root over (place, file, suite, sha256) of all recordings, in hexadecimal."""
    return _node(sorted(entries), LEVELS).hex()


def _node(entries, level):
    """Returns the hash over the entries below one node, whose places agree but in the last
    `level` bits."""
    if not entries:
        return hashlib.sha256().digest()
    if level == 0:
        ((place, *texts),) = entries
        leaf = hashlib.sha256(b"\0" + place.to_bytes(8, "little"))
        for text in texts:
            part = text.encode()
            leaf.update(len(part).to_bytes(8, "little") + part)
        return leaf.digest()
    halves = [], []
    for entry in entries:
        halves[entry[0] >> (level - 1) & 1].append(entry)
    if not all(halves):
        return _node(entries, level - 1)
    left, right = (_node(half, level - 1) for half in halves)
    return hashlib.sha256(b"\1" + left + right).digest()
