#!/usr/bin/env python3
"""Installs the package into a folder outside the tree and builds and runs every example there against it.

What a user does: two commands in a copy of the example's folder, cmake with the place of the package, then the build
and ctest. Nothing in the installed tree may point back to this one.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import tempfile

from common import ROOT, finish


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    return done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"


def points_back(prefix, places):
    """Text files of the installed tree that name the source or the build folder."""
    for file in sorted(p for p in prefix.rglob("*") if p.suffix in {".cmake", ".h", ".pc"}):
        text = file.read_text()
        yield from (f"{file.relative_to(prefix)} names {place}" for place in places if place in text)


def example(folder, work, prefix, compiler):
    """Builds a copy of the example and runs its tests; what went wrong, "" when nothing."""
    copy = work / folder.name
    shutil.copytree(folder, copy)
    environment = {**os.environ, "CTEST_OUTPUT_ON_FAILURE": "1"}
    configure = ["cmake", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={compiler}"]
    for command in (configure, ["cmake", "--build", "build", "--target", "all", "test"]):
        good, text = run(command, cwd=copy, env=environment)
        if not good:
            return text
    return ""


def pkg_config(folder, work, prefix, compiler):
    """The same program with pkg-config in place of CMake."""
    environment = {**os.environ, "PKG_CONFIG_PATH": str(next(prefix.rglob("pkgconfig")))}
    good, flags = run(["pkg-config", "--cflags", "--libs", "brick"], env=environment)
    if not good:
        return flags
    program = work / "by_pkg_config"
    command = [compiler, "-std=c++17", folder / "main.cpp", "-o", program, *flags.splitlines()[1].split()]
    for step in (command, [program]):
        good, text = run(step, cwd=work)
        if not good:
            return text
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", default="c++")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        work, prefix = pathlib.Path(name), pathlib.Path(name) / "installed"
        good, text = run(["cmake", "--install", options.build, "--prefix", prefix, "--component", "package"])
        problems = [] if good else [text]
        if good:
            problems += points_back(prefix, {str(ROOT), str(options.build.resolve())})
            uses = [p for p in (ROOT / "examples").glob("*/CMakeLists.txt") if "find_package(brick" in p.read_text()]
            for folder in sorted(p.parent for p in uses):
                problems += filter(None, [example(folder, work, prefix, options.compiler)])
            problems += filter(None, [pkg_config(ROOT / "examples/servo_ic", work, prefix, options.compiler)])
    finish("package", problems)


main()
