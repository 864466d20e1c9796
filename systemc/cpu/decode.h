// Turns instruction words into the eight-byte form that the execution loop runs. Compressed instructions are expanded
// to the full instruction they stand for, so there is one decoder; the length lives on in the operation (kAdd / kCAdd).
#pragma once

#include <cstdint>

namespace brick::cpu {

// Every operation; TWO marks those that have compressed forms and so exist with a length of four and of two bytes. Laid
// out by hand: clang-format changes its mind about this list each time.
// clang-format off
#define BRICK_CPU_OPERATIONS(ONE, TWO) \
  ONE(Decode) ONE(PageEnd) ONE(Illegal) TWO(Add) TWO(Sub) TWO(Xor) TWO(Or) TWO(And) \
  ONE(Sll) ONE(Slt) ONE(Sltu) ONE(Srl) ONE(Sra) TWO(Addi) TWO(Andi) TWO(Slli) \
  TWO(Srli) TWO(Srai) ONE(Slti) ONE(Sltiu) ONE(Xori) ONE(Ori) TWO(Li) TWO(Lw) \
  TWO(Sw) ONE(Lb) ONE(Lh) ONE(Lbu) ONE(Lhu) ONE(Sb) ONE(Sh) TWO(Jump) \
  TWO(Jal) TWO(Jalr) TWO(Beq) TWO(Bne) ONE(Blt) ONE(Bge) ONE(Bltu) ONE(Bgeu) \
  ONE(Mul) ONE(Mulh) ONE(Mulhsu) ONE(Mulhu) ONE(Div) ONE(Divu) ONE(Rem) ONE(Remu) \
  ONE(Fence) ONE(FenceI) ONE(Ecall) ONE(Ebreak) ONE(Mret) ONE(Wfi) ONE(Csr)
// clang-format on

enum class Op : std::uint8_t {
#define BRICK_CPU_ONE(name) k##name,
#define BRICK_CPU_TWO(name) k##name, kC##name,
  BRICK_CPU_OPERATIONS(BRICK_CPU_ONE, BRICK_CPU_TWO)
#undef BRICK_CPU_ONE
#undef BRICK_CPU_TWO
};

// Register written when an instruction names x0 as its destination: a place that nobody reads.
constexpr std::uint8_t kDiscard = 32;

struct Decoded {
  Op op = Op::kDecode;
  std::uint8_t rd = 0;  // kDiscard for x0
  std::uint8_t rs1 = 0;
  std::uint8_t rs2 = 0;  // kJalr: 1 if it is a call or a return
  std::int32_t imm =
      0;  // kLi: the value; branches and jumps: distance in halfwords; kCsr, kIllegal: the instruction word
};
static_assert(sizeof(Decoded) == 8, "one entry of the cache is eight bytes");

constexpr bool is_compressed(std::uint32_t word) { return (word & 3u) != 3u; }

// The full instruction that a compressed one stands for; 0 (an illegal instruction) for reserved and floating-point
// forms.
std::uint32_t expand(std::uint16_t halfword);

// Decodes the instruction at `pc`; `word` holds the halfword alone in its low bits when it is compressed.
Decoded decode(std::uint32_t word, std::uint32_t pc);

}  // namespace brick::cpu
