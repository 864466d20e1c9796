// circle: programs of CIRCLE1 and CIRCLE2 moves in segments, as many coordinate systems at once as there are motors
// for: full turns, a helix, planes, centre and radius forms, spirals, blends with lines, feed limited by Isx78, forms
// that are errors. Each motor is judged at each servo interrupt by the path as geometry
// (testbench/checkers/spline_path.h), and inside an arc by what segments cost of its radius: V^2 T^2 / (6 R)
// (motion:7.1/4).
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/path_host.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSegment = 3, kTa = 4;  // ms, of every program
constexpr std::array<double, 3> kUp{0, 0, 1}, kDown{0, 0, -1};
constexpr unsigned kCircleError = 11, kRadiusBit = 1u << 3;  // Y:$2014; word 3 of `??`

struct Case {
  std::string name;
  unsigned motors;                   // X, Y, Z
  std::vector<std::string> program;  // lines behind INC, F and TA
  std::vector<SplineMove> moves;     // empty: no segments
  MotorPoint way;
  std::vector<std::string> variables = {};  // of the system: `97=0.1`
  double radius = 0;                        // of a full turn at constant speed whose radius is judged
  unsigned error = 0, status = 0;           // run-time error; bits of word 3
};

// Of 12 degrees about (0, -60), in four decimals as the program has it.
constexpr double kShortX = 12.4747, kShortY = -1.3111;

// Feed in counts/ms.
std::vector<Case> cases(double feed) {
  const auto by_feed = [feed](double way, double most = 1e9) { return way / std::min(feed, most); };
  const double helix = by_feed(std::hypot(2 * kPi * 180, 50)), turn = 2 * kPi;
  const double tilted = 1 / std::sqrt(3.0), third = 60 * std::sqrt(2.0);
  return {
      {"full turn, CIRCLE1, helix",
       3,
       {"CIRCLE1 X0 Y0 Z50 I180 J0"},
       {arc_move(helix, {0, 0, 50}, {{180, 0, 0}, kDown, turn})},
       {0, 0, 50},
       {},
       180},
      {"planes by NORMAL, R both ways",
       3,
       {"NORMAL J-1 CIRCLE2 X100 Z100 R100", "NORMAL I-1 CIRCLE1 Y-80 Z80 R-80",
        "NORMAL I1 J1 K1 CIRCLE1 X120 Y-120 I60 J-60 K0"},
       {arc_move(by_feed(kPi / 2 * 100), {100, 0, 100}, {{100, 0, 0}, {0, 1, 0}, kPi / 2}),
        arc_move(by_feed(1.5 * kPi * 80), {0, -80, 80}, {{0, -80, 0}, {-1, 0, 0}, 1.5 * kPi}),
        arc_move(by_feed(kPi * third), {120, -120, 0}, {{60, -60, 0}, {tilted, tilted, tilted}, kPi})},
       {220, -200, 180}},
      {"spiral, centre of ABS(R), line",
       2,
       {"PSET X0 Y0", "TM16 CIRCLE1 X100 Y150 I100 J0", "ABS(R)", fmt::format("F{} CIRCLE2 X0 Y0 I150 J100", feed),
        "LINEAR TM8 X-60 Y30"},
       {arc_move(16, {100, 150}, {{100, 0, 0}, kDown, kPi / 2}),
        arc_move(by_feed(turn * std::hypot(50, 50)), {0, 0}, {{50, -50, 0}, kUp, turn}), line_move(8, {-60, 30})},
       {40, 180}},
      {"line, arc, line",
       2,
       {"LINEAR X100", "CIRCLE2 X80 Y80 I0 J80", "LINEAR Y100"},
       {line_move(by_feed(100), {100, 0}), arc_move(by_feed(kPi / 2 * 80), {80, 80}, {{0, 80, 0}, kUp, kPi / 2}),
        line_move(by_feed(100), {0, 100})},
       {180, 180}},
      {"a turn more by Isx97, feed by Isx78",
       2,
       {fmt::format("CIRCLE1 X{} Y{} I0 J-60", kShortX, kShortY), "CIRCLE2 X0 Y64 I0 J32"},
       {arc_move(by_feed(60 * (turn + kPi / 15)), {kShortX, kShortY}, {{0, -60, 0}, kDown, turn + kPi / 15}),
        arc_move(by_feed(kPi * 32, std::sqrt(8 * 32)), {0, 64}, {{0, 32, 0}, kUp, kPi})},
       {kShortX, kShortY + 64},
       {"97=0.1", "78=8"}},
      {"ends further apart than 2 R, no centre at all",
       2,
       {"CIRCLE1 X100 R40", "CIRCLE2 X80 Y10"},
       {arc_move(by_feed(kPi * 50), {100, 0}, {{50, 0, 0}, kDown, kPi}),
        line_move(by_feed(std::hypot(80, 10)), {80, 10})},
       {180, 10}},
      {"radius 0 at the end",
       2,
       {"LINEAR X100", "CIRCLE1 X40 Y0 I40 J0"},
       {line_move(by_feed(100), {100, 0})},
       {100, 0},
       {},
       0,
       kCircleError,
       kRadiusBit},
      {"further apart than Isx96 allows",
       2,
       {"LINEAR X100", "CIRCLE1 X100 R40"},
       {line_move(by_feed(100), {100, 0})},
       {100, 0},
       {"96=5"},
       0,
       kCircleError,
       kRadiusBit},
      {"no segments, an arc is a line", 2, {"TM10 CIRCLE1 X100 Y50 I50 J0"}, {}, {100, 50}, {"13=0"}},
  };
}

class Circle {
 public:
  explicit Circle(BenchContext& b) : host_(b) {}
  void run();

