"""The register maps of this folder as plain Python: what generate.py writes down in several languages.

Needs the package systemrdl-compiler (PyPI).
"""

from dataclasses import dataclass, field
from pathlib import Path

from systemrdl import RDLCompiler
from systemrdl.node import AddrmapNode, MemNode

HERE = Path(__file__).resolve().parent


@dataclass
class Code:  # one value of a field
    name: str
    value: int
    desc: str


@dataclass
class Codes:
    name: str
    width: int
    list: list


@dataclass
class Field:
    name: str
    lsb: int
    width: int
    access: str
    reset: int
    desc: str
    stored: bool
    codes: str  # name of its Codes, or ""

    @property
    def mask(self):
        return ((1 << self.width) - 1) << self.lsb


@dataclass
class Register:
    name: str
    title: str
    desc: str
    space: str  # "X", "Y" or "" for host bytes
    address: int  # PMAC word or byte; absolute when the block exists once
    width: int
    fields: list

    @property
    def reset(self):
        return sum(f.reset << f.lsb for f in self.fields)

    @property
    def written(self):  # bits that software can write
        return sum(f.mask for f in self.fields if "w" in f.access)

    @property
    def parts(self):  # fields that are not the whole word
        return [f for f in self.fields if f.width != self.width]

    def hex(self, value):
        return f"{value:0{self.width // 4}X}"


@dataclass
class Block:
    name: str
    title: str
    desc: str
    words: bool
    base: int  # 0 when addresses are offsets
    relative: bool
    registers: list = field(default_factory=list)


@dataclass
class Ic:
    name: str
    kind: str
    number: str
    base: int
    fitted: int
    direction: int


@dataclass
class Memory:
    name: str
    title: str
    words: bool
    base: int
    size: int


def access_name(node):
    text = {"r": "r", "w": "w", "rw": "rw"}[node.get_property("sw").name]
    if node.get_property("onwrite") is not None and node.get_property("onwrite").name == "woclr":
        return "r, w1c"
    return text


class Maps:
    """Blocks, gate ICs in the order of their fitted bits, memories and codes."""

    def __init__(self):
        self.blocks, self.ics, self.memories, self.codes = [], [], [], []
        self.compiler = compiler = RDLCompiler()
        compiler.compile_file(str(HERE / "brick.rdl"))
        for top in ("brick_cpu", "brick_cpu_regions", "brick_cpu_geo_pmac", "brick_host_io", "brick_host_memory"):
            root = compiler.elaborate(top).top
            for node in root.children(unroll=True):
                if isinstance(node, MemNode):
                    self._add_memory(node, words=top.startswith("brick_cpu"))
                elif isinstance(node, AddrmapNode) and node.get_property("ic_name") is None:
                    self._add_block(node)
                elif isinstance(node, AddrmapNode):
                    self._add_ic(node, compiler)
            if root.get_property("codes") is not None:
                self._add_codes(type(root.get_property("codes")))
        self._add_block(compiler.elaborate("pic_8259").top, "pic_8259")  # an alternative to registers of host_io
        self.memories.sort(key=lambda memory: (not memory.words, memory.base))
        self.ics.sort(key=lambda ic: ic.fitted)
        sources = next(codes for codes in self.codes if codes.name == "clock_source")
        sources.list[:0] = [Code(ic.name, ic.fitted, f"{ic.kind.split('_')[0].capitalize()} IC {ic.number}")
                            for ic in self.ics]
        for codes in self.codes:
            codes.width = max(code.value for code in codes.list).bit_length()

    def _add_memory(self, node, words):
        entries = node.get_property("mementries")
        size = entries if words else entries * node.get_property("memwidth") // 8
        base = node.raw_absolute_address // (8 if words else 1)
        self.memories.append(Memory(node.inst_name, node.get_property("name"), words, base, size))

    def _add_ic(self, node, compiler):
        kind = node.orig_type_name
        known = any(ic.kind == kind for ic in self.ics)
        self.ics.append(Ic(node.inst_name, kind, node.get_property("ic_name"), node.raw_absolute_address // 8,
                           node.get_property("fitted_index"), node.get_property("direction_variable")))
        if known:
            return
        self._add_block(node, kind)
        if kind == "servo_ic":
            for channel in ("servo_channel", "servo_channel_fine"):
                self._add_block(compiler.elaborate(channel).top, channel)

    def _add_block(self, node, relative_name=None):
        words = bool(node.get_property("words"))
        base = 0 if relative_name else node.raw_absolute_address // (8 if words else 1)
        block = Block(relative_name or node.inst_name, node.get_property("name"), node.get_property("desc") or "",
                      words, base, relative_name is not None)
        for reg in node.registers():
            offset = reg.raw_address_offset
            address = base + (offset // 8 if words else offset)
            space = ("X" if offset % 8 == 4 else "Y") if words else ""
            block.registers.append(
                Register(reg.inst_name, reg.get_property("name"), reg.get_property("desc") or "", space, address,
                         24 if words else 8, [self._field(f) for f in reg.fields()]))
        self.blocks.append(block)

    def _field(self, node):
        codes = node.get_property("encode")
        if codes is not None:
            self._add_codes(codes)
        return Field(node.inst_name, node.low, node.width, access_name(node), node.get_property("reset") or 0,
                     node.get_property("desc") or "", bool(node.get_property("stored")),
                     codes.type_name if codes is not None else "")

    def _add_codes(self, codes):
        if all(known.name != codes.type_name for known in self.codes):
            listed = [Code(code.name, code.value, code.rdl_desc or "") for code in codes]
            self.codes.append(Codes(codes.type_name, 0, listed))
