"""The rules of testbench/formal that a mutant breaks: refuted within the steps of the module's proof."""

import prove


def refuted(root, name, file, source, mutated, folder, limit):
    """The first rule of `name` that has a counterexample with `mutated` in the place of `source`, the text of `file`;
    None: there is none, or the solvers gave no answer."""
    folder.mkdir(parents=True, exist_ok=True)
    solvers = prove.Solvers(folder, limit)
    try:
        rules = prove.Rules(root, name)
        rules.edits.insert(0, prove.Edit("edit", "mutant", file, source, mutated))
        stem = prove.build(rules, solvers)
    except prove.Failed:
        return None
    return next((rule for rule in rules.english if found(solvers, stem, rule, rules.steps)), None)


def found(solvers, stem, rule, steps):
    """No answer of one rule says nothing of the others."""
    try:
        return solvers.search(stem, rule, steps) is not None
    except prove.Failed:
        return False
