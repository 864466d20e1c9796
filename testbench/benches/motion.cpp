// motion: programs of unsegmented moves, blended or not, each in a coordinate system with two motors, as many at once
// as the board has motors for. Judged at each servo interrupt by the formulas of firmware:7.5, firmware:7.6 and
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
       {"LINEAR INC TA12 TS5 TM20", "X4 Y2", "TM15 X-2 Y1.5", "X1.5 Y-1"},
       linear({{400, 20}, {-200, 15}, {150, 15}}, {12, 12, 12, 12}, rounding),
       linear({{200, 20}, {150, 15}, {-100, 15}}, {12, 12, 12, 12}, rounding),
       200,
       10},
      {"LINEAR, one move",
       {"LINEAR INC TA15 TS0 TM20", "X-3 Y5"},
       linear({{-300, 20}}, {15, 15}, 0),
       linear({{500, 20}}, {15, 15}, 0)},
      {"LINEAR, DELAY between",
       {"LINEAR INC TA10 TS2 TM20", "X2 Y-2", "DELAY12", "X-2 Y1"},
       linear({{200, 20}, {0, 12}, {-200, 20}}, {10, 10, 10, 10}, 2),
       linear({{-200, 20}, {0, 12}, {100, 20}}, {10, 10, 10, 10}, 2)},
      // The change of velocity at each corner takes as long as Ixx17 = 1 asks for, for all motors.
      {"LINEAR, corner of 90 degrees stretched by Ixx17",
       {"LINEAR INC TA5 TS0 TM24", "X2.4 Y2.4", "X-2.4 Y2.4"},
       linear({{240, 24}, {-240, 24}}, {10, 20, 10}, 0),
       linear({{240, 24}, {240, 24}}, {10, 20, 10}, 0),
       200,
       1},
      {"LINEAR, time stretched by Ixx16",
       {"LINEAR INC TA5 TS0 TM25", "X4 Y2"},
       linear({{400, 50}}, {5, 5}, 0),
       linear({{200, 50}}, {5, 5}, 0),
       8},
      // F over the axes of the feed rate: 3, 4, 5.
      {"LINEAR, F",
       {"LINEAR INC FRAX(X,Y) TA10 TS0 F200", "X3 Y4", "X-3 Y-4"},
       linear({{300, 25}, {-300, 25}}, {10, 10, 10}, 0),
       linear({{400, 25}, {-400, 25}}, {10, 10, 10}, 0)},
      // The motor with the longest way over speed keeps its speed.
      {"RAPID", {"RAPID INC", "X8 Y-4"}, rapid(800, 32), rapid(-400, 16)},
      {"PVT",
       {"INC PVT20", "X1:100 Y-1:-50", "X3:200 Y-0.5:30", "PVT30 X3:0 Y2:0"},
       pvt({{100, 10, 20}, {400, 20, 20}, {700, 0, 30}}),
       pvt({{-100, -5, 20}, {-150, 3, 20}, {50, 0, 30}})},
      {"SPLINE1",
       {"SPLINE1 INC TM15", "X1 Y1", "X3 Y-1", "X-2 Y2"},
       spline({100, 400, 200}, 15),
       spline({100, 0, 200}, 15)},
  };
}

class MotionBench {
 public:
  explicit MotionBench(BenchContext& b) : host_(b, std::vector<plant::AxisParameters>(8, dac_axis())) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void load(unsigned system, const Case& c);
  void judge(unsigned motor, const std::string& name, const Course& course);

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

}  // namespace

Bench motion_bench() {
  return {"motion",
          "programs of LINEAR, DELAY, RAPID, PVT and SPLINE1 moves: paths at each servo interrupt, exact stops",
          {"the scoreboard is told that TS is a millisecond longer", "LINEAR, three moves blended, motor 1: path",
           "counts off"},
          [](BenchContext& b) { MotionBench(b).run(); },
          kAServoIc};
}

}  // namespace brick
