// Port A bus master: decoding, the edges of a cycle one after the other, wait states and /TA, see port_a.h.
#include "systemc/cpu/port_a.h"

#include <algorithm>
#include <cstring>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace {

constexpr std::uint32_t kWordMask = 0xFFFFFF;
// Areas by their select lines. AA3 would select flash and battery RAM, which are not on this bus: BA3W is storage.
constexpr unsigned kDefaultArea = 3;
constexpr unsigned kOnChipWaitStates = 7;

// Regions of docs/architecture.md that lie on Port A; the first three of each area select.
struct Region {
  std::uint32_t first, last;
  unsigned area;
};
constexpr Region kRegions[] = {
    {0x060000, 0x063FFF, 2},             // DPRAM
    {0x070000, 0x0700FF, kDefaultArea},  // latches
    {0x078000, 0x07BFFF, 1},             // gate ICs
};
constexpr std::uint32_t kOnChipFirst = 0xFFFF80, kOnChipLast = 0xFFFFFF;
constexpr std::uint32_t kOnChipAddressPins = 0x3F;

}  // namespace

PortA::PortA(sc_core::sc_module_name name, Signals& signals)
    : sc_core::sc_module(name),
      signals_(signals),
      addr_(signals.add("bus.addr", 19, Radix::kHex)),
      data_(signals.add("bus.data", 24, Radix::kHex)),
      aa_(signals.add("bus.aa", 4, Radix::kBinary)),
      x_(signals.add("bus.x", 1, Radix::kBinary)),
      rd_n_(signals.add("bus.rd_n", 1, Radix::kBinary, 1)),
      wr_n_(signals.add("bus.wr_n", 1, Radix::kBinary, 1)) {
  socket.register_b_transport(this, &PortA::b_transport);
}

void PortA::reset(Tick edge, std::int64_t cycle, PortAPins& pins) {
  bcr_ = regs::cpu_bus::kBcr.reset;
  pctl_ = regs::cpu_bus::kPctl.reset;
  clock_.restart(edge, cycle, regs::cpu_bus::pctl::kMultiplier.get(pctl_) + 1);
  state_ = State::kIdle;
  stand_ = edge;
  in_doubt_ = false;
  next_start_ = cycle;
  pins.pa_aa = 0;
  pins.pa_int = false;
  pins.pa_rd_n = pins.pa_wr_n = true;
  const TimeFs now = tick_to_fs(edge);
  signals_.set(aa_, now, 0);
  signals_.set(rd_n_, now, 1);
  signals_.set(wr_n_, now, 1);
}

unsigned PortA::wait_states(unsigned area) const {
  using namespace regs::cpu_bus::bcr;
  constexpr regs::Field kFields[] = {kBa0w, kBa1w, kBa2w, kBdfw};
  return kFields[area].get(bcr_);
}

void PortA::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  auto* request = payload.get_extension<PortARequest>();
  if (state_ == State::kIdle && !begin(payload, *request)) return;
  if (state_ != State::kDone) return;  // the status stays incomplete
  state_ = State::kIdle;
  if (!cycle_.write) std::memcpy(payload.get_data_ptr(), &cycle_.data, sizeof cycle_.data);
  request->done = start_ + shape_.clocks + cycle_.stretched;
  delay += sc_core::sc_time(static_cast<double>(cycle_.end - cycle_.start), sc_core::SC_FS);
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

