#include "testbench/unit/board_model/motor_traffic.h"

#include <algorithm>

namespace brick {
namespace {
constexpr std::uint32_t kBase[] = {0x78000, 0x78100, 0x78200, 0x78300, 0x79200, 0x79300, 0x7A200, 0x7A300, 0x7B200, 0x7B300};
}

MotorTraffic::MotorTraffic(std::uint64_t seed, MotorTrafficOptions options) : random_(seed), options_(std::move(options)) {
  ic_.resize(options_.ics.size());
  for (Ic& ic : ic_) ic.at = 100 + pick(300);
  inputs_.fitted = 0;
  for (const unsigned ic : options_.ics) inputs_.fitted |= 1u << ic;
  for (unsigned line = 0; line < 3; ++line) inputs_.line_select = static_cast<std::uint16_t>(inputs_.line_select << 4 | (1 + pick(8)));
}

Tick MotorTraffic::next() const {
  Tick next = bus_at_;
  for (const Ic& ic : ic_) next = std::min(next, ic.at);
  return next;
}

void MotorTraffic::change(Board& board) {
  const Tick now = next();
  if (bus_at_ == now) bus_step(board);
  for (unsigned i = 0; i < ic_.size(); ++i) {
    if (ic_[i].at != now) continue;
    move(i);
    board.set_motor_inputs(options_.ics[i], ic_[i].inputs);
  }
}

void MotorTraffic::move(unsigned i) {
  Ic& ic = ic_[i];
  ic.at += 1 + static_cast<Tick>(pick(static_cast<std::uint32_t>(options_.pins_pause)));
  if (pick(40) == 0) ic.up = !ic.up;
  for (unsigned channel = 0; channel < kChannels; ++channel) {
    if (pick(3) == 0) continue;
    constexpr unsigned kQuadrature[4] = {0, 1, 3, 2};
    unsigned& place = ic.place[channel];
    place = (place + (ic.up ? 1u : 3u)) % 4;
    std::uint16_t& pins = ic.inputs.pins[channel];
    pins = static_cast<std::uint16_t>((pins & ~3u) | kQuadrature[place]);
    if (pick(20) == 0) pins = static_cast<std::uint16_t>(pins ^ 1u << pick(kChannelPins));
  }
  if (pick(3) == 0) ic.inputs.adc_a = static_cast<std::uint8_t>(pick(16));
  if (pick(3) == 0) ic.inputs.adc_b = static_cast<std::uint8_t>(pick(16));
}

// One access: address, strobe, strobe away, pause. The first step releases the reset.
void MotorTraffic::bus_step(Board& board) {
  switch (bus_step_) {
    case -1:
      inputs_.rst_n = true;
      bus_at_ += 10;
      break;
    case 0:
      choose_access();
      bus_at_ += 3 + pick(3);
      break;
    case 1:
      (write_ ? inputs_.pa_wr_n : inputs_.pa_rd_n) = false;
      bus_at_ += 9 + pick(pick(6) == 0 ? 3000 : 6);  // now and then a long read that sees its word change
      break;
    case 2:
      inputs_.pa_wr_n = inputs_.pa_rd_n = true;
      bus_at_ += 3;
      break;
    default:
      inputs_.pa_aa = 0;
      bus_at_ += 9 + (starts_ < 40 ? 0 : static_cast<Tick>(pick(static_cast<std::uint32_t>(options_.bus_pause))));
      break;
  }
  bus_step_ = bus_step_ == 3 ? 0 : bus_step_ + 1;
  board.set_inputs(inputs_);
}

std::uint32_t MotorTraffic::control_word() {
  std::uint32_t word = pick(1u << 24);
  word = (word & ~0xFu) | (pick(3) == 0 ? 0x800008 : 3 + 4 * pick(2));
  if (pick(8) != 0) word &= ~0x400u;
  if (pick(3) != 0) word &= ~0x40000u;
  return word | 0x4000;
}

void MotorTraffic::choose_access() {
  const std::uint32_t base = kBase[options_.ics[pick(static_cast<std::uint32_t>(options_.ics.size()))]];
  const std::uint32_t channel = 8 * pick(4);
  inputs_.pa_aa = 2;
  inputs_.pa_x = true;
  write_ = true;
  if (starts_ < 40) {  // clocks from the first IC, all channels in use
    const unsigned step = starts_++;
    if (step == 0) {
      inputs_.pa_addr = kBase[options_.ics[0]] + 4;
      inputs_.pa_wdata = 0x3008D2;
      return;
    }
    inputs_.pa_addr = kBase[options_.ics[step % options_.ics.size()]] + 8 * (step / 3 % 4) + 5;
    inputs_.pa_wdata = control_word();
    return;
  }
  switch (pick(10)) {
    case 0:
      inputs_.pa_addr = base + channel + 5;
      inputs_.pa_wdata = control_word();
      break;
    case 1:
    case 2:
      inputs_.pa_x = false;
      inputs_.pa_addr = base + channel + 2 + pick(3);  // OUT A, B, C
      inputs_.pa_wdata = pick(2) != 0 ? (pick(4000) - 2000) << 8 & 0xFFFFFF : pick(1u << 22);
      break;
    case 3:
      inputs_.pa_x = pick(2) != 0;
      inputs_.pa_addr = base + channel + (inputs_.pa_x ? 6 + pick(2) : 7);  // compare
      inputs_.pa_wdata = pick(40);
      break;
    case 4:
      if (options_.moving_clocks && pick(4) == 0) {
        inputs_.pa_addr = base + 0x1C;
        inputs_.pa_wdata = (200 + pick(3000)) << 8 | pick(30);
      } else if (options_.moving_clocks) {
        inputs_.pa_addr = base + 4;
        inputs_.pa_wdata = 0x0008D2 | pick(1u << 6) | pick(3) << 16 | pick(4) << 20 | (base == kBase[options_.ics[0]] ? 0 : 3) << 12;
      } else {
        inputs_.pa_addr = base + 0x0C;  // DAC strobe
        inputs_.pa_wdata = pick(1u << 24);
      }
      break;
    case 5:
      inputs_.pa_addr = base + 8 * (1 + pick(2)) + 4;  // strobe words
      inputs_.pa_wdata = pick(1u << 24);
      break;
    case 6:
      inputs_.pa_addr = base + channel;  // clears errors
      inputs_.pa_wdata = pick(256);
      break;
    default:
      write_ = false;
      inputs_.pa_x = pick(2) != 0;
      inputs_.pa_addr = base + channel + pick(8);
      break;
  }
}

}  // namespace brick
