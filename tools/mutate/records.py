"""Results as text, a line of JSON each: results/mutation/KIND/MODULE.jsonl. The first line says what was judged and
how; each that follows is a mutant. With --part K/N the file is MODULE.K-of-N.jsonl, so that machines do not write into
one file; readers take all of a module's together."""

import json

from common import ROOT

FOLDER = ROOT / "results/mutation"


def path_of(kind, module, part):
    return FOLDER / kind / (f"{module}.jsonl" if part is None else f"{module}.{part[0]}-of-{part[1]}.jsonl")


def paths(kind, module):
    return sorted((FOLDER / kind).glob(f"{module}.jsonl")) + sorted((FOLDER / kind).glob(f"{module}.*-of-*.jsonl"))


def record(mutant, verdict, stage):
    return {"number": mutant.number, "file": mutant.file, "line": mutant.line, "text": mutant.text,
            "operator": mutant.place.operator, "change": mutant.change, "repeat": mutant.repeat,
            "status": verdict.status, "stage": stage, "by": verdict.by, "seconds": round(verdict.seconds, 2)}


def key(row):
    """As Mutant.key."""
    return (row["file"], row["text"], row["operator"], row["change"], row["repeat"])


def write(path, head, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_suffix(".new")
    new.write_text("".join(json.dumps(row) + "\n" for row in [head, *sorted(rows, key=lambda r: r["number"])]))
    new.replace(path)  # a killed run leaves the old one or the new one


def read(path):
    """(head, rows)"""
    head, *rows = [json.loads(line) for line in path.read_text().splitlines()]
    return head, rows


def source_of(kind, module):
    """Of the file that was judged; None: there are no results."""
    heads, _ = of_module(kind, module)
    return heads[0]["source"] if heads else None


def of_module(kind, module):
    """The heads and rows of all parts that are of one tree: those with the inputs of the newest."""
    parts = [read(path) for path in paths(kind, module)]
    if not parts:
        return [], []
    newest = max(parts, key=lambda part: part[0]["time"])[0]["inputs"]
    parts = [part for part in parts if part[0]["inputs"] == newest]
    rows = {row["number"]: row for _, found in parts for row in found}
    return [head for head, _ in parts], list(rows.values())
