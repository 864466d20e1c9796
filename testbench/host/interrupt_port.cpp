#include "testbench/host/interrupt_port.h"

namespace brick {

namespace {
constexpr std::uint8_t kReceiveRequest = regs::host_io::icr::kRreq.mask();
constexpr std::uint8_t kTransmitRequest = regs::host_io::icr::kTreq.mask();
}  // namespace

void InterruptPort::request(bool transmit) {
  requests_transmit_ = transmit;
  bus_.io_write(regs::host_io::kIcr, static_cast<std::uint8_t>(kReceiveRequest | (transmit ? kTransmitRequest : 0)));
}

void InterruptPort::open() {
  bus_.open_port();
  request(sending_);
}

void InterruptPort::send(std::uint8_t c) {
  character_ = c;
  sending_ = true;
}

bool InterruptPort::run_until(Tick limit) {
  while (bus_.now() < limit) {
    if (sending_ != requests_transmit_) request(sending_);
    if (bus_.machine().outputs().get(pin::kHreq) == 0) {
      bus_.wait_change(pin::kHreq, limit);
      if (bus_.machine().outputs().get(pin::kHreq) == 0) return false;
    }
    const std::uint8_t status = bus_.port_status();
    if ((status & HostBus::kRxdf) != 0) {
      on_character(bus_.io_read(regs::host_io::kData7));
      return true;
    }
    if (sending_ && (status & HostBus::kTxde) != 0) {
      bus_.io_write(regs::host_io::kData7, character_);
      sending_ = false;
      return true;
    }
  }
  return false;
}

}  // namespace brick
