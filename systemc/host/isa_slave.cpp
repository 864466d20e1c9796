#include "systemc/host/isa_slave.h"

#include <algorithm>

namespace brick {

// ---------------------------------------------------------------------------------------------------------------- time

// The first edge at which an output moves. MEMCS16# moves with clk_pwm, all others with clk_ref.
Tick IsaSlave::next_event() const {
  if (isa_sd_oe() != oe_shown_ || (fresh_ && pic_sel())) return now_ + 1;  // pic_rd goes with the command
  Tick next = kNever;
  for (Tick n = 0; n < 3 && next == kNever; ++n) {
    const unsigned la = n == 0 ? la2_ : n == 1 ? la1_ : la_pins();
    if (la_hit(la) == isa_memcs16_n()) next = now_ + 1 + n;
  }
  const Tick edge = next_ref_edge(now_);
  const bool settings = straps_ != in || resetdrv_ != (in.isa_resetdrv ? 3 : 0);
  if (settings || ref_acts(command_in(edge - 1 - now_))) return std::min(next, edge);
  return ref_acts(command_pins()) ? std::min(next, edge + kTicksPerRef) : next;
}

void IsaSlave::advance(Tick t) {
  if (t <= now_) return;  // no edge, so the enable as it is now has not been seen yet
  while (now_ < t && !settled()) {
    ++now_;
    const std::uint8_t la = la_pins();
    const bool hit = la_hit(la2_);
    if (is_ref_edge(now_)) ref_edge();
    pwm_edge(la, hit);
  }
  now_ = t;
  oe_shown_ = isa_sd_oe();
}

// No edge changes anything while the pins stand.
bool IsaSlave::settled() const {
  const bool data = in.isa_sd == sd1_ && sd1_ == sd2_ && ((cmd2_ & (kIow | kMemw)) == 0 || sd_low_ == sd2_);
  const bool la = la_pins() == la1_ && la1_ == la2_ && la_hits_ == (la_hit(la2_) ? kAllHits : 0);
  const bool address = (in.isa_sa & kSa) == sa_ && in.isa_aen == aen_ && in.isa_sbhe_n == sbhe_n_;
  return command_pins() == cmd1_ && cmd1_ == cmd2_ && data && la && address && (shown_ || !drive_) &&
         !(straps_ != in) && resetdrv_ == (in.isa_resetdrv ? 3 : 0) && !ref_acts(cmd2_);
}

// The cycle moves on at a clk_ref edge that sees these commands.
bool IsaSlave::ref_acts(unsigned command) const {
  if (fresh_ || finish_ || (load_ && !in.mem_busy)) return true;
  if (host_reset() && (!active_ || drive_ || load_ || target_ != 0 || page_ != 0)) return true;
  if (!active_) return command != 0;
  return (command == 0 && !host_reset()) || (spoilt(command) && target_ != 0);
}

// --------------------------------------------------------------------------------------------------------------- edges

void IsaSlave::pwm_edge(std::uint8_t la, bool hit) {
  if ((cmd2_ & (kIow | kMemw)) != 0) sd_low_ = sd2_;
  cmd2_ = cmd1_;
  cmd1_ = command_pins();
  sd2_ = sd1_;
  sd1_ = in.isa_sd;
  la2_ = la1_;
  la1_ = la;
  la_hits_ = static_cast<std::uint8_t>((la_hits_ << 1 | (hit ? 1 : 0)) & kAllHits);
}

void IsaSlave::ref_edge() {
  const bool reset = host_reset();
  const bool begins = !active_ && cmd2_ != 0, ends = active_ && cmd2_ == 0 && !reset, spoils = spoilt(cmd2_);
  const bool io_load = fresh_ && (kind_ & kIor) && (target_ & (kPort | kPic | kOther));
  const bool mem_load = load_ && !in.mem_busy;
  const bool turns_page = finish_ && (kind_ & kIow) && (target_ & kOther) && addresses_page();

  shown_ = !begins && (shown_ || (drive_ && !ends && !spoils));
  if (io_load) sd_ = static_cast<std::uint16_t>(0xFF00 | io_read());
  if (mem_load && !io_load) sd_ = byte8_ ? static_cast<std::uint16_t>((in.mem_rdata >> 8) * 0x101) : in.mem_rdata;
  load_ = fresh_ ? (kind_ & kMemr) && (target_ & kMemory) : load_ && !mem_load;
  drive_ = drive_ || io_load || mem_load;
  if (ends || spoils) drive_ = load_ = false;
  if (spoils) target_ = 0;
  fresh_ = begins;
  finish_ = ends;
  active_ = begins || (active_ && !ends);
  if (begins) begin();
  if (turns_page) page_ = static_cast<std::uint8_t>(regs::host_io::page::kPage.get(wdata_));
  if (ends) wdata_ = sd_low_;
  if (reset) {
    active_ = true;
    drive_ = load_ = false;
    target_ = page_ = 0;
  }

  sa_ = in.isa_sa & kSa;
  aen_ = in.isa_aen;
  sbhe_n_ = in.isa_sbhe_n;
  resetdrv_ = static_cast<std::uint8_t>((resetdrv_ << 1 | (in.isa_resetdrv ? 1 : 0)) & 3);
  straps_ = in;
}

void IsaSlave::begin() {
  target_ = decode();
  kind_ = cmd2_;
  byte8_ = sbhe_n_ && (sa_ & 1);  // an 8-bit host's odd byte is on the low lane
  const auto lanes = static_cast<std::uint8_t>((sbhe_n_ ? 0 : 2) | ((sa_ & 1) ? 0 : 1));
  be_ = byte8_ ? 2 : lanes;
  lanes_ = (target_ & kMemory) && !byte8_ ? lanes : 1;
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

void IsaSlave::reset(Tick t) {
  now_ = t;
  cmd1_ = cmd2_ = kAll;
  la1_ = la2_ = la_hits_ = 0;
  sd1_ = sd2_ = sd_low_ = wdata_ = 0;
  sa_ = 0;
  aen_ = false;
  sbhe_n_ = true;
  resetdrv_ = 0;
  straps_ = IsaStraps::none();
  active_ = true;
  fresh_ = load_ = drive_ = shown_ = finish_ = byte8_ = false;
  kind_ = target_ = lanes_ = be_ = page_ = io_addr_ = 0;
  mem_addr_ = 0;
  sd_ = 0xFFFF;
  oe_shown_ = 0;
}

}  // namespace brick
