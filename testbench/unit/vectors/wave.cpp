#include "testbench/unit/vectors/wave.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "systemc/core/usage_error.h"

namespace brick {
namespace {

using Json = nlohmann::ordered_json;

class Drawing {
 public:
  Drawing(const Vector& vector, const RunResult& run) : vector_(vector), wave_(*vector.wave), run_(run) {}

  std::string text() {
    for (const WaveWindow& w : wave_.windows) place(w);
    nodes_.assign(wave_.signals.size(), std::string(width_, '.'));
    std::vector<std::string> edges;
    for (const WaveArrow& arrow : wave_.arrows) edges.push_back(draw(arrow));

    std::string all = "{\n  \"signal\": [";
    for (std::size_t i = 0; i < wave_.signals.size(); ++i)
      all += fmt::format("{}\n    {}", i == 0 ? "" : ",", lane(i).dump());
    all += "\n  ],\n  \"edge\": " + Json(edges).dump() + ",\n";
    all += "  \"head\": " + Json{{"text", vector_.title}}.dump() + ",\n";
    all += "  \"foot\": " + Json{{"text", columns()}}.dump() + ",\n  \"config\": {\"skin\": \"narrow\"}\n}\n";
    return all;
  }

 private:
  struct Stretch {
    int line;
    Tick from, to, step;
    std::size_t column;  // of `from`
  };

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw UsageError(fmt::format("{}:{}: {}", vector_.path, line, what));
  }

  void place(const WaveWindow& w) {
    const Stretch s{w.line, run_.at(w.window.from), run_.at(w.window.to), w.step,
                    width_ + (stretches_.empty() ? 0 : 1)};
    const auto bricks = (s.to - s.from + s.step - 1) / s.step;
    constexpr Tick kMost = 80;
    if (bricks < 1 || bricks > kMost)
      fail(w.line, fmt::format("the window has {} columns; expected 1 to {}", bricks, kMost));
    stretches_.push_back(s);
    width_ = s.column + static_cast<std::size_t>(bricks);
  }

  Json lane(std::size_t row) const {
    const unsigned signal = wave_.signals[row];
    const std::string& name = vector_.signals[signal].name;
    if (name == "bus") return bus_lane(signal);
    const unsigned width = vector_.signals[signal].width;
    const bool number = width > 1 || name.find(".position") != std::string::npos;
    const std::optional<unsigned> enable = enable_of(signal);
    std::string wave;
    std::vector<std::string> data;
    bool drawn = false;  // the column before shows `last`
    std::uint32_t last = 0;
    for (const Stretch& s : stretches_) {
      if (!wave.empty()) wave += '|';
      for (Tick t = s.from; t < s.to; t += s.step) {
        const std::uint32_t value = run_.record.value(signal, t);
        if (enable && run_.record.value(*enable, t) == 0) {
          wave += drawn || t == s.from ? 'z' : '.';
          drawn = false;
          continue;
        }
        const bool same = drawn && last == value && !(number && t == s.from);
        drawn = true;
        last = value;
        if (run_.record.edges({signal, Edge::kChanges}, t + 1, t + s.step + 1).size() > 1)
          fail(s.line, fmt::format("several changes of {} within {} ticks from tick {}; expected a smaller step", name,
                                   s.step, t));
        wave += same ? '.' : number ? '=' : value != 0 ? '1' : '0';
        if (number && !same)
          data.push_back(width > 1 ? fmt::format("${:X}", value) : std::to_string(static_cast<std::int32_t>(value)));
      }
    }
    Json lane{{"name", name}, {"wave", wave}};
    if (number) lane["data"] = data;
    if (nodes_[row].find_first_not_of('.') != std::string::npos) lane["node"] = nodes_[row];
    return lane;
  }

  std::optional<unsigned> enable_of(unsigned signal) const {
    const auto& all = vector_.signals;
    const auto found = std::find_if(all.begin(), all.end(), [&](const DeviceSignal& s) {
      return !all[signal].enable.empty() && s.name == all[signal].enable;
    });
    if (found == all.end()) return std::nullopt;
    return static_cast<unsigned>(found - all.begin());
  }

  // A bus cycle is short: it is shown for six columns from the one in which it ends, or until the next.
  Json bus_lane(unsigned signal) const {
    constexpr int kColumns = 6;
    std::string wave;
    std::vector<std::string> data;
    for (const Stretch& s : stretches_) {
      if (!wave.empty()) wave += '|';
      int left = 0;
      for (Tick t = s.from; t < s.to; t += s.step) {
        auto begins = run_.record.edges({signal, Edge::kChanges}, t - s.step + 1, t + 1);
        begins.erase(
            std::remove_if(begins.begin(), begins.end(), [&](Tick at) { return run_.record.value(signal, at) == 0; }),
            begins.end());
        if (!begins.empty()) {
          data.push_back(run_.bus[run_.record.value(signal, begins.back()) - 1]);
          left = kColumns;
        }
        wave += !begins.empty() ? '=' : left > 0 ? '.' : t == s.from || left == 0 ? 'z' : '.';
        --left;
      }
    }
    return {{"name", signal_name(signal)}, {"wave", wave}, {"data", data}};
  }
  const std::string& signal_name(unsigned signal) const { return vector_.signals[signal].name; }

  std::string draw(const WaveArrow& arrow) {
    const Tick from = edge(arrow, arrow.from, run_.at(arrow.after)), to = edge(arrow, arrow.to, from + 1);
    const char a = node(arrow, arrow.from, from), b = node(arrow, arrow.to, to);
    std::string label = arrow.text;
    const std::size_t hole = label.find("{}");
    if (hole != std::string::npos) label.replace(hole, 2, std::to_string(to - from));
    return fmt::format("{}{}{} {}", a, arrow.from.signal == arrow.to.signal ? "<->" : "~>", b, label);
  }
  Tick edge(const WaveArrow& arrow, SignalEdge e, Tick t) const {
    const auto found = run_.record.edges(e, t, stretches_.back().to);
    if (found.empty())
      fail(arrow.line,
           fmt::format("no such edge of {} after tick {}; expected one", vector_.signals[e.signal].name, t));
    return found.front();
  }
  char node(const WaveArrow& arrow, SignalEdge e, Tick t) {
    const auto row = std::find(wave_.signals.begin(), wave_.signals.end(), e.signal);
    if (row == wave_.signals.end())
      fail(arrow.line,
           fmt::format("`{}` is not drawn; expected a signal of the figure", vector_.signals[e.signal].name));
    for (const Stretch& s : stretches_) {
      if (t < s.from || t >= s.to) continue;
      char& at = nodes_[static_cast<std::size_t>(row - wave_.signals.begin())]
                       [s.column + static_cast<std::size_t>((t - s.from + s.step - 1) / s.step)];
      if (at == '.') at = next_node_++;
      return at;
    }
    fail(arrow.line, fmt::format("the edge of {} at tick {} lies in no window; expected one inside",
                                 vector_.signals[e.signal].name, t));
  }

  std::string columns() const {
    std::string all;
    for (const Stretch& s : stretches_) all += fmt::format("{}{}", all.empty() ? "one column: " : " | ", s.step);
    return all + (all == "one column: 1" ? " tick" : " ticks");
  }

  const Vector& vector_;
  const Wave& wave_;
  const RunResult& run_;
  std::vector<Stretch> stretches_;
  std::size_t width_ = 0;
  std::vector<std::string> nodes_;
  char next_node_ = 'A';  // capitals are not printed
};

}  // namespace

std::string wavedrom(const Vector& vector, const RunResult& run) { return Drawing(vector, run).text(); }

}  // namespace brick
