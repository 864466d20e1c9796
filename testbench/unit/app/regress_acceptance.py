#!/usr/bin/env python3
"""brick regress: plans, verdicts, kinds of failure, reports, results that are gone on with, and nobody left behind.
usage: regress_acceptance.py BRICK CASE"""
import getpass
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree as xml

import command
from browser import Browser
from command import brick, check
from regress_folder import Folder, bucket

MIXED = """
title = "mixed"
[[row]]
bench = "smoke"
seeds = [31, 32]
[[row]]
bench = "smoke"
negative = true
seeds = "41-42"
[[row]]
name = "odd"
command = ["sh", "-c", "echo step {seed}: Error: 0x1F and 2.5; exit $(({seed} % 2))"]
seeds = "1-5"
[[row]]
name = "late"
command = ["sh", "-c", "sleep 60 & sleep 60"]
limit = "300ms"
[[row]]
name = "crash"
command = ["sh", "-c", "kill -SEGV $$"]
[[row]]
name = "bad"
command = ["sh", "-c", "echo no such thing >&2; exit 2"]
[[row]]
name = "absent"
command = ["/no/such/program"]
"""


def regress_mistakes():
    """A plan that is wrong is one line and status 2 before anything runs."""
    good = '[[row]]\nname = "a"\ncommand = ["touch", "{plan}/ran"]\n'
    for text, wanted in ((good + '[[row]]\nbench = "smok"\n', "plan.toml:5: bench: found \"smok\"; expected one of"),
                         (good + '[[row]]\nbench = "smoke"\nengine = "verilog"\n', "engine verilog"),
                         (good + '[[row]]\nbench = "smoke"\nboard = "none"\n', "board none: no such board"),
                         (good + '[[row]]\nbench = "clock-macro"\nboard = "geobrick-lv-8"\n', "it needs"),
                         (good + '[[row]]\nbench = "smoke"\nseeds = "9-1"\n', "seeds: found \"9-1\"; expected seeds"),
                         (good + '[[row]]\nbench = "smoke"\nseeds = -1\n', "seeds: found -1"),
                         (good + '[[row]]\nbench = "smoke"\nfresh = 0\n', "fresh: found 0"),
                         (good + '[[row]]\nbench = "smoke"\nskew = 1\n', "plan.toml:6: skew: found 1; expected true"),
                         (good + '[[row]]\nbench = "smoke"\nskew = [true, 1]\n', "plan.toml:6: skew: found 1"),
                         (good + '[[row]]\nbench = "smoke"\nskew = []\n', "plan.toml:6: skew: found []; expected true"),
                         (good + '[[row]]\nbench = "smoke"\nlimit = "soon"\n', "limit: found \"soon\""),
                         (good + '[[row]]\nbench = "smoke"\nsize = 3\n', "an end of its own"),
                         (good + '[[row]]\nbench = "smoke"\nspeed = 3\n', "unknown key speed"),
                         (good + '[[row]]\ncommand = []\n', "a program and its arguments"),
                         (good + '[[row]]\nseeds = 1\n', "key bench is missing"),
                         ("title = 3\n" + good, "a text in quotes"),
                         ("row = []\n", "rows that make one run or more"),
                         ("[[row]\n", "expected TOML")):
        folder = Folder(text)
        r = folder.regress()
        check(r.returncode == 2 and wanted in r.stderr and r.stderr.count("\n") == 1, f"{text!r}: {r}")
        check(not folder.out.exists() and not (folder.path / "ran").exists(), f"{text!r}: something was made")
    folder = Folder(good)
    for options, wanted in ((["--jobs", "0"], "--jobs 0"), (["--fresh-from", "x"], "--fresh-from"),
                            (["-o", str(folder.plan)], "cannot be written")):
        r = brick("regress", str(folder.plan), *options)
        check(r.returncode == 2 and wanted in r.stderr, f"{options}: {r}")
    r = brick("regress", str(folder.path / "none.toml"))
    check(r.returncode == 2 and "cannot be read; expected a plan" in r.stderr, str(r))
    (folder.out / "runs").mkdir(parents=True)
    r = folder.regress()
    check(r.returncode == 2 and "somebody else" in r.stderr, f"a folder of others: {r}")


