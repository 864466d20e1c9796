// The ASCII port and the reports in the dual-ported RAM as host software uses them (host-bus:6.4 to host-bus:6.6), on a
// RAM of words alone: what is written in which order, what is waited for and for how long, what is read where.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "rtl/regs/dpram_map.h"
#include "testbench/host/dpram_reports.h"

namespace brick {
namespace {

using Lines = std::vector<std::string>;

// Time goes by in pauses alone, a tick each; `controller` is called in each, and behind each word that is written.
class FakeRam final : public DpramAccess {
 public:
  std::uint16_t read(std::uint32_t offset) override {
    EXPECT_EQ(offset % 2, 0u);
    return words[offset];
  }
  void write(std::uint32_t offset, std::uint16_t word) override {
    EXPECT_EQ(offset % 2, 0u);
    words[offset] = word;
    written.emplace_back(offset, word);
    if (on_write) on_write(offset);
  }
  Tick now() override { return time; }
  void pause(Tick since, Tick limit) override {
    pauses.emplace_back(since, limit);
    ++time;
    if (on_pause) on_pause();
  }

  void set_item(std::uint32_t offset, std::uint32_t item) {
    words[offset] = static_cast<std::uint16_t>(item);
    words[offset + 2] = static_cast<std::uint16_t>(item >> 16);
  }
  void set_text(const std::string& text) {
    for (std::size_t n = 0; n < text.size(); ++n) {
      std::uint16_t& word = words[static_cast<std::uint32_t>(0x0F44 + n / 2 * 2)];
      const auto byte = static_cast<unsigned char>(text[n]);
      word = static_cast<std::uint16_t>(n % 2 == 0 ? (word & 0xFF00) | byte : (word & 0xFF) | byte << 8);
    }
  }

  std::map<std::uint32_t, std::uint16_t> words;
  std::vector<std::pair<std::uint32_t, std::uint16_t>> written;
  std::vector<std::pair<Tick, Tick>> pauses;
  std::function<void(std::uint32_t)> on_write;
  std::function<void()> on_pause;
  Tick time = 1000;
};

class DpramPortTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kControl = 0x0E9C, kCharacter = 0x0E9E, kText = 0x0EA0, kResponse = 0x0F40;

  // Takes each piece two pauses after it has come, and keeps its 160 bytes as far as they have been written.
  void take_pieces() {
    ram.on_write = [this](std::uint32_t offset) {
      if (offset != kControl) return;
      EXPECT_EQ(ram.words[kControl], 1);
      std::string bytes;
      for (std::size_t n = 0; n + 1 < ram.written.size(); ++n) {
        EXPECT_EQ(ram.written[n].first, kText + 2 * n) << "in order, then the control word";
        bytes += {static_cast<char>(ram.written[n].second), static_cast<char>(ram.written[n].second >> 8)};
      }
      ram.written.clear();
      pieces.push_back(bytes);
      taken_at = ram.time + 2;
    };
    ram.on_pause = [this] {
      if (ram.time >= taken_at) ram.words[kControl] = 0;
    };
  }
  // The controller's answers, each when the one before has been released.
  void answer(std::deque<std::pair<std::uint16_t, std::string>> answers) {
    ram.on_pause = [this, answers]() mutable {
      if (ram.words[kResponse] != 0 || answers.empty()) return;
      const auto [code, text] = answers.front();
      answers.pop_front();
      ram.words[kResponse + 2] = static_cast<std::uint16_t>(text.size() + 1);
      ram.set_text(text + '\0');
      ram.words[kResponse] = code;
    };
  }

  FakeRam ram;
  DpramPort port{ram};
  Lines pieces;
  Tick taken_at = 0;
};

// host-bus:6.6/2, host-bus:6.6/3: 159 characters and NUL; of a longer line no NUL in the 160th byte but in the last
// piece.
TEST_F(DpramPortTest, LinesGoInPiecesOf159Characters) {
  for (const std::size_t length : {0u, 1u, 2u, 3u, 158u, 159u, 160u, 161u, 255u, 318u, 319u}) {
    std::string line;
    for (std::size_t n = 0; n < length; ++n) line += static_cast<char>('A' + n % 23);
    take_pieces();
    pieces.clear();
    ram.words[kControl] = 0;
    ASSERT_TRUE(port.send(line, 10)) << length;
    std::string joined;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      const bool last = n + 1 == pieces.size();
      const std::size_t characters = last ? length - 159 * n : 159;
      EXPECT_EQ(pieces[n].size(), (characters + 2) / 2 * 2) << length;
      EXPECT_EQ(pieces[n][characters] == '\0', last) << length;
      joined += pieces[n].substr(0, characters);
    }
    EXPECT_EQ(joined, line);
    EXPECT_EQ(pieces.size(), length == 0 ? 1 : (length + 158) / 159);
  }
}

