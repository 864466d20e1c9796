// Status, positions, compares and the halves of the timer words with hardware 1/T.
#include "testbench/unit/register_bits/channel_checks.h"

namespace brick {
namespace {

// --- Status

Check pin_shows(unsigned pin) {
  return [pin](BitsRig& rig, unsigned ch) {
    rig.start();
    for (bool level : {true, false}) {
      rig.pin(ch, pin, level);
      if (rig.bit(ch, words::kStatus, 12 + pin) != level) return false;
    }
    return true;
  };
}

Check hall_capture(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kX4 | kGated);  // source 0: the first edge of U, V or W
    for (bool level : {true, false}) {
      rig.read(ch, words::kFlagPosition);
      rig.pin(ch, kW + bit, level);
      if (!status(rig, ch, status_bit::kCaptured) || rig.bit(ch, words::kStatus, bit) != level) return false;
    }
    return true;
  };
}

bool demultiplexing_incomplete(BitsRig& rig, unsigned ch) {
  rig.start();
  if (!status(rig, ch, status_bit::kDemuxInvalid)) return false;
  rig.steps(ch, 3, true);  // the fourth AB state since reset
  return !status(rig, ch, status_bit::kDemuxInvalid);
}

void lose_encoder(BitsRig& rig, unsigned ch) {
  rig.start();
  rig.in.pins[ch - 1] = 1u << kT | 1u << kV;  // pairs differ
  rig.run(BitsRig::kHold);
  rig.write(ch, words::kStatus, 0);
}
bool encoder_loss(BitsRig& rig, unsigned ch) {
  lose_encoder(rig, ch);
  rig.run(BitsRig::kHold);
  if (status(rig, ch, status_bit::kEncoderLoss)) return false;
  rig.pin(ch, kU, true);
  return status(rig, ch, status_bit::kEncoderLoss);
}
bool encoder_loss_clears_with_a_0(BitsRig& rig, unsigned ch) {
  lose_encoder(rig, ch);
  rig.pin(ch, kU, true);
  rig.pin(ch, kU, false);  // latched, the cause is gone
  rig.write(ch, words::kStatus, status_bit::kEncoderLoss.mask());
  if (!status(rig, ch, status_bit::kEncoderLoss)) return false;
  rig.write(ch, words::kStatus, 0);
  return !status(rig, ch, status_bit::kEncoderLoss);
}

bool encoder_error(BitsRig& rig, unsigned ch) {
  rig.start();
  control(rig, ch, kX4);
  if (status(rig, ch, status_bit::kEncoderError)) return false;
  rig.in.pins[ch - 1] = 3;
  rig.run(BitsRig::kHold);
  return status(rig, ch, status_bit::kEncoderError);
}

bool equ_in_status(BitsRig& rig, unsigned ch) {
  rig.start();
  if (status(rig, ch, status_bit::kEqu)) return false;
  control(rig, ch, kEquWrite | kEquState);
  return status(rig, ch, status_bit::kEqu);
}

Check captured(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    rig.steps(ch, 2, true);  // A and B high: the gate is open
    control(rig, ch, kX4 | kIndex | kGated);
    if (rig.bit(ch, words::kStatus, bit)) return false;
    rig.pin(ch, kC, true);
    if (!rig.bit(ch, words::kStatus, bit)) return false;
    rig.read(ch, words::kFlagPosition);
    return !rig.bit(ch, words::kStatus, bit);
  };
}

// Bits that are always 0, with every neighbour that can be 1 at 1.
bool reads_0(BitsRig& rig, unsigned ch, bool x, unsigned offset, unsigned bit) {
  rig.start();
  rig.in.pins[ch - 1] = 0xFFF;
  rig.run(BitsRig::kHold);
  return !rig.bit(x, base(ch) + offset, bit);
}

// --- Positions: 0 and -1 show both values of every bit. That the upper bits follow the lower ones is shown by
// timer_bits_test.cpp, which counts through all 24 bits.

