// motion: programs of unsegmented moves, blended or not. Judged at each servo interrupt by the formulas of motion:4.2,
// motion:4.5 and motion:4.6 in double precision (testbench/checkers/program_profile.h), and at each stop by the exact
// sum of the moves.
#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"
#include "testbench/checkers/jog_profile.h"
#include "testbench/checkers/program_profile.h"

namespace brick {
namespace {



class MotionBench {
 public:
  explicit MotionBench(BenchContext& b) : host_(b, std::vector<plant::AxisParameters>(2, dac_axis())) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  void program(const std::vector<std::string>& lines);
  void linear(const std::string& name, const std::string& program, const std::vector<LinearMove>& x,
              const std::vector<LinearMove>& y, const std::vector<double>& corners, double rounding);
  template <class Make>
  void judge(unsigned motor, const std::string& name, const Make& make);
  void target(unsigned motor, const std::string& name, double moved);

  void blended();
  void stretched();
  void feed_rates();
  void rapid();
  void pvt();
  void spline();

  MotorHost host_;
};

// Loads and runs it until the commanded positions rest.
void MotionBench::program(const std::vector<std::string>& lines) {
  host_.expect("OPEN PROG 1 CLEAR", "");
  for (const std::string& line : lines) host_.expect(line, "");
  host_.expect("CLOSE", "");
  host_.record();
  host_.expect("&1B1R", "");
  if (!host_.settle(250)) report().fail(lines.back(), "still moving after 250 ms");
}

// `make`: the path from a start in counts, with position(t) and end().
template <class Make>
void MotionBench::judge(unsigned motor, const std::string& name, const Make& make) {
  const double duration = make(0.0).end();
  const auto fit = host_.fit(
      motor, [&](double start) -> MotorHost::Path { return [p = make(start)](double t) { return p.position(t); }; },
      duration);
  report_fit(report(), fmt::format("{}, motor {}: path", name, motor), fit,
             static_cast<std::size_t>(duration / host_.period()) - 2);
}

void MotionBench::target(unsigned motor, const std::string& name, double moved) {
  const auto& s = host_.samples(motor);
  const double way = s.empty() ? -1e9 : s.back().commanded - s.front().commanded;
  report().equal(fmt::format("{}, motor {}: way in units of 1/3072 count", name, motor),
                 std::llround(way * MotorHost::kUnits), std::llround(moved * MotorHost::kUnits));
}

void MotionBench::linear(const std::string& name, const std::string& lines, const std::vector<LinearMove>& x,
                         const std::vector<LinearMove>& y, const std::vector<double>& corners, double rounding) {
  std::vector<std::string> list;
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = std::min(lines.find('|', at), lines.size());
    list.push_back(lines.substr(at, end - at));
    at = end + 1;
  }
  program(list);
  for (unsigned motor = 1; motor <= 2; ++motor) {
    const auto& moves = motor == 1 ? x : y;
    double sum = 0;
    for (const LinearMove& m : moves) sum += m.distance;
    // A motor whose first moves are none begins to move later than the system.
    if (moves.front().distance != 0)
      judge(motor, name, [&](double start) { return linear_profile(start, moves, corners, rounding); });
    target(motor, name, sum);
  }
}

void MotionBench::blended() {
  const double told = host_.bench().negative ? 6 : 5;
  linear("LINEAR, three moves blended", "LINEAR INC TA20 TS5 TM30|X4 Y2|TM25 X-2 Y3|X1.5 Y-1",
         {{400, 30}, {-200, 25}, {150, 25}}, {{200, 30}, {300, 25}, {-100, 25}}, {20, 20, 20, 20}, told);
  linear("LINEAR, one move", "LINEAR INC TA15 TS0 TM20|X-3 Y5", {{-300, 20}}, {{500, 20}}, {15, 15}, 0);
  linear("LINEAR, DELAY between", "LINEAR INC TA10 TS2 TM20|X2 Y-2|DELAY15|X-2 Y1", {{200, 20}, {0, 15}, {-200, 20}},
         {{-200, 20}, {0, 15}, {100, 20}}, {10, 10, 10, 10}, 2);
}

// Ixx17 = 1 count/ms^2: the change of velocity at each corner takes as long as that asks for, for all motors; Ixx16.
void MotionBench::stretched() {
  host_.variables(17, 1);
  linear("LINEAR, corner of 90 degrees stretched by Ixx17", "LINEAR INC TA5 TS0 TM30|X3 Y3|X-3 Y3",
         {{300, 30}, {-300, 30}}, {{300, 30}, {300, 30}}, {10, 20, 10}, 0);
  host_.variables(17, 4);
  host_.variables(16, 8);
  linear("LINEAR, time stretched by Ixx16", "LINEAR INC TA5 TS0 TM25|X4 Y2", {{400, 50}}, {{200, 50}}, {5, 5}, 0);
  host_.variables(16, 200);
}

// F over the feed rate axes X and Y; 3, 4, 5.
void MotionBench::feed_rates() {
  linear("LINEAR, F", "LINEAR INC FRAX(X,Y) TA10 TS0 F200|X3 Y4|X-3 Y-4", {{300, 25}, {-300, 25}},
         {{400, 25}, {-400, 25}}, {10, 10, 10}, 0);
}

void MotionBench::rapid() {
  program({"RAPID INC", "X8 Y-4"});
  JogLimits x{4, 0, 5, 32}, y{4, 0, 5, 16};  // as set_up(); the shorter way at half the speed
  judge(1, "RAPID", [&](double start) { return jog_profile(start, start + 800, x); });
  judge(2, "RAPID", [&](double start) { return jog_profile(start, start - 400, y); });
  target(1, "RAPID", 800);
  target(2, "RAPID", -400);
}

void MotionBench::pvt() {
  program({"PVT20 INC", "X1:100 Y-1:-50", "X3:200 Y-0.5:30", "PVT30 X3:0 Y2:0"});
  // Velocities are in units a second, Isx90 = 1000.
  judge(1, "PVT", [](double p) { return pvt_path(p, {{p + 100, 10, 20}, {p + 400, 20, 20}, {p + 700, 0, 30}}); });
  judge(2, "PVT", [](double p) { return pvt_path(p, {{p - 100, -5, 20}, {p - 150, 3, 20}, {p + 50, 0, 30}}); });
  target(1, "PVT", 700);
  target(2, "PVT", 50);
}

void MotionBench::spline() {
  program({"SPLINE1 INC TM15", "X1 Y1", "X3 Y-1", "X-2 Y2"});
  judge(1, "SPLINE1", [](double p) { return spline_path(p, {p + 100, p + 400, p + 200}, 15); });
  judge(2, "SPLINE1", [](double p) { return spline_path(p, {p + 100, p, p + 200}, 15); });
  target(1, "SPLINE1", 200);
  target(2, "SPLINE1", 200);
}

void MotionBench::run() {
  if (host_.motors() < 2) return report().fail("channels", "expected two");
  host_.set_up();
  host_.expect("&1#1->100X #2->100Y", "");
  host_.say({"I5113=0", "I5190=1000", "I5192=0", "I5198=0"});
  host_.variables(92, 3);
  host_.close_all();
  blended();
  stretched();
  feed_rates();
  rapid();
  pvt();
  spline();
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
