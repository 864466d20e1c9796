#include "systemc/cpu/decode.h"

namespace brick::cpu {
namespace {

constexpr std::uint32_t bits(std::uint32_t word, unsigned high, unsigned low) {
  return (word >> low) & ((1u << (high - low + 1)) - 1u);
}

constexpr std::int32_t sign_extend(std::uint32_t value, unsigned width) {
  return static_cast<std::int32_t>(value << (32 - width)) >> (32 - width);
}

constexpr std::int32_t imm_i(std::uint32_t w) { return static_cast<std::int32_t>(w) >> 20; }
constexpr std::int32_t imm_s(std::uint32_t w) { return sign_extend(bits(w, 31, 25) << 5 | bits(w, 11, 7), 12); }
constexpr std::int32_t imm_b(std::uint32_t w) {
  return sign_extend(bits(w, 31, 31) << 12 | bits(w, 7, 7) << 11 | bits(w, 30, 25) << 5 | bits(w, 11, 8) << 1, 13);
}
constexpr std::int32_t imm_j(std::uint32_t w) {
  return sign_extend(bits(w, 31, 31) << 20 | bits(w, 19, 12) << 12 | bits(w, 20, 20) << 11 | bits(w, 30, 21) << 1, 21);
}

constexpr bool is_link(unsigned reg) { return reg == 1 || reg == 5; }  // ra and the alternate link register t0

// Operation of a full instruction; the operand fields are filled in by decode_full.
Op op_register(std::uint32_t w) {
  const unsigned f3 = bits(w, 14, 12);
  static constexpr Op kBase[8] = {Op::kAdd, Op::kSll, Op::kSlt, Op::kSltu, Op::kXor, Op::kSrl, Op::kOr, Op::kAnd};
  static constexpr Op kMultiply[8] = {Op::kMul, Op::kMulh, Op::kMulhsu, Op::kMulhu,
                                      Op::kDiv, Op::kDivu, Op::kRem,    Op::kRemu};
  switch (bits(w, 31, 25)) {
    case 0x00:
      return kBase[f3];
    case 0x01:
      return kMultiply[f3];
    case 0x20:
      return f3 == 0 ? Op::kSub : f3 == 5 ? Op::kSra : Op::kIllegal;
    default:
      return Op::kIllegal;
  }
}

Op op_immediate(std::uint32_t w) {
  const unsigned f7 = bits(w, 31, 25);
  switch (bits(w, 14, 12)) {
    case 0:
      return Op::kAddi;
    case 1:
      return f7 == 0 ? Op::kSlli : Op::kIllegal;
    case 2:
      return Op::kSlti;
    case 3:
      return Op::kSltiu;
    case 4:
      return Op::kXori;
    case 5:
      return f7 == 0 ? Op::kSrli : f7 == 0x20 ? Op::kSrai : Op::kIllegal;
    case 6:
      return Op::kOri;
    default:
      return Op::kAndi;
  }
}

Op op_system(std::uint32_t w) {
  const unsigned f3 = bits(w, 14, 12);
  if (f3 == 4) return Op::kIllegal;
  if (f3 != 0) return Op::kCsr;
  switch (w) {
    case 0x00000073:
      return Op::kEcall;
    case 0x00100073:
      return Op::kEbreak;
    case 0x30200073:
      return Op::kMret;
    case 0x10500073:
      return Op::kWfi;
    default:
      return Op::kIllegal;
  }
}

Decoded decode_full(std::uint32_t w, std::uint32_t pc) {
  static constexpr Op kLoads[8] = {Op::kLb,  Op::kLh,  Op::kLw,      Op::kIllegal,
                                   Op::kLbu, Op::kLhu, Op::kIllegal, Op::kIllegal};
  static constexpr Op kBranches[8] = {Op::kBeq, Op::kBne, Op::kIllegal, Op::kIllegal,
                                      Op::kBlt, Op::kBge, Op::kBltu,    Op::kBgeu};
  const unsigned f3 = bits(w, 14, 12);
  Decoded d;
  d.rd = static_cast<std::uint8_t>(bits(w, 11, 7));
  d.rs1 = static_cast<std::uint8_t>(bits(w, 19, 15));
  d.rs2 = static_cast<std::uint8_t>(bits(w, 24, 20));
  d.imm = imm_i(w);
  switch (bits(w, 6, 0)) {
    case 0x33:
      d.op = op_register(w);
      break;
    case 0x13:
      d.op = op_immediate(w);
      if (f3 == 1 || f3 == 5) d.imm = d.rs2;  // shift amount
      break;
    case 0x03:
      d.op = kLoads[f3];
      break;
    case 0x23:
      d.op = f3 == 0 ? Op::kSb : f3 == 1 ? Op::kSh : f3 == 2 ? Op::kSw : Op::kIllegal;
      d.imm = imm_s(w);
      break;
    case 0x63:
      d.op = kBranches[f3];
      d.imm = imm_b(w) / 2;
      break;
    case 0x6F:
      d.op = d.rd == 0 ? Op::kJump : Op::kJal;
      d.imm = imm_j(w) / 2;
      break;
    case 0x67:
      d.op = f3 == 0 ? Op::kJalr : Op::kIllegal;
      d.rs2 = is_link(d.rd) || is_link(d.rs1);
      break;
    case 0x37:
      d.op = Op::kLi;
      d.imm = static_cast<std::int32_t>(w & 0xFFFFF000u);
      break;
    case 0x17:  // auipc: its address is known here
      d.op = Op::kLi;
      d.imm = static_cast<std::int32_t>((w & 0xFFFFF000u) + pc);
      break;
    case 0x0F:
      d.op = f3 == 0 ? Op::kFence : f3 == 1 ? Op::kFenceI : Op::kIllegal;
      break;
    case 0x73:
      d.op = op_system(w);
      d.imm = static_cast<std::int32_t>(w);
      break;
    default:
      d.op = Op::kIllegal;
      break;
  }
  if (d.rd == 0) d.rd = kDiscard;
  return d;
}

// The operation with a length of two bytes. Those without one (ebreak, illegal) trap, so their length does not matter.
Op compressed(Op op) {
  switch (op) {
#define BRICK_CPU_ONE(name) \
  case Op::k##name:         \
    return Op::k##name;
#define BRICK_CPU_TWO(name) \
  case Op::k##name:         \
  case Op::kC##name:        \
    return Op::kC##name;
    BRICK_CPU_OPERATIONS(BRICK_CPU_ONE, BRICK_CPU_TWO)
#undef BRICK_CPU_ONE
#undef BRICK_CPU_TWO
  }
  return op;
}

}  // namespace

Decoded decode(std::uint32_t word, std::uint32_t pc) {
  Decoded d;
  if (is_compressed(word)) {
    d = decode_full(expand(static_cast<std::uint16_t>(word)), pc);
    d.op = compressed(d.op);
  } else {
    d = decode_full(word, pc);
  }
  if (d.op == Op::kIllegal) d.imm = static_cast<std::int32_t>(word);  // becomes mtval
  return d;
}

}  // namespace brick::cpu
