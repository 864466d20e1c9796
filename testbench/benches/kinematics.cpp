// kinematics: a two-joint arm (SCARA) whose programs are entered as text. Its lengths, gears and paths come from the
// seed: a straight line and a circle in X and Y, in segments. Judged by geometry: each joint at each servo interrupt
// against the B-spline (motion:7.1/3) through atan2 and acos of the ideal path; at knots and between them the hand
// against that path, within what a spline through points T apart can be off; where axes are found by the forward
// program, behind a jog too (motion:8.1).
#include <algorithm>

#include <fmt/format.h>

#include "testbench/benches/benches.h"
#include "testbench/benches/motor_host.h"

namespace brick {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

struct Point {
  double x, y;
};
struct Joints {
  double shoulder, elbow;  // counts
};

struct Arm {
  double upper, fore;  // mm
  double gear;         // counts a degree
  Joints at_zero;      // degrees with both motors at 0

  Joints joints(Point p) const {
    const double square = p.x * p.x + p.y * p.y;
    const double elbow = std::acos((square - upper * upper - fore * fore) / (2 * upper * fore));
    const double shoulder = std::atan2(p.y, p.x) - std::atan2(fore * std::sin(elbow), upper + fore * std::cos(elbow));
    return {(shoulder / kDegree - at_zero.shoulder) * gear, (elbow / kDegree - at_zero.elbow) * gear};
  }
  Point hand(Joints j) const {
    const double first = (j.shoulder / gear + at_zero.shoulder) * kDegree;
    const double both = first + (j.elbow / gear + at_zero.elbow) * kDegree;
    return {upper * std::cos(first) + fore * std::cos(both), upper * std::sin(first) + fore * std::sin(both)};
  }
};

// Progress of a move alone, from 0 to 1, of Tm ms with Ta and TS.
double progress(double t, double tm, double ta, double ts) {
  const auto risen = [&](double u) {
    if (u <= 0) return 0.0;
    if (u >= ta) return u - ta / 2;
    const bool late = u > ta / 2;
    const double v = late ? ta - u : u, slope = 1 / (ta - ts);
    const double way = v < ts ? slope * v * v * v / (6 * ts) : slope * (ts * ts / 6 + (v - ts) * (ts + v - ts) / 2);
    return late ? u - ta / 2 + way : way;
  };
  return (risen(t) - risen(t - tm)) / tm;
}

using Path = std::function<Point(double t)>;

struct Course {
  std::string name, line;
  Path path;
  std::function<double(Point)> off;  // from the geometry, mm
  double tm, ta, ts;
};

class KinematicsBench {
 public:
  explicit KinematicsBench(BenchContext& b) : host_(b) {}
  void run();

 private:
  BenchReport& report() { return host_.report(); }
  double pick(double low, double high) { return low + (high - low) * host_.pick(1000) / 1000.0; }
  void programs();
  void enter(const std::string& kind, const std::vector<std::string>& lines);
  std::vector<Course> courses();
  void judge(const Course& c);
  void judge_hand(const Course& c, double begin);
  double travel(unsigned motor) const;
  double off_path(const std::vector<MotorHost::Sample>& samples, const MotorHost::Path& path, MotorHost::Fit& fit,
                  double length) const;  // says in `fit` where that is
  struct Bound {
    double knot, off;  // mm
  };
  Bound theory(const Course& c) const;
  void axes_are_found(const std::string& when);
  Joints stands() {
    return {static_cast<double>(host_.d(0x88)) / MotorHost::kUnits,
            static_cast<double>(host_.d(0x108)) / MotorHost::kUnits};
  }
  Joints commanded() { return {host_.samples(1).back().commanded, host_.samples(2).back().commanded}; }
  // Joint `which` of the spline through points a segment apart, the first and the last of them three times.
  double spline(const Course& c, int which, double t) const;
  double control(const Course& c, int which, int n) const;

