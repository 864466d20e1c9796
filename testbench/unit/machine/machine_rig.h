// A machine with a probe program, and a host that plays ISA cycles by the tick.
#pragma once

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "systemc/cpu/port_a.h"
#include "systemc/machine/machine.h"

namespace brick {

struct MachineRig {
  explicit MachineRig(const std::string& program, MachineConfig config = {})
      : machine(sc_core::sc_gen_unique_name("machine"), with(std::move(config), program)) {}

  static MachineConfig with(MachineConfig config, const std::string& program) {
    config.firmware = std::string(BRICK_PROBES) + "/" + program + ".elf";
    return config;
  }
  // PMAC word Y:address.
  std::uint32_t y(std::uint32_t address) {
    std::uint32_t v = 0;
    std::memcpy(&v, machine.cpu().memory(kPmacBase + 8 * address, 4), 4);
    return v;
  }
  void set_y(std::uint32_t address, std::uint32_t v) {
    std::memcpy(machine.cpu().memory(kPmacBase + 8 * address, 4), &v, 4);
  }
  std::uint64_t signal(const char* name) { return machine.signals().value(machine.signals().find(name).value()); }

  Machine machine;
};

}  // namespace brick
