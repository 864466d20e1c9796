"""./dev mutate KIND [NAME...]: mutants of the sources, and which test kills each. docs/mutation.md has the scores.

  mutate rtl pic_8259              150 mutants of the module, drawn evenly; all where there are fewer
  mutate model ssi                 the same of a folder of the SystemC model
  mutate firmware motion           of the firmware
  mutate host library              of the host side: modules.toml has the names
  mutate rtl --changed --resume    modules whose inputs differ from those of their results
  mutate firmware motion --renew   the mutants of the results once more, each by the test that killed it, else by all;
                                   with --resume only those that live, where the sources are the same
  mutate report [--check]          docs/mutation.md from results/mutation; --check: it is fresh, no reason is of a dead
                                   mutant; --release: and each survivor has one
  mutate again [--count 20]        mutants that the results have as killed; each must die again.
                                   Without a name of one module of RTL or firmware
  mutate planted [N...]            bugs in rules (tools/mutate/planted): the test of each finds it; --count N: of one
                                   program's; --check: that they apply, docs/rules.md counts them and no result has one
                                   as not found; --release: and each has a result; --write: those counts
Exit status: 0 done, 1 number 0 fails, something cannot be built or a check fails, 2 there is no such thing.
"""

import argparse
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

import bugs
import plan
import report
from common import ROOT, skip


def part_of(text):
    k, _, n = text.partition("/")
    if not (k.isdigit() and n.isdigit() and 1 <= int(k) <= int(n)):
        raise argparse.ArgumentTypeError(f"'{text}': a part is K/N, with K from 1 to N")
    return int(k), int(n)


def positive(text):
    if not text.isdigit() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}': a number from 1 on")
    return int(text)


def arguments():
    parser = argparse.ArgumentParser(prog="./dev mutate", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", help="rtl, model, firmware, host, report, again or planted")
    parser.add_argument("names", nargs="*", metavar="NAME",
                        help="modules, folders, numbers of planted bugs; all when none is given")
    parser.add_argument("--seed", type=int, help="of the drawing (1; again, planted: the commit)")
    parser.add_argument("--count", type=positive, help="mutants a module that are not proved equal (150; again: 20)")
    parser.add_argument("--all", action="store_true", help="every mutant of the module")
    parser.add_argument("--changed", action="store_true", help="modules whose results are of other inputs")
    parser.add_argument("--part", type=part_of, metavar="K/N", help="every Nth of the drawn mutants")
    parser.add_argument("--resume", action="store_true", help="keep what stands in the results for the same inputs")
    parser.add_argument("--renew", action="store_true", help="judge the mutants of the results, whatever their inputs")
    parser.add_argument("--control", type=int, metavar="N",
                        help="killed mutants that the filter must not prove equal (50; of C and C++ 5)")
    parser.add_argument("--check", action="store_true", help="report, planted: write nothing")
    parser.add_argument("--write", action="store_true", help="planted: its counts into docs/rules.md")
    parser.add_argument("--release", action="store_true", help="open survivors, planted bugs without a result fail")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="the built tree")
    parser.add_argument("--jobs", type=positive, default=int(os.environ.get("BRICK_JOBS", os.cpu_count() or 2)))
    options = parser.parse_args()
    options.build = options.build.resolve()  # commands run in it
    if options.seed is None and options.kind not in ("again", "planted"):
        options.seed = 1
    if options.all and options.count:
        parser.error("--all and --count: one of them")
    return options


def run(modules, options):
    try:
        import again
        import judges
        from overlay import NoBuild
        from runner import BadBuild
        from session import Session
    except ImportError as missing:  # of a package of tools/requirements.txt
        skip(f"{missing.name} is not installed (./dev setup)")

    def judge(module):
        session = Session(judges.of(module, options.build, "judged"), options)
        if options.changed and session.is_fresh():
            return 0
        session.run()
        print(session.summary(), flush=True)
        return int(len(session.faults) > 0)

    def status_of(what, work, *arguments):
        try:
            return work(*arguments)
        except (BadBuild, NoBuild, ValueError) as bad:
            print(f"mutate: {what}: {bad}", file=sys.stderr, flush=True)
            return 1

    if options.kind == "again":
        return status_of("again", again.main, modules, options)
    return max([status_of(module.name, judge, module) for module in modules], default=0)


def run_planted(options):
    if options.check or options.write:
        return bugs.tidy(ROOT, options.write, options.release)
    try:
        import planted
    except ImportError as missing:
        skip(f"{missing.name} is not installed (./dev setup)")
    return planted.main(options)


def main():
    options = arguments()
    try:
        if options.kind == "report":
            sys.exit(report.main(options.check, options.release))
        if options.kind == "planted":
            sys.exit(run_planted(options))
        modules = plan.choose(options.kind, options.names)
    except (plan.Unknown, bugs.Bad) as unknown:
        print(f"mutate: {unknown}", file=sys.stderr)
        sys.exit(2)
    sys.exit(run(modules, options))


if __name__ == "__main__":
    main()
