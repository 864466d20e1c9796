// The board's component against the board of the model, on random traffic at Port A, at the ISA bus and on the motor
// side. What a board sees at which tick is written down by a board in between, then played to the ports.
#include <gtest/gtest.h>

#include <brick/board.h>
#include <brick/rtl.h>

#include "rtl/regs/brick_regs.hpp"
#include "systemc/board/model_board.h"
#include "systemc/component/board/board_chip.h"
#include "systemc/component/board/board_options.h"
#include "systemc/component/board/board_words.h"
#include "systemc/cosim/drive.h"
#include "testbench/unit/component/own_process.h"
#include "testbench/unit/component/rig.h"
#include "testbench/unit/cosim/board_traffic.h"
#include "testbench/unit/cosim/motor_traffic.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/random_seed.h"

namespace brick::component {
namespace {

constexpr std::uint32_t kFitted = 0x3;
using Pins = std::vector<std::string>;

// Names of the component's ports where they differ from those of core/board_pins.h.
const std::map<std::string, std::string> kPorts{{"pa_wdata", "pa_data_i"},
                                                {"isa_sd", "isa_sd_i"},
                                                {"bus.rdata", "pa_data_o"},
                                                {"bus.rdata_oe", "pa_data_oe"},
                                                {"bus.ta_n", "pa_ta_n"},
                                                {"cpu.irq_host", "irq_host"},
                                                {"clock.phase", "phase"},
                                                {"clock.servo", "servo"},
                                                {"host.breq", "breq"},
                                                {"host.ipos", "ipos"},
                                                {"host.eror", "eror"},
                                                {"host.f1er", "f1er"},
                                                {"host.isa.rdata", "isa_sd_o"},
                                                {"host.isa.sd_oe", "isa_sd_oe"},
                                                {"host.isa.iochrdy", "isa_iochrdy"},
                                                {"host.isa.memcs16_n", "isa_memcs16_n"},
                                                {"host.irq", "isa_irq"},
                                                {"host.hreq", "hreq"},
                                                {"host.wdo", "wdo"},
                                                {"watchdog.tripped", "wd_tripped"},
                                                {"watchdog.relay", "wd_relay"},
                                                {"watchdog.led", "wd_led"},
                                                {"host.brld_n", "brld_n"},
                                                {"host.erld_n", "erld_n"},
                                                {"host.f1ld_n", "f1ld_n"},
                                                {"host.ipld_n", "ipld_n"},
                                                {"host.ctrl0", "ctrl0"},
                                                {"host.ctrl1", "ctrl1"},
                                                {"dpram.busy_host", "busy_host"},
                                                {"dpram.busy_cpu", "busy_cpu"},
                                                {"clock.source_ic", "phase_source"},
                                                {"clock.conflict", "source_conflict"},
                                                {"host.port.txde", "txde"},
                                                {"host.port.rxdf", "rxdf"},
                                                {"ssi.clk", "ssi_clk"}};
std::string port(std::string_view name) {
  const auto place = kPorts.find(std::string(name));
  return place == kPorts.end() ? std::string(name) : place->second;
}

// Passes everything on and writes it down: inputs at a time between two edges, outputs at that of their edge.
class Recorder final : public brick::Board {
 public:
  Recorder(std::uint32_t fitted, const Binds& binds) : binds_(binds), board_(make_model_board(fitted)) {
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      if ((fitted >> ic & 1) != 0) board_->watch_motor(ic, kAllMotorOutputs);
    board_->on_change = [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) {
      for (const PinField& f : pin::kAll)
        if (before.get(f) != after.get(f)) note(t, port(f.name), after.get(f));
    };
    board_->on_motor_change = [this](Tick t, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
      for (const MotorField& f : motor_pin::kAll)
        for (unsigned n = 0; f.width == 1 && n < (f.shared ? 1 : kChannels); ++n)
          if (before.get(f, n) != after.get(f, n))
            note(t, motor_port(ic, f.shared ? std::string(f.name) : channel(n, f.name)), after.get(f, n));
    };
  }
  Tick now() const override { return board_->now(); }
  const BoardOutputs& outputs() const override { return board_->outputs(); }
  Tick run_until(Tick limit, const BoardOutputs& stop_on) override { return board_->run_until(limit, stop_on); }
  void set_inputs(const BoardInputs& in) override {
    board_->set_inputs(in);
    next_call();
    std::apply(
        [&](const auto&... f) {
          ((in.*f.pin != inputs_.*f.pin ? drive(port(f.name), static_cast<std::uint32_t>(in.*f.pin)) : void()), ...);
        },
        kInputFields);
    if (in.rst_n != inputs_.rst_n || first_) drive("rst_n", in.rst_n);
    inputs_ = in;
    first_ = false;
  }
  void set_motor_inputs(unsigned ic, const MotorInputs& in) override {
    board_->set_motor_inputs(ic, in);
    next_call();
    MotorInputs& old = motors_[ic];
    for (unsigned n = 0; n < kChannels; ++n) {
      for (unsigned i = 0; i < kChannelPins; ++i)
        if (((in.pins[n] ^ old.pins[n]) >> i & 1) != 0)
          drive(motor_port(ic, channel(n, kChannelPinNames[i])), in.pins[n] >> i & 1);
      if (((in.adc_a ^ old.adc_a) >> n & 1) != 0) drive(motor_port(ic, channel(n, "adc_a")), in.adc_a >> n & 1);
      if (((in.adc_b ^ old.adc_b) >> n & 1) != 0) drive(motor_port(ic, channel(n, "adc_b")), in.adc_b >> n & 1);
    }
    old = in;
  }

