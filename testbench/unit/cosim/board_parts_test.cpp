// An event of the model's board concerns the parts that have changed: what they show goes to the pins and to the inputs
// of other blocks that hang on them, and nobody else is touched (systemc/board/board_top.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "systemc/board/board_top.h"
#include "systemc/core/start_value.h"

namespace brick {

// The inside of a board at rest. What is told wrongly stays wrong until somebody wires it anew.
class BoardProbe {
 public:
  struct Part {
    std::string name;
    unsigned bit;
    BoardOutputs pins;  // that it shows
  };
  static std::vector<Part> parts() {
    using B = BoardTop;
    const BoardOutputs port_a = select_pins(pin::kPaData, pin::kPaDataOe, pin::kPaTaN, pin::kBusyHost, pin::kBusyCpu);
    const BoardOutputs pic = select_pins(pin::kPicIst, pin::kPicSig, pin::kPicMsk, pin::kPicElr);
    return {
        {"bus_sync", B::kBusSync, port_a},
        {"isa_slave", B::kIsaSlave, select_pins(pin::kIsaSd, pin::kIsaSdOe, pin::kIsaIochrdy, pin::kIsaMemcs16N)},
        {"host_port", B::kHostPort, {}},  // while it does nothing
        {"dpram", B::kDpram, port_a},
        {"clock_select", B::kClockSelect,
         select_pins(pin::kPhase, pin::kServo, pin::kPhaseSource, pin::kSourceConflict)},
        {"watchdog", B::kWatchdog,
         select_pins(pin::kCtrl0, pin::kCtrl1, pin::kWdo, pin::kWdTripped, pin::kWdRelay, pin::kWdLed)},
        {"interrupt_controller", B::kInterruptController, pic},
        {"pic_8259", B::kPic8259, pic},
        {"host_interrupt", B::kHostInterrupt, select_pins(pin::kIsaIrq)},
        {"host_signals", B::kHostSignals,
         select_pins(pin::kBreq, pin::kIpos, pin::kEror, pin::kF1er, pin::kCtrl0, pin::kCtrl1)},
        {"panel_port", B::kPanelPort, select_pins(pin::kBrldN, pin::kErldN, pin::kF1ldN, pin::kIpldN)},
        {"ssi", B::kSsi, select_pins(pin::kSsiClk)},
        {"IC clocks", B::kIcClocks, {}},
        {"pins of Port A", B::kPortAPins, port_a},
        {"pins of ISA", B::kIsaPins, {}},
        {"connector", B::kConnectorPins, {}},
        {"straps", B::kStraps, pic},
    };
  }