def regress_kinds():
    """Each verdict; failures in kinds, with seeds, the command that repeats one and its waveform; three reports."""
    folder = Folder(MIXED)
    r = folder.regress("--jobs", "2")
    check(r.returncode == 1, f"exit {r.returncode}: {r.stdout}{r.stderr}")
    verdicts = folder.verdicts()
    wanted = {"smoke.systemc_geobrick-lv-8.seed-31": "passed", "smoke.systemc_geobrick-lv-8.seed-32": "passed",
              "smoke.systemc_geobrick-lv-8_negative.seed-41": "failed",
              "smoke.systemc_geobrick-lv-8_negative.seed-42": "failed", "late.seed-1": "limit",
              "crash.seed-1": "crashed", "bad.seed-1": "bad", "absent.seed-1": "crashed"}
    wanted.update({f"odd.seed-{n}": "failed" if n % 2 else "passed" for n in range(1, 6)})
    check(verdicts == wanted, f"{verdicts}")
    report = folder.report()
    check(report["counts"] == {"runs": 13, "passed": 4, "failed": 9, "skipped": 0, "not_run": 0}, str(report["counts"]))
    odd, smoke = bucket(report, "odd"), bucket(report, "smoke")
    check(len(odd) == 1 and odd[0]["seeds"] == [1, 3, 5] and odd[0]["says"] == "step #: Error: # and #", str(odd))
    check(len(smoke) == 1 and smoke[0]["count"] == 2 and smoke[0]["step"] == "servo period #, ticks", str(smoke))
    for words, group in (("no end within", "late"), ("SIGSEGV", "crash"), ("no such thing", "bad"),
                         ("/no/such/program: cannot be run", "absent")):
        check(words in bucket(report, group)[0]["says"], f"{group}: {bucket(report, group)}")
    again = subprocess.run(smoke[0]["command"].replace("brick", command.BRICK, 1), shell=True, capture_output=True,
                           text=True)
    check(again.returncode == 1 and "FAIL  servo period 1, ticks" in again.stdout, f"the command: {again}")
    replay = smoke[0]["replay"]
    check((folder.out / replay["wave"]).stat().st_size > 1000 and replay["note"] == "", str(replay))
    check((folder.out / replay["view"]).read_text().count("servo"), "the view of the bench")
    build = report["build"]
    check(build["version"] in brick("--version").stdout and len(build["image"]) == 16, str(build))
    suites = xml.parse(folder.out / "report.xml").getroot()
    sums = {s.get("name"): [s.get(k) for k in ("tests", "failures", "errors", "skipped")] for s in suites}
    check(sums["smoke"] == ["4", "2", "0", "0"] and sums["late"] == ["1", "0", "1", "0"], str(sums))
    check(sum(len(s) for s in suites) == 13, "a case a run")
    page = (folder.out / "report.html").read_text()
    embedded = page.split('id="report">')[1].split("</script>")[0]
    check(json.loads(embedded) == report, "the page holds another report")
    check("echo step" in embedded and "</" not in embedded, "what stands in the page ends its script")
    look_at_page(folder, report)


