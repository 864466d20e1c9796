"""A mutant: one place of a source file and what stands there instead. And how mutants are drawn."""

import collections
import dataclasses
import itertools
import random

from common import hash_of

SOURCES = (".c", ".cpp", ".h")


@dataclasses.dataclass(frozen=True)
class Place:
    """What a parser found: bytes start..end are `old`; with `new` there the file is a mutant."""

    start: int
    end: int
    operator: str
    old: str
    new: str
    statement: bool = False  # it is left out; otherwise an expression, replaced


@dataclasses.dataclass(frozen=True)
class Mutant:
    """A place with its number, from 1 on in the order of the file; 0 is the file as it is."""

    number: int
    file: str
    line: int
    text: str  # of the line, without the spaces around it
    place: Place
    repeat: int = 0  # of mutants of one key, which of them

    @property
    def change(self):
        old, new = (" ".join(text.split()) for text in (self.place.old, self.place.new))
        return f"{old} => {new}" if not self.place.statement else f"without {old}"

    @property
    def key(self):
        """What a reason is written for: it outlives lines that come and go elsewhere in the file."""
        return (self.file, self.text, self.place.operator, self.change, self.repeat)


def mutants_of(file, source, places, first=1):
    """`source`: the file's bytes. `first`: the number of the first."""
    lines, found, seen = source.decode().splitlines(), [], collections.Counter()
    for number, place in enumerate(sorted(places, key=lambda p: (p.start, p.end, p.operator, p.new)), first):
        line = source.count(b"\n", 0, place.start) + 1
        plain = Mutant(number, file, line, lines[line - 1].strip(), place)
        found.append(dataclasses.replace(plain, repeat=seen[plain.key]))
        seen[plain.key] += 1
    return found


def draw(mutants, count, seed):
    """`count` of them, spread evenly over the file: one of each of `count` stretches of equal length. All of them in
    the order in which they are taken: whoever drops one takes the next of the list."""
    picks = random.Random(seed)
    count = len(mutants) if count is None else min(count, len(mutants))
    edges = [i * len(mutants) // count for i in range(count + 1)] if count else []
    first = [mutants[picks.randrange(a, b)] for a, b in itertools.pairwise(edges)]
    rest = [m for m in mutants if m not in set(first)]
    picks.shuffle(rest)
    return first, rest


def sources_of(root, module):
    """The file, or of a folder the C or C++ files in it that the module's patterns choose."""
    path = root / module.file
    if not path.is_dir():
        return [path]
    return sorted({file for pattern in module.files for file in path.glob(pattern) if file.suffix in SOURCES})


def source_hash(root, module):
    """Of what is mutated: it is stale when this differs."""
    return hash_of(*sources_of(root, module))
