#include "testbench/benches/output_host.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "systemc/cpu/port_a.h"

namespace brick {

namespace {
constexpr std::size_t kLineLength = 190;

// servo-ic.md 1.2, with $20 and 50 more for IC m*.
std::uint32_t ic_base(unsigned ic) {
  static constexpr std::uint32_t kBase[10] = {0x78000, 0x78100, 0x78200, 0x78300, 0x79200, 0x79300, 0x7A200, 0x7A300, 0x7B200, 0x7B300};
  return ic < 10 ? kBase[ic] : kBase[ic - 8] + 0x20;
}

// A write takes place at the second edge of clk_ref that sees the strobe low (docs/servo_ic.md).
Tick taken(TimeFs strobe_low) {
  const Tick seen = fs_to_tick(strobe_low);
  return (seen + kTicksPerRef - 1) / kTicksPerRef * kTicksPerRef + kTicksPerRef;
}
}  // namespace

OutputHost::OutputHost(BenchContext& bench) : bench_(bench), random_(bench.seed * 104'729) {
  for (unsigned ic = 0; ic < kMaxServoIcs && ics_.size() < 2; ++ic)
    if ((bench.board.fitted >> ic & 1) != 0) ics_.push_back(ic);
  changes_.resize(ics_.size());
  bench.machine.attach(*this);
  bench.machine.on_bus_cycle = [this](const PortACycle& c) { cycle(c); };
  bench.bus.watch(select_pins(pin::kPhase), [this](Tick t, const BoardOutputs&, const BoardOutputs& o) {
    phase_.push_back({t, o.get(pin::kPhase) != 0});
  });
  forget();
}

OutputHost::~OutputHost() {
  bench_.bus.watch({}, nullptr);
  bench_.machine.on_bus_cycle = nullptr;
  bench_.machine.detach(*this);
}

std::uint32_t OutputHost::ics() const {
  std::uint32_t mask = 0;
  for (const unsigned ic : ics_) mask |= 1u << ic;
  return mask;
}

void OutputHost::changed(Tick tick, unsigned ic, const MotorOutputs&, const MotorOutputs& after) {
  const auto place = static_cast<std::size_t>(std::find(ics_.begin(), ics_.end(), ic) - ics_.begin());
  changes_.at(place).push_back({tick, after});
}

unsigned OutputHost::i_global(unsigned place, unsigned k) const {
  const unsigned m = ic(place);
  return 7000 + 100 * (m < 10 ? m : m - 8) + (m < 10 ? 0 : 50) + k;
}
unsigned OutputHost::i_channel(unsigned channel, unsigned k) const {
  return i_global(channel / kChannels, 0) + 10 * (channel % kChannels + 1) + k;
}
std::uint32_t OutputHost::base(unsigned place) const { return ic_base(ic(place)); }
std::uint32_t OutputHost::address(unsigned channel, unsigned offset) const {
  return base(channel / kChannels) + 8 * (channel % kChannels) + offset;
}
std::string OutputHost::name(unsigned channel) const {
  return fmt::format("{}.ch{}", servo_ic_scope(ic(channel / kChannels)), channel % kChannels + 1);
}

std::string OutputHost::ask(const std::string& line) {
  const Reply reply = bench_.link.command(line);
  std::string text = reply.complete ? "" : "no reply";
  for (const auto& l : reply.lines) text += (text.empty() ? "" : "|") + l;
  return text;
}

void OutputHost::expect(const std::string& line, const std::string& answer) { bench_.report.equal(line, ask(line), answer); }

void OutputHost::say(const std::vector<std::string>& words) {
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

std::vector<long> OutputHost::numbers(const std::string& line) {
  std::vector<long> values;
  for (const auto& l : bench_.link.command(line).lines) values.push_back(std::strtol(l.c_str(), nullptr, 10));
  return values;
}

void OutputHost::define(unsigned number, char space, unsigned offset, const std::string& part) {
  std::vector<std::string> words;
  for (unsigned i = 0; i < channels(); ++i)
    words.push_back(fmt::format("M{}->{}:${:X},{}", 100 * (i + 1) + number, space, address(i, offset), part));
  say(words);
}

void OutputHost::forget() {
  for (unsigned place = 0; place < places(); ++place) changes_[place] = {{now(), pins(place)}};
  phase_.clear();
  accesses_.clear();
}

Tick OutputHost::written(bool x, std::uint32_t address) const {
  for (auto a = accesses_.rbegin(); a != accesses_.rend(); ++a)
    if (a->write && a->x == x && a->address == address) return a->tick;
  return -1;
}

void OutputHost::cycle(const PortACycle& c) {
  if (c.on_chip || c.address < 0x78000 || c.address > 0x7BFFF) return;
  accesses_.push_back({c.write ? taken(c.strobe_low) : fs_to_tick_floor(c.data_time), c.write, c.x, c.address, c.data});
}

}  // namespace brick
