#include "testbench/benches/isa_malformed.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rtl/regs/brick_regs.hpp"

namespace brick {
namespace {

constexpr std::uint32_t kLast = 7, kMask = 10, kMemory = 0x200;  // I/O offsets; a word of page 0 of the RAM
constexpr std::uint16_t kWord = 0x6B2D;
constexpr std::uint8_t kBackspace = 0x08;  // does nothing to an empty line

class MalformedHosts {
 public:
  explicit MalformedHosts(BenchContext& b) : b_(b) {}

  void run() {
    b_.bus.dpram_write(kMemory, kWord);
    b_.bus.write_pic_mask(0);
    const std::string last = io(kLast), mask = io(kMask), memory = "memory " + fmt::format("0x{:06X}", window_word());
    provoke("read strobe of 30 ns", "t2 at " + last, [this] { short_read(); });
    provoke("write strobe of 30 ns", "t2 at " + last, [this] { short_write(); });
    const std::string short_memory_rule = (b_.board.slot8 ? "t2 at " : "t13 at ") + memory;
    provoke(
        "memory strobe of 30 ns", short_memory_rule, [this] { short_memory(); },
        short_memory_rule + ", t9 at " + memory);  // where it ends while IOCHRDY is low, as each access begins
    provoke("two commands at once", "one-command at " + mask, [this] { two_commands(); });
    provoke("no time between commands", "t11 at " + mask, [this] { handed_over(); });
    provoke("address moves", "address-stands at " + last, [this] { moving_address(); });
    provoke("TX written while full", "room-in-tx at " + last, [this] { full_tx(); });
    provoke("RESETDRV in a write", "whole-cycle at " + mask, [this] { resetdrv(); });
    provoke("reset in a memory write", "whole-cycle at " + memory, [this] { board_reset(false); });
    provoke("power loss in a memory write", "whole-cycle at " + memory, [this] { board_reset(true); });
  }

 private:
  // The host breaks the named rule and nothing else, or what its phase to the clock decides; what comes after it breaks
  // none.
  void provoke(const std::string& name, const std::string& rule, const std::function<void()>& host,
               const std::string& by_phase = "") {
    b_.bus.wait(60);
    ledger().forget();
    host();
    const std::string found = broken();
    b_.report.equal(name, found, !by_phase.empty() && found == by_phase ? by_phase : rule);
    ledger().forget();
    works(name);
  }
  TimingLedger& ledger() { return b_.timing.isa().ledger(); }
  std::string broken() {
    std::vector<std::string> rules;
    for (const TimingViolation& v : ledger().violations())
      rules.push_back(ledger().rules()[v.rule].id + " at " + timing_address(v.where));
    return rules.empty() ? "nothing" : fmt::format("{}", fmt::join(rules, ", "));
  }
  void works(const std::string& after) {
    const std::string number = std::to_string(++probes_);
    b_.link.command("P1=" + number);
    const std::string answer = b_.ask("P1");
    const std::uint16_t word = b_.bus.dpram_read(kMemory);
    const std::uint8_t mask = b_.bus.io_read(kMask);
    b_.report.equal(after + ": the machine works",
                    fmt::format("P1 {}, word {:04X}, MSK {:02X}, broken: {}", answer, word, mask, broken()),
                    fmt::format("P1 {}, word {:04X}, MSK 00, broken: nothing", number, kWord));
  }
  std::string io(std::uint32_t offset) { return fmt::format("I/O 0x{:03X}", b_.bus.io_base() + offset); }
  std::uint32_t window_word() { return b_.bus.window() + kMemory; }  // page 0 has been turned up

