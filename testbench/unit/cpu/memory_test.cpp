// Loads and stores, kinds of regions, devices, watched words, and code that changes under the CPU.
#include <stdexcept>

#include "testbench/unit/cpu/cpu_bench.h"

namespace brick {
namespace {

class CpuMemory : public CpuBench {
 protected:
  CpuMemory() { set_csr(rv::mtvec, kCode + 0x3000); }
  std::uint32_t load(rv::Word (*op)(unsigned, unsigned, int), std::uint32_t address) {
    jump(kCode);
    cpu.set_reg(rv::a0, address - 5);
    execute(op(rv::a1, rv::a0, 5));
    EXPECT_EQ(cpu.pc(), kCode + 4) << std::hex << address;
    return cpu.reg(rv::a1);
  }
  Cycle store(rv::Word (*op)(unsigned, unsigned, int), std::uint32_t address, std::uint32_t value) {
    jump(kCode);
    cpu.set_reg(rv::a0, address + 7);
    cpu.set_reg(rv::a1, value);
    return execute(op(rv::a1, rv::a0, -7));
  }
};

TEST_F(CpuMemory, LoadsExtendBySignOrZero) {
  set_word(kData, 0x807F'FF80);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(load(rv::lw, kData), 0x807F'FF80u);
    EXPECT_EQ(load(rv::lh, kData), 0xFFFF'FF80u);
    EXPECT_EQ(load(rv::lhu, kData), 0x0000'FF80u);
    EXPECT_EQ(load(rv::lh, kData + 2), 0xFFFF'807Fu);
    EXPECT_EQ(load(rv::lhu, kData + 2), 0x0000'807Fu);
    const std::uint32_t as_signed[] = {0xFFFF'FF80, 0xFFFF'FFFF, 0x7F, 0xFFFF'FF80},
                        as_unsigned[] = {0x80, 0xFF, 0x7F, 0x80};
    for (std::uint32_t n = 0; n < 4; ++n) {
      EXPECT_EQ(load(rv::lb, kData + n), as_signed[n]);
      EXPECT_EQ(load(rv::lbu, kData + n), as_unsigned[n]);
    }
  }
}

TEST_F(CpuMemory, StoresChangeTheirBytesOnly) {
  for (int round = 0; round < 2; ++round) {
    store(rv::sw, kData + 8, 0x1122'3344);
    store(rv::sb, kData + 9, 0xFFFF'FFAA);
    EXPECT_EQ(word(kData + 8), 0x1122'AA44u);
    store(rv::sh, kData + 10, 0xFFFF'5566);
    EXPECT_EQ(word(kData + 8), 0x5566'AA44u);
    EXPECT_EQ(word(kData + 12), 0u);
    EXPECT_EQ(word(kData + 4), 0u);
  }
}

TEST_F(CpuMemory, LastBytesOfARegionAndTheFirstBeyond) {
  store(rv::sb, kData + kDataBytes - 1, 0x5A);
  EXPECT_EQ(load(rv::lbu, kData + kDataBytes - 1), 0x5Au);
  EXPECT_TRUE(device.accesses.empty());
  load(rv::lbu, kData + kDataBytes);
  EXPECT_EQ(device.accesses.size(), 1u);
}

TEST_F(CpuMemory, SmallAndUnevenRegions) {  // smaller than a page, two in one page
  std::uint8_t* const a = cpu.map(0x3FFF'F000, 24, {});
  cpu.map(0x3FFF'F018, 8, {});
  a[20] = 99;
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(load(rv::lbu, 0x3FFF'F014), 99u);
    store(rv::sw, 0x3FFF'F01C, 77);
    EXPECT_EQ(load(rv::lw, 0x3FFF'F01C), 77u);
    EXPECT_TRUE(device.accesses.empty());
  }
  load(rv::lw, 0x3FFF'F020);
  EXPECT_EQ(device.accesses.size(), 1u);
}

TEST_F(CpuMemory, MappingRulesAreChecked) {
  EXPECT_THROW(cpu.map(kCode + 0x1000, 0x1000, {}), std::invalid_argument) << "inside another";
  EXPECT_THROW(cpu.map(kCode - 0x1000, 0x10000, {}), std::invalid_argument) << "around another";
  EXPECT_THROW(cpu.map(kCode - 4, 8, {}), std::invalid_argument) << "its end in another";
  EXPECT_THROW(cpu.map(0xFFFF'F000, 0x2000, {}), std::invalid_argument) << "past the end";
  EXPECT_THROW(cpu.map(0x100, 2, {}), std::invalid_argument) << "half a word";
  EXPECT_NO_THROW(cpu.map(kCode - 4, 4, {})) << "a neighbour";
  EXPECT_NO_THROW(cpu.map(0xFFFF'F000, 0x1000, {})) << "the last page";
  EXPECT_EQ(load(rv::lw, 0xFFFF'FFFC), 0u);
  EXPECT_EQ(cpu.mappings().size(), 4u);
}

TEST_F(CpuMemory, ReadOnlyMemoryRefusesStores) {
  cpu.map(0x3000'0000, 0x1000, {true, false, 0});
  set_word(0x3000'0010, 4711);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(load(rv::lw, 0x3000'0010), 4711u);
    store(rv::sw, 0x3000'0010, 1);
    EXPECT_EQ(csr(rv::mcause), 7u);
    EXPECT_EQ(csr(rv::mtval), 0x3000'0010u);
    EXPECT_EQ(word(0x3000'0010), 4711u);
  }
}

TEST_F(CpuMemory, SharedMemoryIsReadAsItStandsAndNeverWritten) {
  std::uint32_t theirs[1024] = {1, 2, 3};
  cpu.share(0x3000'0000, sizeof theirs, reinterpret_cast<const std::uint8_t*>(theirs));
  EXPECT_EQ(load(rv::lw, 0x3000'0004), 2u);
  theirs[1] = 22;
  EXPECT_EQ(load(rv::lw, 0x3000'0004), 22u);
  store(rv::sw, 0x3000'0004, 7);
  EXPECT_EQ(csr(rv::mcause), 7u);
  EXPECT_EQ(theirs[1], 22u);
  EXPECT_THROW(cpu.share(0x3000'0FFC, 8, reinterpret_cast<const std::uint8_t*>(theirs)), std::invalid_argument);
}

TEST_F(CpuMemory, Mask24KeepsTheLow24BitsOfEachWord) {
  cpu.map(0xC000'0000, 0x2000, {false, true, 0});
  for (int round = 0; round < 2; ++round) {
    store(rv::sw, 0xC000'0000, 0xFFFF'FFFF);
    EXPECT_EQ(load(rv::lw, 0xC000'0000), 0x00FF'FFFFu);
    store(rv::sb, 0xC000'0003, 0x12);
    EXPECT_EQ(load(rv::lw, 0xC000'0000), 0x00FF'FFFFu);
    store(rv::sh, 0xC000'0002, 0x3456);
    EXPECT_EQ(load(rv::lw, 0xC000'0000), 0x0056'FFFFu);
    store(rv::sb, 0xC000'0001, 0x12);
    EXPECT_EQ(load(rv::lw, 0xC000'0000), 0x0056'12FFu);
    EXPECT_EQ(load(rv::lw, 0xC000'0004), 0u);
  }
}

TEST_F(CpuMemory, WaitStatesCostCyclesAndCanBeChanged) {
  cpu.map(0xC000'0000, 0x2000, {false, true, 3});
  const auto load_cost = [&](std::uint32_t address) {
    const Cycle before = cpu.cycle();
    load(rv::lw, address);
    return cpu.cycle() - before - 2;  // the jump of load() costs two
  };
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(load_cost(0xC000'0000), 5);
    EXPECT_EQ(store(rv::sw, 0xC000'0004, 1), 4);
    EXPECT_EQ(store(rv::sb, 0xC000'0004, 1), 4);
    EXPECT_EQ(load_cost(kData), 2) << "other memory waits for nothing";
    EXPECT_EQ(store(rv::sw, kData, 1), 1);
  }
  cpu.set_wait(0xC000'0000, 9);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(load_cost(0xC000'0000), 11);
    EXPECT_EQ(store(rv::sw, 0xC000'0004, 1), 10);
  }
}

// Devices ------------------------------------------------------------------------------------------------------------

TEST_F(CpuMemory, DeviceAccessEndsTheRunAfterItsInstruction) {
  cpu.set_reg(rv::a0, kDevice);
  cpu.set_reg(rv::a1, 0xAABB'CCDD);
  put(kCode, {rv::nop(), rv::lw(rv::a2, rv::a0, 4), rv::sw(rv::a1, rv::a0, 8), rv::nop()});
  const Cycle start = cpu.cycle();
  device.duration = 37;
  EXPECT_EQ(cpu.run(start + 2), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.pc(), kCode + 8);
  EXPECT_EQ(cpu.reg(rv::a2), 0x89AB'CDEFu);
  EXPECT_EQ(cpu.cycle(), start + 1 + 37 + 2) << "nop, access, cost of a load";
  EXPECT_EQ(cpu.run(start + 1000), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.pc(), kCode + 12);
  EXPECT_EQ(cpu.cycle(), start + 40 + 37 + 1);
  ASSERT_EQ(device.accesses.size(), 2u);
  EXPECT_EQ(device.accesses[0].address, kDevice + 4);
  EXPECT_EQ(device.accesses[0].now, start + 1) << "begins with its instruction";
  EXPECT_FALSE(device.accesses[0].write);
  EXPECT_TRUE(device.accesses[1].write);
  EXPECT_EQ(device.accesses[1].data, 0xAABB'CCDDu);
  EXPECT_EQ(device.accesses[1].now, start + 40);
}

TEST_F(CpuMemory, NarrowDeviceAccesses) {
  EXPECT_EQ(load(rv::lb, kDevice + 1), 0xFFFF'FFEFu);
  EXPECT_EQ(load(rv::lbu, kDevice + 1), 0xEFu);
  EXPECT_EQ(load(rv::lh, kDevice + 2), 0xFFFF'CDEFu);
  EXPECT_EQ(load(rv::lhu, kDevice + 2), 0xCDEFu);
  store(rv::sb, kDevice + 3, 0x1234'5678);
  store(rv::sh, kDevice + 2, 0x1234'5678);
  EXPECT_EQ(device.accesses[0].bytes, 1u);
  EXPECT_EQ(device.accesses[2].bytes, 2u);
  EXPECT_EQ(device.accesses[4].data, 0x78u);
  EXPECT_EQ(device.accesses[5].data, 0x5678u);
}

TEST_F(CpuMemory, RefusedDeviceAccessTakesItsTimeAndEndsTheRun) {
  cpu.set_reg(rv::a0, 0xD000'0000);
  put(kCode, {rv::lw(rv::a2, rv::a0, 0)});
  const Cycle start = cpu.cycle();
  EXPECT_EQ(cpu.run(start + 1000), Cpu::Stop::kDevice);
  EXPECT_EQ(cpu.cycle(), start + 10 + 4) << "access, trap entry";
  EXPECT_EQ(cpu.pc(), kCode + 0x3000);
}

TEST_F(CpuMemory, ProgramCounterNamesTheInstructionDuringAnAccess) {
  struct Looker : DeviceBus {
    Result access(std::uint32_t, unsigned, bool, std::uint32_t, Cycle now) override {
      pc = cpu->pc();
      cycle = cpu->cycle();
      return {false, 0, now};
    }
    Cpu* cpu = nullptr;
    std::uint32_t pc = 0;
    Cycle cycle = -1;
  } looker;
  Cpu other(&looker);
  looker.cpu = &other;
  const rv::Word program[] = {rv::nop(), rv::nop(), rv::sw(0, 0, 16)};
  std::memcpy(other.map(kCode, 0x1000, {}), program, sizeof program);
  other.reset(kCode);
  other.run(100);
  EXPECT_EQ(looker.pc, kCode + 8);
  EXPECT_EQ(looker.cycle, 2);
}

// Watched words ------------------------------------------------------------------------------------------------------

TEST_F(CpuMemory, WatchedStoreHaltsWhenAsked) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seen;
  store(rv::sw, kData + 0x100, 1);  // the page is in the look-up table before the watch is set
  cpu.watch_store(kData + 0x100);
  cpu.on_store_watch = [&](std::uint32_t address, std::uint32_t value) {
    seen.emplace_back(address, value);
    return value == 3;
  };
  jump(kCode);
  cpu.set_reg(rv::a0, kData + 0x100);
  put(kCode, {rv::addi(rv::a1, 0, 2), rv::sw(rv::a1, rv::a0, 0), rv::sw(rv::a1, rv::a0, 4), rv::addi(rv::a1, 0, 3),
              rv::sw(rv::a1, rv::a0, 0), rv::nop()});
  EXPECT_EQ(cpu.run(cpu.cycle() + 1000), Cpu::Stop::kHalt);
  EXPECT_EQ(cpu.pc(), kCode + 20) << "behind the store";
  EXPECT_EQ(seen, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{kData + 0x100, 2}, {kData + 0x100, 3}}));
  EXPECT_EQ(word(kData + 0x100), 3u);
  EXPECT_EQ(word(kData + 0x104), 2u);
}

// Changing code ------------------------------------------------------------------------------------------------------

TEST_F(CpuMemory, StoreIntoCodeIsSeenByTheNextFetch) {
  cpu.set_reg(rv::a0, kCode);
  cpu.set_reg(rv::a1, rv::addi(rv::a2, rv::a2, 100));
  // A loop whose second instruction is replaced by the store in its first round.
  put(kCode, {rv::nop(), rv::addi(rv::a2, rv::a2, 1), rv::sw(rv::a1, rv::a0, 4), rv::jal(0, -12)});
  steps(8);
  EXPECT_EQ(cpu.reg(rv::a2), 101u);
  // The store replaces the instruction right behind it.
  jump(kCode);
  put(kCode, {rv::addi(rv::a2, 0, 0), rv::sw(rv::a1, rv::a0, 8), rv::nop()});
  steps(3);
  EXPECT_EQ(cpu.reg(rv::a2), 100u);
}

TEST_F(CpuMemory, NarrowStoresIntoCodeReachInstructionsAroundThem) {
  // At 0x22 a full instruction: stores to either half must be seen, also bytes.
  const rv::Word first = rv::addi(rv::a2, 0, 1), second = rv::addi(rv::a2, 0, 0x7FE);
  for (const bool bytes : {false, true}) {
    for (const std::uint32_t place : {kCode + 0x22, kCode + 0xFFE}) {  // the latter passes a page boundary
      for (int round = 0; round < 2; ++round) {
        jump(place);
        put_half(place, static_cast<std::uint16_t>(first));
        put_half(place + 2, static_cast<std::uint16_t>(first >> 16));
        step();
        ASSERT_EQ(cpu.reg(rv::a2), 1u);
        jump(kCode + 0x2000);
        cpu.set_reg(rv::a0, place + 2);
        cpu.set_reg(rv::a1, second >> 16);
        cpu.set_reg(rv::a4, second >> 24);
        if (bytes) {
          execute(rv::sb(rv::a1, rv::a0, 0));
          execute(rv::sb(rv::a4, rv::a0, 1));
        } else {
          execute(rv::sh(rv::a1, rv::a0, 0));
        }
        cpu.set_reg(rv::a5, place);
        execute(rv::jalr(0, rv::a5, 0));
        step();
        ASSERT_EQ(cpu.reg(rv::a2), 0x7FEu) << std::hex << place << ' ' << bytes;
      }
    }
  }
}

// The three below run without a look from outside, so that the look-up tables stay filled: a routine at `place` is
// called, changed by a store of the program itself, and called again.
class CpuSelfModifying : public CpuMemory {
 protected:
  // The routine sets a2, to 1 before the change and to 0x7FE after it.
  void call_change_call(std::uint32_t place, const std::vector<rv::Word>& routine, rv::Word store, std::uint32_t where,
                        std::uint32_t what) {
    put(kCode, {store, rv::jalr(rv::ra, rv::a0, 0), rv::add(rv::a4, rv::a2, 0), store, rv::jalr(rv::ra, rv::a0, 0),
                rv::ebreak()});
    for (std::size_t i = 0; i < routine.size(); ++i) {
      put_half(place + 4 * static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(routine[i]));
      put_half(place + 4 * static_cast<std::uint32_t>(i) + 2, static_cast<std::uint16_t>(routine[i] >> 16));
    }
    jump(kCode);
    cpu.set_reg(rv::a0, place);
    cpu.set_reg(rv::a3, where - 0x40);  // the first store goes beside, the second into the routine
    cpu.set_reg(rv::s0, what);
    steps(2 + static_cast<int>(routine.size()));  // store, call, routine
    EXPECT_EQ(cpu.reg(rv::a2), 1u);
    EXPECT_EQ(cpu.pc(), kCode + 8);
    cpu.set_reg(rv::a3, where);
    steps(3 + static_cast<int>(routine.size()));  // copy, store, call, routine
    EXPECT_EQ(cpu.reg(rv::a2), 0x7FEu);
    EXPECT_EQ(cpu.pc(), kCode + 20);
  }
};

const rv::Word kOne = rv::addi(rv::a2, 0, 1), kOther = rv::addi(rv::a2, 0, 0x7FE);

TEST_F(CpuSelfModifying, APageThatTurnsFromDataToCodeIsWatched) {
  call_change_call(kData + 0x100, {kOne, rv::jalr(0, rv::ra, 0)}, rv::sw(rv::s0, rv::a3, 0), kData + 0x100, kOther);
}

TEST_F(CpuSelfModifying, StoresIntoAKnownCodePageInvalidateEachTime) {
  call_change_call(kCode + 0x100, {kOne, rv::jalr(0, rv::ra, 0)}, rv::sw(rv::s0, rv::a3, 0), kCode + 0x100, kOther);
}

TEST_F(CpuSelfModifying, ASecondHalfInANeighbourPageIsWatched) {
  // The routine is one jump back whose second half, with the distance in it, lies in the next page.
  const rv::Word back = rv::jalr(0, rv::ra, 0), further = rv::jalr(0, rv::ra, 8);
  put(kCode, {rv::jalr(rv::ra, rv::a0, 0), rv::sh(rv::s0, rv::a3, 0), rv::sh(rv::s0, rv::s1, 0),
              rv::jalr(rv::ra, rv::a0, 0), rv::ebreak(), rv::ebreak(), rv::nop()});
  const std::uint32_t place = kData + 0xFFE;
  put_half(place, static_cast<std::uint16_t>(back));
  put_half(place + 2, static_cast<std::uint16_t>(back >> 16));
  jump(kCode);
  cpu.set_reg(rv::a0, place);
  cpu.set_reg(rv::a3, place + 0x42);  // brings the neighbour page into the table of stores
  cpu.set_reg(rv::s0, further >> 16);
  cpu.set_reg(rv::s1, place + 2);
  steps(2);
  EXPECT_EQ(cpu.pc(), kCode + 4);
  steps(4);
  EXPECT_EQ(cpu.pc(), kCode + 16 + 8) << "the changed distance";
}

TEST_F(CpuMemory, FullInstructionAcrossAPageRunsAndContinues) {
  jump(kCode + 0xFFA);
  const rv::Word w = rv::addi(rv::a2, rv::a2, 3);
  put_half(kCode + 0xFFA, static_cast<std::uint16_t>(w));
  put_half(kCode + 0xFFC, static_cast<std::uint16_t>(w >> 16));
  put_half(kCode + 0xFFE, static_cast<std::uint16_t>(w));
  put_half(kCode + 0x1000, static_cast<std::uint16_t>(w >> 16));
  put_half(kCode + 0x1002, static_cast<std::uint16_t>(w));
  put_half(kCode + 0x1004, static_cast<std::uint16_t>(w >> 16));
  const Cycle start = cpu.cycle();
  EXPECT_EQ(cpu.run(start + 3), Cpu::Stop::kLimit);
  EXPECT_EQ(cpu.reg(rv::a2), 9u);
  EXPECT_EQ(cpu.pc(), kCode + 0x1006);
  EXPECT_EQ(cpu.cycle(), start + 3);
}

TEST_F(CpuMemory, CodeChangedFromOutsideIsSeenAfterFenceI) {
  jump(kCode);
  put(kCode, {rv::addi(rv::a2, rv::a2, 1), rv::fence_i(), rv::jal(0, -8)});
  steps(1);
  set_word(kCode, rv::addi(rv::a2, rv::a2, 100));  // past the CPU, as a bus master would
  steps(3);
  EXPECT_EQ(cpu.reg(rv::a2), 101u);
  steps(1);
  set_word(kCode + 4, rv::nop());
  cpu.invalidate_code();
  const Cycle before = cpu.cycle();
  steps(2);  // jump, add
  steps(1);
  EXPECT_EQ(cpu.cycle() - before, 2 + 1 + 1) << "a nop has taken the place of fence.i";
}

}  // namespace
}  // namespace brick
