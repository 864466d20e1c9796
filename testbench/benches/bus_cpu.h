// Accesses in the CPU's place, one after the other, for benches that need both sides of the host port or of the
// dual-ported RAM at once. The firmware stands still until the next reset.
#pragma once

#include <optional>

#include "systemc/machine/machine.h"
#include "testbench/host/host_bus.h"

namespace brick {

class BusCpu : public BusMaster {
 public:
  explicit BusCpu(HostBus& bus) : bus_(bus) { bus_.machine().attach_bus_master(this); }
  ~BusCpu() override { bus_.machine().attach_bus_master(nullptr); }
  BusCpu(const BusCpu&) = delete;
  BusCpu& operator=(const BusCpu&) = delete;

  std::uint32_t read_x(std::uint32_t address) { return make({true, address, false, 0, 0}); }
  void write_x(std::uint32_t address, std::uint32_t data) { make({true, address, true, data, 0}); }

  std::optional<Access> next() override { return std::exchange(ordered_, std::nullopt); }
  void done(const Access&, std::uint32_t data) override { data_ = data; }

 private:
  std::uint32_t make(const Access& access) {
    ordered_ = access;
    data_.reset();
    while (!data_) bus_.wait(12);
    bus_.wait(12);  // what it does inside the board has been done
    return *data_;
  }

  HostBus& bus_;
  std::optional<Access> ordered_;
  std::optional<std::uint32_t> data_;
};

}  // namespace brick
