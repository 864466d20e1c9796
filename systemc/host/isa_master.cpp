#include "systemc/host/isa_master.h"

namespace brick {

namespace {
constexpr std::uint16_t kIdleData = 0xFFFF;  // pull-ups of the data bus
}

void IsaMaster::begin(const IsaCycle& cycle, TimeFs start, const isa::HostTimes& times, unsigned width) {
  cycle_ = cycle;
  result_ = {};
  all_ = times;
  times_ = !cycle.memory() ? times.io : width == 8 ? times.memory8 : times.memory;
  width_ = width;
  start_ = start;
  data_driven_ = !cycle.write();
  go(Step::kStart);
}

// Write data comes where its time is, between two of the other points.
void IsaMaster::go(Step step) {
  step_ = step;
  data_next_ = !data_driven_ && times_.data_valid <= before(step);
  if (step == Step::kCommand) high_ = start_ + times_.command_high;
}

// Data that is valid by then goes before the step.
TimeFs IsaMaster::before(Step step) const {
  switch (step) {
    case Step::kStart:
      return -1;
    case Step::kAddress:
      return times_.address;
    case Step::kWidth:
      return isa::kMemcs16;
    case Step::kCommand:
      return times_.command_low;
    default:
      return times_.command_high;
  }
}

bool IsaMaster::drives() const {
  return data_next_ || step_ == Step::kStart || step_ == Step::kAddress || step_ == Step::kCommand ||
         step_ == Step::kEnd || step_ == Step::kRelease;
}

TimeFs IsaMaster::time() const {
  if (data_next_) return start_ + times_.data_valid;
  switch (step_) {
    case Step::kAddress:
      return start_ + times_.address;
    case Step::kCommand:
      return start_ + times_.command_low;
    case Step::kEnd:
      return high_;
    case Step::kRelease:
      return end();
    default:
      return start_;
  }
}

void IsaMaster::address(IsaPins& pins) const {
  pins.isa_sa = cycle_.address & 0xFFFFF;
  pins.isa_aen = false;
  pins.isa_sbhe_n = !cycle_.sbhe;
}

void IsaMaster::drive(IsaPins& pins) const {
  if (data_next_) {
    pins.isa_sd = cycle_.data;
    return;
  }
  static constexpr bool IsaPins::*kCommands[] = {&IsaPins::isa_ior_n, &IsaPins::isa_iow_n, &IsaPins::isa_memr_n,
                                                 &IsaPins::isa_memw_n};
  bool& command = pins.*kCommands[static_cast<unsigned>(cycle_.command)];
  switch (step_) {
    case Step::kStart:
      if (cycle_.memory()) pins.isa_la = static_cast<std::uint8_t>(cycle_.address >> 17);
      if (times_.address == 0) address(pins);
      break;
    case Step::kAddress:
      address(pins);
      break;
    case Step::kCommand:
      command = false;
      break;
    case Step::kEnd:
      command = true;
      break;
    default:  // kRelease
      pins.isa_sd = kIdleData;
      pins.isa_sbhe_n = true;
      break;
  }
}

void IsaMaster::after_drive() {
  if (data_next_) {
    data_driven_ = true;
    return go(step_);
  }
  switch (step_) {
    case Step::kStart:
      if (times_.address != 0) return go(Step::kAddress);
      [[fallthrough]];
    case Step::kAddress:
      return go(cycle_.memory() && width_ == 16 ? Step::kWidth : Step::kCommand);
    case Step::kCommand:
      return go(Step::kReady);
    case Step::kEnd:
      return go(Step::kRelease);
    default:
      return go(Step::kLeft);
  }
}

Tick IsaMaster::tick() const {
  switch (step_) {
    case Step::kWidth:
      return fs_to_tick_floor(start_ + isa::kMemcs16);
    case Step::kStretch:
      return fs_to_tick_floor(high_ - isa::kReadyToHigh);
    case Step::kRise:
      return fs_to_tick(start_ + times_.command_low + isa::kLongestStretch);
    case Step::kLeft:
      return fs_to_tick(end()) - 1;
    default:  // kReady: if IOCHRDY stays high, all stand until the sample
      return fs_to_tick_floor(high_ - times_.sample);
  }
}

bool IsaMaster::stands(const BoardOutputs& board) const {
  return waits() && (board.get(pin::kIsaIochrdy) != 0) == (step_ == Step::kRise);
}

void IsaMaster::look(Tick now, const BoardOutputs& board) {
  const bool ready = board.get(pin::kIsaIochrdy) != 0;
  switch (step_) {
    case Step::kWidth:
      result_.narrow = board.get(pin::kIsaMemcs16N) != 0;
      if (result_.narrow) times_ = all_.memory8;
      return go(Step::kCommand);
    case Step::kReady:  // IOCHRDY is looked at one BCLK before the command would end, and again at each BCLK
      return go(!ready && now <= fs_to_tick_floor(high_ - isa::kReadyToHigh) ? Step::kStretch : Step::kSample);
    case Step::kRise:
      high_ = tick_to_fs(now) + isa::kReadyToHigh;
      return stretch(ready);
    case Step::kStretch:
      return stretch(ready);
    case Step::kSample:
      result_.data = data_bus(board);
      return go(Step::kEnd);
    default:  // kLeft
      return go(Step::kIdle);
  }
}

void IsaMaster::stretch(bool ready) {
  result_.stuck = !ready && high_ - start_ > isa::kLongestStretch;
  if (ready || result_.stuck) return go(Step::kSample);
  if (all_.exact_ready) return go(Step::kRise);
  high_ += isa::kBclk;  // and once more
}

std::uint16_t IsaMaster::data_bus(const BoardOutputs& board) {
  const std::uint32_t driven = board.get(pin::kIsaSdOe);
  const unsigned floats = ((driven & 1) != 0 ? 0u : 0x00FFu) | ((driven & 2) != 0 ? 0u : 0xFF00u);
  return static_cast<std::uint16_t>(board.get(pin::kIsaSd) | floats);
}

}  // namespace brick
