#include "systemc/host/isa_slave.h"

namespace brick {

std::uint8_t IsaSlave::decode() const {
  const std::uint32_t compared = config_.decode_all ? 0xFFF0 : 0x03F0;
  const bool io = (cmd1_ & (kIor | kIow)) && !aen1_ && ((sa1_ ^ config_.io_base) & compared) == 0;
  const bool memory = (cmd1_ & (kMemr | kMemw)) && (sa1_ >> 16) == config_.mem_page;
  std::uint8_t target = memory ? kMemory : 0;
  if (io) {
    const std::uint32_t group = sa1_ & 0xC;  // +0..7, +8..11, the rest
    constexpr std::uint32_t kPicGroup = regs::host_io::kPicStatus.address & 0xC;
    target |= group < kPicGroup ? kHostPort : group == kPicGroup ? kPic : kReserved;
  }
  return target;
}

bool IsaSlave::idle() const {
  return command_pins() == cmd1_ && cmd1_ == cmd2_ && in.isa_sd == sd1_ && sd1_ == sd2_ &&
         (in.isa_sa & 0xFFFFF) == sa1_ && in.isa_aen == aen1_ && in.isa_sbhe_n == sbhe1_n_ &&
         memcs16_n_ == memcs16_n_next() && !(load_ && !in.mem_busy);
}

void IsaSlave::step() {
  const bool starts = start(), finishes = finish();
  const std::uint8_t target_now = target();

  if (starts && (cmd1_ & kIor) && (target_now & (kHostPort | kPic | kReserved))) {
    const std::uint8_t value = (target_now & kHostPort) ? in.hp_rdata : (target_now & kPic) ? in.pic_rdata : 0xFF;
    sd_ = static_cast<std::uint16_t>(0xFF00 | value);
  } else if (load_ && !in.mem_busy) {
    sd_ = byte8_ ? static_cast<std::uint16_t>((in.mem_rdata >> 8) * 0x101) : in.mem_rdata;
  }
  // Memory data comes at the first edge that is not busy.
  load_ = starts ? (target_now & kMemory) && (cmd1_ & kMemr) : load_ && in.mem_busy && !finishes;

  if (starts) {
    target_ = target_now;
    addr_ = static_cast<std::uint16_t>(sa1_);
    byte8_ = sbhe1_n_ && (sa1_ & 1);  // an 8-bit host's odd byte is on the low lane
    be_ = byte8_ ? 2 : static_cast<std::uint8_t>((sbhe1_n_ ? 0 : 2) | ((sa1_ & 1) ? 0 : 1));
  } else if (finishes) {
    target_ = 0;
  }
  memcs16_n_ = memcs16_n_next();

  cmd2_ = cmd1_;
  sd2_ = sd1_;
  cmd1_ = command_pins();
  sd1_ = in.isa_sd;
  sa1_ = in.isa_sa & 0xFFFFF;
  aen1_ = in.isa_aen;
  sbhe1_n_ = in.isa_sbhe_n;
}

void IsaSlave::reset_registers() {
  cmd1_ = cmd2_ = target_ = be_ = 0;
  sa1_ = 0;
  sd1_ = sd2_ = addr_ = 0;
  sd_ = 0xFFFF;
  aen1_ = byte8_ = load_ = false;
  sbhe1_n_ = memcs16_n_ = true;
}

}  // namespace brick
