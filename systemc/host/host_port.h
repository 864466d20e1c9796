// Model of rtl/host/host_port.sv, the HI08: eight bytes for the host, six words for the CPU, a word of buffering on
// either side of each way. The names of the registers are those of rtl/regs/host_io.rdl and board.rdl.
// docs/host_port.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class HostPort final : public sc_core::sc_module, public RefClockedBlock {
 public:
  explicit HostPort(const sc_core::sc_module_name& name) : sc_module(name) {}

  using Inputs = HostPortInputs;
  Inputs in;

  std::uint8_t hp_rdata() const { return host_read(in.hp_addr); }
  std::uint32_t dsp_rdata() const { return cpu_read(in.dsp_addr); }
  bool hreq() const;
  bool irq() const;
  bool txde() const { return txde_; }
  bool rxdf() const { return rxdf_; }

  // Without side effects.
  std::uint8_t host_read(unsigned addr) const;
  std::uint32_t cpu_read(unsigned addr) const;

 private:
  bool idle() const override;
  void step() override;
  void reset_registers() override;
  bool host_side_reset() const;
  void reset_host_side();
  void host_write();
  void cpu_write();

  bool tx_move() const { return !txde_ && !hrdf_; }
  bool rx_move() const { return !htde_ && !rxdf_; }

  std::uint8_t icr_{}, cvr_{}, ivr_{}, hcr_{}, hbar_{};
  std::uint16_t hpcr_{};
  std::uint32_t tx_{}, horx_{}, hotx_{}, rx_{};
  bool txde_{}, hrdf_{}, htde_{}, rxdf_{};
  bool saw_{};  // the host's read under way found a word in RX
};

}  // namespace brick
