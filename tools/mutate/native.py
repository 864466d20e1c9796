"""Judges the mutants of one folder of C or C++ by the tests that come to them, the quick ones first. What none of them
kills is compiled alone: where the object code is that of the original it is no mutant. Of the firmware the rest goes to
the tests of the image."""

import collections
import dataclasses
import functools
import json
import pathlib
import resource
import shlex
import threading

import c_source
import cpp_source
import image
import overlay
import runner
import schemata
import workplace
from common import ROOT, hash_of
from mutant import Place, mutants_of, sources_of
from runner import ALIVE, EQUAL, Tests, Verdict

ZERO_LIMIT, COMPILE_LIMIT = 300, 600  # s
QUICK = 100  # ms; tests that take longer come after all that do not
NAMES = 300  # of tests in one call
TOOLS = ROOT / "tools/mutate"
OPTIMIZED = ["-O2", "-g0", "-w"]


@dataclasses.dataclass(frozen=True)
class Kind:
    """`compare`: what rigs with both engines do. `more`: of the environment. `flags`: of the compiler."""

    compare: str = "on"
    more: dict = dataclasses.field(default_factory=dict)
    flags: tuple = ("-w",)


CHECKED = ("-w", "-D_GLIBCXX_ASSERTIONS")  # an index outside says so
KINDS = {"firmware": Kind(more={"BRICK_RANDOM_PATHS": "60"}),  # of 700, to be quick
         "model": Kind(compare="model", flags=CHECKED),
         "host": Kind(flags=CHECKED)}


