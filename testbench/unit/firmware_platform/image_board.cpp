#include "testbench/unit/firmware_platform/image_board.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "rtl/regs/brick_regs.h"

namespace brick {
namespace {

constexpr std::uint32_t kPmac = 0xC0000000u, kMainWords = 0x40000;
constexpr Cycle kDeviceCycles = 9;

}  // namespace

std::string firmware_image() {
  const char* other = std::getenv("BRICK_IMAGE");
  return other ? other : BRICK_FIRMWARE_ELF;
}

ImageBoard::ImageBoard(const std::string& elf, std::uint32_t fitted) : cpu_(this), fitted_(fitted) {
  Cpu::RegionOptions read_only, words;
  read_only.read_only = true;
  words.mask24 = true;
  words.wait = 1;
  cpu_.map(0x10000000u, 0x100000u, {});
  cpu_.map(0x20000000u, 0x200000u, {});
  std::memset(cpu_.map(0x30000000u, 0x100000u, {}), 0xFF, 0x100000u);
  const std::uint32_t straps[6] = {0, fitted, 603382, 32768, 1, 0};
  std::memcpy(cpu_.map(0x3FFFF000u, 0x1000u, read_only), straps, sizeof straps);
  cpu_.map(kPmac, kMainWords * 8, words);
  const ElfFile image(elf);
  image.load(cpu_);
  entry_ = image.entry();
  reset();
}

ImageBoard::~ImageBoard() {
  const char* file = std::getenv("BRICK_EXECUTED");
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  if (!file || !test) return;
  std::ofstream out(file, std::ios::app);
  out << test->test_suite_name() << '.' << test->name();
  for (const std::uint32_t address : cpu_.executed()) out << ' ' << address;
  out << '\n';
}

void ImageBoard::reset(Cycle clock_phase) {
  cpu_.reset(entry_);
  next_phase_ = cpu_.cycle() + kPhaseCycles - clock_phase % kPhaseCycles;
  phases_ = static_cast<unsigned>(clock_phase / kPhaseCycles);
  reset_at_ = last_strobe_ = cpu_.cycle();
  longest_gap_ = clocks_started_ = 0;
}

std::uint32_t ImageBoard::word(bool x, std::uint32_t address) {
  std::uint32_t value = 0;
  if (address < kMainWords)
    std::memcpy(&value, cpu_.memory(kPmac + 8 * address + (x ? 4 : 0), 4), 4);
  else
    value = registers_[address * 2 + x];
  return value;
}

void ImageBoard::fill_memory(std::uint32_t pattern) {
  auto* memory = cpu_.memory(kPmac, kMainWords * 8);
  for (std::uint32_t i = 0; i < kMainWords * 2; ++i) std::memcpy(memory + 4 * i, &pattern, 4);
}

void ImageBoard::update_host_line() {
  const bool receive = (hcr_ & HI08_HCR_HRIE_MASK) != 0 && !to_cpu_.empty();
  cpu_.set_interrupt(kIrqHostPort, receive || (hcr_ & HI08_HCR_HTIE_MASK) != 0);
}

DeviceBus::Result ImageBoard::access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) {
  Result result{false, 0, now + kDeviceCycles};
  if (bytes != 4 || address < kPmac) return {true, 0, now};
  ++accesses_;
  const std::uint32_t word = (address - kPmac) / 8;
  const bool x = (address & 4) != 0;
  if (word == HI08_X_HSR) {
    result.data = (to_cpu_.empty() ? 0 : HI08_HSR_HRDF_MASK) | HI08_HSR_HTDE_MASK;
  } else if (word == HI08_X_HORX) {
    if (!to_cpu_.empty()) {
      result.data = to_cpu_.front();
      to_cpu_.pop_front();
    }
  } else if (word == HI08_X_HOTX) {
    from_cpu_ += static_cast<char>(data);
  } else if (word == HI08_X_HCR && write) {
    hcr_ = data;
  } else if (word >= SERVO_IC_0_BASE && word < 0x07C000) {
    const bool drives =
        (data & (SERVO_IC_CLOCK_CONTROL_PHASE_EXTERNAL_MASK | SERVO_IC_CLOCK_CONTROL_SERVO_EXTERNAL_MASK)) == 0;
    const bool clock_word = x && word == SERVO_IC_0_BASE + SERVO_IC_X_CLOCK_CONTROL;
    if (write && clock_word && drives && clocks_started_ == 0) clocks_started_ = now - reset_at_;
    static const std::uint32_t bases[] = GATE_IC_BASES;
    result.data = 0xFFFFFF;
    for (unsigned ic = 0; ic < GATE_IC_COUNT; ++ic) {
      if (word - bases[ic] >= 0x20 || (fitted_ >> ic & 1) == 0) continue;
      if (write) registers_[word * 2 + x] = data;
      result.data = registers_[word * 2 + x];
    }
  } else if (write) {
    if (word == BOARD_LATCHES_X_WATCHDOG_STROBE) {
      ++strobes_;
      longest_gap_ = std::max(longest_gap_, now - last_strobe_);
      last_strobe_ = now;
    }
    registers_[word * 2 + x] = data;
  } else {
    result.data = registers_[word * 2 + x];
  }
  update_host_line();
  return result;
}

void ImageBoard::step(Cycle limit) {
  const Cycle end = std::min(limit, next_phase_);
  while (cpu_.cycle() < end && cpu_.run(on_instruction ? cpu_.cycle() + 1 : end) != Cpu::Stop::kSleep) {
    if (on_instruction) on_instruction();
  }
  if (cpu_.asleep() && cpu_.cycle() < end) cpu_.set_cycle(end);
  if (cpu_.cycle() < next_phase_) return;
  next_phase_ += kPhaseCycles;
  if (!clocks_ || clocks_started_ == 0) return;  // no IC drives them yet
  cpu_.set_interrupt(kIrqPhase, true);
  if (++phases_ % 4 == 0) cpu_.set_interrupt(kIrqServo, true);
}

void ImageBoard::run_ms(double ms) {
  const Cycle end = cpu_.cycle() + static_cast<Cycle>(ms * kCyclesPerMs);
  while (cpu_.cycle() < end) step(end);
}

std::string ImageBoard::send(const std::string& characters, double limit_ms) {
  to_cpu_.insert(to_cpu_.end(), characters.begin(), characters.end());
  update_host_line();
  const Cycle end = cpu_.cycle() + static_cast<Cycle>(limit_ms * kCyclesPerMs);
  const auto complete = [this] {
    if (from_cpu_.empty() || !to_cpu_.empty()) return false;
    const bool error = from_cpu_.find('\a') != std::string::npos;
    return from_cpu_.back() == '\x06' || (error && from_cpu_.back() == '\r');
  };
  while (cpu_.cycle() < end && !complete()) step(std::min(end, cpu_.cycle() + 100));
  std::string reply;
  reply.swap(from_cpu_);
  return reply;
}

}  // namespace brick
