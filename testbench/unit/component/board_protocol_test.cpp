// What the sockets of the board's component answer: errors, bytes and words, times, debug transport, two masters.
#include <gtest/gtest.h>

#include <brick/board.h>
#include <brick/rtl.h>

#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/traffic.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr std::uint64_t kBcr = 8 * 0xFFFFFBu + 4, kPctl = 8 * 0xFFFFFDu + 4;
constexpr std::uint64_t kRam = 8 * 0x60000u, kWindow = 0xD0000, kHostIo = 0x210;
constexpr std::uint64_t kBoardClockControl = 8 * 0x78004u + 4;

std::uint64_t now() { return sc_core::sc_time_stamp().value(); }

enum class Bus { kPortA, kIo, kMemory };
struct BoardBench {
  BoardBench(const Engine& engine, Bus bus, std::function<void(Initiator&)> program)
      : board("board", time, {}, engine), initiator("initiator", std::move(program)) {
    bind(initiator, bus);
  }
  void bind(Initiator& i, Bus bus) {
    if (bus == Bus::kPortA)
      i.socket.bind(board.port_a);
    else
      i.socket.bind(bus == Bus::kIo ? board.isa_io : board.isa_memory);
  }
  TimeBase time{"time"};
  Board board;
  Initiator initiator;
};
void simulate_board(const Engine& engine, Bus bus, const std::function<void(Initiator&)>& program) {
  in_own_process([&] {
    BoardBench bench(engine, bus, program);
    sc_core::sc_start(100, sc_core::SC_US);
    EXPECT_TRUE(bench.initiator.ended);
  });
}

