// Streams of program lines into rotary and fixed buffers: none is lost, doubled or reordered, whether the host heeds
// BREQ or not, with `&n` and resets in between, through the host port or the dual-ported RAM. Each line leaves a trace
// of its own: it writes its number to the next place of its coordinate system and counts, so the scoreboard knows
// nothing of buffers. Binary lines have constants only: a fixed program does that for them.
#include <cstdlib>
#include <random>

#include "testbench/host/binary_rotary.h"
#include "testbench/host/dpram_port.h"
#include "testbench/unit/random_seed.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr unsigned kPlaces = 500, kSystems = 2, kBlock = 200;
constexpr unsigned kBreqLine = 1;  // bit of SIG

enum class Route { kAscii, kBinary };
enum class Fault { kNone, kLost, kDoubled, kSwapped };

class StreamOn : public Controller {
 protected:
  // BRICK_STREAM_LINES: lines of each stream.
  long lines(long on_systemc = 2000, long in_lockstep = night() ? 100 : 50) const {
    const char* wanted = std::getenv("BRICK_STREAM_LINES");
    if (wanted != nullptr) return std::strtol(wanted, nullptr, 10);
    return GetParam() == Engine::kSystemC ? on_systemc : in_lockstep;
  }

  // By the route that is tested.
  std::string ask(const std::string& line) {
    if (!by_ram_) return Controller::ask(line);
    const Reply reply = DpramPort(*ram_).command(line);
    EXPECT_TRUE(reply.complete) << "no complete answer to " << line;
    std::string joined;
    for (const auto& part : reply.lines) joined += (joined.empty() ? "" : "|") + part;
    return joined;
  }
  void use_ram() {
    ASSERT_EQ(ask("I58=1 SAVE"), "");
    ram_ = std::make_unique<BusDpram>(bus());
    by_ram_ = true;
    wait(ms_to_ticks(3));  // a pass of the background
  }

  std::string text(unsigned cs, long number) const {
    if (route_ == Route::kBinary) return "Q1=" + std::to_string(number) + "CALL7";
    const std::string count = "P" + std::to_string(cs);
    return "P(" + std::to_string(1000 * cs) + "+" + count + ")=" + std::to_string(number) + count + "=" + count + "+1";
  }

  // As a host that heeds BREQ: it writes when there is room; else it writes and repeats what is refused.
  void put(const std::string& line) {
    if (heeds_) {
      for (unsigned tries = 0; (bus().read_pic_signals() >> kBreqLine & 1) == 0; ++tries) {
        ASSERT_LT(tries, 100000u) << "BREQ stays low";
        wait(ms_to_ticks(1) / 10);
      }
    }
    if (route_ == Route::kBinary) {
      put_binary(line);
      return;
    }
    std::string reply = ask(line);
    for (unsigned tries = 0; reply == "ERR006"; ++tries) {
      ++refused_;
      ASSERT_FALSE(heeds_) << "refused while BREQ was high: " << line;
      ASSERT_LT(tries, 100000u) << "no room";
      wait(ms_to_ticks(1));
      reply = ask(line);
    }
    ASSERT_EQ(reply, "") << line;
  }

  void put_binary(const std::string& line) {
    BinaryRotary& rotary = rotary_[selected_ - 1];
    BinaryResult result = rotary.put(line);
    for (unsigned tries = 0; result == BinaryResult::kBusy; ++tries) {
      ++refused_;
      ASSERT_LT(tries, 100000u) << "no room";
      wait(ms_to_ticks(1));
      result = rotary.put(line);
    }
    ASSERT_EQ(result, BinaryResult::kOk) << line << ", status " << rotary.status();
    if (!heeds_) return;
    for (unsigned tries = 0; !rotary.empty(); ++tries) {  // BREQ tells of what has been copied
      ASSERT_LT(tries, 1000u) << "held while BREQ was high: " << rotary.status();
      wait(ms_to_ticks(1) / 10);
    }
  }

  bool all_copied() {
    for (BinaryRotary& rotary : rotary_)
      if (!rotary.empty()) return false;
    return true;
  }

