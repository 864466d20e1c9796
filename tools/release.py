#!/usr/bin/env python3
"""Makes a release of a finished build: release.py BUILD DIR --results FOLDER [--compare OTHER].

DIR gets the wheel, the Debian packages, the archive of the sources, the report of `brick regress plans/release.toml`
(FOLDER: its --output), the list in SPDX and SHA256SUMS. The tree must be as its commit, the report must have passed
with nothing skipped and be of that commit. Times in the packages are those of the commit, so that the same tree gives
the same bytes; --compare says which files differ from those of another DIR. DIR is new, empty or a release, which goes.
Exit status 0 done, 1 something is wrong with the tree, the report or a package, 2 DIR is none to be written.
"""

import argparse
import gzip
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import licences
import packages
import wheel
from common import GIT, ROOT, finish

SUMS = "SHA256SUMS"


def git(*arguments):
    return subprocess.run([*GIT, "-C", ROOT, *arguments], capture_output=True, check=True).stdout


def source_archive(folder, version):
    name = f"brick-{version}"
    content = git("archive", "--format=tar", f"--prefix={name}/", "HEAD")
    file = folder / f"{name}.tar.gz"
    file.write_bytes(gzip.compress(content, mtime=0))
    return file


def report_problems(results, commit):
    """What is wrong with the report of the plan `release`."""
    file = results / "report.json"
    if not file.exists():
        yield f"{file}: not there; expected the results of brick regress plans/release.toml --output {results}"
        return
    report = json.loads(file.read_text())
    found = {"title": report["title"], "verdict": report["verdict"], "commit": report["build"]["commit"],
             "dirty": report["build"]["dirty"]}
    expected = {"title": "release", "verdict": "passed", "commit": commit, "dirty": False}
    yield from (f"{file}: {key} is {found[key]}, expected {value}" for key, value in expected.items()
                if found[key] != value)
    yield from (f"{file}: {run['name']} was skipped; expected every run of the plan"
                for run in report["runs"] if run["verdict"] == "skipped")


def refusal(folder, kept):
    """Why a folder is none that may be cleared for a release, or None. `kept`: folders that must stay."""
    for other in kept:
        if folder == other or folder in other.parents:
            return f"{folder}: holds {other}, and is cleared first; expected a folder for the release alone"
    if not folder.exists():
        return None
    if not folder.is_dir():
        return f"{folder}: is no folder; expected a new or an empty one, or that of a release"
    names = {file.name for file in folder.iterdir()}
    if names and foreign(folder, names):
        return f"{folder}: has files that are not of a release; expected a new or an empty folder, or that of a release"
    return None


def foreign(folder, names):
    """Whether a folder has others than what its SHA256SUMS lists."""
    if SUMS not in names:
        return True
    return names != {SUMS, *(line.partition("  ")[2] for line in (folder / SUMS).read_text().splitlines())}


def take(files, folder):
    for file, name in files:
        shutil.copyfile(file, folder / name)


def checksums(folder):
    names = sorted(file.name for file in folder.iterdir() if file.is_file() and file.name != SUMS)
    return "".join(f"{hashlib.sha256((folder / name).read_bytes()).hexdigest()}  {name}\n" for name in names)


def differences(folder, other):
    """Files that are not the same in both, by their checksums; reports hold wall times and are left out."""
    mine, theirs = ({line.split("  ")[1]: line for line in (place / SUMS).read_text().splitlines()}
                    for place in (folder, other))
    return [f"{name}: differs from that of {other}" for name in sorted({*mine, *theirs})
            if "-regress." not in name and mine.get(name) != theirs.get(name)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path, required=True)
    parser.add_argument("--compare", type=pathlib.Path)
    options = parser.parse_args()
    build, folder = options.build.resolve(), options.folder.resolve()
    kept = [ROOT, build, options.results.resolve(), *([options.compare.resolve()] if options.compare else [])]
    if refused := refusal(folder, kept):
        print(f"release.py: {refused}", file=sys.stderr)
        sys.exit(2)
    version = re.search(r"^project\(brick VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    problems = [*report_problems(options.results, git("rev-parse", "HEAD").decode().strip())]
    if git("status", "--porcelain", "--untracked-files=no"):
        problems.append("the tree has changes; expected that of its commit")
    if problems:
        finish("release", problems)
    os.environ["SOURCE_DATE_EPOCH"] = str(licences.commit_time())
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as name:  # an older release goes when the new one is whole
        work, out = pathlib.Path(name) / "work", pathlib.Path(name) / "out"
        work.mkdir()
        out.mkdir()
        made, debs = packages.make(build, work)
        source_archive(out, version)
        take([(made, made.name), *((deb, deb.name) for deb in debs)], out)
        take([(options.results / f"report.{kind}", f"brick-{version}-regress.{kind}")
              for kind in ("html", "json", "xml")], out)
        wheel.run("python3", ROOT / "tools/licences.py", build, work / "licences")
        take([(work / "licences/brick.spdx.json", f"brick-{version}.spdx.json")], out)
        (out / SUMS).write_text(checksums(out))
        shutil.rmtree(folder, ignore_errors=True)
        out.rename(folder)
    print((folder / SUMS).read_text(), end="")
    finish("release", [*wheel.lacks(folder / made.name), *packages.lintian([folder / deb.name for deb in debs]),
                       *(differences(folder, options.compare) if options.compare else [])])


if __name__ == "__main__":
    main()
