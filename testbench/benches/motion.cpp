// motion: programs of unsegmented moves, blended or not, each in a coordinate system with two motors, as many at once
// as the board has motors for; then one of all motors, in every mode, out of a rotary buffer that is filled while it
// runs. Judged at each servo interrupt by the formulas of firmware:7.5, firmware:7.6 and
// firmware:7.8 in double precision (testbench/checkers/program_profile.h), and at each stop by the exact sum of the
// moves.
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/jog_profile.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {

using Path = MotorHost::Path;

struct Course {                           // of one motor
  std::function<Path(double from)> make;  // empty: only its end is judged
  double duration, way;
};
struct Case {
  std::string name;
  std::vector<std::string> program;
  Course x, y;
  double speed = 200, acceleration = 4;  // Ixx16, Ixx17
};

template <class Make>
Course course(const Make& make, double way) {
  return {[make](double from) -> Path { return [p = make(from)](double t) { return p.position(t); }; }, make(0.0).end(),
          way};
}
Course linear(const std::vector<LinearMove>& moves, const std::vector<double>& corners, double rounding) {
  double way = 0;
  for (const LinearMove& m : moves) way += m.distance;
  return course([=](double from) { return linear_profile(from, moves, corners, rounding); }, way);
}
Course rapid(double way, double speed) {  // as MotorHost::set_up(): Ixx19 = 4, Ixx21 = 5
  return course([=](double from) { return jog_profile(from, from + way, JogLimits{4, 0, 5, speed}); }, way);
}
Course pvt(const std::vector<PvtMove>& moves) {  // `to` counted from the start
  return course(
      [=](double from) {
        std::vector<PvtMove> list = moves;
        for (PvtMove& m : list) m.to += from;
        return pvt_path(from, list);
      },
      moves.back().to);
}
Course spline(const std::vector<double>& points, double time) {  // likewise
  return course(
      [=](double from) {
        std::vector<double> list = points;
        for (double& p : list) p += from;
        return spline_path(from, list, time);
      },
      points.back());
}

// 100 counts a unit; Isx90 = 1000: velocities in units a second. `rounding`: TS of the first.
std::vector<Case> cases(double rounding) {
  return {
      {"LINEAR, three moves blended",
       {"LINEAR INC TA12 TS5 TM16", "X4 Y2", "TM15 X-2 Y1.5", "X1.5 Y-1"},
       linear({{400, 16}, {-200, 15}, {150, 15}}, {12, 12, 12, 12}, rounding),
       linear({{200, 16}, {150, 15}, {-100, 15}}, {12, 12, 12, 12}, rounding),
       200,
       10},
      {"LINEAR, DELAY between",
       {"LINEAR INC TA10 TS2 TM18", "X2 Y-2", "DELAY12", "X-2 Y1"},
       linear({{200, 18}, {0, 12}, {-200, 18}}, {10, 10, 10, 10}, 2),
       linear({{-200, 18}, {0, 12}, {100, 18}}, {10, 10, 10, 10}, 2)},
      // The change of velocity at each corner takes as long as Ixx17 = 1 asks for, for all motors.
      {"LINEAR, corner of 90 degrees stretched by Ixx17",
       {"LINEAR INC TA5 TS0 TM24", "X2.4 Y2.4", "X-2.4 Y2.4"},
       linear({{240, 24}, {-240, 24}}, {10, 20, 10}, 0),
       linear({{240, 24}, {240, 24}}, {10, 20, 10}, 0),
       200,
       1},
      {"LINEAR, time stretched by Ixx16",
       {"LINEAR INC TA5 TS0 TM15", "X2 Y1"},
       linear({{200, 25}}, {5, 5}, 0),
       linear({{100, 25}}, {5, 5}, 0),
       8},
  };
}

// The program of all motors: what each goes, in units, for the first of them; the others go `kShare` of it.
constexpr double kShare[] = {1.5, -1.25, 1, -0.75, 0.5, -1.5, 0.25, -1};
constexpr const char* kAxes = "XYZABCUV";
constexpr double kFeed = 180, kFastest = 32;  // F over X and Y, units/s; Ixx22, counts/ms

std::string axes(unsigned motors, double way, double velocity = 0) {
  std::string line;
  for (unsigned i = 0; i < motors; ++i) {
    line += fmt::format("{}{:.6g}", kAxes[i], way * kShare[i]);
    if (velocity != 0) line += fmt::format(":{:.6g}", velocity * kShare[i]);
  }
  return line;
}

struct Section {
  std::string name;
  Course course;
};

// Of one motor, as `rotary()` sends them.
std::vector<Section> sections(double share) {
  const double way = 100 * share;                                          // of a unit
  const double by_feed = std::hypot(kShare[0], kShare[1]) / kFeed * 1000;  // ms
  // RAPID: the motor with the longest way over speed keeps its speed.
  return {{"LINEAR, F", linear({{way, by_feed}, {-0.8 * way, 0.8 * by_feed}}, {8, 8, 8}, 2)},
          {"RAPID", rapid(1.5 * way, kFastest * std::fabs(share / kShare[0]))},
          {"PVT", pvt({{0.4 * way, 0.06 * way, 8}, {0.7 * way, -0.02 * way, 8}, {0.5 * way, 0, 8}})},
          {"SPLINE1", spline({0.4 * way, 0.1 * way}, 9)}};
}

class MotionBench {
 public:
  explicit MotionBench(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void load(unsigned system, const Case& c);
  void judge(unsigned motor, const std::string& name, const Course& course);
  void programs();
  void rotary();
  void judge_rotary(unsigned motor);

  MotorHost host_;
};

void MotionBench::load(unsigned system, const Case& c) {
  for (const unsigned motor : {2 * system - 1, 2 * system})
    host_.say({fmt::format("I{0}16={1} I{0}17={2}", motor, c.speed, c.acceleration)});
  host_.expect(fmt::format("OPEN PROG {} CLEAR", system), "");
  for (const std::string& line : c.program)
    if (const std::string answer = host_.ask(line); !answer.empty()) report().fail(line, answer);
  host_.expect("CLOSE", "");
}

void MotionBench::judge(unsigned motor, const std::string& name, const Course& course) {
  const auto& s = host_.samples(motor);
  report_fit(report(), fmt::format("{}, motor {}: path", name, motor), host_.fit(motor, course.make, course.duration),
             static_cast<std::size_t>(course.duration / host_.period()) - 2);
  report().equal(fmt::format("{}, motor {}: way in units of 1/3072 count", name, motor),
                 std::llround((s.back().commanded - s.front().commanded) * MotorHost::kUnits),
                 std::llround(course.way * MotorHost::kUnits));
}

void MotionBench::run() {
  const unsigned systems = host_.motors() / 2;
  if (systems < 1) return report().fail("channels", "expected two");
  host_.set_up();
  host_.variables(90, 0);
  host_.variables(92, 3);
  for (unsigned s = 1; s <= systems; ++s) {
    host_.expect(fmt::format("&{}#{}->100X #{}->100Y", s, 2 * s - 1, 2 * s), "");
    host_.say({fmt::format("I5{0}13=0 I5{0}90=1000 I5{0}92=0 I5{0}98=0", s)});
  }
  host_.close_all();
  programs();
  rotary();
}

void MotionBench::programs() {
  const unsigned systems = host_.motors() / 2;
  const auto all = cases(host_.bench().negative ? 6 : 5);
  for (std::size_t first = 0; first < all.size(); first += systems) {
    const auto count = static_cast<unsigned>(std::min<std::size_t>(systems, all.size() - first));
    std::string line;
    for (unsigned s = 1; s <= count; ++s) {
      load(s, all[first + s - 1]);
      line += fmt::format("&{0}B{0}R ", s);
    }
    host_.record();
    host_.expect(line, "");
    if (!host_.settle(250, 4)) report().fail(line, "still moving after 250 ms");
    for (unsigned s = 1; s <= count; ++s) {
      judge(2 * s - 1, all[first + s - 1].name, all[first + s - 1].x);
      judge(2 * s, all[first + s - 1].name, all[first + s - 1].y);
    }
  }
}

// Lines come before it runs and while it does, as those of a host that keeps a rotary buffer full.
void MotionBench::rotary() {
  const unsigned motors = host_.motors();
  host_.variables(16, 200);
  host_.variables(17, 6);
  host_.expect("UNDEFINE ALL DELETE GATHER &1", "");
  std::string line;
  for (unsigned i = 0; i < motors; ++i) line += fmt::format("#{}->100{}", i + 1, kAxes[i]);
  host_.expect(line, "");
  host_.expect("DEFINE ROT 400 B0 OPEN ROT", "");
  host_.expect(fmt::format("LINEAR INC FRAX(X,Y) TA8 TS2 F{}", kFeed), "");
  host_.expect(axes(motors, 1), "");
  host_.expect(axes(motors, -0.8), "");
  host_.expect("RAPID" + axes(motors, 1.5), "");
  host_.record();
  host_.expect("R", "");
  host_.expect("PVT8" + axes(motors, 0.4, 60), "");
  host_.expect(axes(motors, 0.3, -20), "");
  host_.expect(axes(motors, -0.2), "");
  host_.expect("DWELL3 SPLINE1 TM9" + axes(motors, 0.4), "");
  host_.expect(axes(motors, -0.3), "");
  host_.wait_ms(125);  // motors that are planned one by one stand meanwhile
  if (!host_.settle(100, 6)) report().fail("rotary buffer", "still moving after 200 ms");
  host_.expect("PR", "0");
  host_.expect("Q CLOSE", "");
  host_.wait_ms(2);
  for (unsigned motor = 1; motor <= motors; ++motor) judge_rotary(motor);
}

void MotionBench::judge_rotary(unsigned motor) {
  const auto& s = host_.samples(motor);
  double way = 0, error = 0;
  std::size_t from = 0;
  for (const Section& section : sections(kShare[motor - 1])) {
    const auto fit = host_.fit(motor, section.course.make, section.course.duration, from);
    report_fit(report(), fmt::format("rotary buffer, {}, motor {}: path", section.name, motor), fit,
               static_cast<std::size_t>(section.course.duration / host_.period()) - 2);
    from = static_cast<std::size_t>(std::max(0.0, std::ceil(fit.end / host_.period())));
    way += section.course.way;
  }
  report().equal(fmt::format("rotary buffer, motor {}: way in units of 1/3072 count", motor),
                 std::llround((s.back().commanded - s.front().commanded) * MotorHost::kUnits),
                 std::llround(way * MotorHost::kUnits));
  for (const auto& sample : s) error = std::max(error, std::fabs(sample.commanded - sample.actual));
  report().step(fmt::format("rotary buffer, motor {}: following error", motor), error <= 20,
                fmt::format("{:.2f} counts, expected up to 20", error));
  report().equal(fmt::format("rotary buffer, motor {}: in position", motor), host_.status_bit(motor, 2, 0), true);
  report().equal(fmt::format("rotary buffer, motor {}: limits and errors, word 2 bits 1 to 6 and 11", motor),
                 std::stoul(host_.status(motor).substr(6), nullptr, 16) & 0x87E, 0UL);
}

}  // namespace

Bench motion_bench() {
  return {
      "motion",
      "programs of LINEAR, DELAY, RAPID, PVT and SPLINE1 moves, one of all motors from a rotary buffer: paths at each "
      "servo interrupt, exact stops",
      {"the scoreboard is told that TS is a millisecond longer", "LINEAR, three moves blended, motor 1: path",
       "counts off"},
      [](BenchContext& b) { MotionBench(b).run(); },
      kAServoIc,
      dac_axes<8>};
}

}  // namespace brick
