"""What tests of the package have in common (fixtures: conftest.py)."""

import pathlib
import time

PATIENCE = 60


class Alarm(Exception):
    pass


def gone(pid):
    limit = time.monotonic() + PATIENCE
    while time.monotonic() < limit:
        try:
            if pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except FileNotFoundError:
            return True
        time.sleep(0.01)
    return False
