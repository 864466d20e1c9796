"""One channel of the servo IC under cocotb: quadrature in, counts and captured positions out, judged by arithmetic."""

import random

import cocotb
from channel import MAP, QUADRATURE, Channel
from scoreboard import REVERSED, X1, X2, X4


@cocotb.test()
async def counts_every_edge(dut):
    """A random walk, then back through 0: the counter is where the walk is."""
    channel = Channel(dut)
    await channel.start()
    await channel.write("control", MAP["control"].word(decode=X4))
    for _ in range(20):
        await channel.move(random.randint(-15, 20))
        assert await channel.position() == channel.place
    await channel.move(-5 - channel.place)
    assert await channel.position() == -5


@cocotb.test()
async def each_decode_counts_its_share(dut):
    """Eight whole cycles give 8, 16 or 32 counts, the other way round in the reversed modes."""
    channel = Channel(dut)
    await channel.start()
    for mode, share in ((X1, 1), (X2, 2), (X4, 4)):
        for code, sign in ((mode, 1), (mode + REVERSED, -1)):
            await channel.write("control", MAP["control"].word(decode=code, counter_reset=1))
            await channel.write("control", MAP["control"].word(decode=code))
            await channel.move(32)
            assert await channel.position() == sign * 8 * share, f"decode {code}"


@cocotb.test()
async def index_captures_its_position_once(dut):
    """The index every 20 edges: the first is captured, the next only after that was read."""
    channel = Channel(dut)
    await channel.start()
    channel.index = 20
    await channel.write("control", MAP["control"].word(decode=X4, capture_source=1))
    assert await channel.captured() is None
    await channel.move(50)  # past 20 and 40
    assert await channel.captured() == 20
    assert await channel.captured() is None
    await channel.move(-75)  # to -25, past 40 first
    assert await channel.captured() == 40
    await channel.move(-20)  # past -40
    assert await channel.captured() == -40


@cocotb.test()
async def both_lines_at_once_are_an_error(dut):
    """Not counted, shown in the status until it is written."""
    channel = Channel(dut)
    await channel.start()
    await channel.write("control", MAP["control"].word(decode=X4))
    await channel.move(6)
    assert not MAP["status"].bit(await channel.read("status"), "encoder_error")
    channel.place += 2
    dut.pins_i.value = QUADRATURE[channel.place % 4]
    assert await channel.position() == 6
    assert MAP["status"].bit(await channel.read("status"), "encoder_error")
    await channel.write("status", 0)
    assert not MAP["status"].bit(await channel.read("status"), "encoder_error")