def look_at_page(folder, report):
    """In a browser: filter, table and links work, pictures are there, no word of error, nothing asked from outside."""
    with Browser() as page:
        page.open(folder.out / "report.html")
        rows = "[...document.querySelectorAll('#runs tbody tr')].map(r => r.textContent)"
        filtered = f"document.getElementById('filter').value = '%s'; show(); {rows}"
        check(len(page.value(rows)) == 13, "a row a run")
        for words, wanted in (("odd 3 failed", 1), ("smoke", 4), ("SMOKE seed-41", 1), ("nothing", 0), ("", 13)):
            found = page.value(filtered.replace("show()", "document.getElementById('filter').oninput()") % words)
            check(len(found) == wanted, f"filter {words!r}: {found}, expected {wanted}")
        cell = "document.querySelector('#matrix button[aria-label^=\"odd, \"]')"
        check(page.value(f"{cell}.textContent") == "2/5", "passed of all")
        check(len(page.value(f"{cell}.click(); {rows}")) == 5 and len(page.value(f"{cell}.click(); {rows}")) == 13,
              "the cells choose")
        links = page.value("[...document.querySelectorAll('a')].map(a => a.getAttribute('href'))")
        check(len(links) == 1 and (folder.out / links[0]).is_file(), f"links: {links}")
        sizes = page.value("Promise.all([...document.querySelectorAll('.bucket img')].map(i => "
                           "i.decode().then(() => [i.naturalWidth, i.naturalHeight])))")
        check(len(sizes) == 1 and sizes[0][0] > 900 and sizes[0][1] > 300, f"pictures: {sizes}")
        drawn = page.value("JSON.parse(document.getElementById('pictures').textContent)[1]").splitlines()
        phase = [drawn[i + 1] for i, line in enumerate(drawn) if ">clock.phase<" in line]
        turns = len(re.findall("V[0-9]", phase[0]))  # of 1.001 ms at 9.04 kHz
        check(turns in (18, 19) and "c4302b" in drawn[-2], f"{turns} turns of PHASE, expected 18 or 19")
        check(not page.said, f"the page complains: {page.said}")
        check(all(u.startswith(("file:", "data:")) for u in page.asked) and len(page.asked) < 4, f"asks: {page.asked}")
        if "BRICK_PAGE_PNG" in os.environ:
            page.picture(os.environ["BRICK_PAGE_PNG"])


def regress_rows():
    """Every choice of a row, each run once though two rows ask for it; of a pattern what boards can do."""
    folder = Folder('[[row]]\nbench = "smoke"\nengine = ["systemc", "rtl"]\nboard = ["geobrick-lv-8", "umac-turbo"]\n'
                    'seeds = [7, "7-8"]\n[[row]]\nbench = "smo*"\nseeds = 8\n[[row]]\nbench = "clock-m*"\n'
                    'board = ["geobrick-lv-8", "turbo-pmac2-ultralite"]\naperture = ["0.5", "1"]\n'
                    '[[row]]\nbench = "rotary-machining"\nsize = 50\n'
                    '[[row]]\nbench = "flags"\nskew = [false, true]\n[[row]]\nbench = "dpram"\nskew = true\n')
    r = folder.regress("--list")
    lines = r.stdout.splitlines()
    check(len(lines) == len(set(lines)) == 14, r.stdout + r.stderr)
    for wanted in ("smoke --engine rtl --board umac-turbo --seed 8",
                   "smoke --engine systemc --board geobrick-lv-8 --seed 7",
                   "clock-macro --engine systemc --board turbo-pmac2-ultralite --aperture 0.5 --seed 1",
                   "rotary-machining --engine systemc --board geobrick-lv-8 --size 50 --seed 1",
                   "flags --engine systemc --board geobrick-lv-8 --seed 1",
                   "flags --engine systemc --board geobrick-lv-8 --skew --seed 1",
                   "dpram --engine systemc --board geobrick-lv-8 --skew --seed 1"):
        check(f"brick run {wanted}" in lines, f"{wanted} in {lines}")
    check(not folder.out.exists(), "--list has made something")
    last = 2**64 - 1
    seeds = Folder(f'[[row]]\nbench = "smoke"\nseeds = "{last - 1}-{last}"\n').regress("--list").stdout.split()[-1::-9]
    check(seeds == [str(last), str(last - 1)], f"the last seeds that there are: {seeds}")
    for plan in sorted(pathlib.Path(__file__).resolve().parents[3].glob("plans/*.toml")):
        r = brick("regress", str(plan), "--list")
        check(r.returncode == 0 and len(r.stdout.splitlines()) >= 10, f"{plan.name}: {r.stderr}")


