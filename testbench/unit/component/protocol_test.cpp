// The socket's protocol, the time base, and what the engines say when something is wrong.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include <brick/interrupt_controller.h>
#include <brick/rtl.h>
#include <brick/servo_ic.h>

#include "systemc/component/interrupt_controller/interrupt_controller_words.h"
#include "systemc/component/lockstep_chip.h"
#include "systemc/component/model_chips.h"
#include "systemc/component/rtl_chips.h"
#include "testbench/unit/component/initiator.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/component/servo_ic_block.h"
#include "testbench/unit/covers.h"

namespace brick::component {
namespace {

using sc_core::sc_time;

void with_servo_ic(const Engine& engine, const std::function<void(Initiator&)>& program) {
  TimeBase time("time");
  ServoIc ic("ic", time, engine);
  Initiator initiator("initiator", program);
  initiator.socket.bind(ic.registers);
  sc_core::sc_start(10, sc_core::SC_US);
  EXPECT_TRUE(initiator.ended);
}

TEST(RegisterSocket, BadPayloadsGetErrorResponsesAtOnce) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_servo_ic(model_engine(), [](Initiator& i) {
      EXPECT_EQ(i.send(i.payload(kRead, 256)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "beyond the last word";
      EXPECT_EQ(i.send(i.payload(kRead, 2)), tlm::TLM_ADDRESS_ERROR_RESPONSE) << "in the middle of one";
      EXPECT_EQ(i.send(i.payload(kRead, 4, 2)), tlm::TLM_BURST_ERROR_RESPONSE) << "half a register";
      EXPECT_EQ(i.send(i.payload(kRead, 4, 8)), tlm::TLM_BURST_ERROR_RESPONSE) << "two registers";
      EXPECT_EQ(i.send(i.payload(tlm::TLM_IGNORE_COMMAND, 4)), tlm::TLM_COMMAND_ERROR_RESPONSE);
      auto narrow = i.payload(kRead, 4);
      narrow->set_streaming_width(2);
      EXPECT_EQ(i.send(narrow), tlm::TLM_BURST_ERROR_RESPONSE);
      unsigned char lanes[4] = {0xFF, 0xFF, 0, 0};
      auto enabled = i.payload(tlm::TLM_WRITE_COMMAND, 4);
      enabled->set_byte_enable_ptr(lanes);
      enabled->set_byte_enable_length(4);
      EXPECT_EQ(i.send(enabled), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
      EXPECT_EQ(sc_core::sc_time_stamp(), sc_core::SC_ZERO_TIME) << "an error takes no time";
    });
  });
}

TEST(RegisterSocket, AccessEndsAtTheFirstReferenceEdgeAfterItsDelay) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    with_servo_ic(model_engine(), [](Initiator& i) {
      sc_time delay(100, sc_core::SC_NS);  // edge 12 of clk_pwm is at 101725.26 ps, the fourth of clk_ref
      EXPECT_EQ(i.send(i.payload(tlm::TLM_READ_COMMAND, 4 * 9), delay), tlm::TLM_OK_RESPONSE);
      EXPECT_EQ(delay, sc_core::SC_ZERO_TIME);
      EXPECT_EQ(sc_core::sc_time_stamp(), sc_time::from_value(101'726));
      EXPECT_EQ(i.data, 0x3038D2u) << "clock control after a reset";
      EXPECT_EQ(i.send(i.payload(tlm::TLM_READ_COMMAND, 4 * 9)), tlm::TLM_OK_RESPONSE);
      EXPECT_EQ(sc_core::sc_time_stamp(), sc_time::from_value(127'157)) << "edge 15: called in an edge's instant";
    });
  });
}

TEST(RegisterSocket, AccessesThatMeetTakeOneEdgeEach) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    InterruptController pic("pic", time, rtl_engine()), other("other", time);
    std::vector<std::pair<Picoseconds, unsigned>> ends;
    const auto write = [&ends](Initiator& i, unsigned who) {
      EXPECT_EQ(i.send(i.payload(tlm::TLM_WRITE_COMMAND, 2, 1)), tlm::TLM_OK_RESPONSE);
      ends.emplace_back(sc_core::sc_time_stamp().value(), who);
    };
    Initiator both("both", [&write](Initiator& i) {
      sc_core::sc_spawn([&write, &i] { write(i, 1); });
      write(i, 0);
    });
    Initiator alone("alone", [&write](Initiator& i) { write(i, 2); });
    both.socket.bind(pic.registers);
    alone.socket.bind(other.registers);
    sc_core::sc_start(1, sc_core::SC_US);
    const std::vector<std::pair<Picoseconds, unsigned>> expected{
        {edge_time(3), 0}, {edge_time(3), 2}, {edge_time(6), 1}};
    std::sort(ends.begin(), ends.end());
    EXPECT_EQ(ends, expected);
  });
}

