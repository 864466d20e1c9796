"""Places in SystemVerilog where a mutant may stand, found with the parser of slang.

Only what the running model computes: widths, parameters, generate blocks, sensitivity lists and `for` steps are fixed
before it runs and would take a build of their own each. Names that begin with a capital are constants (house style).
"""

import re

from mutant import Place
from pyslang import syntax

OTHER = {  # kind: [(operator of the mutant, its text)]
    "BinaryAndExpression": [("operator", "|")], "BinaryOrExpression": [("operator", "&")],
    "BinaryXorExpression": [("operator", "|")], "BinaryXnorExpression": [("operator", "^")],
    "LogicalAndExpression": [("operator", "||")], "LogicalOrExpression": [("operator", "&&")],
    "AddExpression": [("operator", "-")], "SubtractExpression": [("operator", "+")],
    "MultiplyExpression": [("operator", "+")],
    "LogicalShiftLeftExpression": [("operator", ">>")], "LogicalShiftRightExpression": [("operator", "<<")],
    "ArithmeticShiftRightExpression": [("operator", ">>")], "ArithmeticShiftLeftExpression": [("operator", ">>>")],
    "EqualityExpression": [("comparison", "!=")], "InequalityExpression": [("comparison", "==")],
    "LessThanExpression": [("comparison", "<="), ("comparison", ">=")],
    "LessThanEqualExpression": [("comparison", "<"), ("comparison", ">")],
    "GreaterThanExpression": [("comparison", ">="), ("comparison", "<=")],
    "GreaterThanEqualExpression": [("comparison", ">"), ("comparison", "<")],
}
UNARY = {  # kind: what stands before the operand instead
    "UnaryBitwiseNotExpression": "", "UnaryLogicalNotExpression": "", "UnaryMinusExpression": "",
    "UnaryBitwiseOrExpression": "&", "UnaryBitwiseAndExpression": "|", "UnaryBitwiseXorExpression": "|",
    "UnaryBitwiseNandExpression": "~|", "UnaryBitwiseNorExpression": "~&",
}
FIXED = {  # decided before the model runs
    "VariableDimension", "SimpleRangeSelect", "ParameterDeclarationStatement", "ParameterPortList",
    "ParameterValueAssignment", "PackageDeclaration", "LoopGenerate", "IfGenerate", "CaseGenerate", "IntegerType",
    "EventControlWithExpression", "PostdecrementExpression", "PostincrementExpression", "DataDeclaration",
    "AnsiPortList", "NamedType", "TypeReference", "InstanceName", "LogicType",
}
PRIMARY = {
    "IdentifierName", "IdentifierSelectName", "ScopedName", "ParenthesizedExpression", "ConcatenationExpression",
    "MultipleConcatenationExpression", "InvocationExpression", "IntegerLiteralExpression", "IntegerVectorExpression",
    "UnbasedUnsizedLiteralExpression", "CastExpression", "ElementSelectExpression",
}
ASSIGNMENTS = {"AssignmentExpression", "NonblockingAssignmentExpression"}


def nodes(node):
    return [child for child in node if isinstance(child, syntax.SyntaxNode)]


def flat(node):
    """Its children, those of a list each by itself."""
    return [c for part in nodes(node) for c in (nodes(part) if part.kind.name.endswith("List") else [part])]


