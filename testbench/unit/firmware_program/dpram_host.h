// A host at the dual-ported RAM of the native firmware: it looks and writes between two background passes.
#pragma once

#include <string>

#include "testbench/host/dpram_port.h"
#include "testbench/unit/firmware_program/platform.h"

extern "C" {
#include "firmware/base/dpram.h"
}

namespace platform {

class NativeDpram : public brick::DpramAccess {
 public:
  std::uint16_t read(std::uint32_t offset) override { return static_cast<std::uint16_t>(dpram_read(offset)); }
  void write(std::uint32_t offset, std::uint16_t word) override { dpram_write(offset, word); }
  brick::Tick now() override { return passes_; }
  void pause(brick::Tick, brick::Tick) override {
    ++passes_;
    background(1);
  }

 private:
  brick::Tick passes_ = 0;
};

// Its time-outs are background passes. The reply as platform::host has it.
class DpramHost : public brick::DpramPort {
 public:
  static constexpr brick::Tick kPasses = 50;
  explicit DpramHost(NativeDpram& ram) : DpramPort(ram) {}
  std::string ask(const std::string& line) {
    const brick::Reply reply = command(line, kPasses);
    std::string joined = reply.complete ? "" : "no end:";
    for (const std::string& part : reply.lines) joined += (joined.empty() ? "" : "|") + part;
    return joined;
  }
};

}  // namespace platform
