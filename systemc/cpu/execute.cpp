// The execution loop: threaded code over predecoded instructions. Each operation ends by adding its cost and jumping
// straight to the next one, so the host's branch predictor sees one indirect jump an operation. The loop's variables
// stay in host registers; they are written back to State before anything else may look at it.
#include <climits>
#include <cstring>

#include "systemc/cpu/cpu_state.h"
#include "systemc/cpu/cycle_costs.h"

namespace brick {

using namespace cpu;

namespace {

constexpr std::int32_t as_signed(std::uint32_t v) { return static_cast<std::int32_t>(v); }

std::uint32_t mul_high_signed(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(as_signed(a)) * as_signed(b) >> 32);
}
std::uint32_t mul_high_mixed(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(as_signed(a)) * static_cast<std::int64_t>(b) >> 32);
}
std::uint32_t mul_high_unsigned(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(a) * b >> 32);
}

// Division never traps: by zero it gives all ones and the dividend, on overflow the dividend and zero.
bool overflows(std::uint32_t a, std::uint32_t b) { return as_signed(a) == INT_MIN && as_signed(b) == -1; }
std::uint32_t divide(std::uint32_t a, std::uint32_t b) {
  if (b == 0) return ~0u;
  return overflows(a, b) ? a : static_cast<std::uint32_t>(as_signed(a) / as_signed(b));
}
std::uint32_t remainder(std::uint32_t a, std::uint32_t b) {
  if (b == 0) return a;
  return overflows(a, b) ? 0 : static_cast<std::uint32_t>(as_signed(a) % as_signed(b));
}

}  // namespace

// The labels' table and the bodies share these. `step` is the instruction's length in halfwords.
#define NEXT(cycles)                                    \
  do {                                                  \
    cycle += (cycles);                                  \
    ++retired;                                          \
    if (__builtin_expect(cycle >= limit, 0)) goto stop; \
    goto* kLabels[static_cast<unsigned>(d->op)];        \
  } while (false)
#define STEP(cycles) \
  do {               \
    d += step;       \
    NEXT(cycles);    \
  } while (false)
#define FULL(name, ...)          \
  Run##name : {                  \
    constexpr unsigned step = 2; \
    static_cast<void>(step);     \
    __VA_ARGS__                  \
  }
#define BOTH(name, ...)          \
  FULL(name, __VA_ARGS__)        \
  RunC##name : {                 \
    constexpr unsigned step = 1; \
    static_cast<void>(step);     \
    __VA_ARGS__                  \
  }

#define PC_OF(entry_pointer) (page->base + 2 * static_cast<std::uint32_t>((entry_pointer)-page->entry.data()))
#define COMPUTE(...)        \
  {                         \
    x[d->rd] = __VA_ARGS__; \
    STEP(cost::kSimple);    \
  }
#define MULTIPLY(cycles, ...) \
  {                           \
    x[d->rd] = __VA_ARGS__;   \
    STEP(cycles);             \
  }
// Goes `d->imm` halfwords on; a target outside the page is looked up.
#define GO(cycles)                                                                               \
  {                                                                                              \
    const std::uint32_t index =                                                                  \
        static_cast<std::uint32_t>(d - page->entry.data()) + static_cast<std::uint32_t>(d->imm); \
    if (__builtin_expect(index < kPageEntries, 1)) {                                             \
      d = &page->entry[index];                                                                   \
      NEXT(cycles);                                                                              \
    }                                                                                            \
    target = page->base + 2 * index;                                                             \
    cycle += (cycles);                                                                           \
    ++retired;                                                                                   \
    goto boundary;                                                                               \
  }
#define BRANCH(condition)                 \
  {                                       \
    if (condition) GO(cost::kBranchTaken) \
    STEP(cost::kSimple);                  \
  }
