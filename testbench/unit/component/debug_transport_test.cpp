// Debug transport shows what a read would show, and whoever has used it has changed nothing.
#include <gtest/gtest.h>

#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/engines.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr std::uint64_t kStatus = 4, kCaptured = 28, kControl = 44;  // X of offset 0, 3, 5
constexpr std::uint32_t kCapt = 1u << 11;                            // servo-ic:2.2

struct DebugBench {
  DebugBench(bool rtl, std::function<void(Initiator&)> program)
      : ic("ic", time, model_or_rtl(rtl)), initiator("initiator", std::move(program)) {
    initiator.socket.bind(ic.registers);
    ic.ch[0].hmfl(hmfl);
    ic.ch[0].aena(aena);
  }
  TimeBase time{"time"};
  ServoIc ic;
  sc_core::sc_signal<bool> hmfl{"hmfl"}, aena{"aena"};
  Initiator initiator;
};

void simulate_ic(bool rtl, const std::function<void(Initiator&, DebugBench&)>& program) {
  DebugBench* self = nullptr;
  DebugBench bench(rtl, [&](Initiator& i) { program(i, *self); });
  self = &bench;
  sc_core::sc_start(200, sc_core::SC_US);
  EXPECT_TRUE(bench.initiator.ended);
}

TEST(DebugTransport, ReadsAndWritesNothing) {
  BRICK_COVERS("CARD-1");
  for (const bool rtl : {false, true})
    in_own_process([rtl] {
      simulate_ic(rtl, [](Initiator& i, DebugBench&) {
        EXPECT_EQ(i.debug_read(kClockControl), 0x3038D2u);
        i.data = 0;
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(tlm::TLM_WRITE_COMMAND, kClockControl)), 0u);
        EXPECT_EQ(i.debug_read(kClockControl), 0x3038D2u) << "not written";
        EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        tlm::tlm_dmi dmi;
        EXPECT_FALSE(i.socket->get_direct_mem_ptr(*i.payload(tlm::TLM_READ_COMMAND, kClockControl), dmi)) << "may act";
      });
    });
}

// CAPT when the captured position has been read in this way.
using Read = std::function<void(Initiator&)>;
std::uint32_t capt_after(bool rtl, const Read& read) {
  std::uint32_t capt = 0;
  simulate_ic(rtl, [&](Initiator& i, DebugBench& bench) {
    i.write(kControl, 2 << 4);  // captures at HMFL
    sc_core::wait(1, sc_core::SC_US);
    bench.hmfl = true;
    sc_core::wait(12, sc_core::SC_US);
    EXPECT_EQ(i.debug_read(kStatus) & kCapt, kCapt);
    read(i);
    sc_core::wait(1, sc_core::SC_US);
    EXPECT_EQ(i.debug_read(kStatus) & kCapt, i.read(kStatus) & kCapt);
    capt = i.data & kCapt;
  });
  return capt;
}

// A bus read of the captured position clears CAPT and arms (servo-ic:5.9/7).
TEST(DebugTransport, LeavesACaptureAlone) {
  BRICK_COVERS("CARD-1");
  const Read nothing = [](Initiator&) {}, debug = [](Initiator&i) { i.debug_read(kCaptured); },
             bus = [](Initiator&i) { i.read(kCaptured); };
  for (const bool rtl : {false, true}) {
    in_own_process([&] { EXPECT_EQ(capt_after(rtl, nothing), kCapt); });
    in_own_process([&] { EXPECT_EQ(capt_after(rtl, debug), kCapt) << "rtl " << rtl; });
    in_own_process([&] { EXPECT_EQ(capt_after(rtl, bus), 0u) << "rtl " << rtl; });
  }
}

TEST(DebugTransport, LooksAtCommandAddressAndLengthAlone) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    simulate_ic(false, [](Initiator& i, DebugBench&) {
      tlm::tlm_generic_payload plain;  // of its streaming width nothing was said
      plain.set_read();
      plain.set_address(kClockControl);
      plain.set_data_ptr(reinterpret_cast<unsigned char*>(&i.data));
      plain.set_data_length(4);
      EXPECT_EQ(i.socket->transport_dbg(plain), 4u);
      EXPECT_EQ(i.data, 0x3038D2u);
      EXPECT_EQ(plain.get_response_status(), tlm::TLM_INCOMPLETE_RESPONSE) << "left as it is";
      EXPECT_EQ(i.socket->transport_dbg(*i.payload(tlm::TLM_READ_COMMAND, 256)), 0u) << "beyond the last word";
      EXPECT_EQ(i.socket->transport_dbg(*i.payload(tlm::TLM_READ_COMMAND, 2)), 0u) << "in the middle of one";
      EXPECT_EQ(i.socket->transport_dbg(*i.payload(tlm::TLM_READ_COMMAND, 4, 2)), 0u) << "half a register";
    });
  });
}

// What sc_main() reads between two calls of sc_start(), where the RTL may have run ahead to the next microsecond.
std::string debug_read_at(bool rtl, double ns) {
  DebugBench bench(rtl, [](Initiator&) {});
  sc_core::sc_start(ns, sc_core::SC_NS);
  try {
    EXPECT_EQ(bench.initiator.debug_read(kClockControl), 0x3038D2u);
  } catch (const sc_core::sc_report& report) { return report.get_msg_type(); }
  return "";
}

TEST(DebugTransport, DoesNotReadTheFuture) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { EXPECT_EQ(debug_read_at(true, 2000), ""); });
  in_own_process([] { EXPECT_EQ(debug_read_at(true, 2300), "/brick/ahead"); });
  in_own_process([] { EXPECT_EQ(debug_read_at(false, 2300), ""); });
}

}  // namespace
}  // namespace brick::component
