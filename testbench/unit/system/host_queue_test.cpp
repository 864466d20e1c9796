// host-bus:8.7/2: the firmware's queue of received characters is full; the next stays in the host port, so that the
// host waits, but for two at each servo interrupt. None is lost.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr double kTicksAServoPeriod = 13057.0 * 4.0;  // at the default clocks, servo-ic:3.1

class HostQueue : public Controller {
 protected:
  unsigned put(const std::string& text) {  // characters that the port took
    unsigned count = 0;
    while (count < text.size() && bus().put_char(static_cast<std::uint8_t>(text[count]), ms_to_ticks(1))) ++count;
    return count;
  }
  std::string take() {
    std::string text;
    while (const auto c = bus().get_char(ms_to_ticks(5))) text.push_back(static_cast<char>(*c));
    return text;
  }
};
INSTANTIATE_TEST_SUITE_P(Engines, HostQueue, ::testing::Values(Engine::kSystemC), engine_name);

TEST_P(HostQueue, FullQueueTakesTwoCharactersAServoInterrupt) {
  start();
  // A reply that nobody reads holds the background up, for half a second (host-bus:8.5/3).
  put("P0..8191\r");
  wait(ms_to_ticks(20));
  constexpr unsigned kFull = 2048 + 2, kLines = 300;  // the queue, HORX and TX
  std::string lines;
  for (unsigned i = 0; i < kLines; ++i) lines += "VERSION\r";
  Tick began = machine().now();
  ASSERT_EQ(put(lines.substr(0, kFull)), kFull);
  EXPECT_LT(machine().now() - began, ms_to_ticks(40));
  began = machine().now();
  const std::string more = lines.substr(kFull);
  ASSERT_EQ(put(more), more.size());
  const double interrupts = static_cast<double>(machine().now() - began) / kTicksAServoPeriod;
  EXPECT_NEAR(interrupts, static_cast<double>(more.size()) / 2.0, 2.0);
  const std::string all = take();
  EXPECT_GT(all.size(), 2u * 8192u);
  unsigned versions = 0;
  for (std::size_t at = all.find("1.947"); at != std::string::npos; at = all.find("1.947", at + 1)) ++versions;
  EXPECT_EQ(versions, kLines);
}

}  // namespace
}  // namespace brick
