#!/usr/bin/env python3
"""Checks that every citation of the data sheet in the tree leads somewhere (docs/datasheet/README.md has the form).

A citation is SHEET:SECTION or SHEET:SECTION/RULE. The section is a numbered heading of that sheet, the rule a numbered
list item or a table row with the number in its first cell, and there is one such only. No other way of pointing at a
document passes: a page with a number behind it, a number without its sheet, "section" and a number, a page that is not
in the tree.
"""

import argparse
import collections
import contextlib
import pathlib
import re

from common import ROOT, finish, tracked

SHEETS = ("servo-ic", "host-bus", "firmware", "ethernet", "motion")
PAGES = "docs/datasheet"
# The trees that the first writes break these very rules; the second is not ours.
EXEMPT = {"testbench/unit/tools/test_checks_docs.py", "testbench/unit/tools/test_checks_style.py", "LICENSE"}

SHEET = "|".join(SHEETS)
NUMBER = r"\d{1,2}(?:\.\d{1,2})*"
POINT = r"\d{1,2}\.\d{1,2}(?:/\d+)?"  # a section that cannot be taken for a count
CITATION = re.compile(rf"(?<![\w/.-])({SHEET}):({NUMBER})(?:/(\d+))?(?![\w/-]|\.[\w.])")
RANGE = re.compile(rf"{CITATION.pattern} to {CITATION.pattern}")
HEADING = re.compile(rf"#{{2,4}} ({NUMBER})\.? ")
RULE = re.compile(r"(\d+)\. |\| *(\d+) *\|")
VECTOR_KEY = re.compile(r'section = "(.*)"')  # of a timing vector
CITATIONS = re.compile(rf"{CITATION.pattern}(?:, {CITATION.pattern})*")

NO_SHEET = "names no sheet: expected SHEET:SECTION"
LEFTOVERS = (  # looked for where citations are masked by x
    (rf"(?<![\w/.-])(?:{SHEET}):(?={NUMBER})", "is no citation: expected SHEET:SECTION or SHEET:SECTION/RULE"),
    (rf"(?i)(?<![\w/.:-])(?:servo[-_]ic|host[-_]bus|firmware):? ?{POINT}\b", "is no citation: expected SHEET:SECTION"),
    (r"x{8,}(?:(?:,| and| to) /\d+| rule \d+)", "names a rule without its section: expected SHEET:SECTION/RULE"),
    (r"(?:\.\.|\w)/shared\b\S*", "lies outside the tree"),
    (rf"[\w./-]+\.md,? (?:section )?{NUMBER}\b", "points into a page by number: expected SHEET:SECTION"),
    (rf"(?<!\.md )\b[Ss]ections? {NUMBER}\b|§ ?\d+", NO_SHEET),
    (rf"\b(?:[Dd]ata sheets?|[Ss]pec),? {NUMBER}\b|\bas in {POINT}|\b{POINT} (?:item|rule)\b", NO_SHEET),
    (rf"(?<= )\({POINT}(?:, {POINT})*\)(?=[\s.,;:]|$)", NO_SHEET),
)
LEFTOVERS = tuple((re.compile(pattern), what) for pattern, what in LEFTOVERS)
UNIT = r" ?(?:[munkfp]?s|[MkG]?Hz|[mkG]?V|A|%)\b"
BARE = re.compile(rf"(?<=[\w)])(?:,|;| and| to) ({POINT})(?=[\s.,;:)]|$)(?!{UNIT})")  # behind a citation
PAGE_NAME = re.compile(r"(?<![\w/.*}-])(?:[\w./-]*[\w-]+\.md|docs/[\w./-]+\.(?:txt|json|svg|png))\b")
# What is in every line that one of these could match: few lines, and one look is cheaper than a dozen.
HINT = re.compile(rf"(?:{SHEET}):|shared|\.md|docs/|ection|§|[Ss]heet|[Ss]pec|\d\.\d")

