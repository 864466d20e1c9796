// The control word of a channel: words with the bit 0 and 1, and what each does.
#include "testbench/unit/register_bits/channel_checks.h"

namespace brick {
namespace {

using Deed = bool (*)(BitsRig&, unsigned ch,
                      std::uint32_t word);  // starts from reset with `word` in X:+5; true for level 1
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
  rig.write(ch, words::kCompareB, kFar);
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
  return !status(rig, ch, status_bit::kChc) && status(rig, ch, status_bit::kFlagV);
}
bool fractions(BitsRig& rig, unsigned ch, std::uint32_t word) {
  control(rig, ch, word);
  creep(rig, ch, true);
  rig.latch();
  return fine2::kServo.get(rig.peek(ch, words::kTimer2)) == 0xFFF;
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

}  // namespace

void add_control_rows(BitTable& table) {
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
  add_read_back(table, "control", true, 5, false, 0xFFFFFF & ~kEquWrite);  // that bit has fallen back by then
}

}  // namespace brick
