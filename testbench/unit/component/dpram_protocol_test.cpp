// Sockets of the dual-ported RAM: bytes, bursts, byte enables, errors, exact times, BUSY, debug, initiators that are
// killed. Times are those of docs/components.md: edges of clk_ref are ticks 3, 6, 9 and on.
#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include <brick/dpram.h>
#include <brick/rtl.h>

#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::sc_time;
using Program = std::function<void(Initiator&)>;

struct DpramBench {
  DpramBench(const Engine& engine, const Program& on_host, const Program& on_cpu)
      : ram("ram", time, {}, engine), host("host", on_host), cpu("cpu", on_cpu) {
    host.socket.bind(ram.host);
    cpu.socket.bind(ram.cpu);
    ram.small(small);
    ram.busy_host(busy_host);
    ram.busy_cpu(busy_cpu);
  }
  TimeBase time{"time"};
  Dpram ram;
  Initiator host, cpu;
  sc_core::sc_signal<bool> small{"small"}, busy_host{"busy_host"}, busy_cpu{"busy_cpu"};
};

void simulate_dpram(
    const Engine& engine, const Program& host, const Program& cpu = [](Initiator&) {}) {
  DpramBench bench(engine, host, cpu);
  sc_core::sc_start(20, sc_core::SC_US);
  EXPECT_TRUE(bench.host.ended);
  EXPECT_TRUE(bench.cpu.ended);
}

// A quantum is nothing to these.
void on_engines(const std::function<void(const Engine&)>& test) {
  for (const auto& engine :
       {+[] { return model_engine(); }, +[] { return rtl_engine(); }, +[] { return lockstep_engine(); }})
    in_own_process([&] { test(engine()); });
}

std::uint32_t word(Initiator& i, unsigned address) {
  i.data = 0;
  EXPECT_EQ(i.send(i.payload(kRead, address, 2)), tlm::TLM_OK_RESPONSE);
  return i.data;
}
void set_word(Initiator& i, unsigned address, std::uint32_t value) {
  i.data = value;
  EXPECT_EQ(i.send(i.payload(kWrite, address, 2)), tlm::TLM_OK_RESPONSE);
}
Tick tick() {  // of the edge in whose instant we are
  const Tick t = edge_after(sc_core::sc_time_stamp().value()) - 1;
  EXPECT_EQ(edge_time(t), sc_core::sc_time_stamp().value());
  return t;
}

// What is stored 16 bits wide is seen 8, 16 and 32 bits wide, at any address.
TEST(DpramSocket, TakesBytesInAnyNumberAtAnyAddress) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    simulate_dpram(engine, [](Initiator& i) {
      set_word(i, 0x100, 0x2211);
      set_word(i, 0x102, 0x4433);
      const auto bytes = [&i](unsigned address, unsigned length) {
        i.data = 0;
        EXPECT_EQ(i.send(i.payload(kRead, address, length)), tlm::TLM_OK_RESPONSE);
        return i.data;
      };
      EXPECT_EQ(bytes(0x100, 1), 0x11u);
      EXPECT_EQ(bytes(0x101, 1), 0x22u);
      EXPECT_EQ(bytes(0x101, 2), 0x3322u);
      EXPECT_EQ(bytes(0x100, 4), 0x44332211u);
      EXPECT_EQ(bytes(0x101, 3), 0x443322u);
      i.data = 0xAABB;
      EXPECT_EQ(i.send(i.payload(kWrite, 0x101, 2)), tlm::TLM_OK_RESPONSE);
      EXPECT_EQ(bytes(0x100, 4), 0x44AABB11u);
    });
  });
}