Section = collections.namedtuple("Section", "line rules")


def texts(root):
    """(name, text) of every text file of the tree."""
    for path in tracked(root):
        with contextlib.suppress(UnicodeDecodeError):  # a picture or the like
            yield path.as_posix(), (root / path).read_text(encoding="utf-8")


def read_sheet(text, page):
    """({section: Section}, problems) of one page; fenced blocks hold no headings and no rules."""
    sections, problems, here, fenced = {}, [], None, False
    for number, line in enumerate(text.splitlines(), 1):
        fenced ^= line.lstrip().startswith("```")
        heading = None if fenced else HEADING.match(line)
        if heading:
            here = heading[1]
            if here in sections:
                problems.append(f"{page}:{number}: section {here} is there already, in line {sections[here].line}")
            sections.setdefault(here, Section(number, collections.Counter()))
        elif line.startswith("#") and not fenced:
            here = None
        elif here is not None and not fenced and (rule := RULE.match(line)):
            sections[here].rules[rule[1] or rule[2]] += 1
    return sections, problems


def leads_nowhere(sheets, sheet, section, rule):
    """Why a citation cannot be followed, or None."""
    if sheet not in sheets:
        return f"there is no {PAGES}/{sheet}.md"
    if section not in sheets[sheet]:
        return f"{PAGES}/{sheet}.md has no section {section}"
    if rule is not None and sheets[sheet][section].rules[rule] != 1:
        found = "twice" if sheets[sheet][section].rules[rule] else "not"
        return f"rule {rule} is {found} in section {section} of {PAGES}/{sheet}.md"
    return None


def place(section, rule):
    return [int(part) for part in section.split(".")] + [int(rule or 0)]


def problems_in_line(line, sheets):
    """What is wrong with the citations of one line."""
    cited = list(CITATION.finditer(line))
    for match in cited:
        why = leads_nowhere(sheets, *match.groups())
        if why:
            yield f"'{match[0]}': {why}"
    for match in RANGE.finditer(line):
        sheet, first, rule, last_sheet, last, last_rule = match.groups()
        if sheet != last_sheet or place(first, rule) >= place(last, last_rule):
            yield f"'{match[0]}' is no range of one sheet"
    rest = CITATION.sub(lambda match: "x" * len(match[0]), line)
    for pattern, what in LEFTOVERS:
        for match in pattern.finditer(rest):
            yield f"'{line[match.start():match.end()].strip()}' {what}"
    key = VECTOR_KEY.match(line)
    if key and not CITATIONS.fullmatch(key[1]):
        yield f"'{key[1]}' is no list of citations"
    for match in BARE.finditer(rest, cited[0].end()) if cited else ():
        yield f"'{match[1]}' {NO_SHEET}"


def pages_in_line(root, file, line):
    """Pages and files of docs/ that a line names and that are missing. Markdown names them from its own folder, too."""
    for match in PAGE_NAME.finditer(line):
        name = match[0]
        bases = [root / file, root / "x"] if file.endswith(".md") else [root / "x"]
        if not any((base.parent / name).exists() for base in bases):
            yield f"'{name}' does not exist; expected a path from the root of the tree"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    root = parser.parse_args().root.resolve()
    sheets, problems, count = {}, [], 0
    for sheet in SHEETS:
        page = f"{PAGES}/{sheet}.md"
        if (root / page).exists():
            sheets[sheet], twice = read_sheet((root / page).read_text(encoding="utf-8"), page)
            problems += twice
    for file, text in texts(root):
        if file in EXEMPT:
            continue
        for number, line in enumerate(text.splitlines(), 1):
            if not HINT.search(line):
                continue
            count += len(CITATION.findall(line))
            found = (*problems_in_line(line, sheets), *pages_in_line(root, file, line))
            problems += [f"{file}:{number}: {what}" for what in found]
    finish(f"{count} citations of {len(sheets)} sheets", problems)


if __name__ == "__main__":
    main()