// Bit 0 alone says that a command stands in the buffer.
TEST_F(DpramPortTest, ABufferThatIsNotFreeIsWaitedForAndNotWritten) {
  ram.words[kControl] = 0xFFFE;
  EXPECT_TRUE(port.send("P1", 10));
  EXPECT_TRUE(ram.pauses.empty()) << "free";
  ram.written.clear();
  EXPECT_FALSE(port.send("P2", 10)) << "nobody takes the first";
  EXPECT_EQ(ram.time, 1010);
  EXPECT_TRUE(ram.written.empty());
  EXPECT_EQ(ram.pauses, (std::vector<std::pair<Tick, Tick>>(10, {1000, 1010})));
  EXPECT_FALSE(port.command("P2", 10).complete);
  ram.on_pause = [this] { ram.words[kControl] = ram.time == 1030 ? 0 : 1; };
  EXPECT_TRUE(port.send("P2", 10)) << "at the last moment";
}

// host-bus:6.6/4: bits 7..0; true when it has been zeroed.
TEST_F(DpramPortTest, AControlCharacterIsWaitedForUntilItHasActed) {
  ram.words[kCharacter] = 0xFF00;
  ram.on_pause = [this] {
    if (ram.time == 1005) ram.words[kCharacter] = 0;
  };
  EXPECT_TRUE(port.control(0x01, 10));
  EXPECT_EQ(ram.written, (std::vector<std::pair<std::uint32_t, std::uint16_t>>{{kCharacter, 1}}));
  EXPECT_EQ(ram.time, 1005);
  ram.on_pause = nullptr;
  ram.written.clear();
  EXPECT_FALSE(port.control(0x80, 10)) << "it does not act";
  EXPECT_EQ(ram.written.size(), 1u);
  EXPECT_FALSE(port.control(0x02, 10)) << "the one before stands there";
  EXPECT_EQ(ram.written.size(), 1u);
  EXPECT_EQ(ram.time, 1025);
}

// host-bus:6.6/5, host-bus:6.6/6: the word of length, up to NUL or 256 characters; it is the host's until it writes 0.
TEST_F(DpramPortTest, AResponseIsReadAsItStandsAndReleasedOnce) {
  EXPECT_FALSE(port.look());
  ram.words[kResponse] = DPRAM_RESPONSE_LINE;
  ram.words[kResponse + 2] = 4;
  ram.set_text(std::string("abc\0def", 7));
  const auto seen = port.look();
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->code, 0x000D);
  EXPECT_EQ(seen->count, 4);
  EXPECT_EQ(seen->text, "abc");
  EXPECT_TRUE(ram.written.empty()) << "a look leaves it";
  ram.set_text(std::string(256, 'x') + "y");
  EXPECT_EQ(port.take(0)->text, std::string(256, 'x'));
  EXPECT_EQ(ram.written, (std::vector<std::pair<std::uint32_t, std::uint16_t>>{{kResponse, 0}}));
  EXPECT_EQ(ram.time, 1000);
  EXPECT_FALSE(port.take(7));
  EXPECT_EQ(ram.time, 1007);
  EXPECT_EQ(ram.pauses, (std::vector<std::pair<Tick, Tick>>(7, {1000, 1007})));
  EXPECT_EQ(ram.written.size(), 1u) << "nothing is released that nobody has sent";
  answer({{0x000D, "late"}});
  EXPECT_EQ(port.take(1)->text, "late") << "in the last pause";
}

TEST_F(DpramPortTest, AnAnswerEndsWithItsAcknowledgeOrAnError) {
  answer({{0x000D, "25"}, {0x000D, "50"}, {0x0006, ""}, {0x000D, "next"}});
  Reply reply = port.command("P1 P2", 10);
  EXPECT_TRUE(reply.complete);
  EXPECT_FALSE(reply.error);
  EXPECT_EQ(reply.lines, (Lines{"25", "50"}));
  ram.words[kControl] = 0;
  ram.words[kResponse] = 0;
  answer({{0x000D, "25"}, {0x8123, ""}});
  reply = port.command("P1 UUU", 10);
  EXPECT_TRUE(reply.complete && reply.error);
  EXPECT_EQ(reply.lines, (Lines{"25", "ERR123"}));
  answer({{0x8009, ""}});
  EXPECT_EQ(port.finish(10).lines, (Lines{"ERR009"}));
}

