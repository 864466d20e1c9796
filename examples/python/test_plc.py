"""A PLC that watches a pin, counts and sends a text to the host."""

import brick

PLC = """
OPEN PLC 2 CLEAR
IF (M1=1)
  P1=P1+1
  SEND"door open"
  WHILE (M1=1)
  ENDWHILE
ENDIF
CLOSE
"""


def test_door(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c.command("M1->X:$078000,16")  # home flag of channel 1 (servo-ic:3)
    c.script(PLC)
    c["P1"], c["I5"] = 0, 2  # PLC programs may run
    c.command("ENABLE PLC 2")
    for count in (1, 2):
        c.set_pin("servo_ic0.ch1.hmfl", 1)
        c.run(ms=10)
        assert c["P1"] == count
        c.set_pin("servo_ic0.ch1.hmfl", 0)
        c.run(ms=10)
    assert [text.strip() for text in c.texts()] == ["door open", "door open"]
