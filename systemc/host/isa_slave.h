// Model of rtl/host/isa_slave.sv: synchronises the ISA commands, decodes them and drives the host port, the interrupt
// controller and the dual-ported RAM. Its pipelines run behind: only edges that others can see are events.
// docs/isa_slave.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/core/model_block.h"
#include "systemc/host/inputs.h"

namespace brick {

class IsaSlave final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit IsaSlave(const sc_core::sc_module_name& name) : sc_module(name) {}

  using Inputs = IsaSlaveInputs;
  Inputs in;

  // Host bus
  std::uint16_t isa_sd() const { return sd_; }
  std::uint8_t isa_sd_oe() const { return drives() && read_low() ? lanes_ : 0; }
  bool isa_iochrdy() const { return !(mem_target() && cycle_ == Cycle::kStart) && !in.mem_busy; }
  bool isa_memcs16_n() const { return (la_hits_ & 1) == 0; }
  bool host_reset() const { return (resetdrv_ & 2) != 0; }
  // The block that the present cycle is for, or the last one was: only its wires move.
  bool pic_target() const { return (target_ & kPic) != 0; }
  bool mem_target() const { return (target_ & kMemory) != 0; }
  // Host port
  bool hp_sel() const { return target_ & kPort; }
  bool hp_rd() const { return hp_sel() && cycle_ == Cycle::kStart && (kind_ & kIor); }
  bool hp_rd_done() const { return hp_sel() && cycle_ == Cycle::kDoneShown && takes_effect(); }
  bool hp_wr() const { return hp_sel() && takes_effect() && (kind_ & kIow); }
  std::uint8_t hp_addr() const { return io_addr_ & 7; }
  std::uint8_t hp_wdata() const { return wdata_ & 0xFF; }
  // Interrupt controller
  bool pic_sel() const { return target_ & kPic; }
  bool pic_rd() const {
    return pic_sel() && cycle_ == Cycle::kShow && (kind_ & kIor) && cmd2_ == kind_ && !host_reset();
  }
  bool pic_wr() const { return pic_sel() && takes_effect() && (kind_ & kIow); }
  std::uint8_t pic_addr() const { return io_addr_ & 3; }
  std::uint8_t pic_wdata() const { return wdata_ & 0xFF; }
  // Dual-ported RAM
  bool mem_sel() const { return (target_ & kMemory) && active(); }
  bool mem_rd() const { return kind_ & kMemr; }
  bool mem_wr() const { return (target_ & kMemory) && takes_effect() && (kind_ & kMemw); }
  std::uint16_t mem_addr() const { return mem_addr_; }
  std::uint8_t mem_be() const { return be_; }
  std::uint16_t mem_wdata() const { return byte8_ ? static_cast<std::uint16_t>((wdata_ & 0xFF) * 0x101) : wdata_; }

  // Whoever looks on takes no notice of the end of an I/O read but of the host port's receive register, where alone it
  // does something: the others are no events any more.
  void leave_ends_out() { every_end_ = false; }

  Tick next_event() const override;
  void advance(Tick t) override;
  void reset(Tick t) override;

 private:
  enum Command : std::uint8_t { kIor = 1, kIow = 2, kMemr = 4, kMemw = 8, kAll = 15 };
  static constexpr std::uint8_t kAllHits = 15, kSecondHit = 2, kOldestHit = 8;  // of la_hits_
  static constexpr std::uint32_t kSa = 0x1FFFF;                                 // what of SA the cycle needs
  enum Target : std::uint8_t { kPort = 1, kPic = 2, kOther = 4, kMemory = 8 };
  enum class Cycle : std::uint8_t {
    kIdle,   // no command
    kStart,  // the clock after the one that found a command low
    kFetch,  // data of the RAM has still to come
    kShow,   // data is on the bus since this clock
    kShown,  // data was on the bus with the command still low
    kHold,   // nothing to do until the command goes: a write, a cycle of others, a spoilt one, one from before a reset
    kDone,   // the clock after the end
    kDoneShown  // the same of a read whose data was shown
  };

  bool finished() const { return cycle_ == Cycle::kDone || cycle_ == Cycle::kDoneShown; }
  bool takes_effect() const { return finished() && !host_reset(); }
  bool active() const { return cycle_ != Cycle::kIdle && !finished(); }
  bool drives() const { return cycle_ == Cycle::kShow || cycle_ == Cycle::kShown; }
  bool fetched() const { return cycle_ == Cycle::kFetch && !in.mem_busy; }  // the coming edge takes the RAM's data

  static bool writes(unsigned commands) { return (commands & (kIow | kMemw)) != 0; }
  std::uint8_t command_pins() const {
    return (in.isa_ior_n ? 0 : kIor) | (in.isa_iow_n ? 0 : kIow) | (in.isa_memr_n ? 0 : kMemr) |
           (in.isa_memw_n ? 0 : kMemw);
  }
  // What the synchroniser shows n clk_pwm edges from now.
  std::uint8_t command_in(Tick n) const { return n == 0 ? cmd2_ : n == 1 ? cmd1_ : command_pins(); }
  std::uint8_t la_pins() const {
    return static_cast<std::uint8_t>(straps_.slot8 ? in.isa_sa >> 17 & 7 : in.isa_la & 0x7Fu);
  }
  bool settings_still() const { return !(straps_ != in) && resetdrv_ == (in.isa_resetdrv ? 3 : 0); }
  bool la_hit(unsigned la) const { return ((la << 3 ^ straps_.window) & (straps_.slot8 ? 0x38u : 0x3F8u)) == 0; }
  std::uint8_t with_hit(std::uint8_t hits, unsigned la) const {
    return static_cast<std::uint8_t>((hits << 1 | (la_hit(la) ? 1 : 0)) & kAllHits);
  }
  bool read_low() const {
    return (((kind_ & kIor) && !in.isa_ior_n) || ((kind_ & kMemr) && !in.isa_memr_n)) && in.isa_iow_n && in.isa_memw_n;
  }
  bool spoilt(unsigned command) const { return active() && (command & ~kind_ & kAll) != 0; }
  bool addresses_page() const { return !straps_.window_flat && io_addr_ == regs::host_io::kPage.address % 16; }
  std::uint8_t decode() const;
  std::uint8_t io_read() const;
  bool ref_acts(unsigned command) const;
  bool ref_shows(unsigned command) const;
  bool end_shows() const {
    return every_end_ || kind_ != kIor || (hp_sel() && hp_addr() == (regs::host_io::kData7.address & 7));
  }
  bool commands_settled() const;
  bool stages_still() const;
  Tick next_memcs16() const;
  void pwm_edges(Tick count, bool still);
  void sample();
  void cycle_edge();
  Cycle next_cycle(bool io_load, bool mem_load) const;
  void begin();

  Tick now_{};
  // clk_pwm
  std::uint8_t cmd1_{}, cmd2_{}, la1_{}, la2_{}, la_hits_{};
  std::uint16_t sd1_{}, sd2_{}, sd_low_{};  // sd_low_: the last with a write command low
  std::uint16_t wdata_{};                   // the same for who works on clk_ref
  // clk_ref: samples
  std::uint32_t sa_{};
  bool aen_{}, sbhe_n_{};
  std::uint8_t resetdrv_{};
  IsaStraps straps_;
  // the cycle
  Cycle cycle_{};
  bool byte8_{};
  std::uint8_t kind_{}, target_{}, lanes_{}, be_{}, page_{}, io_addr_{};
  std::uint16_t mem_addr_{}, sd_{};
  std::uint8_t oe_shown_{};  // after the last edge
  bool every_end_ = true;
};

}  // namespace brick