// Two edges of clk_ref a word that is read, three a word that is written; what is disabled takes no cycle.
TEST(DpramSocket, EachWordIsACycleOfItsOwn) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    simulate_dpram(engine, [](Initiator& i) {
      std::array<unsigned char, 40> data;
      std::iota(data.begin(), data.end(), static_cast<unsigned char>(1));
      std::array<unsigned char, 4> enables{TLM_BYTE_ENABLED, TLM_BYTE_ENABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED};
      const auto burst = [&](tlm::tlm_command command, unsigned address, sc_time delay = sc_core::SC_ZERO_TIME) {
        auto p = i.payload(command, address, data.size());
        p->set_data_ptr(data.data());
        if (address == 0x400) {
          p->set_byte_enable_ptr(enables.data());
          p->set_byte_enable_length(4);
        }
        const Tick from = edge_after((sc_core::sc_time_stamp() + delay).value()) - 1;
        EXPECT_EQ(i.send(p, delay), tlm::TLM_OK_RESPONSE);
        EXPECT_EQ(delay, sc_core::SC_ZERO_TIME);
        return (tick() - from / 3 * 3) / 3;
      };
      EXPECT_EQ(burst(kWrite, 0x200), 20 * 3);
      EXPECT_EQ(burst(kWrite, 0x401), 21 * 3) << "an odd address: one word more";
      EXPECT_EQ(burst(kWrite, 0x400), 10 * 3) << "every other word";
      data.fill(0);
      EXPECT_EQ(burst(kRead, 0x200, sc_time(1, sc_core::SC_US)), 20 * 2);
      for (unsigned k = 0; k < data.size(); ++k) EXPECT_EQ(data[k], k + 1);
      data.fill(0xEE);
      burst(kRead, 0x400);
      for (unsigned k = 0; k < data.size(); ++k) EXPECT_EQ(data[k], k % 4 < 2 ? k + 1 : 0xEE) << k;
      enables = {TLM_BYTE_DISABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED, TLM_BYTE_DISABLED};
      EXPECT_EQ(burst(kWrite, 0x400), 0) << "nothing to do";
    });
  });
}

// Six edges of clk_pwm for a read of the CPU, five for a write, after the delay.
TEST(DpramSocket, CpuCyclesCountEdgesOfClkPwm) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    simulate_dpram(
        engine, [](Initiator&) {},
        [](Initiator& i) {
          set_word(i, 6, 0xBEEF);  // X:$060001
          EXPECT_EQ(tick(), 5);
          i.data = 0;
          sc_time delay(100, sc_core::SC_NS);  // at 142.4 ns: edge 17 is at 144.1
          EXPECT_EQ(i.send(i.payload(kRead, 6, 2), delay), tlm::TLM_OK_RESPONSE);
          EXPECT_EQ(i.data, 0xBEEFu);
          EXPECT_EQ(tick(), 16 + 6);
          set_word(i, 6, 0x1234);
          EXPECT_EQ(tick(), 22 + 5);
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 6, 2)), 2u);
          EXPECT_EQ(i.data, 0x1234u) << "written when it returns";
        });
  });
}

TEST(DpramSocket, BadPayloadsGetErrorResponsesAtOnce) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    simulate_dpram(
        model_engine(),
        [](Initiator& i) {
          EXPECT_EQ(i.send(i.payload(kRead, 0x10000, 1)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kRead, 0xFFFE, 4)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "beyond the end";
          EXPECT_EQ(i.send(i.payload(kRead, ~0ull, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kRead, 0, 0)), tlm::TLM_BURST_ERROR_RESPONSE) << "no bytes";
          EXPECT_EQ(i.send(i.payload(tlm::TLM_IGNORE_COMMAND, 0, 2)), tlm::TLM_COMMAND_ERROR_RESPONSE);
          auto stream = i.payload(kWrite, 0, 4);
          stream->set_streaming_width(2);
          EXPECT_EQ(i.send(stream), tlm::TLM_BURST_ERROR_RESPONSE);
          unsigned char enables[2] = {TLM_BYTE_ENABLED, 0x55};
          auto odd = i.payload(kWrite, 0, 2);
          odd->set_byte_enable_ptr(enables);
          odd->set_byte_enable_length(2);
          EXPECT_EQ(i.send(odd), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE) << "no value of TLM";
          odd->set_byte_enable_length(0);
          EXPECT_EQ(i.send(odd), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
          EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        },
        [](Initiator& i) {
          EXPECT_EQ(i.send(i.payload(kRead, 1, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kRead, 0x10000, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kRead, 0, 4)), tlm::TLM_BURST_ERROR_RESPONSE) << "one word an access";
          EXPECT_EQ(i.send(i.payload(kRead, 0, 1)), tlm::TLM_BURST_ERROR_RESPONSE);
          unsigned char enables[2] = {TLM_BYTE_ENABLED, TLM_BYTE_ENABLED};
          auto p = i.payload(kWrite, 0, 2);
          p->set_byte_enable_ptr(enables);
          p->set_byte_enable_length(2);
          EXPECT_EQ(i.send(p), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
          EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        });
  });
}

