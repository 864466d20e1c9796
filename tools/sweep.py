#!/usr/bin/env python3
"""Every bench with seeds that nobody has looked at yet: a bench passes with any seed, so one that fails has found a
fault or has a limit of its own making. Each run is `brick run BENCH --engine ENGINE --seed N`; each failure is printed
with the command that repeats it. Seeds come from a seed themselves, which is printed. usage: sweep.py BRICK
[OPTIONS]"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import subprocess
import sys
import time

USUAL = range(1, 31)  # those of the test suite and of people
LARGEST = 10**9


def arguments():
    p = argparse.ArgumentParser(description=__doc__.split("usage")[0])
    p.add_argument("brick", type=pathlib.Path, help="the built command")
    p.add_argument("--engine", default="systemc", choices=("systemc", "rtl", "lockstep"))
    p.add_argument("--bench", action="append", default=[], metavar="NAME", help="may be repeated; default: every one")
    p.add_argument("--program", action="append", default=[], metavar="FILE", help="a test program in the place of the "
                   "benches, with BRICK_RANDOM_SEED in its environment; may be repeated")
    p.add_argument("--filter", default="*", metavar="TESTS", help="of a test program, as --gtest_filter")
    p.add_argument("--seeds", type=int, default=200, metavar="N", help="fresh seeds (default 200)")
    p.add_argument("--seed", action="append", type=int, default=[], metavar="N", help="this one too; may be repeated")
    p.add_argument("--from", type=int, dest="origin", metavar="N", help="where the fresh seeds come from (default: the "
                   "clock)")
    p.add_argument("--minutes", type=float, metavar="M", help="begins no run after so much wall time")
    p.add_argument("--jobs", type=int, default=2, metavar="N", help="runs at a time (default 2)")
    p.add_argument("--limit", type=float, default=600, metavar="S", help="seconds that a run may take (default 600)")
    args = p.parse_args()
    for name, least in (("seeds", 0), ("jobs", 1)):
        if getattr(args, name) < least:
            p.error(f"--{name} {getattr(args, name)}; expected {least} or more")
    if not args.brick.is_file():
        p.error(f"{args.brick}: no such file; expected the built command, such as build/release/bin/brick")
    return args


def fresh_seeds(origin, count):
    draw, seeds = random.Random(origin), []
    while len(seeds) < count:
        seed = draw.randrange(LARGEST)
        if seed not in USUAL and seed not in seeds:
            seeds.append(seed)
    return seeds


def every_bench(brick):
    out = subprocess.run([brick, "list"], capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in out.splitlines() if re.match(r"[a-z0-9-]+ ", line)]


def run(command, limit, seed):
    """What failed, '' if nothing did."""
    environment = {**os.environ, "BRICK_RANDOM_SEED": str(seed)}
    try:
        r = subprocess.run(command, capture_output=True, text=True, timeout=limit, env=environment)
    except subprocess.TimeoutExpired:
        return f"no end after {limit:g} s"
    if r.returncode == 0:
        return ""
    bad = [line.strip() for line in r.stdout.splitlines() if " FAIL " in line or "[  FAILED  ]" in line]
    said = bad + r.stderr.splitlines()
    return said[0] if said else f"exit {r.returncode}"


def main():
    args = arguments()
    brick = str(args.brick)
    benches, known = args.program or args.bench, args.program or every_bench(brick)
    for name in benches:
        if name not in known:
            sys.exit(f"sweep: no bench {name}; expected one of {' '.join(known)}")
    origin = int(time.time()) if args.origin is None else args.origin
    runs = [(bench, seed) for seed in args.seed + fresh_seeds(origin, args.seeds) for bench in benches or known]
    print(f"{len(runs)} runs, engine {args.engine}, fresh seeds --from {origin}", flush=True)
    end = time.monotonic() + 60 * args.minutes if args.minutes is not None else None

    def one(bench_and_seed):
        if end is not None and time.monotonic() > end:
            return None
        bench, seed = bench_and_seed
        command = [brick, "run", bench, "--engine", args.engine, "--seed", str(seed)]
        shown = " ".join(command)
        if args.program:
            command = [bench, f"--gtest_filter={args.filter}"]
            shown = f"BRICK_RANDOM_SEED={seed} {bench} --gtest_filter='{args.filter}'"
        said = run(command, args.limit, seed)
        if said:
            print(f"FAIL {said}\n     {shown}", flush=True)
        return not said

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        results = list(pool.map(one, runs))
    made, failed = sum(r is not None for r in results), sum(r is False for r in results)
    print(f"{made} runs, {failed} failed" + (f", {len(runs) - made} not begun" if made < len(runs) else ""))
    return 1 if failed or made == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