  MotorHost host_;
  Arm arm_{};
  double period_ = 4;  // Isx13
};

double KinematicsBench::control(const Course& c, int which, int n) const {
  const int last = static_cast<int>(std::ceil((c.tm + c.ta) / period_ - 1e-9));
  const Joints j = arm_.joints(c.path(progress(std::clamp(n, 0, last) * period_, c.tm, c.ta, c.ts)));
  return which == 1 ? j.shoulder : j.elbow;
}

double KinematicsBench::spline(const Course& c, int which, double t) const {
  const double at = t / period_ - 1;  // the first segment ends at the second of the three first points
  const int n = static_cast<int>(std::floor(at));
  const double u = at - n, v = 1 - u;
  return (v * v * v * control(c, which, n - 1) + (3 * u * u * u - 6 * u * u + 4) * control(c, which, n) +
          (3 * v * v * v - 6 * v * v + 4) * control(c, which, n + 1) + u * u * u * control(c, which, n + 2)) /
         6;
}

// J q'' T^2/6: so far the mean of three points, a knot, lies beside the middle one, and no farther what is between; its
// part across the path. A tenth more for what varies within a segment, and what a bit of a position word and of a sum
// is.
KinematicsBench::Bound KinematicsBench::theory(const Course& c) const {
  const double h = 0.05, grain = 2 / arm_.gear * kDegree * (arm_.upper + arm_.fore) / 16;
  Bound largest{0, 0};
  for (double t = 1; t < c.tm + c.ta - 1; t += 0.5) {
    const auto joints = [&](double at) { return arm_.joints(c.path(progress(at, c.tm, c.ta, c.ts))); };
    const Joints a = joints(t - h), b = joints(t), d = joints(t + h);
    const Joints bent = {b.shoulder + (a.shoulder - 2 * b.shoulder + d.shoulder) / (h * h) * period_ * period_ / 6,
                         b.elbow + (a.elbow - 2 * b.elbow + d.elbow) / (h * h) * period_ * period_ / 6};
    const Point from = arm_.hand(b), to = arm_.hand(bent);
    largest.knot = std::max(largest.knot, std::hypot(to.x - from.x, to.y - from.y));
    largest.off = std::max(largest.off, std::fabs(c.off(to)));
  }
  return {1.1 * largest.knot + grain, 1.1 * largest.off + grain};
}

void KinematicsBench::enter(const std::string& kind, const std::vector<std::string>& lines) {
  host_.expect("OPEN " + kind + " CLEAR", "");
  for (const std::string& line : lines)
    if (const std::string answer = host_.ask(line); !answer.empty()) report().fail(line, answer);
  host_.expect("CLOSE", "");
}

void KinematicsBench::programs() {
  const double a = arm_.upper, b = arm_.fore;
  enter("FORWARD", {fmt::format("Q30=P1/{:.6g}{:+.6g} Q31=Q30+P2/{:.6g}{:+.6g}", arm_.gear, arm_.at_zero.shoulder,
                                arm_.gear, arm_.at_zero.elbow),
                    fmt::format("Q7={0:.6g}*COS(Q30)+{1:.6g}*COS(Q31) Q8={0:.6g}*SIN(Q30)+{1:.6g}*SIN(Q31)", a, b)});
  enter("INVERSE", {fmt::format("Q20=(Q7*Q7+Q8*Q8-{:.10g})/{:.10g}", a * a + b * b, 2 * a * b), "IF (ABS(Q20)!>1)",
                    "Q21=ACOS(Q20) Q0=Q7 Q22=ATAN2(Q8)",
                    fmt::format("Q0={:.6g}{}{:.6g}*COS(Q21) Q23=ATAN2({:.6g}*SIN(Q21))", a,
                                host_.bench().negative ? "-" : "+", b, b),
                    fmt::format("P1=(Q22-Q23{:+.6g})*{:.6g} P2=(Q21{:+.6g})*{:.6g}", -arm_.at_zero.shoulder, arm_.gear,
                                -arm_.at_zero.elbow, arm_.gear),
                    "ELSE", "M5182=1", "ENDIF", "P100=P100+1"});
}

std::vector<Course> KinematicsBench::courses() {
  const Point start = arm_.hand(stands());  // where a loop was closed
  const double angle = host_.pick(360) * kDegree, way = pick(15, 30), radius = pick(6, 10);
  const Point corner = {start.x + way * std::cos(angle), start.y + way * std::sin(angle)};
  const Point centre = {corner.x + radius * std::cos(angle / 2), corner.y + radius * std::sin(angle / 2)};
  const bool right = host_.pick(2) != 0;
  const double tm = 18, round = 37;
  Course line{"line",
              fmt::format("TM{} TA16 TS4 X{:.9f} Y{:.9f}", tm, corner.x, corner.y),
              [=](double part) {
                return Point{start.x + (corner.x - start.x) * part, start.y + (corner.y - start.y) * part};
              },
              [=](Point p) { return (p.y - start.y) * std::cos(angle) - (p.x - start.x) * std::sin(angle); },
              tm,
              16,
              4};
  Course circle{"circle",
                fmt::format("CIRCLE{} TM{} TA12 TS0 X{:.9f} Y{:.9f} I{:.9f} J{:.9f}", right ? 1 : 2, round, corner.x,
                            corner.y, centre.x - corner.x, centre.y - corner.y),
                [=](double part) {
                  const double turn = (right ? -360 : 360) * kDegree * part;
                  const double x = corner.x - centre.x, y = corner.y - centre.y;
                  return Point{centre.x + x * std::cos(turn) - y * std::sin(turn),
                               centre.y + x * std::sin(turn) + y * std::cos(turn)};
                },
                [=](Point p) { return std::hypot(p.x - centre.x, p.y - centre.y) - radius; },
                round,
                12,
                0};
  return {line, circle};
}

void KinematicsBench::axes_are_found(const std::string& when) {
  host_.expect("PMATCH", "");
  host_.wait_ms(3);
  const Point hand = arm_.hand(stands());
  const Point axes = {std::stod(host_.ask("RL$2047")), std::stod(host_.ask("RL$2048"))};
  const double off = std::hypot(axes.x - hand.x, axes.y - hand.y);
  report().step(when + ": axes by the forward program", off < 1e-4,
                fmt::format("{:.6f} mm off, expected up to 0.0001", off));
}

// Knots are whole segments behind its begin; the hand goes by what motors are commanded.
void KinematicsBench::judge_hand(const Course& c, double begin) {
  const Bound bound = theory(c);
  double worst = 0, at_knots = 0;
  const auto& s = host_.samples(1);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double t = static_cast<double>(i) * host_.period() - begin;
    if (t < 0 || t > c.tm + c.ta + 2 * period_) continue;
    worst = std::max(worst, std::fabs(c.off(arm_.hand({s[i].commanded, host_.samples(2)[i].commanded}))));
  }
  const int last = static_cast<int>((c.tm + c.ta) / period_) + 2;
  for (int n = 0; n <= last; ++n) {  // the samples beside a knot, straight between them
    const double place = (begin + n * period_) / host_.period();
    const auto i = static_cast<std::size_t>(std::max(0.0, place));
    if (i + 1 >= s.size()) break;
    const double part = place - static_cast<double>(i);
    const auto at = [&](unsigned m) {
      const auto& samples = host_.samples(m);
      return samples[i].commanded * (1 - part) + samples[i + 1].commanded * part;
    };
    const Point ideal = c.path(progress((n - 1) * period_, c.tm, c.ta, c.ts)), hand = arm_.hand({at(1), at(2)});
    at_knots = std::max(at_knots, std::hypot(hand.x - ideal.x, hand.y - ideal.y));
  }
  report().step(c.name + ": hand at knots", at_knots <= bound.knot,
                fmt::format("{:.4f} mm off, expected up to {:.4f}", at_knots, bound.knot));
  report().step(c.name + ": hand on the path", worst <= bound.off,
                fmt::format("{:.4f} mm off, expected up to {:.4f}", worst, bound.off));
}

