"""The filter: proves that a mutant is the module it was made from, without a bound, with Yosys and abc.

Both stand side by side with the same inputs; from the first reset on every output is compared at every step. Assumed
is that clk_ref rises with every third edge of clk_pwm, and nothing else: what is proved holds under any neighbour.
Memories and flip-flops that have no reset in the module as it is start as zero; one that a mutant takes the reset from
starts as anything. Who gets no proof within the limit is left to the other judges:
equal for N steps only says nothing.
"""

import json
import re
import subprocess
import threading

from lint_rtl import SIMULATION_ONLY, rtl_files

ONE = "memory_map; opt -full; async2sync; dffunmap"
SEVERAL = "memory_collect; opt -full; clk2fflogic; memory_map -formal; opt -full"

CLOCKS = """reg [2:0] step = 3'd0;
reg clk_pwm_i = 1'b0, clk_ref_i = 1'b0;
always @($global_clock) begin
  step <= (step == 3'd5) ? 3'd0 : step + 3'd1;
  clk_pwm_i <= ~clk_pwm_i;
  clk_ref_i <= step < 3'd3;
end"""


def without_reset(design):
    """Names of the nets whose bits are all of flip-flops without a reset. `design`: of write_json."""
    bits = {bit for cell in design["cells"].values() if cell["type"] in ("$dff", "$dffe")
            for bit in cell["connections"]["Q"]}
    return {name for name, net in design["netnames"].items() if bits.issuperset(net["bits"])}


def starting_as_zero(text, names):
    """RTLIL with an initial value of these nets."""
    def wire(found):
        width = int(found[1] or 1)
        return f"  attribute \\init {width}'{'0' * width}\n{found[0]}" if found[2] in names else found[0]
    return re.sub(r"^  wire (?:width (\d+) )?(?:\w+ \d+ )?(?:signed )?\\?(\S+)$", wire, text, flags=re.M)


class Filter:
    """Of one module. `out`: a folder for its files."""

    def __init__(self, root, module, file, out, limit):
        self.root, self.module, self.file, self.out, self.limit = root, module, file, out, limit
        out.mkdir(parents=True, exist_ok=True)
        self.ports, self.zero, self.lock = None, set(), threading.Lock()

    def yosys(self, folder, script):
        done = subprocess.run(["yosys", "-q", "-p", script], cwd=folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=self.limit)
        return done.returncode == 0

    def files(self):
        """Packages, the module and what is below it: whatever module's name its text has."""
        packages, modules = rtl_files(self.root)
        modules = {f.stem: f for f in modules if f.stem not in SIMULATION_ONLY}
        below, new = set(), {self.module}
        while new:
            below |= new
            texts = [re.sub(r"//[^\n]*", "", (self.root / modules[name]).read_text()) for name in new]
            new = {word for text in texts for word in re.findall(r"\w+", text) if word in modules} - below
        return packages + [modules[name] for name in sorted(below)]

    def read(self, folder, file, name):
        """The module with `file` in the place of its own, as NAME.il."""
        sources = [str(file if str(f) == self.file else self.root / f) for f in self.files()]
        return self.yosys(folder, f"read_verilog -sv -defer {' '.join(sources)}; hierarchy -check -top {self.module}; "
                          f"proc -norom; setattr -mod -unset keep_hierarchy; flatten; opt_clean; "
                          f"rename {self.module} {name}; write_rtlil {name}.il; write_json {name}.json")

    def prepare(self):
        """Of the module as it is. False where Yosys does not read it so."""
        with self.lock:
            if self.ports is None:
                made = self.read(self.out, self.root / self.file, "gold")
                design = json.loads((self.out / "gold.json").read_text())["modules"]["gold"] if made else {}
                self.ports = design.get("ports", {})
                self.zero = without_reset(design) if made else set()
            return bool(self.ports)

    def bench(self):
        """Both designs, in reset at the first step."""
        inputs = [name for name, port in self.ports.items() if port["direction"] == "input"]
        clocks = [name for name in inputs if name in ("clk_pwm_i", "clk_ref_i")]
        outputs = [name for name in self.ports if name not in inputs]
        made = clocks if len(clocks) == 2 else []
        time = "$global_clock" if len(clocks) != 1 else f"posedge {clocks[0]}"
        width = {name: len(port["bits"]) for name, port in self.ports.items()}
        head = ", ".join(f"input wire [{width[n] - 1}:0] {n}" for n in inputs if n not in made)
        lines = [f"module both ({head});", "reg started = 1'b0;", f"always @({time}) started <= 1'b1;",
                 CLOCKS if made else "", "wire rst = rst_ni & started;" if "rst_ni" in inputs else ""]
        for design in ("gold", "gate"):
            lines += [f"wire [{width[n] - 1}:0] {design}_{n};" for n in outputs]
            pins = [f".{n}({'rst' if n == 'rst_ni' else n})" for n in inputs]
            pins += [f".{n}({design}_{n})" for n in outputs]
            lines.append(f"{design} u_{design} ({', '.join(pins)});")
        same = " && ".join(f"gold_{n} == gate_{n}" for n in outputs)
        lines += [f"always @(*) assert (!started || ({same}));", "endmodule"]
        prepare = ONE if len(clocks) == 1 else SEVERAL
        return "\n".join(lines), prepare

    def equal(self, source, folder):
        """True: proved. `source`: the mutant, a file with nothing but it in its text."""
        folder.mkdir(parents=True, exist_ok=True)
        try:
            if not self.prepare() or not self.read(folder, source, "gate"):
                return False
            text, prepare = self.bench()
            (folder / "both.sv").write_text(text)
            for name, file in (("gold", self.out / "gold.il"), ("gate", folder / "gate.il")):
                (folder / f"{name}_zero.il").write_text(starting_as_zero(file.read_text(), self.zero))
            made = self.yosys(folder, "read_rtlil gold_zero.il; read_rtlil gate_zero.il; "
                              "read_verilog -sv -formal both.sv; "
                              f"hierarchy -check -top both; proc; flatten; setundef -undriven -zero; {prepare}; "
                              "opt_clean; techmap; abc -g AND -fast; opt_clean; write_aiger -zinit both.aig")
            if not made:
                return False
            said = subprocess.run(["yosys-abc", "-c", "read_aiger both.aig; fold; strash; scleanup; scorr; dc2; "
                                   f"scleanup; pdr -T {self.limit:.0f}"], cwd=folder, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  timeout=2 * self.limit).stdout
        except subprocess.TimeoutExpired:
            return False
        return "Property proved." in said
