// variables: random writes and reads of I, P, Q and M, one by one, by ranges, counts and steps and with computed
// numbers, in all settings of I9, against a scoreboard that keeps what each of them holds by the rules of firmware:1.4
// to firmware:1.6: limited ranges lose the bits above them, locked and read-only groups keep what they had.
#include <map>
#include <random>

#include <fmt/format.h>

#include "systemc/machine/board_family.h"
#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr std::int64_t kServoPeriod = 3713991;

// I-variables without another effect than being kept; firmware:2, firmware:3.1, firmware:3.4.
struct Group {
  unsigned first, count, step, bits;
  bool with_sign, hexadecimal;
  unsigned lock;  // bit of I41
  std::int64_t value;
};
constexpr unsigned kIsx20 = 5120;
constexpr Group kGroups[] = {
    {65, 1, 1, 24, false, false, 0, 0},          // user marker
    {69, 1, 1, 24, false, true, 0, 0},           //
    {78, 2, 1, 8, false, false, 0, -1},          // 0 and 32, told below
    {83, 1, 1, 4, false, false, 0, 0},           //
    {90, 1, 1, 8, false, true, 0, 0x39},         //
    {111, 32, 100, 23, false, false, 1, 32000},  // Ixx11
    {126, 32, 100, 24, true, false, 1, 0},       // Ixx26
    {129, 32, 100, 16, true, false, 1, 0},       // Ixx29
    {105, 32, 100, 24, false, true, 1, 0x35C0},  // Ixx05
    {188, 32, 100, 8, false, false, 1, 0},       // Ixx88
    {192, 32, 100, 23, false, false, 1, 10},     // Ixx92
    {172, 32, 100, 11, false, false, 1, 1365},   // Ixx72
    {kIsx20, 16, 100, 16, false, false, 2, 0},   // Isx20
    {5188, 16, 100, 23, false, false, 2, 50},    // Isx88
    {5194, 16, 100, 23, false, false, 2, 1644},  // Isx94
    {5001, 48, 1, 24, false, true, 0, 0},        // gather sources
};

class Store {
 public:
  explicit Store(BenchContext& b) : b_(b), random_(b.seed * 31337 + 11) {
    for (const Group& g : kGroups)
      for (unsigned i = 0; i < g.count; ++i) {
        const unsigned n = g.first + i * g.step;
        rule_[n] = &g;
        i_[n] = g.value;
      }
    i_[78] = 0;
    i_[79] = 32;
  }

  unsigned random(unsigned below) { return static_cast<unsigned>(random_() % below); }

  // Eighths: a 36-bit mantissa holds them, ten digits name them.
  double fraction() { return (static_cast<double>(random(8'000'000)) - 4'000'000) / 8; }
  static std::string text(double value) {
    std::string t = fmt::format("{:.3f}", value);
    t.erase(t.find_last_not_of('0') + 1);
    if (t.back() == '.') t.pop_back();
    return t == "-0" ? "0" : t;
  }

  void command(const std::string& line) { writes.equal(line, b_.ask(line), ""); }

  // P, Q of a coordinate system, M without an address.
  void write_plain() {
    const unsigned which = random(3), cs = random(16);
    const unsigned end = which == 1 ? 512 : 8192, count = 1 + random(60), step = 1 + random(4);
    const unsigned first = random(end - count * step), last = first + (count - 1) * step;
    const double value = which == 2 ? static_cast<double>(random(16'000'000)) - 8'000'000 : fraction();
    const char letter = "PQM"[which];
    const std::string address = which == 1 ? fmt::format("&{}", cs + 1) : "";
    std::string target = fmt::format("{}{},{},{}", letter, first, count, step);
    unsigned apart = step;
    if (random(3) == 0) {
      target = fmt::format("{}{}..{}", letter, first, last);
      apart = 1;
    }
    if (random(4) == 0) {
      target = fmt::format("{}({}+{})", letter, first, 0);
      apart = 0;
    }
    command(address + target + "=" + text(value));
    // The negative control: one write in ten is told to the scoreboard with a wrong value.
    const double told = b_.negative && ++lies_ % 10 == 0 ? value + 1 : value;
    auto& store = which == 0 ? p_ : which == 1 ? q_[cs] : m_;
    for (unsigned n = first; n <= (apart == 0 ? first : last); n += apart == 0 ? 1 : apart) {
      store[n] = told;
      written_[which].emplace_back(cs, n);
    }
  }