  void open_binary() {
    ASSERT_EQ(ask("OPEN PROG 7 CLEAR P(Q2+P(Q3))=Q1 P(Q3)=P(Q3)+1 CLOSE"), "");
    for (unsigned cs = kSystems; cs >= 1; --cs) ASSERT_EQ(ask("&" + std::to_string(cs) + "DEF ROT 20 B0"), "");
    ASSERT_EQ(ask("I16=2 I17=4"), "");
    ASSERT_EQ(ask("OPEN BIN ROT"), "");
    for (unsigned cs = kSystems; cs >= 1; --cs) {
      ASSERT_EQ(rotary_[cs - 1].define(100 * cs, 64), BinaryResult::kOk);
      rotary_[cs - 1].enable();
      select(cs);
      put_binary("INC TA0 TS0 TM10 Q2=" + std::to_string(1000 * cs) + "Q3=" + std::to_string(cs));
      ASSERT_EQ(ask("R"), "");
    }
  }

  void open() {
    if (route_ == Route::kBinary) {
      rotary_.clear();
      for (unsigned cs = 1; cs <= kSystems; ++cs) rotary_.emplace_back(bus(), cs);
      selected_ = 0;
      open_binary();
      return;
    }
    for (unsigned cs = kSystems; cs >= 1; --cs) ASSERT_EQ(ask("&" + std::to_string(cs) + "DEF ROT 80 B0"), "");
    ASSERT_EQ(ask("I16=2 I17=4"), "");  // full before there is no room for a line more
    ASSERT_EQ(ask("OPEN ROT"), "");
    for (unsigned cs = kSystems; cs >= 1; --cs) {
      ASSERT_EQ(ask("&" + std::to_string(cs) + "INC TA0 TS0 TM10"), "");
      ASSERT_EQ(ask("R"), "");
    }
    selected_ = 1;
  }