// Counts between the first sample and the one that is farthest from it.
double KinematicsBench::travel(unsigned motor) const {
  double most = 0;
  for (const auto& s : host_.samples(motor))
    most = std::max(most, std::fabs(s.commanded - host_.samples(motor).front().commanded));
  return most;
}

double KinematicsBench::off_path(const std::vector<MotorHost::Sample>& samples, const MotorHost::Path& path,
                                 MotorHost::Fit& fit, double length) const {
  double worst = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) * host_.period() - fit.begin;
    if (t > length) break;
    const double off = std::fabs(samples[i].commanded - path(t));
    if (off > worst) worst = off, fit.at = t;
  }
  return worst;
}

void KinematicsBench::judge(const Course& c) {
  const double length = std::ceil((c.tm + c.ta) / period_ - 1e-9) * period_ + 2 * period_;
  const auto make = [&](int which) {
    return [=, this](double from) -> MotorHost::Path {
      return [=, this](double t) { return from - control(c, which, 0) + spline(c, which, std::clamp(t, 0.0, length)); };
    };
  };
  // Both begin together: the one that goes farther tells when, of the other a slow start may not be seen for long.
  const int leads = travel(1) >= travel(2) ? 1 : 2;
  const auto fit = host_.fit(static_cast<unsigned>(leads), make(leads), length);
  for (const int which : {1, 2}) {
    const auto& s = host_.samples(static_cast<unsigned>(which));
    auto as = fit;
    if (which != leads) as.worst = off_path(s, make(which)(s.front().commanded), as, length);
    report_fit(report(), fmt::format("{}, {}: path", c.name, which == 1 ? "shoulder" : "elbow"), as,
               static_cast<std::size_t>(length / host_.period()) - 2);
  }
  judge_hand(c, fit.begin);
  const Joints goal = arm_.joints(c.path(1)), end = commanded();
  const double off = std::max(std::fabs(end.shoulder - goal.shoulder), std::fabs(end.elbow - goal.elbow));
  report().step(c.name + ": joints at the end", off < 1e-3,
                fmt::format("{:.5f} counts off, expected up to 0.001", off));
}

