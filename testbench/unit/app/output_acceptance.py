"""The built command when what it writes finds no room: streams and files of results.

usage: output_acceptance.py BRICK CASE; each CASE is one test.
"""

import json
import os
import pathlib
import re
import resource
import subprocess
import tempfile

import command
from command import brick, check


def ended(arguments, script="", **streams):
    """(status, stderr) of a command whose stdin, stdout or stderr is a file, or None: closed."""
    closed = [n for n, name in enumerate(("stdin", "stdout", "stderr")) if name in streams and streams[name] is None]
    streams = {name: stream for name, stream in streams.items() if stream}
    r = subprocess.run([command.BRICK, *arguments], text=True, timeout=60, check=False,
                       **({"stdin": subprocess.DEVNULL} if "stdin" in streams else {"input": script}),
                       **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams},
                       preexec_fn=lambda: [os.close(n) for n in closed])
    return r.returncode, r.stderr


def output_lost():
    """A reader that goes, a full disk, a closed stream: status 1 and a line that says so, in the results too."""
    with tempfile.TemporaryDirectory() as folder, open("/dev/full", "w", encoding="ascii") as full:
        results = pathlib.Path(folder, "r.json")
        smoke = ["run", "smoke", "--engine", "systemc", "--json", str(results)]
        lost = "stdout took no more; expected room for what the command prints"
        for who, arguments in (("brick", ["list", "--json"]), ("brick", ["boards"]), ("brick run", smoke)):
            status, said = ended(arguments, stdout=full)
            check(status == 1 and said == f"{who}: {lost}\n", f"{arguments}: {status} {said}")
        for stream, status in (("full", 1), ("closed", ended(smoke, stdout=None)[0])):
            made = json.loads(results.read_text())
            said = [step["detail"] for step in made["steps"] if not step["passed"]]
            check(status == 1 and made["verdict"] == "FAIL" and said == [lost], f"stdout {stream}: {status}, {said}")
        check(ended(["exec", "none"], stderr=None)[0] == 2, "stderr closed")
        results.unlink()
        with subprocess.Popen([command.BRICK, "exec", "-", "--json", str(results)], text=True, stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as p:
            p.stdout.close()
            p.stdin.write("I16\nI17\n")
            p.stdin.close()
            said = p.stderr.read()
        check(p.returncode == 1 and "cannot be written to stdout" in said, f"reader gone: {p.returncode} {said}")
        check(len(json.loads(results.read_text())["exchanges"]) == 2, "the results")


def results_lost():
    """A file that cannot be written is a step that failed; the verdict and the others are written."""
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder, "r.json")
        for option, name in (("--wave", "w.vcd"), ("--record", "r.csv"), ("--cover", "c.info")):
            file = pathlib.Path(folder, name)
            file.symlink_to("/dev/full")
            r = brick("run", "smoke", "--engine", "systemc", option, str(file), "--json", str(results))
            check(r.returncode == 1 and "FAIL smoke" in r.stdout, f"{option}: {r}")
            made = json.loads(results.read_text())
            results.unlink()
            check(made["verdict"] == "FAIL" and name in made["steps"][-1]["detail"], f"{option}: {made['steps'][-1]}")
        room_ends(folder)
        no_room_for_fst(folder)
        unwritable(folder)
        r = subprocess.run([command.BRICK, "run", "smoke", "--cover", f"{folder}/c"], capture_output=True, text=True,
                           env={**os.environ, "PATH": folder}, timeout=60, check=False)
        check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"no disassembler: {r}")


def room_ends(folder):
    """A waveform or record for which there is no more room ends, with a line that says when; the run goes on."""
    for option, name, most in (("--wave", "w.vcd", 150_000), ("--record", "r.csv", 20_000)):
        file = pathlib.Path(folder, name)
        file.unlink(missing_ok=True)
        limits = (most, most)
        r = subprocess.run([command.BRICK, "exec", "-", option, str(file)], input="@wait 400ms\nI16\n", text=True,
                           capture_output=True, timeout=60, check=False,
                           preexec_fn=lambda limits=limits: resource.setrlimit(resource.RLIMIT_FSIZE, limits))
        check(r.returncode == 1 and r.stdout == "5\n", f"{option}: {r}")
        told = re.findall(rf"{name}: cannot .* beyond [a-z ]*(\d+\.\d+) ms: File too large.*; the run goes on",
                          r.stderr)
        check(len(told) == 1 and 0 < float(told[0]) < 400, f"{option}: {r.stderr}")
        check(0 < file.stat().st_size <= most, f"{option}: {file.stat().st_size} bytes")