Check phase_position(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kX4);
    if ((counter(rig, ch) >> bit & 1) != 0) return false;
    rig.step(ch, false);
    return (counter(rig, ch) >> bit & 1) != 0;
  };
}
Check servo_position(unsigned bit) {  // -1 going down, then 0 going up; bit 0 is the direction
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kX4);
    for (bool up : {false, true}) {
      rig.step(ch, up);
      rig.latch();
      if (rig.bit(ch, words::kServoPosition, bit) == up) return false;
    }
    return true;
  };
}
Check capture_position(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    if (!captures(rig, ch, kX4 | kFlag, kHmfl)) return false;
    if ((rig.read(ch, words::kFlagPosition) >> bit & 1) != 0) return false;
    rig.step(ch, false);
    rig.pin(ch, kHmfl, false);
    rig.pin(ch, kHmfl, true);
    return rig.bit(ch, words::kFlagPosition, bit);
  };
}

// --- Timer words with hardware 1/T: at rest the fraction is 4095 after counts up and 0 after counts down.

Check capture_fraction(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    for (bool up : {true, false}) {
      control(rig, ch, kX4 | kFine | kFlag);
      creep(rig, ch, up);
      rig.read(ch, words::kFlagPosition);
      rig.pin(ch, kHmfl, true);
      if (rig.bit(ch, words::kTimer1, bit) != up) return false;
      rig.pin(ch, kHmfl, false);
    }
    return true;
  };
}
Check servo_fraction(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kX4 | kFine);
    for (bool up : {true, false}) {
      creep(rig, ch, up);
      rig.latch();
      if (rig.bit(ch, words::kTimer2, bit) != up) return false;
    }
    return true;
  };
}
// The position rests at 3 and 4095/4096. The next count leaves a compare that stands there, and none before it.
Check compare_fraction(bool of_a, unsigned bit) {
  return [of_a, bit](BitsRig& rig, unsigned ch) {
    for (bool level : {false, true}) {
      rig.start();
      control(rig, ch, kX4 | kFine);
      creep(rig, ch, true);
      rig.write(!of_a, base(ch) + 7, 3);
      rig.write(of_a, base(ch) + 7, kFar);
      rig.write(false, base(ch) + (of_a ? 1 : 0), level ? 0xFFF : 0xFFF & ~(1u << bit));
      const bool before = equ(rig, ch);
      rig.step(ch, true);
      if ((equ(rig, ch) != before) != level) return false;
    }
    return true;
  };
}
Check fraction_reads_back(bool of_a, unsigned bit) {
  return [of_a, bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kFine);
    for (bool level : {true, false}) {
      rig.write(false, base(ch) + (of_a ? 1 : 0), level ? 1u << bit : 0xFFF & ~(1u << bit));
      if (rig.bit(false, base(ch) + (of_a ? 1 : 0), bit) != level) return false;
    }
    return true;
  };
}

// --- Compares: leaving A (or B) toggles EQU only if all 24 bits are those of the counter.

Check compare(bool of_a) {
  return [of_a](BitsRig& rig, unsigned ch) {
    for (bool ones : {false, true}) {
      rig.start();
      control(rig, ch, kX4);
      rig.write(of_a, base(ch) + 7, kFar);
      rig.write(!of_a, base(ch) + 7, ones ? 0xFFFFFF : kFar);
      if (ones) rig.step(ch, false);
      if (!ones) rig.write(!of_a, base(ch) + 7, 0);
      const bool before = equ(rig, ch);
      rig.step(ch, false);
      if (equ(rig, ch) == before) return false;
    }
    return true;
  };
}
Check increment(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    for (bool level : {false, true}) {
      rig.start();
      control(rig, ch, kX4);
      const std::uint32_t inc = level ? 1u << bit : 0xFFFFFF & ~(1u << bit);
      rig.write(ch, words::kCompareB, 0x200000);
      rig.write(ch, words::kCompareA, 0);
      rig.write(ch, words::kCompareIncrement, inc);
      rig.step(ch, true);
      if (rig.peek(ch, words::kCompareB) != ((0x200000 + inc) & 0xFFFFFF)) return false;
    }
    return true;
  };
}

}  // namespace

