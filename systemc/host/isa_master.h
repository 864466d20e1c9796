// A bus master on ISA / PC104: single cycles with real edges (host-bus:3.4), one point in time after the other. It
// knows the board by its pins alone: data by what is driven on SD, the width of memory by MEMCS16#, waiting by IOCHRDY.
// Whoever advances the board takes it to each point and lets the master drive or look there: the host of a Machine
// (testbench/host/isa_host.h), and the board's component.
#pragma once

#include <cstdint>

#include "systemc/core/board_pins.h"
#include "systemc/host/isa_timing.h"

namespace brick {

enum class IsaCommand { kIoRead, kIoWrite, kMemoryRead, kMemoryWrite };

struct IsaCycle {
  IsaCommand command;
  std::uint32_t address;
  std::uint16_t data;
  bool sbhe;  // the upper lane is used
  bool memory() const { return command == IsaCommand::kMemoryRead || command == IsaCommand::kMemoryWrite; }
  bool write() const { return command == IsaCommand::kIoWrite || command == IsaCommand::kMemoryWrite; }
};

struct IsaResult {
  std::uint16_t data;  // as it stood on the bus
  bool narrow;         // a memory cycle of eight bits
  bool stuck;          // IOCHRDY stayed low for longer than t10
};

class IsaMaster {
 public:
  // `start` is on times.grid and not before free_at(); `width` 8: no SBHE#, nobody looks at MEMCS16#. A cycle that is
  // under way is forgotten.
  void begin(const IsaCycle& cycle, TimeFs start, const isa::HostTimes& times, unsigned width);
  bool running() const { return step_ != Step::kIdle; }
  const IsaResult& result() const { return result_; }
  TimeFs end() const { return high_ + (times_.release - times_.command_high); }   // address and data are let go
  TimeFs free_at() const { return high_ + (times_.next - times_.command_high); }  // the next cycle may start

  // The next point. At one it drives pins: the edge fs_to_tick(time()) is the first to see them. At another it looks,
  // when the board stands at tick(), or stands() earlier.
  bool drives() const;
  TimeFs time() const;
  void drive(IsaPins& pins) const;  // as often as one likes
  void driven() { after_drive(); }
  Tick tick() const;
  bool waits() const { return step_ == Step::kReady || step_ == Step::kRise; }  // may stand earlier, by IOCHRDY
  bool stands(const BoardOutputs& board) const;
  void look(Tick now, const BoardOutputs& board);

  static std::uint16_t data_bus(const BoardOutputs& board);  // lanes that nobody drives are pulled up

 private:
  enum class Step {
    kIdle,
    kStart,
    kAddress,
    kWidth,
    kCommand,
    kReady,
    kStretch,
    kRise,
    kSample,
    kEnd,
    kRelease,
    kLeft
  };
  void go(Step step);
  void after_drive();
  void stretch(bool ready);
  TimeFs before(Step step) const;
  void address(IsaPins& pins) const;

  Step step_ = Step::kIdle;
  IsaCycle cycle_{};  // from here on as begin() sets them
  IsaResult result_{};
  isa::HostTimes all_{};
  isa::CycleTimes times_{};
  unsigned width_{};
  bool data_next_{}, data_driven_{};  // write data is the next point
  TimeFs start_{}, high_{};           // high_: the command ends
};

}  // namespace brick
