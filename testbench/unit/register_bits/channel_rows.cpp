// Status, positions, control, compares and the halves of the timer words with hardware 1/T.
#include "testbench/unit/register_bits/bits_rig.h"

namespace brick {
namespace {

using Check = std::function<bool(BitsRig&, unsigned)>;

constexpr std::uint32_t kX4 = 3, kIndex = 1 << 4, kFlag = 2 << 4, kEquWrite = 1 << 11, kEquState = 1 << 12, kGated = 1 << 15,
                        kFine = 1 << 18, kInvertAb = 1 << 20, kInvertC = 1 << 21, kPfm = 1 << 23;
constexpr std::uint32_t kFar = 0x400000;  // a compare that is never reached

void control(BitsRig& rig, unsigned ch, std::uint32_t word) {
  rig.write(true, base(ch) + 5, word);
  rig.run(BitsRig::kHold);
}
bool status(BitsRig& rig, unsigned ch, unsigned bit) { return rig.bit(true, base(ch), bit); }
std::uint32_t counter(BitsRig& rig, unsigned ch) {
  rig.latch();
  return rig.peek(true, base(ch) + 1);
}
bool equ(BitsRig& rig, unsigned ch) { return rig.other(kEqu, ch); }

// Arms the trigger, raises a pin and says whether that captured.
bool captures(BitsRig& rig, unsigned ch, std::uint32_t word, unsigned pin) {
  control(rig, ch, word);
  rig.read(true, base(ch) + 3);
  rig.run(BitsRig::kHold);
  rig.pin(ch, pin, true);
  return status(rig, ch, 11);
}

// --- Status

Check pin_shows(unsigned pin) {
  return [pin](BitsRig& rig, unsigned ch) {
    rig.start();
    for (bool level : {true, false}) {
      rig.pin(ch, pin, level);
      if (status(rig, ch, 12 + pin) != level) return false;
    }
    return true;
  };
}

Check hall_capture(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    control(rig, ch, kX4 | kGated);  // source 0: the first edge of U, V or W
    for (bool level : {true, false}) {
      rig.read(true, base(ch) + 3);
      rig.pin(ch, kW + bit, level);
      if (!status(rig, ch, 11) || status(rig, ch, bit) != level) return false;
    }
    return true;
  };
}

bool demultiplexing_incomplete(BitsRig& rig, unsigned ch) {
  rig.start();
  if (!status(rig, ch, 3)) return false;
  rig.steps(ch, 3, true);  // the fourth AB state since reset
  return !status(rig, ch, 3);
}

void lose_encoder(BitsRig& rig, unsigned ch) {
  rig.start();
  rig.in.pins[ch - 1] = 1u << kT | 1u << kV;  // pairs differ
  rig.run(BitsRig::kHold);
  rig.write(true, base(ch), 0);
}
bool encoder_loss(BitsRig& rig, unsigned ch) {
  lose_encoder(rig, ch);
  rig.run(BitsRig::kHold);
  if (status(rig, ch, 7)) return false;
  rig.pin(ch, kU, true);
  return status(rig, ch, 7);
}
bool encoder_loss_clears_with_a_0(BitsRig& rig, unsigned ch) {
  lose_encoder(rig, ch);
  rig.pin(ch, kU, true);
  rig.pin(ch, kU, false);  // latched, the cause is gone
  rig.write(true, base(ch), 0x80);
  if (!status(rig, ch, 7)) return false;
  rig.write(true, base(ch), 0);
  return !status(rig, ch, 7);
}

bool encoder_error(BitsRig& rig, unsigned ch) {
  rig.start();
  control(rig, ch, kX4);
  if (status(rig, ch, 8)) return false;
  rig.in.pins[ch - 1] = 3;
  rig.run(BitsRig::kHold);
  return status(rig, ch, 8);
}

bool equ_in_status(BitsRig& rig, unsigned ch) {
  rig.start();
  if (status(rig, ch, 9)) return false;
  control(rig, ch, kEquWrite | kEquState);
  return status(rig, ch, 9);
}

Check captured(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    rig.steps(ch, 2, true);  // A and B high: the gate is open
    control(rig, ch, kX4 | kIndex | kGated);
    if (status(rig, ch, bit)) return false;
    rig.pin(ch, kC, true);
    if (!status(rig, ch, bit)) return false;
    rig.read(true, base(ch) + 3);
    return !status(rig, ch, bit);
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
      if (rig.bit(true, base(ch) + 2, bit) == up) return false;
    }
    return true;
  };
}
Check capture_position(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    if (!captures(rig, ch, kX4 | kFlag, kHmfl)) return false;
    if ((rig.read(true, base(ch) + 3) >> bit & 1) != 0) return false;
    rig.step(ch, false);
    rig.pin(ch, kHmfl, false);
    rig.pin(ch, kHmfl, true);
    return rig.bit(true, base(ch) + 3, bit);
  };
}

