"""Places for mutants in a C++ file, a header or not: those of C (c_source.py), and what C++ adds.

Functions are looked for in namespaces, classes and templates; lambdas, initial values of members, operators of classes
and constants called kName count too. What `constexpr` says is fixed before it runs.
"""

import re

import c_source
import schemata
from c_source import STATEMENTS, TypeKind
from clang.cindex import CursorKind, StorageClass
from mutant import mutants_of

SCOPES = {CursorKind.NAMESPACE, CursorKind.CLASS_DECL, CursorKind.STRUCT_DECL, CursorKind.CLASS_TEMPLATE,
          CursorKind.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION, CursorKind.LINKAGE_SPEC, CursorKind.UNEXPOSED_DECL}
FUNCTIONS = {CursorKind.FUNCTION_DECL, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR, CursorKind.DESTRUCTOR,
             CursorKind.CONVERSION_FUNCTION, CursorKind.FUNCTION_TEMPLATE}
WORDS = {CursorKind.TYPE_REF, CursorKind.NAMESPACE_REF, CursorKind.TEMPLATE_REF, CursorKind.MEMBER_REF,
         CursorKind.PARM_DECL, CursorKind.OVERLOADED_DECL_REF, CursorKind.VARIABLE_REF}  # nothing that is computed
NARROW = {TypeKind.SHORT, TypeKind.USHORT, TypeKind.UCHAR, TypeKind.SCHAR, TypeKind.CHAR_S}  # with 1 added it is int
INTEGERS = {TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG, *NARROW}
MARK = re.compile(rb"brick_mutant\((\d+)\)")
ROUNDS = 30


