"""The built command, called from outside: what the *acceptance.py share."""
import pathlib
import subprocess
import sys

BRICK, CASE = sys.argv[1], sys.argv[2]
REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
BOARDS, EXAMPLES = REPOSITORY / "boards", REPOSITORY / "examples"


def brick(*arguments, script=None, timeout=240):
    return subprocess.run([BRICK, *arguments], input=script, capture_output=True, text=True, timeout=timeout)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def play(lines, *options):
    return brick("exec", *options, "-", script="\n".join(lines) + "\n")