  Traffic traffic;
  Seen seen;

 private:
  static std::string channel(unsigned n, std::string_view name) {
    return "ch" + std::to_string(n + 1) + "_" + std::string(name);
  }
  static std::string motor_port(unsigned ic, const std::string& pin) { return servo_ic_scope(ic) + "_" + pin; }
  void note(Tick t, const std::string& pin, std::uint32_t value) {
    if (binds_(pin) && pin.rfind("host.pic", 0) != 0)  // no port
      seen.changes.emplace_back(edge_time(t), pin, value);
  }
  // The changes of one call are in one instant, at random between the two edges; those of the next call at the same
  // tick are later: a strobe that turns twice between two edges does turn.
  void next_call() {
    const Picoseconds last = edge_time(now() + 1) - 1;
    if (at_ != now())
      place_ = now() == 0 ? 0 : edge_time(now()) + random_() % 8000;
    else
      place_ = std::min(last, place_ + 1 + random_() % 40);
    at_ = now();
  }
  void drive(const std::string& pin, std::uint32_t value) {
    if (binds_(pin)) traffic.pins.push_back({place_, pin, value});
  }

  Binds binds_;
  std::unique_ptr<brick::Board> board_;
  BoardInputs inputs_;
  std::array<MotorInputs, kMaxServoIcs> motors_{};
  bool first_ = true;
  std::mt19937 random_{random_seed(7)};
  Tick at_ = -1;
  Picoseconds place_ = 0;
};

// `life` drives a board; each output in `moves` does so many times.
struct Life {
  std::uint32_t fitted;
  Tick ticks;
  std::function<void(brick::Board&, std::uint32_t fitted, Tick end)> live;
  Pins moves;
  std::size_t least;
};

void board_agrees(const Engine& engine, const Life& life, const Binds& binds) {
  Recorder recorder(life.fitted, binds);
  life.live(recorder, life.fitted, life.ticks);
  recorder.traffic.end = edge_time(life.ticks);
  counts(recorder.seen, life.moves, life.least);
  TimeBase time("time");
  Board board("board", time, {life.fitted, 0}, engine);
  const sc_core::sc_time quantum;
  Rig rig("rig", board, recorder.traffic, 0, quantum, binds);
  sc_core::sc_start(sc_core::sc_time::from_value(recorder.traffic.end - 1));
  EXPECT_EQ(difference(rig.seen, recorder.seen, recorder.traffic.end, binds), "");
}

bool no_serial_clocks(const std::string& pin) {
  return pin.find("dac") == std::string::npos && pin.find("adc_") == std::string::npos;
}
bool few(const std::string& pin) {
  return pin == "isa_irq" || pin == "phase" || (pin.rfind("servo_ic", 0) != 0 && pin.find("_o") == std::string::npos);
}

bool of_motors(const std::string& pin) { return pin.rfind("servo_ic", 0) == 0; }
// Inputs, and no output but the motors'.
bool motor_side(const std::string& pin) {
  return of_motors(pin) ||
         std::none_of(pin::kAll.begin(), pin::kAll.end(), [&pin](const PinField& f) { return port(f.name) == pin; });
}

// The outputs of the board's pin table, those of the motors or the others, without `still`.
Pins outputs(std::uint32_t fitted, bool motors, const Pins& still) {
  Pins found;
  for (const PinInfo& info : Board::pin_table(fitted))
    if (info.direction == PinDirection::kOut && of_motors(info.name) == motors &&
        std::find(still.begin(), still.end(), info.name) == still.end())
      found.push_back(info.name);
  return found;
}

Pins serial_clocks(std::uint32_t fitted) {
  Pins clocks;
  for (const std::string& pin : outputs(fitted, true, {}))
    if (pin.find("_clk") != std::string::npos) clocks.push_back(pin);
  return clocks;
}

void live_on_buses(brick::Board& board, std::uint32_t fitted, Tick end, Tick silent_at) {
  BoardTraffic::Options options;
  options.dense = silent_at == kNever;
  options.ics = fitted;
  options.silent_at = silent_at;
  BoardTraffic(11, options).run(board, end);
}

// Both buses, clocks from outside, straps. Nobody fails to strobe the watchdog for 25 ms.
Life buses(Tick ticks, std::size_t least, std::uint32_t fitted = kFitted) {
  const auto live = [](brick::Board& board, std::uint32_t ics, Tick end) { live_on_buses(board, ics, end, kNever); };
  return {fitted, ticks, live, outputs(fitted, false, {"wdo", "wd_tripped", "wd_led"}), least};
}

Life motors(Tick ticks, std::size_t least, std::uint32_t fitted = kFitted) {
  const auto live = [](brick::Board& board, std::uint32_t ics, Tick end) {
    MotorTrafficOptions options;
    options.ics = ics;
    MotorTraffic(12, options).run(board, end);
  };
  return {fitted, ticks, live, outputs(fitted, true, {}), least};
}

// Every motor output of every IC moves: the PWM of all channels, then their DACs and pulses, and so on; with each turn
// AENA, EQU and DIR turn too.
void live_on_outputs(brick::Board& board, std::uint32_t fitted, Tick end) {
  namespace ic = regs::servo_ic;
  namespace channel = regs::servo_channel;
  constexpr unsigned kMaxCount = 700;              // 24 bits of an ADC at 48 ticks go into a period of PHASE
  constexpr Tick kRest = 3 * (2 * kMaxCount + 3);  // three periods of PHASE
  BoardInputs in;
  in.fitted = fitted;
  board.set_inputs(in);
  start_clocks(board, in);
  const auto run = [&](Tick ticks) { board.run_until(std::min(end, board.now() + ticks)); };
  const auto write = [&](std::uint32_t address, bool x, std::uint32_t value) {
    const auto strobe = [&](bool high, Tick ticks) {
      in.pa_wr_n = high;
      board.set_inputs(in);
      run(ticks);
    };
    in.pa_addr = address, in.pa_x = x, in.pa_aa = 2, in.pa_wdata = value;
    strobe(true, 3);
    strobe(false, 12);
    strobe(true, 9);
  };
  const auto each_ic = [&](const auto& act) {
    for (unsigned i = 0; i < kMaxServoIcs; ++i)
      if ((fitted >> i & 1) != 0) act(regs::kGateIcs[i].base);
  };
  using namespace channel::control;
  const std::uint32_t pwm = kAena.mask() | kEquWrite.mask() | kEquState.mask(),
                      serial = kAbDac.mask() | kCPfm.mask() | kPfmDirInvert.mask() | kEquWrite.mask();
  each_ic([&](std::uint32_t base) {
    write(base + ic::kPwmControl.address, true, ic::pwm_control::kMaxCount.set(1, kMaxCount));
  });
  for (bool turn = false; board.now() < end; turn = !turn) {
    each_ic([&](std::uint32_t base) {
      for (unsigned first = base; first < base + 8 * kChannels; first += 8) {
        for (unsigned out = channel::kOutA.address; out <= channel::kOutC.address; ++out)
          write(first + out, false, turn ? 0x555540 : 100 << 8);  // bits of a DAC, a command of the PWM
        write(first + channel::kControl.address, true, turn ? serial : pwm);
      }
    });
    run(kRest);
  }
}

// The CPU rests for 25 ms, so the watchdog trips (servo-ic:10); a reset ends it.
Life trip() {
  constexpr Tick kSilent = 100'000, kTrip = 3'000'000;
  const auto live = [](brick::Board& board, std::uint32_t ics, Tick end) { live_on_buses(board, ics, end, kSilent); };
  return {kFitted, kSilent + kTrip + 400'000, live, {"wdo", "wd_tripped", "wd_led", "wd_relay"}, 2};
}

constexpr std::uint32_t kFourIcs = 0x4000F, kAllIcs = 0x3FFFFF;  // the other two Verilated boards

TEST(BoardComponent, ModelAgreesWithTheBoardOnItsBuses) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { board_agrees(model_engine(), buses(kTicks, 20), no_serial_clocks); });
}
TEST(BoardComponent, ModelAgreesWithTheBoardOnItsMotorSide) {
  BRICK_COVERS("CARD-1");
  in_own_process([] { board_agrees(model_engine(), motors(kTicks, 3), all); });
}
TEST(BoardComponent, MotorSideIsForeseenAlone) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    Life life = motors(kTicks / 4, 40);
    life.moves = {"servo_ic0_dac_clk", "servo_ic0_ch1_pwm_a_top", "servo_ic1_ch4_pwm_c_bot"};
    board_agrees(model_engine(), life, motor_side);
  });
}
TEST(BoardComponent, RtlAgreesWithTheBoard) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { board_agrees(rtl_engine(2), buses(kTicks, 20), no_serial_clocks); });
  in_own_process([] { board_agrees(rtl_engine(3), motors(kTicks, 3), all); });
}
TEST(BoardComponent, LockstepAgreesWithTheBoard) {
  BRICK_COVERS("CARD-1 CARD-2");
  in_own_process([] { board_agrees(lockstep_engine(4), motors(kTicks, 3), all); });
}
TEST(BoardComponent, EachVerilatedBoardAgrees) {
  BRICK_COVERS("CARD-1 CARD-2");
  for (const std::uint32_t fitted : {kFourIcs, kAllIcs}) {
    SCOPED_TRACE(::testing::Message() << "fitted " << fitted);
    in_own_process([=] {
      const Life life{fitted, kTicks / 20, live_on_outputs, outputs(fitted, true, {}), 3};
      board_agrees(lockstep_engine(5), life, all);
    });
    in_own_process([=] {
      Life life = motors(kTicks / 20, 100, fitted);
      life.moves = serial_clocks(fitted);
      board_agrees(lockstep_engine(6), life, all);
    });
    in_own_process([=] { board_agrees(lockstep_engine(7), buses(kTicks / 10, 3, fitted), no_serial_clocks); });
  }
}
TEST(BoardComponent, AgreesPastATripOfTheWatchdog) {
  BRICK_COVERS("CARD-1 CARD-2");
  for (const Engine& engine : {model_engine(), lockstep_engine(7)})
    in_own_process([&engine] { board_agrees(engine, trip(), no_serial_clocks); });
}
TEST(BoardComponent, UnboundPinsChangeNothing) {
  BRICK_COVERS("CARD-1");
  in_own_process([] {
    Life life = buses(kTicks, 100);
    life.moves = {"isa_irq", "phase"};
    board_agrees(model_engine(), life, few);
  });
}