// Killed under way, killed in the queue, reset under way: others go on, what was not made yet is not made.
TEST(RegisterSocket, AKilledOrResetInitiatorLeavesItFree) {
  BRICK_COVERS("CARD-1");
  for (const bool rtl : {false, true})
    in_own_process([rtl] {
      with_servo_ic(rtl ? rtl_engine() : model_engine(), [](Initiator& i) {
        const auto write = [&i] { return sc_core::sc_spawn([&i] { i.write(kClockControl, 0x3008D2); }); };
        sc_core::wait(1, sc_core::SC_US);  // the next edge of clk_ref is 120, at 1017.2 ns
        auto under_way = write(), waiting = write();
        sc_core::wait(5, sc_core::SC_NS);
        waiting.kill();
        under_way.kill();
        EXPECT_EQ(i.read(kClockControl), 0x3038D2u) << "not written";
        EXPECT_EQ(sc_core::sc_time_stamp().value(), edge_time(120));
        auto again = write();
        sc_core::wait(5, sc_core::SC_NS);
        again.reset();
        sc_core::wait(1, sc_core::SC_PS);  // accesses of one instant have the order of their processes' names
        EXPECT_EQ(i.read(kClockControl), 0x3008D2u);
        EXPECT_EQ(sc_core::sc_time_stamp().value(), edge_time(126)) << "after the write, at 123";
      });
    });
}

TEST(Time, EdgesComeInTheFirstInstantAfterTheirTrueTime) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeOptions options;
    options.epoch = sc_time(5, sc_core::SC_NS);
    TimeBase time("time", options);
    // Tick 1 is 8477.105.. ps, tick 1152 exactly 9765625 ps: it acts one unit later, as all do.
    EXPECT_EQ(time.time_of(1).value(), 5000u + 8478);
    EXPECT_EQ(time.time_of(1152).value(), 5000u + 9'765'626);
    EXPECT_EQ(time.tick_at(sc_time(4, sc_core::SC_NS)), 0) << "before the epoch";
    for (const Tick t : {Tick{1}, Tick{2}, Tick{1152}, Tick{1'000'000'007}}) {
      EXPECT_EQ(time.time_of(t).value(), 5000 + edge_time(t));
      EXPECT_EQ(time.tick_at(time.time_of(t)), t);
      EXPECT_EQ(time.tick_at(time.time_of(t) - sc_time::from_value(1)), t - 1);
    }
    EXPECT_THROW(TimeBase("another"), sc_core::sc_report);
  });
}

// Across the instants at which femtoseconds and picoseconds of 63 and 64 bits end; the last is the kernel's own end.
TEST(Time, GoesAsFarAsTheKernels) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    InterruptController pic("pic", time);
    sc_core::sc_signal<bool> line("line"), irq("irq");
    pic.ir[1](line);
    pic.irq(irq);
    constexpr Picoseconds kEnd = ~Picoseconds{};
    for (const Picoseconds instant : {Picoseconds{9'223'372'036'854'776}, Picoseconds{18'446'744'073'709'552},
                                      Picoseconds{1} << 63, kEnd - 2'000'000}) {
      const Tick t = edge_after(instant);
      EXPECT_EQ(time.time_of(t).value(), edge_time(t));
      for (const int off : {-1, 0, 1}) {
        EXPECT_EQ(time.tick_at(sc_time::from_value(edge_time(t) + off)), off < 0 ? t - 1 : t) << off;
        EXPECT_EQ(time.tick_at(sc_time::from_value(edge_time(t + 100) + off)), off < 0 ? t + 99 : t + 100) << off;
      }
      sc_core::sc_start(sc_time::from_value(instant - sc_core::sc_time_stamp().value()));
      line = !line;
      sc_core::sc_start(1, sc_core::SC_US);
      EXPECT_EQ(sc_core::sc_time_stamp().value(), instant + 1'000'000);
    }
    EXPECT_THROW(time.time_of(edge_after(kEnd - 1'000'000) + 120), sc_core::sc_report);
    EXPECT_THROW(time.time_of(-1), sc_core::sc_report);
    EXPECT_THROW(time.tick_at(sc_core::sc_max_time()), sc_core::sc_report);
    sc_core::sc_start(sc_time::from_value(kEnd - 1 - sc_core::sc_time_stamp().value()));
    line = !line;
  });
}

TEST(Time, ACoarseKernelIsRefused) {
  in_own_process([] {
    sc_core::sc_set_time_resolution(10, sc_core::SC_NS);
    EXPECT_THROW(TimeBase("time"), sc_core::sc_report);
  });
  in_own_process([] {
    sc_core::sc_set_time_resolution(10, sc_core::SC_NS);
    sc_core::sc_report_handler::set_actions(sc_core::SC_ERROR, sc_core::SC_DO_NOTHING);
    EXPECT_THROW(TimeBase("time"), std::runtime_error) << "whatever a report does";
  });
}

