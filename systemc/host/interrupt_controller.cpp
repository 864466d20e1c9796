#include "systemc/host/interrupt_controller.h"

#include "systemc/core/register_access.h"

namespace brick {

InterruptController::InterruptController(const sc_core::sc_module_name& name) : sc_module(name), socket("socket") {
  socket.register_b_transport(this, &InterruptController::b_transport);
  socket.register_transport_dbg(this, &InterruptController::transport_dbg);
}

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

void InterruptController::step() {
  const std::uint8_t rise = line2_ & ~line3_;
  const bool clear = in.wr && in.addr == kStatus;
  // An edge that meets the clear stays: its interrupt has not been served.
  latch_ = (rise & msk_ & ~elr_) | (clear ? 0 : latch_ & msk_);
  if (in.wr && in.addr == kMask) msk_ = in.wdata;
  if (in.wr && in.addr == kEdgeLevel) elr_ = in.wdata;
  if (in.reset) latch_ = msk_ = elr_ = 0;
  line3_ = line2_;
  line2_ = line1_;
  line1_ = in.line;
}

void InterruptController::reset_registers() { line1_ = line2_ = line3_ = latch_ = msk_ = elr_ = 0; }

void InterruptController::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (!check_payload(payload, 1, 4)) return;
  const Tick edge = catch_up(*this, now(), delay);
  const auto addr = static_cast<std::uint8_t>(payload.get_address());
  if (payload.is_read()) {
    set_payload_value(payload, read(addr));
  } else {
    const Inputs before = in;
    in = {before.reset, before.line, true, addr, payload_value<std::uint8_t>(payload)};
    advance(edge);
    in = before;
  }
  delay = delay_until(edge);
}

unsigned InterruptController::transport_dbg(tlm::tlm_generic_payload& payload) {
  if (!check_payload(payload, 1, 4) || !payload.is_read()) return 0;
  set_payload_value(payload, read(static_cast<unsigned>(payload.get_address())));
  return 1;
}

}  // namespace brick
