#!/usr/bin/env python3
"""Makes the wheel and the Debian packages of a finished build and tries them: packages.py BUILD DIR [--root].

--root, as root: in a clean Debian 12 of its own below DIR (debootstrap, chroot; apt and pip configured as here) the
wheel is installed without a compiler, then the packages; with each `brick --version` says what the build's says and a
motor moves, by a script and on the page; with the wheel in Python too. A bench of somebody else's builds against
brick-dev and runs its seeds. Without a program
that it needs: exit status 77.
"""

import argparse
import pathlib
import shutil
import subprocess

import wheel
from common import ROOT, finish, skip

SUITE, MIRROR = "bookworm", "http://deb.debian.org/debian"
SHARED = ["/etc/apt/sources.list", "/etc/apt/sources.list.d", "/etc/apt/apt.conf.d", "/etc/apt/auth.conf.d",
          "/etc/apt/trusted.gpg.d", "/usr/share/keyrings", "/etc/pip.conf", "/etc/ssl/certs",
          "/usr/local/share/ca-certificates", "/etc/resolv.conf", "/etc/hosts"]
EXAMPLE = "/usr/share/brick/examples/own_bench"
MOVE = "printf '#1J/\\n#1J:4000\\n@wait 300ms\\n#1P\\n' | {} exec --plant dac8 --load dac8 -"
# The test that sees a motor move on the page, and what it imports.
PAGE_TEST = "testbench/unit/app/page_command.py"
PAGE_FILES = [PAGE_TEST, "testbench/clients/turbo_pmac.py",
              *(f"testbench/unit/app/{name}.py" for name in ("command", "page_client", "served"))]


def debian_packages(build, folder):
    shutil.rmtree(folder / "deb", ignore_errors=True)
    wheel.run("cpack", "-G", "DEB", "-B", folder / "deb", cwd=build)
    return sorted((folder / "deb").glob("*.deb"))


def make(build, folder):
    """(wheel, Debian packages) of one state of the build."""
    wheel.run("cmake", "--build", build)  # cpack would, after the wheel has been made
    return wheel.make(build, folder), debian_packages(build, folder)


def lintian(packages):
    done = subprocess.run(["lintian", "--fail-on", "error", "--tag-display-limit", "0", *packages],
                          capture_output=True, text=True)
    return [line for line in done.stdout.splitlines() if line.startswith("E:")]


class Root:
    """A clean Debian below a folder."""

    def __init__(self, place):
        self.place = place
        shutil.rmtree(place, ignore_errors=True)
        wheel.run("debootstrap", "--variant=minbase", SUITE, place, MIRROR)
        (place / "etc/apt/sources.list").unlink()  # that of debootstrap: those of here come instead
        for name in SHARED:
            source, target = pathlib.Path(name), place / name[1:]
            if source.is_dir():
                shutil.copytree(source, target, symlinks=True, dirs_exist_ok=True)
            elif source.exists():
                target.unlink(missing_ok=True)
                shutil.copy(source, target)

    def run(self, *command):
        """With /proc, where a command looks for itself: mounted for the command alone, so that a kill leaves none."""
        return wheel.run("unshare", "--mount", "--fork", "--kill-child", "sh", "-e", "-c",
                         'mount -t proc proc "$0/proc"; exec chroot "$0" "$@"', self.place, *command)

    def install(self, *packages):
        self.run("apt-get", "install", "-y", "-q", "--no-install-recommends", *packages)


def motor_problems(run, command, expected):
    """Of an installed command. `run` runs a command where it is installed; `expected`: what it says of its version."""
    if run(command, "--version") != expected:
        yield f"{command} --version is another than that of the build"
    move = MOVE.format(command)
    if (where := run("sh", "-c", move)) != "4000\n":
        yield f"motor 1 stands at {where}, expected 4000: {move}"
    run("python3", f"/tmp/{PAGE_TEST}", command, "page_moves")


def problems_in(root, expected, made, packages):
    for file in [made, *packages]:
        shutil.copy(file, root.place / "tmp")
    for name in PAGE_FILES:
        (root.place / "tmp" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, root.place / "tmp" / name)
    root.run("apt-get", "update", "-q")
    root.install("python3-venv")
    root.run("python3", "-m", "venv", "/wheel")
    root.run("/wheel/bin/pip", "install", "--quiet", f"/tmp/{made.name}")
    yield from motor_problems(root.run, "/wheel/bin/brick", expected)
    root.run("/wheel/bin/python", "-c", wheel.TRIAL)
    root.install(*(f"/tmp/{package.name}" for package in packages))
    yield from motor_problems(root.run, "/usr/bin/brick", expected)
    root.install("g++", "cmake", "make", "pkg-config")
    root.run("cmake", "-S", EXAMPLE, "-B", "/tmp/bench")
    root.run("cmake", "--build", "/tmp/bench")
    root.run("sh", "-e", "-c", "cd /tmp/bench; ctest --output-on-failure")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--root", action="store_true")
    options = parser.parse_args()
    needed = ["cpack", "lintian", *(["debootstrap", "chroot", "unshare"] if options.root else [])]
    if missing := [program for program in needed if shutil.which(program) is None]:
        skip(f"not installed: {', '.join(missing)}")
    build, folder = options.build.resolve(), options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    made, packages = make(build, folder)
    version = wheel.run(build / "bin/brick", "--version")  # before somebody builds again
    problems = [*wheel.lacks(made), *lintian(packages)]
    if options.root and not problems:
        problems += problems_in(Root(folder / "root"), version, made, packages)
    finish("packages", problems)


if __name__ == "__main__":
    main()