// Debug reads as many bytes as there are, without time, and beyond the fitted size zeros; no DMI.
TEST(DpramSocket, DebugReadsTheContent) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    DpramBench* self = nullptr;
    DpramBench bench(
        engine,
        [&self](Initiator& i) {
          set_word(i, 0xFFFE, 0xCAFE);
          set_word(i, 0xFFFC, 0x1234);
          const auto now = sc_core::sc_time_stamp().value();
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 0xFFFD, 3)), 3u);
          EXPECT_EQ(i.data & 0xFFFFFF, 0xCAFE12u);
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 0xFFFF, 4)), 1u) << "what is there";
          EXPECT_EQ(i.data & 0xFF, 0xCAu);
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 0x10000, 1)), 0u);
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kWrite, 0xFFFE, 2)), 0u);
          tlm::tlm_dmi dmi;
          EXPECT_FALSE(i.socket->get_direct_mem_ptr(*i.payload(kRead, 0), dmi)) << "BUSY may happen";
          EXPECT_EQ(sc_core::sc_time_stamp().value(), now);
          self->small = true;
          sc_core::wait(1, sc_core::SC_US);
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 0xFFFE, 2)), 2u);
          EXPECT_EQ(i.data & 0xFFFF, 0u) << "not fitted";
          EXPECT_EQ(word(i, 0xFFFE), 0u);
          set_word(i, 0xFFFE, 1);
          self->small = false;
          sc_core::wait(1, sc_core::SC_US);
          EXPECT_EQ(word(i, 0xFFFE), 0xCAFEu) << "took no write";
        },
        [](Initiator&) {});
    self = &bench;
    sc_core::sc_start(20, sc_core::SC_US);
    EXPECT_TRUE(bench.host.ended);
  });
}

// The host's write has the word from edge 120 + 3 to 126; the CPU's strobe falls before edge 122 and is decided with
// 124.
TEST(DpramSocket, TheLaterOneWaitsAndADebugReadDisturbsNobody) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    DpramBench* self = nullptr;
    DpramBench bench(
        engine,
        [](Initiator& i) {
          sc_core::wait(sc_time::from_value(edge_time(118)));
          set_word(i, 0x40, 0x1111);
          EXPECT_EQ(tick(), 126);
          EXPECT_EQ(word(i, 0x40), 0x1111u);
        },
        [&self](Initiator& i) {
          sc_core::wait(sc_time::from_value(edge_time(121)));
          auto debug = sc_core::sc_spawn([&i] {
            for (Tick t = 122; t < 130; ++t) {
              sc_core::wait(sc_time::from_value(edge_time(t)) - sc_core::sc_time_stamp());
              std::uint16_t seen = 0;
              tlm::tlm_generic_payload p;
              p.set_read();
              p.set_address(0x40);
              p.set_data_ptr(reinterpret_cast<unsigned char*>(&seen));
              p.set_data_length(2);
              EXPECT_EQ(i.socket->transport_dbg(p), 2u);
            }
          });
          auto busy = sc_core::sc_spawn([&self] {
            sc_core::wait(self->busy_cpu.posedge_event());
            EXPECT_EQ(tick(), 124);
            sc_core::wait(self->busy_cpu.negedge_event());
            EXPECT_EQ(tick(), 127);
          });
          EXPECT_EQ(word(i, 0x40), 0x1111u) << "what the host has written";
          EXPECT_EQ(tick(), 128 + 2) << "/TA one edge after BUSY, then high for two";
          EXPECT_TRUE(busy.terminated());
        });
    self = &bench;
    sc_core::sc_start(20, sc_core::SC_US);
    EXPECT_TRUE(bench.host.ended);
    EXPECT_TRUE(bench.cpu.ended);
  });
}

