"""Every bench through the built command: it passes on its engines and seeds, and fails its negative control. A bench
that runs in lock-step does not run on the RTL alone as well: there the RTL and the model get the same inputs, are equal
at every tick, and the bench judges what they show; the RTL alone has `smoke` and the tests of the whole controller. In
lock-step here: encoder, outputs and converters of a channel, serial encoders, the host port and Port A; the buses by
themselves have it in unit_accesses, blocks of a channel in their vectors and unit_servo_channel, the MACRO IC and the
panel in unit_system. The plan `night` has all others so too, and more seeds of each. usage: bench_acceptance.py BRICK
CASE; each CASE is one test."""
import fnmatch
import json
import pathlib
import tempfile

from command import BOARDS, CASE, brick, check


def run_json(bench, *options):
    with tempfile.TemporaryDirectory() as folder:
        r = brick("run", bench, "--json", f"{folder}/r.json", *options, timeout=500)
        return r, json.loads(pathlib.Path(f"{folder}/r.json").read_text())


def bench_passes(name, engine, seed="1", firmware=True, board=None, size=None):
    """Its results."""
    r, results = run_json(name, "--engine", engine, "--seed", seed, *(("--board", board) if board else ()),
                          *(("--size", size) if size else ()))
    check(r.returncode == 0 and results["verdict"] == "PASS", r.stdout + r.stderr)
    check(f"PASS {name}" in r.stdout and "ticks/s" in r.stdout and "instructions/s" in r.stdout, r.stdout)
    check(len(results["steps"]) > 5 and results["ticks"] > 0 and (results["instructions"] > 0) == firmware,
          str(results))
    idle = [cover for cover, counted in results["covers"].items() if counted["least"] == 0]
    check(not idle, f"covers that ask for nothing: {idle}")
    return results


def fails_its_negative_control(name, engine="systemc", board=None, **other):
    """With --negative the first step that fails is the one that `brick list --json` names, and says what it should."""
    expected = next(b for b in json.loads(brick("list", "--json").stdout) if b["name"] == name) | other
    r, results = run_json(name, "--engine", engine, "--negative", *(("--board", board) if board else ()))
    check(r.returncode == 1 and results["verdict"] == "FAIL", r.stdout + r.stderr)
    first = next(s for s in results["steps"] if not s["passed"])
    right = fnmatch.fnmatchcase(first["name"], expected["negative_step"]) and \
        fnmatch.fnmatchcase(first["detail"], f"*{expected['negative_says']}*")
    check(right, f"{first}, expected {expected['negative_step']}: ...{expected['negative_says']}...")
    failed = {s["name"]: s["detail"] for s in results["steps"] if not s["passed"]}
    for also in expected["negative_also"]:
        check(also["says"] in failed.get(also["step"], ""), f"{also}: {failed}")


