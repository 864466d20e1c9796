// lookahead: programs that ask for more than their motors may, in several coordinate systems at once, each with another
// Isx20. Limits are first and second differences over servo interrupts, the path is geometry, and the time is held
// against the optimum that testbench/checkers/optimum.h finds for itself (motion:7.3, motion:7.4). The sizing of LA-5,
// a host that starves its rotary buffer, what Isx20 = 0 and 1 leave alone, and motors that come to the limit of their
// desired position (motion:7.5/6).
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/path_host.h"
#include "testbench/checkers/optimum.h"

namespace brick {
namespace {

using Limits = PathHost::Limits;
using System = PathHost::System;

constexpr double kSegment = 2, kTa = 4, kSlower = 1.10;  // ms; of the optimum (motion:7.4/5)
constexpr double kPi = 3.14159265358979323846;
constexpr unsigned kRecords = 60;                                  // segments of each buffer
constexpr double kFirstLine = 40, kStands = 5, kStart = 18;        // counts; ms at rest; ms that a start may take
constexpr unsigned kMoreLines = 3, kLateBy = 12, kPatience = 150;  // ms

// StopTime / 2 at this speed, in segments, and a third more (LA-5): the document's 400, 1 and 5 give 54.
constexpr unsigned sizing(double speed, double acceleration, double segment) {
  const double segments = speed / acceleration / 2 / segment * 4 / 3;
  return static_cast<unsigned>(segments) + (segments > static_cast<unsigned>(segments) ? 1 : 0);
}
static_assert(sizing(400, 1, 5) == 54);

constexpr Limits kStarved[] = {{20, 2}, {20, 1}};
constexpr double kSpeed = 24;  // counts/ms of the line that is sized, at 1 count/ms^2
constexpr unsigned kSized = sizing(kSpeed, 1, kSegment);

struct Case {
  std::string name;
  unsigned ahead;                    // Isx20
  std::vector<Limits> limits;        // of X and Y
  std::vector<std::string> program;  // behind INC and TA, in counts
  std::vector<SplineMove> moves;
  MotorPoint way;
  // kShort: looks not far enough; kFree: limits do not count; X comes to the limit of its desired position, and is held
  // there, or all stop
  enum { kLimited, kShort, kFree, kHeld, kStopped } kind = kLimited;
};
constexpr double kHeldBy = 180;              // counts of X to its limit, and a part of one
constexpr double kActual = 40;               // counts behind it where the actual position would abort
constexpr unsigned kDesiredLimit = 1u << 1;  // of word 3

std::vector<Case> cases() {
  const std::string line = fmt::format("F{} X1000 Y-500", kSpeed * std::sqrt(1.25));
  const std::vector<SplineMove> straight{line_move(1000 / kSpeed, {1000, -500})};
  const std::vector<Limits> sized{{kSpeed, 1}, {kSpeed, 1}}, held{{9, 1}, {9, 1}};
  const std::string beyond = "F16 X240 Y120";
  const std::vector<SplineMove> past{line_move(std::hypot(240, 120) / 16, {240, 120})};
  return {
      {"corners",
       12,
       {{9, 1}, {6, 0.6}},
       {"F18 X180", "Y-60", "X-90 Y-45", "CIRCLE2 X80 Y80 I0 J80", "LINEAR Y40"},
       {line_move(10, {180, 0}), line_move(kTa, {0, -60}), line_move(std::hypot(90, 45) / 18, {-90, -45}),
        arc_move(kPi / 2 * 80 / 18, {80, 80}, {{0, 80, 0}, {0, 0, 1}, kPi / 2}), line_move(kTa, {0, 40})},
       {170, 15}},
      {fmt::format("Isx20={} as LA-5 asks for", kSized), kSized, sized, {line}, straight, {1000, -500}},
      {fmt::format("Isx20={}, half of it", kSized / 2),
       kSized / 2,
       sized,
       {line},
       straight,
       {1000, -500},
       Case::kShort},
      {"Isx20=1", 1, sized, {line}, straight, {1000, -500}, Case::kFree},
      {"Isx20=0", 0, sized, {line}, straight, {1000, -500}, Case::kFree},
      {"held at a desired limit", 12, held, {beyond}, past, {kHeldBy, 120}, Case::kHeld},
      {"stopped at a desired limit", 12, held, {beyond}, past, {}, Case::kStopped},
  };
}

class Lookahead {
 public:
  explicit Lookahead(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void define();
  System system(unsigned number, const std::string& name) const { return {number, {2 * number - 1, 2 * number}, name}; }
  void load(const Case& c, unsigned number);
  void judge_held(const Case& c, const System& s, const SplinePath& path);
  void judge(const Case& c, const System& s);
  void judge_time(const Case& c, const System& s, const SplinePath& path);
  double starve();  // where X is then
  void judge_starved(double sent);
  void round(const std::vector<Case>& all, std::size_t first, unsigned count, bool starves);

  PathHost host_;
  std::vector<double> times_;        // of the sized cases
  std::map<unsigned, double> most_;  // of X of a system: its limit, from where it starts
};

// The highest system first.
void Lookahead::define() {
  host_.expect("DELETE GATHER", "");
  std::string words;
  for (unsigned s = host_.systems(); s >= 1; --s) {
    host_.expect(fmt::format("&{}#{}->1X#{}->1Y", s, 2 * s - 1, 2 * s), "");
    host_.expect(fmt::format("DEFINE LOOKAHEAD {},0", kRecords), "");
    host_.say({fmt::format("I5{0}13={1} I5{0}90=1 I5{0}98=0", s, kSegment)});
  }
  host_.expect("&1DEFINE ROT 200", "");
}

void Lookahead::load(const Case& c, unsigned number) {
  const System s = system(number, c.name);
  const bool cut_short = host_.bench().negative && c.ahead == kSized;  // a control: its pass
  std::vector<std::string> words{fmt::format("I5{}20={}", number, cut_short ? c.ahead / 2 : c.ahead)};
  for (std::size_t i = 0; i < s.motors.size(); ++i) {
    const bool ignored = host_.bench().negative && i == 1;
    words.push_back(fmt::format("I{0}16={1} I{0}17={2}", s.motors[i], c.limits[i].velocity,
                                ignored ? 50 : c.limits[i].acceleration));
  }
  if (c.kind == Case::kHeld || c.kind == Case::kStopped) {
    const unsigned motor = s.motors[0];
    const double from = static_cast<double>(host_.d(0x88 + 0x80 * (motor - 1))) / PathHost::kUnits;
    const double limit = std::ceil(from) + kHeldBy;
    most_[number] = limit - from;
    words.push_back(fmt::format("I{0}13={1} I{0}41={2} I{0}24=${3}", motor, limit + kActual, kActual,
                                c.kind == Case::kHeld ? "80C001" : "808001"));
  }
  host_.say(words);
  host_.expect(fmt::format("OPEN PROG {} CLEAR", number), "");
  host_.expect(fmt::format("INC TA{} TS0", kTa), "");
  for (const std::string& text : c.program)
    if (const std::string answer = host_.ask(text); !answer.empty()) report().fail(text, answer);
  host_.expect("CLOSE", "");
}

void Lookahead::judge_time(const Case& c, const System& s, const SplinePath& path) {
  std::vector<optimum::Motor> motors;
  for (std::size_t i = 0; i < c.limits.size(); ++i) {
    motors.push_back({{}, c.limits[i].velocity, c.limits[i].acceleration});
    for (const MotorPoint& p : path.points()) motors.back().points.push_back(p[i]);
  }
  const optimum::Solver best(motors, kSegment);
  const double took = host_.lasts(s);
  times_.push_back(took);
  report().step(s.name + ": time", took <= kSlower * best.time() + 2 * host_.period(),
                fmt::format("{:.1f} ms, the optimum {:.1f}, expected up to {:.2f} of it; its longest stop {} segments",
                            took, best.time(), kSlower, best.longest_stop()));
}

// Its control points are held, and the others go on; or all stand at the knot before the first segment that would have
// one of these.
void Lookahead::judge_held(const Case& c, const System& s, const SplinePath& path) {
  const double most = most_[s.number];
  const SplinePath along = path.held(0, most);
  host_.report_limits(s, c.limits, 0.95);
  host_.report_followed(s, host_.followed(s, along), 60);
  if (c.kind == Case::kHeld) {
    judge_time(c, s, along);
    host_.report_end(s, {most, c.way[1]});
  } else {
    const double knot = static_cast<double>(path.first_beyond(0, most) - 3) * kSegment;
    const MotorPoint at = host_.at(s, host_.last_of(s, {})), expected = path.at(knot);
    const double off = std::max(std::fabs(at[0] - expected[0]), std::fabs(at[1] - expected[1]));
    report().step(s.name + ": stands", off <= PathHost::kNear,
                  fmt::format("at ({:.4f}, {:.4f}), expected the knot ({:.4f}, {:.4f}) before the limit {:.4f}", at[0],
                              at[1], expected[0], expected[1], most));
    report().equal(s.name + ": word 3 bit 1", host_.status_word(s, 3) & kDesiredLimit, kDesiredLimit);
    host_.expect(fmt::format("&{}A", s.number), "");
  }
  host_.say({fmt::format("I{0}13=0 I{0}24=$800001", s.motors[0])});
}

void Lookahead::judge(const Case& c, const System& s) {
  const SplinePath path(c.moves, kTa, 0, kSegment);
  if (c.kind == Case::kHeld || c.kind == Case::kStopped) {
    judge_held(c, s, path);
  } else if (c.kind == Case::kFree) {  // as if there were no buffer
    host_.report_fitted(s, path, host_.fitted(s, path));
    const auto used = host_.use(s.motors[0], c.limits[0]);
    report().step(s.name + ": nothing is limited", used.acceleration > 2,
                  fmt::format("{:.0f} % of Ixx17, expected more than 200 %", 100 * used.acceleration));
  } else {
    host_.report_limits(s, c.limits, 0.95);
    host_.report_followed(s, host_.followed(s, path), 100);
    if (c.kind == Case::kLimited) judge_time(c, s, path);
  }
  if (c.kind == Case::kShort) {  // sqrt(2 A d): d is what it looks ahead
    const double most = std::sqrt(2.0 * c.ahead * kSegment * kSpeed) / kSpeed, took = host_.lasts(s);
    const auto used = host_.use(s.motors[0], c.limits[0]);
    report().step(s.name + ": slower", used.velocity <= most * 1.02 && took > times_.back() + 3,
                  fmt::format("{:.0f} % of Ixx16, expected up to {:.0f} %; {:.1f} ms, {:.1f} with all of it",
                              100 * used.velocity, 100 * most, took, times_.back()));
  }
  if (!c.way.empty() && c.kind != Case::kHeld) host_.report_end(s, c.way);
  report().equal(s.name + ": run-time error", host_.run_time_error(s), 0u);
}

// A line at once, then one at a time, some too late for the one before: it stops on the way and goes on.
double Lookahead::starve() {
  double sent = kFirstLine;
  const auto stands = [&, still = static_cast<std::size_t>(kStands / host_.period())] {
    const auto& x = host_.samples(1);
    return x.size() > still && x.back().commanded != x.front().commanded &&
           x[x.size() - 1 - still].commanded == x.back().commanded;
  };
  for (unsigned i = 0; i < kMoreLines; ++i) {
    host_.wait_ms(2 + host_.pick(kLateBy));
    for (unsigned waited = 0; i == 1 && waited < kPatience && !stands(); ++waited) host_.wait_ms(1);
    const unsigned x = 15 + host_.pick(30);
    host_.expect(fmt::format("&1 X{} Y{}", x, i % 2 == 0 ? 10 : -10), "");
    sent += x;
  }
  return sent;
}

void Lookahead::judge_starved(double sent) {
  const System s = system(1, "starving host");
  host_.report_limits(s, {kStarved[0], kStarved[1]}, 0.9);
  host_.report_end(s, {sent, 30});
  const auto& x = host_.samples(1);
  std::size_t stands = 0, moving = 0;
  const std::size_t begins = host_.begins(s), end = begins + static_cast<std::size_t>(host_.lasts(s) / host_.period());
  for (std::size_t i = begins; i < end; ++i) (x[i].commanded == x[i - 1].commanded ? stands : moving)++;
  report().step(s.name + ": stops and goes on", stands + 2 > kStands / host_.period() && moving > 40,
                fmt::format("{} servo interrupts at rest, {} moving", stands, moving));
  report().equal(s.name + ": run-time error", host_.run_time_error(s), 0u);
}

// The last round has a system to spare, the first.
void Lookahead::round(const std::vector<Case>& all, std::size_t first, unsigned count, bool starves) {
  std::string points, line;
  for (unsigned i = 0; i < count; ++i) {
    load(all[first + i], i + 1 + starves);
    points += fmt::format("&{0}B{0} ", i + 1 + starves);
    line += fmt::format("&{}R ", i + 1 + starves);
  }
  host_.expect(points, "");
  if (starves) {
    host_.say({fmt::format("I5120=12 I116={0} I117={1} I216={0} I217={2}", kStarved[0].velocity,
                           kStarved[0].acceleration, kStarved[1].acceleration)});
    host_.expect("&1B0 OPEN ROT", "");
    host_.expect(fmt::format("LINEAR INC TA{} TS0 F20", kTa), "");
    host_.expect(fmt::format("X{} Y20", kFirstLine), "");
  }
  host_.record();
  host_.expect(line + (starves ? "&1R" : ""), "");
  const double sent = starves ? starve() : 0;
  if (!host_.settle(200, starves ? kStart : 4)) report().fail(line, "still moving after 200 ms");
  if (starves) host_.expect("&1Q CLOSE", "");
  for (unsigned i = 0; i < count; ++i) judge(all[first + i], system(i + 1 + starves, all[first + i].name));
  if (starves) judge_starved(sent);
}

void Lookahead::run() {
  const unsigned systems = host_.systems();
  if (systems < 1) return report().fail("channels", "expected two");
  host_.set_up();
  host_.variables(92, 0);
  define();
  host_.close_all();
  const auto all = cases();
  for (std::size_t first = 0, starved = 0; starved == 0; first += systems) {
    const std::size_t left = all.size() - std::min(first, all.size());
    starved = left < systems ? 1 : 0;
    round(all, first, static_cast<unsigned>(std::min<std::size_t>(systems, left)), starved == 1);
  }
}

}  // namespace

// covers: LA-1 LA-2 LA-3 LA-4 LA-5
Bench lookahead_bench() {
  return {
      "lookahead",
      "paths that ask for more than their motors may, Isx20 = 0, 1 and more, a starving host, desired limits: limits, "
      "path and time",
      {"Ixx17 of every second motor is not told to the controller; a sweep goes over half of what LA-5 asks for",
       "corners: limits",
       "exceeds Ixx17",
       {},
       {{fmt::format("Isx20={} as LA-5 asks for: time", kSized), "expected up to 1.10 of it"}}},
      [](BenchContext& b) { Lookahead(b).run(); },
      kAServoIc,
      dac_axes<8>};
}

}  // namespace brick
