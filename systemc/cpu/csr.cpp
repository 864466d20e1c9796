// Control and status registers, trap entry and return. Machine mode only; what is not listed here is illegal.
#include "systemc/cpu/cpu_state.h"
#include "systemc/cpu/cycle_costs.h"

namespace brick {

using namespace cpu;

namespace {

constexpr std::uint32_t kMstatus = 0x300, kMisa = 0x301, kMie = 0x304, kMtvec = 0x305, kMstatush = 0x310,
                        kMcountinhibit = 0x320, kMscratch = 0x340, kMepc = 0x341, kMcause = 0x342, kMtval = 0x343,
                        kMip = 0x344, kMcycle = 0xB00, kMinstret = 0xB02, kMcycleh = 0xB80, kMinstreth = 0xB82,
                        kCycle = 0xC00, kInstret = 0xC02, kCycleh = 0xC80, kInstreth = 0xC82, kMvendorid = 0xF11,
                        kMconfigptr = 0xF15;
constexpr std::uint32_t kMisaValue = 0x40001104;  // 32 bits; I, M, C
constexpr std::uint32_t kStatusMie = 1u << 3, kStatusMpie = 1u << 7, kStatusMpp = 3u << 11;
constexpr std::uint32_t kLines = 1u << kIrqPhase | 1u << kIrqServo | 1u << kIrqHostPort | 1u << kIrqRealTime;
constexpr std::uint32_t kWritableLines = kLines & ~(1u << kIrqHostPort);  // the host port is a level

constexpr bool in(std::uint32_t number, std::uint32_t first, std::uint32_t last) {
  return number >= first && number <= last;
}

// Event counters and their selectors exist and are zero.
constexpr bool is_zero_counter(std::uint32_t n) {
  return in(n, 0xB03, 0xB1F) || in(n, 0xB83, 0xB9F) || in(n, 0x323, 0x33F);
}

constexpr std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
constexpr std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
constexpr std::uint64_t with_low(std::uint64_t v, std::uint32_t w) { return (v >> 32 << 32) | w; }
constexpr std::uint64_t with_high(std::uint64_t v, std::uint32_t w) {
  return static_cast<std::uint64_t>(w) << 32 | low(v);
}

}  // namespace

bool Cpu::State::read_csr(std::uint32_t number, std::uint32_t& v) const {
  const std::uint64_t cycles = static_cast<std::uint64_t>(cycle) + mcycle_offset;
  const std::uint64_t instructions = retired + minstret_offset;
  switch (number) {
    case kMstatus:
      v = kStatusMpp | (interrupts_on ? kStatusMie : 0) | (interrupts_were ? kStatusMpie : 0);
      return true;
    case kMisa:
      v = kMisaValue;
      return true;
    case kMie:
      v = mie;
      return true;
    case kMtvec:
      v = mtvec;
      return true;
    case kMscratch:
      v = mscratch;
      return true;
    case kMepc:
      v = mepc;
      return true;
    case kMcause:
      v = mcause;
      return true;
    case kMtval:
      v = mtval;
      return true;
    case kMip:
      v = mip;
      return true;
    case kMcycle:
    case kCycle:
      v = low(cycles);
      return true;
    case kMcycleh:
    case kCycleh:
      v = high(cycles);
      return true;
    case kMinstret:
    case kInstret:
      v = low(instructions);
      return true;
    case kMinstreth:
    case kInstreth:
      v = high(instructions);
      return true;
    default:
      v = 0;
      return number == kMstatush || number == kMcountinhibit || is_zero_counter(number) ||
             in(number, kMvendorid, kMconfigptr);
  }
}

void Cpu::State::write_csr(std::uint32_t number, std::uint32_t v) {
  const std::uint64_t now = static_cast<std::uint64_t>(cycle);
  const std::uint64_t next = retired + 1;  // the writing instruction does not count itself
  switch (number) {
    case kMstatus:
      interrupts_on = (v & kStatusMie) != 0;
      interrupts_were = (v & kStatusMpie) != 0;
      break;
    case kMie:
      mie = v & kLines;
      break;
    case kMtvec:
      mtvec = v & ~2u;
      break;
    case kMscratch:
      mscratch = v;
      break;
    case kMepc:
      mepc = v & ~1u;
      break;
    case kMcause:
      mcause = v;
      break;
    case kMtval:
      mtval = v;
      break;
    case kMip:
      mip = (mip & ~kWritableLines) | (v & kWritableLines);
      break;
    case kMcycle:
      mcycle_offset = with_low(now + mcycle_offset, v) - now;
      break;
    case kMcycleh:
      mcycle_offset = with_high(now + mcycle_offset, v) - now;
      break;
    case kMinstret:
      minstret_offset = with_low(retired + minstret_offset, v) - next;
      break;
    case kMinstreth:
      minstret_offset = with_high(retired + minstret_offset, v) - next;
      break;
    default:
      break;  // hard-wired
  }
}

bool Cpu::State::csr_instruction(std::uint32_t word) {
  const std::uint32_t number = word >> 20, function = word >> 12 & 7, field = word >> 15 & 31, rd = word >> 7 & 31;
  const std::uint32_t source = (function & 4) != 0 ? field : x[field];
  const unsigned kind = function & 3;  // 1 write, 2 set, 3 clear
  const bool writes = kind == 1 || field != 0;
  const bool read_only = number >> 10 == 3;
  std::uint32_t old = 0;
  if ((writes && read_only) || !read_csr(number, old)) return false;
  if (writes) write_csr(number, kind == 1 ? source : kind == 2 ? old | source : old & ~source);
  if (rd != 0) x[rd] = old;
  return true;
}

std::uint32_t Cpu::State::interrupt_cause() const {
  const std::uint32_t ready = mip & mie;
  for (const unsigned line : {kIrqHostPort, kIrqPhase, kIrqServo}) {
    if ((ready >> line & 1) != 0) return 0x80000000u | line;
  }
  return 0x80000000u | kIrqRealTime;
}

std::uint32_t Cpu::State::trap(std::uint32_t cause, std::uint32_t at, std::uint32_t tval) {
  mepc = at;
  mcause = cause;
  mtval = tval;
  if (cpu.on_trap) cpu.on_trap(cause, at, cycle);
  interrupts_were = interrupts_on;
  interrupts_on = false;
  cycle += cost::kTrap;
  const bool vectored = (mtvec & 1) != 0 && (cause & 0x80000000u) != 0;
  return (mtvec & ~3u) + (vectored ? 4 * (cause & 0x7FFFFFFFu) : 0);
}

std::uint32_t Cpu::State::leave_trap() {
  interrupts_on = interrupts_were;
  interrupts_were = true;
  return mepc;
}

}  // namespace brick