def every_board():
    """Every bench on boards that are not its own: it passes, or says in one line what the board has not; nothing in
    between. Each bench passes on one board that can do it, another for the next bench; the plan `night` has all
    pairs."""
    one_servo_ic = {"watchdog", "reinit-e3", "clock-select", "clock-faults", "clock-macro", "port-a-phase",
                    "port-a-hammer", "task-load"}
    every_bench = {b["name"] for b in json.loads(brick("list", "--json").stdout)}
    refused = {"geo-pmac": one_servo_ic, "geobrick-lv-4": one_servo_ic,
               "turbo-pmac2-pci-lite": {"watchdog", "reinit-e3", "port-a-phase", "port-a-hammer", "task-load", "ssi"},
               "turbo-pmac2-pci": {"ssi"}, "turbo-pmac2-pc": {"ssi"},
               "geobrick-lv-8": {"clock-macro"},
               "turbo-pmac-pci": {"clock-macro", "ssi"},
               "pmac-pc": {"clock-macro", "breq-rotary", "breq-fixed", "breq-select", "watchdog", "capture-compare",
                           "isa-timing", "ssi"},
               "umac-turbo": {"ssi", "watchdog", "reinit-e3", "pwm", "port-a-phase", "port-a-hammer", "task-load"},
               "turbo-pmac2-ultralite":
                    every_bench - {"smoke", "binary-rotary", "breq-rotary", "breq-fixed", "breq-select", "interrupts",
                                   "clock-macro", "dpram", "dpram-ascii", "dpram-reporting", "gather", "host-port",
                                   "isa-timing", "bus-timing", "plc", "listing", "variables", "status",
                                   "save-restore"}}
    boards = sorted(f.stem for f in BOARDS.glob("*.toml"))
    for number, bench in enumerate(json.loads(brick("list", "--json").stdout)):
        able = [board for board in boards if bench["name"] not in refused.get(board, set()) and board != bench["board"]]
        tried = able[number % len(able)] if able else None
        for board in boards:
            has = bench["name"] not in refused.get(board, set())
            if has and board != tried:
                continue  # a case of its own, or one of `night`
            r = brick("run", bench["name"], "--engine", "systemc", "--board", board)
            if not has:
                said = (f"brick run: {bench['name']} needs {bench['needs']}, which board {board} has not; "
                        f"expected a board such as {bench['board']}\n")
                check(r.returncode == 2 and r.stderr == said and bench["needs"],
                      f"{board} {bench['name']}: exit {r.returncode}: {r.stderr}")
            else:
                check(r.returncode == 0, f"{board} {bench['name']}: exit {r.returncode}: {r.stdout}{r.stderr}")
    # What another board has in the place of what the negative control is about.
    fails_its_negative_control("breq-select", board="geobrick-lv-8", negative_step="&n, I2=0",
                               negative_says="is selected (&*I2=0, I59=0")
    fails_its_negative_control("interrupts", board="pmac-pc", negative_step="IR0 IPOS, edge",
                               negative_says="vector: 16, expected 8")


# A board of one's own and the benches that are about what is odd there.
OWN_BOARDS = {
    "one axis card": ('family = "umac-turbo"\nbus = "pc104"\nservo_ics = [2]',
                      "capture-compare serial-dac-adc breq-select"),
    "a card of the second base": ('family = "umac-turbo"\nbus = "pc104"\nservo_ics = ["5*"]\naxes = 1', ""),
    "no axis card": ('family = "umac-turbo"\nbus = "pc104"\nservo_ics = []\nmacro_ics = [1]', "status breq-select"),
    "the second servo IC": ('family = "geo-brick-lv"\nbus = "internal"\nservo_ics = [1]\nmacro_ics = [0]',
                            "capture-compare ssi"),
    "one MACRO IC": ('family = "turbo-pmac2-ultralite"\nbus = "pci"\nservo_ics = []\nmacro_ics = [2]',
                     "clock-macro breq-select"),
    "two MACROGATEs": ('family = "turbo-pmac2-ultralite"\nbus = "pci"\nservo_ics = []\nmacro_ics = [0, 1, 2, 3]\n'
                       'macro_gates = [1, 2]', "clock-select clock-faults clock-macro"),
    "10 address bits": ('family = "turbo-pmac2"\nbus = "isa"\nservo_ics = [0]\nio_base = 0x3F0\nio_decode = 10\n'
                        'interrupts = ["EQU4", "none", "EQU1"]', "isa-timing dpram-ascii capture-compare")}


