"""Judges the mutants of one RTL module: number 0 first, then each by its tests, filter, proof, unknown levels, boards
and lock-step."""

import dataclasses
import pathlib
import threading
import time

import overlay
import proofs
import runner
import schemata
import unknowns
import verilog
import workplace
from common import hash_of
from equal import Filter
from mutant import mutants_of
from runner import ALIVE, EQUAL, KILLED, BadBuild, Verdict

FOLDER = pathlib.Path(__file__).parent
FILTER_LIMIT, PROOF_LIMIT, ZERO_LIMIT, AGAIN_LIMIT = 60, 120, 600, 60  # s


@dataclasses.dataclass
class Stage:
    """Tests with one kind of build."""

    name: str
    tests: tuple
    boards: bool
    compare: str


class Judge:
    spare = None  # mutants to draw on when one is equal; the model holds all
    controls = 50  # of the filter

    def __init__(self, root, tree, module, use):
        self.root, self.tree, self.module = root, tree, module
        self.source = (root / module.file).read_bytes()
        self.mutants = mutants_of(module.file, self.source, verilog.places(self.source))
        self.out = workplace.folder_of(tree, use, f"{module.kind}_{module.name}")
        self.alone = workplace.claimed(self.out)
        self.designs = [Filter(root, top, module.file, self.out / f"filter_{top}", FILTER_LIMIT)
                           for top in module.tops]
        self.stages = [Stage("tests", module.opinion, False, "off"), Stage("board", module.board, True, "off"),
                       Stage("slip", module.slip, True, "on")]
        self.binaries, self.filters, self.limits, self.build_seconds = {}, {}, {}, 0.0
        self.lock = threading.Lock()

    def inputs(self):
        """A hash of all that decides: the mutated file, the programs as built, the proof, these tools."""
        programs = {t.program for stage in self.stages for t in stage.tests}
        proof = self.root / f"testbench/formal/{self.module.proof}.sv"
        tools = [*sorted(FOLDER.glob("*.py")), FOLDER.parent / "prove.py", FOLDER.parent / "check_unknowns.py"]
        return hash_of(self.source, *(self.tree / "bin" / p for p in sorted(programs)),
                       proof if self.module.proof else "", repr(self.module), *tools)

    def write(self, chosen):
        """The file with `chosen` in it, of which build() makes programs."""
        mutated = self.out / self.module.file
        mutated.parent.mkdir(parents=True, exist_ok=True)
        mutated.write_bytes(schemata.write(self.source, chosen, schemata.Verilog()))

    def build(self, stage, tests):
        """Their program, when the first mutant comes to it; number 0 passes. Nobody waits whose own is there."""
        if (stage.name, tests) in self.limits:
            return
        with self.lock:
            if (stage.name, tests) in self.limits:
                return
            begin = time.monotonic()
            self.pass_zero(stage, tests, self.binary(stage, tests.program))
            self.build_seconds += time.monotonic() - begin

    def binary(self, stage, name):
        """The program with the mutants in it."""
        key, folder = (name, stage.boards), self.out / ("board" if stage.boards else "module")
        if key not in self.binaries:
            folder.mkdir(parents=True, exist_ok=True)
            replaced = {self.root / self.module.file: self.out / self.module.file}
            one = overlay.Overlay(self.tree, folder, replaced, ["-O1"])
            self.binaries[key] = one.build(overlay.Program(self.tree, name), stage.boards)
        return self.binaries[key]

    def pass_zero(self, stage, tests, binary):
        """Number 0, the module as it is, passes. What it fails when nothing is compared is a control of the
        comparison, and judges nobody."""
        verdict = runner.run(binary, tests, 0, ZERO_LIMIT, "on", self.root)
        if verdict.status != ALIVE:
            raise BadBuild(f"number 0, the module as it is, does not pass: {verdict.by}")
        if stage.compare == "off":
            controls = runner.failures(binary, tests, ZERO_LIMIT, self.root)
            self.filters[(stage.name, tests)] = tests.without(controls)
        self.limits[(stage.name, tests)] = 5 + 10 * verdict.seconds

    def run(self, stage, tests, number):
        binary, key = self.binaries[(tests.program, stage.boards)], (stage.name, tests)

        def one(some):
            return runner.run(binary, some, number, self.limits[key], stage.compare, self.root)

        return runner.confirmed(one, self.filters.get(key, tests))

    def by_tests(self, stage, mutant):
        seconds, verdict = 0.0, Verdict(ALIVE, "", 0.0)
        for tests in stage.tests:
            self.build(stage, tests)
            verdict = self.run(stage, tests, mutant.number)
            seconds += verdict.seconds
            if verdict.status != ALIVE:
                break
        return dataclasses.replace(verdict, seconds=seconds)

    def by_filter(self, mutant):
        begin = time.monotonic()
        equal = False
        for one in self.designs:
            folder = one.out / str(mutant.number)
            folder.mkdir(parents=True, exist_ok=True)
            single = folder / "mutant.sv"
            single.write_bytes(schemata.single(self.source, mutant))
            equal = equal or one.equal(single, folder)
        return Verdict(EQUAL if equal else ALIVE, "proved equal" if equal else "", time.monotonic() - begin)

    def by_proof(self, mutant):
        if not self.module.proof:
            return Verdict(ALIVE, "", 0.0)
        begin = time.monotonic()
        single = schemata.single(self.source, mutant).decode()
        rule = proofs.refuted(self.root, self.module.proof, self.module.file, self.source.decode(), single,
                              self.out / "proof" / str(mutant.number), PROOF_LIMIT)
        seconds = time.monotonic() - begin
        return Verdict(KILLED, f"proof {self.module.proof}: {rule}", seconds) if rule else Verdict(ALIVE, "", seconds)

    def by_unknowns(self, mutant):
        begin = time.monotonic()
        what = unknowns.found(self.root, self.module.file, schemata.single(self.source, mutant).decode())
        seconds = time.monotonic() - begin
        return Verdict(KILLED, f"unknowns: {what}", seconds) if what else Verdict(ALIVE, "", seconds)

    def again(self, mutant, by):
        """`by`: 'PROGRAM: TEST', which passes with number 0; no other program is built unless it lets the mutant live.
        None: there is no such test now."""
        stage, (name, _, test) = self.stages[0], by.partition(": ")
        if name not in [tests.program for tests in stage.tests]:
            return None

        def run(tests, number):
            return runner.run(self.binary(stage, tests.program), tests, number, AGAIN_LIMIT, stage.compare, self.root)

        verdict = runner.again(run, runner.Tests(name, test), mutant.number)
        for tests in stage.tests:
            if verdict is None or verdict.status != ALIVE:
                break
            verdict = runner.by_any(run, tests, mutant.number)
        return verdict

    def judge(self, mutant, _first=""):
        """(stage, verdict): of the first that does not leave it alive. What lock-step alone kills has stage 'slip' and
        counts as alive for the score of misreadings."""
        tests, board, slip = self.stages
        steps = [("tests", lambda: self.by_tests(tests, mutant)), ("filter", lambda: self.by_filter(mutant)),
                 ("proof", lambda: self.by_proof(mutant)), ("unknowns", lambda: self.by_unknowns(mutant)),
                 ("board", lambda: self.by_tests(board, mutant)), ("slip", lambda: self.by_tests(slip, mutant))]
        seconds = 0.0
        for name, step in steps:
            verdict = step()
            seconds += verdict.seconds
            if verdict.status != ALIVE:
                return name, dataclasses.replace(verdict, seconds=seconds)
        return "", Verdict(ALIVE, "", seconds)
