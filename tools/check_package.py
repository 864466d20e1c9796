#!/usr/bin/env python3
"""Installs the package outside the tree and builds and runs its examples as a user does.

Two commands in an empty folder build and run all examples that the package brings, by CMake; one program is built and
run with each of its pkg-config files. Each example's tests have to run, none may be skipped. Nothing that is installed
may name this tree or its build folder: check_package.py --build DIR, or --prefix DIR for what is installed already.
"""

import argparse
import os
import pathlib
import re
import subprocess
import tempfile

from common import ROOT, finish

EXAMPLES = "share/brick/examples"
PROGRAMS = {"brick": ("servo_ic", []), "brick-rtl": ("board", ["rtl"])}  # of each pkg-config file: example, arguments


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    return done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"


def points_back(prefix, places):
    """Files of the installed tree that name the source or the build folder."""
    for file in sorted(p for p in prefix.rglob("*") if p.is_file()):
        content = file.read_bytes()
        yield from (f"{file.relative_to(prefix)} names {place}" for place in places if place.encode() in content)


def examples(prefix, work, compiler):
    """The two commands; what went wrong, "" when nothing."""
    lists = sorted((prefix / EXAMPLES).glob("*/CMakeLists.txt"))
    expected = sum(len(re.findall(r"\badd_test\(", file.read_text())) for file in lists)
    environment = {**os.environ, "CTEST_OUTPUT_ON_FAILURE": "1", "CXX": compiler}
    for command in (["cmake", "-S", prefix / EXAMPLES, "-B", "."],
                    ["cmake", "--build", ".", "--target", "all", "test"]):
        good, text = run(command, cwd=work, env=environment)
        if not good:
            return text
    ran = re.search(r"100% tests passed, 0 tests failed out of (\d+)", text)
    if ran is None or int(ran.group(1)) != expected or expected < len(PROGRAMS):
        count = ran.group(1) if ran else "no"
        return f"{text}\n{EXAMPLES}: {count} tests ran; expected: the {expected} of {len(lists)} examples"
    skipped = re.findall(r"Test +#\d+: (\S+) .*\*\*\*(?:Skipped|Not Run)", text)
    return f"{EXAMPLES}: skipped: {', '.join(skipped)}" if skipped else ""


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


def check(prefix, places, compiler):
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        (work / "empty").mkdir()
        problems = [*points_back(prefix, places), examples(prefix, work / "empty", compiler)]
        problems += [pkg_config(package, prefix, work, compiler) for package in PROGRAMS]
    return list(filter(None, problems))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--build", type=pathlib.Path)
    what.add_argument("--prefix", type=pathlib.Path)
    parser.add_argument("--compiler", default="c++")
    options = parser.parse_args()
    if options.prefix:
        finish("package", check(options.prefix.resolve(), {str(ROOT)}, options.compiler))
        return
    with tempfile.TemporaryDirectory() as name:
        good, text = run(["cmake", "--install", options.build, "--prefix", name, "--component", "package"])
        places = {str(ROOT), str(options.build.resolve())}
        finish("package", check(pathlib.Path(name), places, options.compiler) if good else [text])


main()