TEST(BoardSocketProtocol, PortAKnowsWholeWordsOfItsDevices) {
  BRICK_COVERS("CARD-1");
  simulate_board(model_engine(), Bus::kPortA, [](Initiator& i) {
    EXPECT_EQ(i.send(i.payload(kRead, 0)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "main memory is not on this bus";
    EXPECT_EQ(i.send(i.payload(kRead, 8 * 0x64000u)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "behind the RAM";
    EXPECT_EQ(i.send(i.payload(kRead, 8 * 0xFFFFFBu)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "Y: no peripheral";
    EXPECT_EQ(i.send(i.payload(kRead, std::uint64_t{8} << 24)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
    EXPECT_EQ(i.send(i.payload(kRead, kRam + 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "in the middle of a word";
    EXPECT_EQ(i.send(i.payload(kRead, kRam, 2)), tlm::TLM_BURST_ERROR_RESPONSE);
    EXPECT_EQ(i.send(i.payload(kRead, kRam, 8)), tlm::TLM_BURST_ERROR_RESPONSE);
    EXPECT_EQ(i.send(i.payload(tlm::TLM_IGNORE_COMMAND, kRam)), tlm::TLM_COMMAND_ERROR_RESPONSE);
    EXPECT_EQ(now(), 0u) << "an error takes no time";
  });
}

// The CPU clock after a reset is 117.9648 MHz x 8 / 12: cycle c begins at c x 78125000 / 6144 ps.
TEST(BoardSocketProtocol, WaitStatesAndClockShapeTheCycles) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine()})
    simulate_board(engine, Bus::kPortA, [](Initiator& i) {
      EXPECT_EQ(i.read(kBcr) & 0x3FF, 0x3FFu) << "after a reset the wait states are the most";
      i.write(kBcr, 9 << 5);  // AA1; with more than seven a cycle has three clocks more (host-bus:2.2)
      sc_core::wait(sc_core::sc_time(2'000'001, sc_core::SC_PS) - sc_core::sc_time_stamp());
      i.write(kBoardClockControl, 0x3008D2);
      EXPECT_EQ(now(), 2'161'662u) << "158 is the first; 158 + 12 at 2161661.8";
      EXPECT_EQ(i.read(kBoardClockControl), 0x3008D2u);
      EXPECT_EQ(now(), 2'326'966u) << "the first clock after the call is 171; 171 + 12 at 2326965.3";
      i.write(kPctl, 11);  // x 12 / 12: a cycle is a tick, from the first edge after the write's own cycle on
      i.read(kBoardClockControl);
      const std::uint64_t end = now();
      i.read(kBoardClockControl);
      EXPECT_NEAR(static_cast<double>(now() - end), 13 * 78'125'000.0 / 9216, 1) << "thirteen ticks";
    });
}

TEST(BoardSocketProtocol, TheDelayIsWaitedForFirst) {
  BRICK_COVERS("CARD-1");
  simulate_board(rtl_engine(), Bus::kIo, [](Initiator& i) {
    sc_core::sc_time delay(1, sc_core::SC_US);
    EXPECT_EQ(i.send(i.payload(kRead, kHostIo, 1), delay), tlm::TLM_OK_RESPONSE);
    EXPECT_EQ(delay, sc_core::SC_ZERO_TIME);
    EXPECT_EQ(now(), 1'080'000u + 700'000 + 1) << "BCLK 9 is the first after 1 us; it acts in the picosecond after it";
    EXPECT_EQ(i.send(i.payload(kRead, kHostIo, 1)), tlm::TLM_OK_RESPONSE);
    EXPECT_EQ(now(), 1'080'000u + 840'000 + 700'000 + 1) << "a BCLK of recovery";
  });
}

TEST(BoardSocketProtocol, IsaSplitsAnAccessIntoCycles) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine()})
    simulate_board(engine, Bus::kMemory, [](Initiator& i) {
      unsigned char data[7] = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77};
      const auto access = [&](tlm::tlm_command command, std::uint64_t address, unsigned length) {
        auto p = i.payload(command, address, length);
        p->set_data_ptr(data);
        EXPECT_EQ(i.send(p), tlm::TLM_OK_RESPONSE);
        return now();
      };
      std::uint64_t start = access(kWrite, kWindow + 1, 7);  // a byte, three words
      EXPECT_EQ(start, 120'000u + 3 * 480'000 + 400'000 + 1) << "from BCLK 1 on, the first after power-on";
      i.data = 0;
      auto two = i.payload(kWrite, kWindow + 2, 4);  // the first and the last of four bytes
      unsigned char enables[] = {TLM_BYTE_ENABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED, TLM_BYTE_ENABLED};
      two->set_byte_enable_ptr(enables);
      two->set_byte_enable_length(4);
      EXPECT_EQ(i.send(two), tlm::TLM_OK_RESPONSE);
      access(kRead, kWindow + 1, 7);
      const unsigned char expected[] = {0x11, 0x00, 0x33, 0x44, 0x00, 0x66, 0x77};
      EXPECT_TRUE(std::equal(std::begin(data), std::end(data), expected));
      auto same = i.payload(kRead, kWindow + 2, 4);  // a streaming width of two: the same word again
      same->set_streaming_width(2);
      EXPECT_EQ(i.send(same), tlm::TLM_OK_RESPONSE);
      EXPECT_EQ(i.data, 0x33003300u);
      start = now();
      EXPECT_EQ(i.send(i.payload(kRead, 0x80000, 2)), tlm::TLM_OK_RESPONSE);
      EXPECT_EQ(i.data & 0xFFFF, 0xFFFFu) << "nobody answers: pulled up";
      EXPECT_GE(now() - start, 3 * 660'000u) << "and MEMCS16# neither: a cycle that was to be wide, and two of a byte";
      EXPECT_EQ(i.send(i.payload(kRead, 0xFFFFFF, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
      EXPECT_EQ(i.send(i.payload(kRead, kWindow, 0)), tlm::TLM_BURST_ERROR_RESPONSE);
      two->set_byte_enable_length(0);
      EXPECT_EQ(i.send(two), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    });
}

TEST(BoardSocketProtocol, CyclesOfBothIsaSocketsQueue) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    std::vector<std::uint64_t> ends;
    const auto read = [&ends](Initiator& i, std::uint64_t address) {
      EXPECT_EQ(i.send(i.payload(kRead, address, 1)), tlm::TLM_OK_RESPONSE);
      ends.push_back(now());
    };
    BoardBench bench(rtl_engine(), Bus::kIo, [&](Initiator& i) { read(i, kHostIo); });
    Initiator other("other", [&](Initiator& i) { read(i, kWindow); });
    bench.bind(other, Bus::kMemory);
    sc_core::sc_start(10, sc_core::SC_US);
    EXPECT_EQ(ends, (std::vector<std::uint64_t>{120'000 + 700'001, 120'000 + 840'000 + 400'001}));
  });
}

TEST(BoardSocketProtocol, DebugTransportReadsWhatHasNoSideEffect) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine(), lockstep_engine()})
    in_own_process([&] {
      BoardBench bench(engine, Bus::kPortA, [](Initiator& i) {
        sc_core::wait(100, sc_core::SC_NS);  // from power-on until the board works
        i.write(kRam + 4, 0xABCD);
        EXPECT_EQ(i.debug_read(kRam + 4), 0xABCDu);
        const std::uint64_t before = now();
        EXPECT_EQ(i.debug_read(kPctl), 7u) << "after a reset";
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, kBoardClockControl)), 0u) << "a register of a device";
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, kRam, 2)), 0u);
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kWrite, kRam)), 0u) << "writes nothing";
        EXPECT_EQ(now(), before);
      });
      Initiator host("host", [](Initiator& i) {
        sc_core::wait(50, sc_core::SC_US);
        i.data = 0;
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, kWindow + 1, 4)), 4u);
        EXPECT_EQ(i.data, 0xABCD00u) << "X:$060000 is at byte 2";
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, kWindow + 0xFFFF, 4)), 1u) << "the window's last";
        EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 0xC0000, 4)), 0u);
      });
      bench.bind(host, Bus::kMemory);
      sc_core::sc_start(100, sc_core::SC_US);
      EXPECT_TRUE(host.ended);
    });
}

