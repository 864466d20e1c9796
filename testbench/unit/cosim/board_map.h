// A board of two servo ICs on either engine, and cycles of both its buses by the tick: ISA, the on-chip page.
#pragma once

#include <gtest/gtest.h>

#include "systemc/cosim/engines.h"
#include "testbench/unit/board/board_rig.h"
#include "testbench/unit/covers.h"

namespace brick {

constexpr std::uint32_t kTwoServoIcs = 0x3;
constexpr std::uint32_t kIoBase = 0x210, kMemBase = 0xD0000;

class BoardMap : public ::testing::TestWithParam<bool> {
 protected:
  BoardMap() : BoardMap(kTwoServoIcs) {}
  explicit BoardMap(std::uint32_t fitted)
      : rig(GetParam() ? make_rtl_board(fitted) : make_model_board(fitted), fitted) {}

  // So long that nothing is under way; then `phase` ticks behind an edge of clk_ref.
  void rest(Tick phase) {
    rig.run(30);
    while (rig.now() % kTicksPerRef != phase) rig.run(1);
  }
  void strobe(bool BoardInputs::*command, Tick width) {
    rig.apply();
    rig.run(10);
    rig.in.*command = false;
    rig.apply();
    rig.run(width);
  }
  void end(bool BoardInputs::*command) {
    rig.in.*command = true;
    rig.apply();
    rig.run(12);
  }
  void io_write(unsigned offset, std::uint16_t value) {
    rig.in.set_address(kIoBase + offset);
    rig.in.isa_sd = value;
    strobe(&BoardInputs::isa_iow_n, 60);
    end(&BoardInputs::isa_iow_n);
  }
  std::uint32_t io_read(unsigned offset) {
    rig.in.set_address(kIoBase + offset);
    strobe(&BoardInputs::isa_ior_n, 60);
    const std::uint32_t value = rig.get(pin::kIsaSd) & 0xFF;
    end(&BoardInputs::isa_ior_n);
    return value;
  }
  void memory_address(unsigned offset) {
    rig.in.set_address(kMemBase + offset);
    rig.in.isa_sbhe_n = false;
  }
  std::uint32_t memory_read(unsigned offset) {
    memory_address(offset);
    strobe(&BoardInputs::isa_memr_n, 28);
    const std::uint32_t value = rig.get(pin::kIsaSd);
    end(&BoardInputs::isa_memr_n);
    return value;
  }
  void memory_write(unsigned offset, std::uint16_t value) {
    memory_address(offset);
    rig.in.isa_sd = value;
    strobe(&BoardInputs::isa_memw_n, 28);
    end(&BoardInputs::isa_memw_n);
  }
  // On-chip page X:$FFFFxx. A read is left under way, so that a test can look before its end.
  void on_chip_write(unsigned address, std::uint32_t value) {
    rig.in.pa_addr = address & 0x7F;
    rig.in.pa_x = rig.in.pa_int = true;
    rig.in.pa_wdata = value;
    rig.in.pa_wr_n = false;
    rig.apply();
    rig.run(9);
    rig.in.pa_wr_n = true;
    rig.apply();
    rig.run(6);
    rig.in.pa_int = false;
    rig.apply();
    rig.run(6);
  }
  void begin_on_chip_read(unsigned address) {
    rig.in.pa_addr = address & 0x7F;
    rig.in.pa_x = rig.in.pa_int = true;
    rig.in.pa_rd_n = false;
    rig.apply();
  }

  BoardRig rig;
};

}  // namespace brick
