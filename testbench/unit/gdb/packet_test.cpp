// Registers, memory, queries, and what comes back for packets that are damaged, wrong or unknown.
#include "testbench/unit/gdb/gdb_bench.h"

namespace brick {

using GdbPackets = GdbBench;

TEST_F(GdbPackets, StartsStoppedAtReset) {
  EXPECT_EQ(ask("?"), "T05thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode)) << "pc is register 32";
  EXPECT_EQ(cpu.instructions(), 0u);
}

TEST_F(GdbPackets, ReadsAndWritesRegisters) {
  EXPECT_EQ(ask("Pa=78563412"), "OK");
  EXPECT_EQ(ask("pa"), "78563412");
  const std::string all = ask("g");
  ASSERT_EQ(all.size(), 33u * 8);
  EXPECT_EQ(all.substr(10 * 8, 8), "78563412");
  EXPECT_EQ(all.substr(32 * 8, 8), shown(kCode));
  std::string changed = all;
  changed.replace(5 * 8, 8, shown(0xCAFE));
  changed.replace(32 * 8, 8, shown(kCode + 4));
  EXPECT_EQ(ask("G" + changed), "OK");
  EXPECT_EQ(ask("p5"), shown(0xCAFE));
  EXPECT_EQ(ask("p20"), shown(kCode + 4));
  EXPECT_EQ(ask("P0=01000000"), "OK");
  EXPECT_EQ(ask("p0"), shown(0)) << "x0 stays zero";
  EXPECT_EQ(ask("p341"), shown(0x1800)) << "mstatus (65 + 0x300): previous mode is machine mode, interrupts off";
}

TEST_F(GdbPackets, ReadsAndWritesMemory) {
  EXPECT_EQ(ask("M20000010,4:0102fe7d"), "OK");
  EXPECT_EQ(ask("m20000010,4"), "0102fe7d");
  EXPECT_EQ(ask(std::string("X20000011,2:}\x03") + "A"), "OK") << "}\\x03 stands for #";
  EXPECT_EQ(ask("m20000010,4"), "0123417d");
  EXPECT_EQ(ask("m20000ffe,8").size(), 4u) << "two bytes are left before the end of the memory";
}

TEST_F(GdbPackets, PmacWordsKeep24Bits) {
  EXPECT_EQ(ask("Mc0000010,4:11223344"), "OK");
  EXPECT_EQ(ask("mc0000010,4"), "11223300");
}

TEST_F(GdbPackets, RefusesDevicesAndUnmappedMemory) {
  EXPECT_EQ(ask("mc03c0000,4"), "E01");
  EXPECT_EQ(ask("Mc03c0000,1:00"), "E01");
  EXPECT_EQ(ask("m40000000,1"), "E01");
  EXPECT_EQ(ask("M20000fff,2:0000"), "E01") << "half of it is outside";
}

TEST_F(GdbPackets, AsksAgainForADamagedPacket) {
  write("$?#00");
  EXPECT_EQ(get(), '-');
  write("$?#zz");
  EXPECT_EQ(get(), '-');
  write("$?#3f");
  EXPECT_EQ(get(), '+');
  EXPECT_EQ(reply(), "T05thread:1;");
  write("-");
  EXPECT_EQ(reply(), "T05thread:1;") << "sent again on request";
}

TEST_F(GdbPackets, SurvivesGarbage) {
  for (const char* wrong : {"m",
                            "m20000000",
                            "m20000000,",
                            "mxyz,4",
                            "m20000000,4,",
                            "M20000000,4:00",
                            "M20000000,1:0x",
                            "M20000000,2",
                            "P",
                            "P5",
                            "P5=12",
                            "P99=00000000",
                            "p",
                            "p9999",
                            "G00",
                            "Z0",
                            "Z0,zz,4",
                            "Z2,20000000,0",
                            "z1,10000000",
                            "czz",
                            "vCont;",
                            "vCont;q",
                            "qRcmd,0",
                            "qXfer:features:read:target.xml:0",
                            "m111111111,4"})
    EXPECT_EQ(ask(wrong), "E01") << wrong;
  for (const char* unknown : {"", "vMustReplyEmpty", "Z9,0,0", "qOffsets", "A", "!", "R00", "Z0,10000000,4;X1,22"})
    EXPECT_EQ(ask(unknown), "") << unknown;
  write("noise\x03\xFF$half$?#3f");
  EXPECT_EQ(reply(), "T05thread:1;") << "a new $ begins a new packet";
  EXPECT_EQ(ask("m20000000,4" + std::string(0x5000, '0')), "E01") << "longer than PacketSize";
  EXPECT_EQ(ask("?"), "T05thread:1;");
  EXPECT_EQ(cpu.instructions(), 0u);
}

TEST_F(GdbPackets, DescribesTheTarget) {
  EXPECT_NE(ask("qSupported:swbreak+").find("PacketSize=4000;qXfer:features:read+"), std::string::npos);
  const std::string xml = ask("qXfer:features:read:target.xml:0,2000");
  EXPECT_EQ(xml.substr(0, 6), "l<?xml");
  EXPECT_NE(xml.find("<architecture>riscv:rv32</architecture>"), std::string::npos);
  EXPECT_EQ(ask("qXfer:features:read:target.xml:6,5"), "mversi");
  EXPECT_EQ(ask("qXfer:features:read:other.xml:0,10"), "E00");
  EXPECT_EQ(ask("qAttached"), "1");
}

TEST_F(GdbPackets, WorksWithoutAcknowledgement) {
  EXPECT_EQ(ask("QStartNoAckMode"), "OK");
  write("$?#3f");
  EXPECT_EQ(get(), '$');
}

TEST_F(GdbPackets, MonitorTellsTheTime) {
  EXPECT_EQ(ask("qRcmd,74696d65"), "30206379636c65730a") << "`time` gives `0 cycles` when nothing else is told";
}

TEST(GdbPort, InUseIsRefused) {
  Cpu cpu;
  const GdbServer first(cpu, 0);
  EXPECT_THROW(GdbServer(cpu, first.port()), std::runtime_error);
}

}  // namespace brick
