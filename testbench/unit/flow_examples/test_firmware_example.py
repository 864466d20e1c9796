"""examples/firmware, from an installed tree: the image is ours to the byte, the right step of the bench fails.

Its own control: with a change that alters nothing the script fails.
"""

import os
import pathlib
import shutil
import subprocess
import sys

from installed import Installed, main

OBJCOPY = "riscv64-unknown-elf-objcopy"


class FirmwareChange(Installed):
    def run_example(self):
        example = self.data / "examples/firmware"
        where = {"BUILD": str(self.prefix / "image"), "BRICK": f"{self.build}/bin/brick"}
        if shutil.which("ccache") is not None:  # the same sources are compiled twice
            where |= {"MAKEFLAGS": r"CC=ccache\ riscv64-unknown-elf-gcc", "CCACHE_DIR": str(self.prefix / "ccache")}
        return subprocess.run([example / "run.sh"], timeout=250, text=True, env={**os.environ, **where},
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def content(self, elf):
        """What the image loads, without names of files."""
        subprocess.run([OBJCOPY, "-O", "binary", elf, self.prefix / "content.bin"], check=True)
        return (self.prefix / "content.bin").read_bytes()

    def test_the_change_fails_the_step_that_counts_lines_up_to_i17(self):
        done = self.run_example()
        self.assertEqual(done.returncode, 0, done.stdout)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[:3], ["PASS breq-rotary", "changed: firmware/buffers/buffer_request.c",
                                     "CC firmware/buffers/buffer_request.c"], "one file is compiled again")
        self.assertRegex(lines[3], r"FAIL  filling, I16=5 I17=10: .*expected: stays low from I17=10 on")
        self.assertEqual(lines[4:], ["FAIL breq-rotary"])
        self.assertNotEqual(self.content(self.prefix / "image/turbo.elf"), self.content(f"{self.build}/bin/turbo.elf"))
        # The change taken back, with the same objects: the Makefile builds what CMake builds, and no change is noticed.
        self.plant("examples/firmware/i17_off_by_one.patch", "+  if ((int32_t)ring->lines > ",
                   "+  if ((int32_t)ring->lines  >= ")
        done = self.run_example()
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("the bench did not notice the change: exit status 0", done.stdout)
        self.assertEqual(self.content(self.prefix / "image/turbo.elf"), self.content(f"{self.build}/bin/turbo.elf"))


if __name__ == "__main__":
    for program in ("riscv64-unknown-elf-gcc", "patch", "make"):
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed")
            sys.exit(77)
    if not pathlib.Path(sys.argv[1], "bin/brick").exists():
        print("skipped: brick is not built")
        sys.exit(77)
    main(sys.argv)
