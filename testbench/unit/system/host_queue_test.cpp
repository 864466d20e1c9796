// host-bus:8.7/2: the firmware's queue of received characters is full; the next one stays in the host port, so that the
// host waits, and none is lost.
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

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

TEST_P(HostQueue, FullQueueLeavesTheWordInThePort) {
  start();
  // A reply that nobody reads holds the background up, for half a second (host-bus:8.5/1).
  put("P0..8191\r");
  wait(ms_to_ticks(20));
  std::string lines;
  for (unsigned i = 0; i < 300; ++i) lines += "VERSION\r";
  const unsigned taken = put(lines);
  EXPECT_EQ(taken, 2048u + 2u) << "the queue, HORX and TX";
  const std::string reply = take();
  EXPECT_GT(reply.size(), 2u * 8192u);
  EXPECT_EQ(put(lines.substr(taken, 8 - taken % 8)), 8 - taken % 8);
  const std::string all = reply + take();
  unsigned versions = 0;
  for (std::size_t at = all.find("1.947"); at != std::string::npos; at = all.find("1.947", at + 1)) ++versions;
  EXPECT_EQ(versions, taken / 8 + 1);
}

}  // namespace
}  // namespace brick