def regress_resume():
    """What is there is not made again, more seeds add to it, failures are made again if asked for, and nothing of
    another command counts."""
    plan = '[[row]]\nname = "n"\ncommand = ["sh", "-c", "echo x >> {plan}/log; exit {seed}"]\nseeds = "0-1"\n'
    folder = Folder(plan)
    log = folder.path / "log"

    def runs():
        return len(log.read_text().splitlines()) if log.exists() else 0

    check(folder.regress().returncode == 1 and runs() == 2, "both")
    r = folder.regress("--resume")
    check(r.returncode == 1 and runs() == 2 and "2 taken over" in r.stdout, f"again: {r}")
    folder.write(plan.replace("0-1", "0-2"))
    folder.regress("--resume")
    check(runs() == 3 and folder.report()["counts"]["runs"] == 3, "one seed more")
    folder.regress("--rerun-failed")
    check(runs() == 5, f"{runs()} runs, expected the two that failed again")
    (folder.out / "runs/n.seed-0/result.json").write_text('{"verdict": "passed"')
    folder.regress("--resume")
    check(runs() == 6, "half a result counts")
    folder.write(plan.replace("echo x", "echo  x"))
    folder.regress("--resume")
    check(runs() == 8, "results of another command count")
    folder.regress()
    check(runs() == 10, "without --resume")
    r = folder.regress("--minutes", "0")
    check(r.returncode == 1 and runs() == 10 and "2 not run: --resume makes them" in r.stdout, f"no time: {r}")
    suite = xml.parse(folder.out / "report.xml").getroot()[0]
    check([suite.get(k) for k in ("failures", "errors", "skipped")] == ["0", "2", "0"], "JUnit: not run")
    fresh = Folder('[[row]]\nname = "n"\ncommand = ["true", "{seed}"]\nfresh = 40\n')
    fresh.regress()
    before = set(fresh.verdicts())
    r = fresh.regress("--resume")
    check("40 taken over" in r.stdout and set(fresh.verdicts()) == before and len(before) == 40, f"fresh seeds: {r}")
    check(all(int(name.split("-")[1]) > 30 for name in before), "a usual seed is none that is fresh")


def regress_inputs():
    """A result is of the contents that it was made with: another board, program, image or executable of this name makes
    the run again, and that run alone."""
    folder = Folder('[[row]]\nbench = "port-a-phase"\nboard = "b.toml"\n[[row]]\nname = "n"\n'
                    'command = ["{plan}/n.sh", "--of={plan}/data"]\n[[row]]\nname = "other"\ncommand = ["true"]\n'
                    '[[row]]\nname = "ours"\ncommand = ["brick", "boards", "{plan}/ours.toml"]\n')
    tool, board, data, other = (folder.path / name for name in ("n.sh", "b.toml", "data", "ours.toml"))
    for path in (board, other):
        shutil.copy(command.BOARDS / "geobrick-lv-8.toml", path)
    tool.write_text("#!/bin/sh\n")
    tool.chmod(0o755)
    data.write_text("1")
    own = folder.path / "install/bin/brick"
    own.parent.mkdir(parents=True)
    (own.parent.parent / "share").symlink_to(pathlib.Path(command.BRICK).parent.parent / "share")
    for name in ("brick", "turbo.elf"):
        shutil.copy(pathlib.Path(command.BRICK).with_name(name), own.parent)

    def taken_over():
        r = subprocess.run([own, "regress", folder.plan, "-o", folder.out, "--resume", "--no-replay"],
                           capture_output=True, text=True)
        found = re.search("(\\d+) taken over", r.stdout)
        return int(found[1]) if found else 0

    check([taken_over(), taken_over()] == [0, 4], "all of what did not change")
    for path, kept in ((board, 3), (tool, 3), (data, 3), (other, 3), (own, 0), (own.with_name("turbo.elf"), 0)):
        with open(path, "a") as file:
            file.write("\n#\n")
        check([taken_over(), taken_over()] == [kept, 4], f"{path.name} is another one")


# Says when it begins and ends; each line is written in one piece. Between, it waits for something, not for ever.
NOTED = ('command = ["sh", "-c", "echo {{seed}} begins >> {{plan}}/log; for i in $(seq 100); do {until} && break; '
         'sleep 0.1; done; echo {{seed}} ends >> {{plan}}/log"]\n')
