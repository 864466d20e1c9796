"""The register maps as IP-XACT (IEEE 1685-2014): one component a chip, a memory map for each face of it.

Written by PeakRDL's exporter (PyPI peakrdl-ipxact) from the same elaborated maps as all else. Addresses are bytes:
X:a is 8a + 4 and Y:a is 8a, from the base of the IC, or of the channel, which is at 64 (n - 1).
"""

import re
import tempfile
from pathlib import Path
from xml.dom import minidom

from peakrdl_ipxact import IPXACTExporter

ROOT = Path(__file__).resolve().parent.parent.parent
# Component: the address maps that it shows. What overlaps, as the two faces of a channel do, are maps of their own.
COMPONENTS = {
    "servo_ic": ("servo_ic", "servo_channel", "servo_channel_fine"),
    "macro_ic": ("macro_ic",),
    "board": ("brick_cpu", "brick_host_io", "pic_8259", "brick_host_memory"),
}


def exported(compiler, top, component, version):
    """The component with the memory map of one address map."""
    exporter = IPXACTExporter(vendor="brick", library="ip", version=version)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "map.xml"
        exporter.export(compiler.elaborate(top).top, str(file), component_name=component)
        return minidom.parse(str(file))


def write_ipxact(compiler, component, notice):
    """The lines of one component."""
    version = re.search(r"project\(brick VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    tops = COMPONENTS[component]
    document = exported(compiler, tops[0], component, version)
    maps = document.getElementsByTagName("ipxact:memoryMaps")[0]
    for top in tops[1:]:
        for one in exported(compiler, top, component, version).getElementsByTagName("ipxact:memoryMap"):
            maps.appendChild(document.importNode(one, deep=True))
    text = document.documentElement.toprettyxml(indent="  ")  # of parsed text: blank lines between its own
    return ['<?xml version="1.0" encoding="UTF-8"?>', f"<!-- {notice} -->",
            *(line for line in text.splitlines() if line.strip()), ""]