// Killed anywhere in its cycle of 50 ns: who comes at once after it reads his own word, and his write is made.
TEST(DpramSocket, TheAccessAfterAKilledOneIsWhole) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    simulate_dpram(
        engine, [](Initiator&) {},
        [](Initiator& i) {
          set_word(i, 0x10, 0x1111);
          unsigned broken_off = 0;
          for (double ns = 0.1; ns < 58; ns += 1.3) {
            const auto value = static_cast<std::uint32_t>(ns * 100);
            set_word(i, 0x20, 0x2222);
            auto reader = sc_core::sc_spawn([&i] { word(i, 0x10); });
            sc_core::wait(ns, sc_core::SC_NS);
            broken_off += reader.terminated() ? 0 : 1;
            if (!reader.terminated()) reader.kill();
            EXPECT_EQ(word(i, 0x20), 0x2222u) << "read killed after " << ns << " ns";
            auto writer = sc_core::sc_spawn([&i] { set_word(i, 0x10, 0x1111); });
            sc_core::wait(ns, sc_core::SC_NS);
            if (!writer.terminated()) writer.kill();
            set_word(i, 0x20, value);
            EXPECT_EQ(word(i, 0x20), value) << "write killed after " << ns << " ns";
          }
          EXPECT_GT(broken_off, 30u);
        });
  });
}

// Killed while it waits for the other side: nothing of it is made, BUSY ends, the socket is free.
TEST(DpramSocket, AKilledInitiatorThatWaitsLeavesNothing) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    DpramBench* self = nullptr;
    DpramBench bench(
        engine,
        [&self](Initiator& i) {
          sc_core::wait(sc_time::from_value(edge_time(118)));
          auto first = sc_core::sc_spawn([&i] { set_word(i, 0x40, 0x1111); });
          sc_core::wait(first.terminated_event());
          // The CPU reads for long: the host's write waits and is killed.
          sc_core::wait(sc_time::from_value(edge_time(238)) - sc_core::sc_time_stamp());
          auto second = sc_core::sc_spawn([&i] { set_word(i, 0x40, 0x2222); });
          sc_core::wait(self->busy_host.posedge_event());
          second.kill();
          sc_core::wait(self->busy_host.negedge_event());
          EXPECT_EQ(word(i, 0x40), 0x1111u);
          set_word(i, 0x40, 0x3333);
          EXPECT_EQ(word(i, 0x40), 0x3333u);
        },
        [&self](Initiator& i) {
          sc_core::wait(sc_time::from_value(edge_time(121)));
          auto killed = sc_core::sc_spawn([&i] { set_word(i, 0x40, 0x9999); });
          sc_core::wait(self->busy_cpu.posedge_event());
          killed.kill();
          sc_core::wait(self->busy_cpu.negedge_event());
          EXPECT_EQ(word(i, 0x40), 0x1111u);
          sc_core::wait(sc_time::from_value(edge_time(239)) - sc_core::sc_time_stamp());
          EXPECT_EQ(word(i, 0x40), 0x1111u);
        });
    self = &bench;
    sc_core::sc_start(20, sc_core::SC_US);
    EXPECT_TRUE(bench.host.ended);
    EXPECT_TRUE(bench.cpu.ended);
  });
}

// Two initiators at one socket take turns, word by word.
TEST(DpramSocket, AccessesOfOneSideTakeTurns) {
  BRICK_COVERS("CARD-1");
  on_engines([](const Engine& engine) {
    simulate_dpram(engine, [](Initiator& i) {
      std::vector<Tick> ends;
      const auto write = [&i, &ends](unsigned address) {
        std::uint32_t data = address;
        auto p = i.payload(kWrite, address, 4);
        p->set_data_ptr(reinterpret_cast<unsigned char*>(&data));
        EXPECT_EQ(i.send(p), tlm::TLM_OK_RESPONSE);
        ends.push_back(tick());
      };
      auto other = sc_core::sc_spawn([&write] { write(0x10); });
      write(0x20);
      if (!other.terminated()) sc_core::wait(other.terminated_event());
      std::sort(ends.begin(), ends.end());
      EXPECT_EQ(ends, (std::vector<Tick>{3 * 9, 3 * 12})) << "four cycles of three edges";
      EXPECT_EQ(word(i, 0x10), 0x10u);
      EXPECT_EQ(word(i, 0x20), 0x20u);
    });
  });
}

}  // namespace
}  // namespace brick::component