A_WHILE, BOTH = "[ $i -gt 6 ]", "[ $(grep -c '^[34] begins' {plan}/log) = 2 ]"


def crowds(log):
    """{run: those that ran beside it}"""
    running, beside = set(), {}
    for run, what in map(str.split, log.read_text().splitlines()):
        if what == "ends":
            running.remove(run)
            continue
        beside[run] = set(running)
        for other in running:
            beside[other].add(run)
        running.add(run)
    return beside


def some_alone(until, *options):
    """A folder with the results of a plan whose runs 1, 2 and 5 have nothing beside them; 3 and 4 go on `until`. On a
    cluster two of them fill a task."""
    folder = Folder("".join(f'[[row]]\nname = "n"\n{NOTED.format(until=until)}seeds = {seeds}\nalone = {alone}\n'
                            for seeds, until, alone in (("[1, 2]", A_WHILE, "true"), ("[3, 4]", until, "false"),
                                                        ("5", A_WHILE, "true"))))
    r = folder.regress("--jobs", "3", *options)
    check(r.returncode == 0, f"{r}")
    beside = crowds(folder.path / "log")
    check(len(beside) == 5, f"{beside}")
    check([run for run in "125" if beside[run]] == [], f"beside those alone: {beside}")
    return folder, beside


def regress_alone():
    """What is to run alone has nothing beside it, whatever comes before and after; the others run together."""
    folder, beside = some_alone(BOTH)
    check(beside["3"] == {"4"}, f"one at a time: {beside}")
    folder.write(folder.plan.read_text() + '[[row]]\nname = "late"\ncommand = ["true"]\nalone = "yes"\n')
    r = folder.regress()
    check(r.returncode == 2 and "alone: found \"yes\"" in r.stderr, f"{r}")


def regress_rank():
    """Covers of the runs that passed, together; the runs by what each adds, until none adds anything."""
    folder = Folder('[[row]]\nname = "own"\n'
                    'command = ["sh", "-c", "cp {plan}/{seed}.json run.json; exit $(({seed} / 5))"]\n'
                    'seeds = "1-5"\n[[row]]\nbench = "smoke"\nseeds = "7-8"\n')
    brought = {"a": 1, "b": 1}, {"a": 7, "c": 5}, {"c": 10, "d": 1, "e": 1}, {"a": 1}, {"f": 1}
    for seed, counts in enumerate(brought, 1):
        covers = {name: {"count": n, "least": 10 if name == "c" else 1} for name, n in counts.items()}
        (folder.path / f"{seed}.json").write_text(json.dumps({"covers": covers}))
    r = folder.regress("--rank")
    report = folder.report()
    covers = {c["name"]: (c["counts"], c["least"], c["reached"]) for c in report["covers"]}
    ours = {name: c for name, c in covers.items() if len(name) == 1}
    check(ours == {"a": ({"own": 9}, 1, True), "b": ({"own": 1}, 1, True), "c": ({"own": 15}, 10, True),
                   "d": ({"own": 1}, 1, True), "e": ({"own": 1}, 1, True)}, f"{ours}: expected none of the failed run")
    # seed 3 brings c, d, e; then seed 1 brings a and b; nothing is left for seeds 2 and 4
    ranked = [(k["run"], k["adds"]) for k in report["ranked"] if k["run"].startswith("own")]
    check(ranked == [("own.seed-3", 3.0), ("own.seed-1", 2.0)], f"{ranked}")
    check("3.0 new" in r.stdout and f"{len(covers)} of {len(covers)} covers" in r.stdout, r.stdout)
    # 16 walking ones of either run
    check(covers["smoke: dual-ported RAM, walking ones"] == ({"systemc": 32}, 16, True), f"{covers}")
    check(any(name.startswith("bus: 104, ") for name in covers), "rules of the bus by region")


