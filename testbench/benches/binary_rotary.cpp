// binary-rotary: a host writes program lines into the dual-ported RAM for sixteen coordinate systems, at any time of
// the firmware's tasks, with I45 = 0 and 1. Every word that the controller writes into a header and every edge of BREQ
// goes to testbench/checkers/binary_scoreboard.h; what the rings have got is listed.
#include <algorithm>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"
#include "testbench/benches/benches.h"
#include "testbench/benches/binary_host.h"

namespace brick {
namespace {

constexpr unsigned kSystems = 16, kRing = 40;
constexpr Tick kServo = 4 * (2 * 6527 + 3), kRealTime = 3 * kServo;  // default periods

void set_foreground(BinaryHost& host, BenchContext& b, bool on) {
  host.settle();
  b.expect(fmt::format("I45={}", on ? 1 : 0), "");
  host.scoreboard().foreground(on);
}

// Sixteen at once, one to three lines with each index, pauses from none to a real-time interrupt.
void sixteen(BenchContext& b, BinaryHost& host, bool foreground) {
  const std::string name = fmt::format("16 buffers, I45={}", foreground ? 1 : 0);
  set_foreground(host, b, foreground);
  host.open(kSystems, kRing, 0);
  std::vector<unsigned> words(kSystems);
  unsigned sent = 0;
  for (unsigned tries = 0; sent < 120 && tries < 4000; ++tries) {
    const unsigned cs = host.random(kSystems);
    std::vector<std::string> lines;
    for (unsigned i = 0, count = 1 + host.random(3); i < count; ++i) lines.push_back(host.random_line());
    unsigned more = 0;
    for (const std::string& line : lines) more += static_cast<unsigned>(binary_line(line).commands.size());
    if (words[cs] + more > kRing) continue;  // a full ring is another step's
    if (host.send(cs, {lines})) {
      words[cs] += more;
      sent += static_cast<unsigned>(lines.size());
    }
    if (host.random(12) == 0) host.select(host.random(kSystems));
    b.bus.wait(host.random(host.random(4) == 0 ? static_cast<unsigned>(kRealTime) : 600));
  }
  host.settle();
  host.verdict(name, 60);
  host.scoreboard().unjudged();
  Comparison listings;
  for (unsigned cs = 0; cs < kSystems; ++cs) {
    listings.equal(fmt::format("&{}: PR", cs + 1), host.ask(fmt::format("&{}PR", cs + 1)),
                   std::to_string(host.scoreboard().copied(cs)));
    listings.equal(fmt::format("&{}", cs + 1), host.ask("LIST ROT"), host.scoreboard().listing(cs));
  }
  b.report.step(name + ", listings", listings, 2 * kSystems, "each ring holds its lines");
  host.close();
}

// Up to I17 lines and beyond, then more than the ring holds.
void full(BenchContext& b, BinaryHost& host, bool foreground) {
  const std::string name = fmt::format("I45={}", foreground ? 1 : 0);
  set_foreground(host, b, foreground);
  host.open(1, 24, 64);
  for (unsigned line = 1; line <= 20; ++line) {
    host.send(0, {"P1=1"});
    if (host.random(3) == 0) host.settle();
    b.bus.wait(host.random(static_cast<unsigned>(kServo)));
  }
  host.settle();
  host.verdict("BREQ and Full, " + name, 20);
  const std::string status = host.ask("??");
  b.report.step(
      "20 lines with I17=10, " + name,
      ((std::stoul(status.substr(6, 6), nullptr, 16) >> 16) & 1) == 1 && b.machine.outputs().get(pin::kBreq) == 0,
      "Full=1, BREQ=0");
  const unsigned before = host.scoreboard().counts().busy;
  for (unsigned line = 0; line < 6; ++line) host.send(0, {"P2=2"});
  b.bus.wait(2 * kRealTime);
  host.verdict("ring full, " + name, 4);
  b.report.step("busy, " + name,
                host.rotary(0).status() == DPRAM_ROTARY_BUSY && host.scoreboard().counts().busy > before,
                fmt::format("status {:04X}", host.rotary(0).status()));
  host.close();
}

// Each error of host-bus:7.5, and that the host can begin anew.
void errors(BenchContext& b, BinaryHost& host) {
  struct Lie {
    const char* name;
    unsigned code;
    std::uint32_t word;
    std::uint16_t value;
  };
  const Lie lies[] = {{"size 4", 2, DPRAM_ROTARY_SIZE, 4},
                      {"size odd", 2, DPRAM_ROTARY_SIZE, 33},
                      {"start beyond the RAM", 3, DPRAM_ROTARY_START, 0x3C00},
                      {"host index odd", 4, DPRAM_ROTARY_HOST_INDEX, 7},
                      {"host index beyond", 4, DPRAM_ROTARY_HOST_INDEX, 64},
                      {"PMAC index beyond", 4, DPRAM_ROTARY_PMAC_INDEX, 900},
                      {"enable of another", 7, DPRAM_ROTARY_ENABLE, 2}};
  const struct {
    const char* name;
    unsigned code;
    BinaryCommand command;
  } commands[] = {{"an expression", 5, {0xF10000, 1}},
                  {"code 2,0,7", 5, {0x9001C0, 0}},
                  {"F-1", 6, {0x980001, 0xC00000}},
                  {"a fraction not normalised", 6, {0x880182, 0x200000}},
                  {"no start of line", 8, {0x080181, 0x400000}},
                  {"a prefix alone", 8, {0xF80040, 0}}};
  set_foreground(host, b, false);
  host.open(1, 100, 64);
  BinaryRotary& rotary = host.rotary(0);
  const auto stopped = [&](const std::string& name, unsigned code) {
    b.bus.wait(2 * kRealTime);
    b.report.equal(fmt::format("error {}: {}", code, name), static_cast<unsigned>(rotary.status()), 0x8000u | code);
    rotary.disable();
    rotary.define(0, 64);
    host.scoreboard().recovered(0);
    rotary.enable();
    host.send(0, {"X1"});
    host.settle();
  };
  for (const Lie& lie : lies) {
    host.scoreboard().expect_error(0, lie.code);
    rotary.write(lie.word, lie.value);
    stopped(lie.name, lie.code);
  }
  for (const auto& c : commands) {
    host.scoreboard().expect_error(0, c.code);
    (void)rotary.put(std::vector<BinaryCommand>{c.command});
    stopped(c.name, c.code);
  }
  b.expect("CLOSE", "");
  host.scoreboard().expect_error(0, 1);
  host.send(0, {"X2"});
  b.bus.wait(16 * kRealTime);
  b.report.equal("error 1: closed", static_cast<unsigned>(rotary.status()), 0x8001u);
  host.scoreboard().recovered(0);
  host.verdict("after each of them the host begins anew", 13);
  b.report.equal("lines stored", host.ask("PR"), std::string("13"));
  host.close();
}

// From the write of the host's index to the fall of BREQ, single lines at any time of the tasks.
void delays(BenchContext& b, BinaryHost& host, bool foreground) {
  set_foreground(host, b, foreground);
  host.open(1, 100, 64);
  host.scoreboard().limits(100);
  b.expect("I17=100", "");
  host.scoreboard().forget_delays();
  for (unsigned line = 0; line < 40; ++line) {
    host.send(0, {"X1Y2"});
    host.settle();
    b.bus.wait(host.random(static_cast<unsigned>(kRealTime)));
  }
  std::vector<Tick> found = host.scoreboard().delays();
  std::sort(found.begin(), found.end());
  const Tick most = foreground ? kRealTime + ns_to_ticks(200'000) : ns_to_ticks(600'000);
  b.report.step(fmt::format("last write to BREQ, I45={}", foreground ? 1 : 0),
                found.size() == 40 && found.back() <= most,
                found.empty() ? "no line"
                              : fmt::format("{:.0f} us, median {:.0f}, {:.0f}; limit {:.0f}",
                                            static_cast<double>(tick_to_fs(found.front())) * 1e-9,
                                            static_cast<double>(tick_to_fs(found[found.size() / 2])) * 1e-9,
                                            static_cast<double>(tick_to_fs(found.back())) * 1e-9,
                                            static_cast<double>(tick_to_fs(most)) * 1e-9));
  host.verdict(fmt::format("single lines, I45={}", foreground ? 1 : 0), 40);
  host.scoreboard().limits(10);
  b.expect("CLOSE I17=10", "");
  host.close();
}

void run(BenchContext& b) {
  std::mt19937_64 pace(b.seed * 7919);
  b.bus.set_pace([&pace] { return static_cast<unsigned>(pace() % 4 == 0 ? pace() % 6 : 0); });
  {
    BinaryHost host(b);
    b.expect("DELETE GATHER I68=15 I9=2", "");
    for (const bool foreground : {false, true}) sixteen(b, host, foreground);
    for (const bool foreground : {false, true}) full(b, host, foreground);
    errors(b, host);
    for (const bool foreground : {false, true}) delays(b, host, foreground);
    const BinaryScoreboard::Counts& n = host.scoreboard().counts();
    b.report.step("seen", n.pulses > 50 && n.stays_low >= 2 && n.several > 20 && n.busy >= 2 && n.errors >= 13,
                  fmt::format("{} lines, {} pulses, {} falls that stay, {} lines behind another in its pass, {} times "
                              "busy, {} errors",
                              n.lines, n.pulses, n.stays_low, n.several, n.busy, n.errors));
  }
  b.bus.set_pace(nullptr);
}

}  // namespace

// covers: BIN-1 BIN-2 BIN-3 BIN-5 BIN-6
Bench binary_rotary_bench() {
  return {"binary-rotary",
          "lines through the dual-ported RAM for 16 systems, I45 = 0 and 1; header words and edges of BREQ judged",
          {"one line in eight is told with another text", "16 buffers, I45=0, listings", "&*, expected *P8191=1*"},
          run,
          kASlotOf16Bits};
}

}  // namespace brick
