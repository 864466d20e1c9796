"""What a channel must show, from the data sheet alone: servo-ic:5.4/1 to servo-ic:5.4/3, servo-ic:5.9/2 to
servo-ic:5.9/4. It is told of the pins as they come out of the filter and of accesses, and knows nothing of the RTL."""

import collections

UP = {(0b00, 0b01), (0b01, 0b11), (0b11, 0b10), (0b10, 0b00)}  # bit 0 A, bit 1 B: A before B
X1, X2, X4, REVERSED = 1, 2, 3, 4  # codes of I7mn0


class Scoreboard:
    """The capture is triggered by C alone. `wrong`: a rule that no channel has, X4 counts every edge twice."""

    def __init__(self, wrong=False):
        self.weight = 2 if wrong else 1
        self.decode, self.lines, self.index = X4, 0, 0
        self.position, self.capture, self.error, self.armed = 0, None, False, True
        self.covers = collections.Counter()

    def pins(self, lines, index):
        """The levels of A and B, and C, from now on."""
        self.move(lines)
        if index and not self.index and self.armed:
            self.capture, self.armed = self.position, False
            self.covers["captures"] += 1
        self.index = index

    def move(self, lines):
        changed, last = lines ^ self.lines, self.lines
        self.lines = lines
        if changed == 0b11:
            self.error = True
            self.covers["errors"] += 1
        elif changed:
            up = (last, lines) in UP
            counts = {X1: not lines & 0b10 and changed == 0b01, X2: changed == 0b01, X4: True}[self.decode % REVERSED]
            weight = self.weight if self.decode % REVERSED == X4 else 1
            self.position += counts * weight * (1 if up != (self.decode > REVERSED) else -1)
            self.covers[f"edges {'up' if up else 'down'}, decode {self.decode}"] += 1

    def read_capture(self):
        """The captured position, None when there is none; armed again."""
        capture, self.capture = self.capture, None
        self.armed = self.armed or capture is not None
        return capture
