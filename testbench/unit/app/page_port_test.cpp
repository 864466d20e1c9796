// The page as a client of the communications processor: answers in order, long ones, and clients that go.
#include "app/page/page_port.h"

#include "testbench/unit/host_library/communications_fixture.h"

namespace brick {
namespace {

class PagePortTest : public CommunicationsProcessorTest {
 protected:
  PagePortTest() {
    processor_->on_reply = [this](CommunicationsProcessor::Client client, const Bytes& reply) {
      ASSERT_TRUE(PagePort::is_page(client));
      port_.reply(client, reply);
    };
  }
  void ask(unsigned page, const Bytes& line) {
    port_.command(PagePort::kFirst + page, line,
                  [this, page](const Bytes& answer) { answers_.emplace_back(page, answer); });
  }

  PagePort port_{*processor_};
  Replies answers_;
};

TEST_F(PagePortTest, EachCommandHasItsAnswerInTheOrderOfItsPage) {
  ask(1, "one");
  ask(1, "bad");
  ask(2, "two");
  ask(1, "=");
  run(200 * kMs);
  Replies first, second;
  for (const auto& answer : answers_) (answer.first == 1 ? first : second).push_back(answer);
  EXPECT_EQ(first, (Replies{{1, "one\r\x06"},
                            {1,
                             "\x07"
                             "ERR003\r"},
                            {1, "\x06"}}));
  EXPECT_EQ(second, (Replies{{2, "two\r\x06"}}));
}

// In pieces of 1400 bytes, ethernet:4/4.
TEST_F(PagePortTest, ALongAnswerIsFetchedToItsEnd) {
  ask(1, "long");
  ask(1, "next");
  run(400 * kMs);
  EXPECT_EQ(answers_, (Replies{{1, Bytes(3000, 'x') + "\r\x06"}, {1, "next\r\x06"}}));
}

TEST_F(PagePortTest, OfAnAnswerThatIsTooLongTheRestIsCutOff) {
  const Bytes longer(PagePort::kLongestAnswer + 5000, 'y');
  fake().controller = [&](const Bytes& line) { return line == "longer" ? longer + "\r\x06" : line + "\r\x06"; };
  ask(1, "longer");
  ask(1, "next");
  run(3000 * kMs);
  ASSERT_EQ(answers_.size(), 2u);
  EXPECT_GE(answers_[0].second.size(), PagePort::kLongestAnswer);
  EXPECT_LT(answers_[0].second.size(), longer.size());
  EXPECT_EQ(answers_[1].second, "next\r\x06");
}

TEST_F(PagePortTest, APageThatGoesIsToldNothingMore) {
  fake().thinking = 50 * kMs;
  ask(1, "slow");
  ask(1, "never asked");
  run(10 * kMs);
  port_.close(PagePort::kFirst + 1);
  ask(2, "here");
  run(300 * kMs);
  EXPECT_EQ(answers_, (Replies{{2, "here\r\x06"}}));
  EXPECT_EQ(lines_, (Lines{"slow", "here"}));
}

}  // namespace
}  // namespace brick