  // A point in time after all cycles; `offset` nanoseconds later pins move.
  void begin() { start_ = std::max(b_.bus.free_at(), b_.machine.now_fs()) + isa::ns(1000); }
  void at(std::int64_t offset, const std::function<void(HostInputs&)>& edit) {
    b_.bus.drive_at(start_ + isa::ns(offset), edit);
  }
  void address(std::uint32_t offset, std::uint8_t data = kBackspace) {
    begin();
    const std::uint32_t port = b_.bus.io_base() + offset;
    at(0, [=](HostInputs& in) { in.isa_sa = port, in.isa_sd = static_cast<std::uint16_t>(0xFF00 | data); });
  }
  void rest(std::int64_t offset) {
    at(offset, [](HostInputs& in) {
      in.isa_sd = 0xFFFF;
      in.isa_sbhe_n = true;
    });
  }

  void short_read() {
    address(kLast);
    at(120, [](HostInputs& in) { in.isa_ior_n = false; });
    at(150, [](HostInputs& in) { in.isa_ior_n = true; });
    rest(400);
  }
  void short_write() {  // seen or not: a character that changes nothing
    address(kLast);
    at(120, [](HostInputs& in) { in.isa_iow_n = false; });
    at(150, [](HostInputs& in) { in.isa_iow_n = true; });
    rest(400);
  }
  void memory_address(std::uint16_t data) {
    begin();
    const bool wide = !b_.board.slot8;
    at(0, [=, word = window_word()](HostInputs& in) {
      in.set_address(word);
      in.isa_sbhe_n = !wide;
      in.isa_sd = data;
    });
  }
  void short_memory() {  // the word that is there, or not at all
    memory_address(kWord);
    at(150, [](HostInputs& in) { in.isa_memw_n = false; });
    at(180, [](HostInputs& in) { in.isa_memw_n = true; });
    rest(400);
  }
  void handed_over() {
    address(kMask, 0);
    at(120, [](HostInputs& in) { in.isa_ior_n = false; });
    at(720, [](HostInputs& in) { in.isa_ior_n = true, in.isa_iow_n = false; });
    at(1320, [](HostInputs& in) { in.isa_iow_n = true; });
    rest(1400);
  }
  void two_commands() {
    address(kMask, 0xFF);
    at(120, [](HostInputs& in) { in.isa_iow_n = false; });
    at(300, [](HostInputs& in) { in.isa_ior_n = false; });
    at(900, [](HostInputs& in) { in.isa_iow_n = in.isa_ior_n = true; });
    rest(1000);
  }
  void moving_address() {
    address(kLast);
    const std::uint32_t mask = b_.bus.io_base() + kMask;
    at(120, [](HostInputs& in) { in.isa_iow_n = false; });
    at(300, [=](HostInputs& in) { in.isa_sa = mask; });
    at(700, [](HostInputs& in) { in.isa_iow_n = true; });
    rest(800);
  }
  // The firmware needs longer for a character than the host for a write.
  void full_tx() {
    for (int i = 0; i < 4; ++i) b_.bus.io_write(regs::host_io::kData7, kBackspace);
  }
  void resetdrv() {
    address(kMask, 0xFF);
    at(120, [](HostInputs& in) { in.isa_iow_n = false; });
    at(300, [](HostInputs& in) { in.isa_resetdrv = true; });
    at(800, [](HostInputs& in) { in.isa_iow_n = true; });
    rest(900);
    at(1500, [](HostInputs& in) { in.isa_resetdrv = false; });
    b_.bus.wait(60);
  }
  void board_reset(bool power) {
    memory_address(0x1234);
    at(150, [](HostInputs& in) { in.isa_memw_n = false; });
    at(400, [](HostInputs&) {});
    if (power)
      b_.machine.power_cycle();
    else
      b_.machine.reset();
    at(2500, [](HostInputs& in) { in.isa_memw_n = true; });
    rest(2600);
    b_.link.connect(HostLink::kBootTime);
  }

  BenchContext& b_;
  TimeFs start_ = 0;
  int probes_ = 0;
};

}  // namespace

void malformed_hosts(BenchContext& b) { MalformedHosts(b).run(); }

}  // namespace brick
