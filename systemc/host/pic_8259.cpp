#include "systemc/host/pic_8259.h"

namespace brick {

namespace words = regs::pic_8259;

static_assert(((words::kOcw2.address ^ words::kIcw1.address) & 3) == 0 &&
              ((words::kOcw3.address ^ words::kIcw1.address) & 3) == 0);
static_assert(((words::kIcw2.address ^ words::kOcw1.address) & 3) == 0 &&
              ((words::kIcw4.address ^ words::kOcw1.address) & 3) == 0);

unsigned Pic8259::rank(std::uint8_t bits) const {
  for (unsigned r = 0; r < 8; ++r)
    if ((bits >> level_of(r) & 1) != 0) return r;
  return 8;
}

std::uint8_t Pic8259::rdata() const {
  if (in.addr > kAcknowledge) return 0xFF;
  const unsigned acked = acknowledged();
  if (in.addr == kAcknowledge)
    return static_cast<std::uint8_t>(words::vector::kBase.at(vector_) | words::vector::kIr.at(acked));
  if (poll_) return static_cast<std::uint8_t>(words::poll::kPending.at(pending()) | words::poll::kIr.at(acked));
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
  using namespace words::ocw3;
  if (words::icw1::kIcw1.is_set(in.wdata)) return write_icw1();
  if (!kOcw3.is_set(in.wdata)) return write_ocw2();
  if (kEsmm.is_set(in.wdata)) special_ = kSmm.is_set(in.wdata);
  if (kRr.is_set(in.wdata)) read_isr_ = kRis.is_set(in.wdata);
  poll_ = kPoll.is_set(in.wdata);
}

void Pic8259::write_icw1() {
  level_ = words::icw1::kLtim.is_set(in.wdata);
  icw3_ = !words::icw1::kSngl.is_set(in.wdata);
  icw4_ = words::icw1::kIc4.is_set(in.wdata);
  armed_ = isr_ = imr_ = 0;
  lowest_ = kDefaultLevel;
  turn_ = aeoi_ = special_ = read_isr_ = poll_ = false;
  step_ = Step::kIcw2;
}

void Pic8259::write_ocw2() {
  using namespace words::ocw2;
  const bool turn = kRotate.is_set(in.wdata), specific = kSl.is_set(in.wdata), end = kEoi.is_set(in.wdata);
  const unsigned highest = rank(serviced());
  const unsigned level = specific ? kIr.get(in.wdata) : level_of(highest);
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
      vector_ = static_cast<std::uint8_t>(words::icw2::kVector.get(in.wdata));
      step_ = icw3_ ? Step::kIcw3 : icw4_ ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw3:
      step_ = icw4_ ? Step::kIcw4 : Step::kReady;
      break;
    case Step::kIcw4:
      aeoi_ = words::icw4::kAeoi.is_set(in.wdata);
      step_ = Step::kReady;
      break;
  }
}

void Pic8259::reset_registers() {
  line1_ = line2_ = armed_ = isr_ = vector_ = 0;
  imr_ = words::kOcw1.reset;
  lowest_ = kDefaultLevel;
  step_ = Step::kReady;
  icw3_ = icw4_ = level_ = aeoi_ = turn_ = special_ = read_isr_ = poll_ = false;
}

}  // namespace brick
