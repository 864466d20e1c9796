"""The bus and the encoder pins of `servo_channel`."""

import os

from cocotb import start_soon
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, FallingEdge
from register_map import registers

MAP = registers(os.environ["SERVO_IC_XML"])
QUADRATURE = (0b00, 0b01, 0b11, 0b10)  # bit 0 A, bit 1 B: A before B
INDEX = 0b100  # C
HOLD = 4  # clocks a state lasts; the filter wants two
LATENCY = 8  # clocks from a pin to the counter, at most


class Channel:
    """The bus and the encoder of the device."""

    def __init__(self, dut):
        self.dut, self.place, self.index = dut, 0, 0

    async def start(self):
        """Clocks, all inputs low, reset; SCLK at every edge of clk_ref."""
        dut = self.dut
        for pin in dut:
            if pin._name.endswith("_i") and not pin._name.startswith("clk"):
                pin.value = 0
        dut.rst_ni.value = 0
        dut.sclk_ce_i.value = 1
        start_soon(Clock(dut.clk_pwm_i, 8478, unit="ps").start())  # 117.9648 MHz
        start_soon(Clock(dut.clk_ref_i, 25434, unit="ps").start())  # a third
        await ClockCycles(dut.clk_ref_i, 3)
        await FallingEdge(dut.clk_ref_i)
        dut.rst_ni.value = 1
        await ClockCycles(dut.clk_ref_i, LATENCY)

    async def select(self, name, **lines):
        """One clk_ref cycle of the bus with these lines high; what it reads."""
        dut, register = self.dut, MAP[name]
        await FallingEdge(dut.clk_ref_i)
        for line, value in {"x": register.x, "addr": register.address, "sel": 1, **lines}.items():
            getattr(dut, f"{line}_i").value = value
        await FallingEdge(dut.clk_ref_i)
        word = dut.rdata_o.value
        for line in ("sel", *lines):
            getattr(dut, f"{line}_i").value = 0
        return word

    async def write(self, name, word):
        await self.select(name, we=1, wdata=word)

    async def read(self, name):
        return (await self.select(name)).to_unsigned()

    async def position(self):
        """The counter, as the falling edge of PHASE latches it, signed."""
        await ClockCycles(self.dut.clk_ref_i, LATENCY)
        await self.select("phase_position", phase_fall=1)
        return (await self.select("phase_position")).to_signed()

    async def captured(self):
        """The captured position; None when there is none. Reading arms the trigger."""
        await ClockCycles(self.dut.clk_ref_i, LATENCY)
        if not MAP["status"].bit(await self.read("status"), "captured"):
            return None
        dut = self.dut
        await FallingEdge(dut.clk_ref_i)
        dut.x_i.value, dut.addr_i.value, dut.sel_i.value = 1, MAP["flag_position"].address, 1
        dut.read_capture_i.value = 1
        await ClockCycles(dut.clk_ref_i, 1)
        word = dut.rdata_o.value  # before the edge acts
        await FallingEdge(dut.clk_ref_i)
        dut.sel_i.value = dut.read_capture_i.value = 0
        return word.to_signed()

    async def move(self, edges):
        """Moves by so many quadrature edges; the index is high within its place only."""
        for _ in range(abs(edges)):
            self.place += 1 if edges > 0 else -1
            index = INDEX if self.index and self.place % self.index == 0 else 0
            for c in (0, index, 0) if index else (0,):  # the index rises and falls inside its state
                await FallingEdge(self.dut.clk_ref_i)
                self.dut.pins_i.value = QUADRATURE[self.place % 4] | c
                await ClockCycles(self.dut.clk_ref_i, HOLD)
