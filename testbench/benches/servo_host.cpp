#include "testbench/benches/servo_host.h"

#include <fmt/format.h>

#include "systemc/core/clock_delays.h"

namespace brick {

namespace {
constexpr std::size_t kLineLength = 190;
}

ServoHost::ServoHost(BenchContext& bench, std::uint64_t seed) : bench_(bench), random_(seed) {
  for (unsigned ic = 0; ic < kMaxServoIcs && ics_.size() < 2; ++ic)
    if ((bench.board.fitted >> ic & 1) != 0) ics_.push_back(ic);
}

unsigned ServoHost::i_global(unsigned place, unsigned k) const {
  return regs::kGateIcs[ic(place)].direction_variable - 7 + k;
}
unsigned ServoHost::i_channel(unsigned channel, unsigned k) const {
  return i_global(channel / kChannels, 0) + 10 * (channel % kChannels + 1) + k;
}
std::uint32_t ServoHost::base(unsigned place) const { return regs::kGateIcs[ic(place)].base; }
std::uint32_t ServoHost::address(unsigned channel, const regs::Register& word) const {
  return base(channel / kChannels) + 8 * (channel % kChannels) + word.address;
}
std::string ServoHost::name(unsigned channel) const {
  return fmt::format("{}.ch{}", servo_ic_scope(ic(channel / kChannels)), channel % kChannels + 1);
}

Tick ServoHost::behind(unsigned place) const {
  return bench_.machine.outputs().get(pin::kPhaseSource) == ic(place) ? -kNetDelay : kPinDelay;
}

std::string ServoHost::ask(const std::string& line) {
  before_command();
  return bench_.ask(line);
}

void ServoHost::expect(const std::string& line, const std::string& answer) {
  before_command();
  bench_.expect(line, answer);
}

void ServoHost::say(const std::vector<std::string>& words) {
  std::string line;
  const auto send = [&] {
    const std::string answer = ask(line);
    if (!answer.empty()) bench_.report.fail(line, answer);
    line.clear();
  };
  for (const std::string& word : words) {
    if (line.size() + 1 + word.size() > kLineLength) send();
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty()) send();
}

std::vector<long> ServoHost::numbers(const std::string& line) {
  before_command();
  return bench_.numbers(line);
}

void ServoHost::define(unsigned number, const regs::Register& word, bool is_signed, regs::Field part) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < channels(); ++i)
    words.push_back(fmt::format("M{}->{}:${:X},{},{},{}", 100 * i + number, word.space, address(i, word), part.lsb,
                                part.width, is_signed ? 'S' : 'U'));
  say(words);
}

}  // namespace brick