  struct Wire {
    std::string name;
    std::uint32_t sources;       // bits of the parts
    std::function<void()> turn;  // makes it wrong, or right again
    std::function<unsigned()> value;
  };
  std::vector<Wire> wires() {
    using B = BoardTop;
    std::vector<Wire> list;
    const auto add = [&list](std::uint32_t sources, auto&... fields) {
      const auto one = [&](auto& field) {
        using Field = std::remove_reference_t<decltype(field)>;
        list.push_back({"", sources, [&field] { field = static_cast<Field>(field ^ 1); },
                        [&field] { return static_cast<unsigned>(field); }});
      };
      (one(fields), ...);
    };
    const auto of = [](auto... part) { return ((1u << part) | ...); };
    B& b = *board_;
    auto& isa = b.isa_slave_.in;
    auto &hp = b.host_port_.in, &hp_of_cpu = hp;
    auto& ram = b.dpram_.in;
    auto& own = b.interrupt_controller_.in;
    auto& old = b.pic_8259_.in;
    auto& select = b.clock_select_;
    const std::uint32_t access = of(B::kBusSync, B::kStraps), ics = of(B::kIcClocks, B::kConnectorPins, B::kStraps),
                        lines = of(B::kHostSignals, B::kWatchdog, B::kConnectorPins, B::kStraps),
                        panel = of(B::kHostSignals, B::kConnectorPins, B::kStraps),
                        serial = of(B::kClockSelect, B::kConnectorPins, B::kStraps);
    add(access, b.host_signals_.in.wr, b.host_signals_.in.ctrl_wr, b.host_signals_.in.wdata, b.watchdog_.strobe);
    add(access, hp_of_cpu.dsp_sel, hp.dsp_we, hp.dsp_rd, hp.dsp_addr, hp.dsp_wdata);
    add(of(B::kStraps), b.gate_ics_.macro_gates_, ram.small, own.addr, own.wdata, old.addr, old.wdata);
    add(ics, select.in.phase, select.in.servo, select.in.ext, select.phase_level, select.servo_level);
    add(ics, select.ext_phase, select.ext_servo);
    add(of(B::kClockSelect), b.gate_ics_.phase_, b.gate_ics_.servo_, b.watchdog_.servo);
    add(of(B::kConnectorPins), b.watchdog_.pwr_good);
    add(of(B::kWatchdog), b.gate_ics_.trip_, b.host_signals_.in.trip);
    add(of(B::kIsaSlave), hp.hp_sel, hp.hp_rd, hp.hp_rd_done, hp.hp_wr, hp.hp_addr, hp.hp_wdata, hp.hp_reset);
    add(of(B::kIsaSlave), ram.mem_sel, ram.mem_wr);
    add(0, ram.mem_rd, ram.mem_addr, ram.mem_be, ram.mem_wdata);  // of no cycle of the RAM
    add(of(B::kIsaSlave, B::kStraps), own.wr, own.reset, old.rd, old.wr);
    add(lines | of(B::kIsaSlave, B::kHostPort), own.line, old.line);
    add(lines, b.lines_);
    add(of(B::kInterruptController, B::kPic8259, B::kStraps), b.host_interrupt_.in.request, b.host_interrupt_.in.served,
        isa.pic_rdata);
    add(of(B::kIsaPins), isa.isa_sa, isa.isa_sd, isa.io_base, isa.window);
    add(of(B::kHostPort), isa.hp_rdata);
    add(of(B::kDpram), isa.mem_rdata, isa.mem_busy);
    add(panel, b.panel_port_.jpan, b.panel_port_.fitted, b.panel_port_.breq, b.panel_port_.eror);
    add(panel, b.panel_port_.f1er, b.panel_port_.ipos);
    add(inputs_.ssi_kind != 0 ? serial : 0, b.ssi_.geo, b.ssi_.phase, b.ssi_.servo, b.ssi_.data);
    for (std::size_t i = 0; i < list.size(); ++i) list[i].name = "wire " + std::to_string(i);
    return list;
  }

  explicit BoardProbe(std::uint8_t ssi_kind) : board_(std::make_unique<BoardTop>(name(), 0x40003)) {
    inputs_.fitted = 0x40003;  // two servo ICs and MACRO IC 0
    inputs_.ssi_kind = ssi_kind;
    set();
    board_->run_until(8);
    inputs_.rst_n = true;
    set();
    board_->run_until(200);
    rest();
  }
  void set() { board_->set_inputs(inputs_); }
  BoardInputs& inputs() { return inputs_; }
  BoardTop& board() { return *board_; }

