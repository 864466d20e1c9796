"""A line of a report: what, measured, goal."""


def row(what, measured, goal="", met=True):
    print(f"{what:<58} {measured:>22}   {goal}{'' if met else '  NOT MET'}")
