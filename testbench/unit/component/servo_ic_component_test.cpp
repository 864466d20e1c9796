// The servo IC's component against the IC inside: every change of every pin, every word read, each at its time, for
// each engine and whatever the initiator's quantum.
#include <gtest/gtest.h>

#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

void servo_ic_agrees(const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed,
                     const Binds& binds = all, Tick ticks = kTicks) {
  ServoIcBlock block;
  const auto least = static_cast<std::size_t>(ticks / 500);
  agrees<ServoIc>(block, servo_ic_traffic(seed, ticks), engine, quantum, 4, binds, least,
                  binds("dac_clk") ? least : 100);
}

TEST(ServoIcComponent, AgreesWithTheBlock) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    servo_ic_agrees(engine, quantum, seed);
  });
}
TEST(ServoIcComponent, UnboundPinsAreIdle) {
  BRICK_COVERS("CARD-1");
  const Binds few = [](const std::string& pin) {
    return pin == "ch2_enc_a" || pin == "ch2_enc_b" || pin == "phase_o" || pin == "ch2_equ" || pin == "ch4_pwm_b_top";
  };
  for (const Engine& engine : {model_engine(), rtl_engine()})
    in_own_process([&] { servo_ic_agrees(engine, sc_core::SC_ZERO_TIME, 5, few, kTicks / 4); });
}

// The comparison sees one unit of the kernel's time and one bit.
TEST(ServoIcComponent, OneWrongChangeIsFound) {
  ServoIcBlock block;
  const Traffic traffic = servo_ic_traffic(1, 20'000);
  const Seen right = run(block, traffic);
  ASSERT_GT(right.changes.size(), 50u);
  ASSERT_GT(right.answers.size(), 50u);
  Seen late = right, bit = right, lost = right;
  ++std::get<0>(late.changes[20]);
  bit.answers[30].second ^= 1;
  lost.changes.erase(lost.changes.begin() + 40);
  EXPECT_EQ(difference(right, right, traffic.end, all), "");
  EXPECT_EQ(difference(late, right, traffic.end, all).rfind("change ", 0), 0u);
  EXPECT_EQ(difference(bit, right, traffic.end, all).rfind("access 30: ", 0), 0u);
  EXPECT_NE(difference(lost, right, traffic.end, all), "");
}

}  // namespace
}  // namespace brick::component
