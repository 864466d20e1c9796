// rotary-machining: a contour of LINEAR and CIRCLE moves of eight axes, 200 lines a second, sent as binary lines
// through the dual-ported RAM by a host that goes by BREQ alone. Every edge of BREQ is judged by I16 and I17
// (testbench/checkers/breq_scoreboard.h), the buffer's fill by PR, the motors by path, limits and time (motion:7.4).
// Then the host stops sending in mid-contour: the motors stop at the end of what has come, and go on along the path
// when more comes. `--size`: lines until then.
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/path_host.h"
#include "testbench/checkers/breq_scoreboard.h"
#include "testbench/checkers/optimum.h"
#include "testbench/host/binary_rotary.h"

namespace brick {
namespace {

using Limits = PathHost::Limits;
using System = PathHost::System;

constexpr unsigned kLines = 44;                       // by itself
constexpr double kLineMs = 5, kSegment = 5, kTa = 4;  // 200 lines a second
constexpr double kWay = 100, kFine = 16;              // counts of a line; constants have sixteenths
constexpr unsigned kI16 = 6, kI17 = 12, kRing = 200, kItems = 512, kAhead = 8;
// After the pause: those that fill the buffer, those that lookahead takes in (a segment each, and the moves that
// blend), and as many while these are sent.
constexpr unsigned kLinesBehind = 2 * (kI17 + kAhead);
constexpr unsigned kLook = 3, kLooks = 5;                          // lines between looks at PR; how many at least
constexpr unsigned kLeast = 2 * kI17 + kLook * (kLooks - 1) + 1;   // lines for these
constexpr double kPause = 60, kPauseMore = 30, kLongestDry = 500;  // ms: behind the last line calculated; until it
constexpr unsigned kCorner = 23;                                   // every so many lines
constexpr const char* kAxes = "XYZABCUV";
constexpr double kSlower = 1.10;  // of the optimum (motion:7.4/5)
constexpr Tick kPatience = ns_to_ticks(500'000'000), kCopied = ns_to_ticks(5'000'000);
constexpr Tick kLineTime = ns_to_ticks(200'000);  // several lines may be calculated in a real-time interrupt

struct Line {
  std::string text;
  SplineMove move;
};

// A way that winds: straight lines and arcs that go on in their direction, now and then a corner. The other axes swing,
// each at its own pace.
class Contour {
 public:
  Contour(unsigned axes, std::uint64_t seed) : axes_(axes), random_(seed) {}
  Line next();

 private:
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(random_()) / 4294967296.0; }
  static double fine(double x) { return std::round(x * kFine) / kFine; }

  unsigned axes_, count_ = 0;
  std::mt19937 random_;
  double heading_ = 0;
  bool was_arc_ = true;
};

Line Contour::next() {
  if (count_ % kCorner == kCorner - 1) heading_ += uniform(0.2, 0.5) * (random_() % 2 == 0 ? 1 : -1);
  MotorPoint by(axes_);
  for (unsigned i = 2; i < axes_; ++i) {
    const double swing = 60 + 12 * i, pace = 0.05 + 0.02 * i;
    by[i] = fine(swing * (std::sin(pace * (count_ + 1)) - std::sin(pace * count_)));
  }
  ++count_;
  std::string text, centre;
  SplineMove move;
  if (random_() % 2 == 0) {
    by[0] = fine(kWay * std::cos(heading_)), by[1] = fine(kWay * std::sin(heading_));
    if (was_arc_) text = "LINEAR";
    was_arc_ = false;
    move = line_move(kLineMs, by);
  } else {
    const bool left = random_() % 2 == 0;
    const double side = left ? 1 : -1, radius = uniform(450, 1500), turn = kWay / radius;
    const double i = fine(-side * radius * std::sin(heading_)), j = fine(side * radius * std::cos(heading_));
    by[0] = fine(side * radius * (std::sin(heading_ + side * turn) - std::sin(heading_)));
    by[1] = fine(side * radius * (std::cos(heading_) - std::cos(heading_ + side * turn)));
    heading_ += side * turn;
    text = left ? "CIRCLE2" : "CIRCLE1";
    centre = fmt::format("I{}J{}", i, j);
    was_arc_ = true;
    const double angle = std::atan2(-i * (by[1] - j) + j * (by[0] - i), -i * (by[0] - i) - j * (by[1] - j));
    move = arc_move(kLineMs, by, {{i, j, 0}, {0, 0, side}, side * angle});
  }
  for (unsigned i = 0; i < axes_; ++i) text += fmt::format("{}{}", kAxes[i], by[i]);
  return {text + centre, move};
}

class RotaryMachining {
 public:
  explicit RotaryMachining(BenchContext& b);
  ~RotaryMachining();
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  std::vector<Limits> limits() const;
  void define();
  void send(std::size_t from, std::size_t to);
  bool line(const std::string& text);
  unsigned look();  // PR
  void starve();
  void breq(const std::string& step, unsigned least_raised);
  SplinePath path(std::size_t from, std::size_t to) const;
  MotorPoint way(std::size_t lines) const;  // of the first ones
  std::size_t stop(const System& s, std::size_t lines);
  void judge_time(const System& s, const SplinePath& along, PathHost::Span span, std::size_t lines);
  void judge(const System& s, std::size_t from, std::size_t to, PathHost::Span span);

