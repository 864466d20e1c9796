"""The peer in Python, for cocotb: WRITES, STEPS and FLIP stand in the environment. What it plays stands in peer.h."""

import os
import pathlib

import cocotb
from cocotb.triggers import Timer

CHANNEL = (0xF80, 0xF81, 0xF83, 0xF82)
WORDS = (4, 12, 20, 0)


class Dut:
    def __init__(self, dut):
        self.dut, self.now = dut, 0

    async def start(self):
        for name in ("clk_pwm_i", "clk_ref_i", "sel_i", "x_i", "addr_i", "we_i", "wdata_i", "rd_i", "trip_i",
                     "trip_d_i", "adc_a_i", "adc_b_i"):
            getattr(self.dut, name).value = 0
        self.dut.phase_i.value = self.dut.servo_i.value = 1
        for level in (1, 0, 1):
            self.dut.rst_ni.value = level
            await Timer(1, "ns")

    async def run_until(self, tick):
        dut = self.dut
        while self.now < tick:
            self.now += 1
            await Timer(1, "ns")
            dut.clk_pwm_i.value = 1
            if self.now % 3 == 0:
                dut.clk_ref_i.value = 1
            await Timer(1, "ns")
            dut.clk_pwm_i.value = 0
            dut.clk_ref_i.value = 0

    def select(self, address):
        self.dut.sel_i.value = 1
        self.dut.x_i.value = address >> 2 & 1
        self.dut.addr_i.value = address >> 3

    async def write(self, address, value):
        self.select(address)
        self.dut.we_i.value = 1
        self.dut.wdata_i.value = value
        await self.run_until(self.now + 1)
        self.dut.we_i.value = 0

    def set_pins(self, step, flip):
        self.dut.pins_i.value = sum(CHANNEL[(step + n) % 4] << 12 * n for n in range(4)) ^ flip


@cocotb.test()
async def play(handle):
    writes = [[int(word, 16) for word in line.split()]
              for line in pathlib.Path(os.environ["WRITES"]).read_text().splitlines()]
    steps, flip = int(os.environ["STEPS"]), int(os.environ["FLIP"])
    dut, total, mark, said = Dut(handle), 0, 1, []
    dut.set_pins(0, flip)
    await dut.start()
    for i, (address, value) in enumerate(writes, 1):
        await dut.run_until(9 * i - 1)
        await dut.write(address, value)
    for step in range(steps + 1):
        dut.select(WORDS[step % 4])
        await dut.run_until(240 + 60 * step)
        for value in (handle.rdata_o.value, handle.motor_o.value):
            total = (31 * total + int(value)) % (1 << 64)
        if step in (mark, steps):
            said.append(f"{step} {total:016x}\n")
            while mark <= step:
                mark *= 10
        dut.set_pins(step + 1, flip)
    pathlib.Path(os.environ["SAID"]).write_text("".join(said))
