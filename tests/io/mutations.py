"""Changes of a file's bytes as disks, networks and mistaken copies make them."""

import numpy as np


def mutated(content: bytes, generator: np.random.Generator) -> bytes:
    """The content with one change of one kind; never the same content."""
    changes = (flipped, cut, doubled, swapped, overwritten, enlarged)
    while True:
        changed = changes[generator.integers(len(changes))](content, generator)
        if changed != content:
            return changed


def flipped(content: bytes, generator: np.random.Generator) -> bytes:
    """One to three bits, at the ends as often as in the middle: there stands what describes the rest."""
    data = bytearray(content)
    for _ in range(generator.integers(1, 4)):
        data[_place(len(data), generator)] ^= 1 << int(generator.integers(8))
    return bytes(data)


def cut(content: bytes, generator: np.random.Generator) -> bytes:
    """Bytes missing in the middle or at the end."""
    start = _place(len(content), generator)
    length = int(generator.integers(1, len(content))) if generator.random() < 0.5 else int(generator.integers(1, 64))
    return content[:start] + content[start + length :]


def doubled(content: bytes, generator: np.random.Generator) -> bytes:
    """A stretch that stands there twice."""
    start, stop = sorted(generator.integers(0, len(content), 2).tolist())
    return content[:stop] + content[start:]


def swapped(content: bytes, generator: np.random.Generator) -> bytes:
    """Two neighbouring stretches in the other order."""
    first, middle, last = sorted(generator.integers(0, len(content), 3).tolist())
    return content[:first] + content[middle:last] + content[first:middle] + content[last:]


def overwritten(content: bytes, generator: np.random.Generator) -> bytes:
    """A block of zeros, of ones, or of anything, as of a bad sector."""
    start, length = _place(len(content), generator), int(generator.choice([1, 2, 8, 512, 4096]))
    block = [bytes(length), b"\xff" * length, generator.bytes(length)][generator.integers(3)]
    return (content[:start] + block + content[start + length :])[: len(content)]


def enlarged(content: bytes, generator: np.random.Generator) -> bytes:
    """A number of four or eight bytes that says: very large."""
    start, size = _place(len(content) - 8, generator), int(generator.choice([4, 8]))
    number = int(generator.choice([2**31 - 1, 2**32 - 1, 2**31])) if size == 4 else 2 ** int(generator.integers(33, 63))
    return content[:start] + number.to_bytes(size, "little") + content[start + size :]


def _place(length: int, generator: np.random.Generator) -> int:
    near = int(generator.integers(0, min(length, 4096)))
    return [near, length - 1 - near, int(generator.integers(0, length))][generator.integers(3)]
