"""brick_vectors from outside: exit statuses. usage: program_test.py BRICK_VECTORS"""
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
VECTORS = pathlib.Path(__file__).resolve().parents[2] / "vectors"
RIGHT = "expect ch1.equ is 1"


def run(*arguments, stdout=subprocess.PIPE):
    return subprocess.run([PROGRAM, *map(str, arguments)], stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=60,
                          check=False)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def faults_of_a_wrong_vector():
    """A vector that fails without a fault shows none of its faults: it is no proof, and says so."""
    good = VECTORS / "equ_write.vec"
    r = run("--negative", good)
    check(r.returncode == 0 and "NOT FOUND" not in r.stdout, f"{r}")
    with tempfile.TemporaryDirectory() as folder:
        wrong = pathlib.Path(folder, "wrong.vec")
        text = good.read_text()
        check(RIGHT in text, f"{good.name} has no `{RIGHT}`")
        wrong.write_text(text.replace(RIGHT, "expect ch1.equ is 0", 1))
        r = run("--negative", wrong)
        check(r.returncode == 1 and f"{wrong}: fails without a fault" in r.stderr and r.stdout == "", f"{r}")


def figure_lost():
    """What is printed and finds no room is a failure."""
    for options in (["--draw"], ["--negative"], []):
        with open("/dev/full", "w", encoding="ascii") as full:
            r = run(*options, VECTORS / "adc_word.vec", stdout=full)
        check(r.returncode == 1 and "stdout took no more" in r.stderr, f"{options}: {r}")


faults_of_a_wrong_vector()
figure_lost()
