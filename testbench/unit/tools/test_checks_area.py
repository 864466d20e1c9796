"""Negative controls of tools/area.py: its sums, and what of the dual-ported RAM is no block RAM."""

import re
import shutil
import sys
import unittest

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import area

MEMORY = "rtl/host/dpram_memory.sv"


class Area(unittest.TestCase):
    """The reading of Yosys' statistics; the page itself is made by ./dev area, which takes minutes."""

    @staticmethod
    def stat(**modules):
        text = "8. Printing statistics.\n"
        for name, (bits, cells) in modules.items():
            text += f"\n=== {name.replace('__', chr(92))} ===\n\n   Number of wires:                 80\n"
            text += f"   Number of memory bits:       {bits}\n   Number of cells:                 61\n"
            text += "".join(f"     {cell:<30} {number}\n" for cell, number in cells.items())
        return text + "\n=== design hierarchy ===\n\n   top            1\n     part         2\n\n9. Next pass.\n"

    def test_a_chip_holds_each_instance_of_its_parts(self):
        before = self.stat(top=(0, {}), part=(4096, {}))
        log = before + self.stat(top=(0, {"$_AND_": 5, "part": 2}),
                                 part=(0, {"$_MUX_": 2, "$_DFFE_PN0P_": 7, "memory_kept": 1}))
        self.assertEqual(area.gates(log), {"top": area.Figures(9, 14, 8192), "part": area.Figures(2, 7, 4096)})

    def test_a_module_with_parameters_is_found_by_its_name(self):
        self.assertEqual(area.plain("$paramod\\dpram\\Words=s32'0"), "dpram")
        self.assertEqual(area.plain("$paramod$ab12\\board_top"), "board_top")

    def test_an_unmapped_cell_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "add"):
            area.gates(self.stat(top=(0, {})) + self.stat(top=(0, {"$_AND_": 5, "$add": 1})))

    def test_a_carry_cell_counts_as_two_luts(self):
        log = self.stat(top=(0, {})) + self.stat(top=(0, {"LUT4": 10, "CCU2C": 3, "PFUMX": 9, "TRELLIS_FF": 4}))
        self.assertEqual(area.ecp5(log)["top"], area.Figures(16, 4, 0))

    def test_a_memory_fills_block_ram(self):
        before = self.stat(top=(0, {"ram": 2}), ram=(524288, {"$memrd": 2}))
        good = before + self.stat(top=(0, {"ram": 2}), ram=(0, {"DP16KD": 32}))
        self.assertEqual(list(area.memory_problems(good)), [])
        for cells in ({"$mem_v2": 1}, {"DP16KD": 64}, {"$_DFFE_PN0P_": 524288}, {"TRELLIS_DPR16X4": 8192}):
            problems = list(area.memory_problems(before + self.stat(top=(0, {"ram": 2}), ram=(0, cells))))
            self.assertEqual(len(problems), 1, cells)
            self.assertIn("ram: a memory of 524288 bits takes", problems[0])

    def test_the_page_has_every_row(self):
        page = (TOOLS.parent / "docs/area.md").read_text()
        for name, text in area.ROWS.items():
            self.assertRegex(page, rf"\| `{name}` \| {re.escape(text)} \| \d+ \| \d+ \| \d* \| \d+ \| \d+ \| \d* \|")


@unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
class BlockRam(Tree):
    """The memory of the dual-ported RAM, written in ways that no block RAM can follow."""

    def memory(self, old=None, new=None):
        """area.py --memory of the real one with `old` in its text replaced by `new`."""
        texts = {name: (TOOLS.parent / name).read_text()
                 for name in ("rtl/common/sync2.sv", "rtl/host/dpram.sv", MEMORY)}
        if old is not None:
            self.assertEqual(len(re.findall(old, texts[MEMORY])), 1)
            texts[MEMORY] = re.sub(old, new, texts[MEMORY])
        for name, text in texts.items():
            self.write(name, text)
        return self.run_tool("area.py", "--memory")

    def test_as_it_stands(self):
        self.expect(self.memory(), 0, "block RAM")

    def test_all_written_with_one_clock_and_read_without(self):
        self.expect(self.memory("(?s)always_ff.*end\n", """always_ff @(posedge a_clk_i) begin
            if (a_we_i) mem[a_addr_i] <= a_wdata_i;
            if (b_we_i[0]) mem[b_addr_i][7:0] <= b_wdata_i[7:0];
            if (b_we_i[1]) mem[b_addr_i][15:8] <= b_wdata_i[15:8];
          end
          assign a_rdata_o = mem[a_addr_i];
          assign b_rdata_o = mem[b_addr_i];
          """), 1, "dpram_memory: a memory of 524288 bits takes 0 DP16KD; expected 32 and nothing else")

    def test_read_without_a_register(self):
        self.expect(self.memory(r"else if \(a_re_i\) a_rdata_o <= (mem\[a_addr_i\]);\n  end",
                                r"end\n  assign a_rdata_o = \1;"), 1, "dpram_memory: its memory fits no block RAM")

    def test_written_by_the_other_side_too(self):
        self.expect(self.memory(r"if \(a_we_i\) ", "if (b_we_i[0]) mem[b_addr_i] <= b_wdata_i;\n    if (a_we_i) "), 1,
                    "dpram_memory: its memory fits no block RAM")


if __name__ == "__main__":
    run()
