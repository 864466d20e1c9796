// A tiny assembler for the tests of the CPU: one function an instruction, written from the RISC-V formats and on
// purpose apart from the decoder of the model. Registers are plain numbers.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace rv {

using Word = std::uint32_t;
enum Register : unsigned {
  zero = 0,
  ra = 1,
  sp = 2,
  gp = 3,
  t0 = 5,
  t1 = 6,
  t2 = 7,
  s0 = 8,
  s1 = 9,
  a0 = 10,
  a1 = 11,
  a2 = 12,
  a3 = 13,
  a4 = 14,
  a5 = 15
};

constexpr Word field(Word v, unsigned high, unsigned low) { return (v >> low) & ((1u << (high - low + 1)) - 1); }

// Formats.
constexpr Word r(unsigned f7, unsigned f3, unsigned rd, unsigned rs1, unsigned rs2, unsigned opcode = 0x33) {
  return f7 << 25 | rs2 << 20 | rs1 << 15 | f3 << 12 | rd << 7 | opcode;
}
constexpr Word i(unsigned opcode, unsigned f3, unsigned rd, unsigned rs1, int imm) {
  return field(static_cast<Word>(imm), 11, 0) << 20 | rs1 << 15 | f3 << 12 | rd << 7 | opcode;
}
constexpr Word s(unsigned f3, unsigned rs2, unsigned rs1, int imm) {
  const Word v = static_cast<Word>(imm);
  return field(v, 11, 5) << 25 | rs2 << 20 | rs1 << 15 | f3 << 12 | field(v, 4, 0) << 7 | 0x23;
}
constexpr Word b(unsigned f3, unsigned rs1, unsigned rs2, int imm) {
  const Word v = static_cast<Word>(imm);
  return field(v, 12, 12) << 31 | field(v, 10, 5) << 25 | rs2 << 20 | rs1 << 15 | f3 << 12 | field(v, 4, 1) << 8 |
         field(v, 11, 11) << 7 | 0x63;
}