  void select(unsigned cs) {
    if (cs != selected_) { ASSERT_EQ(ask("&" + std::to_string(cs)), ""); }
    selected_ = cs;
    if (heeds_) wait(ns_to_ticks(20'000));  // the pin follows within 10 us
  }

  // What the lines have left: empty when it is what was sent, or the beginning of it when `all` is false.
  std::string difference(unsigned cs, const std::vector<long>& sent, bool all) {
    const unsigned count = static_cast<unsigned>(std::stoul(ask("P(" + std::to_string(cs) + ")")));
    if (count > sent.size() || (all && count != sent.size()))
      return std::to_string(count) + " executed of " + std::to_string(sent.size());
    if (count == 0) return "";
    const std::string first = std::to_string(1000 * cs), last = std::to_string(1000 * cs + count - 1);
    const Reply reply = link().command("P" + first + ".." + last);
    if (reply.lines.size() != count) return "a reply of " + std::to_string(reply.lines.size()) + " lines";
    for (unsigned i = 0; i < count; ++i)
      if (reply.lines[i] != std::to_string(sent[i]))
        return "place " + std::to_string(i) + " holds " + reply.lines[i] + ", expected " + std::to_string(sent[i]);
    return "";
  }

  // One block of lines; what the scoreboard finds. `reset`: the controller restarts with lines still to be executed.
  std::string block(unsigned size, bool reset, Fault fault) {
    std::vector<long> sent[kSystems + 1];
    long held = -1;
    for (unsigned i = 0; i < size; ++i) {
      if (random_() % 4 == 0) select(1 + random_() % kSystems);
      sent[selected_].push_back(number_);
      const bool here = i == size / 2;
      const std::string line = text(selected_, number_) + (random_() % 5 == 0 ? "X0" : "");
      if (here && fault == Fault::kSwapped) {
        held = number_++;
        continue;
      }
      if (!here || fault != Fault::kLost) put(line);
      if (here && fault == Fault::kDoubled) put(line);
      if (held >= 0) {
        put(text(selected_, held));
        held = -1;
      }
      ++number_;
      if (HasFatalFailure()) return "";
    }
    std::string found;
    if (reset) {
      for (unsigned cs = 1; cs <= kSystems; ++cs) found += difference(cs, sent[cs], false);
      if (!link().command("$$$").complete) return "no answer after the reset";
      wait(ms_to_ticks(3));
      if (ask("P1 P2") != "0|0") found += "something is executed after the reset";
      open();
      return found;
    }
    for (unsigned cs = 1; cs <= kSystems; ++cs) {
      select(cs);
      for (unsigned tries = 0; !all_copied() || ask("PR") != "0"; ++tries) {
        if (tries == 5000) return "not all are executed";
        wait(ms_to_ticks(1));
      }
      wait(ms_to_ticks(5));  // moves of no length
      found += difference(cs, sent[cs], true);
      put("P" + std::to_string(cs) + "=0");
      wait(ms_to_ticks(5));
    }
    return found;
  }

  // Blocks until all lines are sent, one in seven cut by a reset.
  void stream(long count) {
    ASSERT_NO_FATAL_FAILURE(open());
    unsigned blocks = 0;
    while (number_ < count) {
      heeds_ = ++blocks % 2 == 0;
      if (route_ == Route::kBinary) { ASSERT_EQ(ask("I45=" + std::to_string(blocks / 2 % 2)), ""); }
      const std::string found =
          block(static_cast<unsigned>(std::min<long>(kBlock, count)), blocks % 7 == 3, Fault::kNone);
      ASSERT_FALSE(HasFatalFailure());
      ASSERT_EQ(found, "") << "block " << blocks;
    }
    EXPECT_GT(refused_, 0) << "no buffer was ever full";
    std::printf("%ld lines, %ld times refused\n", number_, refused_);
  }

  Route route_ = Route::kAscii;
  std::vector<BinaryRotary> rotary_;
  std::mt19937 random_{random_seed(1)};
  std::unique_ptr<BusDpram> ram_;
  bool by_ram_ = false;
  bool heeds_ = false;
  unsigned selected_ = 1;
  long number_ = 0, refused_ = 0;
};

TEST_P(StreamOn, RotaryBuffersExecuteEachLineOnceAndInOrder) {
  BRICK_COVERS("BREQ-3");
  start();
  stream(lines());
}

TEST_P(StreamOn, RotaryBuffersThroughTheDualPortedRam) {
  start();
  ASSERT_NO_FATAL_FAILURE(use_ram());
  stream(lines(800, 40));
}

// By the background and by the real-time task in turn; a header that is in use is not touched by either change.
TEST_P(StreamOn, BinaryLinesAreExecutedOnceAndInOrder) {
  BRICK_COVERS("BIN-3 BIN-5 BREQ-3");
  route_ = Route::kBinary;
  start();
  stream(lines());
}

// Written, listed, executed, written anew over what there was.
TEST_P(StreamOn, FixedBuffersKeepAndExecuteEachLineInOrder) {
  start();
  unsigned blocks = 0;
  while (number_ < lines()) {
    const std::string program = std::to_string(1 + ++blocks % 5);
    if (blocks % 5 == 0) { ASSERT_EQ(ask("SAVE"), ""); }
    if (blocks % 5 == 0) { ASSERT_TRUE(link().command("$$$").complete); }
    ASSERT_EQ(ask("P1=0 OPEN PROG " + program + " CLEAR"), "");
    std::vector<long> sent;
    std::string listing;
    for (unsigned i = 0; i < std::min<long>(kBlock, lines()); ++i, ++number_) {
      sent.push_back(number_);
      listing += (listing.empty() ? "" : "|") + text(1, number_);
      ASSERT_EQ(ask(text(1, number_)), "");
    }
    ASSERT_EQ(ask("CLOSE"), "");
    ASSERT_EQ(ask("LIST PROG " + program), listing + "|RET");
    ASSERT_EQ(ask("&1 B" + program + " R"), "");
    const auto ended = [this] { return (std::stoul(ask("??").substr(0, 12), nullptr, 16) & 0x1020000u) == 0x20000u; };
    for (unsigned tries = 0; !ended(); ++tries) {  // all is calculated, and nothing executes
      ASSERT_LT(tries, 1000u) << "the program does not end";
      wait(ms_to_ticks(1));
    }
    ASSERT_EQ(difference(1, sent, true), "") << "block " << blocks;
  }
  std::printf("%ld lines\n", number_);
}

// The scoreboard itself: a host that loses a line, writes one twice, or two in the wrong order.
TEST_P(StreamOn, AFaultIsFound) {
  if (GetParam() != Engine::kSystemC) return;
  for (const Route route : {Route::kAscii, Route::kBinary})
    for (const Fault fault : {Fault::kNone, Fault::kLost, Fault::kDoubled, Fault::kSwapped}) {
      random_.seed(5);
      route_ = route;
      start();
      ASSERT_NO_FATAL_FAILURE(open());
      EXPECT_EQ(block(40, false, fault).empty(), fault == Fault::kNone) << static_cast<int>(fault);
    }
}

BRICK_ON_ENGINES(StreamOn, Engine::kSystemC, Engine::kLockstep);

}  // namespace
}  // namespace brick