def regress_skips():
    """A command that ends with 77 lacks something: no failure, but said wherever results are."""
    folder = Folder('[[row]]\nname = "n"\ncommand = ["sh", "-c", "echo no lintian; exit {seed}"]\n'
                    'seeds = [0, 77]\n')
    r = folder.regress()
    check(r.returncode == 0 and "SKIP: no lintian" in r.stdout and "2 runs, 0 failed, 1 skipped" in r.stdout, f"{r}")
    report = folder.report()
    check(report["verdict"] == "passed" and folder.verdicts()["n.seed-77"] == "skipped", str(report))
    check(report["counts"] == {"runs": 2, "passed": 1, "failed": 0, "skipped": 1, "not_run": 0}, str(report["counts"]))
    check([(b["verdict"], b["says"]) for b in report["buckets"]] == [("skipped", "no lintian")], str(report["buckets"]))
    suite = xml.parse(folder.out / "report.xml").getroot()[0]
    check([suite.get(k) for k in ("failures", "errors", "skipped")] == ["0", "0", "1"], "JUnit")
    folder.write(folder.plan.read_text().replace("[0, 77]", "[1, 77]"))
    r = folder.regress("--resume")
    check(r.returncode == 1 and "1 taken over" in r.stdout, f"a failure beside it: {r}")
    folder.write(folder.plan.read_text().replace("[1, 77]", "77"))
    r = folder.regress("--resume")
    check(r.returncode == 1 and "FAIL plan: 1 runs, 0 failed, 1 skipped, none passed" in r.stdout, f"nothing else: {r}")
    check(folder.report()["verdict"] == "failed", "a plan of which nothing was tested has passed")


def sleepers(mark):
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if words[:2] == [b"sleep", mark.encode()]:
            found.append(int(process.name))
    return found


def wait_for(condition, what):
    end = time.monotonic() + 60
    while not condition():
        check(time.monotonic() < end, what)
        time.sleep(0.02)


def regress_killed():
    """SIGINT ends with reports of what is there; whatever kills it, nothing of it lives on; --resume goes on."""
    mark = f"{1000 + os.getpid()}.5"
    plan = ('[[row]]\nname = "quick"\ncommand = ["true", "{seed}"]\nseeds = "1-3"\n'
            f'[[row]]\nname = "slow"\ncommand = ["sh", "-c", "sleep {mark} & sleep {mark}; exit 0"]\nseeds = "1-2"\n')
    for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        folder = Folder(plan)
        r = subprocess.Popen([command.BRICK, "regress", str(folder.plan), "-o", str(folder.out), "--jobs", "2"],
                             stdout=subprocess.PIPE, text=True)
        wait_for(lambda: len(sleepers(mark)) == 4, "the slow ones do not run")
        r.send_signal(kind)
        said, _ = r.communicate(timeout=60)
        wait_for(lambda: not sleepers(mark), f"{kind.name}: {sleepers(mark)} live on")
        if kind == signal.SIGKILL:
            check(r.returncode == -kind, f"exit {r.returncode}")
        else:
            check(r.returncode == 1 and "2 not run: --resume makes them" in said,
                  f"{kind.name}: {r.returncode} {said}")
            wanted = {"runs": 5, "passed": 3, "failed": 0, "skipped": 0, "not_run": 2}
            check(folder.report()["counts"] == wanted, "counts")
        folder.write(plan.replace(f"sleep {mark}", "true"))
        r = folder.regress("--resume")
        check(r.returncode == 0 and "3 taken over" in r.stdout, f"resumed: {r}")


def regress_nohup():
    """A signal that was ignored at the start, as SIGHUP is under nohup, ends nothing."""
    folder = Folder('[[row]]\nname = "n"\ncommand = ["sh", "-c", "until [ -e {plan}/go ]; do sleep 0.02; done"]\n')
    r = subprocess.Popen(["sh", "-c", "trap '' HUP INT; exec \"$@\"", "sh", command.BRICK, "regress", folder.plan, "-o",
                          folder.out], stdout=subprocess.PIPE, text=True)
    wait_for((folder.out / "runs/n.seed-1/output.txt").exists, "nothing runs")
    for kind in (signal.SIGHUP, signal.SIGINT):
        r.send_signal(kind)
    (folder.path / "go").touch()
    said, _ = r.communicate(timeout=60)
    check(r.returncode == 0 and "PASS plan: 1 runs, 0 failed" in said, f"exit {r.returncode}: {said}")


