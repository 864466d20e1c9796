// The host port's component, both sides at once, against the block inside driven through its C++ face.
#include <gtest/gtest.h>

#include <brick/host_port.h>

#include "systemc/host/host_port.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/component/sides.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

constexpr unsigned kHost = 0;

// All accesses are one edge of clk_ref, but reads of the host, which act with a second.
class HostPortSides final : public Sides {
 public:
  HostPortSides() : port_("block") { port_.reset(0); }

  void set(const std::string& pin, std::uint32_t value) override {
    if (pin == "resetdrv") port_.in.hp_reset = value != 0;
    if (pin == "rst_n") reset_ = value == 0;
    if (reset_) port_.reset(now_);
  }
  void edge(Tick t) override {
    now_ = t;
    if (reset_)
      port_.reset(t);
    else
      port_.advance(t);
  }
  bool moved() override {
    const unsigned before = shown_;
    shown_ = port_.hreq() | port_.irq() << 1 | port_.txde() << 2 | port_.rxdf() << 3;
    return shown_ != before;
  }
  std::map<std::string, std::uint32_t> outputs() const override {
    return {{"hreq", port_.hreq()}, {"irq", port_.irq()}, {"txde", port_.txde()}, {"rxdf", port_.rxdf()}};
  }
  bool clocked(unsigned, Tick t) const override { return is_ref_edge(t); }
  void begin(unsigned side, const Access& access) override {
    access_[side] = access;
    sampled_ = sampled_ && side != kHost;
  }
  void before(unsigned side) override {
    const Access& a = access_[side];
    if (side == kHost) {
      port_.in.hp_sel = true;
      port_.in.hp_addr = static_cast<std::uint8_t>(a.address);
      port_.in.hp_wdata = static_cast<std::uint8_t>(a.value);
      if (!a.write && !sampled_) value_[side] = port_.host_read(a.address);
      (a.write ? port_.in.hp_wr : sampled_ ? port_.in.hp_rd_done : port_.in.hp_rd) = true;
    } else {  // X:$FFFFC2 and on
      port_.in.dsp_sel = true;
      port_.in.dsp_addr = static_cast<std::uint8_t>(2 + a.address / 4);
      port_.in.dsp_wdata = a.value;
      if (!a.write) value_[side] = port_.cpu_read(port_.in.dsp_addr);
      (a.write ? port_.in.dsp_we : port_.in.dsp_rd) = true;
    }
  }
  std::optional<std::uint32_t> after(unsigned side) override {
    HostPortInputs& in = port_.in;
    if (side == kHost)
      in.hp_sel = in.hp_wr = in.hp_rd = in.hp_rd_done = false;
    else
      in.dsp_sel = in.dsp_we = in.dsp_rd = false;
    const Access& a = access_[side];
    if (a.write) return a.value;
    if (side == kHost && !sampled_ && !reset_) {
      sampled_ = true;
      return {};
    }
    return value_[side];
  }

 private:
  brick::HostPort port_;
  Access access_[2];
  std::uint32_t value_[2] = {};
  bool sampled_ = false, reset_ = false;
  Tick now_ = 0;
  unsigned shown_ = 0;
};