void KinematicsBench::run() {
  if (host_.motors() < 2) return report().fail("channels", "expected two");
  arm_ = {pick(250, 350), pick(180, 250), pick(90, 140), {pick(-30, 30), pick(50, 100)}};
  period_ = 4 + host_.pick(2);
  host_.set_up();
  host_.variables(11, 0);
  host_.variables(21, 2);
  host_.variables(92, 0);
  host_.expect("I15=0 M5182->Y:$203F,22", "");
  host_.expect("&1#1->I #2->I", "");
  host_.say({fmt::format("I5150=1 I5113={} I5192=1", period_)});
  programs();
  host_.close_all();
  axes_are_found("at the start");
  for (const Course& c : courses()) {
    enter("PROG 1", {c.line});
    host_.record();
    host_.expect("P100=0 B1R", "");
    host_.wait_ms(c.tm);
    if (!host_.settle(c.ta + 60, 3)) report().fail(c.name, "still moving");
    judge(c);
    report().equal(c.name + ": run-time error", host_.ask("RY$2014"), std::string("0"));
  }
  host_.record();
  host_.expect("#1J:80 #2J:-40", "");
  host_.wait_ms(8);
  if (!host_.settle(100, 3)) report().fail("jog", "still moving");
  axes_are_found("behind a jog");
  const Joints there = {stands().shoulder - 100, stands().elbow + 60};
  const Point goal = arm_.hand(there);
  enter("PROG 1", {fmt::format("RAPID X{:.9f} Y{:.9f}", goal.x, goal.y)});
  host_.record();
  host_.expect("B1R", "");
  host_.wait_ms(8);
  if (!host_.settle(100, 3)) report().fail("RAPID", "still moving");
  const Joints end = commanded();
  const double off = std::max(std::fabs(end.shoulder - there.shoulder), std::fabs(end.elbow - there.elbow));
  report().step("RAPID: joints at the end", off < 1e-2, fmt::format("{:.5f} counts off, expected up to 0.01", off));
}

}  // namespace

Bench kinematics_bench() {
  return {
      "kinematics",
      "a two-joint arm by forward and inverse programs: a line and a circle in X and Y at each servo interrupt, axes "
      "behind a jog",
      {"a wrong sign in the inverse program", "line, shoulder: path", "counts off"},
      [](BenchContext& b) { KinematicsBench(b).run(); },
      kAServoIc,
      dac_axes<2>};
}

}  // namespace brick
