#!/usr/bin/env python3
"""Compiles the channel from its file list with Icarus and runs the tests:
run.py [--rtl DIR] [--build DIR] [--seed N] [--json FILE] [--wave] [--negative].

Exit status 0 passed, 1 a test failed, 2 bad usage, 77 cocotb or Icarus is not installed.
"""

import argparse
import json
import pathlib
import shutil
import sys
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent
BENCH = "cocotb_servo_channel"
TESTS = ["test_servo_channel", "test_random"]
try:
    from cocotb_tools.check_results import get_results
    from cocotb_tools.runner import get_runner
except ImportError:
    print("skipped: cocotb is not installed: pip install cocotb")
    sys.exit(77)


def sources(options):
    """The files of the list. Icarus 11 evaluates some `always_comb` without an end; as `always @*` they end."""
    for line in (options.rtl / "servo_channel.f").read_text().splitlines():
        if not line.startswith("//"):
            copy = options.build / "rtl" / pathlib.Path(line).name
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text((options.rtl / line).read_text().replace("always_comb", "always @*"))
            yield copy.resolve()


def simulate(options, scoreboard_results):
    """Where cocotb has written its results."""
    runner = get_runner("icarus")
    runner.build(sources=list(sources(options)), hdl_toplevel="servo_channel", build_args=["-g2012"],
                 timescale=("1ns", "1ps"), build_dir=options.build, waves=options.wave,
                 log_file=options.build / "iverilog.log")
    environment = {"SERVO_IC_XML": str((options.rtl / "regs/servo_ic.xml").resolve()),
                   "BENCH_RESULTS": str(scoreboard_results)}
    if options.negative:
        environment["NEGATIVE"] = "1"
    return runner.test(test_module=TESTS, hdl_toplevel="servo_channel", test_dir=HERE, build_dir=options.build,
                       waves=options.wave, seed=options.seed, extra_env=environment,
                       results_xml=str((options.build / "results.xml").resolve()))


def result(options, results, passed, scoreboard_results):
    """The keys of `brick run --json` that `brick regress` reads: a step for each test, and those of the scoreboard."""
    steps, now = [], 0.0
    for case in ElementTree.parse(results).iter("testcase"):
        now = float(case.find(".//property[@name='sim_time_stop']").get("value"))
        failure = case.find("failure")
        steps.append({"ns": round(now), "name": case.get("name"), "passed": failure is None,
                      "detail": "" if failure is None else failure.get("message", "")})
    judged = json.loads(scoreboard_results.read_text()) if scoreboard_results.exists() else {"steps": [], "covers": {}}
    return {"bench": BENCH, "seed": options.seed, "verdict": "PASS" if passed else "FAIL", "simulated_ns": round(now),
            "steps": judged["steps"] + steps,
            "covers": {f"{BENCH}: {name}": cover for name, cover in judged["covers"].items()}}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rtl", type=pathlib.Path, default=HERE.parent.parent / "rtl", help="of a tree or an install")
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("sim_build"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path, help="steps and covers, as brick run --json has them")
    parser.add_argument("--wave", action="store_true", help="writes servo_channel.fst into the build folder")
    parser.add_argument("--negative", action="store_true", help="a scoreboard with a wrong rule: the bench must fail")
    options = parser.parse_args()
    if shutil.which("iverilog") is None:
        print("skipped: iverilog is not installed")
        sys.exit(77)
    scoreboard_results = (options.build / "scoreboard.json").resolve()
    scoreboard_results.unlink(missing_ok=True)
    results = simulate(options, scoreboard_results)
    tests, failed = get_results(results)
    passed = tests > 0 and failed == 0
    if options.json:
        text = json.dumps(result(options, results, passed, scoreboard_results), indent=1)
        options.json.write_text(text + "\n")
    print(f"{'PASS' if passed else 'FAIL'} {BENCH}, seed {options.seed}: {tests} tests, {failed} failed")
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