// What programs send, and what their commands have answered, in its order and none of the answer; 5 ticks for each
// part.
TEST_F(DpramPortTest, TextsOfProgramsAreNoneOfTheAnswer) {
  answer({{0x020D, "HELLO"}, {0x000D, "25"}, {0x010D, "ERR003"}, {0x0006, ""}});
  const Reply reply = port.finish(5);
  EXPECT_TRUE(reply.complete);
  EXPECT_FALSE(reply.error);
  EXPECT_EQ(reply.lines, Lines{"25"});
  EXPECT_EQ(port.take_unsolicited(), (Lines{"HELLO", "ERR003"}));
  EXPECT_EQ(port.take_unsolicited(), Lines{});
}

TEST_F(DpramPortTest, AnAnswerWithoutAnEndIsNotComplete) {
  answer({{0x000D, "25"}});
  const Reply reply = port.finish(5);
  EXPECT_FALSE(reply.complete);
  EXPECT_EQ(reply.lines, Lines{"25"});
  EXPECT_EQ(ram.time, 1006) << "five more behind what came with the first";
}

// ------------------------------------------------------------------------------------------------------------- reports

using Words = std::vector<std::pair<std::uint32_t, std::uint16_t>>;

// Low half first; of 48 bits 24 in each item, sign-extended; m / 2^35 x 2^(E - 2047) of floating point.
TEST(DpramItems, AreReadAsTheyLie) {
  FakeRam ram;
  DpramReports reports(ram);
  ram.set_item(0x100, 0x89ABCDEF);
  EXPECT_EQ(reports.item(0x100), 0x89ABCDEFu);
  for (const std::int64_t value : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{0xABCDEF},
                                   std::int64_t{-0x123456789AB}, std::int64_t{0x7FFFFFFFFFFF}, -0x800000000000}) {
    for (const std::uint32_t sign : {0x00000000u, 0xFF000000u}) {
      ram.set_item(0x200, static_cast<std::uint32_t>(value & 0xFFFFFF) | sign);
      ram.set_item(0x204, static_cast<std::uint32_t>(value >> 24 & 0xFFFFFF) | sign);
      EXPECT_EQ(reports.fixed_long(0x200), value) << "the upper eight bits do not count";
    }
  }
  for (const auto& [mantissa, exponent] : std::vector<std::pair<std::int64_t, int>>{
           {0x400000000, 2047}, {0x400000000, 2048}, {-0x800000000, 2050}, {0x7FFFFFFFF, 2000}, {0x123456789, 0}}) {
    ram.set_item(0x300, static_cast<std::uint32_t>((mantissa & 0xFFF) << 12) | static_cast<unsigned>(exponent));
    ram.set_item(0x304, static_cast<std::uint32_t>(mantissa >> 12 & 0xFFFFFF));
    EXPECT_EQ(reports.float_long(0x300), std::ldexp(static_cast<double>(mantissa), exponent - 2047 - 35));
  }
}

// Each item has a value that tells its place.
TEST(DpramMotorReports, EachItemStandsWhereTheTableSays) {
  FakeRam ram;
  DpramReports reports(ram);
  const auto word = [](unsigned motor, unsigned item) { return 0x010000u * (motor + 1) + 0x111 * item + 5; };
  for (unsigned motor = 0; motor < 32; ++motor)
    for (unsigned item = 0; item < 12; ++item) ram.set_item(0x74 + 48 * motor + 4 * item, word(motor, item));
  ram.set_item(0x74 + 48 * 3 + 4 * 2, 0xFFFFFFF0);  // -16
  ram.set_item(0x74 + 48 * 3 + 4 * 7, 0xFF800000);
  reports.choose_motors(0x80000009);
  EXPECT_EQ(ram.written, (Words{{0x70, 0x0009}, {0x72, 0x8000}}));
  ram.words[0x6C] = 0x5678;
  ram.words[0x6E] = 0xFF34;
  const auto set = reports.read_motors(10);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->timer, 0x345678u);
  ASSERT_EQ(set->motors.size(), 3u);
  const unsigned chosen[] = {0, 3, 31};
  for (unsigned n = 0; n < 3; ++n) {
    const MotorReport& m = set->motors[n];
    const auto at = [&](unsigned item) { return word(chosen[n], item); };
    const auto pair = [&](unsigned item) { return std::int64_t{at(item)} + (std::int64_t{at(item + 1)} << 24); };
    EXPECT_EQ(m.following_error, pair(0));
    EXPECT_EQ(m.output, n == 1 ? -16 : static_cast<std::int32_t>(at(2)));
    EXPECT_EQ(m.servo_status, at(3));
    EXPECT_EQ(m.status, at(4));
    EXPECT_EQ(m.bias, pair(5));
    EXPECT_EQ(m.velocity, n == 1 ? -0x800000 : static_cast<std::int32_t>(at(7)));
    EXPECT_EQ(m.master, pair(8));
    EXPECT_EQ(m.position, pair(10));
  }
}

