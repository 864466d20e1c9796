"""Outputs that a mutant leaves unknown behind the reset, as lint.unknowns finds them with Icarus, which knows four
states: in the others' two a flip-flop without a reset has a level that is right now and then."""

import check_unknowns

SEED, CLOCKS = 1, 8000  # of lint.unknowns


def top_of(root, file):
    """The smallest design of check_unknowns that has the file; None: there is none."""
    tops = {top: (root / f"rtl/{top}.f").read_text().splitlines() for top in check_unknowns.TOPS}
    having = [top for top, listed in tops.items() if file.removeprefix("rtl/") in listed]
    return min(having, key=lambda top: len(tops[top]), default=None)


def found(root, file, mutated):
    """'TOP: OUTPUT is unknown at TIME' with `mutated` as the text of `file`; None: no output is, or nobody can say."""
    top = top_of(root, file)
    if top is None:
        return None
    try:
        outputs, _, _ = check_unknowns.look(root, top, SEED, CLOCKS, {file: mutated})
    except check_unknowns.Failed:
        return None
    return next((f"{top}: {name} is unknown at {time}" for name, time in outputs.items()), None)
