#include "systemc/host/pic_8259.h"

namespace brick {

namespace words = regs::pic_8259;

static_assert(((words::kOcw2.address ^ words::kIcw1.address) & 3) == 0 &&
              ((words::kOcw3.address ^ words::kIcw1.address) & 3) == 0);
static_assert(((words::kIcw2.address ^ words::kOcw1.address) & 3) == 0 &&
              ((words::kIcw4.address ^ words::kOcw1.address) & 3) == 0);

unsigned Pic8259::Registers::rank(std::uint8_t bits) const {
  unsigned r = 0;
  while (r < 8 && (bits >> level_of(r) & 1) == 0) ++r;
  return r;
}

std::uint8_t Pic8259::rdata() const {
  if (in.addr > kAcknowledge) return 0xFF;
  const Registers& r = registers_;
  const unsigned acked = r.acknowledged(line2_);
  if (in.addr == kAcknowledge)
    return static_cast<std::uint8_t>(words::vector::kBase.at(r.vector) | words::vector::kIr.at(acked));
  if (r.poll) return static_cast<std::uint8_t>(words::poll::kPending.at(pending()) | words::poll::kIr.at(acked));
  return in.addr == kMask ? r.imr : r.read_isr ? r.isr : irr();
}

bool Pic8259::idle() const {
  return !in.rd && !in.wr && in.line == line1_ && line1_ == line2_ &&
         (registers_.armed | static_cast<std::uint8_t>(~line2_)) == registers_.armed;
}

Pic8259::Registers Pic8259::coming() const {
  Registers next = registers_;
  if (reads_poll()) next.poll = false;
  if (in.wr && in.addr == kCommand) next.write_command(in.wdata);
  if (in.wr && in.addr == kMask) next.write_second(in.wdata);
  if (served()) next.acknowledge(registers_.acknowledged(line2_));  // never with a write
  next.armed |= static_cast<std::uint8_t>(~line2_);  // a line that is low now arms its next edge, whatever clears it
  return next;
}

void Pic8259::step() {
  registers_ = coming();
  line2_ = line1_;
  line1_ = in.line;
}

void Pic8259::Registers::acknowledge(unsigned acked) {
  const auto bit = static_cast<std::uint8_t>(1u << acked);
  armed &= ~bit;
  if (!aeoi)
    isr |= bit;
  else if (turn)
    lowest = acked;
}

void Pic8259::Registers::write_command(std::uint8_t byte) {
  using namespace words::ocw3;
  if (words::icw1::kIcw1.is_set(byte)) return write_icw1(byte);
  if (!kOcw3.is_set(byte)) return write_ocw2(byte);
  if (kEsmm.is_set(byte)) special = kSmm.is_set(byte);
  if (kRr.is_set(byte)) read_isr = kRis.is_set(byte);
  poll = kPoll.is_set(byte);
}

void Pic8259::Registers::write_icw1(std::uint8_t byte) {
  level = words::icw1::kLtim.is_set(byte);
  icw3 = !words::icw1::kSngl.is_set(byte);
  icw4 = words::icw1::kIc4.is_set(byte);
  armed = isr = imr = 0;
  lowest = kDefaultLevel;
  turn = aeoi = special = read_isr = poll = false;
  step = Step::kIcw2;
}

void Pic8259::Registers::write_ocw2(std::uint8_t byte) {
  using namespace words::ocw2;
  const bool rotates = kRotate.is_set(byte), specific = kSl.is_set(byte), end = kEoi.is_set(byte);
  const unsigned highest = rank(serviced());
  const unsigned named = specific ? kIr.get(byte) : level_of(highest);
  if (end) {
    if (!specific && highest == 8) return;
    isr &= static_cast<std::uint8_t>(~(1u << named));
    if (rotates) lowest = named;
  } else if (!specific) {
    turn = rotates;
  } else if (rotates) {
    lowest = named;
  }
}

void Pic8259::Registers::write_second(std::uint8_t byte) {
  switch (step) {
    case Step::kReady:
      imr = byte;
      break;
    case Step::kIcw2:
      vector = static_cast<std::uint8_t>(words::icw2::kVector.get(byte));
      step = icw3 ? Step::kIcw3 : icw4 ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw3:
      step = icw4 ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw4:
      aeoi = words::icw4::kAeoi.is_set(byte);
      step = Step::kReady;
      break;
  }
}

void Pic8259::reset_registers() {
  line1_ = line2_ = 0xFF;  // none is armed before it has been seen low
  registers_ = Registers();
}

}  // namespace brick
