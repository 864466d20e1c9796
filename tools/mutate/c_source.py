"""Places in the functions of a C file where a mutant may stand, found with the parser of Clang.

Only what runs: initial values of static variables, labels, sizes and enumerators are fixed before. What comes out of a
macro with arguments is left alone; a macro or an enumerator by its name is a constant. The step of a `for` stays.
"""

import re
import subprocess

from clang.cindex import CursorKind, Index, StorageClass, TranslationUnit, TypeKind
from mutant import Place

OTHER = {  # operator: [(operator of the mutant, its text)]
    "&": [("operator", "|")], "|": [("operator", "&")], "^": [("operator", "|")],
    "&&": [("operator", "||")], "||": [("operator", "&&")],
    "+": [("operator", "-")], "-": [("operator", "+")], "*": [("operator", "/")], "/": [("operator", "*")],
    "%": [("operator", "/")], "<<": [("operator", ">>")], ">>": [("operator", "<<")],
    "==": [("comparison", "!=")], "!=": [("comparison", "==")],
    "<": [("comparison", "<="), ("comparison", ">=")], "<=": [("comparison", "<"), ("comparison", ">")],
    ">": [("comparison", ">="), ("comparison", "<=")], ">=": [("comparison", ">"), ("comparison", "<")],
    "+=": [("operator", "-=")], "-=": [("operator", "+=")], "*=": [("operator", "/=")], "/=": [("operator", "*=")],
    "|=": [("operator", "&=")], "&=": [("operator", "|=")], "^=": [("operator", "|=")],
    "<<=": [("operator", ">>=")], ">>=": [("operator", "<<=")],
}
WHOLE = {CursorKind.DECL_REF_EXPR, CursorKind.INTEGER_LITERAL, CursorKind.FLOATING_LITERAL, CursorKind.CALL_EXPR,
         CursorKind.MEMBER_REF_EXPR, CursorKind.ARRAY_SUBSCRIPT_EXPR, CursorKind.PAREN_EXPR}
STATEMENTS = {CursorKind.CALL_EXPR, CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR,
              CursorKind.UNARY_OPERATOR, CursorKind.BREAK_STMT, CursorKind.CONTINUE_STMT}


