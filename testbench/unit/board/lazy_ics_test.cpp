// An IC that nobody looked at for long is where one is that was looked at all the time: pins and every register, with
// clocks that repeat (the IC jumps), change, come from outside or stop.
#include <gtest/gtest.h>

#include <random>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick {
namespace {

constexpr std::uint32_t kThreeIcs = 0x7;

class LazyIcs : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  // Asks for everything, changing nothing but the state of the capture. Equal on both boards.
  static std::vector<std::uint32_t> everything(BoardRig& rig) {
    std::vector<std::uint32_t> all;
    for (unsigned ic = 0; ic < 3; ++ic) {
      const MotorOutputs o = rig.board().motor_outputs(ic);
      all.insert(all.end(), o.w.begin(), o.w.end());
    }
    for (const auto base : kServoIcBase)
      for (unsigned word = 0; word < 64; ++word) all.push_back(rig.read(word < 32, base + word % 32));
    MotorDigest& digest = *rig.board().motor_digest();
    for (unsigned ic = 0; ic < 3; ++ic) {
      for (unsigned channel = 0; channel < kChannels; ++channel) {
        const PwmTimes times = digest.pwm_times(ic, channel);
        for (const Tick balance : times.balance) all.push_back(static_cast<std::uint32_t>(balance));
        all.push_back(static_cast<std::uint32_t>(times.shorts));
      }
      const ConverterWords lines = digest.dac_lines(ic);
      all.insert(all.end(), lines.begin(), lines.end());
      const MotorDigest::AdcStream stream = digest.adc_stream(ic);
      const Tick end = std::max(stream.end, rig.now());  // of one that is over nobody asks
      for (const std::int64_t part : {stream.clocks, std::int64_t{stream.strobe}, std::int64_t{stream.first}, end})
        all.push_back(static_cast<std::uint32_t>(part));
      for (const bool b : {false, true}) all.push_back(digest.adc_lines(ic, b));
    }
    return all;
  }
  void compare() {
    ASSERT_EQ(lazy.now(), eager.now());
    const std::vector<std::uint32_t> a = everything(lazy), b = everything(eager);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (i < 18)
        ASSERT_EQ(a[i], b[i]) << "IC " << i / 6 << " word " << i % 6 << " of the pins before tick " << lazy.now();
      else if (i >= 18 + 3 * 64)
        ASSERT_EQ(a[i], b[i]) << "IC " << (i - 18 - 3 * 64) / 30 << " word " << (i - 18 - 3 * 64) % 30
                              << " of the digest at tick " << lazy.now();
      else
        ASSERT_EQ(a[i], b[i]) << "IC " << (i - 18) / 64 << " register " << (i - 18) % 64 << " before tick "
                              << lazy.now();
    }
  }
  template <class Do>
  void both(Do what) {
    what(lazy);
    what(eager);
  }
  // The eager board is asked so often that no IC of it ever has two edges of a clock to catch up with.
  void run(Tick ticks) {
    lazy.run(ticks);
    const Tick end = eager.now() + ticks;
    while (eager.now() < end) {
      eager.run(std::min<Tick>(end - eager.now(), 97));
      for (unsigned ic = 0; ic < 3; ++ic) eager.board().motor_outputs(ic);
    }
  }
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random() % below); }
  void write(bool x, std::uint32_t address, std::uint32_t value) {
    both([&](BoardRig& rig) { rig.write(x, address, value); });
  }

  std::mt19937_64 random{random_seed(GetParam())};
  BoardRig lazy{make_model_board(kThreeIcs), kThreeIcs}, eager{make_model_board(kThreeIcs), kThreeIcs};
};

TEST_P(LazyIcs, AreWhereEagerOnesAre) {
  const std::uint32_t source = pick(3);
  for (std::uint32_t ic = 0; ic < 3; ++ic) {
    const std::uint32_t max_count = pick(2) != 0 ? 6527 : 500 + pick(3000);
    write(true, kServoIcBase[ic] + 0x1C, max_count << 8 | pick(40));
    write(true, kServoIcBase[ic] + 4,
          0x0008D2 | pick(3) << 16 | pick(4) << 20 |
              (ic == source   ? 0
               : pick(8) == 0 ? 2
                              : 3)
                  << 12 |
              pick(64));
    for (std::uint32_t channel = 0; channel < 4; ++channel) {
      std::uint32_t control = pick(1u << 24) & ~0x40F;
      control |= pick(3) == 0 ? 8 : 3;
      if (pick(2) != 0) control &= ~0x800000u;  // no PFM
      write(true, kServoIcBase[ic] + 8 * channel + 5, control);
      for (std::uint32_t out = 2; out < 5; ++out)
        write(false, kServoIcBase[ic] + 8 * channel + out, pick(1u << 24) >> pick(12));
    }
  }
  for (int round = 0; round < 6; ++round) {
    const std::uint32_t ic = pick(3);
    MotorInputs motor;
    for (std::uint16_t& pins : motor.pins) pins = static_cast<std::uint16_t>(pick(1u << kChannelPins));
    motor.adc_a = static_cast<std::uint8_t>(pick(16));
    motor.adc_b = static_cast<std::uint8_t>(pick(16));
    both([&](BoardRig& rig) { rig.board().set_motor_inputs(ic, motor); });
    if (pick(3) == 0) {  // in place of the pins
      ConverterWords words;
      for (std::uint32_t& word : words) word = pick(1u << 24);
      both([&](BoardRig& rig) { rig.board().motor_digest()->send_adc(ic, words); });
    }
    write(true, kWatchdogStrobe, 0);
    run(200'000 + static_cast<Tick>(pick(2'000'000)));
    compare();
    if (HasFatalFailure()) return;
    if (round == 2) write(true, kServoIcBase[source] + 0x1C, (400 + pick(3000)) << 8 | 15);
    if (round == 3) write(true, kServoIcBase[source] + 4, 0x3008D2 | pick(2) << 12);
  }
}

TEST_P(LazyIcs, FollowClocksFromOutside) {
  const auto clocks = [&](bool phase, bool servo) {
    both([&](BoardRig& rig) {
      rig.in.ext_clock = true;
      rig.in.ext_phase = phase;
      rig.in.ext_servo = servo;
      rig.apply();
    });
  };
  const Tick half = 6000 + pick(1000);
  const bool regular = GetParam() % 2 == 0;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 120; ++i) {
      clocks(i % 2 == 0, i / 4 % 2 == 0);
      // The lazy board's ICs are not asked meanwhile.
      run(regular ? half : half + pick(40));
    }
    compare();
    if (HasFatalFailure()) return;
    run(pick(100'000));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LazyIcs, ::testing::Range<std::uint64_t>(1, 7));

}  // namespace
}  // namespace brick