class Finder(c_source.Finder):
    language = ("-x", "c++", "-Wno-c++11-narrowing", "-ferror-limit=0")

    def declaration(self, node):
        if node.kind in SCOPES:
            for child in node.get_children():
                self.declaration(child)
        elif node.kind in FUNCTIONS and node.is_definition():
            self.function(node)
        elif node.kind == CursorKind.FIELD_DECL and (value := self.initial(node)) is not None:
            self.expression(value)

    def initial(self, variable):
        *_, last = [None, *variable.get_children()]
        if last is None or last.kind in WORDS or not last.kind.is_expression():
            return None
        start, end = variable.location.offset + len(variable.spelling), self.span(last)
        between = self.source[start:end[0]]
        return last if b"=" in between or self.source[end[0]:end[0] + 1] == b"{" else None

    def function(self, node):
        *head, body = node.get_children()
        if body.kind != CursorKind.COMPOUND_STMT or self.is_fixed(node, body):  # `= default` has none
            return
        for part in head:  # of a constructor
            if part.kind.is_expression():
                self.expression(part)
        self.statement(body)

    def is_fixed(self, node, body):
        return re.search(rb"\bconstexpr\b", self.source[self.span(node)[0]:self.span(body)[0]]) is not None

    # Statements.
    def statement(self, node):
        while node.kind == CursorKind.UNEXPOSED_EXPR and len(inner := list(node.get_children())) == 1 and \
                self.span(inner[0]) == self.span(node):  # temporary objects that go at its end
            node = inner[0]
        if node.kind in STATEMENTS or hasattr(self, node.kind.name):
            super().statement(node)
        elif node.kind.is_statement():
            for child in node.get_children():
                self.statement(child)
        else:
            self.expression(node)

    def DECL_STMT(self, node):
        for variable in node.get_children():
            fixed = variable.storage_class == StorageClass.STATIC or self.text(variable).startswith("constexpr")
            if variable.kind == CursorKind.VAR_DECL and not fixed and (value := self.initial(variable)) is not None:
                self.expression(value)

    def IF_STMT(self, node):
        declared = [c for c in node.get_children() if c.kind in (CursorKind.DECL_STMT, CursorKind.VAR_DECL)]
        if re.match(r"if\s+constexpr", self.text(node)):
            for body in list(node.get_children())[1:]:
                self.statement(body)
        elif declared:
            self.parts(node)
        else:
            super().IF_STMT(node)

    def WHILE_STMT(self, node):
        if len(list(node.get_children())) == 2:
            super().WHILE_STMT(node)
        else:
            self.parts(node)

    def parts(self, node):
        """Of a condition that declares something: it stays."""
        for child in node.get_children():
            if child.kind == CursorKind.VAR_DECL and (value := self.initial(child)) is not None:
                self.expression(value)
            elif child.kind != CursorKind.VAR_DECL:
                self.statement(child)

    def CXX_FOR_RANGE_STMT(self, node):
        *head, body = node.get_children()
        for part in head:
            if part.kind.is_expression():
                self.expression(part)
        self.statement(body)

    def SWITCH_STMT(self, node):
        *head, selector, body = node.get_children()
        if head:
            return self.parts(node)
        text = self.text(selector)
        for label in self.labels(body):
            self.add(selector, "case", f"brick_without({self.text(label)}, {text})")
        self.expression(selector)
        return self.statement(body)

    # Expressions.
    def condition(self, node, values):
        super().condition(node, [{"1": "true", "0": "false"}[value] for value in values])

    def expression(self, node):
        if node.kind == CursorKind.COMPOUND_STMT:  # the body of a lambda
            self.statement(node)
        elif node.kind == CursorKind.LAMBDA_EXPR:
            *_, body = node.get_children()
            self.statement(body)
        elif node.kind == CursorKind.DECL_REF_EXPR:
            self.constant(node)
        elif node.kind not in WORDS:
            super().expression(node)

    def sides(self, node):
        if node.kind == CursorKind.CALL_EXPR:  # an operator of a class
            children = list(node.get_children())
            named = re.fullmatch(r"operator\W+", node.spelling) and len(children) == 3
            return (children[0], children[2]) if named else None
        return super().sides(node)

    def constant(self, node):
        text, kind = self.text(node), node.type.get_canonical().kind
        if re.fullmatch(r"'(\\.|[^\\'])'", text):  # of its own type, which a template may ask for
            self.add(node, "constant", f"char({text} + 1)")
        elif not re.fullmatch(r"(\w+::)*k[A-Z]\w*", text):
            super().constant(node)
        elif kind == TypeKind.BOOL:
            self.add(node, "constant", f"!{text}")
        elif kind in NARROW:
            self.add(node, "constant", f"decltype({text})({text} + 1)")
        elif kind in INTEGERS and not text.endswith("kNever"):  # a tick later is never too
            self.add(node, "constant", f"({text} + 1)")


def mutants(file, name, options, first):
    """Of `file`, numbered from `first` on: those with which Clang reads it. `name`: of the file in the tree."""
    finder = Finder(file, options)
    found = mutants_of(name, finder.source, finder.places, first)
    for _ in range(ROUNDS):
        text = schemata.write(finder.source, found, schemata.C(file))
        finder.unit.reparse([(str(file), text.decode())])
        wrong = {culprit(text, error) for error in finder.errors()}
        if not wrong:
            places = [m.place for m in found]
            return mutants_of(name, finder.source, places, first)
        found = [m for m in found if m.number not in wrong]
    raise ValueError(f"{name}: Clang does not read it with mutants: {finder.errors()[0]}")


def culprit(text, error):
    """The mutant at which Clang stumbles: the one that begins here, else the last in what it underlines (operands, an
    initial value), else the last before."""
    offset = error.location.offset
    begun = re.match(rb"\(*brick_mutant\((\d+)\)", text[offset:])
    if begun:
        return int(begun.group(1))
    underlined = [mark for span in error.ranges for mark in MARK.finditer(text, span.start.offset, span.end.offset)]
    marks = underlined or list(MARK.finditer(text, 0, offset + 1)) or list(MARK.finditer(text))
    return int(marks[-1].group(1))