bool PortA::begin(tlm::tlm_generic_payload& payload, PortARequest& request) {
  const std::uint32_t offset = static_cast<std::uint32_t>(payload.get_address()) - kPmacBase;
  const std::uint32_t address = offset / 8;
  const bool x = (offset & 4) != 0;
  request.done = request.start + 1;
  if (payload.get_data_length() != 4 || offset % 4 != 0) {
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);  // the bus knows whole words only
    return false;
  }
  cycle_ = PortACycle{};
  cycle_.on_chip = x && address >= kOnChipFirst && address <= kOnChipLast;
  unsigned area = kDefaultArea;
  if (!cycle_.on_chip) {
    const auto region = std::find_if(std::begin(kRegions), std::end(kRegions),
                                     [&](const Region& r) { return address >= r.first && address <= r.last; });
    if (region == std::end(kRegions)) {
      payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
      return false;
    }
    area = region->area;
  }
  cycle_.address = address;
  cycle_.x = x;
  cycle_.aa = static_cast<std::uint8_t>(area < kDefaultArea ? 1u << area : 0);
  cycle_.write = payload.is_write();
  cycle_.pc = request.pc;
  cycle_.multiplier = clock_.multiplier();
  // The on-chip peripherals keep their own pace when the core gets faster than 8 x 9.83 MHz.
  cycle_.wait_states = cycle_.on_chip ? std::max(kOnChipWaitStates, clock_.multiplier() - 1) : wait_states(area);
  if (cycle_.write) {
    std::memcpy(&cycle_.data, payload.get_data_ptr(), sizeof cycle_.data);
    cycle_.data &= kWordMask;
  }
  shape_ = port_a_shape(cycle_.wait_states, cycle_.write);
  start_ = std::max(request.start, next_start_);
  if (cycle_.on_chip && (address == regs::cpu_bus::kBcr.address || address == regs::cpu_bus::kPctl.address)) {
    control_register(payload, request);
    return false;
  }
  ta_sampled_ = cycle_.on_chip || cycle_.wait_states == 0;
  acknowledged_ = ta_sampled_;
  data_sampled_ = cycle_.write;
  state_ = State::kRunning;
  next(Step::kAddress);
  return true;
}

void PortA::control_register(tlm::tlm_generic_payload& payload, PortARequest& request) {
  const bool is_bcr = cycle_.address == regs::cpu_bus::kBcr.address;
  std::uint32_t& reg = is_bcr ? bcr_ : pctl_;
  request.done = start_ + shape_.clocks;
  next_start_ = request.done;
  if (cycle_.write) {
    reg = cycle_.data & (is_bcr ? regs::cpu_bus::kBcr : regs::cpu_bus::kPctl).written;
    if (!is_bcr)
      clock_.restart(clock_.tick(request.done), request.done, regs::cpu_bus::pctl::kMultiplier.get(pctl_) + 1);
    if (on_control) on_control();
  } else {
    std::memcpy(payload.get_data_ptr(), &reg, sizeof reg);
  }
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
}

TimeFs PortA::time_of(Step step) const {
  const unsigned stretch = 4 * cycle_.stretched;
  switch (step) {
    case Step::kAddress:
      return clock_.time(start_);
    case Step::kDriveData:
      return clock_.time(start_, shape_.data_driven);
    case Step::kStrobeLow:
      return clock_.time(start_, shape_.strobe_low);
    case Step::kSampleTa:
      return clock_.time(start_, shape_.strobe_high - 1 + stretch) - kTaSetup;
    case Step::kSampleData:
      return clock_.time(start_, shape_.strobe_high + stretch) - kReadDataSetup;
    case Step::kStrobeHigh:
      return clock_.time(start_, shape_.strobe_high + stretch);
    case Step::kEnd:
      return clock_.time(start_, 4 * (shape_.clocks + shape_.held_clocks) + stretch);
  }
  return 0;
}

void PortA::next(Step step) {
  step_ = step;
  const bool sample = step == Step::kSampleTa || step == Step::kSampleData;
  time_ = time_of(step);
  if (sample) time_ = std::max(time_, cycle_.strobe_low);  // a cycle without time for the set-up takes what is there
  const Tick before = stand_;                              // what comes later is not seen earlier
  const bool strobe = step == Step::kStrobeLow || step == Step::kStrobeHigh;
  in_doubt_ = false;
  if (sample || aperture_ == nullptr || !aperture_->on()) {
    stand_ = sample ? fs_to_tick_floor(time_) : fs_to_tick(time_) - 1;
  } else if (strobe) {
    stand_ = aperture_->seen(time_) - 1;
  } else {
    stand_ = aperture_->first(time_) - 1;
    in_doubt_ = aperture_->in_doubt(time_) && aperture_->last(time_) - 1 > std::max(stand_, before);
  }
  stand_ = std::max(stand_, before);
}