  BoardOutputs shown() const { return board_->outputs_; }
  // The pins that follow when `changed` has changed and all that was shown was wrong.
  BoardOutputs pins(std::uint32_t changed) {
    const BoardOutputs right = shown();
    board_->outputs_ = inverse(right);
    const BoardOutputs after = board_->pins(changed);
    board_->outputs_ = right;
    BoardOutputs followed;
    for (unsigned i = 0; i < kBoardOutputWords; ++i) followed.w[i] = ~(after.w[i] ^ right.w[i]);
    return followed;
  }
  void connect(std::uint32_t changed, bool strobe) {
    board_->touched_ = 0;
    board_->strobe_wired_ = strobe;
    board_->connect(changed);
  }
  std::uint32_t touched() const { return board_->touched_; }
  std::uint32_t interrupting() const { return board_->gate_ics_.interrupting_; }
  std::uint32_t lines() const { return board_->selected_lines(); }
  std::uint32_t drives() const { return board_->gate_ics_.drives_; }
  void write_ic(unsigned ic, unsigned offset, std::uint32_t value) {
    board_->gate_ics_.write(ic, true, offset, value, board_->now_);
  }
  void wake() { board_->next_own_ = board_->now_ + 1; }
  // Of the blocks that are looked at seldom one is to do something at `next`, the first of them at `seldom`.
  bool due(Tick next, Tick seldom, Tick t) {
    board_->next_.fill(kNever);
    board_->next_[BoardTop::kSsi] = next;
    board_->seldom_ = seldom;
    return board_->due(t) != 0;
  }
  Tick seldom_behind(bool ssi) {
    board_->seldom_ = 5;
    board_->schedule(1u << (ssi ? BoardTop::kSsi : BoardTop::kDpram));
    return board_->seldom_;
  }
  std::size_t history() const { return board_->gate_ics_.history_.size(); }
  void clocks(bool phase, bool servo, Tick t) { board_->gate_ics_.set_clocks(phase, servo, t); }
  void rest() {  // all edges are over
    board_->each_block(BoardTop::kEveryBlock, [this](unsigned, auto& block) { block.advance(board_->now_); });
  }
  bool straps_differ() const { return board_->straps_differ_; }
  bool& panel_fitted() { return board_->panel_port_.fitted; }
  std::uint32_t& isa_address() { return board_->isa_slave_.in.isa_sa; }
  std::uint16_t& cpu_data() { return board_->dpram_.in.cpu_wdata; }
  // The buses' blocks that the pins of Port A have touched, and whether a pin follows them without a clock.
  std::string touched(const BoardInputs& inputs) {
    board_->touched_ = 1u << BoardTop::kSsi;
    board_->set_port_a(inputs);
    const std::uint32_t all = board_->touched_;
    return std::string((all >> BoardTop::kBusSync & 1) != 0 ? "bus_sync " : "") +
           ((all >> BoardTop::kDpram & 1) != 0 ? "dpram " : "") +
           ((all & ~(1u << BoardTop::kBusSync | 1u << BoardTop::kDpram)) != 0 ? "others " : "") +
           (board_->next_own_ == kNever             ? ""
            : board_->next_own_ == board_->now_ + 1 ? "at once"
                                                    : "at another time");
  }
  static constexpr std::uint32_t kEverything = BoardTop::kEverything, kIsaPins = 1u << BoardTop::kIsaPins,
                                 kIsaSlave = 1u << BoardTop::kIsaSlave, kBusSync = 1u << BoardTop::kBusSync,
                                 kHostPort = 1u << BoardTop::kHostPort;

