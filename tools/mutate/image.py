"""Judges what native tests of the firmware have left alive by the tests of the image: pauses and cycles are there
alone. The mutant's file is compiled for the target, the image linked with it and run on the CPU model, by those tests
that execute the mutant's lines. Number 0 is made as mutants are, and what goes into the memory must be the image's to
the byte: what kills is the mutant, not how it was linked."""

import collections
import contextlib
import dataclasses
import functools
import re
import shlex
import shutil
import threading
import time

import overlay
import runner
import schemata
from runner import ALIVE, OUTSIDE, Verdict

IMAGE, LISTING, COPY = "bin/turbo.elf", "riscv64-unknown-elf-objdump", "riscv64-unknown-elf-objcopy"
ZERO_LIMIT = 600  # s
PLACE = re.compile(r"^(/.*):(\d+)(?: \(discriminator \d+\))?$")
INSTRUCTION = re.compile(r"^ *([0-9a-f]+):\t")


class Image:
    """Of the tree as it is built. `tests`: of programs that run the file BRICK_IMAGE. `out`: a folder."""

    def __init__(self, root, tree, out, tests):
        self.root, self.tree, self.out, self.tests = root, tree, out, tests
        self.lock, self.built = threading.Lock(), False
        self.compiles, self.link, self.as_it_is = {}, [], set()  # files that number 0 was made of
        self.lines = collections.defaultdict(set)  # {(file, line): addresses}
        self.executed, self.limits = {}, {}  # {(Tests, test): addresses}; {Tests: s}

    def read_commands(self):
        """How ninja makes the image."""
        with self.lock:
            if self.link:
                return
            for line in overlay.run(["ninja", "-t", "commands", IMAGE], self.tree).splitlines():
                words = shlex.split(line.split(" && ")[1])
                if "-c" in words:
                    self.compiles[words[words.index("-c") + 1]] = words
                elif words[words.index("-o") + 1].endswith(IMAGE):
                    self.link = words

    def build(self):
        """Once: what each test executes of the image as it is."""
        self.read_commands()
        with self.lock:
            if not self.built:
                self.read_lines()
                for tests in self.tests:
                    self.pass_zero(tests)
            self.built = True

    def read_lines(self):
        place = None
        listing = overlay.run([LISTING, "-d", "-l", "--no-show-raw-insn", str(self.tree / IMAGE)], self.tree)
        for line in listing.splitlines():
            if begin := PLACE.match(line):
                place = begin.group(1), int(begin.group(2))
            elif place and (instruction := INSTRUCTION.match(line)):
                self.lines[place].add(int(instruction.group(1), 16))

    def pass_zero(self, tests):
        self.out.mkdir(parents=True, exist_ok=True)
        table = self.out / f"{tests.program}.executed"
        table.unlink(missing_ok=True)
        verdict = self.run(tests, self.tree / IMAGE, ZERO_LIMIT, BRICK_EXECUTED=str(table))
        if verdict.status != ALIVE:
            raise runner.BadBuild(f"number 0, the image as it is, does not pass: {verdict.by}")
        self.limits[tests] = 5 + 10 * verdict.seconds
        for line in table.read_text().splitlines():
            test, *addresses = line.split()
            self.executed.setdefault((tests, test), set()).update(map(int, addresses))

    def run(self, tests, image, limit, **more):
        return runner.run(self.tree / "bin" / tests.program, tests, 0, limit, "on", self.root, BRICK_IMAGE=str(image),
                          **more)

    def reached(self, mutant, source):
        """{Tests: names} of the tests that execute a line of the mutant; one that has no instructions counts as all of
        its file."""
        end = source.count(b"\n", 0, mutant.place.end) + 1
        file = str(self.root / mutant.file)
        wanted = set().union(*(self.lines[file, line] for line in range(mutant.line, end + 1)))
        wanted = wanted or set().union(*(at for (of, _), at in self.lines.items() if of == file))
        found = collections.defaultdict(list)
        for (tests, name), executed in self.executed.items():
            if executed & wanted:
                found[tests].append(name)
        return found

    def has(self, file):
        """Whether the image is made of it."""
        self.read_commands()
        return str(self.root / file) in self.compiles

    def make(self, name, file, text):
        """In a folder of that name the image with `text` in the place of `file`."""
        folder = self.out / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "mutant.c").write_bytes(text)
        words = list(self.compiles[str(self.root / file)])
        made = words[words.index("-o") + 1]
        words.remove("-Werror")
        for option, file in (("-MF", "mutant.d"), ("-c", "mutant.c"), ("-o", "mutant.o")):
            words[words.index(option) + 1] = str(folder / file)
        overlay.run(words, self.tree)
        link = [str(folder / "mutant.o") if w == made else w for w in self.link]
        link[link.index("-o") + 1] = str(folder / "image.elf")
        overlay.run(link, self.tree)
        return folder / "image.elf"

    def content(self, image, folder):
        overlay.run([COPY, "-O", "binary", str(image), str(folder / "content")], self.tree)
        return (folder / "content").read_bytes()

    def make_zero(self, file, source):
        """Number 0, once for each file."""
        with self.lock:
            if file in self.as_it_is:
                return
            with self.made(f"0_{file.replace('/', '_')}", file, source) as image:
                if self.content(image, image.parent) != self.content(self.tree / IMAGE, image.parent):
                    raise runner.BadBuild(f"number 0, the image as it is, is another when {file} is made for a mutant")
            self.as_it_is.add(file)

    @contextlib.contextmanager
    def made(self, name, file, text):
        """As make; its folder goes when it was used."""
        try:
            yield self.make(name, file, text)
        finally:
            shutil.rmtree(self.out / name, ignore_errors=True)

    def judge(self, mutant, source):
        """`source`: of its file."""
        if not self.has(mutant.file):
            return Verdict(ALIVE, "", 0.0)
        self.build()
        self.make_zero(mutant.file, source)
        begin = time.monotonic()
        try:
            with self.made(str(mutant.number), mutant.file, schemata.single(source, mutant)) as image:
                seconds, verdict = time.monotonic() - begin, self.by_tests(mutant, source, image)
        except overlay.NoBuild as failed:
            return Verdict(OUTSIDE, f"no image: {failed}", time.monotonic() - begin)
        return dataclasses.replace(verdict, seconds=seconds + verdict.seconds)

    def by_tests(self, mutant, source, image):
        seconds, verdict = 0.0, Verdict(ALIVE, "", 0.0)
        for tests, names in sorted(self.reached(mutant, source).items(), key=lambda item: self.limits[item[0]]):
            one = functools.partial(self.run, image=image, limit=self.limits[tests])
            verdict = runner.confirmed(one, dataclasses.replace(tests, filter=":".join(names)))
            seconds += verdict.seconds
            if verdict.status != ALIVE:
                break
        return dataclasses.replace(verdict, seconds=seconds)

    def again(self, mutant, source, tests):
        """What `tests` say of the mutant's image; None: its file is in no image now, or there is no such test."""
        if not self.has(mutant.file):
            return None
        self.make_zero(mutant.file, source)
        with self.made(str(mutant.number), mutant.file, schemata.single(source, mutant)) as image:
            return runner.again(lambda some, number: self.run(some, image if number else self.tree / IMAGE,
                                                              ZERO_LIMIT), tests, mutant.number)