TEST(BoardComponent, ADifferenceInLockstepIsAnErrorOfTheComponent) {
  BRICK_COVERS("CARD-2");
  in_own_process([] {
    RtlOptions bug;
    bug.seeded_bug = true;
    const auto chip = board_chip(make_lockstep_board(make_rtl_board(0x3, bug), make_model_board(0x3)), 0x3, false);
    PinWords inputs(board_words::motor_input(2));
    const auto set = [&](const std::string& pin, std::uint32_t value) {
      for (const PinInfo& info : Board::pin_table(0x3))
        if (info.name == pin) inputs[info.word] = (inputs[info.word] & ~(1u << info.lsb)) | value << info.lsb;
    };
    for (const PinInfo& info : Board::pin_table(0x3))
      if (info.direction == PinDirection::kIn) inputs[info.word] |= info.idle << info.lsb;
    set("ext_clock", 1);
    std::string type;
    try {
      for (unsigned i = 0; i < 20; ++i) {  // the fifth fall of SERVO is late
        set("ext_servo", i % 2);
        chip->set_inputs(inputs);
        chip->run_until(chip->now() + 500);
      }
    } catch (const sc_core::sc_report& report) { type = report.get_msg_type(); }
    EXPECT_EQ(type, "/brick/lockstep");
  });
}