def regress_one_at_a_time():
    """A folder is of the regression that works there; the next one has it when that has ended, whatever ends it."""
    mark = f"{2000 + os.getpid()}.5"
    plan = f'[[row]]\nname = "slow"\ncommand = ["sleep", "{mark}"]\nlimit = "20s"\n'
    folder = Folder(plan)
    first = subprocess.Popen([command.BRICK, "regress", folder.plan, "-o", folder.out], stdout=subprocess.DEVNULL)
    wait_for(lambda: sleepers(mark), "the slow one does not run")
    for options in ([], ["--resume"]):
        r = folder.regress(*options)
        check(r.returncode == 2 and "another brick regress works there" in r.stderr and r.stderr.count("\n") == 1,
              f"{options}: {r}")
    check(sleepers(mark) and first.poll() is None, "the first one has been disturbed")
    first.kill()
    first.wait()
    folder.write(plan.replace("sleep", "true"))
    r = folder.regress()
    check(r.returncode == 0 and folder.report()["counts"]["passed"] == 1, f"after the end of the first: {r}")


class Slurm:
    """A cluster of this machine alone: its two daemons with a configuration of their own, as this user."""

    def __init__(self, folder):
        daemons = [shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin") for name in ("slurmctld", "slurmd")]
        if not all(daemons) or not shutil.which("sbatch"):
            print("slurmctld, slurmd and slurm-client are not installed (./dev setup does it)")
            sys.exit(77)
        ports = []
        for _ in range(2):
            with socket.socket() as s:
                s.bind(("127.0.0.1", 0))
                ports.append(s.getsockname()[1])
        host, user = socket.gethostname().split(".")[0], getpass.getuser()
        for name in ("state", "spool"):
            (folder / name).mkdir()
        (folder / "slurm.conf").write_text(f"""ClusterName=brick
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=4
PartitionName=main Nodes=ALL Default=YES
""")
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
        self.folder, self.daemons, self.running = folder, daemons, []

    def said(self, *words):
        return subprocess.run(words, capture_output=True, text=True).stdout

    def __enter__(self):
        try:
            for daemon in self.daemons:  # which end with us, whatever kills us
                with open(self.folder / f"{pathlib.Path(daemon).name}.log", "w") as log:
                    self.running.append(subprocess.Popen(["setpriv", "--pdeathsig", "KILL", daemon, "-D"],
                                                         stdout=log, stderr=log))
            wait_for(lambda: "idle" in self.said("sinfo", "--noheader"), "no node is idle")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in self.running:
            daemon.terminate()
            daemon.wait()


def alike(report):
    """Without times, hosts and paths."""
    del report["wall_seconds"]
    for run in report["runs"]:
        del run["wall_seconds"], run["host"]
    return report


def regress_slurm():
    """On a cluster the report is the same; a task that is killed costs its run alone, and --resume makes that. A call
    that is killed leaves its array, which the next one ends."""
    plan = ('[[row]]\nbench = "smoke"\nseeds = 31\n[[row]]\nbench = "smoke"\nnegative = true\nseeds = 41\n'
            '[[row]]\nname = "odd"\ncommand = ["sh", "-c", "echo step {seed}: Error: 0x1F; exit $(({seed} % 2))"]\n'
            'seeds = "1-9"\n[[row]]\nname = "crash"\ncommand = ["sh", "-c", "kill -SEGV $$"]\n'
            '[[row]]\nname = "slow"\ncommand = ["sh", "-c", "test -e {plan}/quick || sleep 60"]\n'
            '[[row]]\nname = "late"\ncommand = ["sleep", "60"]\nlimit = "300ms"\n')
    folder = Folder(plan)
    folder.out = folder.path / "50%a $(touch slurm_was_here) 'out"
    (folder.path / "cluster").mkdir()
    with Slurm(folder.path / "cluster") as slurm:
        on_cluster = ("--slurm", "--task-seconds", "2", "--jobs", "3", "--no-replay", "--fresh-from", "7")
        r = subprocess.Popen([command.BRICK, "regress", str(folder.plan), "-o", str(folder.out), *on_cluster],
                             stdout=subprocess.PIPE, text=True)
        tasks = folder.out / "slurm"
        wait_for((folder.out / "runs/slow.seed-1").exists, "the slow one does not run")
        files = {t.name: json.loads(t.read_text()) for t in tasks.glob("*.json")}
        check(1 < len(files) < 14, f"{len(files)} tasks of 14 runs, expected some of some runs each")
        slow = [n for n, t in files.items() if "slow.seed-1" in [p["run"]["name"] for p in t["parts"]]]
        number = slow[0].split("-")[1].split(".")[0]
        slurm.said("scancel", f"{(tasks / 'job.txt').read_text().strip()}_{number}")
        said, _ = r.communicate(timeout=60)
        check(not pathlib.Path("slurm_was_here").exists(), "a shell has read the name of the folder")
        check(all((tasks / name).with_suffix(".txt").exists() for name in files), f"{list(tasks.iterdir())}")
        check(r.returncode == 1 and "1 not run: --resume makes them" in said, f"a task was killed: {said}")
        check(folder.verdicts()["slow.seed-1"] == "not run", "what was killed has a verdict")
        check(not (tasks / "job.txt").exists() and not slurm.said("squeue", "--noheader"), "somebody still works")
        (folder.path / "quick").touch()
        r = folder.regress("--resume", *on_cluster)
        check(folder.verdicts()["slow.seed-1"] == "passed" and "13 taken over" in r.stdout, f"resumed: {r}")
        on_it = alike(folder.report())
        folder.out = folder.path / "local"
        folder.regress("--no-replay", "--jobs", "2", "--fresh-from", "7")
        here = alike(folder.report())
        check(on_it == here, f"another report than the local one: {on_it}\n{here}")
        (folder.path / "quick").unlink()
        folder.out = folder.path / "killed"
        r = subprocess.Popen([command.BRICK, "regress", str(folder.plan), "-o", str(folder.out), *on_cluster])
        wait_for((folder.out / "runs/slow.seed-1").exists, "the slow one does not run")
        r.kill()
        r.wait()
        job = (folder.out / "slurm/job.txt").read_text().strip()
        check(slurm.said("squeue", "--noheader", f"--jobs={job}"), "the array has ended with the call")
        (folder.path / "quick").touch()
        r = folder.regress("--resume", *on_cluster)
        check(alike(folder.report()) == here, f"after a kill: {r}")
        check(not slurm.said("squeue", "--noheader"), "the array of the call that was killed still works")
        some_alone(A_WHILE, "--slurm", "--task-seconds", "1")
        os.environ["PATH"] = ""
        r = folder.regress("--slurm")
        check(r.returncode == 2 and "sbatch: " in r.stderr and "expected a cluster" in r.stderr, f"no cluster: {r}")


def regress_left_over():
    """The array of a call that was killed: ended, or unknown to the cluster by now; a cluster that does not answer may
    still run it, so nothing begins then and the next call asks again."""
    for says, status in (("Invalid job id specified", 0), ("Unable to contact slurm controller", 2)):
        folder = Folder('[[row]]\nname = "n"\ncommand = ["true"]\n')
        programs, job = folder.path / "bin", folder.out / "slurm/job.txt"
        for place in (programs, job.parent):
            place.mkdir(parents=True)
        for name in ("scancel", "squeue"):
            (programs / name).write_text(f"#!/bin/sh\necho {name}: error: {says} >&2\nexit 1\n")
            (programs / name).chmod(0o755)
        job.write_text("7\n")
        r = subprocess.run([command.BRICK, "regress", str(folder.plan), "-o", str(folder.out)], capture_output=True,
                           text=True, timeout=60, env={**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"})
        check(r.returncode == status and job.exists() == (status == 2), f"{says}: {r}")
        check(status == 0 or (says in r.stderr and not (folder.out / "runs").exists()), f"{says}: {r}")


globals()[command.CASE]()