  void write_i() {
    const Group& g = kGroups[random(std::size(kGroups))];
    const unsigned at = random(g.count), count = 1 + random(g.count - at);
    const std::int64_t value = static_cast<std::int64_t>(random(0x7FFFFFFF)) - (g.with_sign ? 0x3FFFFFFF : 0);
    const unsigned first = g.first + at * g.step;
    const std::string number = value >= 0 && random(2) == 0 ? fmt::format("${:X}", value) : std::to_string(value);
    command(fmt::format("I{},{},{}={}", first, count, g.step, number));
    // on a Geo PMAC it is one value under all its numbers (firmware:3.8)
    const bool alike = g.first == kIsx20 && (b_.board.product & kProductGeoPmac) != 0;
    for (unsigned i = alike ? 0 : at; i < (alike ? g.count : at + count); ++i) {
      if ((g.lock & locks_) != 0) continue;
      std::int64_t kept = value & ((std::int64_t{1} << g.bits) - 1);
      if (g.with_sign && (kept >> (g.bits - 1)) != 0) kept -= std::int64_t{1} << g.bits;
      i_[g.first + i * g.step] = kept;
    }
  }

  void lock(unsigned locks) {
    locks_ = locks;
    command(fmt::format("I41={}", locks));
  }

  void set_i9(unsigned i9) {
    i9_ = i9;
    command(fmt::format("I9={}", i9));
  }

  std::string i_text(unsigned n) {
    const std::string head = (i9_ & 1) != 0 ? fmt::format("I{}=", n) : "";
    if ((i9_ & 2) != 0 && rule_[n]->hexadecimal) return fmt::format("{}${:X}", head, i_[n]);
    return head + std::to_string(i_[n]);
  }

  void read_i() {
    const Group& g = kGroups[random(std::size(kGroups))];
    const unsigned at = random(g.count), count = 1 + random(g.count - at), first = g.first + at * g.step;
    std::vector<std::string> expected;
    for (unsigned i = 0; i < count; ++i) expected.push_back(i_text(first + i * g.step));
    const bool by_range = g.step == 1 && random(2) == 0;
    compare(
        i_reads,
        by_range ? fmt::format("I{}..{}", first, first + count - 1) : fmt::format("I{},{},{}", first, count, g.step),
        expected);
  }

  // A range around something that was written.
  void read_plain() {
    const unsigned which = random(3);
    if (written_[which].empty()) return;
    const auto [cs, near] = written_[which][random(static_cast<unsigned>(written_[which].size()))];
    const unsigned end = which == 1 ? 512 : 8192;
    const unsigned first = near - std::min(near, random(20)), last = std::min(near + random(20), end - 1);
    std::vector<std::string> expected;
    const auto& store = which == 0 ? p_ : which == 1 ? q_[cs] : m_;
    for (unsigned n = first; n <= last; ++n) {
      const auto at = store.find(n);
      expected.push_back(text(at == store.end() ? 0 : at->second));
    }
    compare(plain_reads,
            fmt::format("{}{}{}..{}", which == 1 ? fmt::format("&{}", cs + 1) : "", "PQM"[which], first, last),
            expected);
  }

  Comparison writes, plain_reads, i_reads;

