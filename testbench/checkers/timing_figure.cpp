// A cycle of the CPU's bus as a WaveDrom figure.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "testbench/checkers/timing_port_a.h"
#include "testbench/checkers/timing_report.h"

namespace brick {

namespace {

constexpr unsigned kLead = 4;  // quarters shown before and after the cycle

// A lane of one character a step: `before`, then from each edge on another level.
class Lane {
 public:
  Lane(unsigned steps, char before) : wave_(steps, '.'), node_(steps, '.') { wave_[0] = before; }
  Lane& edge(unsigned step, char level) {
    wave_[std::min<std::size_t>(step, wave_.size() - 1)] = level;
    return *this;
  }
  Lane& node(unsigned step, char name) {
    node_[std::min<std::size_t>(step, node_.size() - 1)] = name;
    return *this;
  }
  nlohmann::json json(const std::string& name, const std::vector<std::string>& data = {}) const {
    nlohmann::json lane = {{"name", name}, {"wave", wave_}};
    if (!data.empty()) lane["data"] = data;
    if (node_.find_first_not_of('.') != std::string::npos) lane["node"] = node_;
    return lane;
  }

 private:
  std::string wave_, node_;
};

}  // namespace

nlohmann::json timing_figure(const PinCycle& c, const std::string& caption) {
  // An edge between two steps is drawn at the later one.
  const TimeFs quarter = PortATiming::quarters(1, c.multiplier);
  const auto step = [&](TimeFs t) {
    return kLead + static_cast<unsigned>((std::max<TimeFs>(t - c.start, 0) + quarter - 1000) / quarter);
  };
  const unsigned steps = step(c.end) + kLead;
  const auto ns = [](TimeFs from, TimeFs to) {
    return fmt::format("{:.1f} ns", static_cast<double>(to - from) / kFsPerNs);
  };
  Lane address(steps, 'x'), strobe(steps, '1'), data(steps, 'x'), ta(steps, '0');
  address.edge(kLead, '=').edge(step(c.end), 'x').node(kLead, 'a');
  strobe.edge(step(c.strobe_low), '0').edge(step(c.strobe_high), '1').node(step(c.strobe_low), 'b');
  strobe.node(step(c.strobe_high), 'd');
  const TimeFs stands = c.data_valid;
  data.edge(std::max(step(stands), kLead), c.corrupted ? '8' : '=').node(step(stands), 'c');
  data.edge(step(c.data_held), 'x');
  if (c.stretched > 0) ta.edge(step(c.strobe_low), '1').edge(step(c.ta_moved), '0');
  const std::string word = fmt::format("${:06X}", c.data);
  const std::string from = c.write ? "c->d " : "a->c ";
  return {
      {"signal",
       {address.json("A, AA", {fmt::format("{}:${:06X}", c.x ? 'X' : 'Y', c.address)}),
        strobe.json(c.write ? "/WR" : "/RD"), data.json(c.write ? "D (CPU)" : "D (board)", {word}), ta.json("/TA")}},
      {"edge",
       {from + (c.write ? ns(stands, c.strobe_high) : ns(c.start, stands)), "b->d " + ns(c.strobe_low, c.strobe_high)}},
      {"head", {{"text", caption}}},
      {"foot",
       {{"text", fmt::format("{} wait states, {} by /TA, I52 = {}; a step is TC / 4", c.wait_states, c.stretched,
                             c.multiplier - 1)}}},
      {"config", {{"hscale", 1}}}};
}

}  // namespace brick