void add_read_back(BitTable& table, const char* name, bool x, unsigned offset, bool global, std::uint32_t kept) {
  for (unsigned bit = 0; bit < 24; ++bit) {
    const bool always_0 = (kept >> bit & 1) == 0;
    table.push_back({std::string(name) + " reads back", Side::kRead, x, offset, bit, global, always_0,
                     [=](BitsRig& rig, unsigned ch) {
                       const unsigned addr = global ? offset : base(ch) + offset;
                       rig.start();
                       for (bool level : {true, false}) {
                         rig.write(x, addr, level ? 1u << bit : 0xFFFFFF & ~(1u << bit));
                         rig.run(3);
                         if (rig.bit(x, addr, bit) != (level && !always_0)) return false;
                       }
                       return true;
                     }});
  }
}

void add_channel_rows(BitTable& table) {
  const auto read_row = [&](const char* name, bool x, unsigned offset, unsigned bit, Check check) {
    table.push_back({name, Side::kRead, x, offset, bit, false, false, std::move(check)});
  };
  for (unsigned bit = 0; bit < 3; ++bit) read_row("HALLCAP", true, 0, bit, hall_capture(bit));
  read_row("DMX_INV", true, 0, 3, demultiplexing_incomplete);
  for (unsigned bit = 4; bit < 7; ++bit)
    table.push_back({"status 0", Side::kRead, true, 0, bit, false, true,
                     [bit](BitsRig& rig, unsigned ch) { return reads_0(rig, ch, true, 0, bit); }});
  read_row("ENC_LOSS", true, 0, 7, encoder_loss);
  table.push_back({"ENC_LOSS clear", Side::kWritten, true, 0, 7, false, false, encoder_loss_clears_with_a_0});
  read_row("ENC_ERR", true, 0, 8, encoder_error);  // any write clears it: no written bit matters
  read_row("EQU", true, 0, 9, equ_in_status);
  read_row("CAPT_GI", true, 0, 10, captured(10));
  read_row("CAPT", true, 0, 11, captured(11));
  for (unsigned pin = 0; pin < 12; ++pin) read_row("input", true, 0, 12 + pin, pin_shows(pin));

  for (unsigned bit = 0; bit < 24; ++bit) {
    read_row("phase position", true, 1, bit, phase_position(bit));
    read_row("servo position", true, 2, bit, servo_position(bit));
    read_row("captured position", true, 3, bit, capture_position(bit));
    table.push_back({"compare A", Side::kWritten, false, 7, bit, false, false, compare(true)});
    table.push_back({"compare B", Side::kWritten, true, 7, bit, false, false, compare(false)});
    table.push_back({"increment", Side::kWritten, true, 6, bit, false, false, increment(bit)});
  }
  add_read_back(table, "compare A", false, 7, false, 0xFFFFFF);
  add_read_back(table, "compare B", true, 7, false, 0xFFFFFF);
  add_read_back(table, "increment", true, 6, false, 0xFFFFFF);

  add_control_rows(table);

  for (unsigned bit = 0; bit < 12; ++bit) {
    read_row("captured fraction", false, 0, 12 + bit, capture_fraction(12 + bit));
    read_row("servo fraction", false, 1, 12 + bit, servo_fraction(12 + bit));
    for (bool of_a : {true, false}) {
      const std::string name = of_a ? "fraction of compare A" : "fraction of compare B";
      table.push_back({name, Side::kWritten, false, of_a ? 1u : 0u, bit, false, false, compare_fraction(of_a, bit)});
      table.push_back({name + " reads back", Side::kRead, false, of_a ? 1u : 0u, bit, false, false,
                       fraction_reads_back(of_a, bit)});
    }
  }
}

}  // namespace brick
