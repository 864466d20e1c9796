// Writes a host script by chance, for script_fuzz.py: what random hosts send, and between it lines of the script's own.
//   script_lines SEED [broken]
// Each line can be read, and at its end the controller is asked whether it is alive; or bytes are broken, so that all
// may happen that a file can do.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "app/script.h"
#include "testbench/unit/random_lines.h"

namespace brick {
namespace {

constexpr unsigned kLines = 40, kBreaks = 12;

const std::vector<std::string> kOwn{"@wait 1ms",
                                    "@pic",
                                    "@pic MSK=02 ELR=00",
                                    "@dpram 0x100 4",
                                    "@dpram 0x100 = 1 FFFF",
                                    "@signal host.breq",
                                    "@time",
                                    "@reset",
                                    "@encoder 1 -20 9000",
                                    "@jumper E3 off",
                                    "I3=0",
                                    "I3=1",
                                    "I3=3 I4=1",
                                    "I4=1",
                                    "I4=0 I6=3",
                                    "I6=0",
                                    "I6=2 UUU",
                                    "I3=2 I4=0 I6=1",
                                    "P0..8191=1 UUU",
                                    "^A",
                                    "^X",
                                    "^G^B",
                                    "^I",
                                    "$$$",
                                    "#define A P1",
                                    "A",
                                    "#ifdef A\nP2\n#endif",
                                    "/* a\nb */ P3",
                                    "#1j+ ; a motor",
                                    "@expect"};

// By itself as what the controller is sent, no @ line that chance has made; and behind what stands there already, whose
// macros may make it too long.
bool can_be_read(const std::string& before, const std::string& line) {
  std::istringstream alone(line), behind(before + line);
  try {
    for (const ScriptLine& read : read_script(alone, "line"))
      if (read.text[0] == '@') return false;
    read_script(behind, "lines");
  } catch (const UsageError&) { return false; }
  return true;
}

std::string script(unsigned seed, bool broken) {
  RandomLines lines(seed);
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return random() % n; };
  std::string text;
  for (unsigned n = 0; n < kLines; ++n) {
    const std::string& own = kOwn[below(kOwn.size() - (broken ? 0 : 1))];  // @expect may fail
    const std::string next = below(4) == 0 ? own : lines.next();
    if (broken || next == own || can_be_read(text, next)) text += next + '\n';
  }
  for (unsigned n = 0; broken && n < kBreaks; ++n) text[below(text.size())] = static_cast<char>(random());
  if (!broken) text += "CLOSE\n@signal watchdog.tripped\n@expect watchdog.tripped=0\nVERSION\n";
  return text;
}

}  // namespace
}  // namespace brick

int main(int argc, char** argv) {
  const auto seed = static_cast<unsigned>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 0);
  const std::string text = brick::script(seed, argc > 2);
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}
