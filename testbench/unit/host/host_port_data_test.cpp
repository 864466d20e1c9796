// The two data paths of the host port: double buffers, byte order, initialisation.
#include "testbench/unit/host/host_port_bench.h"

namespace brick {
namespace {

TEST_F(HostPortTest, WordFromTheHostArrivesOneClockAfterItsLastByte) {
  host_write(kData5, 0x12);
  host_write(kData6, 0x34);
  EXPECT_EQ(isr(), unsigned{kTxde | kTrdy}) << "only +7 launches";
  host_write(kData7, 0x56);
  EXPECT_EQ(isr(), 0u) << "in TX";
  EXPECT_EQ(hsr() & kHrdf, 0u);
  both_.ref();
  EXPECT_EQ(isr(), unsigned{kTxde}) << "TXDE and HRDF in the same clock; TRDY waits for the CPU";
  EXPECT_EQ(hsr() & kHrdf, kHrdf);
  EXPECT_EQ(cpu_read(kHorx), 0x123456u);
  EXPECT_EQ(hsr() & kHrdf, 0u);
  EXPECT_EQ(isr(), unsigned{kTxde | kTrdy});
}

TEST_F(HostPortTest, TwoWordsWaitAndKeepTheirOrder) {
  host_send(0x111111);
  both_.ref();
  host_send(0x222222);
  both_.ref(5);
  EXPECT_EQ(isr() & kTxde, 0u) << "both stages full";
  EXPECT_EQ(cpu_read(kHorx), 0x111111u);
  both_.ref();
  EXPECT_EQ(isr() & kTxde, kTxde);
  EXPECT_EQ(cpu_read(kHorx), 0x222222u);
  EXPECT_EQ(hsr() & kHrdf, 0u);
}

TEST_F(HostPortTest, UpperBytesStayFromWordToWord) {
  for (const unsigned upper : {0x0000u, 0xA5C3u}) {  // 0 is the polling recipe: +5 and +6 once, then characters at +7
    host_write(kData5, upper >> 8);
    host_write(kData6, upper);
    for (const unsigned char c : {'#', '1', '?'}) {
      host_write(kData7, c);
      both_.ref();
      EXPECT_EQ(cpu_read(kHorx), upper << 8 | c);
    }
  }
}

TEST_F(HostPortTest, UpperBytesMayComeInEitherOrder) {
  for (const bool hlend : {false, true}) {
    host_write(kIcr, hlend ? kHlend : 0);
    host_write(kData6, 0x34);
    host_write(kData5, 0x12);
    host_write(kData7, 0x56);
    both_.ref();
    EXPECT_EQ(cpu_read(kHorx), hlend ? 0x563412u : 0x123456u);
  }
}

TEST_F(HostPortTest, WordFromTheCpuArrivesOneClockLater) {
  cpu_write(kHotx, 0xABCDEF);
  EXPECT_EQ(hsr() & kHtde, 0u);
  EXPECT_EQ(isr() & kRxdf, 0u);
  both_.ref();
  EXPECT_EQ(hsr() & kHtde, kHtde);
  EXPECT_EQ(isr() & kRxdf, kRxdf);
  EXPECT_EQ(host_read(kData5), 0xABu);
  EXPECT_EQ(host_read(kData6), 0xCDu);
  EXPECT_EQ(isr() & kRxdf, kRxdf) << "+5 and +6 free nothing";
  EXPECT_EQ(host_read(kData7), 0xEFu);
  EXPECT_EQ(isr() & kRxdf, 0u);
}

TEST_F(HostPortTest, SecondWordFromTheCpuWaitsInHotx) {
  cpu_write(kHotx, 1);
  both_.ref();
  cpu_write(kHotx, 2);
  both_.ref(5);
  EXPECT_EQ(hsr() & kHtde, 0u);
  EXPECT_EQ(host_read(kData7), 1u);
  both_.ref();
  EXPECT_EQ(hsr() & kHtde, kHtde);
  EXPECT_EQ(host_read(kData7), 2u);
}

TEST_F(HostPortTest, HlendReversesTheBytes) {
  host_write(kIcr, kHlend);
  host_write(kData5, 0x56);
  host_write(kData6, 0x34);
  host_write(kData7, 0x12);
  both_.ref();
  EXPECT_EQ(cpu_read(kHorx), 0x123456u);
  cpu_write(kHotx, 0xABCDEF);
  both_.ref();
  EXPECT_EQ(host_read(kData5), 0xEFu);
  EXPECT_EQ(host_read(kData6), 0xCDu);
  EXPECT_EQ(isr() & kRxdf, kRxdf) << "the low byte at +5 frees nothing";
  EXPECT_EQ(host_read(kData7), 0xABu);
  EXPECT_EQ(isr() & kRxdf, 0u) << "+7 is the last byte in either order";
}

TEST_F(HostPortTest, InitEmptiesThePathsThatTreqAndRreqChoose) {
  for (const unsigned enable : {0u, 1u, 2u, 3u}) {
    both_.reset();
    host_send(1);
    both_.ref();
    host_send(2);
    cpu_write(kHotx, 3);
    both_.ref();
    cpu_write(kHotx, 4);
    both_.ref(2);  // all four stages are full
    ASSERT_EQ(isr() & (kTxde | kRxdf), unsigned{kRxdf});
    ASSERT_EQ(hsr() & (kHrdf | kHtde), unsigned{kHrdf});
    host_write(kIcr, kInit | enable);
    EXPECT_EQ(host_peek(kIcr), enable) << "INIT is 0 again";
    EXPECT_EQ(isr() & kTxde, (enable & kTreq) ? kTxde : 0u);
    EXPECT_EQ(hsr() & kHrdf, (enable & kTreq) ? 0u : kHrdf);
    EXPECT_EQ(isr() & kRxdf, (enable & kRreq) ? 0u : kRxdf);
    EXPECT_EQ(hsr() & kHtde, (enable & kRreq) ? kHtde : 0u);
    both_.ref(2);
    EXPECT_EQ(hsr() & kHrdf, (enable & kTreq) ? 0u : kHrdf) << "nothing comes after it";
    EXPECT_EQ(isr() & kRxdf, (enable & kRreq) ? 0u : kRxdf);
  }
}

TEST_F(HostPortTest, InitWinsOverWhatHappensInTheSameClock) {
  cpu_write(kHotx, 0x77);  // moves to RX at the next edge, the one of INIT
  both_.in.dsp_sel = both_.in.dsp_we = true;
  both_.in.dsp_wdata = 0x78;
  host_write(kIcr, kInit | kRreq | kTreq);
  both_.in.dsp_sel = both_.in.dsp_we = false;
  EXPECT_EQ(isr() & (kTxde | kRxdf), unsigned{kTxde});
  EXPECT_EQ(hsr() & (kHrdf | kHtde), unsigned{kHtde});
  host_send(0x79);  // moves to HORX at the next edge
  host_write(kIcr, kInit | kTreq);
  EXPECT_EQ(isr() & kTxde, kTxde);
  EXPECT_EQ(hsr() & kHrdf, 0u);
}

TEST_F(HostPortTest, ReadingAnEmptyRegisterDoesNotEatTheWordThatArrives) {
  host_send(0x41);  // moves to HORX at the edge at which the CPU's idle read ends
  cpu_read(kHorx);
  EXPECT_EQ(hsr() & kHrdf, kHrdf);
  EXPECT_EQ(cpu_read(kHorx), 0x41u);
  cpu_write(kHotx, 0x42);
  host_read(kData7);
  EXPECT_EQ(isr() & kRxdf, kRxdf);
  EXPECT_EQ(host_read(kData7), 0x42u);
}

// host-bus:3.8/3: its end, should it still come, takes no word that arrives after the reset.
TEST_F(HostPortTest, AReadUnderWayAtTheResetIsVoid) {
  cpu_write(kHotx, 0x123456);
  both_.ref();
  both_.in.hp_sel = both_.in.hp_rd = true;
  both_.in.hp_addr = kData7;
  both_.ref();
  both_.in.hp_sel = both_.in.hp_rd = false;
  both_.reset();
  cpu_write(kHotx, 0xABCDEF);
  both_.ref();
  ASSERT_EQ(isr() & kRxdf, kRxdf);
  both_.in.hp_sel = both_.in.hp_rd_done = true;
  both_.in.hp_addr = kData7;
  both_.ref();
  both_.in.hp_sel = both_.in.hp_rd_done = false;
  EXPECT_EQ(isr() & kRxdf, kRxdf);
  EXPECT_EQ(host_read(kData7), 0xEFu);
  EXPECT_EQ(isr() & kRxdf, 0u);
}

TEST_F(HostPortTest, WritingAFullRegisterOverwritesIt) {
  host_send(1);
  both_.ref();
  host_send(2);
  host_send(3);
  cpu_read(kHorx);
  both_.ref();
  EXPECT_EQ(cpu_read(kHorx), 3u) << "the host did not look at TXDE";
  both_.ref(3);
  EXPECT_EQ(hsr() & kHrdf, 0u);
  cpu_write(kHotx, 4);
  both_.ref();
  cpu_write(kHotx, 5);
  cpu_write(kHotx, 6);
  host_read(kData7);
  both_.ref();
  EXPECT_EQ(host_read(kData7), 6u) << "the CPU did not look at HTDE";
  both_.ref(3);
  EXPECT_EQ(isr() & kRxdf, 0u);
}

}  // namespace
}  // namespace brick
