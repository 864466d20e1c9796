#!/usr/bin/env python3
"""Installs the package outside the tree and builds and runs its examples as a user does.

Two commands in an empty folder build and run all examples of the tree, by CMake; one program is built and run with
each of the pkg-config files. Each example's tests have to run, none may be skipped (exit status 77 when all that is
wrong is that a tool of an example is not installed), and the waveform that one of them writes is looked at. Of the
installed pages no link leads to nothing, and each is a file of the tree, byte for byte. Nothing that is installed may
name this tree or its build folder, but the image, whose sources a debugger looks for.
check_package.py --build DIR [--programs], or --prefix DIR [--examples DIR] for what is installed already. --programs:
of the examples the program of each pkg-config file alone.
"""

import argparse
import importlib.util
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from common import ROOT, finish, skip, tracked

EXAMPLES = "share/brick/examples"
IMAGE = "share/brick/turbo.elf"
MADE = "licences/", "copyright", "changelog.gz"  # of what stands beside the pages
TOOLS = {"cocotb_servo_channel": ["iverilog", "vvp"], "firmware": ["riscv64-unknown-elf-gcc", "make", "patch"]}
PROGRAMS = {"brick": ("servo_ic", []), "brick-rtl": ("board", ["rtl"])}  # of each pkg-config file: example, arguments


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    return done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"


def points_back(prefix, places):
    """Files of the installed tree that name the source or the build folder."""
    for file in sorted(p for p in prefix.rglob("*") if p.is_file() and p != prefix / IMAGE):
        content = file.read_bytes()
        yield from (f"{file.relative_to(prefix)} names {place}" for place in places if place.encode() in content)


def dead_links(prefix):
    for page in sorted((prefix / "share/doc").rglob("*.md")):
        for link in re.findall(r"\]\(([^)\s#]+)[^)\s]*\)", page.read_text()):
            if not re.match("[a-z]+:", link) and not (page.parent / link).exists():
                yield f"{page.relative_to(prefix)}: {link} is not installed"


def other_pages(prefix):
    """Installed pages that are no files of the tree, or others: nothing that was made beside it goes into a package."""
    known = {str(file) for file in tracked(ROOT)}
    folder = prefix / "share/doc/brick"
    for page in sorted(page for page in folder.rglob("*") if page.is_file()):
        name = str(page.relative_to(folder))
        if not name.startswith(MADE) and (name not in known or page.read_bytes() != (ROOT / name).read_bytes()):
            yield f"{page.relative_to(prefix)}: is not {name} of the tree"


def without_tools():
    """{example that cannot run here: what is missing}."""
    missing = {name: [tool for tool in tools if shutil.which(tool) is None] for name, tools in TOOLS.items()}
    if importlib.util.find_spec("cocotb") is None:
        missing["cocotb_servo_channel"].append("cocotb")
    return {name: tools for name, tools in missing.items() if tools}


def examples(prefix, work, compiler, wanted):
    """The two commands; what went wrong, "" when nothing. `wanted`: the folders that have to be there."""
    lists = sorted((prefix / EXAMPLES).glob("*/CMakeLists.txt"))
    absent = set(wanted) - {file.parent.name for file in lists}
    if absent:
        return f"{EXAMPLES}: not installed: {', '.join(sorted(absent))}"
    expected = sum(len(re.findall(r"\badd_test\(", file.read_text())) for file in lists)
    environment = {**os.environ, "CTEST_OUTPUT_ON_FAILURE": "1", "CXX": compiler}
    for command in (["cmake", "-S", prefix / EXAMPLES, "-B", ".", f"-DPython3_EXECUTABLE={sys.executable}"],
                    ["cmake", "--build", ".", "--target", "all", "test"]):
        good, text = run(command, cwd=work, env=environment)
        if not good:
            return text
    ran = re.search(r"100% tests passed, 0 tests failed out of (\d+)", text)
    if ran is None or int(ran.group(1)) != expected or expected < len(PROGRAMS):
        count = ran.group(1) if ran else "no"
        return f"{text}\n{EXAMPLES}: {count} tests ran; expected: the {expected} of {len(lists)} examples"
    skipped = {name for name in re.findall(r"Test +#\d+: (\S+) .*\*\*\*(?:Skipped|Not Run)", text)
               if not name.startswith(tuple(without_tools()))}
    return f"{EXAMPLES}: skipped: {', '.join(sorted(skipped))}" if skipped else ""


