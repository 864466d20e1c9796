"""What coverage leaves out, with the reason of each: tools/coverage.toml, tables [[exclusion]] of

file     of the tree
lines    a regular expression: lines of the file with it in their text, and the branches that begin there; or
bits     one that is the whole name of signals of the file, with their numbers: `count_q\\[3[0-5]\\]`
reason   why no test can reach them

What a test reached all the same, and what nothing is found of, is a mistake.
"""

import collections
import dataclasses
import re
import tomllib

FILE = "tools/coverage.toml"
KEYS = ({"file", "lines", "reason"}, {"file", "bits", "reason"})


@dataclasses.dataclass(frozen=True)
class Exclusion:
    file: str
    what: str  # "lines" or "bits"
    pattern: re.Pattern
    reason: str

    def __str__(self):
        return f"{FILE}: {self.file}, {self.what} '{self.pattern.pattern}'"


def read(root):
    """(exclusions, mistakes of the file)."""
    path, found, mistakes = root / FILE, [], []
    if not path.exists():
        return found, mistakes
    try:
        rows = tomllib.loads(path.read_text()).get("exclusion", [])
    except tomllib.TOMLDecodeError as error:
        return found, [f"{FILE}: {error}"]
    for number, row in enumerate(rows, 1):
        if set(row) not in KEYS or not all(isinstance(v, str) and v for v in row.values()):
            mistakes.append(f"{FILE}: exclusion {number} has {', '.join(sorted(row))}; expected file, lines or bits, "
                            "and reason, each a text")
            continue
        what = "lines" if "lines" in row else "bits"
        try:
            exclusion = Exclusion(row["file"], what, re.compile(row[what]), row["reason"])
        except re.error as error:
            mistakes.append(f"{FILE}: {row['file']}: '{row[what]}': {error}")
            continue
        source = root / exclusion.file
        if not source.is_file():
            mistakes.append(f"{exclusion}: no such file")
        elif what == "lines" and not any(map(exclusion.pattern.search, source.read_text().splitlines())):
            mistakes.append(f"{exclusion}: no line has it")
        else:
            found.append(exclusion)
    return found, mistakes


def leave_out(root, exclusions, lines, points, enough):
    """(lines, points, {exclusion: how many it leaves out}, mistakes) of what was counted: {(file, line): times} and
    {(kind, file, line, name): times}; `enough` of a kind, how often is reached."""
    of_file = collections.defaultdict(list)
    for exclusion in exclusions:
        of_file[exclusion.file].append(exclusion)
    texts, left, mistakes = {}, collections.Counter(), []

    def stays(kind, file, number, name, times):
        if file not in of_file:
            return True
        if file not in texts:
            texts[file] = (root / file).read_text().splitlines()
        text = texts[file][number - 1] if number <= len(texts[file]) else ""
        for exclusion in of_file[file]:
            bits = exclusion.what == "bits"
            if bits == (kind == "toggle") and (exclusion.pattern.fullmatch(name) if bits
                                               else exclusion.pattern.search(text)):
                left[exclusion] += 1
                if times >= enough(kind):
                    mistakes.append(f"{exclusion}: a test reached {file}:{number} {name}".rstrip())
                return False
        return True

    lines = {key: times for key, times in lines.items() if stays("line", *key, "", times)}
    points = {key: times for key, times in points.items()
              if stays(*key[:3], key[3].partition(" ")[2], times)}  # behind the column
    mistakes += [f"{exclusion}: nothing of it was counted" for exclusion in exclusions if not left[exclusion]]
    return lines, points, left, mistakes
