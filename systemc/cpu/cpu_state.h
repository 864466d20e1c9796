// Inside of the CPU: registers, control and status registers, mapped memory with its look-up tables, and the pages of
// predecoded instructions. Private to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

#include "systemc/cpu/cpu.h"
#include "systemc/cpu/decode.h"

namespace brick {
namespace cpu {

constexpr std::uint32_t kPageBytes = 4096;
constexpr std::uint32_t kPageMask = ~(kPageBytes - 1);
constexpr std::uint32_t kPageEntries = kPageBytes / 2;
constexpr std::uint32_t kTlbSize = 256;
constexpr std::uint32_t kNoTag = 0xFFC;  // no address masked to page and alignment bits has these bits
constexpr std::uint32_t tlb_index(std::uint32_t address) { return address / kPageBytes % kTlbSize; }

enum Cause : std::uint32_t {
  kFetchFault = 1,
  kIllegalInstruction = 2,
  kBreakpoint = 3,
  kLoadMisaligned = 4,
  kLoadFault = 5,
  kStoreMisaligned = 6,
  kStoreFault = 7,
  kEnvironmentCall = 11,
};

struct FreeOwned {
  bool owned = true;
  void operator()(void* p) const {
    if (owned) std::free(p);
  }
};

struct Region {
  std::uint32_t base, bytes;
  Cpu::RegionOptions options;
  std::unique_ptr<std::uint8_t, FreeOwned> data;  // from calloc: the host gives pages when they are touched
  bool holds(std::uint32_t address, std::uint32_t count) const {
    return address >= base && address - base < bytes && count <= bytes - (address - base);
  }
};

// One page of predecoded instructions, an entry a halfword. A full instruction in the last halfword ends in the second
// of the two entries behind it; both leave the page.
struct CodePage {
  explicit CodePage(std::uint32_t page_base) : base(page_base) { clear(); }
  void clear() {
    entry.fill(Decoded{});
    entry[kPageEntries].op = entry[kPageEntries + 1].op = Op::kPageEnd;
  }
  std::uint32_t base;
  std::array<Decoded, kPageEntries + 2> entry;
};

// A page that loads reach directly: the tag is the page address, compared with the alignment bits of the access, so a
// misaligned address never matches.
struct LoadEntry {
  std::uint32_t tag = kNoTag;
  std::uint8_t* host = nullptr;
  Cycle wait = 0;
};

// The same for stores. Pages with a watched word are never entered.
struct StoreEntry {
  std::uint32_t word_tag = kNoTag;
  std::uint32_t part_tag = kNoTag;  // for bytes and halfwords: not entered for 24-bit memory
  std::uint32_t mask = 0;
  bool has_code = false;
  std::uint8_t* host = nullptr;
  Cycle wait = 0;
};

enum class Access { kDone, kDevice, kHalt, kFault, kRetry };

}  // namespace cpu

struct Cpu::State {
  State(Cpu& owner, DeviceBus* bus) : cpu(owner), devices(bus) { forget_translations(); }

  void check_free(std::uint32_t base, std::uint32_t bytes) const;  // throws std::invalid_argument

  // memory.cpp
  cpu::Region* find(std::uint32_t address, std::uint32_t bytes);
  void forget_translations();
  cpu::Access load(std::uint32_t address, unsigned bytes);                       // slow path: result in `value`
  cpu::Access store(std::uint32_t address, unsigned bytes, std::uint32_t data);  // slow path
  cpu::CodePage* code_page(std::uint32_t at);                                    // nullptr: nothing mapped there
  bool fetch(std::uint32_t at, std::uint32_t& word, std::uint32_t& fault_address);
  void code_changed(std::uint32_t address, unsigned bytes);
  void invalidate_code();
  void add_decoded(std::set<std::uint32_t>& addresses) const;  // an instruction is decoded when it is executed

  // csr.cpp
  bool csr_instruction(std::uint32_t word);  // false: illegal
  bool read_csr(std::uint32_t number, std::uint32_t& v) const;
  void write_csr(std::uint32_t number, std::uint32_t v);
  bool interrupt_ready() const { return interrupts_on && (mip & mie) != 0; }
  std::uint32_t interrupt_cause() const;                                          // the most urgent one
  std::uint32_t trap(std::uint32_t cause, std::uint32_t at, std::uint32_t tval);  // returns the handler's address
  std::uint32_t leave_trap();                                                     // mret: returns mepc

  Cpu& cpu;
  DeviceBus* devices;

  std::array<std::uint32_t, 33> x{};  // and kDiscard
  std::uint32_t pc = 0;
  Cycle cycle = 0;
  std::uint64_t retired = 0;
  bool sleeping = false;
  Cycle slept = 0;

  bool interrupts_on = false;    // mstatus.MIE
  bool interrupts_were = false;  // mstatus.MPIE
  std::uint32_t mie = 0, mip = 0, mtvec = 0, mepc = 0, mcause = 0, mtval = 0, mscratch = 0;
  std::uint64_t mcycle_offset = 0, minstret_offset = 0;  // what the counters show beyond cycle and retired

  std::vector<cpu::Region> regions;
  std::vector<std::uint32_t> watched;  // word addresses
  std::array<cpu::LoadEntry, cpu::kTlbSize> load_tlb;
  std::array<cpu::StoreEntry, cpu::kTlbSize> store_tlb;
  std::array<cpu::CodePage*, cpu::kTlbSize> code_tlb{};
  std::unordered_map<std::uint32_t, std::unique_ptr<cpu::CodePage>> code_pages;  // by page address
  std::set<std::uint32_t> executed;  // of pages that have been cleared since

  std::uint32_t value = 0;       // result of a slow load
  std::uint32_t fault = 0;       // cause after Access::kFault
  bool device_accessed = false;  // the fault came from a device
  bool stops_at_exceptions = false;
  bool access_waits = false;  // the instruction at pc has begun its device access: no interrupt may come before its end
};

}  // namespace brick