def no_room_for_fst(folder):
    """FST, too, of which names, positions and times stand in files of their own at first: a line, not a signal."""
    for most in (1000, 4096, 6000, 20_000):
        file = pathlib.Path(folder, "w.fst")
        r = subprocess.run([command.BRICK, "run", "smoke", "--engine", "systemc", "--wave", str(file)], text=True,
                           capture_output=True, timeout=60, check=False,
                           preexec_fn=lambda most=most: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        check(r.returncode == 1 and "FAIL smoke" in r.stdout, f"{most} bytes: {r}")
        check(re.search(r"w\.fst: cannot write the waveform: no room for all of it", r.stdout), f"{most} bytes: {r}")


def unwritable(folder):
    """Found before the run; what is there stays."""
    kept = pathlib.Path(folder, "kept.json")
    kept.write_text("kept")
    for option in ("--json", "--profile", "--cover"):
        r = brick("run", "smoke", "--engine", "systemc", option, "/proc/none.json")
        check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"{option}: {r}")
        check(f"{option} /proc/none.json: cannot be written: " in r.stderr, f"{option}: {r}")
    new = pathlib.Path(folder, "new.json")
    for file in (kept, new):
        r = brick("exec", f"{folder}/none.txt", "--json", str(file), "--profile", f"{folder}/new.out")
        check(r.returncode == 2 and "none.txt" in r.stderr, f"{r}")
    check(kept.read_text() == "kept" and not new.exists() and not pathlib.Path(folder, "new.out").exists(), "as it was")


def same_file():
    """An output that is another output or an input, by whatever name: bad input, before anything is written."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        for name, text in (("s.txt", "I16\n"), ("b.toml", (command.BOARDS / "turbo-pmac-pci.toml").read_text()),
                           ("old.csv", "old")):
            (place / name).write_text(text)
        (place / "link.txt").symlink_to("s.txt")
        (place / "hard.csv").hardlink_to(place / "old.csv")
        (place / "sub").mkdir()
        files = {file: file.read_bytes() for file in place.iterdir() if file.is_file()}
        bench = ["run", "smoke", "--engine", "systemc"]
        for arguments, output, other in (
                ([*bench, "--wave", "a.vcd", "--json", "a.vcd"], "--json a.vcd", "--wave a.vcd"),
                ([*bench, "--record", "r.csv", "--profile", "sub/../r.csv"], "--profile sub/../r.csv",
                 "--record r.csv"),
                ([*bench, "--record", "r.csv", "--cover", f"{folder}/r.csv"], "--record r.csv",
                 f"--cover {folder}/r.csv"),
                ([*bench, "--flash", "f", "--json", "f"], "--json f", "--flash f"),
                ([*bench, "--record", "old.csv", "--json", "hard.csv"], "--json hard.csv", "--record old.csv"),
                (["exec", "s.txt", "--json", "link.txt"], "--json link.txt", "s.txt"),
                (["exec", "--board", "b.toml", "--json", "b.toml", "-"], "--json b.toml", "--board b.toml"),
                (["exec", "--load", "./s.txt", "--json", "s.txt", "-"], "--json s.txt", "--load ./s.txt"),
                (["console", "--history", "h", "--json", "h"], "--json h", "--history h"),
                (["serve", "--json", "x", "--profile", "x"], "--json x", "--profile x"),
                (["timing", "smoke", "--json", "w", "--wavedrom", "w"], "--json w", "--wavedrom w"),
                (["control", "sock", "--record", "r.csv", "--profile", "r.csv"], "--profile r.csv", "--record r.csv")):
            r = subprocess.run([command.BRICK, *arguments], input="", text=True, capture_output=True, timeout=60,
                               cwd=folder, check=False)
            check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"{arguments}: {r}")
            check(f": {output}: is {other} too; expected another file" in r.stderr, f"{arguments}: {r.stderr}")
        found = {file: file.read_bytes() for file in place.iterdir() if file.is_file()}
        check(found == files, f"{set(found) ^ set(files)}")
        r = brick("exec", "-", "--json", "/dev/null", "--profile", "/dev/null", script="I16\n")
        check(r.returncode == 0, f"a device may stand for two: {r}")


globals()[command.CASE]()
