// What a testbench is to the commands that run it: a named host program with steps and a verdict. Each has a negative
// control, a deliberately wrong rule or a seeded bug with which a named step must fail, so that its verdict means
// something. The benches themselves (testbench/benches) stand above the commands; `main` hands them in.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "systemc/machine/machine.h"
#include "testbench/checkers/comparison.h"
#include "testbench/checkers/timing_book.h"
#include "testbench/host/host_bus.h"
#include "testbench/host/host_link.h"

namespace brick {

namespace plant {
class Plant;
struct AxisParameters;
}  // namespace plant

struct BenchStep {
  Tick at = 0;
  std::string name;
  bool passed = true;
  std::string detail;  // what was measured; with a failure also what was expected
};

// How often something happened that a verdict rests on, and how often it has to in all runs together.
struct Cover {
  std::uint64_t count = 0, least = 1;
};

// Collects steps, and prints each as it comes.
class BenchReport {
 public:
  BenchReport(std::ostream& out, Machine& machine) : out_(out), machine_(machine) {}

  bool step(const std::string& name, bool passed, const std::string& detail);
  // Passes when nothing differs in `least` comparisons or more; `detail` is for a step that passes. A cover too,
  // unless it may have compared nothing.
  bool step(const std::string& name, const Comparison& compared, unsigned least, const std::string& detail);
  template <class T>
  bool equal(const std::string& name, const T& measured, const T& expected);
  // A step that passes when it happened so often, and a cover.
  bool reached(const std::string& name, std::uint64_t count, std::uint64_t least);
  // A cover alone (docs/covers.md); counts of one name are added.
  void cover(const std::string& name, std::uint64_t count, std::uint64_t least = 1);
  void fail(const std::string& name, const std::string& detail) { step(name, false, detail); }

  const std::vector<BenchStep>& steps() const { return steps_; }
  const std::map<std::string, Cover>& covers() const { return covers_; }
  bool passed() const;  // at least one step, and none failed

 private:
  std::ostream& out_;
  Machine& machine_;
  std::vector<BenchStep> steps_;
  std::map<std::string, Cover> covers_;
};

struct BenchContext {
  Machine& machine;
  HostBus& bus;
  HostLink& link;
  BenchReport& report;
  const BoardConfig& board;
  std::uint64_t seed;
  bool negative;
  TimingBook& timing;  // what judges the buses of this run
  bool forced_wait_states;
  plant::Plant* plant;     // of --plant, or the bench's own motors; nullptr: none
  unsigned motors = 0;     // so many of its own, as there are channels for
  std::uint64_t size = 0;  // --size: how much of what a bench can have more of; 0: as much as it has by itself

  std::string ask(const std::string& line) const;            // data lines joined by '|'
  std::vector<long> numbers(const std::string& line) const;  // data lines as numbers
  Tick next_fall(const PinField& pin, Tick limit) const;     // its tick, -1 after `limit` at either level
  unsigned clock_variable(unsigned k) const;  // number of I7m0k, I68n0k of the IC that makes the clocks at the factory
  std::string problems() const;               // what ??? reports of flash and clocks: "none", or by name
  void expect(const std::string& line, const std::string& answer) const { report.equal(line, ask(line), answer); }
};

// What a bench cannot do without.
struct BenchNeed {
  std::string what;  // "" if any board will do
  std::function<bool(const BoardConfig&)> met = [](const BoardConfig&) { return true; };
};
extern const BenchNeed kAnyBoard, kAServoIc, kServoIc0, kServoIcs01, kTwoIcs, kAMacroIc, kASlotOf16Bits, kSerialInputs;
std::uint32_t clock_ics(const BoardConfig& board);  // those that can make the clocks, bits as BoardConfig::fitted
BenchNeed without_8259(const BenchNeed& need);      // and the interrupt controller of the Turbo boards

// What `brick run --negative` does, and the proof that the bench sees it: the first step that fails.
struct NegativeControl {
  std::string does;                                   // one line
  std::string step;                                   // its name; '*', '?' for what depends on the seed
  std::string says;                                   // part of its detail, likewise
  std::function<void(MachineConfig&)> seed_bug = {};  // changes the machine; empty if the bench does it itself
  struct Also {
    std::string step, says;
  };
  std::vector<Also> also = {};  // steps that fail by a fault of their own, which `does` says too
};

struct Bench {
  std::string name;
  std::string description;  // one line
  NegativeControl negative;
  std::function<void(BenchContext&)> run;
  BenchNeed need = kAnyBoard;
  std::vector<plant::AxisParameters> (*motors)() =
      nullptr;                          // at the first channels, unless --plant stands others there
  std::string board = "geobrick-lv-8";  // without --board
  bool firmware = true;                 // false: no CPU runs, the bench drives Port A itself
  std::uint64_t least_size = 0;         // of --size; 0: it has an end of its own, and takes none
};

const Bench* find_bench(const std::vector<Bench>& benches, const std::string& name);  // nullptr: none of that name

template <class T>
bool BenchReport::equal(const std::string& name, const T& measured, const T& expected) {
  const bool same = measured == expected;
  return step(name, same, same ? printed(measured) : printed(measured) + ", expected " + printed(expected));
}

}  // namespace brick