#define LOAD(Type, Extended)                                                                  \
  {                                                                                           \
    address = x[d->rs1] + static_cast<std::uint32_t>(d->imm);                                 \
    const LoadEntry& e = s.load_tlb[tlb_index(address)];                                      \
    if (__builtin_expect(e.tag == (address & (kPageMask | (sizeof(Type) - 1))), 1)) {         \
      Type v;                                                                                 \
      std::memcpy(&v, e.host + (address & ~kPageMask), sizeof v);                             \
      x[d->rd] = static_cast<std::uint32_t>(static_cast<Extended>(v));                        \
      d += step;                                                                              \
      NEXT(cost::kLoad + e.wait);                                                             \
    }                                                                                         \
    s.pc = PC_OF(d);                                                                          \
    s.cycle = cycle;                                                                          \
    s.retired = retired;                                                                      \
    outcome = s.load(address, sizeof(Type));                                                  \
    cycle = s.cycle;                                                                          \
    if (outcome == Access::kFault) goto access_fault;                                         \
    if (outcome == Access::kRetry) goto retry;                                                \
    x[d->rd] = static_cast<std::uint32_t>(static_cast<Extended>(static_cast<Type>(s.value))); \
    d += step;                                                                                \
    if (outcome == Access::kDone) NEXT(cost::kLoad);                                          \
    cycle += cost::kLoad;                                                                     \
    goto leave;                                                                               \
  }
#define STORE(Type, tag, keep)                                                        \
  {                                                                                   \
    address = x[d->rs1] + static_cast<std::uint32_t>(d->imm);                         \
    const StoreEntry& e = s.store_tlb[tlb_index(address)];                            \
    if (__builtin_expect(e.tag == (address & (kPageMask | (sizeof(Type) - 1))), 1)) { \
      const Type v = static_cast<Type>(x[d->rs2] & (keep));                           \
      const Cycle wait = e.wait;                                                      \
      std::memcpy(e.host + (address & ~kPageMask), &v, sizeof v);                     \
      if (__builtin_expect(e.has_code, 0)) s.code_changed(address, sizeof v);         \
      d += step;                                                                      \
      NEXT(cost::kStore + wait);                                                      \
    }                                                                                 \
    s.pc = PC_OF(d);                                                                  \
    s.cycle = cycle;                                                                  \
    s.retired = retired;                                                              \
    outcome = s.store(address, sizeof(Type), x[d->rs2]);                              \
    cycle = s.cycle;                                                                  \
    if (outcome == Access::kFault) goto access_fault;                                 \
    if (outcome == Access::kRetry) goto retry;                                        \
    d += step;                                                                        \
    if (outcome == Access::kDone) NEXT(cost::kStore);                                 \
    cycle += cost::kStore;                                                            \
    goto leave;                                                                       \
  }

