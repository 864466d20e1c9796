"""Where programs are built: in folders of the build tree that they are taken from. What runs side by side, such as a
session and a test of the suite, has folders of its own; of two alike the second waits, and not without an end."""

import fcntl
import os
import time

from runner import BadBuild

WAIT, LOOK = 150, 0.5  # s; with the building that follows within the limit of a test


def folder_of(tree, use, name):
    """`use`: of those that may build the same at the same time, which."""
    return tree / "mutate" / use / name


def claimed(folder, wait=WAIT):
    """A file; until it is closed, or this process ends, nobody else builds in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    lock, end = (folder / "lock").open("a+"), time.monotonic() + wait
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            break
        except OSError as held:
            if time.monotonic() >= end:
                with lock:
                    lock.seek(0)
                    raise BadBuild(f"{folder}: process {lock.read().strip() or '?'}, another ./dev mutate, has been at "
                                   f"work there for {wait:g} s; wait for its end, or end it") from held
        time.sleep(LOOK)
    lock.truncate(0)
    lock.write(str(os.getpid()))
    lock.flush()
    return lock
