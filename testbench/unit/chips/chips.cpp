#include "testbench/unit/chips/chips.h"

#include <Vboard_chip.h>
#include <Vboard_chip___024root.h>
#include <Vservo_ic_chip.h>
#include <Vservo_ic_chip___024root.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "rtl/pins/board_ports.hpp"
#include "systemc/core/start_value.h"
#include "systemc/cosim/drive.h"
#include "systemc/cosim/verilated_module.h"

namespace brick {

struct BoardChip : VerilatedModule<Vboard_chip> {
  using VerilatedModule::VerilatedModule;
};
struct ServoIcChip : VerilatedModule<Vservo_ic_chip> {
  using VerilatedModule::VerilatedModule;
};

namespace {

constexpr unsigned kNumberPlanted = 2;
constexpr unsigned kEquLsb = 44;  // of motor_o
constexpr unsigned kDpramWords = 32768;

// D as the CPU drives it; nothing that takes it looks during a read.
void drive_port_a(Vservo_ic_chip& chip, const BoardInputs& in) {
  chip.pa_addr_i = in.pa_addr;
  chip.pa_x_i = in.pa_x;
  chip.pa_aa_i = in.pa_aa;
  chip.pa_int_i = in.pa_int;
  chip.pa_rd_ni = in.pa_rd_n;
  chip.pa_wr_ni = in.pa_wr_n;
  chip.pa_wdata_i = in.pa_wdata;
}

}  // namespace

Chips::Chips(std::uint32_t fitted, std::uint64_t seed, ChipFault fault)
    : board_(std::make_unique<BoardChip>(seed)), ics_(kMaxServoIcs), fault_(fault), fitted_(fitted) {
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if ((fitted >> ic & 1) != 0) ics_[ic] = std::make_unique<ServoIcChip>(seed == 0 ? 0 : seed + 1 + ic);
  auto& memory = (*board_)->rootp->board_chip__DOT__u_core__DOT__u_dpram__DOT__u_memory__DOT__mem;
  for (unsigned i = 0; i < kDpramWords; ++i) memory[i] = start_word(start_seed(seed), i);
  power_on();
}

Chips::~Chips() = default;

// A simulator's flip-flops are reset by the fall of a reset, which must have been high: the clocks run for a while.
void Chips::power_on() {
  in_.fitted = present_ = fitted_;
  in_.rst_n = true;
  in_.pa_rd_n = false;  // so that it rises, as what it holds off
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) set_motor_inputs(ic, {});
  for (const bool high : {true, false}) {
    in_.rst_n = high;
    in_.pa_rd_n = !high;
    set_inputs(in_);
    for (unsigned i = 0; i < 4 * kTicksPerRef; ++i) tick();
  }
  take_contention();  // before a reset anything may be
  now_ = 0;
}

void Chips::set_inputs(const BoardInputs& in) {
  const bool now = in.rst_n != in_.rst_n || in.pa_rd_n != in_.pa_rd_n || in.pa_wr_n != in_.pa_wr_n;
  if (in.fitted != in_.fitted && in.rst_n) throw std::logic_error("a chip is pulled or put in while the power is on");
  in_ = in;
  present_ = in.fitted & fitted_;
  BoardInputs straps = in;
  if (fault_ == ChipFault::kStrapLeft) straps.fitted = fitted_;
  drive_ports(**board_, straps);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if (!has(ic)) continue;
    Vservo_ic_chip& chip = **ics_[ic];
    chip.number_i = static_cast<std::uint8_t>(fault_ == ChipFault::kWrongNumber && ic == 1 ? kNumberPlanted : ic);
    drive_port_a(chip, in);
  }
  settled_ = false;
  if (now) at_once();
}

void Chips::set_motor_inputs(unsigned ic, const MotorInputs& in) {
  if (ic < kMaxServoIcs && ics_[ic] != nullptr) (*ics_[ic])->motor_i = pack(in);
}

void Chips::tick() {
  const bool ref = ++now_ % kTicksPerRef == 0;
  board_->edge(true, ref);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if (has(ic)) ics_[ic]->edge(true, ref);
  const Wires before = last_;
  last_ = driven();
  join(before);
  settled_ = true;
}

BoardOutputs Chips::at_once() {
  if (!settled_) {
    (*board_)->eval();
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      if (has(ic)) (*ics_[ic])->eval();
    join(wires_);
    settled_ = true;
  }
  return outputs();
}

void Chips::report(const std::string& wire, const std::string& drivers) {
  if (std::find(reported_.begin(), reported_.end(), wire) != reported_.end()) return;
  reported_.push_back(wire);
  contention_.push_back(fmt::format("{}:{} at tick {}", wire, drivers, now_));
}

std::vector<std::string> Chips::take_contention() {
  reported_.clear();
  return std::exchange(contention_, {});
}

