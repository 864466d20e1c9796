// The binary rotary transfer with a host that writes whatever it likes, at any time.
#include "testbench/unit/firmware_program/binary_fixture.h"
#include "testbench/unit/random_seed.h"

namespace binary_rotary {
namespace {

// A host that writes whatever it likes, at any time. BRICK_BINARY_STEPS: of each seed.
class HostileHost {
 public:
  explicit HostileHost(unsigned seed) : random_(seed) {
    for (unsigned cs = 1; cs <= 2; ++cs) {
      buffers_[cs - 1].cs = cs;
      buffers_[cs - 1].start = 80 * cs;
    }
  }

  void step() {
    Buffer& buffer = buffers_[below(2)];
    switch (below(12)) {
      case 0:
        buffer.write(2 * below(6), one_in(3) ? random_() & 0xFFFF : below(80));
        break;
      case 1:
        buffer.command(below(buffer.size),
                       {static_cast<std::uint32_t>(random_()), static_cast<std::uint32_t>(random_())});
        break;
      case 2:
        dpram_write(DPRAM_ROTARY_HEADERS + 2 * below(96), random_() & 0xFFFF);
        break;
      case 3:
        buffer.size = 2 * (3 + below(40));
        buffer.set_up();
        break;
      case 4: {
        static const char* const commands[] = {"&1",
                                               "&2",
                                               "I45=0",
                                               "I45=1",
                                               "CLEAR",
                                               "CLOSE",
                                               "OPEN BIN ROT",
                                               "&1B0R",
                                               "A",
                                               "&1 A &2 A CLOSE DEL ALL TEMPS &2 DEF ROT 9 &1 DEF ROT 30 OPEN BIN ROT",
                                               "OPEN ROT",
                                               "LIST ROT",
                                               "LIST PC",
                                               "Q",
                                               "DEL ROT",
                                               "DEF ROT 12",
                                               "I17=3"};
        (void)host(commands[below(17)]);
        break;
      }
      case 5:
        platform::background(1);
        break;
      case 6:
        platform::pass_us(200);
        platform::servo_ticks(1 + below(4));
        break;
      default: {
        const std::vector<BinaryCommand> line = binary_line(text()).commands;
        if (one_in(8) || buffer.has_room(line)) buffer.put(line);
        platform::background(1);
        break;
      }
    }
  }

 private:
  unsigned below(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(random_); }
  bool one_in(unsigned n) { return below(n) == 0; }
  std::string text() {
    std::string line;
    for (unsigned i = 0, count = 1 + below(4); i < count; ++i)
      line += std::vector<std::string>{"X1", "P5000=2", "F10", "Y-2^1", "M3==1", "DWELL1", "INC(X,R)", "N7"}[below(8)] +
              " ";
    return line;
  }

  std::mt19937 random_;
  Buffer buffers_[2];
};

// Empty when each word of the ring belongs to a line that could have come as text, and they are counted right.
std::string wrong_in_ring(unsigned cs) {
  const rotary& r = rotary_buffers[cs - 1];
  if (r.used > r.size || (r.size != 0 && (r.write >= r.size || r.read >= r.size))) return "indices";
  binary_judge line{};
  unsigned lines = 0;
  bool is_first = true;
  for (const word48_t word : ring(cs)) {
    const bool begins = (word & WORD_START_OF_LINE) != 0;
    if (is_first && !begins) line.begun = line.called = true;  // under calculation
    if (is_first || begins) ++lines;
    if (begins) line = {};
    if (begins && !is_first && binary_judge_end(&line) != BINARY_GOOD) return "a line without its end";
    const bool follows_unseen = is_first && !begins;
    if (binary_judge_word(&line, word) != BINARY_GOOD && !follows_unseen)
      return "a word that is none: " + std::to_string(word);
    is_first = false;
  }
  return lines == r.lines ? "" : std::to_string(r.lines) + " lines counted, " + std::to_string(lines) + " are there";
}

TEST_F(BinaryRotary, NothingAHostWritesDoesHarm) {
  BRICK_COVERS("BIN-3 BIN-6");
  constexpr word48_t kMark = 0x123456789ABC;
  const char* wanted = std::getenv("BRICK_BINARY_STEPS");
  const unsigned steps = wanted != nullptr ? static_cast<unsigned>(std::strtoul(wanted, nullptr, 10)) : 4000;
  unsigned long stored = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    platform::power_up();
    SetUp();
    for (std::uint32_t i = 0; i < USER_MEMORY_WORDS; ++i) user_memory_write(i, kMark);
    open("&2 DEF ROT 9 &1 DEF ROT 30");
    HostileHost hostile(brick::random_seed(seed));
    for (unsigned i = 0; i < steps; ++i) {
      hostile.step();
      for (unsigned cs = 1; cs <= 2; ++cs) {
        const std::uint32_t state = hal_mask_real_time();
        const std::string wrong = wrong_in_ring(cs);
        hal_unmask(state);
        ASSERT_EQ(wrong, "") << "&" << cs << " seed " << seed << " step " << i;
      }
      stored += rotary_buffers[0].lines;
    }
    for (std::uint32_t i = 0; i < USER_MEMORY_WORDS - 100; ++i) ASSERT_EQ(user_memory_read(i), kMark) << i;
  }
  EXPECT_GT(stored, 1000u) << "hardly a line came in";
}

}  // namespace
}  // namespace binary_rotary
