// A two-joint arm (SCARA): its programs as a user writes them, and its geometry in doubles.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "testbench/unit/firmware_program/moving_motors.h"

namespace arm {

using moving_motors::Lines;
using platform::host;

constexpr double kPi = 3.14159265358979323846;
constexpr double kUpper = 300, kFore = 250;  // lengths of the links, mm
constexpr double kCounts = 1000;             // a degree

struct Point {
  double x, y;
};
struct Joints {
  double shoulder, elbow;  // counts
};

inline Joints joints(Point at) {  // elbow to the right: its angle is positive
  const double square = at.x * at.x + at.y * at.y;
  const double elbow = std::acos((square - kUpper * kUpper - kFore * kFore) / (2 * kUpper * kFore));
  const double shoulder =
      std::atan2(at.y, at.x) - std::atan2(kFore * std::sin(elbow), kUpper + kFore * std::cos(elbow));
  return {shoulder * 180 / kPi * kCounts, elbow * 180 / kPi * kCounts};
}

inline Point point(Joints j) {
  const double first = j.shoulder / kCounts * kPi / 180, both = first + j.elbow / kCounts * kPi / 180;
  return {kUpper * std::cos(first) + kFore * std::cos(both), kUpper * std::sin(first) + kFore * std::sin(both)};
}

// Counts: P4 runs of the forward program, P5 of the inverse one.
inline Lines forward() {
  return {"Q7=300*COS(P1/1000)+250*COS((P1+P2)/1000)", "Q8=300*SIN(P1/1000)+250*SIN((P1+P2)/1000)", "P4=P4+1"};
}
inline Lines inverse() {
  return {"Q20=(Q7*Q7+Q8*Q8-152500)/150000",
          "IF (ABS(Q20)!>1)",
          "Q21=ACOS(Q20) Q0=Q7 Q22=ATAN2(Q8)",
          "Q0=300+250*COS(Q21) Q23=ATAN2(250*SIN(Q21))",
          "P1=(Q22-Q23)*1000 P2=Q21*1000",
          "ELSE",
          "M5182=1",
          "ENDIF",
          "P5=P5+1"};
}

class Arm : public moving_motors::MovingMotors {
 protected:
  static void program(const std::string& kind, const Lines& lines) {
    ASSERT_EQ(host("&1OPEN " + kind + " CLEAR"), "");
    for (const std::string& line : lines) ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE"), "");
  }
  // Motors 1 and 2 of &1, and further ones; the arm stands at `start`.
  static void fit_arm(Point start = {400, 100}, const Lines& others = {}) {
    Lines definitions = {"I", "I"};
    definitions.insert(definitions.end(), others.begin(), others.end());
    fit(definitions);
    program("FORWARD", forward());
    program("INVERSE", inverse());
    ASSERT_EQ(host("I5150=1 I15=0 M5182->Y:$203F,22"), "");
    put(joints(start));
  }
  static void put(Joints j) {
    motors[0].trajectory = std::llround(j.shoulder * moving_motors::kUnit);
    motors[1].trajectory = std::llround(j.elbow * moving_motors::kUnit);
  }
  static Joints now() { return {at(1), at(2)}; }
  static Point hand() { return point(now()); }
  static double p(unsigned number) { return p_variable_read(number); }
  static double axis(unsigned which) { return cs().position[which]; }
};

}  // namespace arm
