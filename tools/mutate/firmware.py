"""Judges the mutants of one folder of the firmware by the native tests that come to them, the quick ones first. What
none of them kills is compiled alone: where the object code is that of the original it is no mutant."""

import collections
import dataclasses
import fcntl
import shlex
import subprocess
import threading
import time

import c_source
import overlay
import runner
import schemata
from common import ROOT
from mutant import hash_of, mutants_of
from runner import ALIVE, EQUAL, Tests, Verdict

ZERO_LIMIT, COMPILE_LIMIT = 300, 60  # s
QUICK = 100  # ms; tests that take longer come after all that do not
NAMES = 300  # of tests in one call
FEWER = {"BRICK_RANDOM_PATHS": "60"}  # of 2000, which take as long as all other tests
TOOLS = ROOT / "tools/mutate"
OPTIMIZED = ["-O2", "-g0", "-w"]


class Judge:
    spare = 100  # mutants to draw on when one is equal; a folder has thousands, each slows all tests

    def __init__(self, root, tree, module):
        self.root, self.tree, self.module = root, tree, module
        self.out = root / "build/mutate" / f"firmware_{module.name}"
        self.alone = locked(self.out)
        self.programs = {t.program: overlay.Program(tree, t.program) for t in module.opinion}
        self.commands = self.compilations()
        self.sources = {file: (root / file).read_bytes() for file in self.commands}
        self.mutants = []
        for file, command in self.commands.items():
            options = [word for word in command if word.startswith(("-I", "-D", "-std="))]
            self.mutants += mutants_of(file, self.sources[file], c_source.places(root / file, options),
                                       len(self.mutants) + 1)
        self.lock, self.build_seconds = threading.Lock(), 0.0
        self.replaced, self.built, self.reached = {}, {}, {}  # reached: by a mutant's number [(ms, program, test)]

    def compilations(self):
        """{file: command} of the folder's files that the programs are made of."""
        found = {}
        for program in self.programs.values():
            for command in program.compiles.values():
                file = (self.tree / command[command.index("-c") + 1]).resolve()
                if file.parent == self.root / self.module.file:
                    found[str(file.relative_to(self.root))] = command
        return dict(sorted(found.items()))

    def inputs(self):
        """A hash of all that decides: the folder's files, the programs as built, these tools."""
        return hash_of(*self.sources.values(), *(self.tree / "bin" / name for name in sorted(self.programs)),
                       repr(self.module), *sorted(TOOLS.glob("*.py")), TOOLS / "reached.cpp")

    def write(self, chosen):
        """The files with `chosen` in them, of which build() makes programs."""
        by_file = collections.defaultdict(list)
        for mutant in chosen:
            by_file[mutant.file].append(mutant)
        self.replaced = {}
        for file, mutants in by_file.items():
            made = self.out / file
            made.parent.mkdir(parents=True, exist_ok=True)
            made.write_bytes(schemata.write(self.sources[file], mutants, schemata.C(self.root / file)))
            self.replaced[self.root / file] = made

    def build(self):
        """The programs, once, and number 0 in each: it passes and says which tests come to which mutant."""
        with self.lock:
            if self.built:
                return
            begin, built, one = time.monotonic(), {}, self.overlay()
            for name, program in self.programs.items():
                built[name] = one.build(program, False, [self.recorder(program)])
                self.pass_zero(name, built[name])
            self.built = built
            self.build_seconds += time.monotonic() - begin

    def overlay(self):
        folder = self.out / "tests"
        folder.mkdir(parents=True, exist_ok=True)
        return overlay.Overlay(self.tree, folder, self.replaced, ["-w"])

    def recorder(self, program):
        """reached.cpp, compiled as the program's own files are."""
        command = next(c for c in program.compiles.values()
                       if c[c.index("-c") + 1].endswith((".cpp", ".cxx")) and "c++-header" not in c)
        made = self.out / "reached.o"
        overlay.run([*plain(command, TOOLS / "reached.cpp", made), f"-DBRICK_MUTANTS={len(self.mutants)}"], self.tree)
        return str(made)

    def pass_zero(self, name, binary):
        """Number 0, the folder as it is."""
        table = self.out / f"{name}.reached"
        verdict = runner.run(binary, Tests(name, "*"), 0, ZERO_LIMIT, True, self.root,
                             **FEWER, BRICK_REACHED=str(table))
        if verdict.status != ALIVE:
            raise runner.BadBuild(f"number 0, the folder as it is, does not pass: {verdict.by}")
        for line in table.read_text().splitlines():
            test, ms, *numbers = line.split()
            for number in numbers:
                self.reached.setdefault(int(number), []).append((int(ms), name, test))

    def calls(self, number):
        """[(Tests, the ms that they take of number 0)]"""
        tests = self.reached.get(number, [])
        groups = collections.defaultdict(list)
        for ms, name, test in sorted(tests):
            groups[(ms >= QUICK, name)].append((ms, test))
        for (_, name), group in sorted(groups.items()):
            for at in range(0, len(group), NAMES):
                part = group[at:at + NAMES]
                yield Tests(name, ":".join(test for _, test in part)), sum(ms for ms, _ in part)

    def by_tests(self, mutant):
        """By those that come to it; killed by none where there are none."""
        self.build()
        seconds, verdict = 0.0, Verdict(ALIVE, "", 0.0)
        for tests, ms in self.calls(mutant.number):
            verdict = runner.run(self.built[tests.program], tests, mutant.number, 5 + ms / 100, True,
                                 self.root, **FEWER)
            seconds += verdict.seconds
            if verdict.status != ALIVE:
                break
        reached = mutant.number in self.reached
        return dataclasses.replace(verdict, by=verdict.by if reached else "no test comes to it", seconds=seconds)

    def again(self, mutant, by):
        """`by`: 'PROGRAM: TEST', which passes with number 0; nothing else is built. None: there is no such test now."""
        name, _, test = by.partition(": ")
        if name not in self.programs:
            return None
        if name not in self.built:
            self.built[name] = self.overlay().build(self.programs[name], False, [self.recorder(self.programs[name])])
        tests = Tests(name, test)
        verdicts = [runner.run(self.built[name], tests, n, ZERO_LIMIT, True, self.root, **FEWER)
                    for n in (0, mutant.number)]
        if verdicts[0].by.endswith(runner.no_test(tests)):
            return None
        if verdicts[0].status != ALIVE:
            raise runner.BadBuild(f"number 0, the folder as it is, does not pass: {verdicts[0].by}")
        return verdicts[1]

    def by_filter(self, mutant):
        """Equal: the object code is."""
        begin = time.monotonic()
        same = self.object_code(mutant.file, "0", self.sources[mutant.file]) == self.object_code(
            mutant.file, str(mutant.number), schemata.single(self.sources[mutant.file], mutant))
        return Verdict(EQUAL if same else ALIVE, "same object code" if same else "", time.monotonic() - begin)

    def object_code(self, file, folder, source):
        folder = self.out / "alone" / folder
        folder.mkdir(parents=True, exist_ok=True)
        name = file.rpartition("/")[2]
        (folder / name).write_bytes(source)
        words = [w for w in plain(self.commands[file], name, "alone.o") if not w.startswith(("-fsanitize", "-O", "-g"))]
        words = [f"-I{(self.tree / w[2:]).resolve()}" if w.startswith("-I") else w for w in words]
        try:
            done = subprocess.run([*words, *OPTIMIZED], cwd=folder, capture_output=True, text=True,
                                  timeout=COMPILE_LIMIT, check=False)
        except subprocess.TimeoutExpired as late:
            raise overlay.NoBuild(f"{shlex.join(words)}: no end within {COMPILE_LIMIT} s") from late
        if done.returncode != 0:
            raise overlay.NoBuild(f"{shlex.join(words)}\n{done.stderr[-2000:]}")
        return (folder / "alone.o").read_bytes()

    def judge(self, mutant):
        """(stage, verdict)"""
        killed = self.by_tests(mutant)
        if killed.status != ALIVE:
            return "tests", killed
        equal = self.by_filter(mutant)
        seconds = killed.seconds + equal.seconds
        if equal.status == EQUAL:
            return "filter", dataclasses.replace(equal, seconds=seconds)
        return "", dataclasses.replace(killed, seconds=seconds)


def locked(folder):
    """Held until this process ends: the programs that are built there are one's own."""
    folder.mkdir(parents=True, exist_ok=True)
    lock = (folder / "lock").open("w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as held:
        raise runner.BadBuild(f"{folder}: another ./dev mutate is at work there") from held
    return lock


def plain(command, source, made):
    """A compiler's command for another file, without the notes that ninja takes of it."""
    words, skip = [], False
    for word in command:
        if not skip and word not in ("-MD", "-MF", "-MT"):
            words.append(word)
        skip = word in ("-MF", "-MT")
    words[words.index("-c") + 1], words[words.index("-o") + 1] = str(source), str(made)
    return words
