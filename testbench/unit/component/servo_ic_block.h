// The servo IC inside, and traffic for it.
#pragma once

#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/component/traffic.h"

namespace brick::component {

constexpr unsigned kClockControl = 8 * 4 + 4;  // byte of X:+$04 at the socket

class ServoIcBlock final : public Block {
 public:
  explicit ServoIcBlock(const char* name = "block");
  void set(const std::string& pin, std::uint32_t value) override;
  void edge(Tick t) override;
  bool moved() override;
  std::uint32_t read(unsigned address) override;
  void accessed(const Access& access) override;
  std::map<std::string, std::uint32_t> outputs() const override;

 private:
  brick::ServoIc ic_;
  MotorInputs pins_;
  bool phase_ = true, servo_ = true, reset_ = false;
  Tick now_ = 0;
  MotorOutputs shown_;
  unsigned clocks_ = 0;
};

Traffic servo_ic_traffic(std::uint32_t seed, Tick ticks);

}  // namespace brick::component
