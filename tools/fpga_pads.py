"""Delays between pads and flip-flops in a placed design, from the SDF file that nextpnr writes; docs/fpga.md.

nextpnr judges what runs from clock to clock. Here is the rest: pad to flip-flop, flip-flop to pad, pad to pad without a
clock, /RD to the end of D and to what enables it, the flip-flop that releases the reset to all that it resets; and what
that means for the rows of the data sheet of Port A and ISA.
"""

import collections
import math
import re
import sys

TICK = 1000 / 117.9648
CPU = 9.8304  # MHz, times I52 + 1
# What nextpnr does not know, of an LFE5U of grade 8 with LVCMOS33 and a clock from a PLL: rows of "External Switching
# Characteristics" in Lattice's ECP5 family data sheet, FPGA-DS-02012. A pad into a register beside it sets up in
# tSUPLL; tCOPLL is clock, register and pad, so the register counts twice here.
PAD_IN, PAD_OUT, SKEW = 0.70, 3.50, 0.42  # tSUPLL, tCOPLL, tSKEW_PRI
# The RAM has its word a clock before /TA falls; the CPU samples D 0.25 TC - 3 ns behind /TA (rows 105 and 118 of
# host-bus:2.2), which is before it at the fastest clock that pads are allowed for, I52 = 15.
BEHIND_TA = TICK + 0.25 * 1000 / (CPU * 16) - 3.0
TO_PAD = 10.0  # D and /TA, from their clock
# /RD is high for row 113 of host-bus:2.2 at least, behind gate ICs and behind the RAM, at the fastest clock up to which
# host-bus:2.5 promises that D is off then.
SLOW_I52, RAM_I52 = 21, 13
RD_HIGH = 2.75 * 1000 / (CPU * (SLOW_I52 + 1)) - 4.0
RD_HIGH_RAM = 1.75 * 1000 / (CPU * (RAM_I52 + 1)) - 4.0
RAM, STROBES = "u_dpram.", "u_bus_strobes."  # cells
RELEASE = r"\bu_(core\.u_reset_sync\.u_pwm\.sync2|chip\.rst)_q"  # lets go of the reset, on the board, in a servo IC
# From the board's chip to that of a servo IC the reset has a tick, of which this is the board's part.
RESET_PART = 6.2
# Which pads must keep a time, and the rows of host-bus they are for: to a flip-flop, or from one.
PORT_A_IN, ISA_IN = r"pa_.*_n?io?", r"isa_(?!sd_io|resetdrv).*_n?i"
D, TA, MEMCS16, CLOCKS = r"pa_d(ata)?_io", r"pa_ta_n_?o", r"isa_memcs16_n_?io", r"(phase|servo)_io"
RESET_OUT, RESET_IN = "rst_ref_no", "rst_ref_ni"
SHOWN = r"(pa|isa|phase|servo|trip|equ|wdo|rst_ref)_"
Row = collections.namedtuple("Row", "rule what has limit")

Graph = collections.namedtuple("Graph", "after before setup launch")
UNIT = 1000.0  # ps in the file, ns here


def parts(name):
    """cell/port of a name with the escapes of an SDF file."""
    cell, port = name.replace("\\", "").rsplit("/", 1)
    return cell, port


def triple(text):
    return float(text.strip("()").split(":")[2]) / UNIT  # the slowest


def read(lines):
    """The wires and cells of an SDF file: (cell, port) -> its followers with their delays."""
    after, before, setup, launch = (collections.defaultdict(list), collections.defaultdict(list), {}, {})
    kind = cell = None

    def edge(a, b, delay):
        after[a].append((b, delay))
        before[b].append((a, delay))

    for line in lines:
        word = line.split()
        if not word:
            continue
        if word[0] == "(CELLTYPE":
            kind = word[1].strip('")')
        elif word[0] == "(INSTANCE" and len(word) > 1:
            cell = word[1].removesuffix(")").replace("\\", "")
        elif word[0] == "(INTERCONNECT":
            edge(parts(word[1]), parts(word[2]), triple(word[3]))
        elif word[0] == "(IOPATH" and kind == "TRELLIS_COMB":
            edge((cell, word[1]), (cell, word[2]), triple(word[3]))
        elif word[0] == "(IOPATH":  # of a flip-flop or a memory: from its clock
            launch[cell, word[2]] = triple(word[3])
        elif word[0] == "(SETUPHOLD":
            port = word[2].strip(")")
            setup[cell, port] = max(setup.get((cell, port), 0.0), triple(word[5]))
    return Graph(after, before, setup, launch)


