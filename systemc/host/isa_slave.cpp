#include "systemc/host/isa_slave.h"

#include <algorithm>

namespace brick {

// ---------------------------------------------------------------------------------------------------------------- time

// The first edge at which an output moves. MEMCS16# moves with clk_pwm, all others with clk_ref.
Tick IsaSlave::next_event() const {
  if (isa_sd_oe() != oe_shown_ || (cycle_ == Cycle::kShow && pic_sel()))
    return now_ + 1;  // pic_rd goes with the command
  const unsigned commands = command_pins();
  const Tick next = next_memcs16();
  const Tick edge = next_ref_edge(now_);
  const unsigned at_edge = command_in(edge - 1 - now_);
  if (!settings_still() || ref_shows(at_edge)) return std::min(next, edge);
  // At the edge after it the commands are what the pins are.
  const bool shows = ref_acts(at_edge) ? commands != 0 : ref_shows(commands);
  return shows ? std::min(next, edge + kTicksPerRef) : next;
}

Tick IsaSlave::next_memcs16() const {
  const auto moves = [this](unsigned la) { return la_hit(la) == isa_memcs16_n(); };
  return moves(la2_) ? now_ + 1 : moves(la1_) ? now_ + 2 : moves(la_pins()) ? now_ + 3 : kNever;
}

void IsaSlave::advance(Tick t) {
  if (t <= now_) return;  // no edge, so the enable as it is now has not been seen yet
  bool still = stages_still();
  for (Tick edge = next_ref_edge(now_); !(still && commands_settled()); edge += kTicksPerRef) {
    if (edge > t) {
      pwm_edges(t - now_, still);
      break;
    }
    pwm_edges(edge - 1 - now_, still);
    cycle_edge();
    pwm_edges(1, still);
    now_ = edge;
    if (!still) {
      sample();
      still = stages_still();
    }
  }
  now_ = t;
  oe_shown_ = isa_sd_oe();
}

// No edge does anything while these and the rest stand.
bool IsaSlave::commands_settled() const {
  const std::uint8_t commands = command_pins();
  return commands == cmd1_ && commands == cmd2_ && cycle_ != Cycle::kShow && !ref_acts(commands);
}

// What comes in has passed all stages, but for the commands.
bool IsaSlave::stages_still() const {
  const std::uint8_t la = la_pins();
  const bool data = in.isa_sd == sd1_ && sd1_ == sd2_ && (!writes(command_pins() | cmd1_ | cmd2_) || sd_low_ == sd2_);
  return data && la == la1_ && la == la2_ && la_hits_ == with_hit(la_hits_, la) && (in.isa_sa & kSa) == sa_ &&
         in.isa_aen == aen_ && in.isa_sbhe_n == sbhe_n_ && settings_still();
}

// The cycle moves on at a clk_ref edge that sees these commands.
bool IsaSlave::ref_acts(unsigned command) const {
  if (cycle_ == Cycle::kStart || finished() || fetched()) return true;
  if (host_reset() && (cycle_ != Cycle::kHold || target_ != 0 || page_ != 0)) return true;
  if (cycle_ == Cycle::kIdle) return command != 0;
  return (command == 0 && !host_reset()) || (spoilt(command) && target_ != 0);
}

// The same where others can see it. The end of a read does not show, unless the next command came before it was seen:
// then it is what takes the data from the bus.
bool IsaSlave::ref_shows(unsigned command) const {
  if (!ref_acts(command)) return false;
  const bool ends = command == 0 && cycle_ != Cycle::kStart && cycle_ != Cycle::kFetch;
  return !ends || host_reset() || end_shows() || (drives() && command_pins() != 0);
}

// --------------------------------------------------------------------------------------------------------------- edges

// `count` edges of clk_pwm. LA is compared behind the two stages.
void IsaSlave::pwm_edges(Tick count, bool still) {
  for (; count > 0; --count) {
    if (!still) {
      if (writes(cmd2_)) sd_low_ = sd2_;
      sd2_ = sd1_;
      sd1_ = in.isa_sd;
      la_hits_ = with_hit(la_hits_, la2_);
      la2_ = la1_;
      la1_ = la_pins();
    }
    cmd2_ = cmd1_;
    cmd1_ = command_pins();
  }
}

// What moves with every edge of clk_ref.
void IsaSlave::sample() {
  sa_ = in.isa_sa & kSa;
  aen_ = in.isa_aen;
  sbhe_n_ = in.isa_sbhe_n;
  resetdrv_ = static_cast<std::uint8_t>((resetdrv_ << 1 | (in.isa_resetdrv ? 1 : 0)) & 3);
  straps_ = in;
}

void IsaSlave::cycle_edge() {
  const bool reset = host_reset();
  const bool begins = !active() && cmd2_ != 0, ends = active() && cmd2_ == 0 && !reset;
  const bool io_load = cycle_ == Cycle::kStart && (kind_ & kIor) && (target_ & (kPort | kPic | kOther));
  const bool mem_load = fetched();
  const bool turns_page = finished() && (kind_ & kIow) && (target_ & kOther) && addresses_page();

  const Cycle next = next_cycle(io_load, mem_load);
  if (io_load || pic_rd()) sd_ = static_cast<std::uint16_t>(0xFF00 | io_read());
  if (mem_load && !io_load) sd_ = byte8_ ? static_cast<std::uint16_t>((in.mem_rdata >> 8) * 0x101) : in.mem_rdata;
  if (spoilt(cmd2_)) target_ = 0;
  cycle_ = next;
  if (begins) begin();
  if (turns_page) page_ = static_cast<std::uint8_t>(regs::host_io::page::kPage.get(wdata_));
  if (ends) wdata_ = sd_low_;
  if (reset) target_ = page_ = 0;
}

IsaSlave::Cycle IsaSlave::next_cycle(bool io_load, bool mem_load) const {
  if (host_reset()) return Cycle::kHold;  // as after the reset
  if (!active()) return cmd2_ != 0 ? Cycle::kStart : Cycle::kIdle;
  if (cmd2_ == 0) return cycle_ == Cycle::kShown ? Cycle::kDoneShown : Cycle::kDone;
  if (spoilt(cmd2_)) return Cycle::kHold;
  if (io_load || mem_load) return Cycle::kShow;
  switch (cycle_) {
    case Cycle::kStart:
      return (kind_ & kMemr) && (target_ & kMemory) ? Cycle::kFetch : Cycle::kHold;
    case Cycle::kShow:
      return Cycle::kShown;
    default:
      return cycle_;
  }
}

void IsaSlave::begin() {
  target_ = decode();
  kind_ = cmd2_;
  byte8_ = sbhe_n_ && (sa_ & 1);  // an 8-bit host's odd byte is on the low lane
  const std::uint8_t lanes = sbhe_n_ ? 1 : (sa_ & 1) ? 2 : 3;
  be_ = byte8_ ? 2 : lanes;
  lanes_ = (target_ & kMemory) ? lanes : 1;
  mem_addr_ = static_cast<std::uint16_t>((sa_ >> 1 & 0x1FFF) | (straps_.window_flat ? sa_ >> 14 & 3 : page_) << 13);
  io_addr_ = sa_ & 0xF;
}

std::uint8_t IsaSlave::decode() const {
  if (cmd2_ == kMemr || cmd2_ == kMemw) {
    const std::uint32_t compared = straps_.window_flat ? 0x10000 : 0x1C000;
    const bool hit = (la_hits_ & (straps_.slot8 ? kSecondHit : kOldestHit)) != 0 &&
                     ((sa_ ^ static_cast<std::uint32_t>(straps_.window) << 14) & compared) == 0;
    return hit ? kMemory : 0;
  }
  if (cmd2_ != kIor && cmd2_ != kIow) return 0;  // two commands at once
  const std::uint32_t compared = straps_.io_decode16 ? 0xFFF0 : 0x03F0;
  if (aen_ || ((sa_ ^ static_cast<std::uint32_t>(straps_.io_base) << 4) & compared) != 0) return 0;
  const std::uint32_t group = sa_ & 0xC;  // +0..7, +8..11, the rest
  constexpr std::uint32_t kPicGroup = regs::host_io::kPicStatus.address & 0xC;
  return group < kPicGroup ? kPort : group == kPicGroup ? kPic : kOther;
}

std::uint8_t IsaSlave::io_read() const {
  if (target_ & kPort) return in.hp_rdata;
  if (target_ & kPic) return in.pic_rdata;
  return addresses_page() ? static_cast<std::uint8_t>(0xFC | page_) : 0xFF;
}

// What takes its pin at the first edge, long before a command is answered, stays: samples of the address, and the data
// that were seen with a write command low, as which all commands count.
void IsaSlave::reset(Tick t) {
  now_ = t;
  cmd1_ = cmd2_ = kAll;
  la1_ = la2_ = la_hits_ = 0;
  sd1_ = sd2_ = wdata_ = 0;
  resetdrv_ = 0;
  straps_ = IsaStraps::none();
  straps_.window = 0x3FF;  // not where LA is in a reset
  cycle_ = Cycle::kHold;
  byte8_ = false;
  kind_ = target_ = be_ = page_ = io_addr_ = 0;
  mem_addr_ = 0;
  sd_ = 0xFFFF;
}

}  // namespace brick
