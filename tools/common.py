"""What the scripts in this folder share: where the tree is, which files are sources, how a check reports."""

import datetime
import hashlib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SKIPPED = 77  # ctest shows this exit status as "Skipped"
GIT = ["git", "-c", "safe.directory=*"]  # also a clone that is another user's, as in a container


def files(root, folders, suffixes):
    """Every file below `folders` with one of `suffixes`, sorted, paths relative to `root`."""
    found = []
    for folder in folders:
        for path in (root / folder).rglob("*"):
            if path.suffix in suffixes and path.is_file() and "__pycache__" not in path.parts:
                found.append(path.relative_to(root))
    return sorted(found)


def tracked(root):
    """Every file that git tracks or would, relative to `root`; where git cannot tell, all but build products."""
    names = []
    if (root / ".git").exists():
        listing = [*GIT, "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        names = subprocess.run(listing, capture_output=True, text=True, check=False).stdout.split("\0")
    found = [pathlib.Path(name) for name in names if name]
    if not found:
        products = {".git", "build", "out"}
        found = [path.relative_to(root) for path in root.rglob("*")]
        found = [path for path in found if not products & set(path.parts[:2])]
    return sorted(path for path in found if (root / path).is_file() and not (root / path).is_symlink())


def without_comments(text):
    """Of SystemVerilog."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def hash_of(*parts):
    """Of bytes, texts and files, as hexadecimal digits."""
    digest = hashlib.sha256()
    for part in parts:
        data = part if isinstance(part, bytes) else part.encode() if isinstance(part, str) else part.read_bytes()
        digest.update(hashlib.sha256(data).digest())
    return digest.hexdigest()[:16]


def as_of(root):
    """For a page of measured figures: which commit they stand for, and whether there were changes on top of it."""
    def said(*command):
        return subprocess.run([*GIT, "-C", root, *command], capture_output=True, text=True, check=False).stdout.strip()

    commit = said("rev-parse", "--short=10", "HEAD") or "unknown"
    changes = " and changes" if said("status", "--porcelain", "--untracked-files=no") else ""
    return f"at commit {commit}{changes}, {datetime.date.today().isoformat()}"


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