class Finder:
    """Walks the functions of one file. `places` is what it found."""

    language = ()  # options that say it

    def __init__(self, file, options):
        self.source, self.places = file.read_bytes(), []
        self.unit = Index.create().parse(str(file), args=[*options, *self.language, "-isystem", own_headers()],
                                         options=TranslationUnit.PARSE_PRECOMPILED_PREAMBLE)
        if found := self.errors():
            raise ValueError(f"Clang does not read it: {found[0]}")
        for node in self.unit.cursor.get_children():
            if node.location.file and node.location.file.name == str(file):
                self.declaration(node)

    def errors(self):
        return [d for d in self.unit.diagnostics if d.severity >= d.Error]

    def declaration(self, node):
        if node.kind == CursorKind.FUNCTION_DECL and node.is_definition():
            self.statement(list(node.get_children())[-1])

    def span(self, node):
        return node.extent.start.offset, node.extent.end.offset

    def text(self, node):
        start, end = self.span(node)
        return self.source[start:end].decode()

    def add(self, node, operator, new):
        self.places.append(Place(*self.span(node), operator, self.text(node), new))

    def statement(self, node):
        step = getattr(self, node.kind.name, None)
        if step:
            step(node)
        elif node.kind in STATEMENTS:
            self.left_out(node)
        else:
            self.expression(node)

    def left_out(self, node):
        start, end = self.span(node)
        semicolon = re.compile(rb"\s*;").match(self.source, end)
        if semicolon and not self.gives_first_value(node):
            old = self.source[start:semicolon.end()].decode()
            self.places.append(Place(start, semicolon.end(), "statement", old, ";", statement=True))
        self.expression(node)

    def gives_first_value(self, node):
        """Maybe: to a local variable that begins with none. Without it the mutant would do anything."""
        if self.sign(node) != "=":
            return False
        variable = next(node.get_children()).referenced
        return variable is not None and variable.kind == CursorKind.VAR_DECL and self.initial(variable) is None

    def initial(self, variable):
        *_, last = [None, *variable.get_children()]
        at = variable.location.offset
        return last if last is not None and b"=" in self.source[at:self.span(last)[0]] else None

    # Statements.
    def COMPOUND_STMT(self, node):
        for child in node.get_children():
            self.statement(child)

    def DECL_STMT(self, node):
        for variable in node.get_children():
            if variable.kind == CursorKind.VAR_DECL and variable.storage_class != StorageClass.STATIC:
                value = self.initial(variable)
                if value is not None:
                    self.expression(value)

    def IF_STMT(self, node):
        condition, *bodies = node.get_children()
        self.condition(condition, ("1", "0"))
        for body in bodies:
            self.statement(body)

    def WHILE_STMT(self, node):
        condition, body = node.get_children()
        self.condition(condition, ("0",))  # 1 never ends
        self.statement(body)

    def DO_STMT(self, node):
        body, condition = node.get_children()
        self.condition(condition, ("0",))
        self.statement(body)

    def FOR_STMT(self, node):
        *head, body = node.get_children()
        first, second = self.semicolons(node)
        for part in head:
            if self.span(part)[0] < first:
                self.statement(part)
            elif self.span(part)[0] < second:
                self.condition(part, ("0",))
        self.statement(body)

    def semicolons(self, node):
        start, end = self.span(node)
        return [start + m.start() for m in re.finditer(rb";", self.source[start:end])][:2]

    def SWITCH_STMT(self, node):
        selector, body = node.get_children()
        for label in self.labels(body):
            text = self.text(selector)
            if "(" not in text:
                self.add(selector, "case", f"{text} == {self.text(label)} ? ~{text} : {text}")
        self.expression(selector)
        self.statement(body)

    def labels(self, node):
        for child in node.get_children():
            if child.kind == CursorKind.CASE_STMT:
                yield next(child.get_children())
            if child.kind != CursorKind.SWITCH_STMT:
                yield from self.labels(child)

    def CASE_STMT(self, node):
        *_, body = node.get_children()
        self.statement(body)

    def DEFAULT_STMT(self, node):
        self.CASE_STMT(node)

    def RETURN_STMT(self, node):
        value = list(node.get_children())
        if value:
            self.expression(value[0])
        else:
            self.left_out(node)

    def NULL_STMT(self, node):
        pass

    # Expressions.
    def condition(self, node, values):
        for value in values:
            self.add(node, "condition", value)
        self.expression(node)

    def expression(self, node):
        kind, children = node.kind, list(node.get_children())
        if kind == CursorKind.CXX_UNARY_EXPR:  # sizeof
            return
        if kind == CursorKind.UNEXPOSED_EXPR and re.match(r"[.\[]", self.text(node)):  # of an initializer: [X] = value
            children = children[-1:]
        sign = self.sign(node)
        if sides := self.sides(node):
            left, right = (self.operand(side) for side in sides)
            for operator, new in OTHER.get(sign, []):
                if new not in "+-" or not is_pointer(sides[1]):  # two pointers have only a `-`, `n + p` only a `+`
                    self.add(node, operator, f"{left} {new} {right}")
        elif kind == CursorKind.UNARY_OPERATOR:
            self.unary(node, children[0])
        elif kind == CursorKind.CONDITIONAL_OPERATOR:
            for value in ("1", "0"):
                self.add(children[0], "condition", value)
        elif not children:
            self.constant(node)
        for child in children:
            self.expression(child)

    def sides(self, node):
        is_binary = node.kind in (CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR)
        return tuple(node.get_children()) if is_binary else None

    def sign(self, node):
        """The operator between both sides, '' where a macro hides it."""
        sides = self.sides(node)
        if sides is None:
            return ""
        left, right = sides
        between = self.source[self.span(left)[1]:self.span(right)[0]].decode()
        between = re.sub(r"/\*.*?\*/|//[^\n]*", "", between, flags=re.S).strip()
        return between if between in OTHER or between == "=" else ""

    def unary(self, node, inner):
        text = self.text(node)
        if re.match(r"[!~-](?![-])", text):
            self.add(node, "operator", self.text(inner))
        for step, other in (("++", "--"), ("--", "++")):
            if text.startswith(step):
                self.add(node, "operator", other + self.text(inner))
            elif text.endswith(step):
                self.add(node, "operator", self.text(inner) + other)

    def operand(self, node):
        while node.kind == CursorKind.UNEXPOSED_EXPR and (inner := list(node.get_children())):  # a silent conversion
            node = inner[0]
        return self.text(node) if node.kind in WHOLE else f"({self.text(node)})"

    def constant(self, node):
        text = self.text(node)
        new = next_constant(text)
        if new:
            self.add(node, "constant", new)
        elif re.fullmatch(r"[A-Z][A-Z0-9_]*", text) and text != "NULL" and not (
                node.kind == CursorKind.DECL_REF_EXPR and node.referenced.kind != CursorKind.ENUM_CONSTANT_DECL):
            self.add(node, "constant", f"({text} + 1)")


def is_pointer(node):
    return node.type.get_canonical().kind in (TypeKind.POINTER, TypeKind.CONSTANTARRAY, TypeKind.INCOMPLETEARRAY)


def next_constant(text):
    """The value above; of a real the double, of 0.0 one."""
    if text in ("true", "false"):
        return "false" if text == "true" else "true"
    if form := re.fullmatch(r"(0[xX][0-9a-fA-F]+|\d+)([uUlL]*)", text):
        value = int(form.group(1), 0 if not re.fullmatch(r"0\d+", form.group(1)) else 8) + 1
        return (f"0x{value:X}" if form.group(1).lower().startswith("0x") else str(value)) + form.group(2)
    if form := re.fullmatch(r"[\d.]+(?:[eE][+-]?\d+)?([fF]?)", text):
        return "1.0" if float(text.rstrip("fF")) == 0.0 else f"(2.0 * {text})"
    return f"({text} + 1)" if re.fullmatch(r"'(\\.|[^\\'])'", text) else None


def own_headers():
    """The compiler's: libclang of PyPI comes without."""
    return subprocess.run(["cc", "-print-file-name=include"], capture_output=True, text=True,
                          check=True).stdout.strip()


def places(file, options):
    return Finder(file, options).places