// --- Timer words with hardware 1/T: at rest the fraction is 4095 after counts up and 0 after counts down.

void creep(BitsRig& rig, unsigned ch, bool up) {
  rig.steps(ch, 3, up, 30);
  rig.run(300);  // more than the 10 SCLK periods between two counts and the 26 clk_ref of the division
}
Check capture_fraction(unsigned bit) {
  return [bit](BitsRig& rig, unsigned ch) {
    rig.start();
    for (bool up : {true, false}) {
      control(rig, ch, kX4 | kFine | kFlag);
      creep(rig, ch, up);
      rig.read(true, base(ch) + 3);
      rig.pin(ch, kHmfl, true);
      if (rig.bit(false, base(ch), bit) != up) return false;
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
      if (rig.bit(false, base(ch) + 1, bit) != up) return false;
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
      rig.write(true, base(ch) + 7, 0x200000);
      rig.write(false, base(ch) + 7, 0);
      rig.write(true, base(ch) + 6, inc);
      rig.step(ch, true);
      if (rig.peek(true, base(ch) + 7) != ((0x200000 + inc) & 0xFFFFFF)) return false;
    }
    return true;
  };
}

// --- Control word: the words with the bit 0 and 1, and what each does.

using Deed = bool (*)(BitsRig&, unsigned ch, std::uint32_t word);  // starts from reset with `word` in X:+5; true for level 1
Check does(unsigned bit, std::uint32_t rest, Deed deed) {
  return [bit, rest, deed](BitsRig& rig, unsigned ch) {
    for (bool level : {false, true}) {
      rig.start();
      if (deed(rig, ch, rest | (level ? 1u << bit : 0)) != level) return false;
    }
    return true;
  };
}

bool counts_4(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  rig.steps(ch, 4, true);
  return counter(rig, ch) == 4;
}
bool counts_down(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  rig.steps(ch, 4, true);
  return counter(rig, ch) == 0xFFFFFC;
}
bool ignores_a(BitsRig& rig, unsigned ch, std::uint32_t word) {  // A pulses count in mode 0, not in mode 8
  control(rig, ch, word);
  rig.pin(ch, kA, true);
  return counter(rig, ch) == 0;
}
bool no_capture_by_index(BitsRig& rig, unsigned ch, std::uint32_t word) { return !captures(rig, ch, word, kC); }
bool capture_by_index(BitsRig& rig, unsigned ch, std::uint32_t word) { return captures(rig, ch, word, kC); }
bool no_capture_by_home(BitsRig& rig, unsigned ch, std::uint32_t word) { return !captures(rig, ch, word, kHmfl); }
bool holds_0(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  rig.steps(ch, 4, true);
  return counter(rig, ch) == 0;
}
bool equ_rises(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return equ(rig, ch);
}
bool compares_channel_1(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, 1, kX4);
  control(rig, ch, word);
  rig.write(true, base(ch) + 7, kFar);
  rig.step(1, true);
  return equ(rig, ch);
}
bool aena(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return rig.other(kAena, ch);
}
bool c_does_not_reach_its_bit(BitsRig& rig, unsigned ch, std::uint32_t word) {  // AB = 00: the line carries V
  control(rig, ch, word);
  rig.pin(ch, kC, true);
  return !status(rig, ch, 14) && status(rig, ch, 21);
}
bool fractions(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  creep(rig, ch, true);
  rig.latch();
  return rig.peek(false, base(ch) + 1) >> 12 == 0xFFF;
}
bool direction_high(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return rig.other(kDir, ch);
}
// Before the first dead time is over all switches are off.
bool ab_inverted(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return (rig.pwm(ch) & 0xF) == 0xF;
}
bool c_inverted(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return (rig.pwm(ch) & 0x30) == 0x30;
}
bool ab_is_dac(BitsRig& rig, unsigned ch, std::uint32_t word) {  // inverted zeros on the data lines
  control(rig, ch, word);
  return rig.other(kDacA, ch) && rig.other(kDacB, ch) && (rig.pwm(ch) & 0xF) == 0;
}
bool c_is_pfm(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  return rig.other(kPulse, ch) && (rig.pwm(ch) & 0x30) == 0;
}

