"""brick regress: what runs leave that is no result, and runs that have the names of others.
usage: regress_odd.py BRICK CASE"""
import json
import pathlib
import shutil
import xml.etree.ElementTree as xml

import command
from command import check
from regress_folder import Folder, bucket


def regress_foreign():
    """A run.json or words of somebody else, of any form, are no steps and no covers; every run has its verdict."""
    files = ('{"steps": 5}', '{"steps": [5]}', '{"steps": [{"name": 3}]}', '{"simulated_ns": "long"}', "[1]", "{",
             '{"covers": {"a": 3}}', '{"covers": [1]}', '{"covers": {"a": {"count": "x"}}}', '{"covers": 5}',
             '{"covers": {"b": {"count": 0, "least": 0}}}')
    folder = Folder('[[row]]\nname = "own"\n'
                    'command = ["sh", "-c", "cp {plan}/$(({seed} / 2)).json run.json; exit $(({seed} % 2))"]\n'
                    f'seeds = "0-{2 * len(files) - 1}"\n'
                    '[[row]]\nname = "words"\ncommand = ["sh", "-c", "cat {plan}/words; exit 1"]\n')
    for number, text in enumerate(files):
        (folder.path / f"{number}.json").write_text(text)
    (folder.path / "words").write_bytes(b"FAIL \xf9" + "é".encode() * 200)
    r = folder.regress("--rank")
    wanted = {f"own.seed-{n}": "failed" if n % 2 else "passed" for n in range(2 * len(files))}
    check(r.returncode == 1 and folder.verdicts() == {**wanted, "words.seed-1": "failed"}, f"{r}")
    covers = {c["name"]: (c["counts"], c["least"]) for c in folder.report()["covers"]}
    check(covers == {"b": ({"own": 0}, 0)}, f"covers: {covers}")
    check(folder.report()["ranked"] == [] and "1 of 1 covers" in r.stdout, "a least of nothing asks for one")
    # 300 bytes: 9 of `FAIL <F9>`, which is a number here, and 145 times two; the next would be cut
    check(bucket(folder.report(), "words")[0]["says"] == "FAIL <#>" + 145 * "é" + "...", "cut between characters")


def regress_foreign_steps():
    """A step that failed is a failure, also of a command that ends with 0; its covers do not count."""
    steps = ('{"name": "a", "passed": true}, {"name": "b", "passed": false, "detail": "3"}', '{"name": "a"}', "{}",
             '{"name": "a", "passed": true}')
    folder = Folder('[[row]]\nname = "n"\ncommand = ["cp", "{plan}/{seed}.json", "run.json"]\n'
                    f'seeds = "0-{len(steps) - 1}"\n')
    for number, text in enumerate(steps):
        (folder.path / f"{number}.json").write_text(f'{{"steps": [{text}], "covers": {{"c": {{"count": 1}}}}}}')
    r = folder.regress()
    report = folder.report()
    found = [(x["verdict"], x["step"]) for x in report["runs"]]
    check(r.returncode == 1 and found == [("failed", "b"), ("failed", "a"), ("failed", "a step without a name"),
                                          ("passed", "")], f"{found}, {r}")
    check(report["covers"][0]["counts"] == {"n": 1}, f"{report['covers']}")


def regress_odd_files():
    """What has the name of a result and is no file hangs nobody up; every name can stand in XML and on a terminal."""
    commands = ("mkdir run.json result.json", "mkfifo run.json result.json.new", "rm output.txt; mkfifo output.txt")
    folder = Folder('title = "\\u001b[2Jodd"\n' + "".join(
        f'[[row]]\nname = "\\u0007{i}"\ncommand = ["sh", "-c", "{line}; exit 1", "\\u0001\\n"]\n'
        for i, line in enumerate(commands)))
    r = folder.regress()
    check(r.returncode == 1 and list(folder.verdicts().values()) == ["failed"] * len(commands), f"{r}")
    check("FAIL <1B>[2Jodd: 3 runs" in r.stdout and "x <07>0: failed" in r.stdout, f"names on a terminal: {r.stdout}")
    cases = xml.parse(folder.out / "report.xml").getroot().iter("testcase")
    check([c.get("classname") for c in cases] == [f"<07>{i}" for i in range(len(commands))], "names in XML")


def regress_earlier_replays():
    """What an earlier call has replayed is not in the folder of another failure, nor of none."""
    row = '[[row]]\nnegative = true\nbench = '
    folder = Folder(row + '["smoke", "flags"]\n')
    folder.regress()
    kinds = [b["group"] for b in folder.report()["buckets"]]
    waves = [folder.out / f"bucket-{n}" / f"bucket-{n}.fst" for n in (1, 2)]
    check(len(kinds) == 2 and all(wave.exists() for wave in waves), f"{kinds}")
    mark = folder.out / "bucket-1/of-before"
    mark.touch()
    folder.write(row + f'"{kinds[1]}"\n')
    folder.regress()
    check(waves[0].exists() and not mark.exists() and not waves[1].exists(), "replays of the call before are left")


def regress_long_names():
    """A name longer than that of a folder may be costs nothing; two that begin alike are two."""
    long = 280 * "n"
    folder = Folder("".join(f'[[row]]\nname = "{long}{end}"\ncommand = ["true"]\nrepeat = 2\n' for end in "ab"))
    r = folder.regress()
    runs = folder.report()["runs"]
    check(r.returncode == 0 and [x["verdict"] for x in runs] == ["passed"] * 4, f"{r}")
    check([x["group"] for x in runs] == [long + end for end in "aabb"], "the whole name stands in the report")
    check(len({x["name"] for x in runs}) == 4 and all(len(x["name"]) < 256 for x in runs), f"{runs}")
    check("4 taken over" in folder.regress("--resume").stdout, "--resume has forgotten some")


def regress_same_names():
    """Images and boards of one file name in two folders are runs of their own, which --resume knows again; that one of
    the images is none is no difference between engines."""
    row = '[[row]]\nbench = "smoke"\nfirmware = ["a/x.elf", "b/x.elf"]\nboard = ["a/y.toml", "b/y.toml"]\n'
    folder = Folder(2 * row)
    image = pathlib.Path(command.BRICK).with_name("turbo.elf")
    for name in "ab":
        (folder.path / name).mkdir()
        shutil.copy(command.BOARDS / "geobrick-lv-8.toml", folder.path / name / "y.toml")
    shutil.copy(image, folder.path / "a/x.elf")
    (folder.path / "b/x.elf").write_text("no program")
    r = folder.regress("--no-replay")
    report = folder.report()
    check([x["verdict"] for x in report["runs"]] == ["passed", "bad"] * 2, f"{r}: {report['runs']}")
    images = [json.loads((folder.out / "runs" / x["name"] / "result.json").read_text())["build"]["image"]
              for x in report["runs"]]
    check(len(set(images)) == 2 and report["build"]["image"] == ", ".join(sorted(set(images))),
          f"images of the runs: {images}, of all: {report['build']['image']}")
    check([b["verdict"] for b in report["buckets"]] == ["bad"], f"{report['buckets']}")
    check("4 taken over" in folder.regress("--resume", "--no-replay").stdout, "--resume has forgotten some")


globals()[command.CASE]()
