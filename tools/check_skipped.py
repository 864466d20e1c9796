#!/usr/bin/env python3
"""Fails when a test of a run was skipped: check_skipped.py tests.xml, as `ctest --output-junit` writes it.

A developer may lack a tool; CI, where everything is installed, must not pass because something is missing.
"""

import argparse
import pathlib
import xml.etree.ElementTree

from common import finish


def skipped(junit):
    cases = [*xml.etree.ElementTree.parse(junit).getroot().iter("testcase")]
    if not cases:
        yield f"{junit}: no test was run"
    for case in cases:
        if case.get("status") not in {"run", "fail"}:
            yield f"{case.get('name')} was skipped; in CI every test runs"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("junit", type=pathlib.Path)
    options = parser.parse_args()
    if not options.junit.exists():
        finish("skipped tests", [f"{options.junit}: no such file; the run has written no results"])
    finish("skipped tests", [*skipped(options.junit)])


if __name__ == "__main__":
    main()
