// Model of rtl/host/dpram.sv: 16-bit memory with two ports and BUSY arbitration. The CPU side samples its pins at every
// tick, the host side at clk_ref edges; nothing is executed while neither side has anything to do. docs/dpram.md.
#pragma once

#include <cstdint>
#include <vector>

#include <tlm_utils/simple_target_socket.h>
#include <systemc>
#include <tlm>

#include "systemc/core/model_block.h"
#include "systemc/host/inputs.h"

namespace brick {

class Dpram final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit Dpram(const sc_core::sc_module_name& name);

  // Memory without arbitration, for software that has no pins: 16-bit accesses at the host's byte offset.
  tlm_utils::simple_target_socket_optional<Dpram> socket;

  static constexpr unsigned kWords = 32768;

  using Inputs = DpramInputs;
  Inputs in;

  std::uint16_t cpu_rdata() const { return cpu_rdata_; }
  bool cpu_busy() const { return cpu_busy_; }
  std::uint16_t mem_rdata() const { return mem_rdata_; }
  bool mem_busy() const { return mem_busy_; }
  bool host_busy() const { return mem_busy_; }

  Tick next_event() const override;
  void advance(Tick t) override;
  void reset(Tick t) override;

  // Content, for initial values and reports. Index = host byte offset / 2; beyond the fitted size 0.
  std::uint16_t peek(unsigned index) const { return index < fitted() ? mem_[index] : 0; }
  void poke(unsigned index, std::uint16_t value) {
    if (index < fitted()) mem_[index] = value;
  }

 private:
  static constexpr unsigned kSmallWords = 8192;
  unsigned fitted() const { return in.small ? kSmallWords : kWords; }
  bool cpu_active() const { return cpu_rd_ || cpu_wr_; }
  bool conflict() const {
    return cpu_cell_ == in.mem_addr && (cpu_wr_ || !in.mem_rd);
  }  // of the two requests as they stand
  bool cpu_blocked() const { return host_own_ && conflict(); }
  bool host_blocked() const { return cpu_active() && conflict(); }
  bool cpu_idle() const;
  bool host_idle() const;
  void cpu_edge(bool blocked);
  void host_write();
  void host_edge(bool blocked);
  void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);

  std::vector<std::uint16_t> mem_ = std::vector<std::uint16_t>(kWords);
  bool cpu_rd_ = false, cpu_wr_ = false, cpu_done_ = false, cpu_busy_ = false;
  std::uint16_t cpu_cell_ = 0, cpu_rdata_ = 0;
  bool host_own_ = false, mem_busy_ = false;
  std::uint16_t mem_rdata_ = 0;
  Tick now_ = 0;
};

}  // namespace brick