def longest(edges, ends):
    """node -> the longest way from it to one of `ends` (node -> delay there), None: there is none."""
    known = dict(ends)

    def visit(start):
        todo = [start]
        while todo:
            node = todo[-1]
            if node in known:
                todo.pop()
                continue
            fresh = [n for n, _ in edges.get(node, ()) if n not in known]
            if fresh and todo.count(node) == 1:
                todo += fresh
                continue
            ways = [known[n] + delay for n, delay in edges.get(node, ()) if known.get(n) is not None]
            known[node] = max(ways, default=None)
            todo.pop()
        return known[start]

    return visit


def pad(cell):
    """The port that the cell is a pad of; those of two ways are cells of the tops (fpga/ecp5_pads.sv)."""
    both = re.search(r"\bu_(\w+)\.gen_pad\[\d+\]\.u_pad$", cell)
    if both:
        return {"iochrdy": "isa_iochrdy", "memcs16": "isa_memcs16_n"}.get(both[1], both[1]) + "_io"
    return cell.removesuffix("$tr_io") if cell.endswith("$tr_io") else None


def bus(name):
    return re.sub(r"\[\d+\]$", "", name)


def delays(graph):
    """Of each pad, a bus as one, {kind: the longest way}, and that of the reset. Kinds: "in" to a flip-flop, "through"
    from another pad, "out" from a flip-flop to the level, "enable" to what turns the pad on, "ram" from the dual-ported
    RAM to either. What a strobe clocks follows no clock and counts nowhere. Of D alone, for each of its pads, from /RD
    to what turns it on: "off" by way of a flip-flop that /RD clears, "off_ram" by one of the RAM, "end" by a gate where
    the pad has one, which ends D whatever the flip-flops do, else by these. The file has no time from a reset to Q:
    that from the clock stands for it. What synthesis clears with the clock has the same input as the reset, LSR, and
    the time of its clock, which nextpnr judges: of the reset only ways from the flip-flop that releases it count.
    """
    nodes = set(graph.after) | set(graph.before)
    flip_flops = {node: delay for node, delay in graph.setup.items() if node[1] != "LSR"}
    clears = [node for node in graph.setup if node[1] == "LSR"]
    pads_in = {node: 0.0 for node in nodes if pad(node[0]) and node[1] == "O"}
    launch = {node: delay for node, delay in graph.launch.items() if STROBES not in node[0]}
    ram = {node: delay for node, delay in launch.items() if RAM in node[0]}
    others = {node: delay for node, delay in launch.items() if RAM not in node[0]}
    read = longest(graph.before, {node: 0.0 for node in pads_in if pad(node[0]) == "pa_rd_ni"})
    cleared = {(cell, "Q"): read((cell, port)) + launch.get((cell, "Q"), 0.0)
               for cell, port in clears if read((cell, port)) is not None}
    off = longest(graph.before, {node: delay for node, delay in cleared.items() if RAM not in node[0]})
    off_ram = longest(graph.before, {node: delay for node, delay in cleared.items() if RAM in node[0]})
    release = {node: delay for node, delay in graph.launch.items() if re.search(RELEASE, node[0])}
    inwards, resets = longest(graph.after, flip_flops), longest(graph.before, release)
    to_level = {"out": longest(graph.before, others), "ram": longest(graph.before, ram),
                "through": longest(graph.before, pads_in)}
    to_enable = {"enable": to_level["out"], "ram": to_level["ram"], "through": to_level["through"]}
    found = collections.defaultdict(dict)
    for node in sorted(nodes):
        if not pad(node[0]):
            continue
        row = found[bus(pad(node[0]))]
        ways = {"O": {"in": inwards}, "I": to_level, "T": to_enable}.get(node[1], {})
        for kind, way in ways.items():
            keep(row, kind, way(node))
        if node[1] == "T" and re.fullmatch(D, pad(node[0])):
            for kind, delay in ends(read(node), off(node), off_ram(node) if ram else 0.0).items():
                keep(row, kind, delay)
    reset = [resets(node) + graph.setup[node] for node in clears if resets(node) is not None]
    return dict(found), max(reset, default=None)