Traffic host_port_traffic(std::uint32_t seed) {
  Traffic traffic;
  traffic.end = edge_time(kTicks);
  std::mt19937 random(seed);
  const auto below = [&random](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (Picoseconds now = 0; now < traffic.end;) {
    now += 1'000 + below(60'000'000);
    const std::string pin = below(3) == 0 ? "rst_n" : "resetdrv";
    const std::uint32_t active = pin == "rst_n" ? 0 : 1;
    traffic.pins.push_back({now, pin, active});
    traffic.pins.push_back({now += 1 + below(60'000), pin, active ^ 1});
  }
  const auto idle = [&below] { return Picoseconds{below(4) == 0 ? 0 : below(250'000)}; };
  for (Picoseconds now = 0; now < traffic.end; now += traffic.accesses.back().idle + 3 * 8'500) {
    Access a{idle(), below(2) == 0, below(8), below(256)};
    if (below(2) == 0) a.address = below(2) == 0 ? 7 : 2;  // the talk itself
    traffic.accesses.push_back(a);
  }
  for (Picoseconds now = 0; now < traffic.end; now += traffic.others.back().idle + 3 * 8'500) {
    Access a{idle(), below(2) == 0, 4 * below(6), below(1u << 24)};
    if (below(2) == 0) a = {a.idle, a.write, a.write ? 20u : 16u, a.value};  // HOTX, HORX
    traffic.others.push_back(a);
  }
  return traffic;
}

TEST(HostPortComponent, AgreesWithTheBlockOnBothSidesAtOnce) {
  BRICK_COVERS("CARD-1 CARD-2");
  on_each_engine([](const Engine& engine, const sc_core::sc_time& quantum, std::uint32_t seed) {
    const Traffic traffic = host_port_traffic(seed);
    HostPortSides block;
    const Seen expected = run(block, traffic);
    EXPECT_GE(expected.answers.size(), 30'000u);
    EXPECT_GE(expected.others.size(), 30'000u);
    EXPECT_GE(expected.changes.size(), 8'000u);
    std::size_t met = 0;
    for (auto a = expected.answers.begin(), b = expected.others.begin();
         a != expected.answers.end() && b != expected.others.end(); ++(a->first < b->first ? a : b))
      met += a->first == b->first ? 1 : 0;
    EXPECT_GE(met, 2'000u) << "accesses of both sides with one edge";
    TimeBase time("time");
    HostPort port("port", time, engine);
    does(expected, traffic, port, quantum, 1, 4, all, [](Rig& rig, HostPort& p) {
      rig.socket().bind(p.host);
      rig.other_socket().bind(p.cpu);
    });
  });
}

void with_host_port(const Engine& engine, const std::function<void(Initiator&)>& host,
                    const std::function<void(Initiator&)>& cpu) {
  TimeBase time("time");
  HostPort port("port", time, engine);
  Initiator one("one", host), two("two", cpu);
  one.socket.bind(port.host);
  two.socket.bind(port.cpu);
  sc_core::sc_start(10, sc_core::SC_US);
  EXPECT_TRUE(one.ended);
  EXPECT_TRUE(two.ended);
}

std::uint32_t host_read(Initiator& i, unsigned address) {
  i.data = 0;
  EXPECT_EQ(i.send(i.payload(kRead, address, 1)), tlm::TLM_OK_RESPONSE);
  return i.data;
}

// A character there and one back (host-bus:3.2).
TEST(HostPortComponent, CharacterTravelsThereAndBack) {
  BRICK_COVERS("CARD-1");
  on_each_engine([](const Engine& engine, const sc_core::sc_time&, std::uint32_t) {
    constexpr unsigned kHsr = 4, kHorx = 16, kHotx = 20, kIsr = 2;
    with_host_port(
        engine,
        [](Initiator& i) {
          i.data = '?';
          EXPECT_EQ(i.send(i.payload(kWrite, 7, 1)), tlm::TLM_OK_RESPONSE);
          while ((host_read(i, kIsr) & 1) == 0) sc_core::wait(10, sc_core::SC_NS);
          EXPECT_EQ(host_read(i, 7), 0x06u);
          EXPECT_EQ(host_read(i, kIsr) & 1, 0u) << "the read of byte 7 has freed RX";
        },
        [](Initiator& i) {
          while ((i.read(kHsr) & 1) == 0) sc_core::wait(10, sc_core::SC_NS);
          EXPECT_EQ(i.read(kHorx), unsigned{'?'});
          i.write(kHotx, 0x06);
        });
  });
}

TEST(HostPortComponent, BadPayloadsGetErrorResponsesAtOnce) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_host_port(
        model_engine(),
        [](Initiator& i) {
          EXPECT_EQ(i.send(i.payload(kRead, 8, 1)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kRead, 0, 2)), tlm::TLM_BURST_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(tlm::TLM_IGNORE_COMMAND, 0, 1)), tlm::TLM_COMMAND_ERROR_RESPONSE);
          EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        },
        [](Initiator& i) {
          EXPECT_EQ(i.send(i.payload(kWrite, 24)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kWrite, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE);
          EXPECT_EQ(i.send(i.payload(kWrite, 4, 1)), tlm::TLM_BURST_ERROR_RESPONSE);
          EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME);
        });
  });
}

// Debug reads of the host's byte 7 and of HORX, and a read that is given up, leave the word where it is.
TEST(HostPortComponent, OnlyAWholeReadFreesAWord) {
  BRICK_COVERS("CARD-1");
  on_each_engine([](const Engine& engine, const sc_core::sc_time&, std::uint32_t) {
    with_host_port(
        engine,
        [](Initiator& i) {
          sc_core::wait(1, sc_core::SC_US);
          i.data = 0;
          EXPECT_EQ(i.socket->transport_dbg(*i.payload(kRead, 7, 1)), 1u);
          EXPECT_EQ(i.data, 0x77u);
          auto killed = sc_core::sc_spawn([&i] { host_read(i, 7); });
          sc_core::wait(40, sc_core::SC_NS);  // edges 120 and 123 are at 1017 and 1043 ns
          killed.kill();
          sc_core::wait(60, sc_core::SC_NS);
          EXPECT_EQ(host_read(i, 2) & 1, 1u) << "RX still holds the word";
          EXPECT_EQ(host_read(i, 7), 0x77u);
          EXPECT_EQ(host_read(i, 2) & 1, 0u);
        },
        [](Initiator& i) {
          i.write(20, 0x77);
          EXPECT_EQ(i.debug_read(16), 0u);
        });
  });
}

}  // namespace
}  // namespace brick::component
