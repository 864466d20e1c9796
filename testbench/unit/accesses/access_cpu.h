// Random but sound bus cycles in the CPU's place, one after the other or with pauses: every region that has pins, read
// and write, words that exist and words that do not, at any CPU clock of I52 with the wait states of host-bus:2.5 or
// more. What is written is anything, but the clock words of the ICs are chosen so that PHASE and SERVO move often.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>

#include "systemc/machine/machine.h"

namespace brick {

class AccessCpu final : public BusMaster {
 public:
  enum Region { kServoIcs, kMacroIcs, kNoIc, kPanel, kDpram, kLatches, kOnChip, kRegions };
  static constexpr std::array<const char*, kRegions> kNames{
      "servo ICs", "MACRO ICs", "no IC", "control panel port", "dual-ported RAM", "latches", "on-chip page"};

  AccessCpu(Machine& machine, std::uint64_t seed, bool too_fast);  // gate ICs with less than their wait states
  ~AccessCpu() override { machine_.attach_bus_master(nullptr); }
  AccessCpu(const AccessCpu&) = delete;
  AccessCpu& operator=(const AccessCpu&) = delete;

  // The board has been reset: slowest wait states, I52 = 7. The board's part of the reset ends after the CPU's.
  void restart() { queue_.clear(), rest_ = kRest; }
  void another_clock();  // with its wait states, before the next cycles
  bool settled() const { return queue_.empty(); }
  std::uint64_t made(Region region, bool write) const { return made_[region][write]; }
  std::uint64_t made() const;

  std::optional<Access> next() override;
  void done(const Access& access, std::uint32_t data) override;

 private:
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  std::uint32_t data();
  std::uint32_t gate_ic(bool macro);
  void choose();
  void clock_word();
  void compare_output();
  void serial_inputs();

  Machine& machine_;
  bool too_fast_;
  std::mt19937_64 random_;
  static constexpr unsigned kRest = 16;
  std::deque<Access> queue_;  // BCR and PCTL, to be written
  Access chosen_;
  unsigned rest_ = kRest;  // CPU clocks without a cycle
  Region region_ = kDpram;
  std::array<std::array<std::uint64_t, 2>, kRegions> made_{};
};

}  // namespace brick
