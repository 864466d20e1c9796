// A timing vector as read from testbench/vectors/NAME.vec: what is done to the device, what it must do, with what
// corruption the vector must fail, and what of it is drawn. docs/vectors.md describes the format.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "testbench/unit/vectors/device.h"

namespace brick {

enum class Edge { kRises, kFalls, kChanges };
struct TimePoint {
  std::string mark;
  Tick offset = 0;
};
struct Window {  // from is in, to is out
  TimePoint from, to;
};
struct SignalEdge {
  unsigned signal;
  Edge edge;
};
struct Word {
  bool x;
  unsigned addr;
};

namespace step {
struct Reset {};
struct Write {
  Word word;
  std::uint32_t value;
};
struct Read {
  Word word;
  std::uint32_t mask, value;
};
struct Drive {
  unsigned signal;
  std::uint32_t value;
};
struct Wait {
  Tick ticks;
};
struct Until {
  SignalEdge edge;
  Tick limit;
};
struct Mark {
  std::string name;
};
struct Turn {  // a quadrature encoder
  unsigned channel;
  std::int64_t counts;
  Tick every;
};
struct Send {  // a serial converter: bit 23 first, the next after each fall of the clock
  std::uint32_t word;
  unsigned signal, clock;
  bool rises;  // an absolute encoder: bit 23 after the first rise, the next after each, zeros after the last
};
struct Command {
  std::string line;
  std::optional<std::string> reply;
};
struct Level {
  unsigned signal;
  std::uint32_t value;
};
struct High {
  unsigned signal;
  Tick ticks;
  Window window;
};
struct Count {
  SignalEdge edge;
  std::int64_t times;
  Window window;
};
struct At {
  SignalEdge edge;
  TimePoint time;
};
struct Period {
  unsigned signal;
  Tick ticks;
  Window window;
};
struct Pulses {
  unsigned signal;
  Tick ticks;
  Window window;
};
struct Stays {
  unsigned signal;
  std::uint32_t value;
  Window window;
};
struct Gap {
  SignalEdge first, second;
  Tick ticks;
  Window window;
};
struct Bits {
  unsigned signal, clock;
  std::string bits;
  Window window;
};
}  // namespace step

struct Step {
  int line;
  std::string text;
  std::variant<step::Reset, step::Write, step::Read, step::Drive, step::Wait, step::Until, step::Mark, step::Turn,
               step::Send, step::Command, step::Level, step::High, step::Count, step::At, step::Period, step::Pulses,
               step::Stays, step::Gap, step::Bits>
      action;
};

// A planted fault with which the vector must fail.
struct Corruption {
  enum Kind { kWrite, kRead, kLate, kStuck, kInvert, kCommand };
  std::string name;
  Kind kind;
  Word word{};             // kWrite, kRead: these bits are turned over
  std::uint32_t bits = 0;  // also the level of kStuck
  unsigned signal = 0;     // kLate, kStuck, kInvert
  Tick ticks = 0;          // kLate
  std::string line, instead;
};

struct WaveWindow {
  int line;
  Window window;
  Tick step;
};
struct WaveArrow {
  int line;
  SignalEdge from, to;
  TimePoint after;  // the first such edges from here on
  std::string text;
};
struct Wave {
  std::vector<unsigned> signals;
  std::vector<WaveWindow> windows;
  std::vector<WaveArrow> arrows;
};

struct Vector {
  std::string path, name, title, section, device, board;
  std::optional<int> number;          // check vector of servo-ic:14
  std::vector<DeviceSignal> signals;  // of the device; for drawings chN.position, where `turn` has turned it, and bus
  std::map<std::string, Tick> units;
  std::vector<Step> steps;
  std::vector<Corruption> negatives;
  std::optional<Wave> wave;

  const DeviceKind& kind() const;
};

// Throws UsageError, file and line in front.
Vector read_vector(const std::string& path);
Vector parse_vector(const std::string& text, const std::string& path);

}  // namespace brick
