// What work of the planner costs on the image.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "systemc/cpu/elf_file.h"
#include "testbench/unit/firmware_platform/image_board.h"

namespace brick {

// Own cycles of functions with all that they call on the stack of slices, interrupts above it taken off; how often
// `point` is reached in them, and `step`.
class OwnCycles {
 public:
  OwnCycles(ImageBoard& board, const std::string& function, const std::string& point, const std::string& step = "")
      : OwnCycles(board, std::vector<std::string>{function}, point, step) {}
  OwnCycles(ImageBoard& board, const std::vector<std::string>& functions, const std::string& point,
            const std::string& step = "")
      : board_(board), elf_(firmware_image()) {
    for (const std::string& function : functions) begin_.push_back(*elf_.symbol(function));
    pause_ = *elf_.symbol("slice_pause"), round_ = *elf_.symbol("make_round");
    point_ = *elf_.symbol(point);
    if (!step.empty()) step_ = *elf_.symbol(step);
    trap_ = *elf_.symbol("trap_vector"), trap_end_ = *elf_.symbol("trap_real_time");
    board.on_instruction = [this] { look(); };
  }
  ~OwnCycles() { board_.on_instruction = nullptr; }
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t longest() const { return longest_; }  // between two pauses
  std::string longest_at() const { return longest_at_; }
  unsigned points() const { return points_; }
  unsigned steps() const { return steps_; }
  void from_here() { cycles_ = points_ = steps_ = 0; }

 private:
  static constexpr std::uint32_t kSideStack = 0x20000000, kSideStackBytes = 8192;

  void look() {
    const std::uint64_t now = board_.cpu().cycle(), spent = now - last_;
    const std::uint32_t sp = board_.cpu().reg(2), pc = board_.cpu().pc();
    last_ = now;
    if (interrupted_) {
      interrupted_ = pc != before_pc_ || sp != before_sp_;
      if (interrupted_) return;
    } else if (sp - kSideStack < kSideStackBytes) {
      if (pc >= trap_ && pc < trap_end_)
        interrupted_ = true;
      else
        count(pc, sp, spent);
    }
    if (!interrupted_) before_pc_ = pc, before_sp_ = sp;
  }
  void count(std::uint32_t pc, std::uint32_t sp, std::uint64_t spent) {
    if (pc == round_) inside_ = false;  // an abort has thrown away what was under way
    if (inside_) {
      cycles_ += spent, since_pause_ += spent;
      if (pc == pause_ || pc == return_) {
        if (since_pause_ > longest_) longest_ = since_pause_, longest_at_ = elf_.symbol_at(board_.cpu().reg(1));
        since_pause_ = 0;
      }
      points_ += pc == point_;
      steps_ += pc == step_;
      inside_ = pc != return_ || sp != sp_;
    } else if (std::find(begin_.begin(), begin_.end(), pc) != begin_.end()) {
      inside_ = true, since_pause_ = 0;
      return_ = board_.cpu().reg(1), sp_ = sp;
    }
  }
  ImageBoard& board_;
  const ElfFile elf_;
  std::vector<std::uint32_t> begin_;
  std::uint32_t pause_, round_, point_, step_ = 0, trap_, trap_end_;
  bool inside_ = false, interrupted_ = false;
  std::uint32_t return_ = 0, sp_ = 0, before_pc_ = 0, before_sp_ = 0;
  std::uint64_t last_ = 0, cycles_ = 0, since_pause_ = 0, longest_ = 0;
  std::string longest_at_;
  unsigned points_ = 0, steps_ = 0;
};

}  // namespace brick
