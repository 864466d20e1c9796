// reversal: one contour in several coordinate systems at once, each stopped and turned round by other orders at times
// of its own: quick stops, back to the start, back to the oldest stored segment, single segments, H and %, and the same
// orders where there is no lookahead; then back to a DWELL and not beyond it. Backwards is judged by the same path as
// forwards, to 1/16 count; limits as differences; synchronous assignments by the word that they write, at each servo
// interrupt (motion:7.5).
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/path_host.h"

namespace brick {
namespace {

using System = PathHost::System;

constexpr double kSegment = 2, kTa = 4, kFeed = 12;  // ms; counts/ms
constexpr double kPi = 3.14159265358979323846;
constexpr double kSpeed = 12, kAcceleration = 1.5;   // Ixx16, Ixx17
constexpr unsigned kRecords = 60, kFewRecords = 16;  // segments of the buffers
constexpr unsigned kSlots = 8;                       // for assignments
constexpr std::uint32_t kWord = 0x10F0;              // Y, of the first system's assignments

struct Order {
  double ms;         // behind the system's first move, up to kJitter later
  std::string line;  // to the system
};
constexpr double kJitter = 3;
constexpr double kStep = 0.5, kLongest = 250;  // ms
constexpr double kBegins = 10;                 // ms until the last order moves what has stood for long

constexpr const char* kDwelling = "B9R";         // the program that dwells
constexpr double kThere = 28, kBackFeed = 1.75;  // counts; counts/ms on the slow way from the DWELL

struct Case {
  std::string name;
  unsigned ahead, records;
  std::vector<Order> orders;
  bool dwells = false;  // the second program follows, with a DWELL in it
  bool limited = true;  // by Ixx16 and Ixx17, as nothing but lookahead changes the rate
  enum { kStays, kToStart, kToOldest, kTurns } back = kStays;
};

std::vector<Case> cases() {
  return {{"\\, single segments, >",
           12,
           kRecords,
           {{12, "\\"}, {24, "I5{}21=14"}, {32, "I5{}21=14"}, {40, "I5{}21=15"}, {50, ">"}},
           false,
           true,
           Case::kTurns},
          {"< to the oldest segment", 12, kFewRecords, {{28, "<"}, {72, ">"}}, false, true, Case::kToOldest},
          {"Isx20=1: H, %, < to the start",
           1,
           kRecords,
           {{6, "H"}, {11, "R"}, {15, "%50"}, {20, "<"}, {28, "%100"}, {120, ">"}},
           false,
           false,
           Case::kToStart},
          {"Isx20=0: < is H, > is R",
           0,
           kRecords,
           {{6, "<"}, {16, ">"}, {59, "I5{}20=12"}, {60, kDwelling}, {93, "<"}, {135, ">"}},
           true,
           false}};
}

struct Contour {
  std::vector<std::string> program;  // `{}` is the number of the assigned variable
  std::vector<SplineMove> moves;
  MotorPoint way;
};

Contour contour() {
  const auto straight = [](double x, double y) { return line_move(std::max(kTa, std::hypot(x, y) / kFeed), {x, y}); };
  return {
      {"M{}==1 X120", "M{}==2 X20 Y80", "M{}==3 CIRCLE2 X-60 Y60 I-60 J0", "M{}==4 LINEAR X-72 Y-30", "M{}==5 X60"},
      {straight(120, 0), straight(20, 80), arc_move(kPi / 2 * 60 / kFeed, {-60, 60}, {{-60, 0, 0}, {0, 0, 1}, kPi / 2}),
       straight(-72, -30), straight(60, 0)},
      {68, 110}};
}

class Reversal {
 public:
  explicit Reversal(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void define(unsigned systems, const std::vector<Case>& all, std::size_t first);
  void give_orders(const std::vector<Case>& all, std::size_t first, unsigned count);
  void judge(const Case& c, const System& s);
  void judge_dwell(const System& s, std::size_t from);
  void judge_assignments(const System& s, const PathHost::Followed& f);
  void judge_turn(const Case& c, const System& s, const SplinePath& path, const PathHost::Followed& f);

  PathHost host_;
  Contour contour_ = contour();
  std::size_t dwelling_ = 0;  // the sample at which that program is started
};

// The highest system first, the lowest deleted first.
void Reversal::define(unsigned count, const std::vector<Case>& all, std::size_t first) {
  for (unsigned s = 1; first > 0 && s <= host_.systems(); ++s) host_.expect(fmt::format("&{}DELETE LOOKAHEAD", s), "");
  for (unsigned s = count; s >= 1; --s) {
    const Case& c = all[first + s - 1];
    host_.expect(fmt::format("&{}DEFINE LOOKAHEAD {},{}", s, c.records, kSlots), "");
    host_.say({fmt::format("%100 I5{0}20={1} I5{0}13={2} M{3}=0", s, c.ahead, kSegment, 200 + s)});
  }
}

// Each system's own, from its first move on.
void Reversal::give_orders(const std::vector<Case>& all, std::size_t first, unsigned count) {
  struct Orders {
    std::vector<Order> left;
    std::optional<Tick> began;
  };
  std::vector<Orders> systems;
  std::size_t left = 0;
  for (unsigned s = 1; s <= count; ++s) {
    systems.push_back({all[first + s - 1].orders, {}});
    for (Order& o : systems.back().left) o.ms += host_.pick(1000) / 1000.0 * kJitter;
    left += systems.back().left.size();
  }
  bool again = host_.bench().negative;  // the control: an assignment that has been made is made again
  for (double waited = 0; left > 0 && waited < kLongest; waited += kStep) {
    host_.wait_ms(kStep);
    for (unsigned s = 1; s <= count; ++s) {
      Orders& o = systems[s - 1];
      if (!o.began && host_.departs(2 * s - 1)) o.began = host_.now();
      if (o.left.empty() || !o.began) continue;
      if (host_.now() - *o.began < ns_to_ticks(static_cast<std::uint64_t>(o.left.front().ms * 1e6))) continue;
      const std::string line = fmt::format(fmt::runtime(o.left.front().line), s);
      if (line == kDwelling) dwelling_ = host_.last(2 * s - 1);
      host_.expect(fmt::format("&{}{}", s, line), "");
      if (line == ">" && std::exchange(again, false)) host_.say({fmt::format("M{}=1", 200 + s)});
      o.left.erase(o.left.begin());
      --left;
    }
  }
  if (left > 0) report().fail("orders", "some motor has not begun");
}

// Each once, in order, with the segment in which its blend begins or the one beside it.
void Reversal::judge_assignments(const System& s, const PathHost::Followed& f) {
  const auto& words = host_.watched(s.number - 1);
  Comparison compared;
  std::uint32_t expected = 0;
  for (std::size_t i = 1; i < words.size() && i < f.times.size(); ++i) {
    if (words[i] == words[i - 1]) continue;
    compared.equal(fmt::format("at sample {}", i), words[i], ++expected);
    double begins = 0;
    for (std::uint32_t k = 1; k < expected; ++k) begins += contour_.moves[k - 1].time;
    const double off = f.times[i] - begins - kSegment;
    compared.judged(fmt::format("assignment {}", expected),
                    std::fabs(off) <= 1.5 * kSegment ? "" : fmt::format("{:.1f} ms from its corner", off));
  }
  compared.equal("in all", expected, static_cast<std::int64_t>(contour_.moves.size()));
  report().step(s.name + ": assignments", compared, 11, "each once, in order, at its corner");
}

void Reversal::judge_turn(const Case& c, const System& s, const SplinePath& path, const PathHost::Followed& f) {
  double high = 0, back = 0, from = 0;  // ms of program time; the longest way back
  std::size_t to = 0;
  for (std::size_t i = 0; i < f.times.size(); ++i) {
    high = std::max(high, f.times[i]);
    if (high - f.times[i] > back) back = high - f.times[i], from = high, to = i;
  }
  const double knots = f.times[to] / kSegment;
  const MotorPoint at = host_.at(s, to);
  const std::string text = fmt::format("back from {:.2f} to {:.2f} ms of {:.1f}, ({:.4f}, {:.4f})", from, f.times[to],
                                       path.end(), at[0], at[1]);
  switch (c.back) {
    case Case::kStays:
      report().step(s.name + ": does not go back", back < 0.01, text);
      break;
    case Case::kToStart:
      report().step(s.name + ": back", back > 8 && at[0] == 0 && at[1] == 0, text + ", expected exactly the start");
      break;
    case Case::kToOldest: {
      // By then all of the path's points have been in the buffer, the last ones are.
      const auto oldest = static_cast<double>(path.points().size() - kFewRecords);
      report().step(
          s.name + ": back", std::fabs(knots - oldest) < 0.05 && back > 4 * kSegment,
          text + fmt::format(", expected to {:.2f} ms, the oldest of {} points", oldest * kSegment, kFewRecords));
      break;
    }
    case Case::kTurns:
      report().step(s.name + ": goes back", back > 0.9 * kSegment && back < 1.1 * kSegment,
                    text + ", expected a segment");
  }
}

// There, a DWELL, and slowly back: `<` goes to where the DWELL was and stays there, `>` to the end.
void Reversal::judge_dwell(const System& s, std::size_t from) {
  const System named{s.number, s.motors, "behind a DWELL"};
  const MotorPoint dwell{contour_.way[0] + kThere, contour_.way[1]};
  std::size_t there = from;
  const auto is_there = [&](std::size_t sample) {  // to the unit of a position word
    const MotorPoint p = host_.at(s, sample);
    return std::hypot(p[0] - dwell[0], p[1] - dwell[1]) < 0.5 / PathHost::kUnits;
  };
  while (there < host_.last_of(s, {}) && !is_there(there)) ++there;
  const SplinePath path({line_move(kThere / kBackFeed, {-kThere, 0})}, kTa, 0, kSegment);
  const auto f = host_.followed(named, path, {there, ~std::size_t{0}}, dwell);
  host_.report_followed(named, f, 80);
  host_.report_limits(named, {{kSpeed, kAcceleration}, {kSpeed, kAcceleration}}, 0.9, {from, ~std::size_t{0}});
  double high = 0, back = 0;
  std::size_t stands = 0;
  for (std::size_t i = 0; i < f.times.size(); ++i) {
    high = std::max(high, f.times[i]);
    back = std::max(back, high - f.times[i]);
    stands += high > 4 * kSegment && is_there(there + i);
  }
  report().step(named.name + ": back to it, not beyond", back > 4 * kSegment && stands > 2,
                fmt::format("{:.2f} ms back, exactly there in {} servo interrupts, expected {} ms and 3", back, stands,
                            4 * kSegment));
}

void Reversal::judge(const Case& c, const System& s) {
  const SplinePath path(contour_.moves, kTa, 0, kSegment);
  const auto f = host_.followed(s, path, {0, c.dwells ? dwelling_ : ~std::size_t{0}});
  if (c.dwells) judge_dwell(s, dwelling_);
  host_.report_followed(s, f, 80);
  if (c.limited) host_.report_limits(s, {{kSpeed, kAcceleration}, {kSpeed, kAcceleration}}, 0.9);
  judge_turn(c, s, path, f);
  judge_assignments(s, f);
  host_.report_end(s, contour_.way);
  report().equal(s.name + ": run-time error", host_.run_time_error(s), 0u);
}

void Reversal::run() {
  const unsigned systems = host_.systems();
  if (systems < 1) return report().fail("channels", "expected two");
  host_.set_up();
  for (const auto& [k, value] : {std::pair{92u, 0.0}, {16u, kSpeed}, {17u, kAcceleration}}) host_.variables(k, value);
  host_.expect("DELETE GATHER", "");
  std::vector<std::uint32_t> words;
  for (unsigned s = 1; s <= systems; ++s) {
    host_.expect(fmt::format("&{}#{}->1X#{}->1Y", s, 2 * s - 1, 2 * s), "");
    host_.say(
        {fmt::format("I5{0}90=1 I5{0}98=0 I5{0}94=8388607 I5{0}95=200000 M{1}->Y:${2:X}", s, 200 + s, kWord + s - 1)});
    words.push_back(kWord + s - 1);
    host_.expect(fmt::format("OPEN PROG {} CLEAR", s), "");
    host_.expect(fmt::format("INC F{} TA{} TS0", kFeed, kTa), "");
    for (const std::string& text : contour_.program) host_.expect(fmt::format(fmt::runtime(text), 200 + s), "");
    host_.expect("CLOSE", "");
  }
  host_.expect("OPEN PROG 9 CLEAR", "");
  host_.expect(fmt::format("INC F{} TA{} TS0 X{} DWELL4 F{} X{}", kFeed, kTa, kThere, kBackFeed, -kThere), "");
  host_.expect("CLOSE", "");
  host_.close_all();
  const auto all = cases();
  for (std::size_t first = 0; first < all.size(); first += systems) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(systems, all.size() - first));
    define(count, all, first);
    std::string line;
    for (unsigned s = 1; s <= count; ++s) line += fmt::format("&{0}B{0}R ", s);
    host_.watch(words);
    host_.expect(line, "");
    give_orders(all, first, count);
    host_.wait_ms(kBegins);
    if (!host_.settle(250, 6)) report().fail(line, "still moving after 250 ms");
    for (unsigned s = 1; s <= count; ++s) judge(all[first + s - 1], {s, {2 * s - 1, 2 * s}, all[first + s - 1].name});
  }
}

}  // namespace

// covers: LA-1 LA-2 LA-4
Bench reversal_bench() {
  return {
      "reversal",
      "a contour stopped and turned round on its way: back to the oldest segment, to a DWELL, single segments, H, %; "
      "assignments once",
      {"an assignment is made a second time", "*: assignments", "at sample *: 1, expected"},
      [](BenchContext& b) { Reversal(b).run(); },
      kAServoIc,
      dac_axes<8>};
}

}  // namespace brick
