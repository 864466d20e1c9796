"""Random quadrature, index pulses and impossible steps by the seed, every read judged by the scoreboard."""

import json
import os
import random

import cocotb
from channel import HOLD, MAP, QUADRATURE, Channel
from cocotb.triggers import ClockCycles, FallingEdge
from cocotb.utils import get_sim_time
from scoreboard import REVERSED, X1, X2, X4, Scoreboard

DECODES = [code + reversed_ for code in (X1, X2, X4) for reversed_ in (0, REVERSED)]
ROUNDS = 12
COVERS = ["captures", "errors", "reads below 0", "reads of no capture",
          *(f"edges {way}, decode {code}" for way in ("up", "down") for code in DECODES)]


class Bench:
    def __init__(self, channel, scoreboard):
        self.channel, self.scoreboard, self.steps = channel, scoreboard, []

    async def drive(self, place, index):
        """The pins at a place of the quadrature cycle, for long enough to pass the filter."""
        await FallingEdge(self.channel.dut.clk_ref_i)
        self.channel.dut.pins_i.value = QUADRATURE[place % 4] | index << 2
        self.scoreboard.pins(QUADRATURE[place % 4], index)
        await ClockCycles(self.channel.dut.clk_ref_i, HOLD)

    async def walk(self, edges, pulses):
        for _ in range(abs(edges)):
            self.channel.place += 1 if edges > 0 else -1
            await self.drive(self.channel.place, self.scoreboard.index)
            if random.random() < pulses:
                await self.drive(self.channel.place, 1 - self.scoreboard.index)

    async def jump(self):
        self.channel.place += 2
        await self.drive(self.channel.place, self.scoreboard.index)

    async def choose(self, decode):
        await self.channel.write("control", MAP["control"].word(decode=decode, capture_source=1))
        self.scoreboard.decode = decode

    def step(self, name, measured, expected):
        detail = f"{measured}" if measured == expected else f"{measured}, expected {expected}"
        self.steps.append({"ns": round(get_sim_time("ns")), "name": name, "passed": measured == expected,
                           "detail": detail})

    async def judge(self, what):
        position = await self.channel.position()
        self.step(f"position {what}", position, self.scoreboard.position)
        self.scoreboard.covers["reads below 0"] += position < 0
        status = await self.channel.read("status")
        self.step(f"encoder error {what}", bool(MAP["status"].bit(status, "encoder_error")), self.scoreboard.error)
        capture = self.scoreboard.read_capture()
        self.scoreboard.covers["reads of no capture"] += capture is None
        self.step(f"captured position {what}", await self.channel.captured(), capture)
        await self.channel.write("status", 0)
        self.scoreboard.error = False

    def write(self, file):
        covers = {name: {"count": self.scoreboard.covers[name], "least": 1} for name in COVERS}
        with open(file, "w") as out:
            json.dump({"steps": self.steps, "covers": covers}, out)


@cocotb.test()
async def random_traffic_agrees_with_the_scoreboard(dut):
    bench = Bench(Channel(dut), Scoreboard(wrong="NEGATIVE" in os.environ))
    await bench.channel.start()
    for number in range(1, ROUNDS + 1):
        await bench.choose(random.choice(DECODES))
        await bench.walk(random.randint(-15, 15), pulses=0.1)
        if random.random() < 0.2:
            await bench.jump()
        await bench.judge(f"after round {number}")
    for decode in DECODES:  # what chance may have left out: each decode both ways, each kind of event
        await bench.choose(decode)
        await bench.walk(5, pulses=1)
        await bench.walk(-9, pulses=0)
        await bench.judge(f"both ways, decode {decode}")
    await bench.judge("when nothing was captured")
    await bench.jump()
    await bench.judge("after an impossible step")
    await bench.choose(X4)
    await bench.walk(-5 - bench.scoreboard.position, pulses=0)
    await bench.judge("below 0")
    bench.write(os.environ["BENCH_RESULTS"])
    failed = [step for step in bench.steps if not step["passed"]]
    assert not failed, f"{failed[0]['name']}: {failed[0]['detail']}"