// RV32I.
constexpr Word lui(unsigned rd, Word top20) { return top20 << 12 | rd << 7 | 0x37; }
constexpr Word auipc(unsigned rd, Word top20) { return top20 << 12 | rd << 7 | 0x17; }
constexpr Word jal(unsigned rd, int imm) {
  const Word v = static_cast<Word>(imm);
  return field(v, 20, 20) << 31 | field(v, 10, 1) << 21 | field(v, 11, 11) << 20 | field(v, 19, 12) << 12 | rd << 7 |
         0x6F;
}
constexpr Word jalr(unsigned rd, unsigned rs1, int imm) { return i(0x67, 0, rd, rs1, imm); }
constexpr Word beq(unsigned x, unsigned y, int imm) { return b(0, x, y, imm); }
constexpr Word bne(unsigned x, unsigned y, int imm) { return b(1, x, y, imm); }
constexpr Word blt(unsigned x, unsigned y, int imm) { return b(4, x, y, imm); }
constexpr Word bge(unsigned x, unsigned y, int imm) { return b(5, x, y, imm); }
constexpr Word bltu(unsigned x, unsigned y, int imm) { return b(6, x, y, imm); }
constexpr Word bgeu(unsigned x, unsigned y, int imm) { return b(7, x, y, imm); }
constexpr Word lb(unsigned rd, unsigned rs1, int imm) { return i(3, 0, rd, rs1, imm); }
constexpr Word lh(unsigned rd, unsigned rs1, int imm) { return i(3, 1, rd, rs1, imm); }
constexpr Word lw(unsigned rd, unsigned rs1, int imm) { return i(3, 2, rd, rs1, imm); }
constexpr Word lbu(unsigned rd, unsigned rs1, int imm) { return i(3, 4, rd, rs1, imm); }
constexpr Word lhu(unsigned rd, unsigned rs1, int imm) { return i(3, 5, rd, rs1, imm); }
constexpr Word sb(unsigned rs2, unsigned rs1, int imm) { return s(0, rs2, rs1, imm); }
constexpr Word sh(unsigned rs2, unsigned rs1, int imm) { return s(1, rs2, rs1, imm); }
constexpr Word sw(unsigned rs2, unsigned rs1, int imm) { return s(2, rs2, rs1, imm); }
constexpr Word addi(unsigned rd, unsigned rs1, int imm) { return i(0x13, 0, rd, rs1, imm); }
constexpr Word slti(unsigned rd, unsigned rs1, int imm) { return i(0x13, 2, rd, rs1, imm); }
constexpr Word sltiu(unsigned rd, unsigned rs1, int imm) { return i(0x13, 3, rd, rs1, imm); }
constexpr Word xori(unsigned rd, unsigned rs1, int imm) { return i(0x13, 4, rd, rs1, imm); }
constexpr Word ori(unsigned rd, unsigned rs1, int imm) { return i(0x13, 6, rd, rs1, imm); }
constexpr Word andi(unsigned rd, unsigned rs1, int imm) { return i(0x13, 7, rd, rs1, imm); }
constexpr Word slli(unsigned rd, unsigned rs1, unsigned n) { return r(0, 1, rd, rs1, n, 0x13); }
constexpr Word srli(unsigned rd, unsigned rs1, unsigned n) { return r(0, 5, rd, rs1, n, 0x13); }
constexpr Word srai(unsigned rd, unsigned rs1, unsigned n) { return r(0x20, 5, rd, rs1, n, 0x13); }
constexpr Word add(unsigned rd, unsigned x, unsigned y) { return r(0, 0, rd, x, y); }
constexpr Word nop() { return addi(0, 0, 0); }
constexpr Word fence() { return 0x0FF0000F; }
constexpr Word fence_i() { return 0x0000100F; }
constexpr Word ecall() { return 0x00000073; }
constexpr Word ebreak() { return 0x00100073; }
constexpr Word mret() { return 0x30200073; }
constexpr Word wfi() { return 0x10500073; }

// Zicsr.
constexpr Word csrrw(unsigned rd, unsigned csr, unsigned rs1) {
  return csr << 20 | rs1 << 15 | 1u << 12 | rd << 7 | 0x73;
}
constexpr Word csrrs(unsigned rd, unsigned csr, unsigned rs1) {
  return csr << 20 | rs1 << 15 | 2u << 12 | rd << 7 | 0x73;
}
constexpr Word csrrc(unsigned rd, unsigned csr, unsigned rs1) {
  return csr << 20 | rs1 << 15 | 3u << 12 | rd << 7 | 0x73;
}
constexpr Word csrrwi(unsigned rd, unsigned csr, unsigned imm) { return csrrw(rd, csr, imm) | 4u << 12; }
constexpr Word csrrsi(unsigned rd, unsigned csr, unsigned imm) { return csrrs(rd, csr, imm) | 4u << 12; }
constexpr Word csrrci(unsigned rd, unsigned csr, unsigned imm) { return csrrc(rd, csr, imm) | 4u << 12; }

enum Csr : unsigned {
  mstatus = 0x300,
  misa = 0x301,
  mie = 0x304,
  mtvec = 0x305,
  mscratch = 0x340,
  mepc = 0x341,
  mcause = 0x342,
  mtval = 0x343,
  mip = 0x344,
  mcycle = 0xB00,
  minstret = 0xB02,
  mcycleh = 0xB80,
  minstreth = 0xB82,
  cycle = 0xC00,
  time = 0xC01,
  instret = 0xC02,
  cycleh = 0xC80,
  instreth = 0xC82,
  mvendorid = 0xF11,
  mhartid = 0xF14,
};

// A full constant in two instructions.
inline std::vector<Word> li(unsigned rd, Word v) {
  return {lui(rd, (v + 0x800) >> 12), addi(rd, rd, static_cast<int>(v & 0xFFF))};
}

}  // namespace rv