 private:
  static sc_core::sc_module_name name() { return sc_core::sc_gen_unique_name("probed"); }
  static BoardOutputs inverse(BoardOutputs o) {
    for (std::uint32_t& word : o.w) word = ~word;
    return o;
  }
  std::unique_ptr<BoardTop> board_;
  BoardInputs inputs_;
};

namespace {

BoardOutputs all_pins() {
  BoardOutputs all;
  for (const PinField& field : pin::kAll) all.set(field, ~0u);
  return all;
}

std::string names(const BoardOutputs& select) {
  std::string list;
  for (const PinField& field : pin::kAll)
    if (select.get(field) != 0) list += " " + std::string(field.name);
  return list;
}

TEST(BoardParts, MoveThePinsThatTheyShowAndNoOthers) {
  BoardProbe probe(2);
  for (const BoardProbe::Part& part : BoardProbe::parts())
    EXPECT_EQ(names(probe.pins(1u << part.bit)), names(part.pins)) << part.name;
  EXPECT_EQ(names(probe.pins(0)), "");
  EXPECT_EQ(names(probe.pins(BoardProbe::kEverything)), names(all_pins()));
  // The host port alone has pins that follow an edge at which it did something.
  HostPort& port = probe.board().host_port();
  port.in.hp_sel = port.in.hp_wr = true;
  port.advance(next_ref_edge(probe.board().now()));
  EXPECT_EQ(names(probe.pins(BoardProbe::kHostPort)),
            names(select_pins(pin::kIrqHost, pin::kHreq, pin::kTxde, pin::kRxdf)));
  EXPECT_EQ(names(probe.pins(0)), "");
}

TEST(BoardParts, AreWiredToWhatHangsOnThemAndNothingElse) {
  for (const std::uint8_t ssi : {0, 2}) {
    BoardProbe probe(ssi);
    for (const BoardProbe::Wire& wire : probe.wires()) {
      const unsigned right = wire.value();
      const auto wired = [&](std::uint32_t changed, bool strobe) {
        wire.turn();
        probe.connect(changed, strobe);
        const bool is = wire.value() == right;
        if (!is) wire.turn();
        return is;
      };
      for (const BoardProbe::Part& part : BoardProbe::parts())
        ASSERT_EQ(wired(1u << part.bit, true), (wire.sources >> part.bit & 1) != 0)
            << wire.name << ", " << part.name << ", ssi " << unsigned{ssi};
      ASSERT_FALSE(wired(0, false)) << wire.name;
      ASSERT_FALSE(wired(BoardProbe::kBusSync, false)) << wire.name << ", without a strobe";
    }
  }
}

// A wire whose level stays touches nobody; the host bus is taken over as it is.
TEST(BoardParts, AreTouchedByWiresThatMove) {
  BoardProbe probe(2);
  probe.connect(BoardProbe::kEverything & ~BoardProbe::kIsaPins, true);
  EXPECT_EQ(probe.touched(), 0u);
  probe.connect(BoardProbe::kEverything, true);
  EXPECT_EQ(probe.touched(), BoardProbe::kIsaSlave);
  probe.set();
  EXPECT_EQ(probe.touched(), 0u);
}

// The list of the clocks' edges ends with a long regular stretch, and then only.
TEST(BoardParts, CatchUpWithALongRegularStretch) {
  BoardProbe probe(0);
  Tick t = probe.board().now();
  bool phase = true, servo = true;
  const auto edge = [&](Tick after) {
    phase = !phase;
    if (!phase) servo = !servo;
    probe.clocks(phase, servo, t += after);
  };
  const std::size_t before = probe.history();
  for (int n = 0; n < 200; ++n) edge(99);
  EXPECT_EQ(probe.history(), before + 200);
  edge(100);
  EXPECT_EQ(probe.history(), 1u);
  edge(99);
  EXPECT_EQ(probe.history(), 2u);
}

// Blocks with little to do are looked at when one of them has, and asked when one of them moves.
TEST(BoardParts, SeldomBlocksAreLeftAlone) {
  BoardProbe probe(0);
  EXPECT_FALSE(probe.due(7, 9, 8));
  EXPECT_TRUE(probe.due(7, 7, 8));
  EXPECT_FALSE(probe.due(9, 8, 8));
  EXPECT_EQ(probe.seldom_behind(false), 5);
  EXPECT_GT(probe.seldom_behind(true), 1000);
}

// At an edge of clk_ref, whatever else wakes the board.
TEST(BoardParts, StrapsAreTakenByClkRef) {
  for (Tick at = 0; at < kTicksPerRef; ++at) {
    BoardProbe probe(0);
    BoardTop& board = probe.board();
    board.run_until(300 + at);
    probe.inputs().line_select = 0x2951;  // EQU1, EQU5 and the watchdog; it has three digits
    probe.set();
    for (Tick t = 300 + at; t < next_ref_edge(300 + at); ++t) {
      ASSERT_EQ(board.now(), t);
      EXPECT_TRUE(probe.straps_differ());
      probe.wake();
      board.run_until(t + 1);
    }
    EXPECT_FALSE(probe.straps_differ());
    EXPECT_EQ(probe.interrupting(), 0x11u);
  }
}

// EQU of ICs that are fitted, by the three digits of line_select.
TEST(BoardParts, LinesAreOfIcsThatAreFitted) {
  constexpr std::uint32_t kSet =
      regs::servo_channel::control::kEquWrite.mask() | regs::servo_channel::control::kEquState.mask();
  BoardProbe probe(0);
  BoardTop& board = probe.board();
  const auto strap = [&](std::uint32_t fitted, std::uint16_t lines) {
    probe.inputs().fitted = fitted;
    probe.inputs().line_select = lines;
    probe.set();
    board.run_until(board.now() + 6);
    return probe.lines();
  };
  for (const unsigned ic : {0u, 1u}) probe.write_ic(ic, 5, kSet);  // EQU1, EQU5
  for (std::uint32_t fitted = 0; fitted < 4; ++fitted) {
    EXPECT_EQ(strap(fitted, 0x1051), fitted);
    EXPECT_EQ(strap(fitted, 0x5160), fitted << 2 & 4) << "EQU6 is off";
  }
}

// An IC drives the clocks from its word on until it has let them go.
TEST(BoardParts, DriversAreThoseThatDrive) {
  BoardProbe probe(0);
  BoardTop& board = probe.board();
  EXPECT_EQ(probe.drives(), 0u);
  probe.write_ic(1, 0x0C, 0);
  EXPECT_EQ(probe.drives(), 0u);
  probe.write_ic(1, 4, 0x0008D2);
  EXPECT_EQ(probe.drives(), 2u);
  board.run_until(board.now() + 200'000);
  EXPECT_EQ(probe.drives(), 2u);
  probe.write_ic(1, 4, 0x0038D2);
  board.run_until(board.now() + 400'000);
  EXPECT_EQ(probe.drives(), 0u);
}

// What an IC has done before a reset counts, though nobody has asked; and in the reset nothing is to come.
TEST(BoardParts, AResetEndsWhatWasUnderWay) {
  PwmTimes times[2];
  for (const bool asked : {false, true}) {
    BoardProbe probe(0);
    BoardTop& board = probe.board();
    MotorDigest& digest = *board.motor_digest();
    board.servo_ic(0)->write(false, 2, 0x300000);
    board.run_until(90'000);
    if (asked) digest.pwm_times(0, 0);
    const BoardOutputs any = select_pins(pin::kBreq);
    probe.inputs().rst_n = false;
    probe.set();
    EXPECT_EQ(board.quiet_until(any), 90'000);
    board.run_until(90'010);
    EXPECT_EQ(board.quiet_until(any), kNever);
    probe.inputs().rst_n = true;
    probe.set();
    const Tick end = next_ref_edge(90'010) + kTicksPerRef + 2;
    EXPECT_EQ(board.quiet_until(any), end);
    board.run_until(end + 1);
    EXPECT_GT(board.quiet_until(any), end + 1);
    times[asked] = digest.pwm_times(0, 0);
  }
  EXPECT_EQ(times[0].balance, times[1].balance);
  EXPECT_NE(times[0].balance[0], 0);
}

// The dual-ported RAM begins with what the seed of the board makes of it (systemc/core/start_value.h).
TEST(BoardParts, TheRamBeginsByTheSeed) {
  for (const std::uint64_t seed : {1, 2}) {
    BoardTop board(sc_core::sc_gen_unique_name("seeded"), 0x3, seed);
    for (const unsigned word : {0u, 1u, 12345u, Dpram::kWords - 1})
      EXPECT_EQ(board.dpram_word(word), start_word(start_seed(seed), word)) << seed << ", " << word;
  }
}

// Numbers of ICs that there are not, of servo ICs and of MACRO ICs, and those of ICs that are not built.
TEST(BoardParts, OfNoIcAreNone) {
  BoardProbe probe(0);
  BoardTop& board = probe.board();
  unsigned changes = 0;
  board.on_motor_change = [&](Tick, unsigned, const MotorOutputs&, const MotorOutputs&) { ++changes; };
  MotorInputs moved;
  moved.pins.fill(0xFFF);
  MotorDigest& digest = *board.motor_digest();
  for (const unsigned ic : {2u, 17u, 18u, 19u, 22u}) {
    board.set_motor_inputs(ic, moved);
    board.watch_motor(ic, kAllMotorOutputs);
    board.stop_on_motor(ic, kAllMotorOutputs);
    EXPECT_EQ(board.motor_outputs(ic), MotorOutputs{});
    EXPECT_EQ(board.servo_ic(ic), nullptr);
    EXPECT_EQ(digest.dac_lines(ic), ConverterWords{});
    EXPECT_EQ(digest.adc_stream(ic).clocks, 0);
    EXPECT_EQ(digest.adc_lines(ic, true), 0u);
    EXPECT_EQ(digest.pwm_times(ic, 0).shorts, 0u);
    digest.send_adc(ic, {});
  }
  for (const unsigned ic : {1u, 3u, 4u, 5u}) EXPECT_EQ(board.macro_ic(ic), nullptr);
  EXPECT_NE(board.macro_ic(0), nullptr);
  EXPECT_NE(board.servo_ic(0), nullptr);
  EXPECT_NE(board.servo_ic(1), nullptr);
  board.run_until(board.now() + 50'000);
  EXPECT_EQ(changes, 0u);
}

// Inputs that stay as they are are not looked at, of those that move their own group.
TEST(BoardParts, GroupsOfInputsThatMoveAreWired) {
  BoardProbe probe(0);
  bool &panel = probe.panel_fitted(), panel_is = panel;
  std::uint32_t &isa = probe.isa_address(), isa_is = isa;
  std::uint16_t& cpu = probe.cpu_data();
  BoardInputs& in = probe.inputs();
  const auto wired = [&](const std::function<void()>& move) {
    move();
    panel = !panel_is;
    isa = isa_is ^ 1;
    cpu = static_cast<std::uint16_t>(in.pa_wdata ^ 1);
    probe.rest();
    probe.set();
    const std::string groups = std::string(panel == panel_is ? "connector " : "") + (isa == isa_is ? "ISA " : "") +
                               (cpu == (in.pa_wdata & 0xFFFF) ? "Port A " : "") +
                               (probe.straps_differ() ? "straps" : "");
    panel = panel_is;
    isa = isa_is;
    return groups;
  };
  EXPECT_EQ(wired([] {}), "");
  EXPECT_EQ(wired([&] { in.pa_wdata = 5; }), "Port A ");
  EXPECT_EQ(wired([&] { in.isa_sd = 5; }), "ISA ");
  EXPECT_EQ(wired([&] { in.window = 5; }), "ISA ");
  EXPECT_EQ(wired([&] { in.mi1 = true; }), "connector ");
  EXPECT_EQ(wired([&] { in.dpram_small = true; }), "straps");
  EXPECT_EQ(wired([&] { in.mi2 = true; }), "connector straps") << "until an edge of clk_ref takes them";
  EXPECT_EQ(wired([&] { in.dpram_small = false; }), "") << "as they were";
  EXPECT_EQ(wired([&] { in.rst_n = false; }), "Port A ");
}

// Addresses and data are of no interest until a strobe falls, but to the RAM while it is selected.
TEST(BoardParts, PortATouchesTheBlocksThatTakeNotice) {
  BoardProbe probe(0);
  BoardInputs& in = probe.inputs();
  const auto run = [&](Tick ticks) { probe.board().run_until(probe.board().now() + ticks); };
  EXPECT_EQ(probe.touched(in), "");
  in.pa_addr = 0x70010;
  in.pa_wdata = 1;
  in.pa_x = true;
  EXPECT_EQ(probe.touched(in), "");
  in.pa_wr_n = false;
  EXPECT_EQ(probe.touched(in), "bus_sync dpram ");
  run(1);
  in.pa_wdata = 2;
  EXPECT_EQ(probe.touched(in), "bus_sync ") << "a write is on its way";
  run(20);
  in.pa_wdata = 3;
  EXPECT_EQ(probe.touched(in), "") << "it is over";
  in.pa_wr_n = true;
  EXPECT_EQ(probe.touched(in), "bus_sync dpram ");
  in.pa_aa = 4;
  EXPECT_EQ(probe.touched(in), "dpram ");
  in.pa_addr = 0x60000;
  EXPECT_EQ(probe.touched(in), "dpram ");
  in.pa_aa = 0;
  EXPECT_EQ(probe.touched(in), "dpram ") << "it was selected";
  EXPECT_EQ(probe.touched(in), "");
  in.pa_addr = 0x70010;
  in.pa_rd_n = false;
  EXPECT_EQ(probe.touched(in), "bus_sync dpram ") << "D is driven from the sample on";
  run(20);
  EXPECT_EQ(probe.shown().get(pin::kPaDataOe), 1u);
  EXPECT_EQ(probe.touched(in), "");
  in.pa_rd_n = true;
  EXPECT_EQ(probe.touched(in), "bus_sync dpram at once") << "D is let go";
  run(1);
  EXPECT_EQ(probe.touched(in), "");
  in.pa_aa = 4;
  in.pa_rd_n = false;
  EXPECT_EQ(probe.touched(in), "bus_sync dpram at once") << "the RAM makes it wait";
}

}  // namespace
}  // namespace brick
