"""Who judges what, by its kind."""

import native
from common import ROOT

import rtl


def of(module, tree, use):
    """`use`: see workplace.py."""
    judge = rtl.Judge if module.kind == "rtl" else native.Judge
    return judge(ROOT, tree, module, use)
