#!/usr/bin/env python3
"""Checks that what README, CONTRIBUTING and docs/ name exists: links, images, and `paths/in/backticks` of the tree.

Every page in docs/ must be linked from docs/README.md. A path in backticks counts when its first folder is one of the
tree's. * and {a,b} may stand in it, NAME is any name, and the ending may be left out. Build products (build/,
waves/out/) are not looked for.
"""

import argparse
import itertools
import pathlib
import re

from common import ROOT, finish

FOLDERS = {"app", "boards", "cmake", "docs", "firmware", "rtl", "systemc", "testbench", "tools", "waves", ".ci"}
GENERATED = ("build/", "waves/out")


def alternatives(path):
    """`a/{b,c}.sv` names a/b.sv and a/c.sv."""
    parts = re.split(r"\{([^}]*)\}", path)
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return ["".join(choice) for choice in itertools.product(*choices)]


def exists(root, path):
    path = re.sub(r"\bNAME\b", "*", path.rstrip("/"))
    return (root / path).exists() or any(root.glob(path)) or any(root.glob(path + ".*"))


def named_paths(text):
    """(line number, path, is_link) of everything in a Markdown text that should exist."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        if fenced:
            continue
        for target in re.findall(r"\]\(([^)\s]+)\)", line) + re.findall(r"(?:src|href)=\"([^\"]+)\"", line):
            if not re.match(r"[a-z]+:|#", target):
                yield number, target.split("#")[0], True
        for code in re.findall(r"`([^`]+)`", line):
            path = re.sub(r":\d+$", "", code)
            if re.fullmatch(r"[\w./*{},+-]+", path) and "/" in path and path.split("/")[0] in FOLDERS:
                yield number, path, False


def problems_in(root):
    pages = [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]
    for page in pages:
        if not page.exists():
            yield f"{page.relative_to(root)}: missing"
            continue
        for number, path, is_link in named_paths(page.read_text()):
            base = page.parent if is_link else root
            for choice in alternatives(path):
                if not choice.startswith(GENERATED) and not exists(base, choice):
                    yield f"{page.relative_to(root)}:{number}: '{choice}' does not exist"


def unlisted_pages(root):
    index = root / "docs/README.md"
    linked = {path for _, path, is_link in named_paths(index.read_text()) if is_link} if index.exists() else set()
    for page in sorted((root / "docs").glob("*.md")):
        if page != index and page.name not in linked:
            yield f"docs/{page.name}: not listed in docs/README.md"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    root = parser.parse_args().root.resolve()
    finish("links", [*problems_in(root), *unlisted_pages(root)])


if __name__ == "__main__":
    main()
