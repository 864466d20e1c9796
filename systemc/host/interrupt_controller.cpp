#include "systemc/host/interrupt_controller.h"

namespace brick {

std::uint8_t InterruptController::read(unsigned addr) const {
  switch (addr & 3) {
    case kStatus:
      return ist();
    case kSignal:
      return sig();
    case kMask:
      return msk_;
    default:
      return elr_;
  }
}

bool InterruptController::idle() const {
  const bool cleared = latch_ == 0 && msk_ == 0 && elr_ == 0;
  return !in.wr && (!in.reset || cleared) && in.line == line1_ && line1_ == line2_ && line2_ == line3_ &&
         (latch_ & ~msk_) == 0;
}

InterruptController::Registers InterruptController::coming() const {
  if (in.reset) return {0, 0, 0};
  const std::uint8_t rise = line2_ & ~line3_;
  // An edge that meets the clear stays: its interrupt has not been served.
  const auto latch = static_cast<std::uint8_t>((rise & msk_ & ~elr_) | (served() ? 0 : latch_ & msk_));
  return {latch, in.wr && in.addr == kMask ? in.wdata : msk_, in.wr && in.addr == kEdgeLevel ? in.wdata : elr_};
}

void InterruptController::step() {
  const Registers next = coming();
  latch_ = next.latch;
  msk_ = next.msk;
  elr_ = next.elr;
  line3_ = line2_;
  line2_ = line1_;
  line1_ = in.line;
}

void InterruptController::reset_registers() { line1_ = line2_ = line3_ = latch_ = msk_ = elr_ = 0; }

}  // namespace brick
