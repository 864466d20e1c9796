"""Many mutants in one text, of which the number chooses one when the program runs; or one of them alone."""

import pathlib

CHOSEN = pathlib.Path(__file__).parent / "chosen.h"


class Verilog:
    """The number is a variable of a package, read from the environment when the model is made. Only Verilator reads
    this text: $c32 is its way into C++."""

    head = ('`ifndef MUTANT_PKG\n`define MUTANT_PKG\npackage mutant_pkg;\n'  # once, of files that are read together
            '  int unsigned number = $c32("(std::getenv(\\"BRICK_MUTANT\\") ? '
            'std::atoi(std::getenv(\\"BRICK_MUTANT\\")) : 0)");\nendpackage\n`endif\n')
    number = "mutant_pkg::number"

    def expression(self, mutants, inner):
        chosen = "".join(f"{self.number} == {m.number} ? ({m.place.new}) : " for m in mutants)
        return f"({chosen}({inner}))"

    def statement(self, mutants, inner):
        chosen = "".join(f"if ({self.number} == {m.number}) begin {m.place.new} end else " for m in mutants)
        return f"begin {chosen}{inner} end"


class C:
    """C or C++. The number is a variable of reached.cpp, which also keeps what was reached."""

    def __init__(self, file):
        self.head = f'#include "{CHOSEN}"\n#line 1 "{file}"\n'

    def expression(self, mutants, inner):
        chosen = "".join(f"brick_mutant({m.number}) ? ({m.place.new}) : " for m in mutants)
        if any(m.place.operator == "condition" for m in mutants):  # both sides of `?` have one type
            inner = f"({inner}) ? 1 : 0"
        return f"({chosen}({inner}))"

    def statement(self, mutants, inner):
        chosen = "".join(f"if (brick_mutant({m.number})) {{ {m.place.new} }} else " for m in mutants)
        return f"{{ {chosen}{inner} }}"


def write(source, mutants, language):
    """The text with all of `mutants` in it. What a mutant puts in its place is the original text below it: one number
    is chosen at a time."""
    spans = {}
    for mutant in mutants:
        spans.setdefault((mutant.place.start, mutant.place.end), []).append(mutant)
    order = sorted(spans, key=lambda span: (span[0], -span[1]))

    def render(start, end, inside):
        text, at, i = b"", start, 0
        while i < len(inside):
            a, b = inside[i]
            nested = []
            while i + 1 + len(nested) < len(inside) and inside[i + 1 + len(nested)][0] < b:
                nested.append(inside[i + 1 + len(nested)])
            inner = render(a, b, nested).decode()
            here = spans[(a, b)]
            form = language.statement if here[0].place.statement else language.expression
            text += source[at:a] + form(here, inner).encode()
            at, i = b, i + 1 + len(nested)
        return text + source[at:end]

    return language.head.encode() + render(0, len(source), order)


def single(source, mutant):
    """The file as this mutant has it."""
    place = mutant.place
    new = place.new if place.statement else f"({place.new})"
    return source[:place.start] + new.encode() + source[place.end:]
