"""A motor turns one revolution."""

import brick


def test_one_revolution() -> None:
    with brick.Controller(plant="dac8", setup="dac8") as c:
        c.command("#1J/")  # closes the loop
        c.wait_in_position(1)
        c.command("#1J:4000")  # counts
        c.wait_in_position(1)
        assert abs(c.position(1) - 4000) < 10
        assert c.time < 1


if __name__ == "__main__":
    test_one_revolution()
