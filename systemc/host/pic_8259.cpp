#include "systemc/host/pic_8259.h"

namespace brick {

unsigned Pic8259::rank(std::uint8_t bits) const {
  for (unsigned r = 0; r < 8; ++r)
    if ((bits >> level_of(r) & 1) != 0) return r;
  return 8;
}

std::uint8_t Pic8259::rdata() const {
  if (in.addr > kAcknowledge) return 0xFF;
  const unsigned acked = acknowledged();
  if (in.addr == kAcknowledge) return static_cast<std::uint8_t>(vector_ | acked);
  if (poll_) return static_cast<std::uint8_t>((pending() ? 0x80 : 0) | acked);
  return in.addr == kMask ? imr_ : read_isr_ ? isr_ : irr();
}

bool Pic8259::idle() const {
  return !in.rd && !in.wr && in.line == line1_ && line1_ == line2_ &&
         (armed_ | static_cast<std::uint8_t>(~line2_)) == armed_;
}

void Pic8259::step() {
  const std::uint8_t low = ~line2_;
  if (served()) acknowledge();
  if (reads_poll()) poll_ = false;
  if (in.wr && in.addr == kCommand) write_command();
  if (in.wr && in.addr == kMask) write_second();
  armed_ |= low;  // a line that is low now arms its next edge, whatever clears it
  line2_ = line1_;
  line1_ = in.line;
}

void Pic8259::acknowledge() {
  const unsigned acked = acknowledged();
  const auto bit = static_cast<std::uint8_t>(1u << acked);
  armed_ &= ~bit;
  if (!aeoi_)
    isr_ |= bit;
  else if (turn_)
    lowest_ = acked;
}

void Pic8259::write_command() {
  if ((in.wdata & 0x10) != 0) return write_icw1();
  if ((in.wdata & 0x08) == 0) return write_ocw2();
  if ((in.wdata & 0x40) != 0) special_ = (in.wdata & 0x20) != 0;  // OCW3
  if ((in.wdata & 0x02) != 0) read_isr_ = (in.wdata & 0x01) != 0;
  poll_ = (in.wdata & 0x04) != 0;
}

void Pic8259::write_icw1() {
  level_ = (in.wdata & 0x08) != 0;
  icw3_ = (in.wdata & 0x02) == 0;
  icw4_ = (in.wdata & 0x01) != 0;
  armed_ = isr_ = imr_ = 0;
  lowest_ = kDefaultLevel;
  turn_ = aeoi_ = special_ = read_isr_ = poll_ = false;
  step_ = Step::kIcw2;
}

void Pic8259::write_ocw2() {
  const bool turn = (in.wdata & 0x80) != 0, specific = (in.wdata & 0x40) != 0, end = (in.wdata & 0x20) != 0;
  const unsigned highest = rank(serviced());
  const unsigned level = specific ? in.wdata & 7u : level_of(highest);
  if (end) {
    if (!specific && highest == 8) return;
    isr_ &= static_cast<std::uint8_t>(~(1u << level));
    if (turn) lowest_ = level;
  } else if (!specific) {
    turn_ = turn;
  } else if (turn) {
    lowest_ = level;
  }
}

void Pic8259::write_second() {
  switch (step_) {
    case Step::kReady:
      imr_ = in.wdata;
      break;
    case Step::kIcw2:
      vector_ = in.wdata & 0xF8;
      step_ = icw3_ ? Step::kIcw3 : icw4_ ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw3:
      step_ = icw4_ ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw4:
      aeoi_ = (in.wdata & 0x02) != 0;
      step_ = Step::kReady;
      break;
  }
}

void Pic8259::reset_registers() {
  line1_ = line2_ = armed_ = isr_ = vector_ = 0;
  imr_ = 0xFF;
  lowest_ = kDefaultLevel;
  step_ = Step::kReady;
  icw3_ = icw4_ = level_ = aeoi_ = turn_ = special_ = read_isr_ = poll_ = false;
}

}  // namespace brick
