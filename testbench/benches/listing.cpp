// listing: random programs of every kind are entered as a host may spell them, listed in all settings of I9 as a whole
// and in parts, cleared, downloaded from the listing and listed again. What a listing has to be is written together
// with the text that is sent (testbench/benches/program_text.h), from firmware:4.8 and firmware:1.6; nothing of the
// firmware takes part.
#include <map>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/program_text.h"

namespace brick {
namespace {

constexpr unsigned kPrograms = 2, kStatements = 10;                  // of each kind
constexpr unsigned kLeastKindsOfStatements = 25, kMostRounds = 100;  // until chance has left nothing out
constexpr std::size_t kLongestPart = 1400;                           // characters that clients take at a time

struct Kind {
  const char* name;
  ProgramText::Kind kind;
};
constexpr Kind kKinds[] = {{"PROG 7", ProgramText::kMotion},
                           {"PLC 31", ProgramText::kPlc},
                           {"FORWARD", ProgramText::kKinematic},
                           {"INVERSE", ProgramText::kKinematic}};

void compare(Comparison& compared, const std::string& where, const std::vector<std::string>& measured,
             const std::vector<std::string>& expected) {
  compared.equal(where + ", lines", static_cast<std::int64_t>(measured.size()),
                 static_cast<std::int64_t>(expected.size()));
  for (std::size_t i = 0; i < measured.size() && i < expected.size(); ++i)
    compared.equal(fmt::format("{}, line {}", where, i + 1), measured[i], expected[i]);
}

class Host {
 public:
  Host(BenchContext& b, const Kind& kind) : b_(b), name_(kind.name) {}

  void enter(Comparison& compared, const std::vector<std::string>& lines) {
    compared.equal("OPEN", b_.ask(name("OPEN") + " CLEAR"), "");
    for (const std::string& line : lines) compared.equal("`" + line + "`", b_.ask(line), "");
    compared.equal("CLOSE", b_.ask("CLOSE"), "");
  }
  std::vector<std::string> list() { return b_.link.command(name("LIST")).lines; }

  // As clients do it: 80 words at a time, on from the last offset, until there is no more.
  std::vector<std::string> list_in_parts(Comparison& compared) {
    std::map<unsigned long, std::string> lines;
    for (unsigned long start = 0; lines.size() < 1000;) {
      const Reply part = b_.link.command(fmt::format("{},{},80", name("LIST"), start));
      if (part.error || part.lines.empty()) break;
      compared.within("characters of a part", static_cast<std::int64_t>(part.raw.size()), 1, kLongestPart);
      for (const std::string& line : part.lines) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos || line.find_first_not_of("0123456789") != colon) {
          compared.equal("offset of a line", line, "a number and a colon");
          return {};
        }
        lines[std::stoul(line)] = line.substr(colon + 1);
      }
      const unsigned long last = lines.rbegin()->first;
      start = last > start ? last : last + 1;
    }
    std::vector<std::string> text;
    for (const auto& line : lines) text.push_back(line.second);
    return text;
  }

  void clear(Comparison& compared) {
    compared.equal("CLEAR", b_.ask(name("OPEN") + " CLEAR CLOSE"), "");
    compared.equal("LIST of what is cleared", b_.ask(name("LIST")), "ERR003");
  }

 private:
  std::string name(const char* command) const { return fmt::format("{} {}", command, name_); }

  BenchContext& b_;
  std::string name_;
};

void round_trips(BenchContext& b, const Kind& kind, ProgramText& text) {
  Host host(b, kind);
  Comparison entered, listed, parts, cleared, downloaded;
  const std::string empty = b.ask("SIZE");
  for (unsigned program = 0; program < kPrograms; ++program) {
    text.begin(kind.kind, kStatements);
    host.enter(entered, text.sent());
    // The negative control: the scoreboard is told another number in a line.
    if (b.negative) text.spoil();
    const std::string used = b.ask("SIZE");
    cleared.judged("SIZE with a program", used == empty ? "as without" : "");
    for (unsigned i9 = 0; i9 < 4; ++i9) {
      b.ask(fmt::format("I9={}", i9));
      const std::vector<std::string>& expected = text.listed((i9 & 1) != 0);
      compare(listed, fmt::format("I9={}", i9), host.list(), expected);
      if (program == 0 && i9 < 2)
        compare(parts, fmt::format("I9={}, in parts", i9), host.list_in_parts(parts), expected);
    }
    const bool in_long = program % 2 == 0;
    b.ask(in_long ? "I9=1" : "I9=0");
    const std::vector<std::string> listing = host.list();
    host.clear(cleared);
    cleared.equal("SIZE when it is cleared", b.ask("SIZE"), empty);
    host.enter(downloaded, listing);
    compare(downloaded, "downloaded", host.list(), text.listed(in_long));
    downloaded.equal("SIZE when it is downloaded", b.ask("SIZE"), used);
    host.clear(cleared);
  }
  const std::string name = kind.name;
  const unsigned lines = kPrograms * kStatements / 2;  // at least: some stand on one line
  b.report.step(name + " entered", entered, lines, fmt::format("{} lines taken", entered.made()));
  b.report.step(name + " listed", listed, 4 * lines, fmt::format("{} lines as they have to be", listed.made()));
  b.report.step(name + " listed in parts", parts, 2 * kStatements, fmt::format("{} compared", parts.made()));
  b.report.step(name + " cleared", cleared, 4 * kPrograms, "gone, and its memory free");
  b.report.step(name + " downloaded from its listing", downloaded, 2 * lines, "the same listing and the same size");
}

void refusals(BenchContext& b) {
  b.expect("LIST PROG 99", "ERR003");
  b.expect("OPEN PROG 9 CLEAR", "");
  b.expect("X1", "");
  b.expect("LIST", "X1");
  b.expect("CLOSE", "");
  b.expect("LIST PROG 9", "X1|RET");    // as CLOSE has left it
  b.expect("LIST PROG 9,2", "ERR003");  // its last word is at 1
  b.expect("LIST PROG 9,0,0", "");
  b.expect("LIST", "ERR003");
}

void run(BenchContext& b) {
  ProgramText text(b.seed);
  for (unsigned round = 0; round == 0 || (round < kMostRounds && text.produced() < kLeastKindsOfStatements); ++round)
    for (const Kind& kind : kKinds) round_trips(b, kind, text);
  b.report.step("statements", text.produced() >= kLeastKindsOfStatements,
                fmt::format("{} kinds, at least {}", text.produced(), kLeastKindsOfStatements));
  refusals(b);
}

}  // namespace

// covers: I9-1 I9-3 I18-3
Bench listing_bench() {
  return {
      "listing",
      "random programs entered, listed in every form, cleared, downloaded from the listing, listed again",
      {"a number in the first line of each program is told wrong to the scoreboard", "PROG 7 listed", "I9=0, line 1"},
      run};
}

}  // namespace brick
