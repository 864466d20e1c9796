"""Outputs that a mutant leaves unknown behind the reset, as lint.unknowns finds them with Icarus, which knows four
states: in the others' two a flip-flop without a reset has a level that is right now and then."""

import functools

import check_unknowns
from runner import BadBuild

SEED, CLOCKS = 1, 8000  # of lint.unknowns


def top_of(root, file):
    """The smallest design of check_unknowns that has the file; None: there is none."""
    tops = {top: (root / f"rtl/{top}.f").read_text().splitlines() for top in check_unknowns.TOPS}
    having = [top for top, listed in tops.items() if file.removeprefix("rtl/") in listed]
    return min(having, key=lambda top: len(tops[top]), default=None)


@functools.cache
def pass_zero(root, top):
    """Raises BadBuild where Icarus does not run the sources as they are, or finds something in them."""
    try:
        outputs, _, _ = check_unknowns.look(root, top, SEED, CLOCKS)
    except check_unknowns.Failed as failed:
        raise BadBuild(f"unknowns: {failed}") from failed
    if outputs:
        raise BadBuild(f"unknowns: {top}, as it is: {', '.join(outputs)} unknown behind the reset")


def found(root, file, mutated):
    """'TOP: OUTPUT is unknown at TIME' with `mutated` as the text of `file`; None: no output is, or Icarus, which runs
    the sources as they are, does not run these."""
    top = top_of(root, file)
    if top is None:
        return None
    pass_zero(root, top)
    try:
        outputs, _, _ = check_unknowns.look(root, top, SEED, CLOCKS, {file: mutated})
    except check_unknowns.Failed:
        return None
    return next((f"{top}: {name} is unknown at {time}" for name, time in outputs.items()), None)