// Pulled up; low in contention, of which nobody can say what it is.
bool Chips::clock_wire(bool servo) {
  struct Driver {
    unsigned ic;
    bool level;
  };
  std::array<Driver, kMaxServoIcs + 1> drivers;
  unsigned count = 0, high = 0;
  const auto drives = [&](unsigned ic, bool level) {
    drivers[count++] = {ic, level};
    high += level;
  };
  const Vboard_chip& board = **board_;
  if (servo ? board.servo_oe_o : board.phase_oe_o) drives(kMaxServoIcs, servo ? board.servo_o : board.phase_o);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if (!has(ic)) continue;
    const Vservo_ic_chip& chip = **ics_[ic];
    bool oe = servo ? chip.servo_oe_o : chip.phase_oe_o;
    if (ic == 0 && fault_ == (servo ? ChipFault::kServoNeverTurns : ChipFault::kPhaseNeverTurns)) oe = false;
    if (oe) drives(ic, servo ? chip.servo_o : chip.phase_o);
  }
  if (high == count) return true;
  if (high != 0) {
    std::string who;
    for (unsigned i = 0; i < count; ++i)
      who += fmt::format(" {} {}", drivers[i].ic == kMaxServoIcs ? "board" : servo_ic_scope(drivers[i].ic),
                         int{drivers[i].level});
    report(servo ? "SERVO" : "PHASE", who);
  }
  return false;
}

Chips::Wires Chips::driven() {
  Wires w;
  w.phase = clock_wire(false);
  w.servo = clock_wire(true);
  w.trip = (*board_)->wdo_o;
  w.rst_ref_n = (*board_)->rst_ref_no;
  const unsigned swap = fault_ == ChipFault::kSwappedEqu ? 1 : 0;
  for (unsigned ic = 0; ic < 2; ++ic)
    if (has(ic)) w.equ |= static_cast<std::uint8_t>(((*ics_[ic])->motor_o >> kEquLsb & 0xF) << 4 * (ic ^ swap));
  return w;
}

// True when a pad has moved.
bool Chips::apply(const Wires& w) {
  bool moved = false;
  const auto set = [&moved](auto& pad, auto level) {
    if (pad == level) return false;
    pad = level;
    moved = true;
    return true;
  };
  Vboard_chip& b = **board_;
  set(b.phase_i, w.phase);
  set(b.servo_i, w.servo);
  set(b.equ_i, w.equ);
  if (moved) b.eval();
  bool any = moved;
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
    if (!has(ic)) continue;
    Vservo_ic_chip& chip = **ics_[ic];
    moved = false;
    set(chip.phase_i, w.phase);
    set(chip.servo_i, w.servo);
    set(chip.trip_i, w.trip && !(fault_ == ChipFault::kNoTrip && ic == 1));
    set(chip.rst_ref_ni, w.rst_ref_n);
    if (moved) chip.eval();
    any |= moved;
  }
  wires_ = w;
  return any;
}

// What the chips drive arrives, and what moves by it without an edge. `late`: what arrives of the wires that are late.
void Chips::join(Wires late) {
  for (;;) {
    Wires w = driven();
    if (fault_ == ChipFault::kLateClocks) w.phase = late.phase, w.servo = late.servo;
    if (fault_ == ChipFault::kLateReset) w.rst_ref_n = late.rst_ref_n;
    if (!apply(w)) break;
  }
  join_data();
}

// D as the chips drive it.
void Chips::join_data() {
  drivers_ = 0;
  std::string who;
  const auto drives = [&](const std::string& name, std::uint32_t data) {
    if (drivers_++ != 0 && data != data_) who += fmt::format(" {} ${:06X}", name, data);
    data_ = data;
  };
  driven_by_board_ = (*board_)->pa_data_oe_o;
  if (driven_by_board_) drives("board", (*board_)->pa_data_o);
  for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
    if (has(ic) && (*ics_[ic])->pa_data_oe_o) drives(servo_ic_scope(ic), (*ics_[ic])->pa_data_o);
  if (!who.empty()) report("D", who);
}

BoardOutputs Chips::outputs() const {
  BoardOutputs out;
  read_ports(**board_, out);
  out.set(pin::kPhase, wires_.phase);
  out.set(pin::kServo, wires_.servo);
  out.set(pin::kPaData, data_);
  out.set(pin::kPaDataOe, drivers_ != 0);
  return out;
}

MotorOutputs Chips::motor_outputs(unsigned ic) const {
  MotorOutputs out;
  if (ic >= kMaxServoIcs || !has(ic)) return out;
  const std::uint64_t pins = (*ics_[ic])->motor_o;
  out.w[0] = static_cast<std::uint32_t>(pins);
  out.w[1] = static_cast<std::uint32_t>(pins >> 32);
  return out;
}

}  // namespace brick
