"""A plan of `brick regress` for a test, and what its runs have left."""
import json
import pathlib
import tempfile

from command import brick


class Folder:
    def __init__(self, plan):
        self.kept = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.kept.name)
        self.plan, self.out = self.path / "plan.toml", self.path / "out"
        self.write(plan)

    def write(self, plan):
        self.plan.write_text(plan)

    def regress(self, *options):
        return brick("regress", str(self.plan), "-o", str(self.out), *options)

    def report(self):
        return json.loads((self.out / "report.json").read_text())

    def verdicts(self):
        return {r["name"]: r["verdict"] for r in self.report()["runs"]}


def bucket(report, group):
    return [b for b in report["buckets"] if b["group"] == group]
