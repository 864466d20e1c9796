"""What the scripts in this folder share: where the tree is, which files are sources, how a check reports."""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SKIPPED = 77  # ctest shows this exit status as "Skipped"


def files(root, folders, suffixes):
    """Every file below `folders` with one of `suffixes`, sorted, paths relative to `root`."""
    found = []
    for folder in folders:
        for path in (root / folder).rglob("*"):
            if path.suffix in suffixes and path.is_file() and "__pycache__" not in path.parts:
                found.append(path.relative_to(root))
    return sorted(found)


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def finish(what, problems):
    """Prints the problems, one a line, and ends with exit status 1 if there are any."""
    for problem in problems:
        print(problem)
    if problems:
        print(f"{what}: {len(problems)} problem(s)")
        sys.exit(1)
    print(f"{what}: clean")