# covers: CARD-1 CARD-2
def own_boards():
    """Benches take their expectations from the board: on any that a file can say they pass, or lack something."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "own.toml")
        for title, (lines, benches) in OWN_BOARDS.items():
            file.write_text(f'title = "{title}"\ncard = 603382\ndpram_words = 8192\n{lines}\n')
            for bench in ["smoke", *benches.split()]:
                r = brick("run", bench, "--engine", "systemc", "--board", str(file))
                failed = [line for line in r.stdout.splitlines() if "FAIL" in line]
                check(r.returncode == 0, f"{title}, {bench}: exit {r.returncode}: {failed}{r.stderr}")
            fails_its_negative_control("smoke", board=str(file))
        gates = 'macro_ics = [1, 2]\nmacro_gates = [1]'
        lacking = {"clock-macro": "servo_ics = [2]", "clock-select": f"servo_ics = []\n{gates}"}
        for bench, ics in lacking.items():
            file.write_text('title = "few"\nfamily = "umac-turbo"\nbus = "pc104"\ncard = 603382\n'
                            f'dpram_words = 8192\n{ics}\n')
            r = brick("run", bench, "--engine", "systemc", "--board", str(file))
            check(r.returncode == 2 and "which board own has not" in r.stderr, f"{ics}, {bench}: {r}")


def smoke():
    for engine in ("systemc", "rtl", "lockstep"):
        bench_passes("smoke", engine)


def smoke_seeded_bug():
    fails_its_negative_control("smoke", "lockstep", negative_step="engines agree", negative_says="clock.servo")


def breq_rotary():
    bench_passes("breq-rotary", "systemc")


# covers: I18-2
def breq_fixed():
    bench_passes("breq-fixed", "systemc")


def dpram():
    bench_passes("dpram", "systemc")


def dpram_ascii():
    bench_passes("dpram-ascii", "systemc")


def dpram_reporting():
    bench_passes("dpram-reporting", "systemc")


def gather():
    bench_passes("gather", "systemc")


# covers: I9-1 I9-3
def listing():
    bench_passes("listing", "systemc")


# covers: I9-1 I9-2 I9-3
def variables():
    bench_passes("variables", "systemc")


# covers: BREQ-5
def status():
    bench_passes("status", "systemc")


# covers: BREQ-6 BREQ-7
def breq_select():
    bench_passes("breq-select", "systemc")


# covers: BREQ-5
def interrupts():
    bench_passes("interrupts", "systemc")
    r, results = run_json("interrupts", "--engine", "lockstep", "--board", "pmac-pc")  # an 8259
    check(r.returncode == 0 and results["verdict"] == "PASS", r.stdout + r.stderr)


# covers: WDT-1
def watchdog():
    bench_passes("watchdog", "systemc")


# covers: WDT-2
def reinit_e3():
    bench_passes("reinit-e3", "systemc")
    r, results = run_json("reinit-e3", "--engine", "systemc", "--board", "turbo-pmac2-pc")  # with a MACRO IC
    check(r.returncode == 0 and results["verdict"] == "PASS", r.stdout + r.stderr)


def save_restore():
    bench_passes("save-restore", "systemc")
    r, results = run_json("save-restore", "--engine", "systemc", "--board", "turbo-pmac-pci")  # with INIT/
    check(r.returncode == 0 and results["verdict"] == "PASS", r.stdout + r.stderr)


def clock_select():
    bench_passes("clock-select", "systemc")


def clock_faults():
    bench_passes("clock-faults", "systemc")
    bench_passes("clock-faults", "systemc", board="all-ics")  # whose start takes longer than the watchdog waits


def clock_macro():
    bench_passes("clock-macro", "systemc")


def encoder():
    bench_passes("encoder", "systemc")


def encoder_lockstep():
    bench_passes("encoder", "lockstep", "3")


# covers: CLK-6
def pwm():
    for engine, seed in (("systemc", "1"), ("lockstep", "3")):
        bench_passes("pwm", engine, seed)


def pfm():
    for engine, seed in (("systemc", "1"), ("lockstep", "3")):
        bench_passes("pfm", engine, seed)


def serial_dac_adc():
    for engine, seed in (("systemc", "1"), ("lockstep", "3")):
        bench_passes("serial-dac-adc", engine, seed)


def port_a_phase():
    for engine, seed in (("systemc", "1"), ("lockstep", "4")):
        bench_passes("port-a-phase", engine, seed, firmware=False)


def port_a_hammer():
    for engine, seed in (("systemc", "1"), ("lockstep", "4")):
        bench_passes("port-a-hammer", engine, seed, firmware=False)


def host_port():
    for engine, seed in (("systemc", "1"), ("lockstep", "4")):
        bench_passes("host-port", engine, seed)


def isa_timing():
    bench_passes("isa-timing", "systemc")


def slot_of_8_bits():
    """A card without LA and SBHE#: what needs words in one access says so, the others pass."""
    with tempfile.TemporaryDirectory() as folder:
        board = pathlib.Path(folder) / "slot8.toml"
        board.write_text((BOARDS / "turbo-pmac2-pc.toml").read_text() + "slot = 8\n")
        for bench in ("smoke", "host-port", "isa-timing"):
            bench_passes(bench, "systemc", board=str(board))
        r = brick("run", "dpram", "--board", str(board))
        check(r.returncode == 2 and "dpram needs a slot of 16 bits, which board slot8 has not" in r.stderr, r.stderr)


