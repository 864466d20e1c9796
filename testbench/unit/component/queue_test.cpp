// Accesses that meet at one socket: their order does not depend on how a process splits its time into waits and
// annotated delays, and a process that is killed or stopped takes nothing from the others.
#include <gtest/gtest.h>

#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/traffic.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::sc_time;
constexpr std::uint64_t kOutA = 24;  // Y of word 3 of channel 1 is storage: 8 a, a = 3

std::uint32_t access(Initiator& i, bool write, std::uint32_t value, double delay_ns = 0) {
  tlm::tlm_generic_payload p;
  p.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  p.set_address(kOutA);
  p.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
  p.set_data_length(4);
  p.set_streaming_width(4);
  sc_time delay(delay_ns, sc_core::SC_NS);
  i.socket->b_transport(p, delay);
  EXPECT_EQ(p.get_response_status(), tlm::TLM_OK_RESPONSE);
  return value;
}
sc_core::sc_process_handle spawn(const char* name, const std::function<void()>& program) {
  return sc_core::sc_spawn(program, name);
}

void with_servo_ic_and_time(const Engine& engine, const std::function<void(Initiator&, TimeBase&)>& program) {
  TimeBase time("time");
  ServoIc ic("ic", time, engine);
  Initiator initiator("initiator", [&](Initiator& i) { program(i, time); });
  initiator.socket.bind(ic.registers);
  sc_core::sc_start(10, sc_core::SC_US);
  EXPECT_TRUE(initiator.ended);
}

// Edge 12 of clk_pwm, the fourth of clk_ref, is the first of clk_ref after 100 ns (101.7 ns); edge 15 is the next.
TEST(RegisterQueue, ProcessesOfOneInstantHaveTheOrderOfTheirNames) {
  BRICK_COVERS("CARD-1");
  struct Split {
    double wait_ns, delay_ns;
  };
  for (const Split& d : {Split{0, 100}, Split{100, 0}, Split{60, 40}})
    for (const bool late_first : {false, true})
      in_own_process([&] {
        with_servo_ic_and_time(model_engine(), [&](Initiator& i, TimeBase&) {
          std::string order;
          std::vector<Picoseconds> times;
          const auto one = [&](const char* name, const Split& split) {
            spawn(name, [&, name, split] {
              if (split.wait_ns != 0) sc_core::wait(split.wait_ns, sc_core::SC_NS);
              access(i, true, 1, split.delay_ns);
              order += name;
              times.push_back(sc_core::sc_time_stamp().value());
            });
          };
          if (late_first) one("d", d);
          for (const char* name : {"c", "a", "b"}) one(name, {0, 100});
          if (!late_first) one("d", d);
          sc_core::wait(1, sc_core::SC_US);
          EXPECT_EQ(order, "abcd");
          EXPECT_EQ(times, (std::vector<Picoseconds>{edge_time(12), edge_time(15), edge_time(18), edge_time(21)}));
        });
      });
}

TEST(RegisterQueue, WhoCameBeforeGoesFirstWhateverHisName) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_servo_ic_and_time(model_engine(), [](Initiator& i, TimeBase&) {
      std::string order;
      for (const auto& [name, delay] : {std::pair{"a", 100.003}, {"b", 100.002}, {"c", 100.001}})
        spawn(name, [&order, &i, n = name, d = delay] { access(i, true, 1, d), order += n; });
      sc_core::wait(1, sc_core::SC_US);
      EXPECT_EQ(order, "cba");
    });
  });
}

// In the instant of the edge that makes his write: it has been made, and who waits still gets an edge of his own.
TEST(RegisterQueue, WhoIsKilledInTheInstantOfHisEdgeEndsNobodyElsesAccess) {
  BRICK_COVERS("CARD-1");
  for (const auto& engine : {model_engine(), rtl_engine(), lockstep_engine()})
    for (const bool write : {false, true})
      in_own_process([&] {
        with_servo_ic_and_time(engine, [write](Initiator& i, TimeBase& time) {
          auto killed = spawn("a", [&i] { access(i, true, 0x222222); });  // at edge 3
          std::uint32_t value = 0;
          Picoseconds end = 0;
          spawn("b", [&] {
            sc_core::wait(1, sc_core::SC_NS);
            value = access(i, write, 0x333333);
            end = sc_core::sc_time_stamp().value();
          });
          sc_core::wait(time.time_of(3) - sc_core::sc_time_stamp());
          killed.kill();
          sc_core::wait(1, sc_core::SC_US);
          EXPECT_EQ(end, edge_time(6));
          EXPECT_EQ(access(i, false, 0), write ? 0x333333u : 0x222222u);
          if (!write) { EXPECT_EQ(value, 0x222222u); }
        });
      });
}

TEST(RegisterQueue, ADisabledProcessHoldsUpNobody) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_servo_ic_and_time(model_engine(), [](Initiator& i, TimeBase&) {
      bool a_ended = false, b_ended = false;
      auto a = spawn("a", [&] { access(i, true, 0x222222), a_ended = true; });
      spawn("b", [&] { access(i, true, 0x333333), b_ended = true; });
      sc_core::wait(1, sc_core::SC_NS);
      a.disable();
      sc_core::wait(1, sc_core::SC_US);
      EXPECT_TRUE(b_ended);
      EXPECT_FALSE(a_ended);
      a.enable();
      EXPECT_EQ(access(i, false, 0), 0x333333u);
      sc_core::wait(1, sc_core::SC_NS);
      EXPECT_TRUE(a_ended) << "with the next end of an access";
    });
  });
}

TEST(RegisterQueue, PayloadsThatSayNothingAreErrors) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_servo_ic_and_time(model_engine(), [](Initiator& i, TimeBase&) {
      const auto empty = i.payload(tlm::TLM_READ_COMMAND, kOutA), odd = i.payload(tlm::TLM_READ_COMMAND, kOutA);
      empty->set_data_ptr(nullptr);
      EXPECT_EQ(i.send(empty), tlm::TLM_GENERIC_ERROR_RESPONSE);
      odd->set_command(static_cast<tlm::tlm_command>(3));
      EXPECT_EQ(i.send(odd), tlm::TLM_COMMAND_ERROR_RESPONSE);
    });
  });
}

}  // namespace
}  // namespace brick::component