TEST(BoardSocketProtocol, AResetBreaksACycleOff) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine()})
    in_own_process([&] {
      sc_core::sc_signal<bool> rst_n{"rst_n", true};
      BoardBench bench(engine, Bus::kPortA, [&rst_n](Initiator& i) {
        sc_core::sc_spawn([&rst_n] {
          sc_core::wait(100, sc_core::SC_NS);
          rst_n = false;
          sc_core::wait(1, sc_core::SC_US);
          rst_n = true;
        });
        EXPECT_EQ(i.send(i.payload(kRead, kBoardClockControl)), tlm::TLM_GENERIC_ERROR_RESPONSE);
        EXPECT_EQ(now(), 100'000u) << "at once";
        EXPECT_EQ(i.send(i.payload(kRead, kBoardClockControl)), tlm::TLM_GENERIC_ERROR_RESPONSE) << "still low";
        sc_core::wait(2, sc_core::SC_US);
        EXPECT_EQ(i.read(kBoardClockControl), 0x3038D2u) << "as a reset leaves it";
      });
      bench.board.rst_n(rst_n);
      sc_core::sc_start(10, sc_core::SC_US);
      EXPECT_TRUE(bench.initiator.ended);
    });
}

TEST(BoardSocketProtocol, AKilledProcessLeavesItsCycleToTheBus) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine()})
    in_own_process([&] {
      std::uint64_t end = 0;
      BoardBench bench(engine, Bus::kIo, [&end](Initiator& i) {
        auto killed = sc_core::sc_spawn([&i] { i.send(i.payload(kWrite, kHostIo + 10, 1)); });
        sc_core::wait(300, sc_core::SC_NS);  // the command is low
        i.data = 0x5A;
        killed.kill();
        EXPECT_EQ(i.send(i.payload(kRead, kHostIo + 10, 1)), tlm::TLM_OK_RESPONSE);
        end = now();
      });
      bench.initiator.data = 0x33;
      sc_core::sc_start(10, sc_core::SC_US);
      EXPECT_EQ(bench.initiator.data & 0xFF, 0x33u) << "the mask was written";
      EXPECT_EQ(end, 120'000u + 840'000 + 700'000 + 1);
    });
}

TEST(BoardSocketProtocol, ABusHasOneMaster) {
  BRICK_COVERS("CARD-1");
  const auto elaborate = [](Bus bus, const std::function<void(Board&, sc_core::sc_signal<bool>&)>& bind) {
    in_own_process([&] {
      std::string type;
      sc_core::sc_signal<bool> line{"line", true};
      BoardBench bench(model_engine(), bus, [](Initiator&) {});
      bind(bench.board, line);
      try {
        sc_core::sc_start(1, sc_core::SC_NS);
      } catch (const sc_core::sc_report& report) {
        type = report.get_msg_type();
        EXPECT_NE(std::string(report.get_msg()).find("expected: the one or the other"), std::string::npos);
      }
      EXPECT_EQ(type, "/brick/two_masters");
    });
  };
  elaborate(Bus::kPortA, [](Board& board, sc_core::sc_signal<bool>& line) { board.pa_rd_n(line); });
  elaborate(Bus::kIo, [](Board& board, sc_core::sc_signal<bool>& line) { board.isa_memr_n(line); });
  elaborate(Bus::kMemory, [](Board& board, sc_core::sc_signal<bool>& line) { board.isa_aen(line); });
  simulate_board(model_engine(), Bus::kMemory, [](Initiator&) {});
  in_own_process([] {  // the other bus, and what is no line of a cycle, may be driven by pins
    sc_core::sc_signal<bool> rd_n{"rd_n", true}, resetdrv{"resetdrv"};
    BoardBench bench(model_engine(), Bus::kIo, [](Initiator&) {});
    bench.board.pa_rd_n(rd_n);
    bench.board.isa_resetdrv(resetdrv);
    sc_core::sc_start(1, sc_core::SC_NS);
  });
}

}  // namespace
}  // namespace brick::component
