"""What tools/release.py refuses, and what it calls different."""

import contextlib
import gzip
import io
import json
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))
import release  # noqa: E402

GOOD = {"title": "release", "verdict": "passed", "build": {"commit": "c0ffee", "dirty": False},
        "runs": [{"name": "smoke", "verdict": "passed"}]}


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def problems(self, **changes):
        (self.folder / "report.json").write_text(json.dumps({**GOOD, **changes}))
        return [problem.split(": ", 1)[1] for problem in release.report_problems(self.folder, "c0ffee")]

    def test_a_report_of_the_plan_that_passed_at_this_commit_is_taken(self):
        self.assertEqual(self.problems(), [])

    def test_any_other_is_refused(self):
        self.assertEqual(self.problems(title="ci"), ["title is ci, expected release"])
        self.assertEqual(self.problems(verdict="failed"), ["verdict is failed, expected passed"])
        self.assertEqual(self.problems(build={"commit": "f00", "dirty": True}),
                         ["commit is f00, expected c0ffee", "dirty is True, expected False"])
        (self.folder / "report.json").unlink()
        self.assertEqual(len([*release.report_problems(self.folder, "c0ffee")]), 1)

    def test_a_report_with_a_skipped_run_is_refused(self):
        runs = [*GOOD["runs"], {"name": "packages", "verdict": "skipped"}]
        self.assertEqual(self.problems(runs=runs), ["packages was skipped; expected every run of the plan"])

    def refusal(self, folder, *kept):
        return release.refusal(folder, [ROOT, *kept])

    def test_a_new_folder_an_empty_one_and_a_release_are_cleared(self):
        self.assertIsNone(self.refusal(self.folder / "new"))
        self.assertIsNone(self.refusal(self.folder))
        (self.folder / "brick.deb").write_text("one")
        (self.folder / release.SUMS).write_text(release.checksums(self.folder))
        self.assertIsNone(self.refusal(self.folder))

    def test_a_folder_with_other_files_is_refused(self):
        (self.folder / "thesis.txt").write_text("one")
        self.assertIn("has files that are not of a release", self.refusal(self.folder))
        (self.folder / release.SUMS).write_text("")
        self.assertIn("has files that are not of a release", self.refusal(self.folder))
        (self.folder / release.SUMS).write_text(release.checksums(self.folder))
        (self.folder / "more").mkdir()
        self.assertIn("has files that are not of a release", self.refusal(self.folder))
        self.assertIn("is no folder", self.refusal(self.folder / "thesis.txt"))

    def test_a_folder_that_holds_what_must_stay_is_refused(self):
        self.assertIn(f"holds {ROOT}", self.refusal(ROOT))
        self.assertIn(f"holds {ROOT}", self.refusal(ROOT.parent))
        for kept in (self.folder, self.folder / "results"):
            self.assertIn(f"holds {kept}", self.refusal(self.folder, kept))
        self.assertIsNone(self.refusal(self.folder / "out", self.folder))

    def test_the_command_says_so_in_one_line_and_leaves_the_folder_alone(self):
        (self.folder / "thesis.txt").write_text("one")
        done = subprocess.run([sys.executable, ROOT / "tools/release.py", self.folder / "build", self.folder,
                               "--results", "/nowhere"], text=True, capture_output=True)
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
        self.assertTrue((self.folder / "thesis.txt").exists())

    def test_files_that_differ_are_named_reports_are_not(self):
        for name, content in (("one", "a"), ("other", "b")):
            place = self.folder / name
            place.mkdir()
            (place / "brick-1.tar.gz").write_text("same")
            (place / "brick-1-regress.json").write_text(content)
            (place / "brick.deb").write_text(content)
            (place / release.SUMS).write_text(release.checksums(place))
        found = release.differences(self.folder / "one", self.folder / "other")
        self.assertEqual([problem.split(":")[0] for problem in found], ["brick.deb"])

    def released(self, folder, *options, wheel="a wheel", lintian=()):
        """Exit status and output of all of main(), with packages that are made at once and a tree as its commit."""
        def make(_, work):
            files = [work / "brick_pmac-1-py3-none-any.whl", work / "brick_1_amd64.deb", work / "brick-dev_1_amd64.deb"]
            for file in files:
                file.write_text(wheel)
            return files[0], files[1:]

        def licences(*command):
            command[-1].mkdir()
            (command[-1] / "brick.spdx.json").write_text("{}")

        results = self.folder / "results"
        results.mkdir(exist_ok=True)
        for kind in ("html", "xml"):
            (results / f"report.{kind}").write_text(kind)
        (results / "report.json").write_text(json.dumps(GOOD))
        output = io.StringIO()
        answers = {"rev-parse": b"c0ffee\n", "status": b"", "archive": b"sources"}
        arguments = ["release.py", self.folder / "build", folder, "--results", results, *options]
        with unittest.mock.patch.multiple(release.packages, make=make, lintian=lambda _: [*lintian]), \
                unittest.mock.patch.multiple(release.wheel, run=licences, lacks=lambda _: []), \
                unittest.mock.patch.object(release, "git", lambda what, *_: answers[what]), \
                unittest.mock.patch.object(sys, "argv", [str(word) for word in arguments]), \
                contextlib.redirect_stdout(output):
            try:
                release.main()
            except SystemExit as end:
                return end.code, output.getvalue()
        return 0, output.getvalue()

    def test_a_release_is_whole_and_the_next_one_takes_its_place(self):
        for wheel in ("one", "two"):
            status, said = self.released(self.folder / "out", wheel=wheel)
            self.assertEqual(status, 0, said)
            self.assertEqual((self.folder / "out/brick_1_amd64.deb").read_text(), wheel)
        names = {file.name for file in (self.folder / "out").iterdir()}
        version = next(name for name in names if name.endswith(".tar.gz")).removesuffix(".tar.gz")
        self.assertEqual(names, {
            release.SUMS, "brick_pmac-1-py3-none-any.whl", "brick_1_amd64.deb", "brick-dev_1_amd64.deb",
            *(version + end for end in (".tar.gz", ".spdx.json", "-regress.html", "-regress.json", "-regress.xml"))})
        subprocess.run(["sha256sum", "--check", "--quiet", release.SUMS], cwd=self.folder / "out", check=True)
        self.assertEqual({file.name for file in self.folder.iterdir()}, {"out", "results"})  # nothing else stays

    def test_two_builds_are_compared(self):
        self.released(self.folder / "first")
        self.assertEqual(self.released(self.folder / "second", "--compare", self.folder / "first")[0], 0)
        status, said = self.released(self.folder / "second", "--compare", self.folder / "first", wheel="other")
        self.assertEqual((status, said.count("differs from that of")), (1, 3), said)

    def test_a_lintian_error_is_a_problem(self):
        self.assertEqual(self.released(self.folder / "out", lintian=["E: brick: bad"])[0], 1)

    @unittest.skipUnless((ROOT / ".git").exists(), "a tree without git")
    def test_the_archive_of_a_commit_is_the_same_twice_and_whole(self):
        first = release.source_archive(self.folder, "1").read_bytes()
        self.assertEqual(release.source_archive(self.folder, "1").read_bytes(), first)
        with tarfile.open(fileobj=io.BytesIO(gzip.decompress(first))) as archive:
            names = archive.getnames()
        self.assertLessEqual({"brick-1/CMakeLists.txt", "brick-1/dev", "brick-1/LICENSE"}, set(names))


if __name__ == "__main__":
    unittest.main()