def ends(gate, off, off_ram):
    """How one pad of D is ended, from the ways that it has; what it lacks takes for ever."""
    off, off_ram = (math.inf if way is None else way for way in (off, off_ram))
    return {"end": max(off, off_ram) if gate is None else gate, "off": off, "off_ram": off_ram}


def keep(row, kind, delay):
    if delay is not None:
        row[kind] = max(row.get(kind, 0.0), delay)


def worst(found, pattern, *kinds):
    ways = [ways[kind] for name, ways in found.items() if re.fullmatch(pattern, name) for kind in kinds if kind in ways]
    return max(ways, default=0.0)


def spare(row):
    return row.limit - row.has


def rows(found):
    """The rows of the data sheet that pads decide, the one with the least to spare first."""
    a_in = worst(found, PORT_A_IN, "in") + PAD_IN + SKEW
    isa_in = worst(found, ISA_IN, "in") + PAD_IN + SKEW
    ta = worst(found, TA, "out", "ram")
    out = {name: worst(found, name, "out", "enable") + PAD_OUT + SKEW
           for name in (D, "isa_sd_io", "isa_iochrdy_io", MEMCS16)}
    table = [(PORT_A_IN, Row("host-bus:2.6", "pads of Port A to a flip-flop", a_in, TICK)),
             (D, Row("host-bus:2.6", "clock to D, of registers", out[D], TO_PAD)),
             (D, Row("host-bus:2.6/5", "/RD to the end of D, without a clock",
                     worst(found, D, "end") + PAD_IN + PAD_OUT, TICK)),
             (D, Row("host-bus:2.2, row 113", f"/RD to registers off D behind its gate, up to I52 = {SLOW_I52}",
                     worst(found, D, "off"), RD_HIGH)),
             (TA, Row("host-bus:2.2, row 113", f"/RD to the RAM off D behind its gate, up to I52 = {RAM_I52}",
                      worst(found, D, "off_ram"), RD_HIGH_RAM)),
             (TA, Row("host-bus:2.6", "clock to /TA", ta + PAD_OUT + SKEW, TO_PAD)),
             (TA, Row("host-bus:6.9/8", "D of the RAM behind /TA, which comes a clock later",
                      worst(found, D, "ram") - ta, BEHIND_TA)),
             (CLOCKS, Row("servo-ic:5.1/11", "PHASE, SERVO from chip to chip, without the wire",
                          worst(found, CLOCKS, "out") + PAD_OUT + SKEW + worst(found, CLOCKS, "in") + PAD_IN, TICK)),
             (RESET_OUT, Row("host-bus:2.6", "clock to the reset of the servo ICs, its part of a tick",
                             worst(found, RESET_OUT, "out") + PAD_OUT + SKEW, RESET_PART)),
             (RESET_IN, Row("host-bus:2.6", "reset from the board's chip to a flip-flop, the rest of that tick",
                            (worst(found, RESET_IN, "in") or math.inf) + PAD_IN, TICK - RESET_PART)),
             (CLOCKS, Row("servo-ic:5.1/8", "clock to the enable of PHASE, SERVO, which are high then",
                          worst(found, CLOCKS, "enable") + PAD_OUT + SKEW, 3 * TICK)),
             (ISA_IN, Row("host-bus:3.4, t8", "command to IOCHRDY low, 5 ticks between", 5 * TICK + isa_in +
                          out["isa_iochrdy_io"], 70.0)),
             (ISA_IN, Row("host-bus:3.4, t4", "IOR# to data, 8 ticks between, 11 to those of an 8259", 11 * TICK +
                          isa_in + out["isa_sd_io"], 120.0)),
             (ISA_IN, Row("host-bus:3.4, row 14", "MEMR# to data, 11 ticks between", 11 * TICK + isa_in +
                          out["isa_sd_io"], 173.0)),
             (ISA_IN, Row("host-bus:3.4, row 16", "LA to MEMCS16#, 3 ticks between", 3 * TICK + isa_in +
                          out[MEMCS16], 66.0))]
    there = (row for pads, row in table if any(re.fullmatch(pads, name) for name in found))  # a chip has some alone
    return sorted(there, key=spare)


