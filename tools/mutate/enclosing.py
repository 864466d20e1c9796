"""What of a source holds a stretch of it and can be chosen when the program runs: the statement, or where there is
none, the expression."""

import itertools
import re

import c_source
import cpp_source
from mutant import Place
from pyslang import syntax
from verilog import ASSIGNMENTS, nodes

FIXED = {"ParameterDeclarationStatement", "ParameterPortList", "EventControlWithExpression", "VariableDimension",
         "TypedefDeclaration", "PackageDeclaration", "TimingControlStatement"}
BODIES = {"COMPOUND_STMT", "CASE_STMT", "DEFAULT_STMT", "IF_STMT", "FOR_STMT", "WHILE_STMT", "DO_STMT",
          "CXX_FOR_RANGE_STMT"}  # that statements stand in
PARTS = {"DECL_STMT", "NULL_STMT", "CASE_STMT", "DEFAULT_STMT"}  # of something, not chosen by themselves

def place(source, spans, start, old, new):
    """Of the `old` text at `start`, where the `new` stands instead. `spans`: [(start, end, is a statement)] of all that
    can be chosen. What both texts begin and end with may reach beyond it."""
    head = in_common(old, new)
    tail = in_common(old[head:][::-1], new[head:][::-1])
    start, end, new = start + head, start + len(old) - tail, new[head:len(new) - tail]
    first, last = start, end  # of what is more than spaces: those beside a statement belong to none
    if not new.strip():
        gone = source[start:end]
        first, last = start + len(gone) - len(gone.lstrip()), end - len(gone) + len(gone.rstrip())
    around = [span for span in spans if span[0] <= first and last <= span[1]]
    statements = [span for span in around if span[2]]
    if not around:
        raise ValueError("it stands in no statement or expression that runs")
    a, b, is_statement = min(statements or around, key=lambda span: span[1] - span[0])
    whole = source[a:max(a, start)] + new + source[min(b, end):b]
    return Place(a, b, "planted", source[a:b].decode(), whole.decode(), is_statement)


def in_common(a, b):
    """How many bytes they begin with."""
    return sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], zip(a, b, strict=False)))


def of_verilog(source):
    """Spans of a file of SystemVerilog."""
    found = []

    def walk(node):
        kind, span = node.kind.name, node.sourceRange
        a, b = span.start.offset, span.end.offset
        if kind.endswith("Statement") and kind not in FIXED:
            found.append((a, b, True))
        elif kind == "ContinuousAssign":
            for assignment in nodes(node):
                for part in ([assignment] if assignment.kind.name in ASSIGNMENTS else nodes(assignment)):
                    value = nodes(part)[-1].sourceRange
                    found.append((value.start.offset, value.end.offset, False))
        elif kind in ("EqualsValueClause", "NamedPortConnection"):
            for child in nodes(node):
                if kind == "EqualsValueClause" or child.kind.name.endswith("Expr"):
                    found.append((child.sourceRange.start.offset, child.sourceRange.end.offset, False))
        if kind not in FIXED or kind == "TimingControlStatement":
            for child in nodes(node):
                walk(child)

    walk(syntax.SyntaxTree.fromText(source.decode()).root)
    return found


def of_c(file, options):
    """(source, spans) of a file of C or C++, with the options of its compiler."""
    # the name of a header does not say it
    is_c = file.suffix == ".c" or any(re.match(r"-std=(c|gnu)\d", option) for option in options)
    finder = c_source.Finder(file, [*options, "-xc"]) if is_c else cpp_source.Finder(file, options)
    found = []

    def walk(node, in_body):
        a, b = finder.span(node)
        kind = node.kind
        semicolon = re.compile(rb"\s*;").match(finder.source, b)
        if kind.is_statement() and kind.name not in PARTS:
            found.append((a, semicolon.end() if semicolon and kind.name != "COMPOUND_STMT" else b, True))
        elif kind.is_expression() and b > a:
            found.append((a, semicolon.end(), True) if in_body and semicolon else (a, b, False))
        for i, child in enumerate(node.get_children()):  # of what has a head, only its bodies are statements
            body_of_function = kind in cpp_source.FUNCTIONS and child.kind.name == "COMPOUND_STMT"
            if body_of_function:
                for statement in child.get_children():
                    walk(statement, True)
            else:
                walk(child, kind.name in BODIES and (kind.name == "COMPOUND_STMT" or i > 0))

    for node in finder.unit.cursor.get_children():
        if node.location.file and node.location.file.name == str(file):
            walk(node, False)
    return finder.source, found
