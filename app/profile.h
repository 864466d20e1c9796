// Where the cycles of the firmware go (`--profile FILE`, docs/profile.md): by instruction, call and task, and the
// dearest run of each task with the program line that took most of it. It looks between two instructions by the back
// door: the controller does the same with it and without.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "app/callgrind.h"
#include "app/profiled_task.h"
#include "systemc/core/ticks.h"
#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"

namespace brick {

class Machine;

class Profile {
 public:
  // Takes on_trap, on_mret, on_reset and on_instruction of the CPU, whose former owners are called on; ends before they
  // do. Throws UsageError where the image cannot be read.
  Profile(Machine& machine, std::string file, const std::string& image);
  ~Profile();
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;

  void close();              // writes the file; throws UsageError
  std::string text() const;  // after close(): a line a task, "" before

 private:
  // A line of a program, as LIST PC names it.
  struct Line {
    std::string program;
    std::uint32_t offset;
    bool operator<(const Line& other) const {
      return std::tie(program, offset) < std::tie(other.program, other.offset);
    }
  };
  struct Frame {
    std::uint32_t site, callee, back;
    bool tail;            // it was jumped to: whoever it returns to has called one before it
    std::uint64_t begin;  // Stack::own
  };
  // `executor` 0: no program is executed. Its line has taken what came since `line_begin`; its turn ends with the frame
  // that stood on top when it was called.
  struct Stack {
    std::vector<Frame> frames;
    std::uint64_t own = 0;  // cycles
    std::uint32_t executor = 0;
    std::size_t turn = 0;  // frames
    std::uint64_t line_begin = 0;
  };
  // What one trap has interrupted goes on when it ends, so each has a stack of calls of its own.
  struct Level {
    explicit Level(ProfiledTask of) : task(of) {}
    ProfiledTask task;
    Stack stack;
    bool on_side = false;
    std::map<Line, std::uint64_t> lines;
  };
  struct Worst {
    std::uint64_t runs = 0, cycles = 0, of_line = 0;
    TimeFs at = 0;
    std::optional<Line> line;
  };
  struct Call {
    std::uint64_t count = 0;
    TaskCycles inclusive{};
  };
  using Page = std::array<TaskCycles, 2048>;  // by halfword of 4 KiB

  void trapped(std::uint32_t cause);
  void executed(std::uint32_t pc, Cycle cycles);
  void follow(std::uint32_t from, std::uint32_t to);
  void leave(Level& level, Stack& stack);   // its newest frame
  void charge(Level& level, Stack& stack);  // to the line under way
  void begin_anew();
  void unwind(Level& level);
  void judge(Level& level, std::uint64_t cycles);
  std::optional<Line> line_of(std::uint32_t executor) const;
  TaskCycles& cost(std::uint32_t pc);
  void write();

  Machine& machine_;
  Cpu& cpu_;
  std::string file_;
  ElfFile elf_;
  Callgrind out_;
  std::uint32_t executor_step_, background_pass_, exchange_stacks_;
  decltype(Cpu::on_trap) on_trap_;
  decltype(Cpu::on_mret) on_mret_;
  decltype(Cpu::on_reset) on_reset_;
  std::vector<Level> levels_;
  Stack side_;  // of the work in slices, which goes on from where it has paused
  bool entering_ = false, leaving_ = false, unwinds_ = false;
  std::unordered_map<std::uint32_t, std::unique_ptr<Page>> pages_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Call> calls_;  // site, callee
  std::array<Worst, kProfiledTasks> worst_;
  std::string text_;
};

}  // namespace brick