Cpu::Stop Cpu::execute(Cycle limit) {
#define BRICK_CPU_ONE(name) &&Run##name,
#define BRICK_CPU_TWO(name) &&Run##name, &&RunC##name,
  static const void* const kLabels[] = {BRICK_CPU_OPERATIONS(BRICK_CPU_ONE, BRICK_CPU_TWO)};
#undef BRICK_CPU_ONE
#undef BRICK_CPU_TWO

  State& s = *s_;
  if (s.sleeping) return Stop::kSleep;
  std::uint32_t* const x = s.x.data();
  const bool flow = static_cast<bool>(on_flow);
  Cycle cycle = s.cycle;
  std::uint64_t retired = s.retired;
  std::uint32_t target = s.pc, cause = 0, tval = 0, address = 0, word = 0;
  Access outcome = Access::kDone;
  CodePage* page = nullptr;
  Decoded* d = nullptr;

boundary:  // between two instructions, the next one at `target`; interrupts may have become ready
  if (cycle >= limit) {
    s.pc = target;
    s.cycle = cycle;
    s.retired = retired;
    return Stop::kLimit;
  }
  if (__builtin_expect(s.interrupt_ready() && !s.access_waits, 0)) {
    s.pc = target;
    s.cycle = cycle;
    s.retired = retired;
    target = s.trap(s.interrupt_cause(), target, 0);
    cycle = s.cycle;
    goto boundary;
  }
look_up:
  page = s.code_page(target);
  if (__builtin_expect(page == nullptr, 0)) {
    s.pc = target;
    s.cycle = cycle;
    s.retired = retired;
    target = s.trap(kFetchFault, target, target);
    cycle = s.cycle;
    goto trapped;
  }
  d = &page->entry[(target & ~kPageMask) / 2];
  goto* kLabels[static_cast<unsigned>(d->op)];

access_fault:  // of a load or store
  cause = s.fault;
  tval = address;
exception:  // the instruction at d does not retire
  s.pc = PC_OF(d);
  s.cycle = cycle;
  s.retired = retired;
  target = s.trap(cause, s.pc, tval);
  cycle = s.cycle;
  // A device that refuses an access has been accessed all the same: its time has passed and pins may have moved.
  if (s.device_accessed) {
    s.device_accessed = false;
    s.pc = target;
    return Stop::kDevice;
  }
trapped:  // by an exception
  if (__builtin_expect(s.stops_at_exceptions, 0)) {
    s.pc = target;
    return Stop::kException;
  }
  goto boundary;

retry:  // the instruction at d waits for a device; s.pc, s.cycle and s.retired stand before it
  return Stop::kDevice;

leave:  // the instruction before d made the caller's attention due
  s.pc = PC_OF(d);
  s.cycle = cycle;
  s.retired = retired + 1;
  return outcome == Access::kHalt ? Stop::kHalt : Stop::kDevice;

stop:
  s.pc = PC_OF(d);
  s.cycle = cycle;
  s.retired = retired;
  return Stop::kLimit;

  FULL(Decode, {
    const std::uint32_t at = PC_OF(d);
    if (!s.fetch(at, word, tval)) {
      cause = kFetchFault;
      goto exception;
    }
    *d = decode(word, at);
    goto* kLabels[static_cast<unsigned>(d->op)];
  })
  FULL(PageEnd, {
    target = PC_OF(d);
    goto look_up;
  })
  FULL(Illegal, {
    cause = kIllegalInstruction;
    tval = static_cast<std::uint32_t>(d->imm);
    goto exception;
  })

  BOTH(Add, COMPUTE(x[d->rs1] + x[d->rs2]))
  BOTH(Sub, COMPUTE(x[d->rs1] - x[d->rs2]))
  BOTH(Xor, COMPUTE(x[d->rs1] ^ x[d->rs2]))
  BOTH(Or, COMPUTE(x[d->rs1] | x[d->rs2]))
  BOTH(And, COMPUTE(x[d->rs1] & x[d->rs2]))
  FULL(Sll, COMPUTE(x[d->rs1] << (x[d->rs2] & 31)))
  FULL(Srl, COMPUTE(x[d->rs1] >> (x[d->rs2] & 31)))
  FULL(Sra, COMPUTE(static_cast<std::uint32_t>(as_signed(x[d->rs1]) >> (x[d->rs2] & 31))))
  FULL(Slt, COMPUTE(as_signed(x[d->rs1]) < as_signed(x[d->rs2])))
  FULL(Sltu, COMPUTE(x[d->rs1] < x[d->rs2]))
  BOTH(Addi, COMPUTE(x[d->rs1] + static_cast<std::uint32_t>(d->imm)))
  BOTH(Andi, COMPUTE(x[d->rs1] & static_cast<std::uint32_t>(d->imm)))
  FULL(Xori, COMPUTE(x[d->rs1] ^ static_cast<std::uint32_t>(d->imm)))
  FULL(Ori, COMPUTE(x[d->rs1] | static_cast<std::uint32_t>(d->imm)))
  FULL(Slti, COMPUTE(as_signed(x[d->rs1]) < d->imm))
  FULL(Sltiu, COMPUTE(x[d->rs1] < static_cast<std::uint32_t>(d->imm)))
  BOTH(Slli, COMPUTE(x[d->rs1] << d->imm))
  BOTH(Srli, COMPUTE(x[d->rs1] >> d->imm))
  BOTH(Srai, COMPUTE(static_cast<std::uint32_t>(as_signed(x[d->rs1]) >> d->imm)))
  BOTH(Li, COMPUTE(static_cast<std::uint32_t>(d->imm)))

  FULL(Mul, MULTIPLY(cost::kMul, x[d->rs1] * x[d->rs2]))
  FULL(Mulh, MULTIPLY(cost::kMulHigh, mul_high_signed(x[d->rs1], x[d->rs2])))
  FULL(Mulhsu, MULTIPLY(cost::kMulHigh, mul_high_mixed(x[d->rs1], x[d->rs2])))
  FULL(Mulhu, MULTIPLY(cost::kMulHigh, mul_high_unsigned(x[d->rs1], x[d->rs2])))
  FULL(Div, MULTIPLY(cost::kDivide, divide(x[d->rs1], x[d->rs2])))
  FULL(Divu, MULTIPLY(cost::kDivide, x[d->rs2] == 0 ? ~0u : x[d->rs1] / x[d->rs2]))
  FULL(Rem, MULTIPLY(cost::kDivide, remainder(x[d->rs1], x[d->rs2])))
  FULL(Remu, MULTIPLY(cost::kDivide, x[d->rs2] == 0 ? x[d->rs1] : x[d->rs1] % x[d->rs2]))

  BOTH(Lw, LOAD(std::uint32_t, std::uint32_t))
  FULL(Lh, LOAD(std::uint16_t, std::int16_t))
  FULL(Lhu, LOAD(std::uint16_t, std::uint16_t))
  FULL(Lb, LOAD(std::uint8_t, std::int8_t))  // NOLINT(bugprone-signed-char-misuse): extends the sign
  FULL(Lbu, LOAD(std::uint8_t, std::uint8_t))
  BOTH(Sw, STORE(std::uint32_t, word_tag, e.mask))
  FULL(Sh, STORE(std::uint16_t, part_tag, 0xFFFFu))
  FULL(Sb, STORE(std::uint8_t, part_tag, 0xFFu))

  BOTH(Beq, BRANCH(x[d->rs1] == x[d->rs2]))
  BOTH(Bne, BRANCH(x[d->rs1] != x[d->rs2]))
  FULL(Blt, BRANCH(as_signed(x[d->rs1]) < as_signed(x[d->rs2])))
  FULL(Bge, BRANCH(as_signed(x[d->rs1]) >= as_signed(x[d->rs2])))
  FULL(Bltu, BRANCH(x[d->rs1] < x[d->rs2]))
  FULL(Bgeu, BRANCH(x[d->rs1] >= x[d->rs2]))
  BOTH(Jump, GO(cost::kJump))
  BOTH(Jal, {
    const std::uint32_t at = PC_OF(d);
    x[d->rd] = at + 2 * step;
    if (__builtin_expect(flow, 0) && (d->rd == 1 || d->rd == 5)) {
      s.pc = at;
      s.cycle = cycle;
      s.retired = retired;
      on_flow(at + 2 * static_cast<std::uint32_t>(d->imm), cycle + cost::kJump);
    }
    GO(cost::kJump)
  })
  BOTH(Jalr, {
    target = (x[d->rs1] + static_cast<std::uint32_t>(d->imm)) & ~1u;
    x[d->rd] = PC_OF(d + step);
    cycle += cost::kJump;
    if (__builtin_expect(flow, 0) && d->rs2 != 0) {
      s.pc = PC_OF(d);
      s.cycle = cycle - cost::kJump;
      s.retired = retired;
      on_flow(target, cycle);
    }
    ++retired;
    goto boundary;
  })

  FULL(Fence, STEP(cost::kSimple);)
  FULL(FenceI, {
    s.invalidate_code();
    STEP(cost::kFenceI);
  })
  FULL(Ecall, {
    cause = kEnvironmentCall;
    tval = 0;
    goto exception;
  })
  FULL(Ebreak, {
    cause = kBreakpoint;
    tval = PC_OF(d);
    goto exception;
  })
  FULL(Mret, {
    target = s.leave_trap();
    cycle += cost::kMret;
    ++retired;
    if (on_mret) {
      s.pc = target;
      s.cycle = cycle;
      s.retired = retired;
      on_mret(target, cycle);
    }
    goto boundary;
  })
  FULL(Wfi, {
    target = PC_OF(d + step);
    cycle += cost::kSimple;
    ++retired;
    if ((s.mip & s.mie) != 0) goto boundary;
    s.pc = target;
    s.cycle = cycle;
    s.retired = retired;
    s.sleeping = true;
    return Stop::kSleep;
  })
  FULL(Csr, {
    s.cycle = cycle;
    s.retired = retired;
    if (!s.csr_instruction(static_cast<std::uint32_t>(d->imm))) {
      cause = kIllegalInstruction;
      tval = static_cast<std::uint32_t>(d->imm);
      goto exception;
    }
    target = PC_OF(d + step);
    cycle += cost::kCsr;
    ++retired;
    goto boundary;
  })
}

}  // namespace brick
