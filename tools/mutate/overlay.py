"""Builds a test program with other source files in the place of some, beside the build tree it is taken from.

The commands are ninja's own. Verilator and compiler run anew for what reads a replaced file, with the new folders first
in the include path; the objects are linked in front of the libraries, so that their symbols win. Of the build tree
its folder mutate alone is written.
"""

import dataclasses
import functools
import os
import pathlib
import re
import shlex
import subprocess

BIGGEST = "Vboard_all"  # of the boards; what runs on it judges nobody, and it takes as long as all else


class NoBuild(Exception):
    """A command failed: what it said."""


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    if done.returncode != 0:
        raise NoBuild(f"{shlex.join(command)[:300]}\n{done.stdout[-3000:]}")
    return done.stdout


@dataclasses.dataclass
class Model:
    """A Verilated model of the program: its command and its files."""

    prefix: str
    mdir: str
    sources: list
    command: list
    folder: str


class Program:
    """How ninja builds one executable of `tree`."""

    def __init__(self, tree, name):
        self.tree, self.name = tree, name
        lines = run(["ninja", "-t", "commands", f"bin/{name}"], tree).splitlines()
        self.compiles, self.models, self.link = {}, {}, None
        for line in lines:
            verilate = re.search(r"^cd (\S+) && (\S*verilator_bin .*?)(?: &&|$)", line)
            if verilate:
                self.model(verilate.group(1), shlex.split(verilate.group(2)))
            elif f" -o bin/{name} " in line:
                self.link = shlex.split(re.search(r"&& (\S*c\+\+ .*?)(?: &&|$)", line).group(1))
            elif " -c " in line and " -o " in line:
                words = shlex.split(line)
                self.compiles[words[words.index("-o") + 1]] = words
        if self.link is None:
            raise NoBuild(f"{tree}: no program {name}; build it first")

    def model(self, folder, words):
        prefix, mdir = words[words.index("--prefix") + 1], words[words.index("--Mdir") + 1]
        sources = [w for w in words if re.search(r"\.(sv|v|vlt)$", w)]
        self.models[prefix] = Model(prefix, mdir, sources, words, folder)

    @functools.cached_property
    def read(self):
        """{object: the files (absolute) that its compilation reads}, by ninja's log of dependencies."""
        found, target = {}, None
        for line in run(["ninja", "-t", "deps", *self.compiles], self.tree).splitlines():
            if line and not line[0].isspace():
                target = line.split(":")[0]
                found[target] = set()
            elif line.strip():
                found[target].add(os.path.normpath(self.tree / line.strip()))
        return found

    def readers(self, files):
        """Objects whose compilation reads one of `files` (absolute)."""
        return [target for target, read in self.read.items() if read & files]


def of_several(source):
    """CMake has joined files for the compiler (cmake/Headers.cmake, brick_together)."""
    return pathlib.Path(source).parent.name == "Unity"


def joined_files(source):
    """The files that it joins, itself where it joins none."""
    return re.findall(r'^#include "(.*)"', pathlib.Path(source).read_text(), re.M) if of_several(source) else [source]


def unjoined(source, root):
    """The text of such a file, in which the include path says which files it joins."""
    return pathlib.Path(source).read_text().replace(f'"{root}/', '"')


class Overlay:
    """Of `replaced` {path as the build knows it: file to take instead}, built below `out`. `headers`: a folder in which
    those of them that are included stand, by their paths from the root of the sources."""

    def __init__(self, tree, out, replaced, flags, headers=None, root=None):
        self.tree, self.out, self.flags, self.headers, self.root = tree, out, flags, headers, root
        self.replaced = {str(pathlib.Path(old).resolve()): new for old, new in replaced.items()}

    def verilate(self, model):
        mdir = self.out / f"{model.prefix}.dir"
        mdir.mkdir(parents=True, exist_ok=True)
        words = [w for w in model.command if w not in ("-Wall",)]
        words[words.index("--Mdir") + 1] = str(mdir)
        for i, word in enumerate(words):
            if word in model.sources:
                full = str((pathlib.Path(model.folder) / word).resolve())
                words[i] = str(self.replaced.get(full, word))
        run([*words, "-Wno-fatal", "-Wno-lint", "-Wno-style", "-Wno-LATCH", "-Wno-MULTIDRIVEN"], model.folder)
        return mdir

    def joined(self, model, mdir):
        """The two files that the build compiles of a model (cmake/BrickRtl.cmake), of the new code."""
        for part in ("fast", "slow"):
            slow = [f for f in sorted(mdir.glob("*.cpp")) if re.search(r"__(Slow|Syms)\.cpp$", f.name)]
            files = slow if part == "slow" else [f for f in sorted(mdir.glob("*.cpp")) if f not in slow]
            (self.out / f"{model.prefix}_{part}.cpp").write_text("".join(f'#include "{f}"\n' for f in files))

    def build(self, program, boards, more=()):
        """The program, built; `boards`: also its models of whole boards with two and five ICs. `more`: objects."""
        models = [m for m in program.models.values()
                  if any(str((pathlib.Path(m.folder) / s).resolve()) in self.replaced for s in m.sources)
                  and (not m.prefix.startswith("Vboard_") or (boards and m.prefix != BIGGEST))]
        includes, objects, headers = [f"-I{self.headers}"] if self.headers else [], list(more), []
        for model in models:
            mdir = self.verilate(model)
            self.joined(model, mdir)
            includes.append(f"-I{mdir}")
            headers += [str(f.resolve()) for f in pathlib.Path(model.mdir).glob("*.h")]
        for target in program.readers(set(headers) | set(self.replaced)):
            words = list(program.compiles[target])
            source = pathlib.Path(words[words.index("-c") + 1])
            own = self.out / source.name
            joined = any(source.name in (f"{m.prefix}_fast.cpp", f"{m.prefix}_slow.cpp") for m in models)
            if joined and own.exists():
                words[words.index("-c") + 1] = str(own)
            elif str(source.resolve()) in self.replaced:
                words[words.index("-c") + 1] = str(self.replaced[str(source.resolve())])
            elif self.headers and of_several(source):
                one = self.out / f"{target.replace('/', '_')}.cpp"
                one.write_text(unjoined(source, self.root))
                words[words.index("-c") + 1] = str(one)
            made = self.out / target.replace("/", "_")
            words[words.index("-o") + 1] = str(made)
            for option in ("-MF", "-MT"):
                if option in words:
                    words[words.index(option) + 1] = f"{made}.d"
            compiler = next(i for i, w in enumerate(words) if re.search(r"(c\+\+|g\+\+|cc|gcc)$", w))
            words[compiler + 1:compiler + 1] = includes
            run([*words, *self.flags], self.tree)
            objects.append(str(made))
        words, binary = list(program.link), self.out / program.name
        words[words.index("-o") + 1] = str(binary)
        own = [w for w in words if w.endswith(".o")]
        for target in own:  # an object of the program itself: the new one in its place
            new = str(self.out / target.replace("/", "_"))
            if new in objects:
                words[words.index(target)] = new
                objects.remove(new)
        at = next(i for i, w in enumerate(words) if w.endswith(".a"))
        # A source may stand in two libraries of the program: its first object counts, as it would of archives.
        run([*words[:at], "-Wl,--allow-multiple-definition", *objects, *words[at:]], self.tree)
        return binary
