// Model of rtl/host/dpram.sv: 16-bit memory with two ports and BUSY arbitration. The CPU side works at every tick, the
// host side at clk_ref edges; nothing is executed while neither side has anything to do, and edges that only let the
// strobe of another device pass are executed when the next one matters. docs/dpram.md.
#pragma once

#include <cstdint>

#include <systemc>

#include "systemc/core/model_block.h"
#include "systemc/host/dpram_memory.h"
#include "systemc/host/inputs.h"

namespace brick {

class Dpram final : public sc_core::sc_module, public ModelBlock {
 public:
  explicit Dpram(const sc_core::sc_module_name& name) : sc_module(name) {}

  static constexpr unsigned kWords = DpramMemory::kWords;

  using Inputs = DpramInputs;
  Inputs in;

  std::uint16_t cpu_rdata() const { return cpu_rdata_; }
  bool cpu_drive() const { return drive_ && !in.cpu_rd_n && in.rd_falls == drive_rd_; }
  // Whoever moves /RD says so: what it turns off without a clock stays off, though it falls again before the next edge.
  void rd_moved() {
    if (in.cpu_rd_n) drive_ = false;
  }
  bool cpu_wait() const { return in.cpu_sel && (in.rd_falls != rd_.acknowledged || in.wr_falls != wr_.done); }
  bool cpu_busy() const { return cpu_busy_; }
  std::uint16_t mem_rdata() const { return mem_rdata_; }
  bool mem_busy() const { return mem_busy_; }
  bool host_busy() const { return mem_busy_; }

  Tick next_event() const override;
  void advance(Tick t) override;
  void reset(Tick t) override;

  // Content, for initial values and reports. Index = host byte offset / 2; beyond the fitted size 0.
  std::uint16_t peek(unsigned index) const { return index < fitted() ? memory_.read(index) : 0; }
  void poke(unsigned index, std::uint16_t value, unsigned bytes = 3) {
    if (index < fitted()) memory_.write(index, value, bytes);
  }

 private:
  static constexpr unsigned kSmallWords = 8192;
  struct Strobe {
    std::uint8_t falls1, falls2, falls3, done, acknowledged;
    bool low1, low2;
    bool pending() const { return falls2 != done; }
    bool low() const { return pending() && low2; }
    // A tick after its fall, since level and select may come so late: nothing for this RAM.
    bool vain(bool sel) const { return falls2 == falls3 && !(sel && low2); }
  };

  unsigned fitted() const { return in.small ? kSmallWords : kWords; }
  std::uint16_t pin_cell() const {
    return static_cast<std::uint16_t>((in.cpu_addr & 0x3FFF) << 1 | (in.cpu_x ? 1 : 0));
  }
  bool request() const { return sel_ && (rd_.low() || wr_.low()) && !sampled_ && !proven_; }
  bool still() const { return wr_.low2 && !wr_.pending(); }  // the write under way, not a next one
  bool conflict() const { return pins_ == in.mem_addr && (wr_.low() || !in.mem_rd); }
  bool cpu_blocked() const { return (host_own_ || mem_busy_) && conflict(); }
  bool released() const {  // a new strobe has fallen, or the last one is seen high
    return !sampled_ && !proven_ && (rd_.pending() || wr_.pending() || !(own_wr_ ? wr_ : rd_).low2);
  }
  bool host_blocked() const {
    return (own_ && cell_ == in.mem_addr && (own_wr_ || !in.mem_rd)) || (request() && conflict() && !mem_busy_);
  }
  // Strobes of other devices show nowhere; advance() lets them pass when it is called next.
  bool others() const { return !in.cpu_sel && !sel_ && !own_ && !sampled_ && !proven_ && !cpu_busy_; }
  void let_others_pass(Tick count);
  bool cpu_settled() const;
  bool host_settled() const;
  void cpu_edge(bool blocked);
  void cpu_pins();
  void host_edge(bool blocked);

  DpramMemory memory_;
  // CPU side: pins as sampled, then the access under way
  Strobe rd_{}, wr_{};
  bool sel_{};
  std::uint16_t pins_{};
  bool drive_{};             // the word of a read stands
  std::uint8_t drive_rd_{};  // which one it was
  bool cpu_busy_{}, own_{}, own_wr_{}, sampled_{}, proven_{};
  std::uint16_t cell_{}, wdata_{}, cpu_rdata_{};
  // host side
  bool host_own_{}, mem_busy_{};
  std::uint16_t mem_rdata_{};
  Tick now_{};
};

}  // namespace brick
