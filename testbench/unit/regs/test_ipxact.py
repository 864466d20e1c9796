"""The IP-XACT files say what the SystemRDL maps say: each register's address, each field's place, access and reset.

Read with the standard library, without the exporter that wrote them, and compared both ways. A wrong map is found.
"""

import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "rtl/regs"))
try:
    from maps import Maps
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

IPXACT = {"ipxact": "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"}
# What the CPU reaches outside the board's registers and memories: regions of its bus that hold other blocks.
REGIONS = ("main_memory", "ssi_page", "latches", "gate_ics", "on_chip")
ACCESS = {"r": "read-only", "w": "write-only", "rw": "read-write", "r, w1c": "read-write"}


def number(node, name):
    """The text of a child, a decimal or a SystemVerilog number such as 'h2A; None without one."""
    text = node.findtext(f"ipxact:{name}", None, IPXACT)
    return text if text is None else int(text[2:], 16) if text.startswith("'h") else int(text)


def read(name):
    """{(block, register): (byte address, {field: (lsb, width, access, reset)})}, {memory: (base, size)} of a file."""
    registers, memories = {}, {}
    component = ElementTree.parse(ROOT / f"rtl/regs/{name}.xml").getroot()
    for block in component.iterfind(".//ipxact:addressBlock", IPXACT):
        base, title = number(block, "baseAddress"), block.findtext("ipxact:name", None, IPXACT)
        if block.findtext("ipxact:usage", None, IPXACT) == "memory":
            memories[title] = (base, number(block, "range"))
        for register in block.iterfind("ipxact:register", IPXACT):
            fields = {f.findtext("ipxact:name", None, IPXACT): (
                number(f, "bitOffset"), number(f, "bitWidth"), f.findtext("ipxact:access", None, IPXACT),
                number(f.find("ipxact:resets/ipxact:reset", IPXACT), "value")
                if f.find("ipxact:resets", IPXACT) is not None else 0)
                for f in register.iterfind("ipxact:field", IPXACT)}
            registers[title, register.findtext("ipxact:name", None, IPXACT)] = (
                base + number(register, "addressOffset"), fields)
    return registers, memories


def byte(block, register, base=0):
    """X:a is byte 8a + 4, Y:a is 8a; host registers are bytes already."""
    return 8 * (base + register.address) + 4 * (register.space == "X") if block.words else register.address


def wanted(maps, name):
    """The same as read(), from the RDL."""
    blocks = {block.name: block for block in maps.blocks}
    relative = ("servo_channel", "servo_channel_fine") if name == "servo_ic" else ()
    placed = [(n, blocks[n], 0) for n in (name, *relative) if n in blocks]
    if name == "board":
        placed = [(block.name, block, 0) for block in maps.blocks if not block.relative]
        placed += [(ic.name, blocks[ic.kind], ic.base) for ic in maps.ics]
        placed.append(("pic_8259", blocks["pic_8259"], 0))  # a map of its own: its words share addresses
    registers = {(title, register.name): (byte(block, register, base), {
        f.name: (f.lsb, f.width, ACCESS[f.access], f.reset) for f in register.fields})
        for title, block, base in placed for register in block.registers}
    memories = {m.name: (8 * m.base, 8 * m.size) if m.words else (m.base, m.size) for m in maps.memories
                if m.name not in REGIONS}
    return registers, memories if name == "board" else {}


class IpXact(unittest.TestCase):
    maps = Maps()
    maxDiff = 2000

    def test_each_component_has_what_the_maps_have(self):
        for name, least in (("servo_ic", 20), ("macro_ic", 8), ("board", 100)):
            with self.subTest(name):
                self.assertGreater(len(read(name)[0]), least)
                self.assertEqual(read(name), wanted(self.maps, name))

    def test_known_numbers(self):
        registers, _ = read("servo_ic")  # 8 x $04 + 4, docs/registers.md
        self.assertEqual(registers["servo_ic", "clock_control"][0], 0x24)
        self.assertEqual(registers["servo_ic", "clock_control"][1]["servo_divider"], (20, 4, "read-write", 3))
        registers, memories = read("board")
        self.assertEqual(registers["servo_ic_1", "clock_control"][0], 8 * 0x078104 + 4)
        self.assertEqual(registers["host_io", "cvr"], (0x211, {"hv": (0, 7, "read-write", 0x32),
                                                               "hc": (7, 1, "read-write", 0)}))
        self.assertEqual(memories["dpram_window"], (0xD0000, 65536))

    def test_a_wrong_map_is_found(self):
        maps = Maps()
        next(block for block in maps.blocks if block.name == "macro_ic").registers[0].fields[0].lsb += 1
        self.assertNotEqual(read("macro_ic"), wanted(maps, "macro_ic"))
        maps.ics[3].base += 1
        self.assertNotEqual(read("board")[0], wanted(maps, "board")[0])


if __name__ == "__main__":
    unittest.main()
