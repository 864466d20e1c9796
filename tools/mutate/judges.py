"""Who judges what, by its kind."""

from common import ROOT

import firmware
import rtl


def of(module, tree):
    return {"rtl": rtl.Judge, "firmware": firmware.Judge}[module.kind](ROOT, tree, module)
