// dpram-ascii: a host at the ASCII port in the dual-ported RAM and one at the host port, lines of both under way at
// random distances. What each has to be answered is known from the lines, because each port has its own addresses and
// each line its own number; the answers of one say nothing about the other. The rules are those of host-bus:6.6,
// host-bus:4.7 and host-bus:8.5.
#include <random>

#include <fmt/format.h>

#include "rtl/regs/dpram_map.h"
#include "testbench/benches/benches.h"
#include "testbench/host/dpram_port.h"

namespace brick {
namespace {

constexpr Tick kMillisecond = ns_to_ticks(1'000'000);
constexpr unsigned kFirstChosen = 5, kLineEnd = 8;  // of the interrupt controller, BoardConfig::line_select
constexpr unsigned kEqu1 = 1;                       // which the firmware pulses

class AsciiBench {
 public:
  explicit AsciiBench(BenchContext& bench) : b_(bench), ram_(bench.bus), port_(ram_), random_(bench.seed * 31 + 7) {}
  void run();

 private:
  unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
  std::string ask(const std::string& line) {
    const Reply reply = port_.command(line);
    std::string joined = reply.complete ? "" : "no end: ";
    for (std::size_t i = 0; i < reply.lines.size(); ++i) joined += (i == 0 ? "" : "|") + reply.lines[i];
    return joined;
  }
  void expect(const std::string& line, const std::string& answer) {
    b_.report.equal("RAM: " + line, ask(line), answer);
  }

  void both_ports();
  void lengths();
  void errors();
  void control_characters();
  void texts();
  void interrupt(unsigned line);
  void unread();

