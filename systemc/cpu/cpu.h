// RV32IMC instruction-set model with machine mode, cycle costs and predecoded instructions. It stands in for the
// DSP563xx: its instructions differ, its bus must not (docs/architecture.md). Memory is reached directly (DMI), devices
// through DeviceBus. Time is counted in CPU clock cycles.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace brick {

using Cycle = std::int64_t;

// Where loads and stores outside DMI memory go. Called at cycle `now`; returns the cycle at which the instruction goes
// on. `retry`: the access is still under way. run() returns kDevice before the instruction, which has not retired; the
// next run() makes the same access again, and the instruction ends when the answer says so.
class DeviceBus {
 public:
  virtual ~DeviceBus() = default;
  struct Result {
    bool fault;
    std::uint32_t data;
    Cycle done;
    bool retry = false;
  };
  virtual Result access(std::uint32_t address, unsigned bytes, bool write, std::uint32_t data, Cycle now) = 0;
};

// Interrupt lines: bit numbers in mip and mie, mcause = 0x8000'0000 | number. docs/architecture.md "Interrupts".
enum CpuInterrupt : unsigned {
  kIrqPhase = 16,     // latched at the falling edge of PHASE; cleared by writing mip
  kIrqServo = 17,     // latched at the falling edge of SERVO; cleared by writing mip
  kIrqHostPort = 18,  // level of the HI08 interrupt request
  kIrqRealTime = 19,  // set and cleared by software through mip
};

class Cpu {
 public:
  explicit Cpu(DeviceBus* devices = nullptr);  // not owned
  ~Cpu();
  Cpu(const Cpu&) = delete;

  // Memory -----------------------------------------------------------------------------------------------------------
  // Maps `bytes` of DMI memory at `base`. `mask24`: stores keep only the low 24 bits of each 32-bit word (PMAC X/Y
  // memory). `wait`: extra cycles a load or store costs (Port A wait states of the main SRAM). `read_only`: stores
  // raise an access fault.
  struct RegionOptions {
    bool read_only = false;
    bool mask24 = false;
    Cycle wait = 0;
  };
  std::uint8_t* map(std::uint32_t base, std::uint32_t bytes, RegionOptions options);  // zeroed; owned by the Cpu
  // Maps memory of somebody else, who keeps it where it is, for reading only.
  void share(std::uint32_t base, std::uint32_t bytes, const std::uint8_t* data);
  void set_wait(std::uint32_t base, Cycle wait);
  std::uint8_t* memory(std::uint32_t address, std::uint32_t bytes);  // nullptr where not mapped
  void invalidate_code();                                            // after memory was changed from outside
  struct Mapping {
    std::uint32_t base, bytes;
    bool mask24;
  };
  std::vector<Mapping> mappings() const;  // in the order of mapping
  // Addresses of all instructions that have been executed, ascending: those that are decoded, so keeping them costs
  // nothing.
  std::vector<std::uint32_t> executed() const;

  // State ------------------------------------------------------------------------------------------------------------
  void reset(std::uint32_t pc);  // registers zero, interrupts off, asleep false; memory is kept
  std::uint32_t pc() const;
  void set_pc(std::uint32_t pc);  // for a debugger, between two instructions; a sleeping CPU goes on sleeping
  std::uint32_t reg(unsigned i) const;
  void set_reg(unsigned i, std::uint32_t v);
  std::uint32_t csr(unsigned number) const;
  Cycle cycle() const;      // local time
  void set_cycle(Cycle c);  // after sleep
  Cycle slept() const;      // of them
  std::uint64_t instructions() const;
  bool asleep() const;        // WFI with nothing pending
  bool access_waits() const;  // the instruction at pc has begun its device access (DeviceBus::Result::retry)

  // Interrupt pins, as the CPU sees them from its present cycle on. Wakes a sleeping CPU when the bit is enabled in
  // mie.
  void set_interrupt(CpuInterrupt line, bool pending);

  // Runs until cycle() >= limit, a device access has been made, WFI sleeps, a watched store asks to halt, or the CPU
  // stands before the handler of an exception and stop_at_exceptions() was asked for; never starts an instruction at or
  // after `limit`.
  enum class Stop { kLimit, kDevice, kSleep, kHalt, kException };
  Stop run(Cycle limit);
  void stop_at_exceptions(bool stop);  // of a device access: kDevice

  // Hooks (empty = off, cost nothing) ---------------------------------------------------------------------------------
  std::function<void(std::uint32_t pc, Cycle)> on_flow;  // calls and returns (jal/jalr with ra)
  std::function<void(std::uint32_t cause, std::uint32_t pc, Cycle)>
      on_trap;  // trap taken, pc interrupted; mepc, mcause and mtval hold it
  std::function<void(std::uint32_t pc, Cycle)> on_mret;
  // After each instruction and each entry of a trap, which is told behind on_trap: where it stood, what it took.
  std::function<void(std::uint32_t pc, Cycle cycles)> on_instruction;
  std::function<void()> on_reset;                                                  // before reset() changes anything
  std::function<bool(std::uint32_t address, std::uint32_t value)> on_store_watch;  // see watch_store
  void watch_store(std::uint32_t address);  // a store to this word calls on_store_watch; true stops with kHalt

 private:
  struct State;
  Stop execute(Cycle limit);  // run() without on_instruction
  std::unique_ptr<State> s_;
};

}  // namespace brick
