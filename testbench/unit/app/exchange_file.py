"""Exchange files: what the host sends and every byte that the controller answers (exchanges/*.txt).

    # comment
    I3 => 2<CR><ACK>
    @wait 5ms

<CR> <LF> <ACK> <BELL> stand for themselves and <18> for a byte in hexadecimal, _ for any hexadecimal digit, {5..9} for
a number in between; a line without `=>` is the host's (docs/scripts.md) and has no answer.
"""
import pathlib
import re

from command import check, play

FOLDER = pathlib.Path(__file__).resolve().parent / "exchanges"
NAMES = {"<CR>": "<0D>", "<LF>": "<0A>", "<ACK>": "<06>", "<BELL>": "<07>"}
RANGE = re.compile(r"\{(-?\d+)\.\.(-?\d+)\}")


def read(name):
    """(line in the file, what is sent, what is expected or None) of each line."""
    for number, line in enumerate((FOLDER / name).read_text().splitlines(), 1):
        if line and not line.startswith("# "):
            sent, arrow, expected = line.partition(" => ")
            yield number, sent, expected if arrow else None


def fits(reply, expected):
    for mark, byte in NAMES.items():
        expected = expected.replace(mark, byte)
    ranges = RANGE.findall(expected)
    parts = [re.escape(part).replace("_", "[0-9A-F]") for part in RANGE.sub("\0", expected).split("\0")]
    found = re.fullmatch(r"(-?\d+)".join(parts), reply)
    return found is not None and all(int(low) <= int(value) <= int(high)
                                     for value, (low, high) in zip(found.groups(), ranges, strict=True))


def differences(name, *options):
    """What does not fit, a string each; and how many answers were compared."""
    exchanges = list(read(name))
    r = play([sent for _, sent, _ in exchanges], "--raw", *options)
    check(r.returncode == 0, f"{name} {options}: exit {r.returncode}: {r.stderr}")
    replies = iter(r.stdout.splitlines())
    found, compared = [], 0
    for number, sent, expected in exchanges:
        if expected is None:
            continue
        reply = next(replies, "nothing")
        compared += 1
        if not fits(reply, expected):
            found.append(f"{name}:{number}: `{sent}` answered {reply}, expected {expected}")
    left = list(replies)
    if left:
        found.append(f"{name}: {len(left)} answers more than expected: {left[0]}")
    return found, compared
