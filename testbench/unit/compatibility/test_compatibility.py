"""What 1.0 promised (docs/compatibility.md), read by this build: the files of 1.0/ as they were, never as they are now.
usage: test_compatibility.py BRICK COMPILER [UNITTEST OPTIONS]"""

import gzip
import json
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT, SAMPLES = HERE.parents[2], HERE / "1.0"
BRICK, COMPILER = sys.argv[1:3]
PATIENCE = 120  # seconds of the wall


def brick(*arguments, script=None):
    return subprocess.run([BRICK, *map(str, arguments)], input=script, capture_output=True, text=True,
                          timeout=PATIENCE, check=False)


def lacks(sample, found, path=""):
    """Keys of the sample that are not there any more."""
    if isinstance(sample, dict):
        if not isinstance(found, dict):
            return [f"{path} is no object"]
        return [wrong for key, inner in sample.items()
                for wrong in (lacks(inner, found[key], f"{path}/{key}") if key in found else [f"{path}/{key}"])]
    if isinstance(sample, list):
        if not isinstance(found, list):
            return [f"{path} is no list"]
        return [wrong for one in found[:1] if sample for wrong in lacks(sample[0], one, f"{path}[]")]
    return []


class Of10(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def says(self, done, status=0):
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout

    def test_options(self):
        for part in (SAMPLES / "options.txt").read_text().split("\n\n"):
            command, *options = part.split()
            known = set(re.findall(r"--[a-z-]+", self.says(brick(command, "--help"))))
            self.assertEqual(set(options) - known, set(), command)

    def test_statuses(self):
        self.says(brick("run", "smoke", "--engine", "systemc", "--negative"), 1)
        self.says(brick("run", "no-such-bench"), 2)
        self.says(brick("exec", "-", script="P1=1\n@expect 2\n"), 1)
        self.says(brick("exec", "-", script="frob\n"), 0)

    def test_json_keys(self):
        keys = json.loads((SAMPLES / "keys.json").read_text())
        results = self.folder / "run.json"
        self.says(brick("run", "smoke", "--engine", "systemc", "--json", results))
        plan, report = self.folder / "plan.toml", self.folder / "made/report.json"
        plan.write_text('title = "one"\n[[row]]\ncommand = ["brick", "list"]\n')
        self.says(brick("regress", plan, "--output", report.parent))
        found = {"report": json.loads(report.read_text()), "list": json.loads(self.says(brick("list", "--json"))),
                 "boards": json.loads(self.says(brick("boards", "--json"))), "run": json.loads(results.read_text())}
        self.assertEqual(lacks(keys, found), [])

    def test_board_file(self):
        said = self.says(brick("boards", SAMPLES / "board.toml"))
        self.assertIn("servo IC 2*", said)
        self.assertIn("by an 8259", said)
        self.assertIn("CID 602191", said)

    def test_plant_file(self):
        script = "@wait 20ms\n@signal plant.axis2.position\n"
        said = self.says(brick("exec", "--plant", SAMPLES / "plant.toml", "-", script=script))
        self.assertIn("plant.axis2.position=", said)

    def test_plan_file(self):
        said = self.says(brick("regress", SAMPLES / "plan.toml", "--list")).splitlines()
        self.assertEqual(len(said), 2 * 2 * 2 + 1 + 2, said)
        options = "--engine lockstep --board geobrick-lv-8 --aperture 0.5 --negative --seed 2"
        self.assertIn(f"brick run flags {options}", said)

    def test_flash_file(self):
        flash = self.folder / "flash.bin"
        flash.write_bytes(gzip.decompress((SAMPLES / "flash.bin.gz").read_bytes()))
        said = self.says(brick("exec", "--flash", flash, "-", script="I130\nM100->\nLIST PROG 7\nLIST PLC 9\n"))
        self.assertEqual(said.splitlines(), ["123456", "Y:$3000,8,4", "LIN INC F10", "X10Y-20.5", "DWE100",
                                             "P100=P100+1"])

    def test_control_channel(self):
        ours, theirs = socket.socketpair()
        with ours, theirs:
            process = subprocess.Popen([BRICK, "control", f"fd:{theirs.fileno()}", "--plant", "dac8"],
                                       pass_fds=[theirs.fileno()])
            theirs.close()
            ours.settimeout(PATIENCE)
            lines = ours.makefile("rb")
            for number, line in enumerate((SAMPLES / "control.jsonl").read_text().splitlines()):
                sample = json.loads(line.replace("FOLDER", str(self.folder)))
                ours.sendall(json.dumps({"jsonrpc": "2.0", "id": number, "method": sample["method"],
                                         "params": sample["params"]}).encode() + b"\n")
                answer = json.loads(lines.readline())
                self.assertEqual(answer["id"], number)
                if "error" in sample:
                    self.assertEqual(answer["error"]["code"], sample["error"], answer)
                    result, keys = answer["error"]["data"], sample["data"]
                else:
                    self.assertIn("result", answer, line)
                    result, keys = answer["result"], sample["result"]
                self.assertEqual(set(keys) - set(result), set(), line)
                self.assertEqual({key: result[key] for key in sample.get("equal", {})}, sample.get("equal", {}))
            lines.close()
        self.assertEqual(process.wait(PATIENCE), 0)

    def test_headers(self):
        done = subprocess.run([COMPILER, "-std=c++17", "-fsyntax-only", "-I", ROOT / "systemc/component/include",
                               SAMPLES / "host.cpp"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