 private:
  using System = PathHost::System;
  BenchReport& report() { return host_.report(); }
  System load(const Case& c, unsigned number, const std::vector<unsigned>& motors);
  void judge(const Case& c, const System& s);
  void judge_radius(const Case& c, const System& s, const SplinePath& path, double begin);

  PathHost host_;
  double feed_ = 0;
};

Circle::System Circle::load(const Case& c, unsigned number, const std::vector<unsigned>& motors) {
  System s{number, motors, c.name};
  std::string line = fmt::format("&{}", number);
  for (unsigned i = 0; i < c.motors; ++i) line += fmt::format("#{}->1{}", motors[i], "XYZ"[i]);
  host_.expect(line, "");
  const auto variable = [number](const std::string& text) { return fmt::format("I{}{}", 50 + number, text); };
  std::vector<std::string> words;
  for (const std::string& text :
       {fmt::format("13={}", kSegment), std::string("78=0"), std::string("96=0"), std::string("97=0")})
    words.push_back(variable(text));
  for (const std::string& text : c.variables) words.push_back(variable(text));
  host_.say(words);
  host_.expect(fmt::format("OPEN PROG {} CLEAR", number), "");
  host_.expect(fmt::format("NORMAL K-1 INC INC(R) F{} TA{} TS0", feed_, kTa), "");
  for (const std::string& text : c.program)
    if (const std::string answer = host_.ask(text); !answer.empty()) report().fail(text, answer);
  host_.expect("CLOSE", "");
  return s;
}

// Where all of it is in the middle of a turn at constant speed: behind the change of velocity and two segments.
void Circle::judge_radius(const Case& c, const System& s, const SplinePath& path, double begin) {
  const double speed = 2 * kPi * c.radius / c.moves.front().time;  // in the plane
  const double segment = host_.bench().negative ? 1.1 * kSegment : kSegment;
  const double error = speed * speed * segment * segment / (6 * c.radius);
  double least = 1e9, most = 0;
  unsigned judged = 0;
  for (std::size_t i = 0; i <= host_.last_of(s, {}); ++i) {
    const double t = static_cast<double>(i) * host_.period() - begin;
    if (t < kTa + 3 * kSegment || t > path.end() - kTa - 3 * kSegment) continue;
    const MotorPoint p = host_.at(s, i);
    const double off = c.radius - std::hypot(p[0] - c.radius, p[1]);
    least = std::min(least, off), most = std::max(most, off), ++judged;
  }
  report().step(s.name + ": radius", judged >= 80 && least >= 0.98 * error && most <= 1.02 * error,
                fmt::format("{:.4f} to {:.4f} counts smaller, expected V^2 T^2 / (6 R) = {:.4f} to 2 %; {} servo "
                            "interrupts",
                            least, most, error, judged));
}

void Circle::judge(const Case& c, const System& s) {
  if (c.moves.empty()) {
    for (std::size_t i = 0; i < s.motors.size(); ++i)
      report_fit(
          report(), fmt::format("{}, motor {}: path", s.name, s.motors[i]),
          host_.fit(
              s.motors[i],
              [&, i](double from) -> MotorHost::Path {
                return [p = linear_profile(from, {{c.way[i], 10}}, {kTa, kTa}, 0)](double t) { return p.position(t); };
              },
              10 + kTa),
          25);
  } else {
    const SplinePath path(c.moves, kTa, 0, kSegment);
    const auto fit = host_.fitted(s, path);
    if (c.radius > 0) judge_radius(c, s, path, fit.begin);
    host_.report_fitted(s, path, fit);
  }
  host_.report_end(s, c.way);
  report().equal(s.name + ": run-time error", host_.run_time_error(s), c.error);
  report().equal(s.name + ": word 3 bit 3", host_.status_word(s, 3) & kRadiusBit, c.status & kRadiusBit);
}

void Circle::run() {
  host_.set_up();
  host_.variables(92, 0);
  std::vector<std::string> words;
  for (unsigned s = 1; s <= host_.motors() / 2; ++s) words.push_back(fmt::format("I5{0}90=1 I5{0}98=0", s));
  host_.say(words);
  host_.close_all();
  feed_ = 18 + 0.5 * host_.pick(5);
  const auto all = cases(feed_);
  std::vector<unsigned> motors;
  for (unsigned motor = 1; motor <= host_.motors(); ++motor) motors.push_back(motor);
  for (std::size_t next = 0; next < all.size();) {
    host_.expect("UNDEFINE ALL", "");
    std::vector<System> systems;
    const std::size_t first = next;
    std::string line;
    std::shuffle(motors.begin(), motors.end(), host_.random());
    for (auto free = motors.begin(); next < all.size() && all[next].motors <= motors.end() - free; ++next) {
      systems.push_back(load(all[next], static_cast<unsigned>(systems.size()) + 1, {free, free + all[next].motors}));
      free += all[next].motors;
      line += fmt::format("&{0}B{0}R ", systems.size());
    }
    host_.record();
    host_.expect(line, "");
    if (!host_.settle(150, 4)) report().fail(line, "still moving after 150 ms");
    for (std::size_t i = 0; i < systems.size(); ++i) judge(all[first + i], systems[i]);
  }
}

}  // namespace

Bench circle_bench() {
  return {
      "circle",
      "arcs in segments: turns both ways, helix, planes, centre and radius, spirals, errors; path and radius at each "
      "servo interrupt",
      {"the scoreboard is told that Isx13 is a tenth longer", "full turn, CIRCLE1, helix: radius",
       "counts smaller, expected V^2 T^2"},
      [](BenchContext& b) { Circle(b).run(); },
      kAServoIc,
      dac_axes<8>};
}

}  // namespace brick
