"""modules.toml, read: what is mutated, and by which tests it is judged."""

import dataclasses
import pathlib
import tomllib

from runner import Tests

FILE = pathlib.Path(__file__).parent / "modules.toml"


class Unknown(Exception):
    """What the user asks for is not there."""


@dataclasses.dataclass(frozen=True)
class Module:
    kind: str
    name: str
    file: str  # or the folder of the files
    tops: tuple  # of the filter, in turn; none: no filter
    proof: str  # of testbench/formal; "": none
    opinion: tuple
    board: tuple
    slip: tuple
    files: tuple = ("*",)  # of the folder
    image: tuple = ()  # of the firmware
    rest: bool = False  # a folder of the firmware with a sum, and a goal, of its own


def tests(entries, sets):
    found = []
    for entry in entries:
        if entry in sets:
            found += tests(sets[entry], sets)
        else:
            program, _, which = entry.partition(" ")
            found.append(Tests(program, which or "*"))
    return tuple(found)


def read(file=FILE):
    """{kind: {name: Module}}"""
    table = tomllib.loads(file.read_text())
    sets = table.pop("sets", {})
    kinds = {}
    for kind, modules in table.items():
        kinds[kind] = {
            name: Module(kind, name, row["file"], tuple(row.get("tops", [name])), row.get("proof", ""),
                         tests(row["opinion"], sets), tests(row.get("board", []), sets),
                         tests(row.get("slip", []), sets), tuple(row.get("files", ["*"])),
                         tests(row.get("image", []), sets), row.get("rest", False))
            for name, row in modules.items()}
    return kinds


def choose(kind, names):
    """The modules of a kind that have these names, all where there are none; 'again': of any kind, and a name may be
    KIND.NAME."""
    kinds = read()
    if kind not in [*kinds, "again"]:
        raise Unknown(f"no '{kind}' is mutated; there is: {', '.join(sorted([*kinds, 'again']))}")
    modules = [m for of, found in kinds.items() if kind in (of, "again") for m in found.values()]
    known = {m: (m.name, f"{m.kind}.{m.name}") for m in modules}
    unknown = [name for name in names if not any(name in called for called in known.values())]
    if unknown:
        raise Unknown(f"{kind}: no module {', '.join(unknown)}; there is: {', '.join(m.name for m in modules)}")
    return [m for m, called in known.items() if not names or set(names) & set(called)]
