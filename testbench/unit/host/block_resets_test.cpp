// What the blocks of the host's side show in a reset, whatever was under way, and behind it until something happens.
#include "testbench/unit/host/dpram_bench.h"
#include "testbench/unit/host/host_port_bench.h"
#include "testbench/unit/host/isa_slave_fixture.h"

namespace brick {
namespace {

// docs/isa_slave.md
TEST_F(IsaSlaveTest, AResetSelectsNothingAndClearsWhatTheBlocksSee) {
  both.in.isa_sbhe_n = true;
  both.in.mem_rdata = 0x5678;
  mem_read(0xDFFFF);
  io_write(0x217, 0xA5);
  both.in.isa_sd = 0x1234;
  bool Inputs::*const commands[] = {&Inputs::isa_ior_n, &Inputs::isa_iow_n, &Inputs::isa_memr_n, &Inputs::isa_memw_n};
  for (const auto command : commands)
    for (const unsigned address : {0x217u, 0x21Bu, 0xDFFFFu}) {
      SCOPED_TRACE(::testing::Message() << std::hex << address);
      set_address(address);
      ticks(12);
      both.in.*command = false;
      ticks(30);
      both.in.isa_resetdrv = true;
      ticks(address == 0x217 ? 0 : 12);
      both.in.isa_resetdrv = false;
      both.reset();
      const Outputs shown = IsaBench::show(model);
      for (const auto& [name, value] : shown) {
        const bool high = name == "isa_iochrdy" || name == "isa_memcs16_n";
        EXPECT_EQ(both.get(name), name == "isa_sd" ? 0xFFFFu : high ? 1u : 0u) << name;
      }
      ticks(12);
      both.in.*command = true;
      ticks(12);
      const bool write = command == &Inputs::isa_iow_n || command == &Inputs::isa_memw_n;
      EXPECT_EQ(both.get("mem_wdata"), write ? 0x1234u : 0u) << "what stood with a write command, of no byte of a host";
      EXPECT_EQ(both.get("hp_sel") | both.get("pic_sel") | both.get("mem_sel"), 0u);
    }
}

class DpramResetTest : public ::testing::Test, protected DpramBench {
 protected:
  void TearDown() override { EXPECT_LOCKSTEP(both); }
};

// docs/dpram.md
TEST_F(DpramResetTest, ReadWordsAreZeroAndNobodyOwnsAWord) {
  for (const bool cpu_reads : {false, true}) {
    host_write(6, 0x1234);
    EXPECT_EQ(cpu_read(6), 0x1234u);
    EXPECT_EQ(host_read(6), 0x1234u);
    host_start(6, cpu_reads);  // and is under way with the CPU's
    both.ref(2);
    cpu_reads ? cpu_start_write(6, 1) : cpu_start_read(6);
    both.ticks(6);
    EXPECT_TRUE(cpu_busy());
    cpu_end();
    both.in.mem_sel = false;
    both.in.rd_falls = both.in.wr_falls = 0;  // the counts are reset with it
    both.reset();
    for (const char* output : {"cpu_rdata", "cpu_wait", "cpu_busy", "mem_rdata", "host_busy", "cpu_drive"})
      EXPECT_EQ(both.get(output), 0u) << output;
    EXPECT_EQ(cpu_read(6), 0x1234u) << "at once";
  }
}

TEST_F(HostPortTest, AResetLeavesNoWordOnItsWay) {
  cpu_write(kHotx, 0x123456);
  both_.ref(2);
  host_send(0x654321);
  both_.ref(2);
  host_write(kData5, 0x77);
  host_write(kData6, 0x88);
  ASSERT_EQ(cpu_peek(kHorx), 0x654321u);
  ASSERT_EQ(host_peek(kData6), 0x34u);
  both_.reset();
  EXPECT_EQ(cpu_peek(kHorx), 0u);
  for (const std::uint8_t byte : {kData5, kData6, kData7}) EXPECT_EQ(host_peek(byte), 0u) << unsigned{byte};
  host_write(kData7, 0x99);
  both_.ref(2);
  EXPECT_EQ(cpu_read(kHorx), 0x000099u) << "nor a byte of before";
}

}  // namespace
}  // namespace brick