TEST(BoardComponent, FlipFlopsStartByTheSeedOfTheEngine) {
  const RtlOptions options = board_options(5, 7);
  EXPECT_EQ(options.seed, 5u);
  EXPECT_EQ(options.ram_seed, 7u) << "the RAM by that of the board, as the model's";
  EXPECT_FALSE(options.seeded_bug);
}

TEST(BoardComponent, FittedHasTheBitsOfTheIcs) {
  BRICK_COVERS("CARD-1");
  for (const Engine& engine : {model_engine(), rtl_engine(), lockstep_engine()})
    in_own_process([&engine] {
      TimeBase time("time");
      BoardOptions options;
      options.fitted = 1u << 22 | 0x3;
      std::string type;
      try {
        Board board("board", time, options, engine);
      } catch (const sc_core::sc_report& report) { type = report.get_msg_type(); }
      EXPECT_EQ(type, "/brick/fitted");
    });
}

// A pin that is new in the table needs a port.
TEST(BoardComponent, EveryPinHasItsPort) {
  in_own_process([] {
    TimeBase time("time");
    Board board("board", time);
    std::size_t ports = 0;
    for (const PinInfo& info : Board::pin_table(0x3)) ports += info.direction != PinDirection::kInner;
    EXPECT_EQ(board.pins().size(), ports);
  });
}

}  // namespace
}  // namespace brick::component