class Finder:
    """Walks one file. `places` is what it found."""

    def __init__(self, source):
        self.source, self.places, self.beside = source, [], {}  # beside: of each enumerator of the file, the next
        tree = syntax.SyntaxTree.fromText(source.decode())
        errors = [str(d.code) for d in tree.diagnostics if d.isError()]
        if errors:
            raise ValueError(f"slang does not read it: {', '.join(errors)}")
        self.enumerators(tree.root)
        self.walk(tree.root)

    def enumerators(self, node):
        if node.kind.name == "EnumType":
            names = [self.text(d).split("=")[0].strip() for d in flat(node) if d.kind.name == "Declarator"]
            self.beside.update(zip(names, names[1:] + names[:1], strict=True))
        for child in nodes(node):
            self.enumerators(child)

    def span(self, node):
        return node.sourceRange.start.offset, node.sourceRange.end.offset

    def text(self, node):
        start, end = self.span(node)
        return self.source[start:end].decode()

    def add(self, node, operator, new, statement=False):
        start, end = self.span(node)
        self.places.append(Place(start, end, operator, self.text(node), new, statement))

    def walk(self, node, block=None):
        """`block`: of the process that the node stands in."""
        kind = node.kind.name
        if kind in ("LoopGenerate", "IfGenerate", "CaseGenerate"):  # their bodies only
            for child in nodes(node):
                if child.kind.name in ("GenerateBlock", "ElseClause") or "Generate" in child.kind.name:
                    self.walk(child)
            return
        if kind in FIXED:
            return
        if kind in ("AlwaysFFBlock", "AlwaysCombBlock", "FunctionDeclaration"):
            block = Block(node, kind, self)
        step = getattr(self, kind, None)
        if step:
            step(node, block)
            return
        self.expression(node, kind)
        for child in nodes(node):
            self.walk(child, block)

    def expression(self, node, kind):
        if kind in OTHER:
            left, right = nodes(node)[0], nodes(node)[-1]
            for operator, sign in OTHER[kind]:
                self.add(node, operator, f"{self.operand(left)} {sign} {self.operand(right)}")
        elif kind in UNARY:
            self.add(node, "operator", UNARY[kind] + self.text(nodes(node)[-1]))
        elif kind in ("IntegerLiteralExpression", "IntegerVectorExpression", "UnbasedUnsizedLiteralExpression"):
            new = next_literal(self.text(node))
            if new:
                self.add(node, "constant", new)

    def operand(self, node):
        """Its text, in parentheses where another operator beside it would take it apart."""
        whole = node.kind.name in PRIMARY or node.kind.name in UNARY
        return self.text(node) if whole else f"({self.text(node)})"

    # Constants by name.
    def ScopedName(self, node, block):
        if "::" in self.text(node):
            self.name(node, self.text(node).split("::")[-1])

    def IdentifierName(self, node, block):
        self.name(node, self.text(node))

    def name(self, node, name):
        if re.fullmatch(r"[A-Z]\w*", name):
            self.add(node, "constant", self.beside.get(name, f"{self.text(node)} ^ 1'b1"))

    # An index stays within its vector, mostly.
    def BitSelect(self, node, block):
        index = nodes(node)[0]
        if index.kind.name == "IntegerLiteralExpression":
            self.add(index, "constant", str(int(self.text(index)) ^ 1))
        else:
            self.walk(index, block)

    # Of these the width is fixed.
    def AscendingRangeSelect(self, node, block):
        self.walk(nodes(node)[0], block)

    DescendingRangeSelect = AscendingRangeSelect

    def MultipleConcatenationExpression(self, node, block):
        self.walk(nodes(node)[1], block)

    def CastExpression(self, node, block):
        self.walk(nodes(node)[-1], block)

    # Conditions.
    def ConditionalPredicate(self, node, block):
        start, _ = self.span(node)
        if block and block.reset_condition == start:
            self.add(node, "reset", "1'b0")
            return
        operator = "enable" if block and block.enables(node) else "condition"
        for value in ("1'b1", "1'b0"):
            self.add(node, operator, value)
        for child in nodes(node):
            self.walk(child, block)

    def StandardCaseItem(self, node, block):
        *labels, body = flat(node)
        for label in labels:
            self.add(label, "case item", f"~({self.text(block.selector(node))})")
        self.walk(body, block)

    # Statements.
    def ExpressionStatement(self, node, block):
        inner = nodes(node)[-1]
        if block and inner.kind.name in ASSIGNMENTS and block.may_leave_out(node):
            self.add(node, "reset" if block.in_reset(node) else "statement", ";", statement=True)
        target, value = nodes(inner)[0], nodes(inner)[-1]
        if inner.kind.name in ASSIGNMENTS:
            for select in nodes(target):  # an index of what is assigned
                self.walk(select, block)
            self.walk(value, block)

    def ContinuousAssign(self, node, block):
        for assignment in nodes(node):
            for part in ([assignment] if assignment.kind.name in ASSIGNMENTS else nodes(assignment)):
                if not self.text(part).startswith("unused"):  # says to the linters what nobody reads
                    self.walk(nodes(part)[-1], block)

    def ForLoopStatement(self, node, block):
        for child in nodes(node):
            if child.kind.name != "ForVariableDeclaration":
                self.walk(child, block)

    def NamedPortConnection(self, node, block):
        for child in nodes(node):
            if not re.fullmatch(r"[\w\[\]:{}, ]*", self.text(child)):  # what may be an output stays a net
                self.walk(child, block)

    def FunctionDeclaration(self, node, block):
        for child in nodes(node):
            if child.kind.name != "FunctionPrototype":
                self.walk(child, block)


