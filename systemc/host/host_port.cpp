#include "systemc/host/host_port.h"

#include "rtl/regs/brick_regs.hpp"

namespace brick {
namespace {

namespace icr = regs::host_io::icr;
namespace cvr = regs::host_io::cvr;
namespace isr = regs::host_io::isr;
namespace hcr = regs::hi08::hcr;
namespace hsr = regs::hi08::hsr;

constexpr unsigned low3(const regs::Register& reg) { return reg.address & 7; }
constexpr unsigned kIcr = low3(regs::host_io::kIcr), kCvr = low3(regs::host_io::kCvr), kIsr = low3(regs::host_io::kIsr),
                   kIvr = low3(regs::host_io::kIvr), kData5 = low3(regs::host_io::kData5),
                   kData6 = low3(regs::host_io::kData6), kData7 = low3(regs::host_io::kData7);

constexpr unsigned low6(const regs::Register& reg) { return reg.address & 0x3F; }
constexpr unsigned kHcr = low6(regs::hi08::kHcr), kHsr = low6(regs::hi08::kHsr), kHpcr = low6(regs::hi08::kHpcr),
                   kHbar = low6(regs::hi08::kHbar), kHorx = low6(regs::hi08::kHorx), kHotx = low6(regs::hi08::kHotx);

constexpr unsigned byte_of(std::uint32_t word, unsigned lsb) { return (word >> lsb) & 0xFF; }
void set_byte(std::uint32_t& word, unsigned lsb, std::uint8_t value) {
  word = (word & ~(0xFFu << lsb)) | (static_cast<std::uint32_t>(value) << lsb);
}

}  // namespace

bool HostPort::hreq() const { return (icr::kRreq.is_set(icr_) && rxdf_) || (icr::kTreq.is_set(icr_) && txde_); }

bool HostPort::irq() const {
  return (hcr::kHrie.is_set(hcr_) && hrdf_) || (hcr::kHtie.is_set(hcr_) && htde_) ||
         (hcr::kHcie.is_set(hcr_) && cvr::kHc.is_set(cvr_));
}

std::uint8_t HostPort::host_read(unsigned addr) const {
  const bool hlend = icr::kHlend.is_set(icr_);
  switch (addr & 7) {
    case kIcr:
      return icr_;
    case kCvr:
      return cvr_;
    case kIsr:
      return static_cast<std::uint8_t>(isr::kHreq.at(hreq()) | isr::kHf3.at(hcr::kHf3.get(hcr_)) |
                                       isr::kHf2.at(hcr::kHf2.get(hcr_)) | isr::kTrdy.at(txde_ && !hrdf_) |
                                       isr::kTxde.at(txde_) | isr::kRxdf.at(rxdf_));
    case kIvr:
      return ivr_;
    case kData5:
      return static_cast<std::uint8_t>(byte_of(rx_, hlend ? 0 : 16));
    case kData6:
      return static_cast<std::uint8_t>(byte_of(rx_, 8));
    case kData7:
      return static_cast<std::uint8_t>(byte_of(rx_, hlend ? 16 : 0));
    default:
      return 0;
  }
}

std::uint32_t HostPort::cpu_read(unsigned addr) const {
  switch (addr & 0x3F) {
    case kHcr:
      return hcr_;
    case kHsr:
      return hsr::kHv.at(cvr::kHv.get(cvr_)) | hsr::kHf1.at(icr::kHf1.get(icr_)) | hsr::kHf0.at(icr::kHf0.get(icr_)) |
             hsr::kHcp.at(cvr::kHc.get(cvr_)) | hsr::kHtde.at(htde_) | hsr::kHrdf.at(hrdf_);
    case kHpcr:
      return hpcr_;
    case kHbar:
      return hbar_;
    case kHorx:
      return horx_;
    default:
      return 0;
  }
}

bool HostPort::idle() const {
  const bool host = in.hp_sel && (in.hp_wr || in.hp_rd_done || (in.hp_rd && saw_ != rxdf_));
  const bool cpu = in.dsp_sel && (in.dsp_we || in.dsp_rd);
  return !host && !cpu && !tx_move() && !rx_move() && !(in.hp_reset && !host_side_reset());
}

bool HostPort::host_side_reset() const {
  return icr_ == regs::host_io::kIcr.reset && cvr_ == regs::host_io::kCvr.reset && ivr_ == regs::host_io::kIvr.reset &&
         txde_ && htde_ && !hrdf_ && !rxdf_;
}

void HostPort::reset_host_side() {
  icr_ = regs::host_io::kIcr.reset;
  cvr_ = regs::host_io::kCvr.reset;
  ivr_ = regs::host_io::kIvr.reset;
  txde_ = htde_ = true;
  hrdf_ = rxdf_ = false;
}

// Registers first move by themselves, then the strobes of this edge act on top; INIT is part of the host's write and
// comes last, but for RESETDRV. Everything that a strobe tests is the state before the edge, as with the RTL's
// flip-flops.
void HostPort::step() {
  const bool hrdf_before = hrdf_, rxdf_before = rxdf_;
  if (tx_move()) {
    horx_ = tx_;
    hrdf_ = txde_ = true;
  }
  if (rx_move()) {
    rx_ = hotx_;
    rxdf_ = htde_ = true;
  }
  if (in.dsp_sel && in.dsp_rd && in.dsp_addr == kHorx && hrdf_before) hrdf_ = false;
  if (in.hp_sel && in.hp_rd_done && in.hp_addr == kData7 && rxdf_before && saw_) rxdf_ = false;
  if (in.hp_sel && in.hp_rd) saw_ = rxdf_before;
  if (in.dsp_sel && in.dsp_we) cpu_write();
  if (in.hp_sel && in.hp_wr) host_write();
  if (in.hp_reset) reset_host_side();
}

void HostPort::cpu_write() {
  const std::uint32_t value = in.dsp_wdata & 0xFFFFFF;
  switch (in.dsp_addr) {
    case kHcr:
      hcr_ = static_cast<std::uint8_t>(value & regs::hi08::kHcr.written);
      break;
    case kHsr:
      if (hsr::kHcp.is_set(value)) cvr_ = static_cast<std::uint8_t>(cvr::kHc.set(cvr_, 0));
      break;
    case kHpcr:
      hpcr_ = static_cast<std::uint16_t>(value & regs::hi08::kHpcr.written);
      break;
    case kHbar:
      hbar_ = static_cast<std::uint8_t>(value & regs::hi08::kHbar.written);
      break;
    case kHotx:
      hotx_ = value;
      htde_ = false;
      break;
    default:
      break;
  }
}

void HostPort::host_write() {
  const bool hlend = icr::kHlend.is_set(icr_);
  switch (in.hp_addr) {
    case kIcr:
      icr_ = static_cast<std::uint8_t>(icr::kInit.set(in.hp_wdata & regs::host_io::kIcr.written, 0));
      if (icr::kInit.is_set(in.hp_wdata) && icr::kTreq.is_set(in.hp_wdata)) {
        txde_ = true;
        hrdf_ = false;
      }
      if (icr::kInit.is_set(in.hp_wdata) && icr::kRreq.is_set(in.hp_wdata)) {
        rxdf_ = false;
        htde_ = true;
      }
      break;
    case kCvr:
      cvr_ = in.hp_wdata;
      break;
    case kIvr:
      ivr_ = in.hp_wdata;
      break;
    case kData5:
      set_byte(tx_, hlend ? 0 : 16, in.hp_wdata);
      break;
    case kData6:
      set_byte(tx_, 8, in.hp_wdata);
      break;
    case kData7:
      set_byte(tx_, hlend ? 16 : 0, in.hp_wdata);
      txde_ = false;
      break;
    default:
      break;
  }
}

void HostPort::reset_registers() {
  reset_host_side();
  hcr_ = regs::hi08::kHcr.reset;
  hbar_ = regs::hi08::kHbar.reset;
  hpcr_ = regs::hi08::kHpcr.reset;
  tx_ = horx_ = hotx_ = rx_ = 0;
  saw_ = false;
}

}  // namespace brick