void PortA::move_bus(PortAPins& pins) const {
  switch (step_) {
    case Step::kAddress:
      pins.pa_addr = cycle_.address & (cycle_.on_chip ? kOnChipAddressPins : 0x7FFFFu);
      pins.pa_x = cycle_.x;
      pins.pa_aa = cycle_.aa;
      pins.pa_int = cycle_.on_chip;
      break;
    case Step::kDriveData:
      pins.pa_wdata = cycle_.data;
      break;
    case Step::kEnd:
      pins.pa_aa = 0;
      pins.pa_int = false;
      break;
    default:
      break;
  }
}

// After the strobe has fallen: what is sampled next, or the end of the strobe. Each sample of /TA that says "not yet"
// adds a clock, and data sampled before it does not count.
void PortA::after_low() {
  const bool data_first = time_of(Step::kSampleData) <= time_of(Step::kSampleTa);
  if (!data_sampled_ && (ta_sampled_ || data_first))
    next(Step::kSampleData);
  else if (!ta_sampled_)
    next(Step::kSampleTa);
  else if (acknowledged_)
    next(Step::kStrobeHigh);
  else {
    ++cycle_.stretched;
    ta_sampled_ = false;
    data_sampled_ = cycle_.write;
    after_low();
  }
}

void PortA::step(PortAPins& pins, const BoardOutputs& board) {
  if (in_doubt_) {
    const PortAPins from = pins;
    PortAPins to = pins;
    move_bus(to);
    pins = aperture_->mixed(from, to, time_);
    stand_ = aperture_->last(time_) - 1;
    in_doubt_ = false;
    return;
  }
  const bool shown = !cycle_.on_chip;
  move_bus(pins);
  switch (step_) {
    case Step::kAddress:
      cycle_.start = time_;
      if (shown) {
        signals_.set(addr_, time_, pins.pa_addr);
        signals_.set(x_, time_, cycle_.x);
        signals_.set(aa_, time_, cycle_.aa);
      }
      next(cycle_.write && shape_.data_driven < shape_.strobe_low ? Step::kDriveData : Step::kStrobeLow);
      break;
    case Step::kDriveData:
      cycle_.data_time = time_;
      if (shown) signals_.set(data_, time_, cycle_.data);
      if (shape_.data_driven < shape_.strobe_low)
        next(Step::kStrobeLow);
      else
        after_low();
      break;
    case Step::kStrobeLow:
      cycle_.strobe_low = time_;
      (cycle_.write ? pins.pa_wr_n : pins.pa_rd_n) = false;
      if (shown) signals_.set(cycle_.write ? wr_n_ : rd_n_, time_, 0);
      if (shown && !cycle_.write) signals_.set(data_, time_, board.get(pin::kPaData));
      if (cycle_.write && shape_.data_driven > shape_.strobe_low)
        next(Step::kDriveData);
      else
        after_low();
      break;
    case Step::kSampleTa:
      cycle_.ta_time = time_;
      ta_sampled_ = true;
      acknowledged_ = board.get(pin::kPaTaN) == 0;
      after_low();
      break;
    case Step::kSampleData:
      cycle_.data_time = time_;
      data_sampled_ = true;
      cycle_.data = board.get(pin::kPaData);
      after_low();
      break;
    case Step::kStrobeHigh:
      cycle_.strobe_high = time_;
      pins.pa_rd_n = pins.pa_wr_n = true;
      if (shown) signals_.set(cycle_.write ? wr_n_ : rd_n_, time_, 1);
      next(Step::kEnd);
      break;
    case Step::kEnd:
      cycle_.end = time_;
      if (shown) signals_.set(aa_, time_, 0);
      state_ = State::kDone;
      next_start_ = start_ + shape_.clocks + cycle_.stretched + shape_.idle_clocks;
      if (on_cycle) on_cycle(cycle_);
      break;
  }
}

void PortA::board_changed(Tick tick, const BoardOutputs& board) {
  const bool reading = state_ == State::kRunning && !cycle_.write && !cycle_.on_chip && step_ != Step::kAddress &&
                       step_ != Step::kStrobeLow && step_ != Step::kEnd;
  if (reading) signals_.set(data_, tick_to_fs(tick), board.get(pin::kPaData));
}

}  // namespace brick
