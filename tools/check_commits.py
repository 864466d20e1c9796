#!/usr/bin/env python3
"""Checks that commits that change code say why: `area: imperative summary` in 60 characters or fewer, then a body.

Judged are the commits after the one that added this file, merges apart. Without a history that reaches back to it (a
copy without .git, a shallow clone) there is nothing to judge, and the check passes and says so.
"""

import argparse
import pathlib
import re
import subprocess
import sys

from common import GIT, ROOT, finish

SELF = "tools/check_commits.py"
CODE = re.compile(r"\.(sv|vlt|rdl|cpp|hpp|h|c|S|ld|def|py|cmake|vec)$|CMakeLists\.txt$|^(dev|\.ci/run)$")
SUMMARY = re.compile(r"[\w./, -]+: \S")
LONGEST = 60


def git(root, *arguments):
    done = subprocess.run([*GIT, *arguments], cwd=root, text=True, errors="replace", stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL)
    return done.stdout if done.returncode == 0 else ""


def commits_of(root, span):
    """(hash, message, files that it changes) of each, merges apart."""
    said = git(root, "log", "-z", "--no-merges", "--name-only", "--format=%x00%x01%H%x00%B%x00", span)
    for commit in f"\0{said}".split("\0\0\x01")[1:]:  # no message and no name of a file has a zero
        name, message, *files = commit.split("\0")
        yield name, message.strip(), [file.strip("\n") for file in files]


def commit_problems(name, message, files):
    summary, _, body = message.partition("\n")
    short = name[:10]
    if len(summary) > LONGEST or not SUMMARY.match(summary):
        yield f"{short}: summary '{summary}'; expected 'area: what it does' in {LONGEST} characters or fewer"
    if any(CODE.search(file) for file in files) and not body.strip():
        yield f"{short} {summary}: changes code and does not say why in its body"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    root = parser.parse_args().root
    shallow = git(root, "rev-parse", "--is-shallow-repository").strip()
    first = git(root, "log", "--diff-filter=A", "--format=%H", "--", SELF).split()
    if shallow != "false" or not first:
        print("no history back to the commit that brought this check: nothing to judge")
        sys.exit(0)
    commits = list(commits_of(root, f"{first[-1]}..HEAD"))
    finish(f"{len(commits)} commits", [problem for commit in commits for problem in commit_problems(*commit)])


if __name__ == "__main__":
    main()
