// The control panel of a Turbo PMAC on the whole machine: whose BREQ the host sees (I2, FPDn/, I59), on pin and
// interrupt line, and on boards without a panel; the size of the dual-ported RAM as host and program see it.
#include "systemc/machine/board_file.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

constexpr Tick kServo = 4 * (2 * 6527 + 3);  // default servo period in ticks
constexpr Tick kRealTime = 3 * kServo;       // I8 = 2
constexpr Tick kLook = kRealTime + kServo;   // within a real-time interrupt the firmware looks at the port
constexpr unsigned kStart = 3, kStop = 5;    // bits of the port
constexpr std::uint8_t kBreqLine = 2;        // bit of IR1

class PanelBoard : public Controller {
 protected:
  void start_board(const std::string& name) {
    MachineConfig config;
    config.board = read_board_file("boards/" + name + ".toml");
    start(config);
  }
  // Inputs FPDn/ for the number n and the others high; one more input low if wanted.
  void panel(unsigned n, int low = -1) {
    machine().inputs().jpan = static_cast<std::uint16_t>((0xF0FF | (~n & 0xF) << 8) & ~(low < 0 ? 0u : 1u << low));
    machine().apply();
    wait(kLook);
  }
  bool breq() { return machine().outputs().get(pin::kBreq) != 0; }
  bool running(int cs) { return (std::stoul(ask("&" + std::to_string(cs) + "??").substr(0, 6), nullptr, 16) & 1) != 0; }

  // C.S. 9, 2 and 1 have open rotary buffers: 2 with room, 1 and 9 full.
  void prepare() {
    ask("I16=1 I17=2 I68=15");
    for (const char* cs : {"&9", "&2", "&1"}) {
      ASSERT_EQ(ask(cs + std::string("DEFINE ROTARY 40")), "");
      ASSERT_EQ(ask("B0"), "");
      ASSERT_EQ(ask("OPEN ROTARY"), "");
      const int lines = cs[1] == '2' ? 1 : 3;
      for (int line = 0; line < lines; ++line) ASSERT_EQ(ask("DWELL1"), "");
      ASSERT_EQ(ask("CLOSE"), "");
    }
  }
};

TEST_P(PanelBoard, BreqFollowsThePanelOrTheHostByI2) {
  BRICK_COVERS("BREQ-6");
  start_board("turbo-pmac-pci");
  EXPECT_EQ(ask("I2"), "1");
  prepare();
  panel(2);
  ask("&1");
  EXPECT_FALSE(breq()) << "I2=1: C.S. 1 is addressed and full";
  ask("&2");
  EXPECT_TRUE(breq()) << "I2=1: C.S. 2 is addressed";
  panel(1);
  EXPECT_TRUE(breq()) << "I2=1: the panel does not matter";

  ask("I2=0");
  EXPECT_FALSE(breq()) << "I2=0: the panel selects C.S. 1";
  panel(2);
  EXPECT_TRUE(breq());
  ask("&1");
  EXPECT_TRUE(breq()) << "I2=0: the host's address does not matter";
  for (const unsigned n : {0u, 3u, 9u, 15u}) {
    panel(n);
    EXPECT_FALSE(breq()) << n;
  }
  panel(2);
  EXPECT_TRUE(breq());
  ask("I59=1");
  panel(1);
  EXPECT_FALSE(breq()) << "C.S. 9 is full";
  for (const char* line : {"&9OPEN ROTARY", "CLEAR", "CLOSE &1"}) EXPECT_EQ(ask(line), "");
  EXPECT_TRUE(breq()) << "C.S. 9 has room now";
  EXPECT_EQ((bus().read_pic_signals() & kBreqLine) != 0, true);
  ask("I59=0");
  wait(kLook);
  EXPECT_FALSE(breq()) << "C.S. 1";
}

TEST_P(PanelBoard, ChangingThePanelRaisesTheInterruptAndStartRunsTheProgram) {
  BRICK_COVERS("BREQ-6");
  start_board("turbo-pmac-pci");
  prepare();
  ask("I2=0");
  panel(1);
  ASSERT_FALSE(breq());
  bus().write_pic_mask(kBreqLine);
  bus().clear_pic();
  panel(2);
  EXPECT_EQ(bus().read_pic_status() & kBreqLine, kBreqLine);
  EXPECT_EQ(machine().outputs().get(pin::kIsaIrq), 1u);
  bus().write_pic_mask(0);

  panel(1);
  EXPECT_FALSE(breq());
  const BoardOutputs edge = select_pins(pin::kBreq);
  machine().inputs().jpan &= static_cast<std::uint16_t>(~(1u << kStart));
  machine().apply();
  machine().run_until(machine().now() + ms_to_ticks(30), edge);
  EXPECT_TRUE(breq()) << "three lines of DWELL1 run down below I16 = 1";
  EXPECT_TRUE(running(1));
  panel(1, kStop);
  EXPECT_FALSE(running(1));
  EXPECT_EQ(ask("RHY$78800"), "FEDF") << "STOP/ and FPD0/ are low";
}

TEST_P(PanelBoard, BoardsWithoutAPanelShowTheAddressedSystemWhateverI2Is) {
  BRICK_COVERS("BREQ-7");
  start_board("geobrick-lv-8");
  prepare();
  panel(2);
  for (const char* i2 : {"I2=0", "I2=1"}) {
    ask(i2);
    ask("&1");
    EXPECT_FALSE(breq()) << i2;
    ask("&2");
    EXPECT_TRUE(breq()) << i2;
  }
  EXPECT_EQ(ask("RHY$78800"), "0");
}

TEST_P(PanelBoard, TheDualPortedRamEndsWhereTheBoardSays) {
  start_board("turbo-pmac-pci");
  ask("WY$60FFF,$1234 WX$60FFF,$5678");
  EXPECT_EQ(bus().dpram_read(0x3FFC), 0x1234);
  EXPECT_EQ(bus().dpram_read(0x3FFE), 0x5678);
  bus().dpram_write(0x4000, 0xAAAA);
  EXPECT_EQ(bus().dpram_read(0x4000), 0xFFFF) << "beyond BAR1 nobody answers";
  EXPECT_EQ(ask("RHY$61000"), "0");
  start_board("geobrick-lv-8");
  bus().dpram_write(0x4000, 0xAAAA);
  bus().dpram_write(0xFFFE, 0xBBBB);
  EXPECT_EQ(ask("RHY$61000 RHX$63FFF"), "AAAA|BBBB");
}

BRICK_ON_ENGINES(PanelBoard, at_night(Engine::kRtl), Engine::kSystemC, at_night(Engine::kLockstep));

}  // namespace
}  // namespace brick
