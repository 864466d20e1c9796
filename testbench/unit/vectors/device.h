// What a timing vector is run on: something with pins and registers that is advanced in ticks. The servo IC's channels
// stand behind it as RTL, as model, or as both compared; so does the whole controller. Signal numbers are places in
// signals().
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

// The device cannot go on: the two engines differ, the firmware does not answer. Counts as a failure of the vector.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DeviceSignal {
  std::string name;
  bool input;
  unsigned width = 1;       // more than 1: drawn as a number
  std::string enable = {};  // the signal that is 0 while nobody drives this one
};

class Device {
 public:
  virtual ~Device() = default;
  virtual const std::vector<DeviceSignal>& signals() const = 0;
  virtual Tick now() const = 0;
  virtual std::uint32_t value(unsigned signal) const = 0;

  virtual void reset() = 0;
  virtual void run(Tick ticks) = 0;
  // To the next change of the signal, or any tick before it; not beyond `limit`.
  virtual void run_towards_change(unsigned signal, Tick limit) = 0;
  // An input as the next edge will see it.
  virtual void drive(unsigned signal, std::uint32_t value) = 0;

  // Bus cycles; time passes. Address: word of the IC, of the page of serial encoder inputs.
  virtual void write(bool x, unsigned addr, std::uint32_t value) = 0;
  virtual std::uint32_t read(bool x, unsigned addr) = 0;
  // A command line to the firmware; data lines of the reply joined by '|'.
  virtual std::string command(const std::string& line) = 0;

  // Called for every change of a signal, inputs too, in order of time.
  std::function<void(Tick, unsigned signal, std::uint32_t value)> on_change;
};

struct DeviceKind {
  std::string name;                   // as vectors name it
  std::vector<DeviceSignal> signals;  // what vectors may name
  unsigned words;                     // that write and read reach, X and Y of each
  bool encoders, commands;            // has turn, command
  std::vector<std::string> engines;
};
const std::vector<DeviceKind>& device_kinds();

// `engine`: rtl, systemc, both; for the channels also board_rtl, board_systemc, board_both: those of servo IC 0 on the
// whole board. `board`: of a controller.
std::unique_ptr<Device> make_device(const std::string& kind, const std::string& engine, const std::string& board);

// Two devices of one kind, one step at a time; DeviceError at the first difference.
std::unique_ptr<Device> compared(std::unique_ptr<Device> first, std::unique_ptr<Device> second);

// The kinds (channels_device.cpp, board_device.cpp, controller_device.cpp, buses_device.cpp, ssi_device.cpp).
std::vector<DeviceSignal> channels_signals();
std::unique_ptr<Device> make_channels(bool rtl);
std::unique_ptr<Device> make_board_device(const std::string& engine);  // rtl, systemc, both
std::vector<DeviceSignal> controller_signals();
std::vector<DeviceSignal> buses_signals();
std::unique_ptr<Device> make_buses(const std::string& engine);  // rtl, systemc, both
std::vector<DeviceSignal> ssi_signals();
std::unique_ptr<Device> make_ssi(bool rtl);
std::unique_ptr<Device> make_controller(const std::string& engine, const std::string& board);

}  // namespace brick