class Judge:
    spare = 100  # mutants to draw on when one is equal; a folder has thousands, each slows all tests
    controls = 5  # of the filter, which compares bytes: each is compiled alone

    def __init__(self, root, tree, module, use):
        self.root, self.tree, self.module, self.kind = root, tree, module, KINDS[module.kind]
        self.out = workplace.folder_of(tree, use, f"{module.kind}_{module.name}")
        self.alone = workplace.claimed(self.out)
        self.stages = [("tests", module.opinion, self.kind.compare), ("slip", module.slip, "on")]
        self.programs = {t.program: overlay.Program(tree, t.program) for _, tests, _ in self.stages for t in tests}
        self.commands = self.compilations()
        self.sources = {file: (root / file).read_bytes() for file in self.commands}
        self.mutants = self.find()
        self.image = image.Image(root, tree, self.out / "image", module.image) if module.image else None
        self.lock, self.build_seconds = threading.Lock(), 0.0
        self.replaced, self.built, self.objects = {}, {}, {}
        self.reached = collections.defaultdict(list)  # of a stage and a mutant's number [(ms, program, test)]

    def compilations(self):
        """{file: commands that read it} of the folder's files that the programs are made of, those of libraries first:
        what tests alone read is of no interest to the object code."""
        found = collections.defaultdict(dict)
        wanted = {str(path) for path in sources_of(self.root, self.module)}
        for program in self.programs.values():
            for target in program.readers(wanted):
                command = program.compiles[target]
                for path in program.read[target] & wanted:
                    found[path][command[command.index("-c") + 1]] = command
        def of_tests(command):
            source = str((self.tree / command[command.index("-c") + 1]).resolve())
            return all("/testbench/unit/" in file for file in overlay.joined_files(source))
        chosen = {}
        for path, commands in sorted(found.items()):
            own = [c for c in commands.values() if not of_tests(c)]
            chosen[path[len(str(self.root)) + 1:]] = own or list(commands.values())[:1]
        return chosen

    def find(self):
        """The mutants of all files. What the parser found is kept while nothing that it reads changes."""
        kept, found, mutants = self.out / "places.json", {}, []
        known = json.loads(kept.read_text()) if kept.exists() else {}
        for file in self.commands:
            read = self.hash_of_read(file)
            places = known[file][1] if known.get(file, [""])[0] == read else self.places_in(file)
            found[file] = [read, places]
            mutants += mutants_of(file, self.sources[file], [Place(*place) for place in places], len(mutants) + 1)
        new = kept.with_suffix(".new")
        new.write_text(json.dumps(found))
        new.replace(kept)  # a killed run leaves the old one or the new one
        return mutants

    def hash_of_read(self, file):
        """Of all files that the compiler reads for `file`, its options, the finders and what they parse with."""
        command = self.commands[file][0]
        target = command[command.index("-o") + 1]
        read = {path for program in self.programs.values() for path in program.read.get(target, ())}
        return hash_of(*map(pathlib.Path, sorted(read)), repr(parser_options(command)), c_source.own_headers(),
                       TOOLS.parent / "requirements.txt", TOOLS / "chosen.h",
                       *(TOOLS / f"{part}.py" for part in ("c_source", "cpp_source", "schemata", "mutant")))

    def places_in(self, file):
        options = parser_options(self.commands[file][0])
        if file.endswith(".c"):
            places = c_source.Finder(self.root / file, options).places
        else:
            places = [m.place for m in cpp_source.mutants(self.root / file, file, options, 1)]
        return [dataclasses.astuple(place) for place in places]

    def inputs(self):
        """A hash of all that decides: the folder's files, the programs as built, these tools."""
        programs = sorted({*self.programs, *(tests.program for tests in self.module.image)})
        images = [self.tree / image.IMAGE] if self.image else []
        return hash_of(*self.sources.values(), *(self.tree / "bin" / name for name in programs), *images,
                       repr(self.module), *sorted(TOOLS.glob("*.py")), TOOLS / "reached.cpp", TOOLS / "chosen.h")

    def write(self, chosen):
        """The files with `chosen` in them, of which build() makes programs."""
        by_file = collections.defaultdict(list)
        for mutant in chosen:
            by_file[mutant.file].append(mutant)
        self.replaced = {}
        for file, mutants in by_file.items():
            made = self.out / "source" / file
            made.parent.mkdir(parents=True, exist_ok=True)
            made.write_bytes(schemata.write(self.sources[file], mutants, schemata.C(self.root / file)))
            self.replaced[self.root / file] = made
        for old in (self.out / "source").rglob("*.*"):  # of another run; the include path would find it
            if old not in self.replaced.values():
                old.unlink()

    def build(self):
        """The programs, once, and number 0 in each: it passes and says which tests come to which mutant."""
        with self.lock:
            if self.built:
                return
            begin, built = children_seconds(), {name: self.program(name) for name in self.programs}
            for stage, programs, compare in self.stages:
                for tests in programs:
                    self.pass_zero(stage, tests, compare, built[tests.program])
            self.built = built
            self.build_seconds += children_seconds() - begin

    def program(self, name):
        folder, program = self.out / "tests", self.programs[name]
        folder.mkdir(parents=True, exist_ok=True)
        one = overlay.Overlay(self.tree, folder, self.replaced, list(self.kind.flags), self.out / "source", self.root)
        return one.build(program, False, [recorder(program, len(self.mutants), self.out)])

    def run(self, binary, tests, number, limit, compare, **more):
        return runner.run(binary, tests, number, limit, compare, self.root, **self.kind.more, **more)

    def pass_zero(self, stage, tests, compare, binary):
        """Number 0, the folder as it is."""
        table = self.out / f"{tests.program}.reached"
        verdict = self.run(binary, tests, 0, ZERO_LIMIT, compare, BRICK_REACHED=str(table))
        if verdict.status != ALIVE:
            raise runner.BadBuild(f"number 0, the folder as it is, does not pass: {verdict.by}")
        for line in table.read_text().splitlines():
            test, ms, *numbers = line.split()
            for number in numbers:
                self.reached[stage, int(number)].append((int(ms), tests.program, test))

    def calls(self, stage, number, first=""):
        """[(Tests, the ms that they take of number 0)]: `first`, then the quick ones of all programs, then the others;
        the program of which least time is needed comes first."""
        groups = collections.defaultdict(list)
        for ms, name, test in sorted(self.reached[stage, number]):
            if f"{name}: {test}" == first:
                yield Tests(name, test), ms
                continue
            groups[(ms >= QUICK, name)].append((ms, test))
        order = sorted(groups.items(), key=lambda item: (item[0][0], sum(ms for ms, _ in item[1]), item[0][1]))
        for (_, name), group in order:
            for at in range(0, len(group), NAMES):
                part = group[at:at + NAMES]
                yield Tests(name, ":".join(test for _, test in part)), sum(ms for ms, _ in part)

    def by_tests(self, stage, compare, mutant, first=""):
        """By those that come to it; killed by none where there are none."""
        self.build()
        seconds, verdict = 0.0, Verdict(ALIVE, "", 0.0)
        for tests, ms in self.calls(stage, mutant.number, first):
            one = functools.partial(self.run, self.built[tests.program], number=mutant.number, limit=5 + ms / 100,
                                    compare=compare)
            verdict = runner.confirmed(one, tests)
            seconds += verdict.seconds
            if verdict.status != ALIVE:
                break
        reached = self.reached[stage, mutant.number]
        return dataclasses.replace(verdict, by=verdict.by if reached else "no test comes to it", seconds=seconds)

    def again(self, mutant, by):
        """`by`: 'PROGRAM: TEST', which passes with number 0; nothing else is built. None: there is no such test now."""
        name, _, test = by.partition(": ")
        tests = Tests(name, test)
        if name in [of_image.program for of_image in self.module.image]:
            return self.image.again(mutant, self.sources[mutant.file], tests)
        if name not in self.programs:
            return None
        if name not in self.built:
            self.built[name] = self.program(name)
        return runner.again(lambda some, number: self.run(self.built[name], some, number, ZERO_LIMIT,
                                                          self.kind.compare), tests, mutant.number)

    def by_filter(self, mutant):
        """Equal: the object code is, of all that reads the file."""
        source, seconds, same = self.sources[mutant.file], 0.0, True
        mutated = schemata.single(source, mutant)
        for n in range(len(self.commands[mutant.file])):
            code, used = self.object_code(mutant.file, n, str(mutant.number), mutated)
            seconds += used
            if code != self.original(mutant.file, n):
                same = False
                break
        return Verdict(EQUAL if same else ALIVE, "same object code" if same else "", seconds)

    def original(self, file, reader):
        if (file, reader) not in self.objects:
            self.objects[file, reader], _ = self.object_code(file, reader, f"0_{file.replace('/', '_')}",
                                                             self.sources[file])
        return self.objects[file, reader]

    def object_code(self, file, reader, folder, source):
        """Of a file that reads `file`, with `source` in its place, and the seconds that the compiler took."""
        folder, command = self.out / "alone" / folder, self.commands[file][reader]
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_bytes(source)
        path = str((self.tree / command[command.index("-c") + 1]).resolve())
        if path == str(self.root / file):
            path = file
        elif overlay.of_several(path):
            (folder / "several.cpp").write_text(overlay.unjoined(path, self.root))
            path = "several.cpp"
        words = [w for w in plain(command, path, "alone.o") if not w.startswith(("-fsanitize", "-O", "-g"))]
        words = [f"-I{(self.tree / w[2:]).resolve()}" if w.startswith("-I") else w for w in words]
        compiler = next(i for i, w in enumerate(words) if w.endswith(("++", "cc", "gcc")) and not w.endswith("ccache"))
        words[compiler + 1:compiler + 1] = ["-I.", "-include", str(schemata.CHOSEN)]  # brick_without()
        status, said, seconds = runner.ended([*words, *OPTIMIZED], folder, COMPILE_LIMIT)
        if status != 0:
            raise overlay.NoBuild(f"{shlex.join(words)}\nstatus {status}\n{said[-2000:]}")
        return (folder / "alone.o").read_bytes(), seconds

    def judge(self, mutant, first=""):
        """(stage, verdict). What lock-step alone kills has stage 'slip' and counts as alive for the score. `first`:
        the test to begin with, as `by` of a verdict names it."""
        killed = self.by_tests("tests", self.kind.compare, mutant, first)
        if killed.status != ALIVE:
            return "tests", killed
        seconds = killed.seconds
        if self.module.slip:  # before the filter: what it kills need not be compiled alone
            slip = self.by_tests("slip", "on", mutant)
            seconds += slip.seconds
            if slip.status != ALIVE:
                return "slip", dataclasses.replace(slip, seconds=seconds)
        equal = self.by_filter(mutant)
        seconds += equal.seconds
        if equal.status == EQUAL:
            return "filter", dataclasses.replace(equal, seconds=seconds)
        if self.image:
            by_image = self.image.judge(mutant, self.sources[mutant.file])
            seconds += by_image.seconds
            if by_image.status != ALIVE:
                return "image", dataclasses.replace(by_image, seconds=seconds)
        return "", dataclasses.replace(killed, seconds=seconds)


def children_seconds():
    """Of the processor, of all programs that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def recorder(program, mutants, out):
    """reached.cpp, compiled as the program's own files are."""
    command = next(c for c in program.compiles.values()
                   if c[c.index("-c") + 1].endswith((".cpp", ".cxx")) and "c++-header" not in c)
    made = out / "reached.o"
    overlay.run([*plain(command, TOOLS / "reached.cpp", made), f"-DBRICK_MUTANTS={mutants}"], program.tree)
    return str(made)


def parser_options(command):
    """What of a compiler's command decides how its source reads."""
    options = []
    for word, before in zip(command, ["", *command], strict=False):
        if word.startswith(("-I", "-D", "-std=", "-isystem")) or before == "-isystem":
            options.append(word)
    return options


def plain(command, source, made):
    """A compiler's command for another file, without the notes that ninja takes of it."""
    words, skip = [], False
    for word in command:
        if not skip and word not in ("-MD", "-MF", "-MT"):
            words.append(word)
        skip = word in ("-MF", "-MT")
    words[words.index("-c") + 1], words[words.index("-o") + 1] = str(source), str(made)
    return words
