"""Random scripts through the built command: status 0, 1 or 2 and what was expected, and the controller lives.

usage: script_fuzz.py BRICK SCRIPT_LINES FIRST COUNT; a script a number, every fourth with broken bytes.
"""
import collections
import subprocess
import sys

BRICK, LINES = sys.argv[1:3]
LONGEST = 300  # seconds of wall time, for half a second of simulated time


def play(seed, broken):
    script = subprocess.run([LINES, str(seed), *(["broken"] if broken else [])], capture_output=True, check=True).stdout
    run = subprocess.run([BRICK, "exec", "-"], input=script, capture_output=True, timeout=LONGEST, check=False)
    said = run.stderr.decode()  # which is UTF-8, whatever the script holds
    wrong = None
    if run.returncode not in ((0, 1, 2) if broken else (0,)):
        wrong = f"exit {run.returncode}"
    elif run.returncode != 0 and "expected" not in said.splitlines()[-1]:
        wrong = "it does not say what was expected"
    elif any(c < " " and c != "\n" for c in said + run.stdout.decode()):
        wrong = "control characters on the terminal"
    elif not broken and not run.stdout.decode().splitlines()[-1].endswith("1.947"):
        wrong = "the last answer is another"
    return run.returncode, wrong and f"seed {seed}{' broken' if broken else ''}: {wrong}: {said[-600:]}"


first, count = int(sys.argv[3]), int(sys.argv[4])
statuses, failures = collections.Counter(), []
for seed in range(first, first + count):
    status, failure = play(seed, seed % 4 == 3)
    statuses[status] += 1
    if failure:
        failures.append(failure)
print(f"{count} scripts, by status: {dict(statuses)}")
if failures:
    sys.exit("\n".join(failures))