def pins_of(component):
    """Its pins as the page has them, those of a channel four times."""
    page = (ROOT / "docs/components.md").read_text()
    table = re.search(rf"<!-- pins of {component} -->(.*?)<!-- end -->", page, re.S).group(1)
    names = re.findall(r"^\| `(\w+)`", table, re.M)
    return [name.replace("chN", f"ch{n}") for name in names for n in (range(1, 5) if "chN" in name else [0])]


def waveform(file):
    """What the waveform of examples/servo_ic lacks: all pins, 40 quarters of an encoder, PHASE in 13057 ticks."""
    if not file.exists():
        return f"{file.name} was not written"
    text = file.read_text()
    scale = re.search(r"\$timescale\s+1 (\w+)", text)
    names = dict(re.findall(r"\$var \w+ +1 +(\S+) +(\S+) +\$end", text))
    times, levels, now = {name: [] for name in names.values()}, {}, 0
    for mark, value, code in re.findall(r"^(?:#(\d+)|([01])(\S+))$", text, re.M):
        if mark:
            now = int(mark)
        elif code in names and levels.get(code, value) != value:
            times[names[code]].append((now, value))
        if not mark:
            levels[code] = value
    rises = [at for at, value in times.get("phase_o", []) if value == "1"]
    periods = {round((b - a) * 9216 / 78_125_000) for a, b in itertools.pairwise(rises)}
    found = {"unit": scale and scale.group(1), "missing": sorted(set(pins_of("servo_ic")) - set(times)),
             "quarters": [len(times.get(f"ch1_enc_{line}", [])) for line in "ab"], "ticks of PHASE": sorted(periods)}
    right = {"unit": "ps", "missing": [], "quarters": [20, 20], "ticks of PHASE": [13057]}
    wrong = [f"{what} {found[what]}, expected {right[what]}" for what in right if found[what] != right[what]]
    return f"{file.name}: {'; '.join(wrong)}" if wrong else ""


def pkg_config(package, prefix, work, compiler):
    """An example's program by pkg-config in place of CMake; what went wrong."""
    folder, arguments = PROGRAMS[package]
    file = next(prefix.rglob(f"pkgconfig/{package}.pc"), None)
    if file is None:
        return f"{package}.pc is not installed"
    environment = {**os.environ, "PKG_CONFIG_PATH": str(file.parent)}
    good, flags = run(["pkg-config", "--cflags", "--libs", package], env=environment)
    if not good:
        return f"{package}.pc: {flags}"
    program = work / package
    main_cpp = prefix / EXAMPLES / folder / "main.cpp"
    defines = ["-DWITH_RTL"] if package == "brick-rtl" else []
    command = [compiler, "-std=c++17", *defines, main_cpp, "-o", program, *flags.splitlines()[1].split()]
    for step in (command, [program, *arguments]):
        good, text = run(step, cwd=work)
        if not good:
            return f"{package}.pc: {text}"
    return ""


def check(prefix, places, compiler, wanted, programs):
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        (work / "empty").mkdir()
        problems = [*points_back(prefix, places), *dead_links(prefix)]
        if not programs:
            problems.append(examples(prefix, work / "empty", compiler, wanted))
        if "servo_ic" in wanted and not programs:
            problems.append(waveform(work / "empty/servo_ic/servo_ic.vcd"))
        problems += [pkg_config(package, prefix, work, compiler) for package in PROGRAMS]
    return list(filter(None, problems))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--build", type=pathlib.Path)
    what.add_argument("--prefix", type=pathlib.Path)
    parser.add_argument("--examples", type=pathlib.Path, help="folders that have to be installed, default none")
    parser.add_argument("--programs", action="store_true")
    parser.add_argument("--compiler", default="c++")
    options = parser.parse_args()
    source = ROOT / "examples" if options.build else options.examples
    wanted = [path.parent.name for path in source.glob("*/CMakeLists.txt")] if source else []
    with tempfile.TemporaryDirectory() as name:
        prefix, places = (options.prefix or pathlib.Path(name)).resolve(), {str(ROOT)}
        if options.build:
            places.add(str(options.build.resolve()))
            good, text = run(["cmake", "--install", options.build, "--prefix", prefix])
            if not good:
                finish("package", [text])
        problems = [*(other_pages(prefix) if options.build else []),
                    *check(prefix, places, options.compiler, wanted, options.programs)]
    missing = {name: tools for name, tools in without_tools().items() if name in wanted and not options.programs}
    if missing and not problems:
        skip("; ".join(f"{name} needs {', '.join(tools)}" for name, tools in missing.items()))
    finish("package", problems)


if __name__ == "__main__":
    main()