def wait_states(found, i52):
    """The least for gate ICs at a CPU clock, by row 105, (WS + 0.25) TC - 5 ns; None: 31 are too few."""
    need = 9 * TICK + 1.0 + worst(found, PORT_A_IN, "in") + PAD_IN + SKEW + \
        worst(found, D, "out", "enable") + PAD_OUT + SKEW
    clock = 1000 / (CPU * (i52 + 1))
    least = max(1, math.ceil((need + 5.0) / clock - 0.25))
    return least if least <= 31 else None


def of_all(placed):
    """Of each pad the longest way in any of several placements."""
    found = collections.defaultdict(dict)
    for name, kind, delay in ((name, *way) for one, _ in placed for name, ways in one.items() for way in ways.items()):
        keep(found[name], kind, delay)
    return dict(found)


def page(placed):
    """The tables of [(ways, reset)] of several placements, each line that of the worst."""
    judged = collections.defaultdict(list)
    for row in (row for one, _ in placed for row in rows(one)):
        judged[row.rule, row.what].append(row)
    yield from ("| rule | what | ns here | ns allowed | to spare |", "|---|---|---|---|---|")
    for row in sorted((max(same, key=lambda row: row.has) for same in judged.values()), key=spare):
        missed = "" if spare(row) >= 0 else " **missed**"
        yield f"| {row.rule} | {row.what} | {row.has:.1f} | {row.limit:.1f} | {spare(row):.1f}{missed} |"
    found, resets = of_all(placed), [reset for _, reset in placed]
    reset = None if None in resets else max(resets)
    least = ((i52, wait_states(found, i52)) for i52 in (0, 7, 9, 15, 23, 31))
    told = ", ".join(f"{'none' if states is None else states} at {i52}" for i52, states in least)
    yield from ("", f"Least wait states of gate ICs on this chip, by I52: {told}.", "",
                "| pads | pad to flip-flop ns | flip-flop to pad ns | pad to pad ns |", "|---|---|---|---|")
    shown = ((name, ways) for name, ways in found.items() if re.match(SHOWN, name))
    columns = (("in",), ("out", "ram", "enable"), ("through",))
    for name, ways in sorted(shown, key=lambda item: -max(item[1].values(), default=0.0)):
        longest_ways = (max((ways[kind] for kind in kinds if kind in ways), default=None) for kinds in columns)
        cells = ("" if way is None else f"{way:.2f}" for way in longest_ways)
        yield f"| `{name}` | {' | '.join(cells)} |"
    if reset is None:
        yield from ("", "The reset is released by no flip-flop that is known **missed**.")
    else:
        missed = "" if reset <= TICK else " **missed**"
        yield from ("", f"The reset reaches the last flip-flop {reset:.2f} ns after its clock, of {TICK:.2f}{missed}.")


def of_files(paths):
    placed = []
    for path in paths:
        with open(path) as sdf:
            placed.append(delays(read(sdf)))
    return page(placed)


if __name__ == "__main__":
    print("\n".join(of_files(sys.argv[1:])))
