// Model of rtl/host/isa_slave.sv: synchronises the ISA commands, decodes them and drives the host port, the interrupt
// controller and the dual-ported RAM. Asleep while the pins stand still. docs/host-bus.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/host/inputs.h"
#include "systemc/host/ref_clocked_block.h"

namespace brick {

class IsaSlave final : public sc_core::sc_module, public RefClockedBlock {
 public:
  struct Config {
    std::uint16_t io_base = regs::host_io::kBase;
    std::uint8_t mem_page = regs::kDpramWindowBase >> 16;  // SA[19:16]
    bool decode_all = true;                                // false: classic ten-bit I/O decode
  };
  explicit IsaSlave(const sc_core::sc_module_name& name) : IsaSlave(name, Config()) {}
  IsaSlave(const sc_core::sc_module_name& name, const Config& config) : sc_module(name), config_(config) {}

  using Inputs = IsaSlaveInputs;
  Inputs in;

  // Host bus
  std::uint16_t isa_sd() const { return sd_; }
  bool isa_iochrdy() const { return !in.mem_busy; }
  bool isa_memcs16_n() const { return memcs16_n_; }
  // Host port
  bool hp_sel() const { return target() & kHostPort; }
  bool hp_rd_done() const { return hp_sel() && finish() && (cmd2_ & kIor); }
  bool hp_wr() const { return hp_sel() && finish() && (cmd2_ & kIow); }
  std::uint8_t hp_addr() const { return addr() & 7; }
  std::uint8_t hp_wdata() const { return sd2_ & 0xFF; }
  // Interrupt controller
  bool pic_sel() const { return target() & kPic; }
  bool pic_wr() const { return pic_sel() && finish() && (cmd2_ & kIow); }
  bool pic_rd() const { return pic_sel() && start() && (cmd1_ & kIor); }
  std::uint8_t pic_addr() const { return addr() & 3; }
  std::uint8_t pic_wdata() const { return sd2_ & 0xFF; }
  // Dual-ported RAM
  bool mem_sel() const { return (target() & kMemory) && !finish(); }
  bool mem_rd() const { return (start() ? cmd1_ : cmd2_) & kMemr; }
  bool mem_wr() const { return (target() & kMemory) && finish() && (cmd2_ & kMemw); }
  std::uint16_t mem_addr() const { return addr() >> 1; }
  std::uint8_t mem_be() const { return be_; }
  std::uint16_t mem_wdata() const { return byte8_ ? static_cast<std::uint16_t>((sd2_ & 0xFF) * 0x101) : sd2_; }

 private:
  enum Command : std::uint8_t { kIor = 1, kIow = 2, kMemr = 4, kMemw = 8 };
  enum Target : std::uint8_t { kHostPort = 1, kPic = 2, kReserved = 4, kMemory = 8 };

  bool idle() const override;
  void step() override;
  void reset_registers() override;

  std::uint8_t command_pins() const {
    return (in.isa_ior_n ? 0 : kIor) | (in.isa_iow_n ? 0 : kIow) | (in.isa_memr_n ? 0 : kMemr) |
           (in.isa_memw_n ? 0 : kMemw);
  }
  bool start() const { return cmd1_ != 0 && cmd2_ == 0; }
  bool finish() const { return cmd1_ == 0 && cmd2_ != 0; }
  std::uint8_t target() const { return start() ? decode() : target_; }
  std::uint8_t decode() const;
  std::uint16_t addr() const { return start() ? static_cast<std::uint16_t>(sa1_) : addr_; }
  bool memcs16_n_next() const { return (sa1_ >> 16) != config_.mem_page; }

  Config config_;
  // synchroniser
  std::uint8_t cmd1_ = 0, cmd2_ = 0;
  std::uint32_t sa1_ = 0;
  std::uint16_t sd1_ = 0, sd2_ = 0;
  bool aen1_ = false, sbhe1_n_ = true;
  // the command under way
  std::uint8_t target_ = 0, be_ = 0;
  std::uint16_t addr_ = 0, sd_ = 0xFFFF;
  bool byte8_ = false, load_ = false, memcs16_n_ = true;
};

}  // namespace brick