def capture_compare():
    bench_passes("capture-compare", "systemc")


def flags():
    bench_passes("flags", "systemc")


# covers: CARD-5
def bus_timing():
    bench_passes("bus-timing", "systemc")


# covers: BIN-1 BIN-3 BIN-5 BIN-6
def binary_rotary():
    bench_passes("binary-rotary", "systemc")


def plc():
    bench_passes("plc", "systemc")


def servo_loop():
    bench_passes("servo-loop", "systemc")


def jog_home():
    bench_passes("jog-home", "systemc")


def motion():
    bench_passes("motion", "systemc")


def kinematics():
    bench_passes("kinematics", "systemc")


def limits():
    bench_passes("limits", "systemc")


def commutation_bench():
    bench_passes("commutation", "systemc")


# covers: SSI-1
def ssi():
    for board, seed in (("geo-pmac", "1"), ("geobrick-lv-8", "2")):
        bench_passes("ssi", "systemc", seed, board=board)


def ssi_lockstep():
    bench_passes("ssi", "lockstep", "3", board="geo-pmac")


def time_base():
    bench_passes("time-base", "systemc")


def follow():
    bench_passes("follow", "systemc")


def task_load():
    bench_passes("task-load", "systemc")


def circle():
    bench_passes("circle", "systemc")


# covers: LA-1 LA-2 LA-3 LA-4 LA-5
def lookahead():
    """Short, for the lock-step of the plan `night`: no more than 300 ms are simulated."""
    results = bench_passes("lookahead", "systemc", "12")
    check(results["simulated_ns"] <= 300e6, f"{results['simulated_ns']} ns, expected up to 300 ms")


# covers: LA-1 LA-2 LA-4
def reversal():
    bench_passes("reversal", "systemc")


def refuses_size(name, size, said):
    r = brick("run", name, "--engine", "systemc", "--size", size)
    check(r.returncode == 2 and r.stderr == f"brick run: {said}\n", f"exit {r.returncode}: {r.stderr}")


# covers: BREQ-4 BIN-3 LA-3 LA-4
def rotary_machining():
    bench_passes("rotary-machining", "systemc", "1", size="300")
    for size, said in (("36", "--size 36: is too little for rotary-machining; expected 37 or more"),
                       ("0", "--size 0: is too little for rotary-machining; expected 37 or more"),
                       ("many", "--size many: is no number; expected an integer of 0 or more")):
        refuses_size("rotary-machining", size, said)
    refuses_size("smoke", "50", "--size 50: smoke has an end of its own; expected no --size")
    bench_passes("rotary-machining", "systemc", "2", size="37")  # the least


if CASE.endswith("_negative"):
    fails_its_negative_control(CASE.removesuffix("_negative").removesuffix("_bench").replace("_", "-"))
else:
    globals()[CASE]()