TEST(DpramSystemReports, EachItemStandsWhereTheTableSays) {
  FakeRam ram;
  DpramReports reports(ram);
  const auto word = [](unsigned system, unsigned item) { return 0x400000u + 0x10000 * system + 0x111 * item + 7; };
  for (unsigned system = 0; system < 16; ++system)
    for (unsigned item = 0; item < 29; ++item)
      ram.set_item(0x69C + 128 * system + 4 * item, 0xFF000000 | word(system, item));
  ram.set_item(0x688, 0xFF123456);
  ram.set_item(0x68C, 0x00ABCDEF);
  ram.words[0x678] = 0x1234;
  ram.words[0x67A] = 0x80AB;
  reports.choose_systems(2);
  EXPECT_EQ(ram.written, (Words{{0x674, 2}}));
  const auto set = reports.read_systems(10);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->timer, 0xAB1234u);
  EXPECT_EQ(set->global[0], 0x123456u);
  EXPECT_EQ(set->global[1], 0xABCDEFu);
  ASSERT_EQ(set->systems.size(), 2u);
  for (unsigned n = 0; n < 2; ++n) {
    const SystemReport& s = set->systems[n];
    const auto real = [&](unsigned item) {
      const std::uint32_t low = word(n, item), high = word(n, item + 1);
      const double mantissa = static_cast<double>(std::int64_t{high} * 4096 + (low >> 12));
      return std::ldexp(mantissa, static_cast<int>(low & 0xFFF) - 2047 - 35);
    };
    EXPECT_EQ(s.feed_rate, real(0));
    EXPECT_EQ(s.time_base, word(n, 2));
    EXPECT_EQ(s.time_base_source, word(n, 3));
    EXPECT_EQ(s.status[2], word(n, 4));
    EXPECT_EQ(s.status[0], word(n, 5));
    for (unsigned axis = 0; axis < 9; ++axis) EXPECT_EQ(s.targets[axis], real(6 + 2 * axis)) << axis;
    EXPECT_EQ(s.status[1], word(n, 24));
    EXPECT_EQ(s.lines, word(n, 25));
    EXPECT_EQ(s.move_ms_left, word(n, 26));
    EXPECT_EQ(s.acceleration_ms_left, word(n, 27));
    EXPECT_EQ(s.executing, word(n, 28));
  }
}

// host-bus:6.4/4, host-bus:6.4/5: busy, ready is waited for and busy stays, read, release. Without a set in time:
// release.
TEST(DpramReportHandshake, TheHostIsBusyFromBeforeItLooksUntilItHasRead) {
  for (const bool of_motors : {true, false}) {
    FakeRam ram;
    DpramReports reports(ram);
    const std::uint32_t busy = of_motors ? 0x6A : 0x676, ready = of_motors ? 0x6E : 0x67A;
    const auto read = [&](Tick timeout) {
      return of_motors ? reports.read_motors(timeout).has_value() : reports.read_systems(timeout).has_value();
    };
    ram.words[ready] = 0x7FFF;
    EXPECT_FALSE(read(10));
    EXPECT_EQ(ram.time, 1010);
    EXPECT_EQ(ram.pauses, (std::vector<std::pair<Tick, Tick>>(10, {1000, 1010})));
    EXPECT_EQ(ram.written, (Words{{busy, 0x8000}, {busy, 0}}));
    ram.written.clear();
    ram.on_pause = [&] {
      EXPECT_EQ(ram.words[busy], 0x8000);
      if (ram.time == 1020) ram.words[ready] = 0x8000;
    };
    EXPECT_TRUE(read(10)) << "at the last moment";
    EXPECT_EQ(ram.written, (Words{{busy, 0x8000}, {busy, 0}}));
    EXPECT_TRUE(read(0)) << "ready already";
    EXPECT_EQ(ram.time, 1020);
    ram.words[ready] = 0;
    DpramReports careless(ram, false);
    ram.written.clear();
    if (of_motors) {
      EXPECT_TRUE(careless.read_motors(0));
    } else {
      EXPECT_TRUE(careless.read_systems(0));
    }
    EXPECT_EQ(ram.written, (Words{{busy, 0}})) << "one that does not heed them";
  }
  FakeRam ram;
  DpramReports reports(ram);
  reports.clear_handshakes();
  EXPECT_EQ(ram.written, (Words{{0x6A, 0}, {0x6E, 0}, {0x676, 0}, {0x67A, 0}}));
}

}  // namespace
}  // namespace brick
