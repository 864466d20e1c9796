// Compressed instructions of RV32C, one by one, as the full instructions they stand for.
#include "systemc/cpu/decode.h"

namespace brick::cpu {
namespace {

constexpr std::uint32_t kIllegalWord = 0;

constexpr std::uint32_t bits(std::uint32_t word, unsigned high, unsigned low) {
  return (word >> low) & ((1u << (high - low + 1)) - 1u);
}

// Builders of full instructions, by format.
constexpr std::uint32_t r_type(unsigned f7, unsigned rs2, unsigned rs1, unsigned f3, unsigned rd) {
  return f7 << 25 | rs2 << 20 | rs1 << 15 | f3 << 12 | rd << 7 | 0x33u;
}
constexpr std::uint32_t i_type(std::uint32_t imm, unsigned rs1, unsigned f3, unsigned rd, unsigned opcode) {
  return (imm & 0xFFFu) << 20 | rs1 << 15 | f3 << 12 | rd << 7 | opcode;
}
constexpr std::uint32_t store_word(std::uint32_t imm, unsigned rs2, unsigned rs1) {
  return bits(imm, 11, 5) << 25 | rs2 << 20 | rs1 << 15 | 2u << 12 | bits(imm, 4, 0) << 7 | 0x23u;
}
constexpr std::uint32_t branch(std::uint32_t imm, unsigned rs1, unsigned f3) {
  return bits(imm, 12, 12) << 31 | bits(imm, 10, 5) << 25 | rs1 << 15 | f3 << 12 | bits(imm, 4, 1) << 8 |
         bits(imm, 11, 11) << 7 | 0x63u;
}
constexpr std::uint32_t jump(std::uint32_t imm, unsigned rd) {
  return bits(imm, 20, 20) << 31 | bits(imm, 10, 1) << 21 | bits(imm, 11, 11) << 20 | bits(imm, 19, 12) << 12 |
         rd << 7 | 0x6Fu;
}

// Sign-extended six-bit immediate of the CI format.
constexpr std::uint32_t imm6(std::uint32_t h) { return bits(h, 6, 2) | (bits(h, 12, 12) ? 0xFFFFFFE0u : 0u); }

constexpr std::uint32_t jump_distance(std::uint32_t h) {
  const std::uint32_t low = bits(h, 8, 8) << 10 | bits(h, 10, 9) << 8 | bits(h, 6, 6) << 7 | bits(h, 7, 7) << 6 |
                            bits(h, 2, 2) << 5 | bits(h, 11, 11) << 4 | bits(h, 5, 3) << 1;
  return low | (bits(h, 12, 12) ? 0xFFFFF800u : 0u);
}

constexpr std::uint32_t branch_distance(std::uint32_t h) {
  const std::uint32_t low = bits(h, 6, 5) << 6 | bits(h, 2, 2) << 5 | bits(h, 11, 10) << 3 | bits(h, 4, 3) << 1;
  return low | (bits(h, 12, 12) ? 0xFFFFFF00u : 0u);
}

constexpr unsigned reg3(std::uint32_t h, unsigned low) { return 8 + bits(h, low + 2, low); }  // x8..x15

std::uint32_t quadrant0(std::uint32_t h) {
  const std::uint32_t word_offset = bits(h, 5, 5) << 6 | bits(h, 12, 10) << 3 | bits(h, 6, 6) << 2;
  switch (bits(h, 15, 13)) {
    case 0: {  // c.addi4spn; 0 is reserved, and so is the all-zero halfword
      const std::uint32_t imm = bits(h, 10, 7) << 6 | bits(h, 12, 11) << 4 | bits(h, 5, 5) << 3 | bits(h, 6, 6) << 2;
      return imm == 0 ? kIllegalWord : i_type(imm, 2, 0, reg3(h, 2), 0x13);
    }
    case 2:
      return i_type(word_offset, reg3(h, 7), 2, reg3(h, 2), 0x03);  // c.lw
    case 6:
      return store_word(word_offset, reg3(h, 2), reg3(h, 7));  // c.sw
    default:
      return kIllegalWord;
  }
}

// c.srli, c.srai, c.andi and the register-register group.
std::uint32_t quadrant1_arithmetic(std::uint32_t h) {
  const unsigned rd = reg3(h, 7);
  const bool high_shift = bits(h, 12, 12) != 0;  // shift amounts of 32 and more are reserved in RV32
  switch (bits(h, 11, 10)) {
    case 0:
      return high_shift ? kIllegalWord : i_type(bits(h, 6, 2), rd, 5, rd, 0x13);
    case 1:
      return high_shift ? kIllegalWord : i_type(0x400 | bits(h, 6, 2), rd, 5, rd, 0x13);
    case 2:
      return i_type(imm6(h), rd, 7, rd, 0x13);
    default:
      break;
  }
  if (high_shift) return kIllegalWord;
  static constexpr unsigned kF3[4] = {0, 4, 6, 7};  // sub, xor, or, and
  const unsigned which = bits(h, 6, 5);
  return r_type(which == 0 ? 0x20 : 0, reg3(h, 2), rd, kF3[which], rd);
}

std::uint32_t quadrant1(std::uint32_t h) {
  const unsigned rd = bits(h, 11, 7);
  switch (bits(h, 15, 13)) {
    case 0:
      return i_type(imm6(h), rd, 0, rd, 0x13);  // c.addi, c.nop
    case 1:
      return jump(jump_distance(h), 1);  // c.jal
    case 2:
      return i_type(imm6(h), 0, 0, rd, 0x13);  // c.li
    case 3:
      if (rd == 2) {  // c.addi16sp
        const std::uint32_t imm = bits(h, 4, 3) << 7 | bits(h, 5, 5) << 6 | bits(h, 2, 2) << 5 | bits(h, 6, 6) << 4 |
                                  (bits(h, 12, 12) ? 0xFFFFFE00u : 0u);
        return imm == 0 ? kIllegalWord : i_type(imm, 2, 0, 2, 0x13);
      }
      return imm6(h) == 0 ? kIllegalWord : imm6(h) << 12 | rd << 7 | 0x37u;  // c.lui
    case 4:
      return quadrant1_arithmetic(h);
    case 5:
      return jump(jump_distance(h), 0);  // c.j
    case 6:
      return branch(branch_distance(h), reg3(h, 7), 0);  // c.beqz
    default:
      return branch(branch_distance(h), reg3(h, 7), 1);  // c.bnez
  }
}

std::uint32_t quadrant2(std::uint32_t h) {
  const unsigned rd = bits(h, 11, 7), rs2 = bits(h, 6, 2);
  const bool bit12 = bits(h, 12, 12) != 0;
  switch (bits(h, 15, 13)) {
    case 0:
      return bit12 ? kIllegalWord : i_type(rs2, rd, 1, rd, 0x13);  // c.slli
    case 2: {                                                      // c.lwsp
      const std::uint32_t imm = bits(h, 3, 2) << 6 | bits(h, 12, 12) << 5 | bits(h, 6, 4) << 2;
      return rd == 0 ? kIllegalWord : i_type(imm, 2, 2, rd, 0x03);
    }
    case 4:
      if (rs2 != 0) return r_type(0, rs2, bit12 ? rd : 0, 0, rd);  // c.add, c.mv
      if (rd != 0) return i_type(0, rd, 0, bit12 ? 1 : 0, 0x67);   // c.jalr, c.jr
      return bit12 ? 0x00100073u : kIllegalWord;                   // c.ebreak
    case 6:
      return store_word(bits(h, 8, 7) << 6 | bits(h, 12, 9) << 2, rs2, 2);  // c.swsp
    default:
      return kIllegalWord;
  }
}

}  // namespace

std::uint32_t expand(std::uint16_t halfword) {
  switch (halfword & 3) {
    case 0:
      return quadrant0(halfword);
    case 1:
      return quadrant1(halfword);
    case 2:
      return quadrant2(halfword);
    default:
      return kIllegalWord;
  }
}

}  // namespace brick::cpu
