#!/usr/bin/env python3
"""Compiles the channel from its file list with Icarus and runs the tests: run.py [--rtl DIR] [--build DIR] [--waves].

Exit status 0 passed, 1 a test failed, 77 cocotb or Icarus is not installed.
"""

import argparse
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
try:
    from cocotb_tools.check_results import get_results
    from cocotb_tools.runner import get_runner
except ImportError:
    print("skipped: cocotb is not installed: pip install cocotb")
    sys.exit(77)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rtl", type=pathlib.Path, default=HERE.parent.parent / "rtl", help="of a tree or an install")
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("sim_build"))
    parser.add_argument("--waves", action="store_true", help="writes servo_channel.fst into the build folder")
    options = parser.parse_args()
    if shutil.which("iverilog") is None:
        print("skipped: iverilog is not installed")
        sys.exit(77)
    listed = (options.rtl / "servo_channel.f").read_text().splitlines()
    runner = get_runner("icarus")
    runner.build(sources=[options.rtl / line for line in listed if not line.startswith("//")],
                 hdl_toplevel="servo_channel", build_args=["-g2012"], timescale=("1ns", "1ps"),
                 build_dir=options.build, waves=options.waves, log_file=options.build / "iverilog.log")
    results = runner.test(test_module="test_servo_channel", hdl_toplevel="servo_channel", test_dir=HERE,
                          build_dir=options.build, waves=options.waves,
                          results_xml=str((options.build / "results.xml").resolve()),
                          extra_env={"SERVO_IC_XML": str((options.rtl / "regs/servo_ic.xml").resolve())})
    tests, failed = get_results(results)
    print(f"{tests} tests, {failed} failed")
    sys.exit(0 if tests and not failed else 1)


if __name__ == "__main__":
    main()