  BenchContext& b_;
  BusDpram ram_;
  DpramPort port_;
  std::mt19937_64 random_;
};

void AsciiBench::both_ports() {
  const unsigned here = 1 + pick(15), there = 1 + (here + pick(14)) % 16, motor = 2 + pick(30);
  b_.expect(fmt::format("&{}#1", here), "");
  expect(fmt::format("&{}#{}", there, motor), "");
  const unsigned told = b_.negative ? here : there;  // the negative control: as if the addresses were the same
  Comparison compared;
  for (int round = 0; round < 25; ++round) {
    const long number = pick(1'000'000);
    const bool first = pick(2) == 0;
    const std::string by_port = fmt::format("P1={} P1&", number), by_ram = fmt::format("P2=-{} P2&#", number);
    if (first && !b_.link.send(by_port)) b_.report.fail("line to the host port", "not taken");
    b_.bus.wait(pick(30'000));
    if (!port_.send(by_ram + std::string(pick(240 - static_cast<unsigned>(by_ram.size())), ' ')))
      b_.report.fail("line to the RAM", "not taken");
    b_.bus.wait(pick(30'000));
    if (!first && !b_.link.send(by_port)) b_.report.fail("line to the host port", "not taken");
    using Lines = std::vector<std::string>;
    compared.equal(fmt::format("round {}, host port", round), fmt::format("{}", fmt::join(b_.link.finish().lines, "|")),
                   fmt::format("{}", fmt::join(Lines{std::to_string(number), std::to_string(here)}, "|")));
    compared.equal(fmt::format("round {}, RAM", round), fmt::format("{}", fmt::join(port_.finish().lines, "|")),
                   fmt::format("-{}|{}|{}", number, told, motor));
  }
  b_.report.step("both ports at once", compared, 50, "25 lines each, with addresses of their own");
}

void AsciiBench::lengths() {
  Comparison compared;
  for (const unsigned length : {8U, 158U, 159U, 160U, 161U, 255U}) {
    const std::string value = std::to_string(length + 1000);
    const std::string line = "P3=" + std::string(length - 3 - value.size(), ' ') + value;
    compared.equal(fmt::format("{} characters", length), ask(line), std::string());
    compared.equal(fmt::format("{} characters, P3", length), b_.ask("P3"), value);
  }
  compared.equal("256 characters", ask("P3=1" + std::string(252, ' ')), std::string("ERR003"));
  b_.report.step("lines in pieces", compared, 13, "8 to 256 characters");
}

void AsciiBench::errors() {
  constexpr struct {
    const char *line, *error;  // firmware:6.4
  } kLines[] = {{"UUU", "ERR003"},
                {"X1000", "ERR005"},
                {"&1DEF ROT 0", "ERR003"},
                {"&17", "ERR003"},
                {"CLOSE DEF ROT 99999", "ERR006"},
                {"&1R", "ERR015"},
                {"PR", "ERR003"},
                {"P1=\xC4", "ERR004"}};
  Comparison compared;
  for (const auto& [line, error] : kLines) {
    compared.equal(std::string(line) + ", RAM", ask(line), std::string(error));
    compared.equal(std::string(line) + ", host port", b_.ask(line), std::string(error));
  }
  b_.report.step("errors at both ports", compared, 2 * std::size(kLines), "eight lines, codes 8nnn in the RAM");
}

void AsciiBench::control_characters() {
  b_.expect("OPEN PLC 1 CLEAR", "");
  b_.expect("P4=P4+1", "");
  b_.expect("CLOSE P4=0 I5=2 ENABLE PLC 1", "");
  b_.bus.wait(5 * kMillisecond);
  const std::vector<long> scans = b_.numbers("P4");
  b_.report.step("PLC 1 runs before ^D", scans.size() == 1 && scans[0] >= 5,
                 fmt::format("{} scans in 5 ms, expected one a millisecond or more", fmt::join(scans, " ")));
  b_.report.step("^D acts and is zeroed", port_.control(0x04, 50 * kMillisecond), "within 50 ms");
  const std::string before = b_.ask("P4");
  b_.bus.wait(5 * kMillisecond);
  b_.expect("P4", before);
  // ^P: the port's own group of motors, which is that of ##1, whatever the host port has addressed. Ixx08 is 96, so
  // 3,072 is a count (firmware:1.10/8).
  std::string positions;
  for (unsigned motor = 9; motor <= 16; ++motor) {
    const long counts = pick(100'000);
    b_.expect(fmt::format("M8->D:${:X} M8={}", 0x80 * motor + 0x0B, 3072 * counts), "");
    positions += (motor == 9 ? "" : " ") + std::to_string(counts);
  }
  expect("##1", "");
  b_.expect("##0", "");
  const bool taken = port_.control(0x10, 50 * kMillisecond);
  const Reply reply = port_.finish();
  b_.report.step("^P is taken, its answer has an end", taken && reply.complete, "within 50 ms");
  b_.report.equal("^P", fmt::format("{}", fmt::join(reply.lines, "|")), positions);
  expect("##0", "");
}

// A PLC sends to both ports; the RAM has each text as a line of its own, in order.
void AsciiBench::texts() {
  b_.expect("OPEN PLC 1 CLEAR", "");
  b_.expect("SENDR\"ram 1\"SENDP\"port\"SENDR\"ram 2\"CMDR\"P1..2\"DISABLE PLC 1", "");
  b_.expect("CLOSE P1=5 P2=6 ENABLE PLC 1", "");
  std::string got;
  while (const auto response = port_.take(20 * kMillisecond))
    got += fmt::format("{:04X} {}|", response->code, response->text);
  b_.report.equal("texts and answers of a program", got, std::string("020D ram 1|020D ram 2|010D 5|010D 6|"));
  std::string bytes;
  while (const auto c = b_.bus.get_char(5 * kMillisecond)) bytes += *c == '\r' ? '|' : static_cast<char>(*c);
  b_.report.equal("text of it at the host port", bytes, std::string("port|"));
}

// Rises of the line, counted where the interrupt controller shows it.
void AsciiBench::interrupt(unsigned line) {
  b_.expect("I56=1", "");
  b_.bus.write_pic_edge_level(0);
  b_.bus.clear_pic();
  b_.bus.write_pic_mask(1U << line);
  const unsigned lines = 3 + pick(5);
  if (!port_.send(fmt::format("P1..{}", lines))) b_.report.fail("line to the RAM", "not taken");
  unsigned interrupts = 0, taken = 0;
  while (b_.bus.wait_pin(pin::kIsaIrq, 1, 10 * kMillisecond)) {
    ++interrupts;
    b_.bus.clear_pic();
    b_.bus.wait(pick(100'000));
    taken += port_.take(0) ? 1 : 0;
  }
  b_.report.equal("interrupts, one a line", interrupts, lines + 1);
  b_.report.equal("lines that were there at each", taken, lines + 1);
  b_.bus.wait(5 * kMillisecond);
  b_.report.equal("line after the last release", b_.bus.read_pic_signals() >> line & 1, 0);
  b_.bus.write_pic_mask(0);
  b_.expect("I56=0", "");
}

// An answer that nobody reads: lines of the host port take no longer.
void AsciiBench::unread() {
  const auto longest = [this] {
    Tick most = 0;
    for (int i = 0; i < 8; ++i) {
      const Tick from = b_.bus.now();
      b_.expect("P5=5 P5", "5");
      most = std::max(most, b_.bus.now() - from);
      b_.bus.wait(pick(20'000));
    }
    return most;
  };
  b_.bus.wait(5 * kMillisecond);
  const Tick before = longest();
  if (!port_.send("P0..299")) b_.report.fail("line to the RAM", "not taken");
  b_.bus.wait(20 * kMillisecond);
  const Tick meanwhile = longest();
  b_.report.step("host port while an answer is not read", meanwhile < before + ns_to_ticks(100'000),
                 fmt::format("{} ticks at most, {} before", meanwhile, before));
  const Reply reply = port_.finish();
  b_.report.equal("lines of that answer", static_cast<unsigned>(reply.lines.size()), 300U);
}

void AsciiBench::run() {
  b_.expect("I58=1", "");
  b_.bus.wait(3 * kMillisecond);
  both_ports();
  lengths();
  errors();
  control_characters();
  texts();
  for (unsigned line = kFirstChosen; line < kLineEnd && !b_.board.pic_8259; ++line)
    if ((b_.board.line_select >> 4 * (line - kFirstChosen) & 0xF) == kEqu1) interrupt(line);
  unread();
}

}  // namespace

Bench dpram_ascii_bench() {
  return {"dpram-ascii",
          "command lines through the dual-ported RAM and the host port at once: answers, pieces, texts, interrupt",
          {"the scoreboard is told that both ports have one address", "both ports at once", "round 0, RAM"},
          [](BenchContext& b) { AsciiBench(b).run(); },
          kASlotOf16Bits};
}

}  // namespace brick