class Block:
    """A process or function: which of its statements may be left out without a latch, and where its reset is."""

    def __init__(self, node, kind, finder):
        self.finder, self.clocked = finder, kind == "AlwaysFFBlock"
        self.assigned, self.selectors, self.alone = {}, {}, set()
        self.reset_condition, self.reset_span, self.enable_from = None, (0, 0), None
        self.scan(node)

    def scan(self, node):
        kind, span = node.kind.name, self.finder.span
        if kind == "CaseStatement":
            selector, *items = flat(node)
            self.selectors.update({span(item): selector for item in items})
        if kind == "ConditionalStatement":
            children = nodes(node)
            first = self.clocked and self.reset_condition is None
            if first and re.search(r"\brst\w*\b", self.finder.text(children[0])):  # of a process with a reset
                self.reset_condition, self.reset_span = span(children[0])[0], span(children[1])
            if children[-1].kind.name != "ElseClause":  # left out, its only statement is the condition 0
                body = children[1]
                while body.kind.name == "SequentialBlockStatement" and len(flat(body)) == 1:
                    body = flat(body)[0]
                self.alone.add(span(body))
        if kind in ASSIGNMENTS:
            name = re.match(r"[\w.]+", self.finder.text(node))
            self.assigned.setdefault(name.group(0) if name else "", []).append(span(node)[0])
        for child in nodes(node):
            self.scan(child)

    def selector(self, item):
        return self.selectors[self.finder.span(item)]

    def in_reset(self, node):
        return self.reset_span[0] <= self.finder.span(node)[0] < self.reset_span[1]

    def enables(self, node):
        return self.clocked

    def may_leave_out(self, node):
        start = self.finder.span(node)[0]
        if self.finder.span(node) in self.alone:
            return False
        name = re.match(r"[\w.]+", self.finder.text(node))
        before = self.assigned.get(name.group(0), []) if name else []
        return self.clocked or any(place < start for place in before)


def next_literal(text):
    """The value above, at the same width; None where it is not understood."""
    if text in ("'0", "'1"):
        return "'1" if text == "'0" else "'0"
    if re.fullmatch(r"[0-9_]+", text):
        return str(int(text.replace("_", "")) + 1)
    form = re.fullmatch(r"(\d+)'s?([bodhBODH])([0-9a-fA-F_]+)", text)
    if not form:
        return None
    width, base, digits = int(form.group(1)), form.group(2).lower(), form.group(3).replace("_", "")
    value = (int(digits, {"b": 2, "o": 8, "d": 10, "h": 16}[base]) + 1) % (1 << width)
    return text[:form.start(3)] + format(value, {"b": "b", "o": "o", "d": "d", "h": "X"}[base])


def places(source):
    """Of the bytes of a file."""
    return Finder(source).places
