// The words of systemc/cosim/drive.h mean the same on both sides: each bit of each field is changed alone, the RTL
// moves its pins by that, and as the model does, which knows the field by its name and not by its place.
#include <gtest/gtest.h>

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/cosim/drive.h"
#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/distorted_board.h"

namespace brick {
namespace {

using Edit = std::function<void(BoardInputs&)>;
using Changes = std::vector<std::pair<Tick, BoardOutputs>>;

// Both engines, with what somebody else drives distorted on its way.
std::unique_ptr<DistortedBoard> distorted(std::uint32_t fitted, Edit edit, Changes& changes) {
  auto board = std::make_unique<DistortedBoard>(make_lockstep_board(make_rtl_board(fitted), make_model_board(fitted)));
  board->distort = std::move(edit);
  board->on_change = [&changes](Tick t, const BoardOutputs&, const BoardOutputs& after) {
    changes.emplace_back(t, after);
  };
  return board;
}

// Random accesses from both sides, with a control panel and clocks from outside.
Changes traffic(const Edit& edit) {
  constexpr Tick kEnd = 40'000;
  Changes changes;
  const auto board = distorted(0x3, edit, changes);
  BoardTraffic traffic(2, {0, true});
  while (traffic.next() < kEnd) {
    board->run_until(traffic.next(), {});
    traffic.change();
    BoardInputs in = traffic.inputs();
    in.ext_clock = in.jpan_fitted = true;
    in.dpram_small = false;
    in.line_select = board->now() < kEnd / 2 ? 0xEDC : 0xF51;  // all lines that come from outside
    in.slot8 = board->now() >= kEnd / 2;  // SA[19:17] count on an 8-bit slot only, LA[23:20] on the other
    board->set_inputs(in);
  }
  return changes;
}

// Every IC is read, each kind of a MACRO IC shows itself, EQU of every channel can be chosen as an interrupt.
Changes census(const Edit& edit) {
  constexpr std::uint32_t kAll = (1u << regs::kGateIcs.size()) - 1;
  constexpr regs::Register kMacroOnly = regs::macro_ic::kSupplementary1, kControl = regs::servo_channel::kControl;
  namespace control = regs::servo_channel::control;
  Changes changes;
  BoardRig rig(distorted(kAll, edit, changes), kAll);
  rig.in.line_select = 0;
  for (unsigned channel = 0; channel < 8; ++channel)
    rig.write(true, regs::kGateIcs[channel / 4].base + 8 * (channel % 4) + kControl.address,
              control::kEquWrite.at(1) | control::kEquState.at(1));
  for (const regs::GateIc& ic : regs::kGateIcs) {
    if (ic.macro) rig.write(true, ic.base + kMacroOnly.address, kMacroOnly.written);
    rig.read(true, ic.base + (ic.macro ? kMacroOnly : regs::servo_ic::kClockControl).address);
  }
  return changes;
}

// A frame on every channel of the serial encoder inputs of a Geo Brick LV, from a fall of SERVO; then all words are
// read.
Changes frames(const Edit& edit) {
  Changes changes;
  BoardRig rig(distorted(0x3, edit, changes), 0x3);
  rig.in.ext_clock = true;
  rig.in.ssi_kind = 2;
  rig.apply();
  rig.run(20);
  for (unsigned group = 0; group < 2; ++group) rig.write(true, regs::ssi_brick::kTiming.address + 0x10 * group, 0x302);
  for (unsigned n = 0; n < 8; ++n) rig.write(true, regs::ssi_brick::kControl.address + 4 * n, 0x140C);
  rig.in.ext_servo = false;
  rig.apply();
  rig.run(1000);
  for (unsigned n = 0; n < 8; ++n) rig.read(false, regs::ssi_brick::kPosition.address + 4 * n);
  return changes;
}

// No board has two strobes of a bus at once: a strobe is held idle instead.
template <class Field>
void change(BoardInputs& in, const Field& field, unsigned bit) {
  using Value = std::decay_t<decltype(in.*field.pin)>;
  constexpr std::string_view kStrobes[] = {"pa_rd_n", "pa_wr_n", "isa_ior_n", "isa_iow_n", "isa_memr_n", "isa_memw_n"};
  for (const std::string_view strobe : kStrobes)
    if (field.name == strobe) return void(in.*field.pin = true);
  in.*field.pin = static_cast<Value>(in.*field.pin ^ 1u << bit);
}

TEST(InputLayout, EachBitOfEachFieldReachesTheRtlAsTheModel) {
  const Edit none = [](BoardInputs&) {};
  const Changes usual_traffic = traffic(none), usual_census = census(none), usual_frames = frames(none);
  const auto check = [&](const auto& field) {
    const bool encoders = field.name == "ssi_kind" || field.name == "ssi_data";
    const bool straps = field.name == "fitted" || field.name == "macro_gate" || field.name == "line_select";
    for (unsigned bit = 0; bit < field.width; ++bit) {
      SCOPED_TRACE(::testing::Message() << field.name << " bit " << bit);
      const Edit edit = [&](BoardInputs& in) { change(in, field, bit); };
      try {
        EXPECT_TRUE(encoders ? frames(edit) != usual_frames
                    : straps ? census(edit) != usual_census
                             : traffic(edit) != usual_traffic)
            << "nothing moved";
      } catch (const LockstepDifference& e) { ADD_FAILURE() << e.what(); }
    }
  };
  std::apply([&](const auto&... field) { (check(field), ...); }, kInputFields);
}

TEST(InputLayout, EachPinHasOnePlace) {
  // Port A: A, D, AA, X, internal, two strobes. ISA: LA, SA, SD, seven lines; its switches and window. Connectors:
  // JPAN, two clocks, four interrupt lines, 5 V good, eight encoders. Straps: ICs, kinds of MACRO ICs, three digits of
  // sources, kind of interrupt controller, three jumpers, kind of encoder inputs.
  constexpr unsigned kPins = (19 + 24 + 4 + 1 + 1 + 2) + (7 + 20 + 16 + 7) + (8 + 10 + 3) + (16 + 2 + 4 + 1 + 8) +
                             (22 + 4 + 3 * 4 + 1 + 3 + 2);
  unsigned pins = 0;
  BoardInputWords taken{};
  const auto check = [&](const auto& field) {
    ASSERT_LT(field.word, kBoardInputWords) << field.name;
    ASSERT_LE(field.lsb + field.width, 32u) << field.name;
    const std::uint32_t place = pin_mask(field.width) << field.lsb;
    EXPECT_EQ(taken[field.word] & place, 0u) << field.name;
    taken[field.word] |= place;
    pins += field.width;
  };
  std::apply([&](const auto&... field) { (check(field), ...); }, kInputFields);
  EXPECT_EQ(pins, kPins);
}

}  // namespace
}  // namespace brick