  BenchContext& b_;
  PathHost host_;
  BreqScoreboard scoreboard_{kLineTime};
  BinaryRotary rotary_;
  std::vector<Line> lines_;
  unsigned least_ = ~0u, most_ = 0, looks_ = 0;  // PR while lines come
  BreqScoreboard::Counts counted_;
};

RotaryMachining::RotaryMachining(BenchContext& b) : b_(b), host_(b), rotary_(b.bus, 1) {
  b.bus.watch(select_pins(pin::kBreq), [this](Tick now, const BoardOutputs&, const BoardOutputs& after) {
    scoreboard_.edge(now, after.get(pin::kBreq) != 0);
  });
}

RotaryMachining::~RotaryMachining() { b_.bus.watch({}, nullptr); }

// Slower motors for the axes that swing.
std::vector<Limits> RotaryMachining::limits() const {
  std::vector<Limits> all(host_.motors(), Limits{8, 0.6});
  all[0] = all[1] = {24, 1};
  return all;
}

void RotaryMachining::define() {
  host_.set_up();
  host_.variables(92, 0);
  std::string definitions = "&1";
  std::vector<std::string> words{fmt::format("I16={} I17={} I45={}", kI16, kI17, host_.pick(2)),
                                 fmt::format("I5113={} I5120={} I5187={} I5188=0 I5192=0", kSegment, kAhead, kTa)};
  for (unsigned i = 0; i < host_.motors(); ++i) {
    definitions += fmt::format("#{}->1{}", i + 1, kAxes[i]);
    words.push_back(fmt::format("I{0}16={1} I{0}17={2}", i + 1, limits()[i].velocity, limits()[i].acceleration));
  }
  host_.expect(definitions, "");
  host_.say(words);
  for (const char* command : {"DELETE GATHER", "DEFINE LOOKAHEAD 40,0"}) host_.expect(command, "");
  host_.expect(fmt::format("DEFINE ROT {} B0", kRing), "");
  host_.close_all();
  scoreboard_.limits(kI16, kI17);
  scoreboard_.select(0, host_.now());
  host_.expect("&1 OPEN BIN ROT", "");
  rotary_.define(0, kItems);
  rotary_.enable();
  host_.wait(BreqScoreboard::kSettled);
  scoreboard_.settled(host_.now());
}

bool RotaryMachining::line(const std::string& text) {
  if (!b_.bus.wait_pin(pin::kBreq, 1, kPatience)) return report().step("BREQ", false, "low for half a second");
  const BinaryLine made = binary_line(text);
  if (made.result != BinaryResult::kOk || rotary_.stage(made.commands) != BinaryResult::kOk)
    return report().step(text, false, "no binary line, or no room for it");
  scoreboard_.line_sent(host_.now());
  rotary_.commit();
  if (!b_.bus.wait_pin(pin::kBreq, 0, kCopied)) return report().step(text, false, "not copied within 5 ms");
  host_.wait(BreqScoreboard::kSettled);
  scoreboard_.settled(host_.now());
  return true;
}

unsigned RotaryMachining::look() {
  const Tick from = host_.now();
  const auto ahead = static_cast<unsigned>(std::stoul(host_.ask("PR")));
  scoreboard_.lines_ahead(from, host_.now(), ahead);
  least_ = std::min(least_, ahead), most_ = std::max(most_, ahead), ++looks_;
  return ahead;
}

// No line until all have been calculated, and a while longer. What has been calculated lasts some 30 ms before the path
// has to end, and lookahead some 50 more: the motors come to rest, or are about to.
void RotaryMachining::starve() {
  double waited = 0;
  for (; look() > 0 && waited < kLongestDry; ++waited) host_.wait_ms(1);
  if (waited >= kLongestDry) report().fail("starved: PR", "lines after half a second, expected 0");
  host_.wait_ms(kPause + host_.pick(1000) / 1000.0 * kPauseMore);
}

void RotaryMachining::send(std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    if (host_.bench().negative && i == 2 * kI17) host_.wait_ms(300);  // the control
    if (!line((i == 0 ? fmt::format("INC TM{}", kLineMs) : "") + lines_[i].text)) return;
    if (i >= from + kI17 && i % kLook == 0) look();
  }
}

void RotaryMachining::breq(const std::string& step, unsigned least_raised) {
  const BreqScoreboard::Counts c = scoreboard_.counts() - counted_;
  counted_ = scoreboard_.counts();
  const auto& wrong = scoreboard_.violations();
  report().step(step, wrong.empty() && c.raised_by_execution >= least_raised,
                fmt::format("{}{} lines, {} pulses, {} times full, {} times raised by execution, expected {} or more",
                            wrong.empty() ? "" : wrong.front() + "; ", c.lines, c.pulses, c.stays_low,
                            c.raised_by_execution, least_raised));
}

SplinePath RotaryMachining::path(std::size_t from, std::size_t to) const {
  std::vector<SplineMove> moves;
  for (std::size_t i = from; i < to; ++i) moves.push_back(lines_[i].move);
  return {moves, kTa, 0, kSegment};
}

MotorPoint RotaryMachining::way(std::size_t lines) const {
  MotorPoint sum(host_.motors(), 0);
  for (std::size_t l = 0; l < lines; ++l)
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += lines_[l].move.way(1)[i];
  return sum;
}

// The sample at the end of these lines, where motors are at rest, be it for less than a servo cycle.
std::size_t RotaryMachining::stop(const System& s, std::size_t lines) {
  const MotorPoint end = way(lines);
  double nearest = 1e9;
  std::size_t found = 0;
  for (std::size_t i = 0; i <= host_.last_of(s, {}); ++i) {
    const MotorPoint p = host_.at(s, i);
    double off = 0;
    for (std::size_t m = 0; m < p.size(); ++m) off = std::max(off, std::fabs(p[m] - end[m]));
    if (off < nearest) nearest = off, found = i;
  }
  report().step("starved: stops where the lines end", nearest <= PathHost::kNear,
                fmt::format("{:.4f} counts off at sample {}, expected up to {}", nearest, found, PathHost::kNear));
  return found;
}

void RotaryMachining::judge_time(const System& s, const SplinePath& along, PathHost::Span span, std::size_t lines) {
  std::vector<optimum::Motor> motors;
  for (std::size_t i = 0; i < s.motors.size(); ++i) {
    motors.push_back({{}, limits()[i].velocity, limits()[i].acceleration});
    for (const MotorPoint& p : along.points()) motors.back().points.push_back(p[i]);
  }
  const double best = optimum::Solver(motors, kSegment).time(), took = host_.lasts(s, span);
  const std::size_t from = host_.begins(s, span.from) + 2,
                    to = from + static_cast<std::size_t>(took / host_.period()) - 4;
  std::size_t stands = 0;
  for (std::size_t i = from; i < to; ++i)
    stands += std::all_of(s.motors.begin(), s.motors.end(), [&](unsigned m) {
      return host_.samples(m)[i].commanded == host_.samples(m)[i - 1].commanded;
    });
  report().step(s.name + ": never dry", stands == 0 && to > from + 50,
                fmt::format("stands in {} servo interrupts of {}, expected 0", stands, to - from));
  report().step(s.name + ": time", took <= kSlower * best + 2 * host_.period(),
                fmt::format("{:.1f} ms for {} lines, {:.1f} a second; the optimum {:.1f}, expected up to {:.2f} of it",
                            took, lines, 1000 * static_cast<double>(lines) / took, best, kSlower));
}

void RotaryMachining::judge(const System& s, std::size_t from, std::size_t to, PathHost::Span span) {
  const SplinePath along = path(from, to);
  const auto f = host_.followed(s, along, span, way(from));
  judge_time(s, along, span, to - from);
  host_.report_followed(s, f, static_cast<std::size_t>(along.end() / host_.period()) - 4);
  host_.report_limits(s, limits(), 0.9, span);
}

void RotaryMachining::run() {
  define();
  const std::size_t count = b_.size == 0 ? kLines : b_.size, all = count + kLinesBehind;
  Contour contour(host_.motors(), b_.seed);
  while (lines_.size() < all) lines_.push_back(contour.next());
  send(0, kI17);
  host_.record();
  scoreboard_.run(0, host_.now());
  host_.expect("R", "");
  send(kI17, count);
  breq("contour: BREQ at every edge", 2);
  report().step("contour: lines in the buffer", least_ + 3 >= kI16 && most_ <= kI17 && looks_ >= kLooks,
                fmt::format("{} to {} in {} looks, expected {} to {}", least_, most_, looks_, kI16 - 3, kI17));
  System s{1, {}, "contour"};
  for (unsigned m = 1; m <= host_.motors(); ++m) s.motors.push_back(m);
  starve();
  send(count, all);
  if (!host_.settle(1000, 6)) report().fail(s.name, "still moving");
  breq("starved, then more: BREQ", 1);
  const std::size_t stood = stop(s, count);
  judge(s, 0, count, {0, stood});
  s.name = "behind the pause";
  judge(s, count, all, {stood, ~std::size_t{0}});
  host_.report_end(s, way(all));
  host_.expect("PR", "0");
  report().equal("run-time error", host_.run_time_error(s), 0u);
  rotary_.disable();
  host_.expect("CLOSE", "");
}

}  // namespace

// covers: BREQ-4 BIN-3 LA-3 LA-4
Bench rotary_machining_bench() {
  return {"rotary-machining",
          "a contour of all axes, 200 binary lines a second by BREQ alone, starved in the middle: BREQ, fill, path, "
          "limits, time",
          {"the host pauses in the middle", "contour: lines in the buffer", "looks, expected 3 to 12"},
          [](BenchContext& b) { RotaryMachining(b).run(); },
          BenchNeed{"a servo IC and a slot of 16 bits",
                    [](const BoardConfig& b) { return kAServoIc.met(b) && kASlotOf16Bits.met(b); }},
          dac_axes<8>,
          "geobrick-lv-8",
          true,
          kLeast};
}

}  // namespace brick
