// Drivers of PHASE and SERVO in the model, any two of them: who wins, and when they have fought too long
// (servo-ic:7.2/5).
#include <gtest/gtest.h>

#include "systemc/board/clock_select.h"

namespace brick {
namespace {

constexpr unsigned kIcs = 22;  // servo IC m, m* at m + 8, MACRO IC i at 18 + i
constexpr Tick kTaken = 3;     // the first edge of clk_ref takes the drivers

class Nets {
 public:
  Nets(bool servo, std::uint32_t drivers, std::uint32_t low, bool ext = false, bool ext_level = true) : servo_(servo) {
    select_.reset(0);
    (servo ? select_.in.servo : select_.in.phase) = drivers;
    (servo ? select_.servo_level : select_.phase_level) = ~low;
    select_.in.ext = ext;
    (servo ? select_.ext_servo : select_.ext_phase) = ext_level;
  }
  void run_to(Tick end) {
    while (now_ < end) select_.advance(++now_);
  }
  bool net() const { return servo_ ? select_.servo() : select_.phase(); }
  bool other_net() const { return servo_ ? select_.phase() : select_.servo(); }
  bool conflict() const { return select_.conflict(); }
  std::uint32_t source() const { return select_.phase_source(); }
  void leave(std::uint32_t drivers) { (servo_ ? select_.in.servo : select_.in.phase) = drivers; }

 private:
  const bool servo_;
  ClockSelect select_{sc_core::sc_gen_unique_name("select")};
  Tick now_ = 0;
};

// Two edges see them disagree, the third shows it; it is over when one is left, an edge of clk_ref later.
TEST(ClockSelectModel, AnyTwoDriversFightAndTheLowestWins) {
  for (const bool servo : {false, true})
    for (unsigned a = 0; a < kIcs; ++a)
      for (unsigned b = a + 1; b < kIcs; ++b)
        for (const std::uint32_t low : {1u << a, 1u << b}) {
          SCOPED_TRACE(::testing::Message() << (servo ? "SERVO of " : "PHASE of ") << a << " and " << b);
          Nets nets(servo, 1u << a | 1u << b, low);
          nets.run_to(kTaken + 2);
          ASSERT_FALSE(nets.conflict());
          ASSERT_EQ(nets.net(), low != 1u << a);
          ASSERT_TRUE(nets.other_net());
          nets.run_to(kTaken + 3);
          ASSERT_TRUE(nets.conflict());
          ASSERT_EQ(nets.source(), servo ? regs::clock_source::kNone : a);
          nets.leave(1u << b);
          nets.run_to(3 * kTaken);
          ASSERT_FALSE(nets.conflict());
          nets.run_to(3 * kTaken + 1);
          ASSERT_EQ(nets.net(), low != 1u << b);
        }
}

// Whoever is left, the conflict is over: two that join him and agree do not find it. A reset lets all drivers go.
TEST(ClockSelectModel, AConflictIsOverWithOneDriver) {
  for (const bool servo : {false, true})
    for (const unsigned left : {0u, 1u, 5u}) {
      SCOPED_TRACE(::testing::Message() << (servo ? "SERVO" : "PHASE") << ", IC " << left);
      ClockSelect select(sc_core::sc_gen_unique_name("select"));
      std::uint32_t &drivers = servo ? select.in.servo : select.in.phase,
                    &level = servo ? select.servo_level : select.phase_level;
      Tick now = 0;
      const auto run = [&](Tick ticks) {
        for (const Tick end = now + ticks; now < end;) select.advance(++now);
      };
      select.reset(0);
      drivers = 1u << left | 1u << 7;
      level = ~(1u << left);
      run(20);
      ASSERT_TRUE(select.conflict());
      drivers = 1u << left;
      run(20);
      level = ~0u;
      run(20);
      drivers = 1u << left | 1u << 7 | 1u << 9;
      run(20);
      EXPECT_FALSE(select.conflict());
      level = ~(1u << left);
      run(20);
      ASSERT_TRUE(select.conflict());
      select.reset(now);
      EXPECT_FALSE(select.conflict());
      EXPECT_EQ(select.phase_source(), std::uint32_t{regs::clock_source::kNone});
      EXPECT_TRUE(servo ? select.servo() : select.phase());
      level = ~0u;
      run(20);
      EXPECT_FALSE(select.conflict());
    }
}

TEST(ClockSelectModel, TwoThatAgreeDoNotFight) {
  for (const std::uint32_t low : {0u, 0x3u}) {
    Nets nets(false, 0x3, low);
    nets.run_to(100);
    EXPECT_FALSE(nets.conflict());
    EXPECT_EQ(nets.net(), low == 0);
  }
}

// Jumper E1: what comes from outside is the net, and each IC that drives is a second driver.
TEST(ClockSelectModel, AnyDriverFightsWithClocksFromOutside) {
  for (const bool servo : {false, true})
    for (unsigned ic = 0; ic < kIcs; ++ic)
      for (const bool outside : {false, true})
        for (const bool level : {false, true}) {
          SCOPED_TRACE(::testing::Message() << servo << ", IC " << ic << " is " << level << ", outside " << outside);
          Nets nets(servo, 1u << ic, level ? 0 : 1u << ic, true, outside);
          nets.run_to(20);
          ASSERT_EQ(nets.conflict(), level != outside);
          ASSERT_EQ(nets.net(), outside);
          ASSERT_EQ(nets.source(), std::uint32_t{regs::clock_source::kOutside});
        }
}

}  // namespace
}  // namespace brick