// What a main program does between two calls of sc_start().
std::string change_line_at(const Engine& engine, double ns) {
  TimeBase time("time");
  InterruptController pic("pic", time, engine);
  sc_core::sc_signal<bool> line("line"), irq("irq");
  pic.ir[1](line);
  pic.irq(irq);
  sc_core::sc_start(ns, sc_core::SC_NS);
  line = true;
  try {
    sc_core::sc_start(1, sc_core::SC_US);
  } catch (const sc_core::sc_report& report) { return report.get_msg_type(); }
  return "";
}

TEST(Time, MainProgramChangesPinsAtTheGridOrAnywhere) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { EXPECT_EQ(change_line_at(rtl_engine(), 2000), ""); });
  in_own_process([] { EXPECT_EQ(change_line_at(rtl_engine(), 2300), "/brick/ahead"); });
  in_own_process([] { EXPECT_EQ(change_line_at(model_engine(), 2300), ""); });
}

TEST(Time, NothingTicksWhenNothingHappens) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    TimeBase time("time");
    ServoIc ic("ic", time), driven("driven", time, rtl_engine());
    InterruptController pic("pic", time);
    sc_core::sc_signal<bool> pwm("pwm"), irq("irq");
    ic.ch[0].aena(pwm);
    pic.irq(irq);
    sc_core::sc_start(1, sc_core::SC_US);
    const auto before = sc_core::sc_delta_count();
    sc_core::sc_start(1, sc_core::SC_SEC);
    EXPECT_LT(sc_core::sc_delta_count() - before, 10u);
  });
}

TEST(Time, AComponentMayGoAfterItsBaseButNotRun) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    auto base = std::make_unique<TimeBase>("time");
    ServoIc ic("ic", *base);
    base.reset();
    TimeBase second("second");  // the place is free
    EXPECT_EQ(error_of([] { sc_core::sc_start(1, sc_core::SC_US); }), "/brick/time_base");
  });
  in_own_process([] {
    auto base = std::make_unique<TimeBase>("time");
    auto ic = std::make_unique<ServoIc>("ic", *base);
    sc_core::sc_start(1, sc_core::SC_US);
    base.reset();
    sc_core::sc_start(1, sc_core::SC_US);
    ic.reset();
    sc_core::sc_start(1, sc_core::SC_US);
  });
}

TEST(Time, ABaseThatFailsLeavesItsPlace) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    sc_core::sc_set_time_resolution(10, sc_core::SC_NS);
    EXPECT_EQ(error_of([] { TimeBase coarse("coarse"); }), "/brick/resolution");
    EXPECT_EQ(error_of([] { TimeBase again("again"); }), "/brick/resolution") << "not /brick/time_base";
  });
}

// Wrong in one pin from one edge on.
class Distorted : public Chip {
 public:
  Distorted(std::unique_ptr<Chip> chip, Tick from) : chip_(std::move(chip)), from_(from) { take(); }
  Tick now() const override { return chip_->now(); }
  const PinWords& outputs() const override { return outputs_; }
  void watch(const PinWords& outputs) override { chip_->watch(outputs); }
  void set_inputs(const PinWords& inputs) override { chip_->set_inputs(inputs); }
  bool run_until(Tick limit) override {
    const bool changed = chip_->run_until(limit);
    take();
    return changed;
  }
  bool foresees() const override { return true; }
  Tick quiet_until() const override { return now() < from_ ? std::min(chip_->quiet_until(), from_ - 1) : now(); }
  void begin(unsigned face, const Cycle& cycle) override { chip_->begin(face, cycle); }
  void abandon(unsigned face) override { chip_->abandon(face); }
  bool busy(unsigned face) const override { return chip_->busy(face); }
  std::uint32_t value(unsigned face) const override { return chip_->value(face) + (now() < from_ ? 0 : 1); }
  Tick no_end_until() const override { return chip_->no_end_until(); }
  std::uint32_t peek(unsigned face, unsigned address) override {
    return chip_->peek(face, address) + (now() < from_ ? 0 : 1);
  }

 private:
  void take() {
    outputs_ = chip_->outputs();
    if (now() >= from_) outputs_[1] ^= 1;
  }
  std::unique_ptr<Chip> chip_;
  Tick from_;
  PinWords outputs_;
};

TEST(LockstepChip, SaysWhereTheEnginesDiffer) {
  BRICK_COVERS("CARD-2");
  in_own_process([] {
    const auto chip = lockstep_chip("interrupt_controller", rtl_interrupt_controller(1),
                                    std::make_unique<Distorted>(model_interrupt_controller(), 1234),
                                    InterruptController::pin_table());
    chip->set_inputs({interrupt_controller_words::kRstN.at(1)});
    chip->run_until(1233);
    std::string message;
    try {
      chip->run_until(2000);
    } catch (const sc_core::sc_report& report) { message = report.get_msg(); }
    EXPECT_EQ(message,
              "interrupt_controller: RTL and SystemC model differ at tick 1234 (10460 ns)\n  irq: rtl 0, systemc 1");
    EXPECT_THROW(chip->peek(0, 2), sc_core::sc_report) << "a register";
  });
}

}  // namespace
}  // namespace brick::component