 private:
  void compare(Comparison& into, const std::string& line, const std::vector<std::string>& expected) {
    const std::vector<std::string> lines = b_.link.command(line).lines;
    into.equal(line + ", lines", static_cast<std::int64_t>(lines.size()), static_cast<std::int64_t>(expected.size()));
    for (std::size_t i = 0; i < lines.size() && i < expected.size(); ++i)
      into.equal(fmt::format("{}, line {}", line, i + 1), lines[i], expected[i]);
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  std::map<unsigned, double> p_, m_, q_[16];
  std::vector<std::pair<unsigned, unsigned>> written_[3];  // of P, Q, M: coordinate system and number
  std::map<unsigned, std::int64_t> i_;
  std::map<unsigned, const Group*> rule_;
  unsigned i9_ = 2, locks_ = 0, lies_ = 0;
};

constexpr unsigned kLeastPlain = 300, kLeastLimited = 250;  // ranges are long or short: on until so many are compared

void plain(BenchContext& b, Store& store) {
  store.command("M0..8191->*");
  store.command("M0..8191=0");
  for (unsigned round = 0; round < 20 || store.plain_reads.made() < kLeastPlain; ++round) {
    store.set_i9(round % 4);  // P, Q and M are bare in each
    store.write_plain();
    store.write_plain();
    store.read_plain();
    store.read_plain();
  }
  b.report.step("P, Q, M read back", store.plain_reads, kLeastPlain,
                fmt::format("{} compared, as they were written", store.plain_reads.made()));
}

void limited(BenchContext& b, Store& store) {
  for (unsigned round = 0; round < 30 || store.i_reads.made() < kLeastLimited; ++round) {
    store.set_i9(round % 4);
    if (round % 10 == 7) store.lock(1 + round / 10 % 3);  // motors, coordinate systems, both, neither of them
    if (round % 10 == 9) store.lock(0);
    store.write_i();
    store.read_i();
    store.read_i();
  }
  store.lock(0);
  b.report.step("I read back", store.i_reads, kLeastLimited, fmt::format("{} compared", store.i_reads.made()));
}

// Definitions: sent in any spelling, reported in one.
void definitions(BenchContext& b, Store& store) {
  Comparison compared;
  for (unsigned round = 0; round < 16; ++round) {
    const char space = "XY"[store.random(2)];
    const unsigned address = 0x10000 + store.random(0x1000), number = 100 + store.random(8000);
    static constexpr unsigned kWidths[] = {1, 4, 8, 12, 16, 20};
    const unsigned width = kWidths[store.random(6)], offset = store.random(24 - width + 1);
    const bool with_sign = width != 1 && store.random(2) == 0;
    std::string sent, expected;
    switch (store.random(5)) {
      case 0:
        sent = fmt::format("L:${:06x}", address);
        expected = fmt::format("L:${:X}", address);
        break;
      case 1:
        sent = fmt::format("D:{}", address);
        expected = fmt::format("D:${:X}", address);
        break;
      case 2:
        sent = fmt::format("{}:${:X},{}24{}", space, address, store.random(2) == 0 ? "0," : "", with_sign ? ",S" : "");
        expected = fmt::format("{}:${:X},24{}", space, address, with_sign ? ",S" : "");
        break;
      default:
        sent = fmt::format("{}:${:07X},{},{}{}", space, address, offset, width, with_sign ? ",S" : ",U");
        expected = fmt::format("{}:${:X},{}", space, address, offset);
        if (width != 1) expected += fmt::format(",{}{}", width, with_sign ? ",S" : "");
    }
    if (width == 1 && sent.find(",1,U") != std::string::npos) sent = sent.substr(0, sent.size() - 2);
    store.command(fmt::format("M{}->{}", number, sent));
    const unsigned i9 = round % 4;
    store.set_i9(i9);
    const std::string head = (i9 & 1) != 0 ? fmt::format("M{}->", number) : "";
    compared.equal(fmt::format("M{}->{}", number, sent), b.ask(fmt::format("M{}->", number)), head + expected);
    store.command(fmt::format("M{}->*", number));
    compared.equal("cleared", b.ask(fmt::format("M{}->", number)), head + "*");
  }
  store.set_i9(2);
  b.report.step("M definitions", compared, 32, fmt::format("{} compared", compared.made()));
}

// Bits of words through M-variables: the others stay as they are.
void bits(BenchContext& b, Store& store) {
  Comparison compared;
  unsigned word = 0;
  store.command("WX$10F0,0");
  for (unsigned round = 0; round < 12; ++round) {
    static constexpr unsigned kWidths[] = {1, 4, 8, 12, 16};
    const unsigned width = kWidths[store.random(5)], offset = store.random(24 - width + 1);
    const unsigned value = store.random(1u << width), mask = ((1u << width) - 1) << offset;
    store.command(fmt::format("M1->X:$10F0,{},{} M1={}", offset, width, value));
    word = (word & ~mask) | value << offset;
    compared.equal(fmt::format("bits {} wide from {}", width, offset), b.ask("RHX$10F0"), fmt::format("{:X}", word));
    compared.equal("M1", b.ask("M1"), std::to_string(value));
  }
  store.command("M1->*");
  b.report.step("bits of a word", compared, 24, "the others stay");
}

void refusals(BenchContext& b) {
  // Read-only: taken and without effect. They say what is fitted (firmware:2.2), which is 5 or 7 on no board.
  const unsigned fitted = b.board.fitted, servo_ics = (fitted & 0x3FF) | (fitted >> 10 & 0xFF) << 12;
  b.expect("I4900=5 I4900..4902=7", "");
  b.expect("I4900..4902", fmt::format("${0:X}|${0:X}|${1:X}", servo_ics, fitted >> 18));
  for (const char* line : {"I8192", "P8192=1", "P5..4", "I5,0", "M(-1)", "P1.5", "Q8192", "I100..8192=*"})
    b.expect(line, "ERR003");
  b.expect("P1=7 P8192=3 P1=8", "ERR003");
  b.expect("P1", "7");  // what stood before the error has taken effect, the rest has not
  b.expect(fmt::format("I10={}", kServoPeriod), "");
  b.expect("I111,32,100=* I111 I3211", "32000|32000");
}

void run(BenchContext& b) {
  Store store(b);
  plain(b, store);
  limited(b, store);
  definitions(b, store);
  bits(b, store);
  refusals(b);
  b.report.step("commands taken", store.writes, 150, fmt::format("{} without an error", store.writes.made()));
}

}  // namespace

// covers: I9-1 I9-2 I9-3
Bench variables_bench() {
  return {"variables",
          "random writes and reads of I, P, Q and M by ranges, steps and computed numbers, in all settings of I9",
          {"one write of P, Q or M in ten is told to the scoreboard with a wrong value", "P, Q, M read back",
           ", expected "},
          run};
}

}  // namespace brick