void add_control(BitTable& table) {
  const auto add = [&](unsigned bit, const char* name, std::uint32_t rest, Deed deed) {
    table.push_back({name, Side::kWritten, true, 5, bit, false, false, does(bit, rest, deed)});
  };
  add(0, "decode x2, x4", 2, counts_4);
  add(1, "decode x1, x4", 1, counts_4);
  add(2, "direction", kX4, counts_down);
  add(3, "pulse from outside, from the PFM", 0, ignores_a);
  add(4, "flag, index and flag", kFlag, no_capture_by_home);
  add(5, "index, index and flag", kIndex, no_capture_by_index);
  add(6, "index invert", kIndex, no_capture_by_index);
  add(7, "flag invert", kFlag, no_capture_by_home);
  add(8, "HMFL, PLIM", kFlag, no_capture_by_home);
  add(9, "HMFL, MLIM", kFlag, no_capture_by_home);
  add(10, "counter reset", kX4, holds_0);
  add(11, "EQU write", kEquState, equ_rises);
  add(12, "EQU state", kEquWrite, equ_rises);
  table.push_back({"compare channel", Side::kWritten, true, 5, 13, false, false, [](BitsRig& rig, unsigned ch) {
                     // Channel 1 is its own channel 1: there only the word itself shows the bit.
                     if (ch != 1) return does(13, 0, compares_channel_1)(rig, ch);
                     for (bool level : {false, true}) {
                       rig.start();
                       control(rig, 1, level ? 1u << 13 : 0);
                       if (rig.bit(true, 5, 13) != level) return false;
                     }
                     return true;
                   }});
  add(14, "amplifier enable", 0, aena);
  add(15, "gated index", kIndex, no_capture_by_index);
  add(16, "gate state", kIndex | kGated, capture_by_index);
  add(17, "de-multiplex", 0, c_does_not_reach_its_bit);
  add(18, "hardware 1/T", kX4, fractions);
  add(19, "PFM direction invert", kPfm, direction_high);
  add(20, "A, B invert", 0, ab_inverted);
  add(21, "C invert", 0, c_inverted);
  add(22, "A, B DAC", kInvertAb, ab_is_dac);
  add(23, "C PFM", kInvertC, c_is_pfm);
}

}  // namespace

void add_read_back(BitTable& table, const char* name, bool x, unsigned offset, bool global, std::uint32_t kept) {
  for (unsigned bit = 0; bit < 24; ++bit) {
    const bool always_0 = (kept >> bit & 1) == 0;
    table.push_back({std::string(name) + " reads back", Side::kRead, x, offset, bit, global, always_0, [=](BitsRig& rig, unsigned ch) {
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
    table.push_back(
        {"status 0", Side::kRead, true, 0, bit, false, true, [bit](BitsRig& rig, unsigned ch) { return reads_0(rig, ch, true, 0, bit); }});
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

  add_control(table);
  add_read_back(table, "control", true, 5, false, 0xFFFFFF & ~kEquWrite);  // that bit has fallen back by then

  for (unsigned bit = 0; bit < 12; ++bit) {
    read_row("captured fraction", false, 0, 12 + bit, capture_fraction(12 + bit));
    read_row("servo fraction", false, 1, 12 + bit, servo_fraction(12 + bit));
    for (bool of_a : {true, false}) {
      const std::string name = of_a ? "fraction of compare A" : "fraction of compare B";
      table.push_back({name, Side::kWritten, false, of_a ? 1u : 0u, bit, false, false, compare_fraction(of_a, bit)});
      table.push_back({name + " reads back", Side::kRead, false, of_a ? 1u : 0u, bit, false, false, fraction_reads_back(of_a, bit)});
    }
  }
}

}  // namespace brick
