// The firmware image on the CPU model with the simplest devices that let it live: gate IC registers that hold what is
// written, an HI08 that a host reads and writes at once, and phase and servo interrupts at the rate of servo IC 0. No
// Port A, no edges: for tests of the firmware's tasks and speed. The whole machine is tested in testbench/unit/system.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/elf_file.h"

namespace brick {

// The file that tests run: BRICK_IMAGE of the environment, else that of the build.
std::string firmware_image();

// At its end it adds a line to the file BRICK_EXECUTED of the environment: the test, the addresses of the instructions
// that it has executed.
class ImageBoard : public DeviceBus {
 public:
  ImageBoard(const std::string& elf, std::uint32_t fitted);
  ~ImageBoard() override;

  Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) override;

  void reset(Cycle clock_phase = 0);  // `clock_phase`: CPU cycles that the clocks are ahead, up to a servo period
  void set_clocks(bool running) { clocks_ = running; }
  void run_ms(double ms);
  std::string send(const std::string& characters, double limit_ms = 100.0);  // until ACK, an error's CR, or the limit
  double now_ms() const { return static_cast<double>(cpu_.cycle()) / kCyclesPerMs; }
  std::uint64_t instructions() const { return cpu_.instructions(); }
  std::uint64_t device_accesses() const { return accesses_; }
  std::uint32_t word(bool x, std::uint32_t address);
  void fill_memory(std::uint32_t pattern);
  Cpu& cpu() { return cpu_; }
  std::function<void()> on_instruction;  // after each one; empty costs nothing
  std::uint64_t strobes() const { return strobes_; }
  double longest_strobe_gap_ms() const {
    return static_cast<double>(longest_gap_) / kCyclesPerMs;
  }  // since the last reset
  double clocks_started_ms() const {
    return static_cast<double>(clocks_started_) / kCyclesPerMs;
  }  // after reset: servo IC 0 drives

  static constexpr double kCyclesPerMs = 78643.2;
  static constexpr Cycle kPhaseCycles = 8705;  // 13057 periods of 117.9648 MHz

 private:
  void step(Cycle limit);
  void update_host_line();

  Cpu cpu_;
  std::uint32_t entry_ = 0;
  std::uint32_t fitted_;
  bool clocks_ = true;
  std::map<std::uint32_t, std::uint32_t> registers_;
  std::uint32_t hcr_ = 0;
  std::deque<std::uint8_t> to_cpu_;
  std::string from_cpu_;
  Cycle next_phase_ = 0;
  unsigned phases_ = 0;
  std::uint64_t accesses_ = 0, strobes_ = 0;
  Cycle reset_at_ = 0, last_strobe_ = 0, longest_gap_ = 0, clocks_started_ = 0;
};

}  // namespace brick
