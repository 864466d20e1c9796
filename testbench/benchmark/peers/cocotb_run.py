"""cocotb_run.py build FOLDER SOURCE... | test FOLDER: the peer under cocotb's own runner, with Verilator."""

import pathlib
import sys

from cocotb.runner import get_runner  # type: ignore[import-not-found]

HERE = pathlib.Path(__file__).resolve().parent


def main():
    what, folder, *sources = sys.argv[1:]
    runner = get_runner("verilator")
    if what == "build":
        runner.build(verilog_sources=sources, hdl_toplevel="servo_ic", build_dir=folder,
                     build_args=["-O3", "-fno-table", "--x-assign", "fast", "-Wno-fatal", "-Wno-lint", "-Wno-style",
                                 "-CFLAGS", "-O3"])
        return
    runner.build_dir, runner.verilog_sources, runner.vhdl_sources = pathlib.Path(folder), [HERE], []  # as build() does
    runner.test(test_module="cocotb_peer", hdl_toplevel="servo_ic", test_dir=HERE, build_dir=folder,
                results_xml=str(pathlib.Path(folder) / "results.xml"))


if __name__ == "__main__":
    main()
